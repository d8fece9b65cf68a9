//! Lights that next event estimation samples, in the scene's order, with the table that chooses among them.

use std::f64::consts::PI;

use glam::DVec3;

use super::NONE;
use super::environment::PackedEnvironment;
use super::material::mean_emission;
use super::primitive::{PrimitiveGeometry, WorldPrimitive};
use super::world::WorldGeometry;
use crate::math::luminance;
use crate::sampling::{Lamp, LightChoice};
use crate::scene::{ColorInput, Estimator, Light, Scene, TextureKind};
use crate::shader::shared::{Constants, shared_constants, shared_kinds};

shared_kinds! {
    /// What a light is. The first four kinds are those of primitives.
    pub enum LightKind {
        Triangle = 0 as LIGHT_TRIANGLE,
        Quad = 1 as LIGHT_QUAD,
        Sphere = 2 as LIGHT_SPHERE,
        Disk = 3 as LIGHT_DISK,
        Point = 4 as LIGHT_POINT,
        Environment = 5 as LIGHT_ENVIRONMENT,
        Spot = 6 as LIGHT_SPOT,
        Directional = 7 as LIGHT_DIRECTIONAL,
        /// Of any of the first four kinds, from bit [`PORTAL_SHIFT`] on.
        Portal = 8 as LIGHT_PORTAL,
    }
}

shared_constants!(flags {
    /// Words of a light in the tables.
    pub const LIGHT_WORDS: u32 = (size_of::<PackedLight>() / 16) as u32;
    pub(super) const LIGHT_TWO_SIDED: u32 = 256;
    /// The radiance is that of the whole material, seen from where the light goes.
    pub(super) const LIGHT_VARIES: u32 = 512;
    /// Its points move as its attributes say.
    pub(super) const LIGHT_MOVES: u32 = 1024;
    /// Of a portal: where the kind of its shape stands.
    pub(super) const PORTAL_SHIFT: u32 = 12;
});

/// Kinds, flags and sizes, for WGSL.
pub fn constants() -> Constants {
    [LightKind::constants(), flags()].concat()
}

/// 80 bytes, the layout of `light_word` in `shaders/shading/light.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct PackedLight {
    pub kind_and_flags: u32,
    pub alias_threshold: u32,
    pub alias: u32,
    /// Probability of being chosen.
    pub pmf: f32,
    /// First vertex, corner, center or position. Nothing for lights at infinity.
    pub p0: [f32; 3],
    /// Radius of a sphere, else the area.
    pub size: f32,
    /// Edges from p0; for a disk, two perpendicular radii. Of a spot light, its axis; of a directional light, the way to it.
    pub p1: [f32; 3],
    pub padding: u32,
    /// Of a spot light: 1 − cosine of the angle at which its light ends, and of the one up to which it is full.
    pub p2: [f32; 3],
    pub attributes: u32,
    /// Radiance of a surface, intensity of a point or spot, irradiance of a directional light.
    pub radiance: [f32; 3],
    /// Of a surface.
    pub material: u32,
}

impl PackedLight {
    /// Its radiance is looked up in the whole material.
    pub fn varies(&self) -> bool {
        self.kind_and_flags & LIGHT_VARIES != 0
    }

    pub fn moves(&self) -> bool {
        self.kind_and_flags & LIGHT_MOVES != 0
    }

    pub fn kind(&self) -> u32 {
        self.kind_and_flags & 255
    }

    pub fn is(&self, kind: LightKind) -> bool {
        self.kind() == kind as u32
    }
}

/// All sampled lights; marks the primitives that are lights with their index. The order is that of the reference.
pub fn collect(scene: &Scene, world: &mut WorldGeometry, environment: &PackedEnvironment) -> Vec<PackedLight> {
    if scene.render.estimator == Estimator::Bsdf {
        return Vec::new();
    }
    let (mut lights, mut choice) = (Vec::new(), LightChoice::default());
    // Asked once a material, not once a triangle: a texture's mean looks at all of it.
    let emissions: Vec<_> = (0..scene.materials.len()).map(|material| SurfaceEmission::of(scene, material)).collect();
    for primitive in &mut world.primitives {
        let emission = &emissions[primitive.material];
        let power = emission.power(primitive);
        if let Some(light) = surface_light(primitive, emission).filter(|_| power > 0.0) {
            primitive.light = lights.len() as u32;
            lights.push(light);
            choice.add(Lamp::Surface { shape: primitive.shape, material: primitive.material }, power);
        }
    }
    for (light, power) in scene.lights.iter().filter_map(from_a_point).filter(|(_, power)| *power > 0.0) {
        lights.push(light);
        choice.add(Lamp::Alone, power);
    }
    for (light, lamp, irradiance) in at_infinity(scene, world, environment) {
        lights.push(light);
        choice.add_at_infinity(lamp, irradiance);
    }
    let table = choice.table();
    for (index, light) in lights.iter_mut().enumerate() {
        light.alias = table.alias[index];
        light.alias_threshold = table.threshold[index];
        light.pmf = table.pmf[index] as f32;
    }
    lights
}

