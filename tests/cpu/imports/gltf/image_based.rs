//! EXT_lights_image_based: which picture is where, what its numbers mean, and what stands in where it cannot be read.

use glam::{DMat3, DVec3};
use gpt::scene::{Environment, EnvironmentRadiance, Light, Scene};
use serde_json::{Value, json};

use super::{File, report};

/// A picture of four quarters: the corner at the top left, at the top right, at the bottom left and at the bottom right.
fn quarters(colours: [[u8; 4]; 4], has_alpha: bool) -> Vec<u8> {
    const SIDE: u32 = 16;
    let at = |x: u32, y: u32| colours[(2 * (2 * y / SIDE) + 2 * x / SIDE) as usize];
    let picture = image::RgbaImage::from_fn(SIDE, SIDE, |x, y| image::Rgba(at(x, y)));
    let picture = image::DynamicImage::ImageRgba8(picture);
    let picture = if has_alpha { picture } else { picture.into_rgb8().into() };
    let mut bytes = std::io::Cursor::new(Vec::new());
    picture.write_to(&mut bytes, image::ImageFormat::Png).expect("it is written");
    bytes.into_inner()
}

/// The colour of a quarter of a face: all of them differ.
fn colour(face: usize, quarter: usize) -> [u8; 4] {
    [40 + 35 * face as u8, 50 * quarter as u8 + 60, 255, 255]
}

fn lit(change: impl Fn(&mut Value), picture: impl Fn(usize) -> Vec<u8>) -> File {
    let mut file = File::new();
    let images: Vec<Value> = (0..6)
        .map(|face| {
            let view = file.bytes(&picture(face));
            json!({ "bufferView": view, "mimeType": "image/png" })
        })
        .collect();
    file.root["images"] = json!(images);
    let mut light =
        json!({ "specularImages": [[0, 1, 2, 3, 4, 5]], "specularImageSize": 16, "irradianceCoefficients": vec![[0.0; 3]; 9] });
    change(&mut light);
    file.root["extensions"]["EXT_lights_image_based"] = json!({ "lights": [light] });
    file.root["scenes"][0]["extensions"] = json!({ "EXT_lights_image_based": { "light": 0 } });
    file.root["extensionsUsed"] = json!(["KHR_lights_punctual", "KHR_materials_specular", "EXT_lights_image_based"]);
    file.root["extensionsRequired"] = json!(["EXT_lights_image_based"]);
    file
}

fn environment(scene: &Scene) -> &Environment {
    let found = scene.lights.iter().find_map(|light| if let Light::Environment(found) = light { Some(found) } else { None });
    found.expect("an environment")
}

/// The map's texel in a direction of its own space.
fn towards(environment: &Environment, direction: DVec3) -> [f64; 3] {
    let EnvironmentRadiance::Map(map) = &environment.radiance else { panic!("no map") };
    let direction = direction.normalize();
    let u = (direction.x.atan2(-direction.z) / std::f64::consts::TAU).rem_euclid(1.0);
    let v = direction.y.acos() / std::f64::consts::PI;
    let place = |share: f64, side: u32| ((share * f64::from(side)) as u32).min(side - 1);
    map.texels.color((place(v, map.height) * map.width + place(u, map.width)) as usize).to_array().map(f64::from)
}

