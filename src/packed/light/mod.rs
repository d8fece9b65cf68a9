//! Lights that next event estimation samples, those of [`LightList`] in its order, with the table that chooses among them.

pub mod profile;
pub mod record;
mod surface;

use std::collections::HashMap;
use std::collections::hash_map::Entry;

use glam::DVec3;

use super::constants::NONE;
use super::environment::PackedEnvironment;
use super::error::PackError;
use super::primitive::WorldPrimitive;
use super::texture::{self, PackedTextures};
use super::world::WorldGeometry;
use crate::emission_map::{EmissionMaps, Unrolled};
use crate::sampling::light_list::{EmittingSurface, LightList, LightSource, OutsideLight, links_of};
use crate::sampling::light_strategy::LightStrategy;
use crate::sampling::light_tree::{Emitter, LightNode};
use crate::sampling::{AliasTable, HierarchicalWarp, LightCells, LightTree};
use crate::scene::light::light_table;
use crate::scene::{Estimator, Light, LinkMask, Scene};
use crate::spectrum::Spectrum;
use profile::{PackedProfile, Profiles};
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

/// The light from outside the scene; a map is appended to the texels.
///
/// # Errors
/// [`PackError::TooManyTexels`] where 32 bits cannot number them.
pub fn environment(scene: &Scene, textures: &mut PackedTextures) -> Result<PackedEnvironment, PackError> {
    let outside = scene.lights.iter().filter_map(Light::outside);
    let parts = outside.map(|(parameters, switch)| PackedEnvironment::new(&parameters, switch, textures));
    Ok(PackedEnvironment::of(parts.collect::<Result<Vec<_>, _>>()?.into_iter()))
}

/// The lights from which next event estimation chooses.
#[derive(Debug, Default)]
pub struct SampledLights {
    pub lights: Vec<PackedLight>,
    /// By light, which receivers it lights; empty where each lights all.
    pub links: Vec<LinkMask>,
    /// How many of them stand inside the scene: the first.
    pub local_count: usize,
    /// Nodes of the tree by which those are chosen; empty where they are chosen by power.
    pub nodes: Vec<LightNode>,
    /// The table by which they are chosen in cells, of which nothing is known yet; empty where they are chosen otherwise.
    pub cells: Vec<u32>,
    /// Profiles that lights name.
    pub profiles: Vec<PackedProfile>,
}

/// The textures that the scene's lights project, as they are [mentioned](texture::mention); NONE where a light projects none.
pub fn projected_textures(scene: &Scene) -> Vec<u32> {
    let mention = |light: &Light| light.texture().map_or(NONE, |texture| texture::mention(texture, None));
    scene.lights.iter().map(mention).collect()
}

