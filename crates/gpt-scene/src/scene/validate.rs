//! The rules that a scene keeps before a renderer may take it.
//!
//! Files are checked as they are read, with the line of each mistake. A scene that a program builds by hand is checked here, whichever
//! device renders it: both the packed scene and the reference look indices up without asking again.

use super::blend_tree::check_blends;
use super::check::{Check, image, is_amount, is_positive};
use super::light::{Environment, EnvironmentRadiance, Light};
use super::material::{BlendWeight, LayerStack, Material, MaterialId, MaterialKind, ParameterType, Subsurface};
use super::medium::MediumId;
use super::model::Scene;
use super::settings::{BadSetting, BlendMode};
use super::shape::{Geometry, Shape};
use super::texture::{ChannelInput, ColorInput, Relief, Texture, TextureId, TextureKind, UvTransform};
use crate::spectrum::Spectrum;

/// Most octaves of Perlin noise: further ones are finer than the numbers that they are computed in.
pub const MOST_OCTAVES: u32 = 16;
/// A mistake in a scene, with the part that has it.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{part}: {message}")]
pub struct InvalidScene {
    /// The part's name in reports: a shape's label, "material `name`", "camera".
    pub part: String,
    pub message: String,
}

/// Names the part that a check was of.
fn of(part: impl FnOnce() -> String, check: Check) -> Result<(), InvalidScene> {
    check.map_err(|message| InvalidScene { part: part(), message })
}

impl Scene {
    /// Checks that every index is in range, that numbers are finite and in their range, and that paths end. It takes time in proportion to
    /// the scene's size.
    ///
    /// # Errors
    /// The first part of the scene that cannot be rendered, and what is wrong with it.
    pub fn validate(&self) -> Result<(), InvalidScene> {
        let words = |bad: BadSetting| bad.to_string();
        of(|| "film".into(), self.film.check().map_err(words))?;
        of(|| "render settings".into(), self.render.check().map_err(words))?;
        of(|| "camera".into(), self.camera.check(self.film.size))?;
        for texture in &self.textures {
            of(|| format!("texture `{}`", texture.name), check_texture(texture).and(self.check_times(texture)))?;
        }
        for medium in &self.media {
            of(|| format!("medium `{}`", medium.name), medium.check())?;
        }
        of(|| "camera".into(), self.camera_medium.map_or(Ok(()), |id| self.medium_exists(id)))?;
        // Checks of materials follow blends to their ends.
        check_blends(&self.materials).map_err(|(id, message)| {
            let part = format!("material `{}`", self.materials[id].name);
            InvalidScene { part, message }
        })?;
        for material in &self.materials {
            of(|| format!("material `{}`", material.name), self.check_material(material))?;
        }
        let textured = self.materials_that(Material::uses_texture);
        let open = self.openness();
        let mut kinds: Vec<[u64; 2]> = open.iter().flatten().map(|kind| kind.map(f64::to_bits)).collect();
        kinds.sort_unstable();
        kinds.dedup();
        if kinds.len() > 2 {
            let message = "weights by openness (`open`) of a scene have at most two pairs of `distance` and `power`".into();
            return Err(InvalidScene { part: "materials".into(), message });
        }
        for shape in &self.shapes {
            of(|| shape.label.clone(), self.check_shape(shape, &textured).and_then(|()| check_openness(shape, &open, true)))?;
        }
        self.validate_instances(&textured)?;
        for (index, entry) in self.lights.iter().enumerate() {
            let projected = entry.texture().map_or(Ok(()), |texture| self.texture_exists(texture));
            of(|| format!("light[{index}]"), projected.and(entry.check()))?;
        }
        of(|| "environment".into(), self.check_environments().and(self.check_light_groups()))?;
        of(|| "light links".into(), self.check_light_links())
    }

