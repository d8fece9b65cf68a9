//! Layers of what a ray meets as a point of its object: texture coordinates, places in the object's own space, and ways across the picture. Both devices
//! against closed forms.

use glam::{DAffine3, DVec2, DVec3};
use gpt::film::KernelLayer;
use gpt::scene::Scene;

use crate::layers::{Pixels, SPP, everywhere, ray, scene};

/// A sheet across the view, its lower left corner at (−2, −1.5, 0).
const SHEET: &str = "type = \"rectangle\"\ncorner = [-2, -1.5, 0]\nedge_u = [4, 0, 0]\nedge_v = [0, 3, 0]\nmaterial = \"red\"\n";
/// The camera before it, at a distance of 5, with the pixels of a picture of 16 × 12.
const BEFORE: &str = "position = [0, 0, 5]\nlook_at = [0, 0, 0]\nvfov = 40\n";
/// Pixels that a length of 1 at a distance of 1 takes up.
fn pixels() -> f64 {
    6.0 / 20.0_f64.to_radians().tan()
}

/// The scene of these tables with other keys of the camera.
fn seen_by(camera: &str, tables: &str) -> Scene {
    let text = scene_text(camera, tables);
    gpt::load::load_toml_str(&text, "object-layers", std::path::Path::new("")).unwrap_or_else(|error| panic!("{error}: {text}"))
}

fn scene_text(camera: &str, tables: &str) -> String {
    format!(
        "[film]\nsize = [16, 12]\n[render]\nspp = {SPP}\npixel_sampler = \"none\"\n[camera]\n{camera}[[material]]\nname = \"red\"\n\
         type = \"diffuse\"\nreflectance = [0.6, 0.2, 0.1]\n{tables}\n[[light]]\ntype = \"point\"\nposition = [1, 4, 3]\nintensity = 9\n"
    )
}

/// The place at which the ray through a pixel's middle meets the plane z = 0.
fn on_plane(scene: &Scene, pixel: usize) -> DVec3 {
    let (origin, direction) = ray(scene, pixel);
    origin - direction * (origin.z / direction.z)
}

/// The largest difference of pixels' means from what is expected of those that see something; at least half of them do.
fn farthest(found: &Pixels, expected: impl Fn(usize) -> DVec3) -> f64 {
    let seen: Vec<usize> = (0..found.means.len()).filter(|&pixel| found.counts[pixel] > 0).collect();
    assert!(2 * seen.len() > found.means.len(), "{} pixels", seen.len());
    let off = |&pixel: &usize| (DVec3::from_array(found.means[pixel].map(f64::from)) - expected(pixel)).length();
    seen.iter().map(off).fold(0.0, f64::max)
}

/// A rectangle without any texture has coordinates along its edges, a mesh its own.
#[test]
fn texture_coordinates_are_known() {
    let mesh = "type = \"mesh\"\npositions = [[-2, -1.5, 0], [2, -1.5, 0], [2, 1.5, 0], [-2, 1.5, 0]]\nfaces = [[0, 1, 2], [0, 2, 3]]\n\
                uvs = [[0, 0], [2, 0], [2, 6], [0, 6]]\nmaterial = \"red\"\n";
    for (shape, scale) in [(SHEET, DVec2::new(1.0, 1.0)), (mesh, DVec2::new(2.0, 6.0))] {
        let scene = scene(&format!("[[shape]]\n{shape}"));
        let expected = |pixel: usize| {
            let place = on_plane(&scene, pixel);
            (DVec2::new((place.x + 2.0) / 4.0, (place.y + 1.5) / 3.0) * scale).extend(0.0)
        };
        for found in everywhere(&scene, KernelLayer::Uv) {
            assert!(farthest(&found, expected) < 1e-5, "{}", farthest(&found, expected));
            // Negative control: the other way round they are others.
            assert!(farthest(&found, |pixel| DVec3::new(expected(pixel).y, expected(pixel).x, 0.0)) > 0.1);
        }
    }
}

/// A quarter turn to the left about the viewing direction, twice as large, a step aside.
const PLACED: &str = "transform = [{ scale = 2 }, { rotate = [0, 0, 1], degrees = 90 }, { translate = [0.25, 0.125, 0] }]\n";

/// By hand: the map of PLACED takes (x, y) to (0.25 − 2y, 0.125 + 2x).
fn before_placed(place: DVec3) -> DVec3 {
    DVec3::new((place.y - 0.125) / 2.0, (0.25 - place.x) / 2.0, place.z / 2.0)
}

/// A shape with a transform, a group's mesh in its place, and both in motion have their own space.
#[test]
fn places_in_the_space_of_objects_are_known() {
    let group = "[[group]]\nname = \"thing\"\n[[group.shape]]\ntype = \"mesh\"\npositions = [[-2, -1.5, 0], [2, -1.5, 0], [2, 1.5, 0], [-2, 1.5, 0]]\n\
                 faces = [[0, 1, 2], [0, 2, 3]]\nmaterial = \"red\"\n[[instance]]\ngroup = \"thing\"\nplaces = [[0, -2, 0, 0.25, 2, 0, 0, 0.125, 0, 0, 2, 0]]\n";
    for tables in [format!("[[shape]]\n{SHEET}{PLACED}"), group.to_owned()] {
        let scene = scene(&tables);
        let expected = |pixel: usize| before_placed(on_plane(&scene, pixel));
        for found in everywhere(&scene, KernelLayer::ObjectPosition) {
            assert!(farthest(&found, expected) < 1e-5, "{tables}: {}", farthest(&found, expected));
            // Negative control: the place in the world is another.
            assert!(farthest(&found, |pixel| on_plane(&scene, pixel)) > 0.1);
        }
        // Along its own plane, the sheet moves a known way in the time of each ray: the mean place lies half of it behind.
        let moving = seen_by(BEFORE, &format!("{tables}motion = [{{ translate = [0.5, 0, 0] }}]\n"));
        for found in everywhere(&moving, KernelLayer::ObjectPosition) {
            let of_mean = |pixel: usize| before_placed(on_plane(&moving, pixel) - DVec3::new(0.25, 0.0, 0.0));
            // SPP times are spread evenly over the shutter.
            assert!(farthest(&found, of_mean) < 0.25 / f64::from(SPP), "{tables}: {}", farthest(&found, of_mean));
            assert!(farthest(&found, |pixel| before_placed(on_plane(&moving, pixel))) > 0.1);
        }
    }
}

