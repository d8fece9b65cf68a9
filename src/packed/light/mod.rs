//! Lights that next event estimation samples, in the scene's order, with the table that chooses among them.

pub mod record;
mod surface;

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::f64::consts::PI;

use glam::DVec3;

use super::constants::NONE;
use super::environment::PackedEnvironment;
use super::error::PackError;
use super::primitive::WorldPrimitive;
use super::texture::{self, PackedTextures};
use super::world::WorldGeometry;
use crate::emission_map::{EmissionMaps, Unrolled};
use crate::sampling::light_tree::{Emitter, LightNode};
use crate::sampling::light_way::LightWay;
use crate::sampling::{AliasTable, HierarchicalWarp, LightCells, LightGroup, LightSampler, LightTree};
use crate::scene::light::light_table;
use crate::scene::{Estimator, Light, LightStrength, Scene};
use record::PORTAL_SHIFT;
pub use record::{LightKind, PackedLight, PackedWarp, constants};
use surface::{SurfaceEmission, surface_light};

/// The kind of a delta light, by the table of lights.
macro_rules! delta_kinds {
    (environment { $($environment:tt)* } delta { $($delta:ident($type:ident) $module:ident $number:ident $($needed:ident)*,)* }) => {
        fn delta_kind(light: &Light) -> Option<LightKind> {
            match light {
                $(Light::$delta(_) => Some(LightKind::$delta),)*
                _ => None,
            }
        }
    };
}
light_table!(delta_kinds);

fn delta_light(light: &Light, texture: u32) -> Option<(PackedLight, LightStrength)> {
    let parameters = light.delta()?;
    let packed = PackedLight::delta(delta_kind(light)?, &parameters, texture);
    parameters.strength.is_positive().then_some((packed, parameters.strength))
}

/// The light from outside the scene; a map is appended to the texels.
///
/// # Errors
/// [`PackError::TooManyTexels`] where 32 bits cannot number them.
pub fn environment(scene: &Scene, textures: &mut PackedTextures) -> Result<PackedEnvironment, PackError> {
    let outside = scene.lights.iter().filter_map(Light::outside);
    let parts = outside.map(|(parameters, switch)| PackedEnvironment::new(&parameters, switch, textures));
    Ok(PackedEnvironment::of(parts.collect::<Result<Vec<_>, _>>()?.into_iter()))
}

/// What next event estimation chooses from.
#[derive(Debug, Default)]
pub struct SampledLights {
    pub lights: Vec<PackedLight>,
    /// How many of them stand inside the scene: the first.
    pub local_count: usize,
    /// Of the tree by which those are chosen; empty where they are chosen by power.
    pub nodes: Vec<LightNode>,
    /// The table by which they are chosen in cells, of which nothing is known yet; empty where they are chosen otherwise.
    pub cells: Vec<u32>,
}

/// The textures that the scene's lights throw, as they are [mentioned](texture::mention); NONE where a light throws none.
pub fn thrown_textures(scene: &Scene) -> Vec<u32> {
    let mention = |light: &Light| light.texture().map_or(NONE, |texture| texture::mention(texture, None));
    scene.lights.iter().map(mention).collect()
}

