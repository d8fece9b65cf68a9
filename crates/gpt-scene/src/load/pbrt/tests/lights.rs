//! Cameras, films and lights.

use super::{Folder, SCENE, read, report, valid, whole};
use crate::scene::{Camera, EnvironmentRadiance, Equirectangular, Light, Projection, Scene};
use crate::spectrum::Spectrum;
use glam::DVec3;

fn sphere(scene: &str) -> Scene {
    whole(&scene.replace("MORE", "Shape \"sphere\""))
}

fn vertical(scene: &Scene) -> f64 {
    match scene.camera.projection {
        Projection::Perspective { vertical_fov_degrees } => vertical_fov_degrees,
        Projection::Orthographic { height } => height,
        other => panic!("a window, and not {}", other.name()),
    }
}

#[test]
fn cameras_see_what_they_see_there() {
    let scene = sphere(SCENE);
    assert_eq!(report(&scene), "");
    assert_eq!((scene.film.size, scene.render.max_depth, scene.render.spp), ([40, 30], 4, 2));
    assert_eq!((scene.camera.position, vertical(&scene), scene.camera.stretch), (DVec3::new(0.0, 0.0, 4.0), 40.0, 1.0));
    // Without the mirror, the picture of a left-handed camera is one.
    assert_eq!(sphere(&SCENE.replace("Scale -1 1 1\n", "")).camera.stretch, -1.0);
    // The angle is that of the shorter side: of a picture that is higher than wide, it lies across.
    let high = sphere(&SCENE.replace("xresolution\" 40", "xresolution\" 15"));
    let expected = 2.0 * (2.0 * 20_f64.to_radians().tan()).atan().to_degrees();
    assert!((vertical(&high) - expected).abs() < 1e-12, "{}", vertical(&high));
    assert!((high.camera.stretch - 1.0).abs() < 1e-12);
    let window = sphere(&SCENE.replace("\"float fov\" 40", "\"float fov\" 90 \"float screenwindow\" [ -1 3 0 1 ]"));
    assert!((vertical(&window) - 2.0 * 0.5_f64.atan().to_degrees()).abs() < 1e-12);
    assert!(
        (window.camera.stretch - 4.0 / (40.0 / 30.0)).abs() < 1e-12 && window.camera.shift == [0.25, 0.5],
        "{:?}",
        window.camera
    );
    let flat =
        sphere(&SCENE.replace("\"perspective\" \"float fov\" 40", "\"orthographic\" \"float screenwindow\" [ -2 2 -1 1 ]"));
    assert_eq!(flat.camera.projection, Projection::Orthographic { height: 2.0 });
    let lens = sphere(&SCENE.replace("\"float fov\" 40", "\"float lensradius\" 0.1 \"float focaldistance\" 3"));
    assert_eq!((lens.camera.focus_distance, lens.camera.aperture.map(|aperture| aperture.radius)), (3.0, Some(0.1)));
    assert!(report(&lens).is_empty());
    let refused = SCENE.replace("perspective", "spherical").replace("MORE", "");
    let error = Folder::new(&[("a.pbrt", refused.as_bytes())]).load("a.pbrt").map(|_| ()).expect_err("no such camera");
    assert!(error.message().contains("`spherical`") && error.line() == Some(4), "{error}");
}

/// A panorama of LookAt's frame shows in its middle what pbrt-v4's (cameras.cpp) shows there: the way to -X of the camera's space, which lies to
/// the side of where it looks. Mirrored, it is not mirrored here, which is reported.
#[test]
fn panoramas_look_aside() {
    let mirrored = SCENE.replace("\"perspective\" \"float fov\" 40", "\"spherical\" \"string mapping\" \"equirectangular\"");
    let panorama = mirrored.replace("Scale -1 1 1\n", "");
    let (straight, scene) = (sphere(SCENE), sphere(&panorama));
    assert_eq!(scene.camera.projection, Projection::Equirectangular(Equirectangular::default()));
    let ahead = |camera: &Camera| (camera.look_at - camera.position).normalize();
    let [_, above, _] = straight.camera.frame();
    // LookAt's side is up × forward.
    let middle = -above.cross(ahead(&straight.camera));
    assert!(ahead(&scene.camera).distance(middle) < 1e-9, "{} and not {middle}", ahead(&scene.camera));
    assert!(ahead(&scene.camera).distance(ahead(&straight.camera)) > 1.0, "the control");
    assert_eq!(report(&scene), "");
    assert!(report(&sphere(&mirrored)).contains("mirrored spherical camera"), "{}", report(&sphere(&mirrored)));
}

