//! Media of Mitsuba's scenes become media of ours.

use std::ffi::OsStr;
use std::path::Path;

use glam::DVec3;
use tempfile::tempdir;

use crate::load::volume::write_mitsuba;
use crate::load::{LoadOptions, SceneError, load_with};
use crate::scene::settings::NumberOrAuto;
use crate::scene::{MaterialKind, Medium, Phase, PhaseKind, PhaseLobe, Scene, VoxelGrid, digest};
use crate::scene_writer::save_scene;
use crate::spectrum::Spectrum;

const VOLPATH: &str = "<integrator type=\"volpath\"/>";
const POINT_LIGHT: &str = "<emitter type=\"point\"><point name=\"position\" x=\"9\" y=\"9\" z=\"9\"/></emitter>";
const BODY: &str = "<bsdf type=\"null\"/>";

/// A scene of these elements with a sensor that has these.
fn document(integrator: &str, of_sensor: &str, more: &str) -> String {
    format!(
        "<scene version=\"3.0.0\">{integrator}<sensor type=\"perspective\"><float name=\"fov\" value=\"40\"/>{of_sensor}<transform name=\"to_world\">\
         <lookat origin=\"0,0,20\" target=\"0,0,0\" up=\"0,1,0\"/></transform></sensor>{POINT_LIGHT}{more}</scene>"
    )
}

fn load(text: &str) -> Result<Scene, SceneError> {
    let folder = tempdir().unwrap();
    let path = folder.path().join("a.xml");
    std::fs::write(&path, text).unwrap();
    write_volumes(folder.path());
    load_with(Some(OsStr::new(&path)), &LoadOptions::default())
}

