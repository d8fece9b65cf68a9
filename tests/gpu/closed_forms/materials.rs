//! Closed forms of materials and blends: what a uniform environment of 1 shows of them, furnaces, and blended lights.

use std::f64::consts::PI;
use std::sync::Arc;

use glam::{DVec3, Vec2};
use gpt::scene::*;
use gpt::spectrum::Spectrum;

use super::cases::{ALL, Case, push};
use super::scenes::*;

pub fn all() -> Vec<Case> {
    let mut cases = Vec::new();
    at_normal_incidence(&mut cases);
    blends_by_angle(&mut cases);
    blends_with_delta_lobes(&mut cases);
    furnaces_of_blends(&mut cases);
    translucent_surfaces(&mut cases);
    blended_lights(&mut cases);
    volumes(&mut cases);
    nested_media(&mut cases);
    cases
}

const MODES: [BlendMode; 2] = [BlendMode::Mixture, BlendMode::Pick];

/// The case in both modes; picking makes noise of its own.
fn push_modes(cases: &mut Vec<Case>, name: &str, scene: &Scene, expected: Spectrum, estimators: &[Estimator]) {
    for mode in MODES {
        let mut scene = scene.clone();
        scene.render.blend = mode;
        if mode == BlendMode::Pick {
            scene.render.spp *= 2;
        }
        push(cases, &format!("{name}, {mode:?}"), &scene, expected, estimators);
    }
}

fn blend(scene: &mut Scene, first: MaterialId, second: MaterialId, weight: BlendWeight) -> MaterialId {
    material(scene, MaterialKind::Blend { materials: [first, second], weight }, None)
}

fn half() -> BlendWeight {
    BlendWeight::Constant { value: 0.5 }
}

/// A floor under a uniform environment, all round the floor too, whose radiance is the same in all pixels: the camera sees a spot
/// around the origin, at (0.3, 0.3) of the floor's texture coordinates, `degrees` from the normal.
fn spot(spp: u32, degrees: f64) -> Scene {
    let (sine, cosine) = degrees.to_radians().sin_cos();
    let mut scene = scene(spp, camera(DVec3::new(0.6 * sine, cosine, 0.8 * sine) * 3.0, DVec3::ZERO, 0.001));
    environment(&mut scene, 1.0);
    scene
}

fn floor_at_spot(scene: &mut Scene, material: MaterialId) {
    let (edge_u, edge_v) = (DVec3::X * 40.0, -DVec3::Z * 40.0);
    shape(scene, Geometry::Rectangle(Rectangle { corner: -0.3 * (edge_u + edge_v), edge_u, edge_v }), material);
}