/// A light with a position of its own, and its luminous power.
fn from_a_point(light: &Light) -> Option<(PackedLight, f64)> {
    match *light {
        Light::Point { position, intensity } => {
            Some((plain(LightKind::Point, position, intensity), 4.0 * PI * luminance(intensity)))
        }
        Light::Spot { position, direction, intensity, angle_degrees, falloff_degrees } => {
            // 1 − cosine, which keeps its precision for narrow cones.
            let [outer, inner] = [angle_degrees, falloff_degrees].map(|angle| 2.0 * (0.5 * angle).to_radians().sin().powi(2));
            let light = PackedLight {
                p1: direction.as_vec3().to_array(),
                p2: [outer as f32, inner as f32, 0.0],
                ..plain(LightKind::Spot, position, intensity)
            };
            Some((light, PI * (outer + inner) * luminance(intensity)))
        }
        Light::Directional { .. } | Light::Environment(_) => None,
    }
}

/// Directional lights, the environment and the portals to it, each with a measure of the irradiance it makes.
fn at_infinity(scene: &Scene, world: &WorldGeometry, environment: &PackedEnvironment) -> Vec<(PackedLight, Lamp, f64)> {
    let mut lights = Vec::new();
    for light in &scene.lights {
        if let Light::Directional { direction, irradiance } = *light
            && luminance(irradiance) > 0.0
        {
            let p1 = (-direction).as_vec3().to_array();
            let light = PackedLight { p1, ..plain(LightKind::Directional, DVec3::ZERO, irradiance) };
            lights.push((light, Lamp::Alone, luminance(irradiance)));
        }
    }
    let irradiance = PI * environment.mean_luminance();
    if irradiance == 0.0 {
        return lights;
    }
    // Under `mis` a constant environment is left to BSDF sampling, which covers it without a shadow ray.
    let constant = matches!(environment, PackedEnvironment::Constant { .. });
    if scene.render.estimator == Estimator::Nee || !constant {
        lights.push((plain(LightKind::Environment, DVec3::ZERO, DVec3::ZERO), Lamp::Environment, irradiance));
    }
    let total: f64 = world.portals.iter().map(WorldPrimitive::area).sum();
    for portal in &world.portals {
        let (kind, size, [p0, p1, p2]) = match light_geometry(portal) {
            Some(geometry) => geometry,
            None => continue,
        };
        let light = PackedLight {
            kind_and_flags: LightKind::Portal as u32 | (kind as u32) << PORTAL_SHIFT,
            size: size as f32,
            p1: p1.as_vec3().to_array(),
            p2: p2.as_vec3().to_array(),
            ..plain(LightKind::Portal, p0, DVec3::ZERO)
        };
        lights.push((light, Lamp::Environment, irradiance * portal.area() / total));
    }
    lights
}

/// What a surface of some material sends out.
struct SurfaceEmission {
    material: usize,
    mean_radiance: DVec3,
    /// The material, or some part of it, emits from its back too.
    two_sided: bool,
    /// The radiance of a blend changes with its weights, that of a texture over the surface: the whole material is looked up.
    varies: bool,
    /// Of a plain material.
    radiance: ColorInput,
}

impl SurfaceEmission {
    fn of(scene: &Scene, material: usize) -> Self {
        let own = scene.materials[material].emission;
        let radiance = own.map_or(ColorInput::grey(0.0), |emission| emission.radiance);
        Self {
            material,
            mean_radiance: mean_emission(scene, material, &|input| mean_color(scene, input)),
            two_sided: scene.emits_from_both_sides(material),
            varies: scene.materials[material].is_blend() || radiance.is_texture(),
            radiance,
        }
    }