    fn validate_instances(&self, textured: &[bool]) -> Result<(), InvalidScene> {
        for group in &self.groups {
            for shape in &group.shapes {
                let checked = self.check_shape(shape, textured).and_then(|()| check_openness(shape, &self.openness(), false));
                of(|| shape.label.clone(), checked)?;
            }
            of(|| format!("group `{}`", group.name), self.check_group(group))?;
        }
        let (emits, balls) = (self.materials_that(|material| material.emission.is_some()), self.balls());
        let check = |entry| self.check_instances(entry, textured, &emits, &balls);
        self.instances.iter().try_for_each(|entry| of(|| entry.label.clone(), check(entry)))
    }

    /// The distances and powers of the weights by openness in each material, at any depth of blends and stacks.
    pub fn openness(&self) -> Vec<Vec<[f64; 2]>> {
        let of_weight = |material: &Material| match &material.kind {
            MaterialKind::Blend { weight, .. } => weight.openness(),
            _ => None,
        };
        let is_used = self.materials.iter().any(|material| of_weight(material).is_some());
        let all_of = |id: MaterialId| {
            let (mut found, mut to_visit, mut visited) = (Vec::new(), vec![id], std::collections::BTreeSet::new());
            while let Some(id) = to_visit.pop().filter(|_| is_used) {
                if visited.insert(id) {
                    found.extend(of_weight(&self.materials[id]));
                    to_visit.extend_from_slice(self.materials[id].parts());
                    if let MaterialKind::Layered(layers) = &self.materials[id].kind {
                        to_visit.extend_from_slice(&layers.interfaces);
                    }
                }
            }
            found
        };
        (0..self.materials.len()).map(all_of).collect()
    }

    fn medium_exists(&self, id: MediumId) -> Check {
        if id < self.media.len() { Ok(()) } else { Err(format!("there is no medium {id}")) }
    }

    fn check_material(&self, material: &Material) -> Check {
        material.interior.map_or(Ok(()), |id| self.medium_exists(id))?;
        if let Some(id) = material.normal_map {
            self.texture_exists(id)?;
            if self.textures[id].times.is_some() {
                return Err("its normal map is a product of textures".into());
            }
        }
        if let Some(emission) = &material.emission {
            self.color(&emission.radiance)?;
        }
        if let MaterialKind::Blend { materials, weight } = &material.kind {
            materials.iter().try_for_each(|&id| self.material_exists(id))?;
            if materials.iter().any(|&id| self.materials[id].normal_map.is_some()) {
                return Err("the normal map of a blend is its own, not that of a part".into());
            }
            self.weight(weight)?;
        }
        if let MaterialKind::Layered(layers) = &material.kind {
            self.check_layers(layers)?;
        }
        if let MaterialKind::Principled(principled) = &material.kind
            && principled.coat_normal_map.is_some_and(|map| !map.scale.is_finite())
        {
            return Err("the scale of its coat's normal map must be finite".into());
        }
        if let MaterialKind::Principled(principled) = &material.kind
            && let Some(Subsurface { color, radius, anisotropy, .. }) = principled.subsurface
        {
            if !(color.is_finite() && color.min_component() >= 0.0 && color.max_component() <= 1.0) {
                return Err("its colour below the surface must be from 0 to 1".into());
            }
            if !(radius.is_finite() && radius.min_component() > 0.0) {
                return Err("its mean free path below the surface must be finite and above 0".into());
            }
            if !(-0.999..=0.999).contains(&anisotropy) {
                return Err("its mean cosine below the surface must be from -0.999 to 0.999".into());
            }
            if principled.thin || principled.attenuation.is_some() || material.interior.is_some() {
                return Err("what is below its surface is stated twice".into());
            }
        }
        let Some(lobe) = material.kind.lobe() else { return Ok(()) };
        if lobe.ior.is_some_and(|ior| !is_positive(ior)) {
            return Err("the index of refraction must be positive".into());
        }
        lobe.inputs().try_for_each(|(parameter_type, input)| match (parameter_type, input) {
            (ParameterType::SignedScalar | ParameterType::Vector, ColorInput::Constant(vector)) if vector.is_finite() => Ok(()),
            _ => self.color(&input),
        })
    }