/// The motion vectors of a scene are everywhere these, to a thousandth of a pixel; and are not these.
fn assert_motion(scene: &Scene, expected: DVec2, control: DVec2) {
    for found in everywhere(scene, KernelLayer::Motion) {
        let off = farthest(&found, |_| expected.extend(0.0));
        assert!(off < 1e-3, "{off}: {:?} instead of {expected}", found.means[100]);
        let off = farthest(&found, |_| control.extend(0.0));
        assert!(off > 0.1, "the control: {off}");
    }
}

/// A sheet that goes right and up by a known way at a known distance, as a shape and as an instance; and its camera, the other way.
#[test]
fn motion_is_known_in_pixels() {
    let right_and_up = DVec2::new(0.4, 0.2) * pixels() / 5.0;
    let step = "motion = [{ translate = [0.4, 0.2, 0] }]\n";
    let group = "[[group]]\nname = \"thing\"\n[[group.shape]]\ntype = \"mesh\"\npositions = [[-3, -2, 0], [3, -2, 0], [3, 2, 0], [-3, 2, 0]]\n\
                 faces = [[0, 1, 2], [0, 2, 3]]\nmaterial = \"red\"\n[[instance]]\ngroup = \"thing\"\nplaces = [[0, -1, 0, 0.1, 1, 0, 0, 0.2, 0, 0, 1, 0]]\n";
    for tables in [format!("[[shape]]\n{SHEET}{step}"), format!("{group}{step}")] {
        assert_motion(&seen_by(BEFORE, &tables), right_and_up, DVec2::new(right_and_up.x, -right_and_up.y));
        // Half of the time.
        let half = seen_by(&format!("{BEFORE}shutter = [0.25, 0.75]\n"), &tables);
        assert_motion(&half, 0.5 * right_and_up, right_and_up);
    }
    // At rest nothing goes anywhere, to the last bit.
    let at_rest = seen_by(BEFORE, &format!("[[shape]]\n{SHEET}"));
    for found in everywhere(&at_rest, KernelLayer::Motion) {
        assert!(found.means.iter().all(|mean| *mean == [0.0; 3]));
    }
    // Parallel rays know no distance.
    let parallel = "position = [0, 0, 5]\nlook_at = [0, 0, 0]\nprojection = \"orthographic\"\nheight = 3\n";
    let of_parallel = DVec2::new(0.4, 0.2) * 12.0 / 3.0;
    assert_motion(&seen_by(parallel, &format!("[[shape]]\n{SHEET}{step}")), of_parallel, right_and_up);
}

/// A camera that goes right and up before a sheet at rest: what is seen goes left and down. Keyframes say where it is.
#[test]
fn motion_of_the_camera_counts() {
    let keys = "keyframes = [{ frame = 0, position = [0, 0, 5], look_at = [0, 0, 0] }, { frame = 1, position = [0.3, 0.1, 5], look_at = [0.3, 0.1, 0] }]\n";
    let moving = seen_by(&format!("{BEFORE}{keys}"), &format!("[[shape]]\n{SHEET}"));
    let frame = moving.at_frame(0.0).expect("a frame");
    let left_and_down = -DVec2::new(0.3, 0.1) * pixels() / 5.0;
    assert_motion(&frame, left_and_down, -left_and_down);
}

/// A sheet that turns has another motion at each point: that of the rotation, by the places before and after. The sheet turns about the viewing direction.
#[test]
fn motion_of_what_turns_is_known() {
    let wide =
        SHEET.replace("[-2, -1.5, 0]", "[-9, -9, 0]").replace("[4, 0, 0]", "[18, 0, 0]").replace("[0, 3, 0]", "[0, 18, 0]");
    let turns = seen_by(BEFORE, &format!("[[shape]]\n{wide}motion = [{{ rotate = [0, 0, 1], degrees = 20 }}]\n"));
    let turn = |degrees: f64| DAffine3::from_rotation_z(degrees.to_radians());
    for found in everywhere(&turns, KernelLayer::Motion) {
        let expected = |share: f64| {
            move |pixel: usize| {
                let at = DVec3::new((pixel % 16) as f64 - 7.5, 5.5 - (pixel / 16) as f64, 0.0);
                turn(20.0 * (1.0 - share)).transform_point3(at) - turn(-20.0 * share).transform_point3(at)
            }
        };
        // At the middle of the shutter; samples are spread around it, and the chord turns with them.
        let off = farthest(&found, expected(0.5));
        assert!(off < 0.12, "{off}");
        assert!(farthest(&found, expected(0.0)) > 0.3, "the control: the vector of a ray as the shutter opens");
    }
}