/// A crop shows its part of the whole picture: the lower right quarter.
#[test]
fn crops_are_parts_of_the_picture() {
    let crops = ["\"float cropwindow\" [ 0.5 1 0.5 1 ]", "\"integer pixelbounds\" [ 20 40 15 30 ]"];
    for crop in crops {
        let scene = sphere(&SCENE.replace("Film \"rgb\"", &format!("Film \"rgb\" {crop}")));
        assert_eq!((scene.film.size, scene.camera.shift), ([20, 15], [0.5, -0.5]), "{crop}");
        let expected = 2.0 * (0.5 * 20_f64.to_radians().tan()).atan().to_degrees();
        assert!((vertical(&scene) - expected).abs() < 1e-12, "{crop}");
    }
}

fn intensity(scene: &Scene) -> Spectrum {
    scene
        .lights
        .iter()
        .rev()
        .find_map(|light| if let Light::Point(light) = light { Some(light.intensity) } else { None })
        .expect("a light")
}

/// The numbers of an `rgb` are those of the picture; every other spectrum has the luminance 1.
#[test]
fn spectra_of_lights_are_normalised_as_there() {
    let of = |parameters: &str| intensity(&valid(&format!("LightSource \"point\" {parameters}\nShape \"sphere\"")));
    assert_eq!(of("\"rgb I\" [ 1 2 3 ]"), Spectrum::new(1.0, 2.0, 3.0));
    assert_eq!(of(""), Spectrum::WHITE);
    assert_eq!(of("\"spectrum I\" \"stdillum-D65\" \"float scale\" 4"), Spectrum::grey(4.0));
    let warm = of("\"blackbody I\" 2800 \"float scale\" 5");
    assert!((warm.luminance() / 5.0 - 1.0).abs() < 1e-3 && warm.r() > 3.0 * warm.b(), "{warm}");
    // Whatever its values are.
    let [dim, bright] = ["\"spectrum I\" [ 300 1 830 1 ]", "\"spectrum I\" [ 300 50 830 50 ]"].map(of);
    assert!(dim.distance(bright) < 1e-9 && (dim.luminance() - 1.0).abs() < 1e-3, "{dim} {bright}");
    // Light of equal energy is not white.
    assert!(dim.r() > 1.15 && dim.b() < 0.95, "{dim}");
    // Power is spread over all directions, whatever the colour is.
    let power = of("\"rgb I\" [ 2 2 2 ] \"float power\" 100");
    assert!((power.r() - 2.0 * 100.0 / (4.0 * std::f64::consts::PI)).abs() < 1e-9, "{power}");
    let green = of("\"rgb I\" [ 0 1 0 ]");
    let other = intensity(&valid("ColorSpace \"rec2020\"\nLightSource \"point\" \"rgb I\" [ 0.5 1 0.5 ]\nShape \"sphere\""));
    assert!(green == Spectrum::new(0.0, 1.0, 0.0) && other.g() > other.r() && other.r() < 0.3, "{other}");
}