fn linear(byte: u8) -> f64 {
    let encoded = f64::from(byte) / 255.0;
    if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

/// The way that each face is at, and the way up in its picture, as cube maps have them.
const FACES: [(DVec3, DVec3); 6] = [
    (DVec3::X, DVec3::Y),
    (DVec3::NEG_X, DVec3::Y),
    (DVec3::Y, DVec3::NEG_Z),
    (DVec3::NEG_Y, DVec3::Z),
    (DVec3::Z, DVec3::Y),
    (DVec3::NEG_Z, DVec3::Y),
];

/// Quarters that are not where they are seen from within, upright and not mirrored.
fn misplaced(scene: &Scene) -> Vec<(usize, usize)> {
    let mut found = Vec::new();
    for (face, (forward, up)) in FACES.into_iter().enumerate() {
        let right = forward.cross(up);
        for quarter in 0..4 {
            let [down, across] = [quarter / 2, quarter % 2].map(|far| f64::from(far as u32 * 2) - 1.0);
            let seen = towards(environment(scene), forward + 0.4 * across * right - 0.4 * down * up);
            let [r, g, b, _] = colour(face, quarter);
            if seen.iter().zip([r, g, b].map(linear)).any(|(seen, expected)| (seen - expected).abs() > 1e-3) {
                found.push((face, quarter));
            }
        }
    }
    found
}

fn coloured(face: usize) -> Vec<u8> {
    quarters([0, 1, 2, 3].map(|quarter| colour(face, quarter)), false)
}

#[test]
fn each_of_six_pictures_is_seen_upright_on_its_side() {
    let scene = lit(|_| {}, coloured).read();
    assert_eq!(misplaced(&scene), []);
    let said = report(&scene);
    assert!(said.contains("specularImages") && said.contains("irradianceCoefficients"), "{said}");
    // The control: two faces exchanged, and one mirrored.
    let exchanged = lit(|light| light["specularImages"] = json!([[1, 0, 2, 3, 4, 5]]), coloured).read();
    assert_eq!(misplaced(&exchanged).len(), 8);
    let mirrored = lit(
        |_| {},
        |face| quarters([1, 0, 3, 2].map(|quarter| colour(face, if face == 2 { quarter } else { quarter ^ 1 })), false),
    )
    .read();
    assert_eq!(misplaced(&mirrored).len(), 4);
}

#[test]
fn rotation_turns_the_light_and_intensity_scales_it() {
    // By a right angle about +Y: the picture of +Z is seen towards +X.
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let change = |light: &mut Value| {
        light["rotation"] = json!([0.0, half, 0.0, half]);
        light["intensity"] = json!(3.0);
    };
    let turned = lit(change, coloured).read();
    let (plain, found) = (lit(|_| {}, coloured).read(), environment(&turned));
    let turn = found.turn.expect("it is turned");
    assert!((turn * DVec3::Z - DVec3::X).length() < 1e-12, "{turn}");
    let seen = towards(found, turn.transpose() * DVec3::new(1.0, 0.3, 0.2));
    let expected = towards(environment(&plain), DVec3::new(-0.2, 0.3, 1.0));
    assert!(seen.iter().zip(expected).all(|(seen, expected)| (seen - 3.0 * expected).abs() < 1e-3), "{seen:?} {expected:?}");
    assert_eq!(environment(&plain).turn.unwrap_or(DMat3::IDENTITY), DMat3::IDENTITY);
    // The control: the other way round is another picture.
    assert!((turn.transpose() * DVec3::Z - DVec3::X).length() > 1.0);
}

#[test]
fn colours_with_alpha_are_divided_by_it() {
    let grey = |alpha: u8| move |_: usize| quarters([[128, 64, 32, alpha]; 4], true);
    let [whole, quarter] = [255, 51].map(|alpha| towards(environment(&lit(|_| {}, grey(alpha)).read()), DVec3::ONE));
    let expected = [128, 64, 32].map(linear);
    assert!(whole.iter().zip(expected).all(|(seen, expected)| (seen - expected).abs() < 1e-3), "{whole:?}");
    assert!(quarter.iter().zip(expected).all(|(seen, expected)| (seen - 5.0 * expected).abs() < 5e-3), "{quarter:?}");
}

/// Light has the irradiance that the coefficients say, on surfaces of any direction, where pictures cannot be read.
#[test]
fn coefficients_stand_in_for_pictures_that_cannot_be_read() {
    let coefficients: Vec<[f64; 3]> = (0..9)
        .map(|index| [[9.0, 0.5, -0.4, 0.6, 0.2, 0.1, -0.15, 0.12, 0.2][index], if index == 0 { 4.0 } else { 0.0 }, 0.0])
        .collect();
    let change = |light: &mut Value| light["irradianceCoefficients"] = json!(coefficients);
    let scene = lit(change, |_| b"\xabKTX 20\xbb\r\n\x1a\n".to_vec()).read();
    let said = report(&scene);
    assert!(said.contains("KTX2") && said.contains("irradianceCoefficients"), "{said}");
    let EnvironmentRadiance::Map(map) = &environment(&scene).radiance else { panic!("no map") };
    let irradiance = |normal: DVec3| {
        let mut sum = 0.0;
        for index in 0..map.width * map.height {
            let (x, y) = (index % map.width, index / map.width);
            let (turn, fall) = (
                std::f64::consts::TAU * (f64::from(x) + 0.5) / f64::from(map.width),
                std::f64::consts::PI * (f64::from(y) + 0.5) / f64::from(map.height),
            );
            let direction = DVec3::new(fall.sin() * turn.sin(), fall.cos(), -fall.sin() * turn.cos());
            let area = 2.0 * std::f64::consts::PI.powi(2) * fall.sin() / f64::from(map.width * map.height);
            sum += f64::from(map.texels.color(index as usize).x) * direction.dot(normal).max(0.0) * area;
        }
        sum
    };
    for normal in [DVec3::X, DVec3::NEG_Y, DVec3::new(0.6, 0.0, -0.8), DVec3::new(2.0, 3.0, 6.0) / 7.0] {
        let DVec3 { x, y, z } = normal;
        let basis = [
            0.282_095,
            0.488_603 * y,
            0.488_603 * z,
            0.488_603 * x,
            1.092_548 * x * y,
            1.092_548 * y * z,
            0.315_392 * (3.0 * z * z - 1.0),
            1.092_548 * x * z,
            0.546_274 * (x * x - y * y),
        ];
        let expected: f64 = basis.iter().zip(&coefficients).map(|(value, coefficient)| value * coefficient[0]).sum();
        assert!((irradiance(normal) - expected).abs() < 0.01 * expected, "{normal}: {} {expected}", irradiance(normal));
        // The control: a coefficient left out.
        let without = expected - basis[3] * coefficients[3][0] - basis[1] * coefficients[1][0];
        assert!(x == 0.0 && y == 0.0 || (irradiance(normal) - without).abs() > 0.01 * without, "{normal}");
    }
}

#[test]
fn what_a_light_lacks_is_said_in_a_sentence() {
    let refused = |change: &dyn Fn(&mut Value)| lit(change, coloured).refused();
    assert!(refused(&|light| light["rotation"] = json!([1.0])).contains("its rotation is not of 4 numbers"));
    assert!(refused(&|light| light["intensity"] = json!("bright")).contains("its intensity is no number"));
    let said = refused(&|light| {
        light["specularImages"] = json!([[0, 1]]);
        light["irradianceCoefficients"] = json!([]);
    });
    assert!(said.contains("no six specularImages") && said.contains("no 9 irradianceCoefficients"), "{said}");
    let mut file = lit(|_| {}, coloured);
    file.root["scenes"][0]["extensions"]["EXT_lights_image_based"]["light"] = json!(7);
    assert!(file.refused().contains("there is no EXT_lights_image_based.lights[7]"), "{}", file.refused());
    let levels = lit(|light| light["specularImages"] = json!([[0, 1, 2, 3, 4, 5], [0, 1, 2, 3, 4, 5]]), coloured).read();
    assert!(report(&levels).contains("rough materials"), "{}", report(&levels));
}
