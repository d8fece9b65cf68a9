use std::sync::Arc;

use glam::{DVec2, DVec3, Vec3};

use super::*;
use crate::scene::{
    BlendWeight, ColorInput, Emission, ImageData, ImageTexture, Material, Texture, TextureFilter, TextureKind, TextureWrap,
};
use crate::spectrum::Spectrum;

/// A scene of one material that emits what an image shows.
fn textured_light(image: ImageTexture, rotation_degrees: f64) -> Scene {
    let mut texture = Texture::new("picture", TextureKind::Image(image));
    texture.transform.rotation_degrees = rotation_degrees;
    let emission = Some(Emission { radiance: ColorInput::ScaledTexture(0, Spectrum::grey(2.0)), two_sided: false });
    let material = Material {
        name: "light".into(),
        kind: MaterialKind::Emissive,
        normal_map: None,
        emission,
        two_sided: true,
        interior: None,
    };
    let mut scene = Scene { textures: vec![texture], materials: vec![material], ..Scene::default() };
    let quad = crate::scene::Rectangle { corner: DVec3::ZERO, edge_u: DVec3::X, edge_v: DVec3::Y };
    scene.shapes.push(crate::scene::Shape {
        label: "light".into(),
        geometry: crate::scene::Geometry::Rectangle(quad),
        material: 0,
        transform: crate::scene::Transform::default(),
        motion: None,
        portal: false,
        receiver: 0,
    });
    scene
}

fn image(size: [u32; 2], filter: TextureFilter, wrap: [TextureWrap; 2], texel: impl Fn(u32, u32) -> f32) -> ImageTexture {
    let [width, height] = size;
    let texels: Vec<Vec3> =
        (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| Vec3::splat(texel(x, y))).collect();
    let image = Arc::new(ImageData { width, height, texels: texels.into(), has_alpha: false });
    ImageTexture { image, wrap, filter, scale: [1.0, 1.0] }
}

fn noise(x: u32, y: u32) -> f32 {
    (crate::sampling::hash::mix(x + 97 * y) % 1000) as f32 / 1000.0
}

fn part(corners: [DVec2; 3]) -> EmitterPart {
    EmitterPart::Triangle(corners.map(Coordinates::from))
}

const EACH: [(TextureFilter, [TextureWrap; 2]); 5] = [
    (TextureFilter::Nearest, [TextureWrap::Clamp; 2]),
    (TextureFilter::Bilinear, [TextureWrap::Repeat; 2]),
    (TextureFilter::Bilinear, [TextureWrap::Clamp; 2]),
    (TextureFilter::Bilinear, [TextureWrap::Mirror; 2]),
    (TextureFilter::Bilinear, [TextureWrap::Clamp, TextureWrap::Mirror]),
];

/// By the midpoint rule over what the reference looks up.
#[test]
fn means_are_those_of_what_is_looked_up() {
    let triangle = [DVec2::new(0.13, 0.2), DVec2::new(0.9, 0.31), DVec2::new(0.4, 1.17)];
    for ((filter, wrap), turn) in EACH.into_iter().flat_map(|each| [(each, 0.0), (each, 30.0)]) {
        let scene = textured_light(image([7, 5], filter, wrap, noise), turn);
        let maps = EmissionMaps::new(&scene);
        let expected = mean_by_points(&triangle, |uv| 2.0 * crate::texture::look_up(&scene.textures, 0, uv).r());
        let mean = maps.luminance(0, &part(triangle)).expect("it is an image");
        assert!((mean / expected - 1.0).abs() < 5e-3, "{filter:?} {wrap:?} {turn}: {mean} and {expected}");
    }
}

