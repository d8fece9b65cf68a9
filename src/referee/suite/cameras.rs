//! Cameras and exposures, by bright rectangles on black whose places are known.

use std::f64::consts::PI;

use super::super::formulas::{cross, normalized, sub};
use super::super::test::Test;
use super::stage::{bright_rectangle, emissive, frontal, frontal_camera, on_plane, scaled, scene, sized};

const COLOR: [f64; 3] = [1.0, 0.5, 0.25];
/// Corners of the bright rectangle at z = 0, which no symmetry maps onto itself.
const FROM: [f64; 2] = [-0.5, -0.3];
const TO: [f64; 2] = [0.65, 0.45];

fn within([x, y]: [f64; 2], from: [f64; 2], to: [f64; 2]) -> [f64; 3] {
    let is_within = (from[0]..to[0]).contains(&x) && (from[1]..to[1]).contains(&y);
    if is_within { COLOR } else { [0.0; 3] }
}

fn pattern(point: [f64; 2]) -> [f64; 3] {
    within(point, FROM, TO)
}

fn bright() -> String {
    format!("{}{}", emissive("bright", COLOR), bright_rectangle(FROM, TO, 0.0, ""))
}

/// The point at which a perspective camera's ray meets z = 0. `half`: tangents of half the angles of view.
fn on_ground(position: [f64; 3], look_at: [f64; 3], up: [f64; 3], half: [f64; 2], s: f64, t: f64) -> [f64; 2] {
    let forward = normalized(sub(look_at, position));
    let right = normalized(cross(forward, up));
    let above = cross(right, forward);
    let (a, b) = (half[0] * (2.0 * s - 1.0), half[1] * (1.0 - 2.0 * t));
    let direction: [f64; 3] = std::array::from_fn(|axis| forward[axis] + a * right[axis] + b * above[axis]);
    let distance = -position[2] / direction[2];
    [position[0] + distance * direction[0], position[1] + distance * direction[1]]
}

pub fn tests() -> Vec<Test> {
    [projections(), openings()].into_iter().flatten().collect()
}