/// Seen along the normal, no lobe about the mirror direction is cut by the horizon, and its integral has a closed form.
fn at_normal_incidence(cases: &mut Vec<Case>) {
    let (a, b) = (Spectrum::new(0.6, 0.3, 0.1), Spectrum::new(0.2, 0.5, 0.7));
    let constant = ColorInput::Constant;
    let exponent = ColorInput::grey(12.0);
    let white_metal = |alpha: f64| MaterialKind::Conductor {
        fresnel: ConductorFresnel::Reflectance(constant(Spectrum::WHITE)),
        facets: Microfacets::ggx(ColorInput::grey(alpha)),
        specular_reflectance: ColorInput::grey(1.0),
        film: None,
    };
    let (eta, k) = (Spectrum::new(0.18, 0.42, 1.37), Spectrum::new(3.42, 2.35, 1.77));
    let squared = |color: Spectrum| color * color;
    let [less, more] = [eta - Spectrum::WHITE, eta + Spectrum::WHITE].map(squared);
    let normal_reflectance = (less + k * k) / (more + k * k);
    let smooth_gold = MaterialKind::Conductor {
        fresnel: ConductorFresnel::Complex { eta, k },
        facets: Microfacets::ggx(ColorInput::grey(0.0)),
        specular_reflectance: ColorInput::grey(1.0),
        film: None,
    };
    let glass = |facets| MaterialKind::RoughGlass {
        ior: 1.5,
        facets,
        thin: false,
        reflectance: constant(a),
        transmittance: constant(b),
        film: None,
        dispersion: None,
    };
    let internal = 1.0 - (1.0 - 0.091_777_6) / 2.25;
    let plastic = |nonlinear| MaterialKind::Plastic {
        interface: PlasticInterface::smooth(1.5),
        reflectance: constant(a),
        specular_reflectance: constant(b),
        nonlinear,
    };
    let one = constant(Spectrum::WHITE);
    let facets = Microfacets::ggx(ColorInput::grey(1.0));
    let rough_plate = MaterialKind::RoughGlass {
        ior: 1.5,
        facets,
        reflectance: one,
        transmittance: one,
        thin: true,
        film: None,
        dispersion: None,
    };
    let principled = |base: Spectrum, metallic: f64, roughness: f64, transmission: f64| {
        MaterialKind::Principled(Box::new(plain_principled(base, metallic, roughness, transmission)))
    };
    // The losses of rough metals are in a table, which is right to 0.002; smooth ones lose nothing.
    let compensated = MaterialKind::Principled(Box::new(Principled {
        energy_compensation: true,
        ..plain_principled(Spectrum::WHITE, 1.0, 0.0, 0.0)
    }));
    let fibres = MaterialKind::Principled(Box::new(Principled {
        sheen_color: constant(a),
        sheen_roughness: one,
        ..plain_principled(Spectrum::BLACK, 1.0, 0.0, 0.0)
    }));
    let kinds = [
        ("glossy", MaterialKind::Glossy { reflectance: constant(a), exponent }, a),
        ("phong", MaterialKind::Phong { diffuse: constant(a), specular: constant(b), exponent }, a + b),
        // Exponent 0 is a Lambert lobe.
        (
            "phong of exponent 0",
            MaterialKind::Phong { diffuse: constant(a), specular: constant(b), exponent: ColorInput::grey(0.0) },
            a + b,
        ),
        // Half of the light would meet a second microfacet, and more.
        ("white metal of alpha 1", white_metal(1.0), Spectrum::grey(1.0 - std::f64::consts::LN_2)),
        ("smooth gold", smooth_gold, normal_reflectance),
        // 4 % are reflected above the base, and as much comes out again as goes in.
        ("plastic", plastic(false), 0.04 * b + 0.96 * a),
        ("nonlinear plastic", plastic(true), 0.04 * b + 0.96 * a * (1.0 - internal) / (Spectrum::WHITE - a * internal)),
        // Both boundaries reflect, and what goes to and fro between them: 2F/(1 + F).
        (
            "thin glass",
            MaterialKind::Glass {
                ior: 1.5,
                reflectance: constant(a),
                transmittance: constant(b),
                thin: true,
                film: None,
                dispersion: None,
            },
            (0.08 * a + 0.96 * b) / 1.04,
        ),
        // The light that meets one microfacet alone, and is not reflected, goes through.
        ("rough thin glass of alpha 1", rough_plate, Spectrum::grey(1.0 - std::f64::consts::LN_2)),
        ("principled white metal", principled(Spectrum::WHITE, 1.0, 1.0, 0.0), Spectrum::grey(1.0 - std::f64::consts::LN_2)),
        // Nothing is lost.
        ("principled compensated smooth metal", compensated, Spectrum::WHITE),
        ("principled fibres on black", fibres, a * reflected_by_fibres()),
        (
            "principled smooth dielectric",
            principled(a, 0.0, 0.0, 0.0),
            Spectrum::grey(0.04) + a * (1.0 - reflected_by_half_vectors()),
        ),
        ("principled thin wall", principled(a, 0.0, 0.0, 1.0), Spectrum::grey(0.04) + 0.96 * a),
        // 4 % are reflected; the rest is spread over a cone ior² times as large.
        ("Phong glass", glass(Microfacets::phong(exponent)), 0.04 * a + 0.96 / 2.25 * b),
    ];
    for (name, kind, expected) in kinds {
        let mut scene = spot(256, 0.0);
        let material = material(&mut scene, kind, None);
        floor_at_spot(&mut scene, material);
        push(cases, name, &scene, expected, &ALL);
    }
}

/// Thin where it lets light through, without extensions.
fn plain_principled(base: Spectrum, metallic: f64, roughness: f64, transmission: f64) -> Principled {
    let (zero, one, grey) = (ColorInput::grey(0.0), ColorInput::grey(1.0), ColorInput::grey);
    Principled {
        base_color: ColorInput::Constant(base),
        metallic: grey(metallic),
        roughness: grey(roughness),
        ior: 1.5,
        dispersion: None,
        specular: one,
        specular_color: one,
        transmission: grey(transmission),
        diffuse_transmission: ColorInput::grey(0.0),
        diffuse_transmission_color: ColorInput::grey(1.0),
        subsurface: None,
        thin_film: None,
        thin_film_share: ColorInput::grey(0.0),
        thin: true,
        attenuation: None,
        clearcoat: zero,
        coat_normal_map: None,
        clearcoat_roughness: zero,
        sheen_color: zero,
        sheen_roughness: zero,
        anisotropy: None,
        anisotropy_direction: None,
        anisotropy_rotation_degrees: 0.0,
        masking: Masking::Separable,
        energy_compensation: false,
    }
}

