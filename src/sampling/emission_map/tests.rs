use std::sync::Arc;

use glam::{DVec2, DVec3, Vec3};

use super::*;
use crate::scene::{Emission, ImageData, MaterialKind, Texture};

/// A scene of one material that emits what an image shows.
fn lamp(image: ImageTexture, rotation_degrees: f64) -> Scene {
    let mut texture = Texture::new("picture", TextureKind::Image(image));
    texture.transform.rotation_degrees = rotation_degrees;
    let emission = Some(Emission { radiance: ColorInput::ScaledTexture(0, DVec3::splat(2.0)), two_sided: false });
    let material = Material { name: "lamp".into(), kind: MaterialKind::Emissive, normal_map: None, emission, two_sided: true };
    let mut scene = Scene { textures: vec![texture], materials: vec![material], ..Scene::default() };
    let quad = crate::scene::Rectangle { corner: DVec3::ZERO, edge_u: DVec3::X, edge_v: DVec3::Y };
    scene.shapes.push(crate::scene::Shape {
        label: "lamp".into(),
        geometry: crate::scene::Geometry::Rectangle(quad),
        material: 0,
        transform: crate::scene::Transform::default(),
        motion: None,
        portal: false,
    });
    scene
}

fn image(size: [u32; 2], filter: TextureFilter, wrap: TextureWrap, texel: impl Fn(u32, u32) -> f32) -> ImageTexture {
    let [width, height] = size;
    let texels: Vec<Vec3> =
        (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| Vec3::splat(texel(x, y))).collect();
    let image = Arc::new(ImageData { width, height, texels: texels.into(), has_alpha: false });
    ImageTexture { image, wrap, filter, scale: [1.0, 1.0] }
}

fn noise(x: u32, y: u32) -> f32 {
    (crate::sampling::hash::mix(x + 97 * y) % 1000) as f32 / 1000.0
}

const EACH: [(TextureFilter, TextureWrap); 4] = [
    (TextureFilter::Nearest, TextureWrap::Clamp),
    (TextureFilter::Bilinear, TextureWrap::Repeat),
    (TextureFilter::Bilinear, TextureWrap::Clamp),
    (TextureFilter::Bilinear, TextureWrap::Mirror),
];

/// By the midpoint rule over what the reference looks up.
#[test]
fn means_are_those_of_what_is_looked_up() {
    let triangle = [DVec2::new(0.13, 0.2), DVec2::new(0.9, 0.31), DVec2::new(0.4, 1.17)];
    for ((filter, wrap), turn) in EACH.into_iter().flat_map(|each| [(each, 0.0), (each, 30.0)]) {
        let scene = lamp(image([7, 5], filter, wrap, noise), turn);
        let maps = EmissionMaps::new(&scene);
        let steps = 300;
        let middle = |index: u32| (f64::from(index) + 0.5) / f64::from(steps);
        let at = |uv: DVec2| 2.0 * crate::reference::texture::look_up(&scene.textures, 0, uv).x;
        let (mut sum, mut count) = (0.0, 0.0);
        for (i, j) in (0..steps).flat_map(|i| (0..steps).map(move |j| (i, j))) {
            let (u, v) = (middle(i), middle(j));
            if u + v < 1.0 {
                sum += at(triangle[0] + u * (triangle[1] - triangle[0]) + v * (triangle[2] - triangle[0]));
                count += 1.0;
            }
        }
        let mean = maps.luminance(0, &triangle).expect("it is an image");
        assert!((mean / (sum / count) - 1.0).abs() < 5e-3, "{filter:?} {wrap:?} {turn}: {mean} and {}", sum / count);
    }
}

/// A part that touches the one bright texel of a large picture, however large or small it is, is known to be lit, and parts add up to the whole.
#[test]
fn no_texel_is_overlooked() {
    let scene = lamp(
        image([900, 700], TextureFilter::Nearest, TextureWrap::Repeat, |x, y| f32::from(u8::from((x, y) == (431, 77)))),
        0.0,
    );
    let maps = EmissionMaps::new(&scene);
    let whole = maps.luminance(0, &UNIT_SQUARE).expect("it is an image");
    assert!((whole / (2.0 / 630_000.0) - 1.0).abs() < 1e-9, "{whole}");
    let [a, b, c, d] = UNIT_SQUARE;
    let halves = [[a, b, c], [a, c, d]].map(|corners| maps.luminance(0, &corners).expect("it is an image"));
    assert!((0.5 * (halves[0] + halves[1]) / whole - 1.0).abs() < 1e-6, "{halves:?}");
    assert!(halves[1] > 0.9 * 2.0 * whole && halves[0] < 0.1 * 2.0 * whole, "the texel is above the diagonal: {halves:?}");
    let texel = DVec2::new(431.5 / 900.0, 1.0 - 77.5 / 700.0);
    assert_eq!(maps.luminance(0, &[texel; 3]), Some(2.0), "a part without area shows a texel");
    assert_eq!(maps.luminance(0, &[texel + 0.2; 3]), Some(0.0));
    // Over so many repetitions only the whole counts.
    assert_eq!(maps.luminance(0, &[a, 1e6 * b, 1e6 * d]), None);
    assert_eq!(EmissionMaps::default().luminance(0, &UNIT_SQUARE), None);
}

/// The density is high where it is bright, positive wherever anything shines, and 0 elsewhere; rectangles that are lit evenly have none.
#[test]
fn rectangles_are_drawn_by_what_they_show() {
    let bright = |x: u32, y: u32| f32::from(u8::from((x, y) == (2, 1)));
    for (filter, wrap) in EACH {
        let scene = lamp(image([8, 8], filter, wrap, bright), 0.0);
        let maps = EmissionMaps::new(&scene);
        let warp = maps.warp(0).expect("it is lit unevenly");
        let at = |x: f64, y: f64| warp.density((x + 0.5) / 8.0, 1.0 - (y + 0.5) / 8.0);
        assert!(at(2.0, 1.0) > 15.0, "{filter:?}: {}", at(2.0, 1.0));
        for (x, y) in (0..64).flat_map(|x| (0..64).map(move |y| (f64::from(x) / 8.0 - 0.4, f64::from(y) / 8.0 - 0.4))) {
            let uv = DVec2::new((x + 0.5) / 8.0, 1.0 - (y + 0.5) / 8.0);
            let shines = crate::reference::texture::look_up(&scene.textures, 0, uv).x > 0.0;
            assert!(at(x, y) > 0.0 || !shines, "{filter:?}: {x} {y}");
        }
        assert_eq!(at(6.0, 6.0), 0.0);
        let even = lamp(image([8, 8], filter, wrap, |x, y| 0.5 + 0.5 * noise(x, y)), 0.0);
        assert!(EmissionMaps::new(&even).warp(0).is_none());
    }
    let black = lamp(image([2, 2], TextureFilter::Nearest, TextureWrap::Clamp, |_, _| 0.0), 0.0);
    assert!(EmissionMaps::new(&black).warp(0).is_none());
}
