//! Lights that next event estimation samples, in the scene's order, with the table that chooses among them by power.

use std::f64::consts::PI;

use glam::DVec3;

use super::material::mean_emission;
use super::primitive::{PrimitiveGeometry, WorldPrimitive};
use super::{NONE, environment_is_sampled};
use crate::sampling::AliasTable;
use crate::scene::{ColorInput, Estimator, Light, MaterialKind, Scene, TextureKind};

/// Kinds in `shaders/shading/light.wgsl`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u32)]
pub enum LightKind {
    Triangle = 0,
    Quad = 1,
    Sphere = 2,
    Disk = 3,
    Point = 4,
    Environment = 5,
}

const TWO_SIDED: u32 = 256;
/// The radiance is that of the whole material, seen from where the light goes.
const BLENDED: u32 = 512;

/// 80 bytes, the layout of `light_word` in `shaders/shading/light.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct FlatLight {
    pub kind_and_flags: u32,
    pub alias_threshold: u32,
    pub alias: u32,
    /// Probability of being chosen.
    pub pmf: f32,
    /// First vertex, corner, center or position.
    pub p0: [f32; 3],
    /// Radius of a sphere, else the area.
    pub size: f32,
    /// Edges from p0; for a disk, two perpendicular radii.
    pub p1: [f32; 3],
    pub emission_texture: u32,
    pub p2: [f32; 3],
    pub attributes: u32,
    /// Radiance of a surface, intensity of a point.
    pub radiance: [f32; 3],
    /// Of a surface.
    pub material: u32,
}

impl FlatLight {
    /// Its radiance is that of a whole blend.
    pub fn is_blended(&self) -> bool {
        self.kind_and_flags & BLENDED != 0
    }
}

/// All sampled lights; marks the primitives that are lights with their index.
pub fn collect(scene: &Scene, primitives: &mut [WorldPrimitive]) -> Vec<FlatLight> {
    if scene.render.estimator == Estimator::Bsdf {
        return Vec::new();
    }
    let mut lights = Vec::new();
    let mut powers = Vec::new();
    for primitive in primitives {
        let emission = SurfaceEmission::of(scene, primitive.material);
        let power = emission.power(primitive);
        if let Some(light) = surface_light(primitive, &emission).filter(|_| power > 0.0) {
            primitive.light = lights.len() as u32;
            lights.push(light);
            powers.push(power);
        }
    }
    let others: f64 = powers.iter().sum::<f64>() + scene.lights.iter().map(point_power).sum::<f64>();
    for light in &scene.lights {
        match light {
            Light::Point { position, intensity } if point_power(light) > 0.0 => {
                lights.push(plain(LightKind::Point, *position, *intensity));
                powers.push(point_power(light));
            }
            Light::Environment(environment) if environment_is_sampled(scene) => {
                let radiance = environment.constant_radiance().unwrap_or(DVec3::ZERO);
                if radiance.max_element() > 0.0 {
                    lights.push(plain(LightKind::Environment, DVec3::ZERO, radiance));
                    // As likely as all other lights together.
                    powers.push(if others > 0.0 { others } else { 1.0 });
                }
            }
            _ => {}
        }
    }
    let table = AliasTable::new(&powers);
    for (index, light) in lights.iter_mut().enumerate() {
        light.alias = table.alias[index];
        light.alias_threshold = table.threshold[index];
        light.pmf = table.pmf[index] as f32;
    }
    lights
}

/// What a surface of some material sends out.
struct SurfaceEmission {
    material: usize,
    mean_radiance: DVec3,
    /// The material, or some part of it, emits from its back too.
    two_sided: bool,
    /// Emission varies with the blend's weights: the whole material is looked up.
    blended: bool,
    /// Of a plain material.
    radiance: ColorInput,
}

impl SurfaceEmission {
    fn of(scene: &Scene, material: usize) -> Self {
        let own = scene.materials[material].emission;
        Self {
            material,
            mean_radiance: mean_emission(scene, material, &|input| mean_color(scene, input)),
            two_sided: scene.emits_from_both_sides(material),
            blended: matches!(scene.materials[material].kind, MaterialKind::Blend { .. }),
            radiance: own.map_or(ColorInput::grey(0.0), |emission| emission.radiance),
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

fn point_power(light: &Light) -> f64 {
    match light {
        Light::Point { intensity, .. } => 4.0 * PI * luminance(*intensity),
        _ => 0.0,
    }
}

/// Luminance of linear Rec.709.
pub fn luminance(color: DVec3) -> f64 {
    color.dot(DVec3::new(0.2126, 0.7152, 0.0722))
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
    }
}

fn plain(kind: LightKind, position: DVec3, radiance: DVec3) -> FlatLight {
    FlatLight {
        kind_and_flags: kind as u32,
        alias_threshold: u32::MAX,
        alias: 0,
        pmf: 1.0,
        p0: position.as_vec3().to_array(),
        size: 0.0,
        p1: [0.0; 3],
        emission_texture: NONE,
        p2: [0.0; 3],
        attributes: NONE,
        radiance: radiance.as_vec3().to_array(),
        material: NONE,
    }
}

fn surface_light(primitive: &WorldPrimitive, emission: &SurfaceEmission) -> Option<FlatLight> {
    let (radiance, texture) = super::material::color_and_texture(&emission.radiance);
    let (kind, p0, p1, p2) = match primitive.geometry {
        PrimitiveGeometry::Triangle([a, b, c]) => {
            (LightKind::Triangle, a.as_dvec3(), (b.as_dvec3() - a.as_dvec3()), c.as_dvec3() - a.as_dvec3())
        }
        PrimitiveGeometry::Quad { corner, edge_u, edge_v } => (LightKind::Quad, corner, edge_u, edge_v),
        PrimitiveGeometry::Sphere { center, .. } => (LightKind::Sphere, center, DVec3::ZERO, DVec3::ZERO),
        PrimitiveGeometry::Disk { center, normal, radius } => {
            let [tangent, bitangent] = frame(normal);
            (LightKind::Disk, center, tangent * radius, bitangent * radius)
        }
        // No density covers an infinite area evenly.
        PrimitiveGeometry::Plane { .. } => return None,
    };
    let size = if let PrimitiveGeometry::Sphere { radius, .. } = primitive.geometry { radius } else { primitive.area() };
    Some(FlatLight {
        kind_and_flags: kind as u32 | if emission.two_sided { TWO_SIDED } else { 0 } | if emission.blended { BLENDED } else { 0 },
        size: size as f32,
        p1: p1.as_vec3().to_array(),
        emission_texture: texture,
        p2: p2.as_vec3().to_array(),
        attributes: primitive.attributes,
        material: emission.material as u32,
        ..plain(kind, p0, DVec3::from(radiance.map(f64::from)))
    })
}

/// Orthonormal basis of Duff et al. 2017; `frame_from_normal` in `shaders/core/math.wgsl`.
fn frame(n: DVec3) -> [DVec3; 2] {
    let s = if n.z < -0.2137 { -1.0 } else { 1.0 };
    let a = -1.0 / (s + n.z);
    let b = n.x * n.y * a;
    [DVec3::new(1.0 + s * n.x * n.x * a, s * b, -s * n.x), DVec3::new(b, s + n.y * n.y * a, -n.y)]
}