/// A block seen along the normal of its front: light comes in and out as often as its boundaries reflect it, and a colour is left of it each
/// time that it goes from one to the other.
fn volumes(cases: &mut Vec<Case>) {
    let color = Spectrum::new(0.9, 0.6, 0.4);
    for (name, ior, boundary) in [("block of air", 1.0, 0.0), ("block of glass", 1.5, 0.04)] {
        let mut scene = spot(64, 0.0);
        scene.render.max_depth = 40;
        let attenuation = Some(Attenuation { color: color.map(f64::sqrt), distance: 0.25 });
        let kind = Principled { ior, thin: false, attenuation, ..plain_principled(Spectrum::WHITE, 0.0, 0.0, 1.0) };
        let material = material(&mut scene, MaterialKind::Principled(Box::new(kind)), None);
        shape(&mut scene, Geometry::Box(Cuboid { min: DVec3::new(-9.0, -0.5, -9.0), max: DVec3::new(9.0, 0.0, 9.0) }), material);
        let passed = (1.0 - boundary) * (1.0 - boundary) * color / (Spectrum::WHITE - boundary * color);
        let expected = Spectrum::grey(boundary) + passed;
        push(cases, name, &scene, expected, &ALL);
    }
}

/// Blocks of media that bend no light, one within another, seen along the normal of their fronts: at each height the medium counts that was
/// entered last, also where one ends within another, and a clear one counts as well.
fn nested_media(cases: &mut Vec<Case>) {
    let colors = [Spectrum::new(0.9, 0.6, 0.4), Spectrum::new(0.3, 0.8, 0.7), Spectrum::new(0.6, 0.5, 0.9)];
    // From the top: the outer block, a clear one, one that begins before the next and ends in it, and that.
    let blocks = [(-1.0, 0.0, Some(0)), (-0.4, -0.3, None), (-0.6, -0.45, Some(1)), (-0.75, -0.5, Some(2))];
    let thickness = [0.3 + 0.05 + 0.25, 0.05, 0.25];
    let mut scene = spot(512, 0.0);
    scene.render.max_depth = 40;
    for (bottom, top, color) in blocks {
        let attenuation = color.map(|index: usize| Attenuation { color: colors[index], distance: 0.5 });
        let kind = Principled { ior: 1.0, thin: false, attenuation, ..plain_principled(Spectrum::WHITE, 0.0, 0.0, 1.0) };
        let material = material(&mut scene, MaterialKind::Principled(Box::new(kind)), None);
        let block = Cuboid { min: DVec3::new(-9.0, bottom, -9.0), max: DVec3::new(9.0, top, 9.0) };
        shape(&mut scene, Geometry::Box(block), material);
    }
    let passes = |index: usize| colors[index].map(|left| left.powf(thickness[index] / 0.5));
    let expected = passes(0) * passes(1) * passes(2);
    push(cases, "blocks within blocks", &scene, expected, &ALL);
}

/// ∫ D/(4·(1 + Λ(1) + Λ(μ))) dω of light along the normal, by the distribution and the fits of Estevez and Kulla (2017) for the width 1.
fn reflected_by_fibres() -> f64 {
    let fit = |x: f64| 21.5473 / (1.0 + 3.82987 * x.powf(0.19823)) - 1.97760 * x - 4.32054;
    let lambda = |x: f64| if x < 0.5 { fit(x).exp() } else { (2.0 * fit(0.5) - fit(1.0 - x)).exp() };
    let count = 100_000;
    let at = |step: u32| (f64::from(step) + 0.5) / f64::from(count);
    // The half vector's sine has the square (1 − μ)/2.
    let share = |cosine: f64| 3.0 * ((1.0 - cosine) / 2.0).sqrt() / (4.0 * (1.0 + lambda(1.0) + lambda(cosine)));
    (0..count).map(|step| share(at(step))).sum::<f64>() / f64::from(count)
}

