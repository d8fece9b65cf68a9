//! Closed forms of lights: spheres by every strategy, spot and directional lights, maps, skies and portals over a Lambert floor.

use std::f64::consts::PI;
use std::sync::Arc;

use glam::{DVec3, Vec3};
use gpt::scene::*;
use gpt::spectrum::Spectrum;

use super::cases::{ALL, Case, WITH_LIGHT_SAMPLING, at_the_origin, push};
use super::scenes::*;

const ALBEDO: f64 = 0.5;

pub fn all() -> Vec<Case> {
    let mut cases = Vec::new();
    spheres(&mut cases);
    from_points_and_afar(&mut cases);
    maps(&mut cases);
    skies(&mut cases);
    portals(&mut cases);
    cases
}

/// A white floor, of which the camera sees the origin.
fn over_a_floor(spp: u32) -> Scene {
    let mut scene = scene(spp, at_the_origin());
    scene.render.max_depth = 2;
    let white = diffuse(&mut scene, ALBEDO);
    shape(&mut scene, floor(20.0), white);
    scene
}

/// Irradiance πL(R/d)² of a sphere above, whatever its points are drawn by; each from outside and, where it glows inward, from inside: π·L.
fn spheres(cases: &mut Vec<Case>) {
    for strategy in [LightSampling::Visible, LightSampling::Area] {
        let mut scene = over_a_floor(1024);
        scene.render.light_sampling = strategy;
        let mut around = scene.clone();
        let light = emissive(&mut scene, Spectrum::new(1.0, 2.0, 4.0));
        shape(&mut scene, sphere(DVec3::Y, 0.5), light);
        let expected = Spectrum::new(1.0, 2.0, 4.0) * ALBEDO * 0.25;
        push(cases, &format!("sphere light by {strategy:?}"), &scene, expected, &WITH_LIGHT_SAMPLING);
        let light = glowing(&mut around, 0.0, 2.0);
        shape(&mut around, sphere(DVec3::ZERO, 30.0), light);
        push(
            cases,
            &format!("sphere light around, by {strategy:?}"),
            &around,
            Spectrum::grey(2.0 * ALBEDO),
            &WITH_LIGHT_SAMPLING,
        );
    }
}

/// Spot: intensity times its smooth step times cosθ/d². Directional: irradiance times cosθ.
fn from_points_and_afar(cases: &mut Vec<Case>) {
    let intensity = Spectrum::new(3.0, 2.0, 1.0);
    // The floor's point is 20 degrees off the axis; the light is 2 above it, off the vertical by 30 degrees.
    let to_light = DVec3::new(0.5, 0.75_f64.sqrt(), 0.0);
    let axis = DVec3::new(-(50_f64.to_radians().sin()), -(50_f64.to_radians().cos()), 0.0);
    let cosine = |degrees: f64| degrees.to_radians().cos();
    let t = (cosine(20.0) - cosine(35.0)) / (cosine(10.0) - cosine(35.0));
    for (name, angle_degrees, falloff_degrees, curve, share) in [
        ("inside", 45.0, 25.0, FalloffCurve::Smooth, 1.0),
        ("in between", 35.0, 10.0, FalloffCurve::Smooth, t * t * (3.0 - 2.0 * t)),
        ("in between, square", 35.0, 10.0, FalloffCurve::Square, t * t),
        ("in between, linear", 35.0, 10.0, FalloffCurve::Linear, 0.6),
    ] {
        let mut scene = over_a_floor(4);
        let position = to_light * 2.0;
        let spot = SpotLight {
            position,
            direction: axis,
            intensity,
            angle_degrees,
            falloff_degrees,
            curve,
            picture: None,
            profile: None,
        };
        scene.lights.push(Light::Spot(spot));
        let expected = intensity * share * cosine(30.0) / 4.0 * ALBEDO / PI;
        push(cases, &format!("spot light, {name}"), &scene, expected, &WITH_LIGHT_SAMPLING);
    }
    profiles(cases, to_light, intensity);
    // The floor's point is 20 degrees off the axis, to the right or to the left as the light is turned: in the picture 0.5 ± tan 20° / 2 tan 40°.
    let place = 0.5 * 20_f64.to_radians().tan() / 40_f64.to_radians().tan();
    for (side, up) in [(-1.0, DVec3::Z), (1.0, DVec3::NEG_Z)] {
        let mut scene = over_a_floor(4);
        // A ramp from red at the left to green at the right; texels of two columns in the middle interpolate it exactly.
        let ramp = Texels::Float(vec![[1.0, 0.0, 0.5], [0.0, 1.0, 0.5]]);
        let image = Arc::new(ImageData { width: 2, height: 1, texels: ramp, has_alpha: false });
        let (wrap, filter) = ([TextureWrap::Clamp; 2], TextureFilter::Bilinear);
        scene.textures.push(Texture::new("ramp", TextureKind::Image(ImageTexture { image, wrap, filter, scale: [0.5, 1.0] })));
        scene.textures[0].transform.offset = [0.25, 0.0];
        let u = 0.5 + side * place;
        let texel = Spectrum::new(1.0 - u, u, 0.5);
        let position = to_light * 2.0;
        let picture = Some(ProjectedTexture { texture: 0, up });
        let (angle_degrees, falloff_degrees, curve) = (40.0, 40.0, FalloffCurve::Linear);
        scene.lights.push(Light::Spot(SpotLight {
            position,
            direction: axis,
            intensity,
            angle_degrees,
            falloff_degrees,
            curve,
            picture,
            profile: None,
        }));
        let expected = texel * intensity * cosine(30.0) / 4.0 * ALBEDO / PI;
        push(cases, &format!("picture of a spot light, {side}"), &scene, expected, &WITH_LIGHT_SAMPLING);
        scene.lights = vec![Light::Projector(Projector {
            position,
            direction: axis,
            up,
            irradiance: intensity,
            vertical_fov_degrees: 50.0,
            aspect: 40_f64.to_radians().tan() / 25_f64.to_radians().tan(),
            texture: Some(0),
        })];
        let expected = texel * intensity / cosine(20.0).powi(3) * cosine(30.0) / 4.0 * ALBEDO / PI;
        push(cases, &format!("projector, {side}"), &scene, expected, &WITH_LIGHT_SAMPLING);
    }
    let mut scene = over_a_floor(4);
    scene.lights.push(Light::Directional(DirectionalLight { direction: -to_light, irradiance: intensity }));
    push(cases, "directional light", &scene, intensity * cosine(30.0) * ALBEDO / PI, &WITH_LIGHT_SAMPLING);
}