fn read(text: &str) -> Scene {
    load(text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// Grids without a symmetry: `cloud.vol` of one number in the box from (-1, 0, 0) to (1, 1, 2), `tints.vol` of colours, `red.vol` of densities in colours.
fn write_volumes(folder: &Path) {
    let write = |name: &str, grid: &VoxelGrid| {
        std::fs::write(folder.join(name), write_mitsuba(grid, DVec3::new(-1.0, 0.0, 0.0), DVec3::new(1.0, 1.0, 2.0))).unwrap();
    };
    write("cloud.vol", &cloud());
    write("tints.vol", &tints());
    write("red.vol", &VoxelGrid::new([1, 1, 2], 3, vec![0.0, 0.0, 3.0, 1.0, 2.0, 3.0]).unwrap());
    write("tinted.vol", &VoxelGrid::new([1, 1, 2], 3, vec![1.0, 0.5, 2.0, 2.0, 1.0, 4.0]).unwrap());
    std::fs::write(folder.join("text.vol"), "no grid").unwrap();
}

fn cloud() -> VoxelGrid {
    VoxelGrid::new([3, 2, 2], 1, (0..12).map(|value| (value * value) as f32 / 8.0).collect()).unwrap()
}

fn tints() -> VoxelGrid {
    VoxelGrid::new([1, 2, 1], 3, vec![0.25, 0.5, 0.75, 1.0, 0.5, 0.0]).unwrap()
}

fn ball(radius: f64, within: &str) -> String {
    format!("<shape type=\"sphere\"><float name=\"radius\" value=\"{radius}\"/>{within}</shape>")
}

/// The one medium of a ball whose `interior` has these elements.
fn medium(plugin: &str, within: &str) -> Medium {
    let interior = format!("<medium type=\"{plugin}\" name=\"interior\">{within}</medium>");
    let scene = read(&document(VOLPATH, "", &ball(1.0, &format!("{BODY}{interior}"))));
    let [medium] = &scene.media[..] else { panic!("{} media", scene.media.len()) };
    medium.clone()
}

/// The medium within a shape.
fn within(scene: &Scene, shape: usize) -> Option<&str> {
    scene.materials[scene.shapes[shape].material].interior.map(|id| scene.media[id].name.as_str())
}

fn report(scene: &Scene) -> String {
    let report = &scene.import_report;
    let items = report.dropped.iter().chain(&report.approximated);
    items.map(|item| format!("{}: {}\n", item.what, item.instead)).collect()
}

fn near(found: Spectrum, expected: [f64; 3]) {
    let difference = (found - Spectrum::from_rgb(expected)).map(f64::abs).max_component();
    assert!(difference < 1e-9, "{found} instead of {expected:?}");
}

#[test]
fn every_way_to_say_how_dense_a_medium_is() {
    let rows = [
        ("", [0.25; 3], [0.75; 3]),
        ("<float name=\"scale\" value=\"4\"/>", [1.0; 3], [3.0; 3]),
        (
            "<rgb name=\"sigma_t\" value=\"1, 2, 4\"/><rgb name=\"albedo\" value=\"0.5, 0.25, 1\"/><float name=\"scale\" value=\"2\"/>",
            [1.0, 3.0, 0.0],
            [1.0, 1.0, 8.0],
        ),
        ("<float name=\"sigma_t\" value=\"2\"/><float name=\"albedo\" value=\"0\"/>", [2.0; 3], [0.0; 3]),
        (
            "<volume type=\"constvolume\" name=\"sigma_t\"><rgb name=\"value\" value=\"2, 3, 4\"/></volume>\
             <volume type=\"constvolume\" name=\"albedo\"><float name=\"value\" value=\"0.5\"/></volume>",
            [1.0, 1.5, 2.0],
            [1.0, 1.5, 2.0],
        ),
        // The way of 0.6.
        (
            "<rgb name=\"sigmaS\" value=\"1, 2, 3\"/><rgb name=\"sigmaA\" value=\"0.5\"/><float name=\"scale\" value=\"2\"/>",
            [1.0; 3],
            [2.0, 4.0, 6.0],
        ),
        ("<string name=\"material\" value=\"Ketchup\"/>", [0.061, 0.97, 1.45], [0.18, 0.07, 0.03]),
    ];
    for (keys, absorption, scattering) in rows {
        let found = medium("homogeneous", keys);
        near(found.absorption, absorption);
        near(found.scattering, scattering);
        assert_eq!(found.phase, Phase::isotropic(), "{keys}");
    }
    // The control: another scale is another medium.
    assert_ne!(medium("homogeneous", rows[1].0).scattering, medium("homogeneous", rows[0].0).scattering);
    let message = load(&document(
        VOLPATH,
        "",
        &ball(
            1.0,
            "<bsdf type=\"null\"/><medium type=\"homogeneous\" name=\"interior\"><string name=\"material\" value=\"cheese\"/></medium>",
        ),
    ));
    let message = message.expect_err("nobody has measured it").to_string();
    assert!(message.contains("a.xml:1") && message.contains("`cheese`"), "{message}");
}

#[test]
fn phase_functions_are_what_they_say_or_reported() {
    let phase = |text: &str| medium("homogeneous", text).phase;
    let lobe = |kind| Phase::of(kind);
    let henyey_greenstein = |g| PhaseKind::HenyeyGreenstein { g };
    assert_eq!(phase("<phase type=\"isotropic\"/>"), Phase::isotropic());
    assert_eq!(phase("<phase type=\"rayleigh\"/>"), lobe(PhaseKind::Rayleigh));
    assert_eq!(phase("<phase type=\"hg\"><float name=\"g\" value=\"-0.3\"/></phase>"), lobe(henyey_greenstein(-0.3)));
    // The default there.
    assert_eq!(phase("<phase type=\"hg\"/>"), lobe(henyey_greenstein(0.8)));
    let blend = "<phase type=\"blendphase\"><float name=\"weight\" value=\"0.25\"/><phase type=\"rayleigh\"/><phase type=\"hg\"/></phase>";
    let expected = [(0.75, PhaseKind::Rayleigh), (0.25, henyey_greenstein(0.8))].map(|(weight, kind)| PhaseLobe { weight, kind });
    assert_eq!(phase(blend), Phase(expected.to_vec()));
    // The control: the weight is the second one's share.
    assert_ne!(phase(&blend.replace("0.25", "0.75")), phase(blend));
    assert_eq!(phase("<phase type=\"tabphase\"><string name=\"values\" value=\"1, 1, 1\"/></phase>"), Phase::isotropic());
    let approximated = [
        ("<phase type=\"tabphase\"><string name=\"values\" value=\"0.4, 1, 1.6\"/></phase>", "phase `tabphase`"),
        ("<phase type=\"sggx\"><volume type=\"constvolume\" name=\"S\"/></phase>", "phase `sggx`"),
        ("<phase type=\"hg\"><float name=\"g\" value=\"0.9999\"/></phase>", "mean cosine"),
    ];
    for (text, said) in approximated {
        let scene = read(&document(
            VOLPATH,
            "",
            &ball(1.0, &format!("{BODY}<medium type=\"homogeneous\" name=\"interior\">{text}</medium>")),
        ));
        assert!(report(&scene).contains(said), "{text}: {}", report(&scene));
    }
    for (text, said) in [
        ("<phase type=\"hg\"><float name=\"g\" value=\"1\"/></phase>", "`g` is above -1 and below 1"),
        ("<phase type=\"tabphase\"><string name=\"values\" value=\"1\"/></phase>", "two numbers or more"),
        ("<phase type=\"blendphase\"><phase type=\"hg\"/></phase>", "1 phase functions within, and 2 weights"),
        ("<phase type=\"hg\"/><phase type=\"hg\"/>", "a medium has one phase function"),
    ] {
        let text =
            document(VOLPATH, "", &ball(1.0, &format!("{BODY}<medium type=\"homogeneous\" name=\"interior\">{text}</medium>")));
        let message = load(&text).expect_err("it is wrong").to_string();
        assert!(message.contains(said), "{message}");
    }
}

/// Each of 30 blends names the one before twice.
#[test]
fn blends_that_share_their_parts_end() {
    let mut text = "<phase type=\"hg\" id=\"p0\"/>".to_owned();
    for blend in 1..30 {
        let part = format!("<ref id=\"p{}\"/>", blend - 1);
        text += &format!("<phase type=\"blendphase\" id=\"p{blend}\"><float name=\"weight\" value=\"0.5\"/>{part}{part}</phase>");
    }
    let of = |blend: usize| {
        let medium = format!("<medium type=\"homogeneous\" name=\"interior\"><ref id=\"p{blend}\"/></medium>");
        load(&document(VOLPATH, "", &(text.clone() + &ball(1.0, &format!("{BODY}{medium}")))))
    };
    assert!(of(29).expect_err("they are too many").to_string().contains("phase functions"));
    assert!(of(5).is_ok());
}

const FOG: &str = "<medium type=\"homogeneous\" id=\"fog\"/><medium type=\"homogeneous\" id=\"milk\"><float name=\"sigma_t\" value=\"3\"/></medium>";
const IN_FOG: &str = "<ref id=\"fog\"/>";
const MILK: &str = "<ref name=\"interior\" id=\"milk\"/>";
const GLASS: &str = "<bsdf type=\"dielectric\" id=\"glass\"/>";

#[test]
fn media_are_in_shapes_and_around_the_sensor() {
    let shapes = ball(1.0, &format!("{GLASS}{MILK}<ref name=\"exterior\" id=\"fog\"/>"))
        + &ball(2.0, &format!("<bsdf type=\"null\"/>{MILK}<ref name=\"exterior\" id=\"fog\"/>"));
    let scene = read(&document(VOLPATH, IN_FOG, &format!("{FOG}{shapes}")));
    assert_eq!(scene.camera_medium.map(|id| &*scene.media[id].name), Some("fog"));
    assert_eq!([within(&scene, 0), within(&scene, 1)], [Some("milk"), Some("milk")]);
    let kind = |shape: usize| &scene.materials[scene.shapes[shape].material].kind;
    assert!(matches!((kind(0), kind(1)), (MaterialKind::Glass { .. }, MaterialKind::Pass)));
    assert_eq!(scene.media.len(), 2);
    // Around the inner ball is milk, and not fog.
    assert_eq!(report(&scene).matches("exterior medium of a shape").count(), 1, "{}", report(&scene));
    // The scene file that is written of it says the same.
    let folder = tempdir().unwrap();
    let path = folder.path().join("b.toml");
    save_scene(&scene, &path).unwrap();
    let written = load_with(Some(OsStr::new(&path)), &LoadOptions::default()).unwrap();
    assert_eq!(digest(&written), digest(&scene));
}

/// A body of glass that says nothing leaves a path in the medium around it there; here it is filled with it.
#[test]
fn bodies_of_glass_hold_what_is_around_them() {
    let fog_box = |radius: f64| ball(radius, "<bsdf type=\"null\"/><ref name=\"interior\" id=\"fog\"/>");
    let glass = ball(1.0, GLASS);
    let scene = read(&document(VOLPATH, "", &format!("{FOG}{glass}{}", fog_box(3.0))));
    assert_eq!(within(&scene, 0), Some("fog"));
    let scene = read(&document(VOLPATH, IN_FOG, &format!("{FOG}{glass}")));
    assert_eq!(within(&scene, 0), Some("fog"));
    // The controls: fog that is smaller than the ball, and none.
    let scene = read(&document(VOLPATH, "", &format!("{FOG}{glass}{}", fog_box(0.5))));
    assert_eq!(within(&scene, 0), None);
    assert_eq!(within(&read(&document(VOLPATH, "", &format!("{FOG}{glass}"))), 0), None);
    // A shape that says what is outside of it alone is empty.
    let hole = ball(1.0, "<bsdf type=\"null\"/><ref name=\"exterior\" id=\"fog\"/>");
    let scene = read(&document(VOLPATH, IN_FOG, &format!("{FOG}{hole}")));
    let empty = scene.materials[scene.shapes[0].material].interior.expect("a medium");
    assert!(scene.media[empty].extinction().is_black() && report(&scene).is_empty(), "{}", report(&scene));
    // One that says nothing of its outside is not within fog there.
    let scene = read(&document(VOLPATH, IN_FOG, &format!("{FOG}{}", ball(1.0, &format!("{GLASS}{MILK}")))));
    assert!(report(&scene).contains("no medium outside of a shape"), "{}", report(&scene));
}

/// Fog of a room that the sensor is in ends with the room.
#[test]
fn fog_of_a_room_is_not_around_the_room() {
    let room = |radius: f64| ball(radius, "<bsdf type=\"null\"/><ref name=\"interior\" id=\"fog\"/>");
    let beside = format!("<shape type=\"cube\">{GLASS}<transform name=\"to_world\"><translate x=\"90\"/></transform></shape>");
    let scene =
        read(&document(VOLPATH, IN_FOG, &format!("{FOG}{}{}{beside}", room(30.0), ball(1.0, "<bsdf type=\"dielectric\"/>"))));
    assert_eq!(report(&scene), "");
    assert_eq!([0, 1, 2].map(|shape| within(&scene, shape)), [Some("fog"), Some("fog"), None]);
    // The control: the sensor stands beside a smaller room, whose fog is around it all the same.
    let scene = read(&document(VOLPATH, IN_FOG, &format!("{FOG}{}{beside}", room(3.0))));
    assert_eq!(within(&scene, 1), Some("fog"));
    assert!(report(&scene).contains("no medium outside of a shape"), "{}", report(&scene));
}

/// Around shapes of a group that instances place is the sensor's medium.
#[test]
fn groups_hold_media() {
    let cube = |within: &str| format!("<shape type=\"cube\"><boolean name=\"flip_normals\" value=\"true\"/>{within}</shape>");
    let group = format!(
        "<shape type=\"shapegroup\" id=\"g\">{}{}</shape>",
        cube(GLASS),
        cube("<ref id=\"glass\"/><ref name=\"interior\" id=\"milk\"/><ref name=\"exterior\" id=\"fog\"/>")
    );
    let instances: String = (0..100)
        .map(|x| {
            format!(
                "<shape type=\"instance\"><ref id=\"g\"/><transform name=\"to_world\"><translate x=\"{}\"/></transform></shape>",
                3 * x
            )
        })
        .collect();
    let holds = |of_sensor: &str| {
        let scene = read(&document(VOLPATH, of_sensor, &format!("{FOG}{group}{instances}")));
        assert_eq!((scene.groups.len(), scene.shapes.len()), (1, 0));
        let interior = |shape: usize| {
            let interior = scene.materials[scene.groups[0].shapes[shape].material].interior;
            interior.map(|id| scene.media[id].name.clone())
        };
        ([interior(0), interior(1)].map(Option::unwrap_or_default), report(&scene))
    };
    assert_eq!(holds(IN_FOG), (["fog", "milk"].map(str::to_owned), String::new()));
    // The control: without fog around the sensor it is not around the group.
    let (interiors, report) = holds("");
    assert_eq!(interiors, ["", "milk"].map(str::to_owned));
    assert!(report.contains("exterior medium of a shape"), "{report}");
}

#[test]
fn integrators_that_see_no_media_leave_them_out() {
    let shapes = format!("{FOG}{}", ball(1.0, &format!("{GLASS}{MILK}")));
    for integrator in ["path", "direct"] {
        let scene = read(&document(&format!("<integrator type=\"{integrator}\"/>"), IN_FOG, &shapes));
        assert_eq!((within(&scene, 0), scene.camera_medium, scene.media.len()), (None, None, 0), "{integrator}");
        assert!(report(&scene).contains(&format!("medium beside integrator `{integrator}`")), "{}", report(&scene));
    }
    for integrator in ["volpath", "volpathmis", "prbvolpath"] {
        let text = format!(
            "<integrator type=\"{integrator}\"><integer name=\"max_depth\" value=\"7\"/><integer name=\"rr_depth\" value=\"9\"/></integrator>"
        );
        let scene = read(&document(&text, "", &shapes));
        assert_eq!(within(&scene, 0), Some("milk"), "{integrator}");
        assert_eq!(
            (scene.render.max_depth, scene.render.roulette_depth, report(&scene).as_str()),
            (7, NumberOrAuto::Number(9), ""),
            "{integrator}"
        );
    }
    let around = "<integrator type=\"aov\"><integrator type=\"volpath\"/></integrator>";
    assert_eq!(within(&read(&document(around, "", &shapes)), 0), Some("milk"));
    assert_eq!(within(&read(&document("", "", &shapes)), 0), Some("milk"), "a file that names no integrator");
}

#[test]
fn surfaces_around_media() {
    let of = |bsdf: &str| read(&document(VOLPATH, "", &format!("{FOG}{}", ball(1.0, &format!("{bsdf}{MILK}")))));
    let mask = of("<bsdf type=\"mask\"><float name=\"opacity\" value=\"0.5\"/><bsdf type=\"dielectric\"/></bsdf>");
    assert!(matches!(mask.materials[mask.shapes[0].material].kind, MaterialKind::Blend { .. }));
    assert_eq!((within(&mask, 0), report(&mask).as_str()), (Some("milk"), ""));
    assert_eq!(within(&of("<bsdf type=\"twosided\"><bsdf type=\"diffuse\"/></bsdf>"), 0), Some("milk"));
    let thin = of("<bsdf type=\"thindielectric\"/>");
    assert!(matches!(thin.materials[thin.shapes[0].material].kind, MaterialKind::Blend { .. }));
    assert_eq!((within(&thin, 0), report(&thin).as_str()), (Some("milk"), ""));
    let tinted = of("<bsdf type=\"thindielectric\"><rgb name=\"specular_transmittance\" value=\"0.5\"/></bsdf>");
    assert!(report(&tinted).contains("thin wall around a medium"), "{}", report(&tinted));
    // Without a BSDF it is an opaque surface in version 3.9.1, and was the boundary alone in 0.6.
    let bare = of("");
    assert!(matches!(bare.materials[bare.shapes[0].material].kind, MaterialKind::Diffuse { .. }));
    assert!(report(&bare).contains("medium of a shape without a BSDF"), "{}", report(&bare));
    let text = document(VOLPATH, "", &format!("{FOG}{}", ball(1.0, MILK))).replace("version=\"3.0.0\"", "version=\"0.6.0\"");
    let old = read(&text);
    assert!(matches!(old.materials[old.shapes[0].material].kind, MaterialKind::Pass) && within(&old, 0) == Some("milk"));
}

/// The density is divided by the scale of an import, names get its prefix, and its camera keeps its medium.
#[test]
fn imported_media_keep_their_optical_depth() {
    let folder = tempdir().unwrap();
    let shapes = format!("{FOG}<shape type=\"cube\">{GLASS}{MILK}<ref name=\"exterior\" id=\"fog\"/></shape>");
    std::fs::write(folder.path().join("a.xml"), document(VOLPATH, IN_FOG, &shapes)).unwrap();
    let read = |transform: &str| {
        let path = folder.path().join("b.toml");
        std::fs::write(&path, format!("[[import]]\nfile = \"a.xml\"\n{transform}")).unwrap();
        load_with(Some(OsStr::new(&path)), &LoadOptions::default()).unwrap_or_else(|error| panic!("{error}"))
    };
    let plain = read("");
    let names: Vec<&str> = plain.media.iter().map(|medium| medium.name.as_str()).collect();
    assert_eq!((names, within(&plain, 0)), (vec!["a/fog", "a/milk"], Some("a/milk")));
    assert_eq!(plain.camera_medium, Some(0));
    let scaled = read("transform = [{ scale = 2 }, { rotate = [1, 1, 0], degrees = 30 }]\n");
    near(scaled.media[1].extinction(), [1.5; 3]);
    near(plain.media[1].extinction(), [3.0; 3]);
    assert!(report(&scaled).is_empty());
    let uneven = read("transform = [{ scale = [1, 1, 8] }]\n");
    near(uneven.media[1].extinction(), [1.5; 3]);
    assert!(report(&uneven).contains("media of an import that is scaled unevenly"), "{}", report(&uneven));
}

const CLOUD: &str = "<volume type=\"gridvolume\" name=\"sigma_t\"><string name=\"filename\" value=\"cloud.vol\"/>MORE</volume>";
const TINTS: &str = "<volume type=\"gridvolume\" name=\"albedo\"><string name=\"filename\" value=\"tints.vol\"/></volume>";

/// Light that is lost and light that is scattered, per unit length, at a point.
fn at(medium: &Medium, point: DVec3) -> [Spectrum; 2] {
    let Some(grids) = &medium.grids else { return [medium.extinction(), medium.scattering] };
    let density = grids.density().value_at(point);
    let albedo = grids.albedo().map(|albedo| albedo.value_at(point));
    let scattering = albedo.map_or(medium.scattering, |albedo| medium.extinction() * albedo);
    [medium.extinction() * density, scattering * density]
}

fn grey(value: f64) -> [f64; 3] {
    [value; 3]
}

/// A grid fills the unit cube, or its own box, where `to_world` places it; there is nothing outside.
#[test]
fn densities_of_grids_stand_where_they_do_there() {
    let of = |more: &str, keys: &str| medium("heterogeneous", &(CLOUD.replace("MORE", more) + keys));
    let place = "<transform name=\"to_world\"><scale value=\"4\"/><translate x=\"1\"/></transform>";
    let own_box = "<boolean name=\"use_grid_bbox\" value=\"true\"/>";
    let nearest = "<string name=\"filter_type\" value=\"nearest\"/>";
    let size = DVec3::new(3.0, 2.0, 2.0);
    for within in [DVec3::new(0.1, 0.2, 0.3), DVec3::new(0.5, 0.9, 0.6), DVec3::new(0.95, 0.5, 0.05)] {
        let (smooth, plain) = (cloud().trilinear(within * size).r(), cloud().nearest(within * size).r());
        assert_ne!(smooth, plain);
        let boxed = DVec3::new(-1.0, 0.0, 0.0) + within * DVec3::new(2.0, 1.0, 2.0);
        let move_out = |point: DVec3| point * 4.0 + DVec3::X;
        for (more, point, expected) in [
            (String::new(), within, smooth),
            (nearest.to_owned(), within, plain),
            (place.to_owned(), move_out(within), smooth),
            (own_box.to_owned(), boxed, smooth),
            (format!("{own_box}{place}"), move_out(boxed), smooth),
        ] {
            let medium = of(&more, "<float name=\"scale\" value=\"2\"/><float name=\"albedo\" value=\"0.25\"/>");
            let [extinction, scattering] = at(&medium, point);
            near(extinction, grey(2.0 * expected));
            near(scattering, grey(0.5 * expected));
            near(at(&medium, point + DVec3::splat(50.0))[0], grey(0.0));
        }
    }
    // A density of one colour everywhere is that colour times a number.
    let tinted = medium("heterogeneous", &CLOUD.replace("MORE", own_box).replace("cloud.vol", "tinted.vol"));
    for (z, expected) in [(0.0, [1.0, 0.5, 2.0]), (2.0, [2.0, 1.0, 4.0])] {
        near(at(&tinted, DVec3::new(0.0, 0.5, z))[0], expected);
    }
    // Numbers fill the unit cube alone, wherever that is.
    let unit = medium("heterogeneous", "<rgb name=\"sigma_t\" value=\"1, 2, 3\"/>");
    near(at(&unit, DVec3::splat(0.9))[0], [1.0, 2.0, 3.0]);
    near(at(&unit, DVec3::splat(-0.1))[0], grey(0.0));
    let moved = format!("<volume type=\"constvolume\" name=\"sigma_t\"><float name=\"value\" value=\"2\"/>{place}</volume>");
    let moved = medium("heterogeneous", &moved);
    near(at(&moved, DVec3::splat(3.0))[0], grey(2.0));
    near(at(&moved, DVec3::splat(0.5))[0], grey(0.0));
}

/// An albedo goes on beyond its box as it is at the border, of media that are the same everywhere too.
#[test]
fn albedos_of_grids_go_on() {
    for (plugin, density) in
        [("heterogeneous", CLOUD.replace("MORE", "")), ("homogeneous", "<float name=\"sigma_t\" value=\"4\"/>".to_owned())]
    {
        let medium = medium(plugin, &(density + TINTS));
        let point = DVec3::new(0.3, 0.6, 0.4);
        let [extinction, scattering] = at(&medium, point);
        let albedo = tints().trilinear(point * DVec3::new(1.0, 2.0, 1.0));
        near(scattering, (extinction * albedo).to_rgb());
        assert!(extinction.r() > 0.1 && albedo.r() != albedo.g());
    }
    let everywhere = medium("homogeneous", &format!("<float name=\"sigma_t\" value=\"4\"/>{TINTS}"));
    near(at(&everywhere, DVec3::new(9.0, 9.0, 9.0))[1], [4.0, 2.0, 0.0]);
    near(at(&everywhere, DVec3::new(9.0, -9.0, 9.0))[1], [1.0, 2.0, 3.0]);
}

#[test]
fn what_is_not_exact_of_a_grid_is_reported_and_what_is_wrong_refused() {
    let of = |keys: &str| {
        document(VOLPATH, "", &ball(1.0, &format!("{BODY}<medium type=\"heterogeneous\" name=\"interior\">{keys}</medium>")))
    };
    let turned = "<transform name=\"to_world\"><rotate z=\"1\" angle=\"30\"/></transform>";
    let square = "<transform name=\"to_world\"><rotate z=\"1\" angle=\"90\"/></transform>";
    for (keys, said) in [
        (CLOUD.replace("MORE", turned), "density of a medium that is turned"),
        (CLOUD.replace("MORE", "<string name=\"wrap_mode\" value=\"repeat\"/>"), "wrap_mode `repeat`"),
        (CLOUD.replace("MORE", "<float name=\"unheard_of\" value=\"1\"/>"), "unheard_of"),
        ("<volume type=\"procedural\" name=\"sigma_t\"/>".to_owned(), "volume `procedural`"),
        // The controls: nothing is said of what is exact.
        (CLOUD.replace("MORE", "").replace("cloud.vol", "red.vol"), ""),
        (CLOUD.replace("MORE", square), ""),
        (CLOUD.replace("MORE", "<string name=\"wrap_mode\" value=\"mirror\"/><boolean name=\"raw\" value=\"true\"/>"), ""),
    ] {
        let report = report(&read(&of(&keys)));
        assert!(report.contains(said) && report.is_empty() == said.is_empty(), "{keys}: {report}");
    }
    for (keys, said) in [
        ("<volume type=\"gridvolume\" name=\"sigma_t\"/>".to_owned(), "needs the string `filename`"),
        (CLOUD.replace("MORE", "").replace("cloud.vol", "absent.vol"), "there is no file absent.vol"),
        (CLOUD.replace("MORE", "").replace("cloud.vol", "text.vol"), "does not begin as such a file does"),
        (CLOUD.replace("MORE", "<string name=\"filter_type\" value=\"cubic\"/>"), "trilinear or nearest, not cubic"),
        (CLOUD.replace("MORE", "") + "<float name=\"scale\" value=\"-1\"/>", "-1"),
    ] {
        let message = load(&of(&keys)).expect_err("it is wrong").to_string();
        assert!(message.contains(said) && message.contains("a.xml:1"), "{keys}: {message}");
    }
}

/// Grids move with an import, and what they are per unit length stays in proportion.
#[test]
fn grids_of_an_import_are_moved() {
    let folder = tempdir().unwrap();
    write_volumes(folder.path());
    let cloud = format!("<medium type=\"heterogeneous\" name=\"interior\">{}{TINTS}</medium>", CLOUD.replace("MORE", ""));
    std::fs::write(folder.path().join("a.xml"), document(VOLPATH, "", &ball(1.0, &format!("{BODY}{cloud}")))).unwrap();
    let read = |transform: &str| {
        let path = folder.path().join("b.toml");
        std::fs::write(&path, format!("[[import]]\nfile = \"a.xml\"\n{transform}")).unwrap();
        let scene = load_with(Some(OsStr::new(&path)), &LoadOptions::default()).unwrap_or_else(|error| panic!("{error}"));
        scene.media[0].clone()
    };
    let (plain, moved) = (read(""), read("transform = [{ scale = 2 }, { translate = [0, 5, 0] }]\n"));
    let point = DVec3::new(0.3, 0.6, 0.4);
    let [lost, scattered] = at(&plain, point);
    let there = at(&moved, point * 2.0 + 5.0 * DVec3::Y);
    near(there[0], (lost * 0.5).to_rgb());
    near(there[1], (scattered * 0.5).to_rgb());
    assert!(lost.r() > 0.1);
}