/// ∫ F(cos θ/2) cosθ/π dω with Schlick's F from 0.04 on: of light along the normal, what the half vectors take from a diffuse base.
fn reflected_by_half_vectors() -> f64 {
    let count = 10_000;
    let at = |step: u32| (f64::from(step) + 0.5) / f64::from(count);
    let fresnel = |cosine: f64| 0.04 + 0.96 * (1.0 - ((1.0 + cosine) / 2.0).sqrt()).powi(5);
    (0..count).map(|step| 2.0 * at(step) * fresnel(at(step))).sum::<f64>() / f64::from(count)
}

/// ρ1 + (ρ0 − ρ1)·w0, w0 by the angle of view or by a texture.
fn blends_by_angle(cases: &mut Vec<Case>) {
    let facing = |power| BlendWeight::Facing { power };
    let reverse = |of| BlendWeight::Reverse { of: Box::new(of) };
    let threshold = |tau, of| BlendWeight::Threshold { tau, of: Box::new(of) };
    // ior 2 in air: normal reflectance 1/9; refraction at 60° from the normal has the cosine √(1 − ¾/4).
    let schlick = |cosine: f64| 1.0 / 9.0 + 8.0 / 9.0 * (1.0 - cosine).powi(5);
    let refracted = (13.0_f64 / 16.0).sqrt();
    let (parallel, perpendicular) = ((1.0 - refracted) / (1.0 + refracted), (0.5 - 2.0 * refracted) / (0.5 + 2.0 * refracted));
    let exact = 0.5 * (parallel * parallel + perpendicular * perpendicular);
    let cosine = 0.5_f64;
    let weights = [
        ("facing", facing(1.0), cosine),
        ("facing to the fifth root", facing(0.2), cosine.powf(0.2)),
        ("Schlick", BlendWeight::Fresnel { ior: 2.0, exact: false }, 1.0 - schlick(cosine)),
        ("exact Fresnel", BlendWeight::Fresnel { ior: 2.0, exact: true }, 1.0 - exact),
        ("texture", BlendWeight::Texture { texture: 0 }, 0.2126 * 0.8 + 0.7152 * 0.25 + 0.0722 * 0.5),
        ("reverse", reverse(facing(1.0)), 1.0 - cosine),
        ("threshold above", threshold(0.49, facing(1.0)), 1.0),
        ("threshold below", threshold(0.51, facing(1.0)), 0.0),
        ("reversed threshold of a reverse", reverse(threshold(0.6, reverse(facing(0.2)))), 1.0),
    ];
    let tint = Spectrum::new(0.9, 0.6, 0.3);
    for (name, weight, w0) in weights {
        let mut scene = spot(256, 60.0);
        let colors = (Spectrum::new(0.8, 0.25, 0.5), Spectrum::WHITE);
        let kind = TextureKind::Checker { a: colors.0, b: colors.1, scale: [1.0, 1.0] };
        scene.textures.push(Texture::new("checker", kind));
        let bright = material(&mut scene, MaterialKind::Diffuse { reflectance: ColorInput::Constant(tint) }, None);
        let dark = diffuse(&mut scene, 0.1);
        let both = blend(&mut scene, bright, dark, weight);
        floor_at_spot(&mut scene, both);
        push_modes(
            cases,
            &format!("Lamberts by {name}"),
            &scene,
            tint * w0 + Spectrum::grey((1.0 - w0) * 0.1),
            &[Estimator::Mis, Estimator::Bsdf],
        );
    }
}