/// Lamps 2 above the floor's point, off the vertical by 30 degrees: candela times cosθ/d².
fn profiles(cases: &mut Vec<Case>, to_light: DVec3, intensity: Spectrum) {
    let profile = |vertical: &[f64], horizontal: &[f64], candela: &[f64]| {
        Arc::new(LightProfile::new(vertical.to_vec(), horizontal.to_vec(), candela.to_vec()).expect("it is possible"))
    };
    let degrees: Vec<f64> = (0..=90).map(f64::from).collect();
    let cosines: Vec<f64> = degrees.iter().map(|angle| angle.to_radians().cos()).collect();
    // The floor's point lies on the side of -X, so many degrees counter-clockwise of the lamp's front, seen from above. No angle of a table is there:
    // a pixel sees both sides of it.
    let turned = |degrees: f64| DVec3::new(-degrees.to_radians().cos(), 0.0, -degrees.to_radians().sin());
    let sides = profile(&[0.0, 60.0], &[0.0, 90.0, 180.0, 270.0, 360.0], &[1.0, 1.0, 1.0, 3.0, 1.0, 5.0, 1.0, 7.0, 1.0, 1.0]);
    let cosine = 30_f64.to_radians().cos();
    for (name, profile, front, candela) in [
        ("even", profile(&[0.0, 180.0], &[0.0], &[2.0, 2.0]), DVec3::X, 2.0),
        ("of a cosine", profile(&degrees, &[0.0], &cosines), DVec3::X, cosine),
        ("between two angles", profile(&[0.0, 20.0, 60.0], &[0.0], &[9.0, 4.0, 8.0]), DVec3::X, 5.0),
        ("20 degrees past its front", sides.clone(), turned(20.0), 1.0 + 2.0 / 9.0),
        ("45 degrees past its front", sides.clone(), turned(45.0), 1.5),
        ("110 degrees past its front", sides.clone(), turned(110.0), 2.0 + 2.0 / 9.0),
        ("200 degrees past its front", sides.clone(), turned(200.0), 3.0 + 2.0 / 9.0),
        ("290 degrees past its front", sides, turned(290.0), 4.0 - 2.0 / 3.0),
    ] {
        let mut scene = over_a_floor(4);
        let position = to_light * 2.0;
        let aimed = Some(AimedProfile { profile, nadir: DVec3::NEG_Y, front });
        scene.lights.push(Light::Point(PointLight { position, intensity, profile: aimed.clone() }));
        let expected = intensity * candela * cosine / 4.0 * ALBEDO / PI;
        push(cases, &format!("profile {name}"), &scene, expected, &WITH_LIGHT_SAMPLING);
        scene.lights = vec![Light::Spot(SpotLight {
            position,
            direction: DVec3::NEG_Y,
            intensity,
            angle_degrees: 50.0,
            falloff_degrees: 10.0,
            curve: FalloffCurve::Linear,
            picture: None,
            profile: aimed,
        })];
        push(cases, &format!("spot light with a profile {name}"), &scene, expected * 0.5, &WITH_LIGHT_SAMPLING);
    }
}