fn projections() -> Vec<Test> {
    let wide_camera = frontal_camera();
    let wide = Test::of_formula(
        [
            "cameras/wide-film",
            "The angle of view is that of the height, and pixels are square.",
            "`vfov` of the scene file; glTF camera.perspective.yfov",
        ],
        sized([96, 64], &wide_camera, &bright()),
        |s, t| pattern([1.5 * (2.0 * s - 1.0), 1.0 - 2.0 * t]),
    )
    .with_edges()
    .mistake("an angle of view that is taken for that of the width", |s, t| pattern([2.0 * s - 1.0, (1.0 - 2.0 * t) / 1.5]))
    .mistake("an angle of view that is taken for that of the diagonal", |s, t| {
        let scale = 1.0 / (1.0f64 + 2.25).sqrt();
        pattern([1.5 * scale * (2.0 * s - 1.0), scale * (1.0 - 2.0 * t)])
    });
    let tall = Test::of_formula(
        [
            "cameras/tall-film",
            "A film that is higher than wide has the angle of view along its height.",
            "`vfov` of the scene file; glTF camera.perspective.yfov",
        ],
        sized([48, 72], &frontal_camera(), &bright()),
        |s, t| pattern([(2.0 * s - 1.0) / 1.5, 1.0 - 2.0 * t]),
    )
    .with_edges()
    .mistake("an angle of view that is taken for that of the shorter side", |s, t| {
        pattern([2.0 * s - 1.0, 1.5 * (1.0 - 2.0 * t)])
    });
    let roll = Test::of_formula(
        ["cameras/roll", "`up` turns the picture about the axis.", "Right-handed coordinates"],
        scene(&format!("{}up = [0.5, 0.8660254037844386, 0]\n", frontal_camera()), &bright()),
        |s, t| {
            let half = [0.25; 2];
            pattern(on_ground([0.0, 0.0, 4.0], [0.0; 3], [0.5, 0.75f64.sqrt(), 0.0], half, s, t))
        },
    )
    .with_edges()
    .mistake("a camera that rolls the other way", |s, t| {
        pattern(on_ground([0.0, 0.0, 4.0], [0.0; 3], [-0.5, 0.75f64.sqrt(), 0.0], [0.25; 2], s, t))
    });
    const ASIDE: [f64; 3] = [1.8, -1.1, 3.0];
    const LOOK_AT: [f64; 3] = [0.1, 0.05, 0.0];
    let aside = Test::of_formula(
        ["cameras/oblique", "A plane seen from aside, in perspective.", "Central projection"],
        scene(&format!("position = {ASIDE:?}\nlook_at = {LOOK_AT:?}\nvfov = 40\n"), &bright()),
        |s, t| pattern(on_ground(ASIDE, LOOK_AT, [0.0, 1.0, 0.0], [20f64.to_radians().tan(); 2], s, t)),
    )
    .with_edges()
    .mistake("a left-handed camera", |s, t| {
        pattern(on_ground(ASIDE, LOOK_AT, [0.0, 1.0, 0.0], [20f64.to_radians().tan(); 2], 1.0 - s, t))
    });
    let shift = Test::of_formula(
        [
            "cameras/shift",
            "A picture whose middle lies aside of the axis: a quarter of the width to the right, an eighth of the height above.",
            "`shift` of the scene file; off-centre projection",
        ],
        scene(&format!("{}shift = [0.25, 0.125]\n", frontal_camera()), &bright()),
        |s, t| pattern(on_plane(s + 0.25, t - 0.125)),
    )
    .with_edges()
    .mistake("a shift to the other side", |s, t| pattern(on_plane(s - 0.25, t + 0.125)));
    let orthographic = {
        let camera = "position = [0, 0, 4]\nlook_at = [0, 0, 0]\nprojection = \"orthographic\"\nheight = 2\n";
        // The second stands nearer to the camera, and is as large as it is.
        let near = bright_rectangle([-0.9, 0.6], [-0.6, 0.9], 2.0, "");
        Test::of_formula(
            [
                "cameras/orthographic",
                "Parallel rays: what is near is no larger.",
                "`height` of the scene file; glTF camera.orthographic.ymag is half of it",
            ],
            scene(camera, &format!("{}{near}", bright())),
            |s, t| {
                let point = on_plane(s, t);
                let [first, second] = [pattern(point), within(point, [-0.9, 0.6], [-0.6, 0.9])];
                std::array::from_fn(|channel| first[channel].max(second[channel]))
            },
        )
        .with_edges()
        .mistake("a window of twice the height", |s, t| {
            let point = on_plane(s, t).map(|axis| 2.0 * axis);
            let [first, second] = [pattern(point), within(point, [-0.9, 0.6], [-0.6, 0.9])];
            std::array::from_fn(|channel| first[channel].max(second[channel]))
        })
    };
    let edges = Test::of_formula(
        [
            "cameras/coverage",
            "A pixel that an edge crosses shows the share of its square that is covered.",
            "Box filter of one pixel, `filter` of the scene file",
        ],
        frontal(&format!("{}{}", emissive("bright", COLOR), bright_rectangle([-0.512, -0.43], [0.371, 0.288], 0.0, ""))),
        |s, t| within(on_plane(s, t), [-0.512, -0.43], [0.371, 0.288]),
    )
    .with_edges()
    .mistake("a picture that lies half a pixel to the right", |s, t| {
        within(on_plane(s - 1.0 / 128.0, t), [-0.512, -0.43], [0.371, 0.288])
    })
    .mistake("a picture that lies one pixel too low", |s, t| {
        within(on_plane(s, t - 1.0 / 64.0), [-0.512, -0.43], [0.371, 0.288])
    });
    vec![wide, tall, roll, aside, shift, orthographic, edges]
}