    fn check_layers(&self, layers: &LayerStack) -> Check {
        layers.interfaces.iter().try_for_each(|&id| self.material_exists(id))?;
        if layers.interfaces.is_empty() || layers.slabs.len() + 1 != layers.interfaces.len() {
            return Err("it needs an interface, and one slab between each two".into());
        }
        for slab in &layers.slabs {
            self.color(&slab.thickness)?;
            let Some(id) = slab.medium else { continue };
            self.medium_exists(id)?;
            self.check_slab(id)?;
        }
        layers.interfaces.iter().try_for_each(|&id| self.check_interface(id))?;
        let is_by_direction = |&id: &MaterialId| self.is_blended_by_direction(id);
        if self.render.blend == BlendMode::Pick && layers.interfaces.iter().any(is_by_direction) {
            return Err("with `blend = \"pick\"` no interface may be blended by the direction that it is seen from".into());
        }
        Ok(())
    }

    fn weight(&self, mut weight: &BlendWeight) -> Check {
        loop {
            weight = match weight {
                BlendWeight::Texture { texture } => return self.texture_exists(*texture),
                BlendWeight::Channel { texture, factor, .. } if (0.0..=1.0).contains(factor) => {
                    return self.texture_exists(*texture);
                }
                BlendWeight::Reverse { of } => of,
                BlendWeight::Threshold { tau, of } if tau.is_finite() => of,
                BlendWeight::Front | BlendWeight::Camera => return Ok(()),
                BlendWeight::Constant { value } if (0.0..=1.0).contains(value) => return Ok(()),
                BlendWeight::Up { axis, power } if is_positive(*power) && (axis.length() - 1.0).abs() < 1e-6 => return Ok(()),
                BlendWeight::Open { distance, power } if is_positive(*power) && is_positive(*distance) => return Ok(()),
                BlendWeight::Facing { power } if power.is_finite() && *power >= 0.0 => return Ok(()),
                BlendWeight::Fresnel { ior, .. } if is_positive(*ior) => return Ok(()),
                _ => return Err("a number of the blend's weight is out of its range".into()),
            }
        }
    }

    fn color(&self, input: &ColorInput) -> Check {
        match input {
            ColorInput::Constant(color) if is_amount(*color) => Ok(()),
            ColorInput::Constant(_) => Err("a colour, or a complex index of refraction, must be finite and not negative".into()),
            ColorInput::ScaledTexture(_, factor) if !is_amount(*factor) => {
                Err("the factor of a texture must be finite and not negative".into())
            }
            ColorInput::Channel(ChannelInput { factor, .. }) if !is_amount(*factor) => {
                Err("the factor of a texture must be finite and not negative".into())
            }
            ColorInput::Texture(id) | ColorInput::ScaledTexture(id, _) | ColorInput::SquaredTexture(id) => {
                self.texture_exists(*id)
            }
            ColorInput::Channel(ChannelInput { texture, .. }) => self.texture_exists(*texture),
        }
    }

    /// A product has two textures.
    fn check_times(&self, texture: &Texture) -> Check {
        let Some(other) = texture.times else { return Ok(()) };
        self.texture_exists(other)?;
        if self.textures[other].times.is_some() { Err("it is multiplied by a product".into()) } else { Ok(()) }
    }

    fn texture_exists(&self, id: TextureId) -> Check {
        if id < self.textures.len() { Ok(()) } else { Err(format!("there is no texture {id}")) }
    }

    fn material_exists(&self, id: MaterialId) -> Check {
        if id < self.materials.len() { Ok(()) } else { Err(format!("there is no material {id}")) }
    }

    fn has_bump_map(&self, id: MaterialId) -> bool {
        let map = self.materials[id].normal_map.and_then(|id| self.textures.get(id));
        map.is_some_and(|map| matches!(map.relief, Relief::Heights(_)))
    }