/// A part that touches the one bright texel of a large picture, however large or small it is, is known to emit, and parts add up to the whole.
#[test]
fn no_texel_is_overlooked() {
    let scene = textured_light(
        image([900, 700], TextureFilter::Nearest, [TextureWrap::Repeat; 2], |x, y| f32::from(u8::from((x, y) == (431, 77)))),
        0.0,
    );
    let maps = EmissionMaps::new(&scene);
    let whole = maps.luminance(0, &EmitterPart::Whole(Unrolled::Evenly)).expect("it is an image");
    assert!((whole / (2.0 / 630_000.0) - 1.0).abs() < 1e-9, "{whole}");
    let [a, b, c, d] = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];
    let halves = [[a, b, c], [a, c, d]].map(|corners| maps.luminance(0, &part(corners)).expect("it is an image"));
    assert!((0.5 * (halves[0] + halves[1]) / whole - 1.0).abs() < 1e-6, "{halves:?}");
    assert!(halves[1] > 0.9 * 2.0 * whole && halves[0] < 0.1 * 2.0 * whole, "the texel is above the diagonal: {halves:?}");
    let texel = DVec2::new(431.5 / 900.0, 1.0 - 77.5 / 700.0);
    assert_eq!(maps.luminance(0, &part([texel; 3])), Some(2.0), "a part without area shows a texel");
    assert_eq!(maps.luminance(0, &part([texel + 0.2; 3])), Some(0.0));
    // Over so many repetitions only the whole counts.
    assert_eq!(maps.luminance(0, &part([a, 1e6 * b, 1e6 * d])), None);
    assert_eq!(EmissionMaps::default().luminance(0, &part([a, b, c])), None);
}

/// The density is high where it is bright, positive wherever anything shines, and 0 elsewhere; rectangles that emit evenly have none.
#[test]
fn rectangles_are_drawn_by_what_they_show() {
    let bright = |x: u32, y: u32| f32::from(u8::from((x, y) == (2, 1)));
    for (filter, wrap) in EACH {
        let scene = textured_light(image([8, 8], filter, wrap, bright), 0.0);
        let maps = EmissionMaps::new(&scene);
        let warp = maps.warp(0, Unrolled::Evenly).expect("it emits unevenly");
        let at = |x: f64, y: f64| warp.density((x + 0.5) / 8.0, 1.0 - (y + 0.5) / 8.0);
        assert!(at(2.0, 1.0) > 15.0, "{filter:?}: {}", at(2.0, 1.0));
        for (x, y) in (0..64).flat_map(|x| (0..64).map(move |y| (f64::from(x) / 8.0 - 0.4, f64::from(y) / 8.0 - 0.4))) {
            let uv = DVec2::new((x + 0.5) / 8.0, 1.0 - (y + 0.5) / 8.0);
            let shines = crate::texture::look_up(&scene.textures, 0, uv).r() > 0.0;
            assert!(at(x, y) > 0.0 || !shines, "{filter:?}: {x} {y}");
        }
        assert_eq!(at(6.0, 6.0), 0.0);
        let even = textured_light(image([8, 8], filter, wrap, |x, y| 0.5 + 0.5 * noise(x, y)), 0.0);
        assert!(EmissionMaps::new(&even).warp(0, Unrolled::Evenly).is_none());
    }
    let black = textured_light(image([2, 2], TextureFilter::Nearest, [TextureWrap::Clamp; 2], |_, _| 0.0), 0.0);
    assert!(EmissionMaps::new(&black).warp(0, Unrolled::Evenly).is_none());
}

/// The emission is no image alone: a checker, noise, a product, corners' colours, and a blend. The truth is
/// the midpoint rule over what the reference looks up.
#[test]
fn functions_are_looked_at_in_points() {
    let triangle = [DVec2::new(0.13, 0.2), DVec2::new(0.9, 0.31), DVec2::new(0.4, 0.97)];
    let (a, b) = (Spectrum::grey(0.1), Spectrum::grey(3.0));
    let checker = TextureKind::Checker { a, b, scale: [3.0, 5.0] };
    let kinds = [
        checker.clone(),
        TextureKind::Perlin { scale: 4.0, octaves: 3, a, b, seed: 5 },
        TextureKind::Worley { scale: 6.0, a, b, seed: 1 },
    ];
    for (index, is_product) in (0..kinds.len()).flat_map(|index| [(index, false), (index, true)]) {
        let mut scene = textured_light(image([7, 5], TextureFilter::Bilinear, [TextureWrap::Repeat; 2], noise), 0.0);
        scene.textures.push(Texture::new("other", scene.textures[0].kind.clone()));
        scene.textures[0].kind = kinds[index].clone();
        scene.textures[0].times = is_product.then_some(1);
        let maps = EmissionMaps::new(&scene);
        let at = |uv: DVec2| 2.0 * crate::texture::look_up(&scene.textures, 0, uv).r();
        let expected = mean_by_points(&triangle, at);
        let found = maps.luminance(0, &part(triangle)).expect("it varies");
        let floor = 0.005 * 2.0 * crate::scene::texture::mean_of_texture(&scene.textures, 0).r();
        assert!((found - floor - expected).abs() < 0.02 * expected, "{index} {is_product}: {found} and {expected}");
        // The points of a sphere are even by area.
        let steps = 400;
        let places = (0..steps).flat_map(|i| (0..steps).map(move |j| (i, j)));
        let middle = |index: u32| (f64::from(index) + 0.5) / f64::from(steps);
        let over_area = |(i, j)| {
            let v = middle(j);
            (at(DVec2::new(middle(i), v)) * (std::f64::consts::PI * v).sin(), (std::f64::consts::PI * v).sin())
        };
        let (sum, area) = places.map(over_area).fold((0.0, 0.0), |sum, (value, area)| (sum.0 + value, sum.1 + area));
        let found = maps.luminance(0, &EmitterPart::Whole(Unrolled::Sphere)).expect("it varies");
        assert!((found - floor - sum / area).abs() < 0.02 * sum / area, "{index} {is_product}: {found} and {}", sum / area);
    }
}