#[test]
fn the_exposure_of_the_film_multiplies_all_light() {
    let plain = sphere(SCENE);
    let scene = SCENE
        .replace("Film \"rgb\"", "Film \"rgb\" \"float iso\" 200")
        .replace("\"float fov\" 40", "\"float fov\" 40 \"float shutterclose\" 0.25");
    let more = "AreaLightSource \"diffuse\" \"rgb L\" [ 1 1 1 ]\nShape \"sphere\"\nLightSource \"infinite\" \"rgb L\" [ 2 2 2 ]";
    let exposed = whole(&scene.replace("MORE", more));
    assert_eq!(intensity(&exposed), intensity(&plain) * 0.5);
    assert_eq!(radiance(&exposed), Spectrum::grey(0.5));
    let Some(Light::Environment(sky)) = exposed.lights.iter().find(|light| light.is_environment()) else { panic!("no sky") };
    assert!(matches!(sky.radiance, EnvironmentRadiance::Constant(radiance) if radiance == Spectrum::WHITE), "{:?}", sky.radiance);
    let sensor =
        sphere(&SCENE.replace("Film \"rgb\"", "Film \"rgb\" \"string sensor\" \"canon_eos_5d\" \"float whitebalance\" 5000"));
    assert!(report(&sensor).contains("sensor `canon_eos_5d`") && report(&sensor).contains("whitebalance"), "{}", report(&sensor));
}

/// The radiance of the last shape's material.
fn radiance(scene: &Scene) -> Spectrum {
    let material = &scene.materials[scene.shapes.last().expect("a shape").material];
    match material.emission.as_ref().expect("it gives light").radiance {
        crate::scene::ColorInput::Constant(radiance) => radiance,
        other => panic!("{other:?}"),
    }
}

#[test]
fn surfaces_give_off_their_power() {
    let of = |light: &str, shape: &str| {
        let scene = valid(&format!("AreaLightSource \"diffuse\" {light}\n{shape}"));
        (radiance(&scene).r(), report(&scene))
    };
    let pi = std::f64::consts::PI;
    let sphere = "Shape \"sphere\" \"float radius\" 2";
    assert_eq!(of("\"rgb L\" [ 3 3 3 ]", sphere), (3.0, String::new()));
    let (found, _) = of("\"float power\" 10", sphere);
    assert!((found - 10.0 / (pi * 16.0 * pi)).abs() < 1e-12, "{found}");
    let (both, _) = of("\"float power\" 10 \"bool twosided\" true", sphere);
    assert!((both - 0.5 * found).abs() < 1e-12, "{both}");
    // Each triangle there is a light of its own.
    let square = "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 1 1 0 0 1 0 ] \"integer indices\" [ 0 1 2 0 2 3 ]";
    let (found, said) = of("\"float power\" 10", square);
    assert!((found - 10.0 / (pi * 0.5)).abs() < 1e-9 && said.is_empty(), "{found} {said}");
    let uneven = square.replace("0 1 0 ]", "0 3 0 ]");
    assert!(of("\"float power\" 10", &uneven).1.contains("triangles of different sizes"));
}

#[test]
fn lights_stand_where_transforms_put_them() {
    let scene = valid(
        "Translate 0 5 0\nLightSource \"spot\" \"point3 from\" [ 1 0 0 ] \"point3 to\" [ 1 -1 0 ] \"float coneangle\" 40 \"float conedeltaangle\" 10\n\
         Rotate 90 1 0 0\nLightSource \"distant\" \"rgb L\" [ 1 2 3 ] \"point3 to\" [ 0 1 0 ] \"float illuminance\" 2\nShape \"sphere\"",
    );
    let Light::Spot(spot) = &scene.lights[1] else { panic!("{:?}", scene.lights) };
    assert_eq!((spot.position, spot.direction), (DVec3::new(1.0, 5.0, 0.0), DVec3::NEG_Y));
    assert_eq!((spot.angle_degrees, spot.falloff_degrees), (40.0, 30.0));
    let Light::Directional(sun) = &scene.lights[2] else { panic!("{:?}", scene.lights) };
    assert!(sun.direction.distance(DVec3::Z) < 1e-12 && sun.irradiance == Spectrum::new(2.0, 4.0, 6.0), "{sun:?}");
}