    fn check_shape(&self, shape: &Shape, textured: &[bool]) -> Check {
        shape.geometry.check()?;
        shape.check_place()?;
        shape.check_motion(self.camera.shutter).map_err(|(_, message)| message)?;
        if shape.portal && shape.geometry.is_infinite() {
            return Err("a plane cannot be a portal".into());
        }
        self.material_exists(shape.material)?;
        shape.materials().try_for_each(|id| self.material_exists(id))?;
        if shape.geometry.lacks_uv().is_some() && shape.materials().any(|id| textured[id]) {
            return Err("a textured material needs texture coordinates".into());
        }
        let has_edges = matches!(shape.geometry, Geometry::Mesh(_) | Geometry::Rectangle(_) | Geometry::Box(_));
        if !has_edges && shape.materials().any(|id| self.has_bump_map(id)) {
            return Err(
                "a bump map is for meshes, rectangles and boxes, whose texture coordinates have directions everywhere".into()
            );
        }
        Ok(())
    }

    /// Constant ones add up; a map or a sky stands alone.
    fn check_environments(&self) -> Check {
        let environments = || self.lights.iter().filter(|light| light.is_environment());
        let is_constant =
            |light: &Light| matches!(light, Light::Environment(Environment { radiance: EnvironmentRadiance::Constant(_), .. }));
        if environments().count() > 1 && !environments().all(is_constant) {
            return Err("a map or a sky is the scene's only environment".into());
        }
        Ok(())
    }
}

/// Weights by openness are baked at the vertices of a mesh that stands in one place, in its second texture coordinates.
fn check_openness(shape: &Shape, open: &[Vec<[f64; 2]>], stands_alone: bool) -> Check {
    if !shape.materials().any(|id| open.get(id).is_some_and(|kinds| !kinds.is_empty())) {
        return Ok(());
    }
    let Geometry::Mesh(mesh) = &shape.geometry else {
        return Err("a weight by openness (`open`) is computed at the vertices of meshes, and this is none".into());
    };
    if !stands_alone {
        return Err("a weight by openness (`open`) depends on what is around a mesh, which instances do not share".into());
    }
    if !mesh.second_uvs.is_empty() {
        return Err("a weight by openness (`open`) takes the place of second texture coordinates, which this mesh has".into());
    }
    Ok(())
}

fn check_texture(texture: &Texture) -> Check {
    let (Relief::Normals(scale) | Relief::Heights(scale)) = texture.relief;
    if !scale.is_finite() {
        return Err("its relief must be finite".into());
    }
    if let (Relief::Heights(_), TextureKind::Checker { .. }) = (texture.relief, &texture.kind) {
        return Err("a checker rises in steps: it has no slopes, by which a bump map bends normals".into());
    }
    let UvTransform { rotation_degrees, offset } = texture.transform;
    if !rotation_degrees.is_finite() || !offset.into_iter().all(f64::is_finite) {
        return Err("its rotation and its offset must be finite".into());
    }
    match &texture.kind {
        TextureKind::Image(texture) => {
            let finite = texture.scale.into_iter().all(f64::is_finite);
            if finite { image(&texture.image) } else { Err("its scale must be finite".into()) }
        }
        TextureKind::Checker { a, b, scale } => between(*a, *b, scale.iter().all(|factor| factor.is_finite())),
        TextureKind::Perlin { octaves, .. } if !(1..=MOST_OCTAVES).contains(octaves) => {
            Err(format!("{octaves} octaves; 1 to {MOST_OCTAVES} are possible"))
        }
        TextureKind::Perlin { a, b, scale, .. } | TextureKind::Worley { a, b, scale, .. } => between(*a, *b, scale.is_finite()),
    }
}

fn between(a: Spectrum, b: Spectrum, scale_is_finite: bool) -> Check {
    let possible = a.is_finite() && b.is_finite() && scale_is_finite;
    if possible { Ok(()) } else { Err("its colours and its scale must be finite".into()) }
}

#[cfg(test)]
mod tests;