/// 0.5·a + 0.5 and the like: a choice among lobes that no other strategy can make.
fn blends_with_delta_lobes(cases: &mut Vec<Case>) {
    let sphere_before = |spp| {
        let mut scene = scene(spp, camera(DVec3::new(0.0, 0.0, 3.0), DVec3::new(0.6, 0.0, 0.0), 12.0));
        environment(&mut scene, 1.0);
        scene
    };
    let mirror = |scene: &mut Scene| material(scene, MaterialKind::Mirror { reflectance: ColorInput::grey(1.0) }, None);
    for albedo in [0.0, 0.5] {
        let mut scene = sphere_before(128);
        let (matte, shiny) = (diffuse(&mut scene, albedo), mirror(&mut scene));
        let both = blend(&mut scene, matte, shiny, half());
        shape(&mut scene, sphere(DVec3::ZERO, 1.0), both);
        push_modes(cases, &format!("Lambert {albedo} and mirror"), &scene, Spectrum::grey(0.5 * albedo + 0.5), &ALL);
    }
    let mut scene = sphere_before(256);
    let (shiny, clear) = (mirror(&mut scene), glass(&mut scene, 1.5));
    let both = blend(&mut scene, shiny, clear, BlendWeight::Facing { power: 1.0 });
    shape(&mut scene, sphere(DVec3::ZERO, 1.0), both);
    push_modes(cases, "mirror and glass", &scene, Spectrum::WHITE, &[Estimator::Mis]);

    // Nested: 0.25 mirror + 0.75·(0.4 Lambert 0.6 + 0.6·(0.5 Lambert 0.2 + 0.5 white smooth metal)).
    let mut scene = sphere_before(128);
    let (shiny, light, dark) = (mirror(&mut scene), diffuse(&mut scene, 0.6), diffuse(&mut scene, 0.2));
    let fresnel = ConductorFresnel::Reflectance(ColorInput::grey(1.0));
    let facets = Microfacets::ggx(ColorInput::grey(0.0));
    let metal = MaterialKind::Conductor { fresnel, facets, specular_reflectance: ColorInput::grey(1.0), film: None };
    let metal = material(&mut scene, metal, None);
    let inner = blend(&mut scene, dark, metal, half());
    let middle = blend(&mut scene, light, inner, BlendWeight::Constant { value: 0.4 });
    let outer = blend(&mut scene, shiny, middle, BlendWeight::Constant { value: 0.25 });
    shape(&mut scene, sphere(DVec3::ZERO, 1.0), outer);
    let expected = 0.25 + 0.75 * (0.4 * 0.6 + 0.6 * (0.5 * 0.2 + 0.5));
    push_modes(cases, "nested blend", &scene, Spectrum::grey(expected), &ALL);
}

/// Closed surface, blend of Lamberts, emission of the parts and of the blend itself: Le/(1 − Σ wᵢρᵢ), Le = Σ wᵢLeᵢ + Le.
fn furnaces_of_blends(cases: &mut Vec<Case>) {
    let inside = camera(DVec3::new(0.2, -0.3, 0.1), DVec3::new(1.0, 0.5, -0.7), 60.0);
    let mut scene = scene(64, inside);
    scene.render.roulette_depth = 12.into();
    let (bright, dark) = (glowing(&mut scene, 0.9, 2.0), glowing(&mut scene, 0.1, 0.4));
    let middle = diffuse(&mut scene, 0.5);
    let inner = blend(&mut scene, dark, middle, half());
    let outer = blend(&mut scene, bright, inner, BlendWeight::Constant { value: 0.25 });
    scene.materials[outer].emission = Some(Emission { radiance: ColorInput::grey(0.2), two_sided: true });
    shape(&mut scene, sphere(DVec3::ZERO, 1.0), outer);
    let albedo = 0.25 * 0.9 + 0.375 * 0.1 + 0.375 * 0.5;
    let radiance = 0.25 * 2.0 + 0.375 * 0.4 + 0.2;
    push_modes(cases, "furnace of a nested blend", &scene, Spectrum::grey(radiance / (1.0 - albedo)), &ALL);
    scene.render.max_depth = 2;
    push_modes(cases, "the same, direct", &scene, Spectrum::grey(radiance * (1.0 + albedo)), &ALL);
}

/// Blends with `pass`: the environment shows through, and light in front of it adds to it.
fn translucent_surfaces(cases: &mut Vec<Case>) {
    let pass = |scene: &mut Scene| material(scene, MaterialKind::Pass, None);
    let mut scene = spot(256, 40.0);
    let (nothing, matte) = (pass(&mut scene), diffuse(&mut scene, 0.6));
    let translucent = blend(&mut scene, nothing, matte, half());
    floor_at_spot(&mut scene, translucent);
    push_modes(cases, "translucent surface", &scene, Spectrum::grey(0.5 + 0.5 * 0.6), &ALL);

    let mut scene = spot(256, 40.0);
    let (light, nothing) = (emissive(&mut scene, Spectrum::new(2.0, 1.0, 0.5)), pass(&mut scene));
    let flame = blend(&mut scene, light, nothing, BlendWeight::Constant { value: 0.3 });
    floor_at_spot(&mut scene, flame);
    push_modes(cases, "glowing translucent surface", &scene, Spectrum::new(2.0, 1.0, 0.5) * 0.3 + Spectrum::grey(0.7), &ALL);

    // Two walls of a hollow ball, each letting nine tenths through, end no edge: the light behind is seen directly.
    let mut scene = spot(256, 40.0);
    scene.lights.clear();
    scene.render.max_depth = 1;
    let (nothing, black) = (pass(&mut scene), diffuse(&mut scene, 0.0));
    let gauze = blend(&mut scene, nothing, black, BlendWeight::Constant { value: 0.9 });
    shape(&mut scene, sphere(DVec3::ZERO, 1.0), gauze);
    let light = emissive(&mut scene, Spectrum::grey(3.0));
    shape(&mut scene, sphere(DVec3::ZERO, 100.0), light);
    scene.materials[light].emission = Some(Emission { radiance: ColorInput::grey(3.0), two_sided: true });
    push_modes(cases, "light behind two translucent surfaces", &scene, Spectrum::grey(0.81 * 3.0), &ALL);
}