/// All sampled lights, with the textures of the scene's projection lights; marks the primitives that are
/// lights with their index. The order is that of the reference. Importance maps of textured area lights are
/// appended to the texels.
///
/// # Errors
/// [`PackError::TooManyTexels`] where 32 bits cannot number them.
pub fn collect(
    scene: &Scene,
    world: &mut WorldGeometry,
    environment: &PackedEnvironment,
    projected_textures: &[u32],
    textures: &mut PackedTextures,
) -> Result<SampledLights, PackError> {
    // Asked once a material, not once a triangle: a texture's mean looks at all of it, and a blend's at all of its parts.
    let emits = scene.materials_that(|material| material.emission.is_some());
    let two_sided = scene.materials_that(|material| material.emission.is_some_and(|emission| emission.two_sided));
    let emissions: Vec<_> = (0..emits.len()).map(|id| emits[id].then(|| SurfaceEmission::of(scene, id, two_sided[id]))).collect();
    let maps = EmissionMaps::new(scene);
    let mut warps: HashMap<(usize, Unrolled), PackedWarp> = HashMap::new();
    let (mut surfaces, mut surface_lights) = (Vec::new(), Vec::new());
    let is_sampled = scene.render.estimator != Estimator::Bsdf;
    for primitive in world.primitives.iter_mut().filter(|_| is_sampled) {
        let Some(emission) = &emissions[primitive.material] else { continue };
        let attributes = world.attributes.get(primitive.attributes as usize);
        // Second texture coordinates, where there are any, stand behind the first.
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
            // Surfaces are the first lights.
            primitive.light = surfaces.len() as u32;
            surfaces.push(EmittingSurface { shape: primitive.shape, material: primitive.material, power });
            surface_lights.push(light);
        }
    }
    let outside = OutsideLight { mean_luminance: environment.mean_luminance, is_constant: environment.is_constant };
    let areas: Vec<f64> = world.portals.iter().map(WorldPrimitive::area).collect();
    let LightList { sources, sampler } = LightList::new(scene, &surfaces, outside, &areas);
    let mut profiles = Profiles::default();
    let mut profile_numbers: HashMap<usize, u32> = HashMap::new();
    for source in &sources {
        if let LightSource::Delta(number) = *source
            && let Some(aimed) = scene.lights[number].profile()
        {
            profile_numbers.insert(number, profiles.add(aimed, textures)?);
        }
    }
    let profiles = profiles.records;
    let packed = |source: &LightSource| match *source {
        LightSource::Surface(number) => Some(surface_lights[number]),
        LightSource::Delta(number) => {
            let light = &scene.lights[number];
            let profile = profile_numbers.get(&number).copied().unwrap_or(NONE);
            let mut parameters = light.delta()?;
            if !scene.light_groups.shows(scene.light_groups.of_light(number)) {
                parameters.color = Spectrum::BLACK;
            }
            Some(PackedLight::delta(delta_kind(light)?, &parameters, projected_textures[number], profile))
        }
        LightSource::Environment => Some(PackedLight::at(DVec3::ZERO, Spectrum::BLACK).of_kind(LightKind::Environment)),
        LightSource::Portal(number) => portal_light(&world.portals[number]),
    };
    let mut lights: Vec<PackedLight> = sources.iter().filter_map(packed).collect();
    let links = links_of(scene, &sources, &surfaces);
    let table = sampler.table();
    for (index, light) in lights.iter_mut().enumerate() {
        light.alias = table.alias[index];
        light.alias_threshold = table.threshold[index];
        light.pmf = table.pmf[index] as f32;
    }
    let local_count = sampler.local_count();
    match LightStrategy::of(scene.render.light_choice, &sampler) {
        LightStrategy::Power => return Ok(SampledLights { lights, links, local_count, profiles, ..SampledLights::default() }),
        LightStrategy::Cells => {
            let cells = LightCells::default().words().to_vec();
            return Ok(SampledLights { lights, links, local_count, cells, profiles, ..SampledLights::default() });
        }
        LightStrategy::Tree => choose_at_infinity_apart(&mut lights[local_count..], local_count, &sampler.table_at_infinity()),
    }
    let of_surface = |(primitive, surface): (&WorldPrimitive, &EmittingSurface)| {
        Some(emitter(scene, primitive, emissions[primitive.material].as_ref()?, surface.power))
    };
    let surfaces = world.primitives.iter().filter(|primitive| primitive.light != NONE).zip(&surfaces).filter_map(of_surface);
    let delta_lights = scene.lights.iter().filter_map(Light::delta).filter(|light| light.strength.is_positive());
    let emitters: Vec<Emitter> = surfaces.chain(delta_lights.filter_map(|light| Emitter::delta(&light))).collect();
    let LightTree { nodes, trails, .. } = LightTree::new(&emitters, sampler.table_at_infinity());
    for (light, trail) in lights.iter_mut().zip(trails) {
        light.trail = trail;
    }
    Ok(SampledLights { lights, links, local_count, nodes, profiles, ..SampledLights::default() })
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

/// An emitting surface as the light tree sees it.
fn emitter(scene: &Scene, primitive: &WorldPrimitive, emission: &SurfaceEmission, power: f64) -> Emitter {
    let bounds = primitive.geometry.extent().unwrap_or_default();
    if primitive.moves() {
        return Emitter::moving(&scene.shapes[primitive.shape], scene.camera.shutter, bounds, power);
    }
    Emitter::surface(bounds, primitive.geometry.light_normal(), emission.two_sided(), power)
}

/// A portal as a light; None where points of it cannot be drawn.
fn portal_light(portal: &WorldPrimitive) -> Option<PackedLight> {
    let (size, [p0, p1, p2]) = portal.geometry.light()?;
    let light = PackedLight {
        kind_and_flags: (portal.kind() as u32) << PORTAL_SHIFT,
        size: size as f32,
        p1: p1.as_vec3().to_array(),
        p2: p2.as_vec3().to_array(),
        ..PackedLight::at(p0, Spectrum::BLACK)
    };
    Some(light.of_kind(LightKind::Portal))
}