/// Share of a disk of radius 1 that lies right of −q: the edge that a lens with a round opening spreads.
fn right_of_edge(q: f64) -> f64 {
    let q = q.clamp(-1.0, 1.0);
    0.5 + (q * (1.0 - q * q).sqrt() + q.asin()) / PI
}

/// The time for which x lies within a window that moves from `start` by `way` during the exposure.
fn time_within(x: f64, start: [f64; 2], way: f64) -> f64 {
    let (first, last) = ((x - start[1]) / way, (x - start[0]) / way);
    (last.clamp(0.0, 1.0) - first.clamp(0.0, 1.0)).max(0.0)
}

fn openings() -> Vec<Test> {
    let lens = |texts, radius: f64, focus: f64| {
        // The opening sees a disk of this radius of the plane z = 0, 4 away, around the pinhole's point.
        let blur = radius * (4.0 - focus) / focus;
        let edge = bright_rectangle([0.0, -9.0], [9.0, 9.0], 0.0, "");
        Test::of_formula(
            texts,
            scene(
                &format!("{}aperture = {{ shape = \"disk\", radius = {radius} }}\nfocus_distance = {focus}\n", frontal_camera()),
                &format!("{}{edge}", emissive("bright", COLOR)),
            ),
            move |s, t| {
                let x = on_plane(s, t)[0];
                scaled(COLOR, if blur > 0.0 { right_of_edge(x / blur) } else { f64::from(u8::from(x > 0.0)) })
            },
        )
    };
    let blurred = lens(
        [
            "cameras/lens",
            "A straight edge behind the plane in focus is spread as a round opening spreads it.",
            "Thin lens: the circle of confusion is a disk of even brightness",
        ],
        0.6,
        3.0,
    )
    .mistake("an opening whose diameter is taken for its radius", |s, t| scaled(COLOR, right_of_edge(on_plane(s, t)[0] / 0.1)))
    .mistake("a pinhole", |s, t| scaled(COLOR, f64::from(u8::from(on_plane(s, t)[0] > 0.0))));
    let sharp = lens(["cameras/lens-in-focus", "What lies in the plane in focus is sharp.", "Thin lens"], 0.6, 4.0)
        .with_edges()
        .mistake("a distance in focus that is measured to one side", |s, t| {
            scaled(COLOR, right_of_edge(on_plane(s, t)[0] / 0.1))
        });
    let moving = |texts, shutter: [f64; 2]| {
        let keys = "motion = [{ translate = [0.9, 0, 0] }]";
        let length = shutter[1] - shutter[0];
        let start = [-0.7 + 0.9 * shutter[0], -0.2 + 0.9 * shutter[0]];
        let value = move |start: [f64; 2], way: f64, s: f64, t: f64| {
            let [x, y] = on_plane(s, t);
            scaled(COLOR, if (-0.4..0.3).contains(&y) { time_within(x, start, way) } else { 0.0 })
        };
        Test::of_formula(
            texts,
            scene(
                &format!("{}shutter = {shutter:?}\n", frontal_camera()),
                &format!("{}{}", emissive("bright", COLOR), bright_rectangle([-0.7, -0.4], [-0.2, 0.3], 0.0, keys)),
            ),
            move |s, t| value(start, 0.9 * length, s, t),
        )
        .with_edges()
        .mistake("what moves is seen where it starts", move |s, t| value(start, 1e-9, s, t))
        .mistake("an exposure of twice the time", move |s, t| value(start, 1.8 * length, s, t))
    };
    vec![
        blurred,
        sharp,
        moving(
            [
                "cameras/motion",
                "A rectangle that moves evenly shows the share of the time for which it covers a point.",
                "Exposure: the mean over the shutter's time",
            ],
            [0.0, 1.0],
        ),
        moving(
            ["cameras/shutter", "A shutter that is open for the second quarter of the motion.", "`shutter` of the scene file"],
            [0.25, 0.5],
        ),
    ]
}