/// The sphere light over a floor, its emission weighted by a blend.
fn blended_lights(cases: &mut Vec<Case>) {
    let (radius, distance, albedo) = (0.6, 1.0, 0.5);
    let mut scene = spot(256, 60.0);
    scene.lights.clear();
    scene.render.max_depth = 2;
    let white = diffuse(&mut scene, albedo);
    floor_at_spot(&mut scene, white);
    let (light, black) = (emissive(&mut scene, Spectrum::new(1.0, 2.0, 4.0)), diffuse(&mut scene, 0.0));
    let lamp = blend(&mut scene, black, light, BlendWeight::Constant { value: 0.75 });
    shape(&mut scene, sphere(DVec3::Y * distance, radius), lamp);
    let expected = Spectrum::new(1.0, 2.0, 4.0) * 0.25 * albedo * (radius / distance).powi(2);
    push_modes(cases, "blended sphere light", &scene, expected, &ALL);
}

/// A point light over a Lambert floor whose normal map turns every normal to n: ρ/π·I·(n·wi)/d². The same from below, where the
/// turned normal is turned over as a whole.
pub fn with_normal_maps() -> Vec<Case> {
    let mut cases = Vec::new();
    let (u, v) = (DVec3::X * 40.0, -DVec3::Z * 40.0);
    let corner = -0.3 * (u + v);
    // Along u, along v, along the normal.
    let local = DVec3::new(0.3, -0.2, 0.8).normalize();
    let normal = local.x * DVec3::X + local.y * -DVec3::Z + local.z * DVec3::Y;
    let rectangle = Geometry::Rectangle(Rectangle { corner, edge_u: u, edge_v: v });
    let mesh = |mirrored: bool| {
        let positions = [corner, corner + u, corner + u + v, corner + v].map(DVec3::as_vec3).to_vec();
        let mut uvs = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(Vec2::from).to_vec();
        if mirrored {
            uvs.iter_mut().for_each(|uv| uv.x = 1.0 - uv.x);
        }
        Geometry::Mesh(Arc::new(Mesh { positions, uvs, faces: vec![[0, 1, 2], [0, 2, 3]], ..Mesh::default() }))
    };
    let turned = DVec3::new(-normal.x, normal.y, normal.z);
    let floors = [("rectangle", rectangle, normal), ("mesh", mesh(false), normal), ("mesh, u mirrored", mesh(true), turned)];
    for (name, geometry, normal) in floors {
        for (side, sign) in [("above", 1.0), ("below", -1.0)] {
            let (wi, distance) = (DVec3::new(0.5, 1.0, 0.2).normalize() * sign, 2.0);
            let mut scene = scene(4, camera(DVec3::new(0.6, 1.5, 0.8) * sign, DVec3::ZERO, 0.001));
            scene.render.max_depth = 2;
            let texel = Spectrum::from_rgb((local * 0.5 + 0.5).to_array());
            let kind = TextureKind::Checker { a: texel, b: texel, scale: [1.0, 1.0] };
            scene.textures.push(Texture::new("normals", kind));
            let matte = diffuse(&mut scene, 0.6);
            scene.materials[matte].normal_map = Some(0);
            shape(&mut scene, geometry.clone(), matte);
            scene.lights.push(Light::Point(PointLight {
                position: wi * distance,
                intensity: Spectrum::grey(3.0),
                profile: None,
            }));
            let expected = 0.6 / PI * 3.0 * (normal * sign).dot(wi) / (distance * distance);
            // The picture's edge sees the light at another angle, by 10⁻⁵.
            push(&mut cases, &format!("normal map of a {name}, {side}"), &scene, Spectrum::grey(expected), &[Estimator::Mis]);
        }
    }
    cases
}