/// All light from everywhere is one environment.
#[test]
fn infinite_lights_are_added() {
    let both = "LightSource \"infinite\" \"rgb L\" [ 1 0 0 ]\nLightSource \"infinite\" \"rgb L\" [ 0 2 0 ] \"float illuminance\" 3\nShape \"sphere\"";
    let scene = valid(both);
    let skies: Vec<&Light> = scene.lights.iter().filter(|light| light.is_environment()).collect();
    let [Light::Environment(sky)] = skies[..] else { panic!("{skies:?}") };
    let EnvironmentRadiance::Constant(found) = sky.radiance else { panic!("{sky:?}") };
    assert!(found.distance(Spectrum::new(1.0, 6.0 / std::f64::consts::PI, 0.0)) < 1e-9, "{found}");
    let more = "LightSource \"infinite\" \"string filename\" \"sky.png\"\nShape \"sphere\"";
    let load = |width: u32| {
        let folder = Folder::new(&[("a.pbrt", SCENE.replace("MORE", more).as_bytes())]);
        image::RgbImage::from_pixel(width, 8, image::Rgb([255; 3])).save(folder.path("sky.png")).expect("a picture");
        folder.load("a.pbrt")
    };
    let scene = load(8).unwrap_or_else(|error| panic!("{error}"));
    assert!(report(&scene).contains("resampled to a lat-long map of 32 x 16"), "{}", report(&scene));
    let Some(Light::Environment(sky)) = scene.lights.iter().find(|light| light.is_environment()) else { panic!("no sky") };
    let EnvironmentRadiance::Map(map) = &sky.radiance else { panic!("{sky:?}") };
    assert!(map.texels.colors().all(|texel| (texel - 1.0).abs().max_element() < 1e-3));
    let error = load(16).map(|_| ()).expect_err("it is no square");
    assert!(error.message().contains("square") && error.line() == Some(11), "{error}");
    let portal = valid("LightSource \"infinite\" \"point3 portal\" [ 0 0 0 1 0 0 1 1 0 0 1 0 ]\nShape \"sphere\"");
    assert!(report(&portal).contains("portal") && portal.shapes.iter().any(|shape| shape.portal), "{}", report(&portal));
}

#[test]
fn what_moves_is_where_it_is_at_each_time() {
    let moving = "TransformTimes 1 3\nCamera";
    let scene = SCENE
        .replace("Camera", moving)
        .replace("\"float fov\" 40", "\"float fov\" 40 \"float shutteropen\" 1 \"float shutterclose\" 2");
    let more = "AttributeBegin\nTranslate 1 0 0\nActiveTransform EndTime\nTranslate 2 0 0\nRotate 90 0 0 1\nActiveTransform All\n\
                Shape \"sphere\" \"float radius\" 0.5\nAttributeEnd\nShape \"disk\"";
    let scene = whole(&scene.replace("MORE", more));
    assert_eq!((report(&scene).as_str(), scene.camera.shutter), ("", [0.0, 0.5]));
    let [ball, disk] = &scene.shapes[..] else { panic!("two shapes") };
    assert!(disk.motion.is_none());
    let motion = ball.motion.as_ref().expect("it moves");
    let rest = ball.transform.to_affine();
    let origin = rest.translation;
    let end = motion.at(1.0, origin) * rest;
    assert!(end.translation.distance(DVec3::new(3.0, 0.0, 0.0)) < 1e-9, "{end:?}");
    assert!(end.transform_vector3(DVec3::X).distance(DVec3::Y) < 1e-9, "{end:?}");
    let half = motion.at(0.5, origin) * rest;
    assert!(half.translation.distance(DVec3::new(2.0, 0.0, 0.0)) < 1e-9, "{half:?}");
    assert!(read("ActiveTransform Never").is_err());
}

#[test]
fn a_moving_camera_is_told() {
    let scene = SCENE.replace("Camera", "ActiveTransform EndTime\nTranslate 1 0 0\nActiveTransform All\nCamera");
    let scene = sphere(&scene);
    assert!(report(&scene).contains("motion of the camera"), "{}", report(&scene));
    assert_eq!(scene.camera.position, DVec3::new(0.0, 0.0, 4.0));
    let later = scene.at_frame(1.0).expect("it has keyframes");
    assert!((later.camera.position.x.abs() - 1.0).abs() < 1e-9, "{:?}", later.camera.position);
}