fn map(scene: &mut Scene, width: u32, height: u32, texel: impl Fn(u32, u32) -> f32) {
    let texels: Vec<_> =
        (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| Vec3::splat(texel(x, y))).collect();
    let radiance = EnvironmentRadiance::Map(Arc::new(ImageData { width, height, texels: texels.into(), has_alpha: false }));
    scene.lights.push(Light::Environment(Environment {
        radiance,
        rotation_degrees: 30.0,
        turn: None,
        rows: Default::default(),
        mirrored: false,
    }));
}

/// A constant map is a constant environment; a single bright texel gives the integral of its interpolated light.
fn maps(cases: &mut Vec<Case>) {
    for (width, height) in [(1, 1), (24, 12)] {
        let mut scene = over_a_floor(256);
        map(&mut scene, width, height, |_, _| 2.0);
        push(cases, &format!("constant map of {width} x {height}"), &scene, Spectrum::grey(2.0 * ALBEDO), &ALL);
    }
    let (width, height, column, row) = (16_u32, 8_u32, 0, 1);
    let mut scene = over_a_floor(256);
    map(&mut scene, width, height, |x, y| if (x, y) == (column, row) { 40.0 } else { 0.0 });
    // ∫ L cosθ dω: the texel's tent, one texel to either side, by the midpoint rule.
    let steps = 2000;
    let mut irradiance = 0.0;
    for i in 0..steps {
        let offset = 2.0 * (f64::from(i) + 0.5) / f64::from(steps) - 1.0;
        let polar = PI * (f64::from(row) + 0.5 + offset) / f64::from(height);
        irradiance += (1.0 - offset.abs()) * polar.sin() * polar.cos() * (2.0 / f64::from(steps)) * PI / f64::from(height);
    }
    // Across, the tent's integral is one texel.
    irradiance *= 40.0 * 2.0 * PI / f64::from(width);
    push(cases, "a single bright texel", &scene, Spectrum::grey(irradiance * ALBEDO / PI), &WITH_LIGHT_SAMPLING);
}

/// Upward, ∫ (h + (z − h)y)·y dω = π(h + 2z)/3.
fn skies(cases: &mut Vec<Case>) {
    let (zenith, horizon, ground) = (Spectrum::new(0.3, 0.6, 1.2), Spectrum::new(1.0, 0.8, 0.6), Spectrum::new(0.5, 0.1, 0.1));
    let mut scene = over_a_floor(512);
    scene.lights.push(Light::Sky(Sky { zenith, horizon, ground }));
    push(cases, "sky", &scene, (horizon + zenith * 2.0) / 3.0 * ALBEDO, &ALL);
}

/// Light through a rectangular opening in the ceiling of a black room: the form factor of a point to a rectangle straight above it. The
/// opening is a portal made of two.
fn portals(cases: &mut Vec<Case>) {
    let (half_x, half_z, height, reach) = (0.4, 0.6, 1.0, 4.0);
    let mut scene = over_a_floor(512);
    let black = diffuse(&mut scene, 0.0);
    let ceiling = |from: [f64; 2], to: [f64; 2]| {
        Geometry::Rectangle(Rectangle {
            corner: DVec3::new(from[0], height, from[1]),
            edge_u: DVec3::X * (to[0] - from[0]),
            edge_v: DVec3::Z * (to[1] - from[1]),
        })
    };
    for (from, to) in [
        ([-reach, -reach], [-half_x, reach]),
        ([half_x, -reach], [reach, reach]),
        ([-half_x, -reach], [half_x, -half_z]),
        ([-half_x, half_z], [half_x, reach]),
    ] {
        shape(&mut scene, ceiling(from, to), black);
    }
    for (corner, along) in
        [([-reach, -reach], DVec3::X), ([-reach, reach], DVec3::X), ([-reach, -reach], DVec3::Z), ([reach, -reach], DVec3::Z)]
    {
        let corner = DVec3::new(corner[0], 0.0, corner[1]);
        shape(
            &mut scene,
            Geometry::Rectangle(Rectangle { corner, edge_u: along * (2.0 * reach), edge_v: DVec3::Y * height }),
            black,
        );
    }
    let gone = material(&mut scene, MaterialKind::Pass, None);
    for (from, to) in [([-half_x, -half_z], [0.1, half_z]), ([0.1, -half_z], [half_x, half_z])] {
        shape(&mut scene, ceiling(from, to), gone);
    }
    scene.shapes.iter_mut().for_each(|shape| shape.portal = shape.material == gone);
    let (x, z) = (half_x / height, half_z / height);
    let side = |a: f64, b: f64| a / (1.0 + a * a).sqrt() * (b / (1.0 + a * a).sqrt()).atan();
    let form_factor = 2.0 / PI * (side(x, z) + side(z, x));
    let mut constant = scene.clone();
    environment(&mut constant, 1.0);
    push(cases, "portal, constant", &constant, Spectrum::grey(form_factor * ALBEDO), &WITH_LIGHT_SAMPLING);
    map(&mut scene, 4, 2, |_, _| 1.0);
    push(cases, "portal, map", &scene, Spectrum::grey(form_factor * ALBEDO), &WITH_LIGHT_SAMPLING);
}