/// A spot that lies between the points that are looked at is given up to chance, but nothing has the density 0; a spot that is seen is drawn.
#[test]
fn no_point_of_a_function_has_density_0() {
    let black = |name: &str| Material {
        name: name.into(),
        kind: MaterialKind::Emissive,
        normal_map: None,
        emission: None,
        two_sided: true,
        interior: None,
    };
    let blend = |size: u32| {
        let mut scene = textured_light(
            image([size, size], TextureFilter::Nearest, [TextureWrap::Clamp; 2], |x, y| f32::from(u8::from((x, y) == (2, 1)))),
            0.0,
        );
        scene.materials[0].emission = Some(Emission { radiance: ColorInput::grey(7.0), two_sided: false });
        scene.materials.push(black("black"));
        let weight = BlendWeight::Texture { texture: 0 };
        scene.materials.push(Material { kind: MaterialKind::Blend { materials: [0, 1], weight }, ..black("blend") });
        scene
    };
    let scene = blend(8);
    let maps = EmissionMaps::new(&scene);
    let warp = maps.warp(2, Unrolled::Evenly).expect("it emits unevenly");
    assert!(warp.density(2.5 / 8.0, 1.0 - 1.5 / 8.0) > 30.0);
    assert!(warp.densities.iter().all(|&density| density > 0.0));
    let on_sphere = maps.warp(2, Unrolled::Sphere).expect("it emits unevenly");
    assert!(on_sphere.density(2.5 / 8.0, 1.0 - 1.5 / 8.0) > 20.0 && on_sphere.densities.iter().all(|&density| density > 0.0));
    assert!(maps.map(0).is_none() && maps.map(1).is_none(), "what is the same everywhere is not looked at");
    let scene = blend(5000);
    let maps = EmissionMaps::new(&scene);
    assert!(maps.warp(2, Unrolled::Evenly).is_none() && maps.luminance(2, &EmitterPart::Whole(Unrolled::Evenly)) > Some(0.0));
}

/// Bands of a sphere: below each lies what its lower border says, all of them together are the whole, and points in each are even over its area.
#[test]
fn spheres_are_unrolled_by_area() {
    let below = |v: f64| Unrolled::Sphere.area_below(v, 6);
    for row in 0..=6 {
        let v = f64::from(row) / 6.0;
        assert!((below(v).0 - 0.5 * (1.0 - (std::f64::consts::PI * v).cos())).abs() < 1e-12);
        assert!((Unrolled::Sphere.uv(DVec2::new(0.4, below(v).0)) - DVec2::new(0.4, v)).length() < 1e-7);
    }
    let areas = (0..6).map(|row| below((f64::from(row) + 0.5) / 6.0).1);
    assert!((areas.sum::<f64>() / 6.0 - 1.0).abs() < 1e-12);
    let middle = 0.5 * (below(2.0 / 6.0).0 + below(2.999_999_999_9 / 6.0).0);
    assert!((below(2.5 / 6.0).0 - middle).abs() < 1e-9);
}

fn mean_by_points(triangle: &[DVec2; 3], at: impl Fn(DVec2) -> f64) -> f64 {
    let steps = 300;
    let middle = |index: u32| (f64::from(index) + 0.5) / f64::from(steps);
    let places = (0..steps).flat_map(|i| (0..steps).map(move |j| (middle(i), middle(j)))).filter(|(u, v)| u + v < 1.0);
    let values: Vec<f64> =
        places.map(|(u, v)| at(triangle[0] + u * (triangle[1] - triangle[0]) + v * (triangle[2] - triangle[0]))).collect();
    values.iter().sum::<f64>() / values.len() as f64
}