    /// Luminous power: π·A·L, twice that for two sides.
    fn power(&self, primitive: &WorldPrimitive) -> f64 {
        let luminance = luminance(self.mean_radiance);
        // An infinite plane that does not emit has no power: 0, not 0·∞.
        if luminance == 0.0 {
            return 0.0;
        }
        PI * primitive.area() * luminance * if self.two_sided { 2.0 } else { 1.0 }
    }
}

fn mean_color(scene: &Scene, input: &ColorInput) -> DVec3 {
    let mean = |texture: usize| match &scene.textures[texture].kind {
        TextureKind::Image(image) => {
            let texels = &image.image.texels;
            texels.iter().map(|texel| texel.as_dvec3()).sum::<DVec3>() / texels.len() as f64
        }
        TextureKind::Checker { a, b, .. } | TextureKind::Perlin { a, b, .. } | TextureKind::Worley { a, b, .. } => {
            0.5 * (*a + *b)
        }
    };
    match input {
        ColorInput::Constant(color) => *color,
        ColorInput::Texture(texture) => mean(*texture),
        ColorInput::ScaledTexture(texture, factor) => mean(*texture) * *factor,
        ColorInput::SquaredTexture(texture) => mean(*texture) * mean(*texture),
    }
}

fn plain(kind: LightKind, position: DVec3, radiance: DVec3) -> PackedLight {
    PackedLight {
        kind_and_flags: kind as u32,
        alias_threshold: u32::MAX,
        alias: 0,
        pmf: 1.0,
        p0: position.as_vec3().to_array(),
        size: 0.0,
        p1: [0.0; 3],
        padding: 0,
        p2: [0.0; 3],
        attributes: NONE,
        radiance: radiance.as_vec3().to_array(),
        material: NONE,
    }
}

fn surface_light(primitive: &WorldPrimitive, emission: &SurfaceEmission) -> Option<PackedLight> {
    let (radiance, _) = super::material::color_and_texture(&emission.radiance);
    let (kind, size, [p0, p1, p2]) = light_geometry(primitive)?;
    let flag = |set: bool, bit: u32| if set { bit } else { 0 };
    let flags =
        flag(emission.two_sided, LIGHT_TWO_SIDED) | flag(emission.varies, LIGHT_VARIES) | flag(primitive.moves(), LIGHT_MOVES);
    let kind_and_flags = kind as u32 | flags;
    Some(PackedLight {
        kind_and_flags,
        size: size as f32,
        p1: p1.as_vec3().to_array(),
        p2: p2.as_vec3().to_array(),
        attributes: primitive.attributes,
        material: emission.material as u32,
        ..plain(kind, p0, DVec3::from(radiance.map(f64::from)))
    })
}

/// Kind, size and the three points of a light that has this shape.
fn light_geometry(primitive: &WorldPrimitive) -> Option<(LightKind, f64, [DVec3; 3])> {
    let area = primitive.area();
    match primitive.geometry {
        PrimitiveGeometry::Triangle(corners) => {
            let [a, b, c] = corners.map(|corner| corner.as_dvec3());
            Some((LightKind::Triangle, area, [a, b - a, c - a]))
        }
        PrimitiveGeometry::Quad { corner, edge_u, edge_v } => Some((LightKind::Quad, area, [corner, edge_u, edge_v])),
        PrimitiveGeometry::Sphere { center, radius } => Some((LightKind::Sphere, radius, [center, DVec3::ZERO, DVec3::ZERO])),
        PrimitiveGeometry::Disk { center, normal, radius } => {
            let [tangent, bitangent] = frame(normal);
            Some((LightKind::Disk, area, [center, tangent * radius, bitangent * radius]))
        }
        // No density covers an infinite area evenly.
        PrimitiveGeometry::Plane { .. } => None,
    }
}

/// Orthonormal basis of Duff et al. 2017; `frame_from_normal` in `shaders/core/math.wgsl`.
fn frame(n: DVec3) -> [DVec3; 2] {
    let s = if n.z < -0.2137 { -1.0 } else { 1.0 };
    let a = -1.0 / (s + n.z);
    let b = n.x * n.y * a;
    [DVec3::new(1.0 + s * n.x * n.x * a, s * b, -s * n.x), DVec3::new(b, s + n.y * n.y * a, -n.y)]
}