/// All sampled lights, with the places of the textures that the scene's lights throw; marks the primitives that are lights with their index. The order is that of the reference.
/// What points of lamps are drawn by is appended to the texels.
///
/// # Errors
/// [`PackError::TooManyTexels`] where 32 bits cannot number them.
pub fn collect(
    scene: &Scene,
    world: &mut WorldGeometry,
    environment: &PackedEnvironment,
    thrown_textures: &[u32],
    textures: &mut PackedTextures,
) -> Result<SampledLights, PackError> {
    if scene.render.estimator == Estimator::Bsdf {
        return Ok(SampledLights::default());
    }
    let (mut lights, mut sampler) = (Vec::new(), LightSampler::default());
    // Asked once a material, not once a triangle: a texture's mean looks at all of it, and a blend's at all of its parts.
    let emits = scene.materials_that(|material| material.emission.is_some());
    let two_sided = scene.materials_that(|material| material.emission.is_some_and(|emission| emission.two_sided));
    let emissions: Vec<_> = (0..emits.len()).map(|id| emits[id].then(|| SurfaceEmission::of(scene, id, two_sided[id]))).collect();
    let maps = EmissionMaps::new(scene);
    let mut warps: HashMap<(usize, Unrolled), PackedWarp> = HashMap::new();
    let mut powers = Vec::new();
    for primitive in &mut world.primitives {
        let Some(emission) = &emissions[primitive.material] else { continue };
        let attributes = world.attributes.get(primitive.attributes as usize);
        // Where there are second texture coordinates, they stand behind the first.
        let second = if world.second_uvs { world.attributes.get(primitive.attributes as usize + 1) } else { None };
        let power = emission.power(primitive, &maps, [attributes, second]);
        let unrolled = primitive.kind().unrolled().filter(|_| power > 0.0);
        let shown = unrolled.and_then(|unrolled| Some((unrolled, maps.warp(primitive.material, unrolled)?)));
        let warp = match shown {
            None => None,
            Some((unrolled, warp)) => Some(match warps.entry((primitive.material, unrolled)) {
                Entry::Occupied(known) => *known.get(),
                Entry::Vacant(place) => *place.insert(pack_warp(warp, textures)?),
            }),
        };
        let light = surface_light(primitive, emission, scene.render.light_sampling, warp, attributes);
        if let Some(light) = light.filter(|_| power > 0.0) {
            primitive.light = lights.len() as u32;
            lights.push(light);
            powers.push(power);
            let group = LightGroup::Surface { shape: primitive.shape, material: primitive.material };
            sampler.add(group, LightStrength::Power(power));
        }
    }
    let is_local = |(_, strength): &(PackedLight, LightStrength)| matches!(strength, LightStrength::Power(_));
    let delta_lights = scene.lights.iter().zip(thrown_textures).filter_map(|(light, &texture)| delta_light(light, texture));
    let (local, at_infinity): (Vec<_>, Vec<_>) = delta_lights.partition(is_local);
    for (light, strength) in local.into_iter().chain(at_infinity) {
        lights.push(light);
        sampler.add(LightGroup::Alone, strength);
    }
    for (light, irradiance) in environment_lights(scene, world, environment) {
        lights.push(light);
        sampler.add(LightGroup::Environment, LightStrength::Irradiance(irradiance));
    }
    let table = sampler.table();
    for (index, light) in lights.iter_mut().enumerate() {
        light.alias = table.alias[index];
        light.alias_threshold = table.threshold[index];
        light.pmf = table.pmf[index] as f32;
    }
    let local_count = sampler.local_count();
    match LightWay::of(scene.render.light_choice, &sampler) {
        LightWay::Power => return Ok(SampledLights { lights, local_count, ..SampledLights::default() }),
        LightWay::Cells => {
            let cells = LightCells::default().words().to_vec();
            return Ok(SampledLights { lights, local_count, cells, ..SampledLights::default() });
        }
        LightWay::Tree => choose_at_infinity_apart(&mut lights[local_count..], local_count, &sampler.table_at_infinity()),
    }
    let of_surface = |(primitive, power): (&WorldPrimitive, f64)| {
        Some(emitter(scene, primitive, emissions[primitive.material].as_ref()?, power))
    };
    let surfaces = world.primitives.iter().filter(|primitive| primitive.light != NONE).zip(powers).filter_map(of_surface);
    let delta_lights = scene.lights.iter().filter_map(Light::delta).filter(|light| light.strength.is_positive());
    let emitters: Vec<Emitter> = surfaces.chain(delta_lights.filter_map(|light| Emitter::delta(&light))).collect();
    let LightTree { nodes, trails, .. } = LightTree::new(&emitters, sampler.table_at_infinity());
    for (light, trail) in lights.iter_mut().zip(trails) {
        light.trail = trail;
    }
    Ok(SampledLights { lights, local_count, nodes, ..SampledLights::default() })
}

/// Lets lights at infinity, behind `local_count` others, be chosen among themselves.
fn choose_at_infinity_apart(lights: &mut [PackedLight], local_count: usize, table: &AliasTable) {
    for (index, light) in lights.iter_mut().enumerate() {
        light.alias = local_count as u32 + table.alias[index];
        light.alias_threshold = table.threshold[index];
    }
}

/// Appends a density to the texels.
fn pack_warp(warp: &HierarchicalWarp, textures: &mut PackedTextures) -> Result<PackedWarp, PackError> {
    let end = textures.texel_words() + 3 * warp.splits.len() + warp.densities.len();
    if end > u32::MAX as usize {
        return Err(PackError::TooManyTexels { words: end });
    }
    let first_node = textures.texel_words() as u32;
    textures.words.extend(warp.splits.iter().flatten());
    let first_density = textures.texel_words() as u32;
    textures.words.extend(warp.densities.iter().map(|&density| (density as f32).to_bits()));
    Ok(PackedWarp { first_node, first_density, width: warp.width, height: warp.height })
}

/// What the tree knows of an emitting surface.
fn emitter(scene: &Scene, primitive: &WorldPrimitive, emission: &SurfaceEmission, power: f64) -> Emitter {
    let bounds = primitive.geometry.extent().unwrap_or_default();
    if primitive.moves() {
        return Emitter::moving(&scene.shapes[primitive.shape], scene.camera.shutter, bounds, power);
    }
    Emitter::surface(bounds, primitive.geometry.light_normal(), emission.two_sided(), power)
}

/// The environment and the portals to it, each with a measure of the irradiance it makes.
fn environment_lights(scene: &Scene, world: &WorldGeometry, environment: &PackedEnvironment) -> Vec<(PackedLight, f64)> {
    let mut lights = Vec::new();
    let irradiance = PI * environment.mean_luminance;
    if irradiance == 0.0 {
        return lights;
    }
    let infinitely_far = PackedLight::at(DVec3::ZERO, DVec3::ZERO);
    // Under `mis` a constant environment is left to BSDF sampling, which covers it without a shadow ray.
    if scene.render.estimator == Estimator::Nee || !environment.is_constant {
        lights.push((infinitely_far.of_kind(LightKind::Environment), irradiance));
    }
    let total: f64 = world.portals.iter().map(WorldPrimitive::area).sum();
    for portal in &world.portals {
        let Some((size, [p0, p1, p2])) = portal.geometry.light() else { continue };
        let light = PackedLight {
            kind_and_flags: (portal.kind() as u32) << PORTAL_SHIFT,
            size: size as f32,
            p1: p1.as_vec3().to_array(),
            p2: p2.as_vec3().to_array(),
            ..PackedLight::at(p0, DVec3::ZERO)
        };
        lights.push((light.of_kind(LightKind::Portal), irradiance * portal.area() / total));
    }
    lights
}
