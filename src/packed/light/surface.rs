//! Emitting surfaces as lights.

use std::f64::consts::PI;

use glam::DVec2;

use super::record::{
    LIGHT_BY_SOLID_ANGLE, LIGHT_MOVES, LIGHT_REVERSED, LIGHT_TWO_SIDED, LIGHT_VARIES, LIGHT_WARPED, PackedLight, PackedWarp,
};
use crate::emission_map::{EmissionMaps, EmitterPart};
use crate::packed::attributes::TriangleAttributes;
use crate::packed::material::mean_emission;
use crate::packed::primitive::WorldPrimitive;
use crate::packed::shape::PrimitiveKind;
use crate::packed::texture::color_and_texture;
use crate::sampling::solid_angle::is_rectangle;
use crate::scene::texture::{mean_of_channel, mean_of_texture};
use crate::scene::{ChannelInput, ColorInput, LightSampling, Scene};
use crate::spectrum::Spectrum;
use crate::texture::Coordinates;

/// Emission of the surfaces with some material.
pub struct SurfaceEmission {
    material: usize,
    mean_radiance: Spectrum,
    /// The material, or some part of it, emits from its back too.
    two_sided: bool,
    /// The radiance of a blend changes with its weights, that of a texture over the surface: the whole material is looked up.
    varies: bool,
    /// Radiance of a material without a texture, as it is to be seen.
    radiance: ColorInput,
}

impl SurfaceEmission {
    pub fn of(scene: &Scene, material: usize, two_sided: bool) -> Self {
        let own = scene.materials[material].emission;
        let radiance = own.map_or(ColorInput::grey(0.0), |emission| emission.radiance);
        let is_seen = scene.light_groups.shows(scene.light_groups.of_material(material));
        Self {
            material,
            mean_radiance: mean_emission(scene, material, &|input| mean_color(scene, input)),
            two_sided,
            varies: scene.materials[material].is_blend() || radiance.is_texture(),
            radiance: if is_seen { radiance } else { ColorInput::grey(0.0) },
        }
    }

    pub fn two_sided(&self) -> bool {
        self.two_sided
    }

    /// Luminous power: π·A·L, twice that for two sides. `attributes` are those of the primitive, for either set of texture coordinates.
    pub fn power(&self, primitive: &WorldPrimitive, maps: &EmissionMaps, attributes: [Option<&TriangleAttributes>; 2]) -> f64 {
        let of_part = emitter_part(primitive, attributes).and_then(|part| maps.luminance(self.material, &part));
        let luminance = of_part.unwrap_or(self.mean_radiance.luminance());
        // An infinite plane that does not emit has no power: 0, not 0·∞.
        if luminance == 0.0 {
            return 0.0;
        }
        PI * primitive.area() * luminance * if self.two_sided { 2.0 } else { 1.0 }
    }
}

fn mean_color(scene: &Scene, input: &ColorInput) -> Spectrum {
    let mean = |texture: usize| mean_of_texture(&scene.textures, texture);
    match input {
        ColorInput::Constant(color) => *color,
        ColorInput::Texture(texture) => mean(*texture),
        ColorInput::ScaledTexture(texture, factor) => mean(*texture) * *factor,
        ColorInput::SquaredTexture(texture) => mean(*texture) * mean(*texture),
        ColorInput::Channel(ChannelInput { texture, channel, factor, .. }) => {
            mean_of_channel(&scene.textures, *texture, *channel) * *factor
        }
    }
}

/// The part of an area light that a primitive is; None of what has no texture coordinates.
fn emitter_part(primitive: &WorldPrimitive, attributes: [Option<&TriangleAttributes>; 2]) -> Option<EmitterPart> {
    if primitive.kind() != PrimitiveKind::Triangle {
        return primitive.kind().unrolled().map(EmitterPart::Whole);
    }
    let uvs =
        |of: &TriangleAttributes| [[of.u0, of.v0], [of.u1, of.v1], [of.u2, of.v2]].map(|[u, v]| DVec2::new(u.into(), v.into()));
    let first = uvs(attributes[0]?);
    let second = attributes[1].map_or(first, uvs);
    Some(EmitterPart::Triangle(std::array::from_fn(|corner| Coordinates { first: first[corner], second: second[corner] })))
}

/// The light that an emitting primitive is; None where it cannot be sampled. Whole shapes are drawn by `warp`, where there is one; `attributes` are
/// those of the primitive.
pub fn surface_light(
    primitive: &WorldPrimitive,
    emission: &SurfaceEmission,
    sampling: LightSampling,
    warp: Option<PackedWarp>,
    attributes: Option<&TriangleAttributes>,
) -> Option<PackedLight> {
    let (radiance, _) = color_and_texture(&emission.radiance);
    let (size, [p0, p1, p2]) = primitive.geometry.light()?;
    let flag = |set: bool, bit: u32| if set { bit } else { 0 };
    let is_suited = match primitive.kind() {
        PrimitiveKind::Quad => is_rectangle(p1, p2),
        kind => kind == PrimitiveKind::Triangle,
    };
    let by_solid_angle = is_suited && !primitive.moves() && warp.is_none() && sampling == LightSampling::Cone;
    let is_reversed = warp.is_some() && attributes.is_some_and(|attributes| attributes.u0 > attributes.u1);
    let flags = flag(emission.two_sided, LIGHT_TWO_SIDED)
        | flag(emission.varies, LIGHT_VARIES)
        | flag(by_solid_angle, LIGHT_BY_SOLID_ANGLE)
        | flag(primitive.moves(), LIGHT_MOVES)
        | flag(warp.is_some(), LIGHT_WARPED)
        | flag(is_reversed, LIGHT_REVERSED);
    let plain = PackedLight::at(p0, Spectrum::from_f32(radiance));
    Some(PackedLight {
        kind_and_flags: primitive.kind() as u32 | flags,
        size: size as f32,
        p1: p1.as_vec3().to_array(),
        p2: p2.as_vec3().to_array(),
        attributes: primitive.attributes,
        material: emission.material as u32,
        radiance: warp.map_or(plain.radiance, PackedWarp::words),
        ..plain
    })
}
