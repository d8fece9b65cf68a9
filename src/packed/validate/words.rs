//! The meaning of each 32-bit word of a packed record to a kernel, in one place.
//!
//! The [checks](super) go by this list, and their tests corrupt every word of every record by it.

use std::mem::offset_of;

use crate::packed::attributes::TriangleAttributes;
use crate::packed::blend_weight::{PackedBlendWeight, WeightKind};
use crate::packed::bvh4::Node;
use crate::packed::instance::PackedInstance;
use crate::packed::layers::PackedLayer;
use crate::packed::light::PackedLight;
use crate::packed::light::profile::PackedProfile;
use crate::packed::material::{BLEND, LAYERED, PackedBlendPart, PackedMaterial, PackedParameter};
use crate::packed::primitive::Primitive;
use crate::packed::scene::PackedScene;
use crate::packed::texture::{PackedTexture, PackedTextureKind};
use crate::sampling::light_tree::{LightCluster, LightNode};

/// An array of records.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Array {
    Primitives,
    Attributes,
    Nodes,
    Instances,
    Materials,
    Parameters,
    BlendParts,
    Layers,
    Weights,
    Lights,
    LightNodes,
    LightProfiles,
    Textures,
}

impl Array {
    pub const ALL: [Self; 13] = [
        Self::Primitives,
        Self::Attributes,
        Self::Nodes,
        Self::Instances,
        Self::Materials,
        Self::Parameters,
        Self::BlendParts,
        Self::Layers,
        Self::Weights,
        Self::Lights,
        Self::LightNodes,
        Self::LightProfiles,
        Self::Textures,
    ];

    /// The words of a record that are not free, by their place in it.
    pub fn words(self) -> &'static [(usize, Word)] {
        match self {
            Self::Primitives => &PRIMITIVE,
            Self::Attributes => &ATTRIBUTES,
            Self::Nodes => &NODE,
            Self::Instances => &INSTANCE,
            Self::Materials => &MATERIAL,
            Self::Parameters => &PARAMETER,
            Self::BlendParts => &BLEND_PART,
            Self::Layers => &LAYER,
            Self::Weights => &WEIGHT,
            Self::Lights => &LIGHT,
            Self::LightNodes => &LIGHT_NODE,
            Self::LightProfiles => &LIGHT_PROFILE,
            Self::Textures => &TEXTURE,
        }
    }

    /// 32-bit words of a record.
    pub fn record_words(self) -> usize {
        let bytes = match self {
            Self::Primitives => size_of::<Primitive>(),
            Self::Attributes => size_of::<TriangleAttributes>(),
            Self::Nodes => size_of::<Node>(),
            Self::Instances => size_of::<PackedInstance>(),
            Self::Materials => size_of::<PackedMaterial>(),
            Self::Parameters => size_of::<PackedParameter>(),
            Self::BlendParts => size_of::<PackedBlendPart>(),
            Self::Layers => size_of::<PackedLayer>(),
            Self::Weights => size_of::<PackedBlendWeight>(),
            Self::Lights => size_of::<PackedLight>(),
            Self::LightNodes => size_of::<LightNode>(),
            Self::LightProfiles => size_of::<PackedProfile>(),
            Self::Textures => size_of::<PackedTexture>(),
        };
        bytes / 4
    }

    /// All records of a scene, word by word.
    pub fn of(self, scene: &PackedScene) -> &[u32] {
        match self {
            Self::Primitives => bytemuck::cast_slice(&scene.primitives),
            Self::Attributes => bytemuck::cast_slice(&scene.attributes),
            Self::Nodes => bytemuck::cast_slice(&scene.hierarchy.nodes),
            Self::Instances => bytemuck::cast_slice(&scene.instances),
            Self::Materials => bytemuck::cast_slice(&scene.materials.materials),
            Self::Parameters => bytemuck::cast_slice(&scene.materials.further),
            Self::BlendParts => bytemuck::cast_slice(&scene.materials.parts),
            Self::Layers => bytemuck::cast_slice(&scene.materials.layers),
            Self::Weights => bytemuck::cast_slice(&scene.materials.weights),
            Self::Lights => bytemuck::cast_slice(&scene.lights),
            Self::LightNodes => bytemuck::cast_slice(&scene.light_nodes),
            Self::LightProfiles => bytemuck::cast_slice(&scene.light_profiles),
            Self::Textures => bytemuck::cast_slice(&scene.textures.textures),
        }
    }

    /// How many records a scene has.
    pub fn len(self, scene: &PackedScene) -> usize {
        self.of(scene).len() / self.record_words()
    }
}

/// The use of a word. Words in no list are free: numbers to compute with, seeds, thresholds. Whatever bits
/// such a word has, no kernel reads out of bounds by it.
#[derive(Debug, Clone, Copy)]
pub enum Word {
    /// An index into an array.
    Index(Array),
    /// An index into an array, or [`crate::packed::NONE`].
    Optional(Array),
    /// A kind, a flag, a count or the beginning of a run: checked together with other words, by functions of their own.
    Checked,
    /// Such a word in the records of which this holds; free in others.
    CheckedIn(fn(&[u32]) -> bool),
}

use Word::{Checked, CheckedIn, Index, Optional};

macro_rules! word {
    ($record:ty, $field:ident) => {
        offset_of!($record, $field) / 4
    };
}

const PRIMITIVE: [(usize, Word); 3] = [
    (word!(Primitive, kind_and_material), Checked),
    (word!(Primitive, light), Optional(Array::Lights)),
    (word!(Primitive, attributes), Optional(Array::Attributes)),
];

const ATTRIBUTES: [(usize, Word); 1] = [(word!(TriangleAttributes, motion), Checked)];

const NODE: [(usize, Word); 3] = [
    (word!(Node, exponents_and_flags), Checked),
    (word!(Node, first_child), CheckedIn(has_inner_children)),
    (word!(Node, first_primitive_and_sizes), Checked),
];

const INSTANCE: [(usize, Word); 3] = [
    (word!(PackedInstance, root_and_flags), Checked),
    (word!(PackedInstance, material), Optional(Array::Materials)),
    (word!(PackedInstance, motion), Checked),
];

const MATERIAL: [(usize, Word); 11] = [
    (word!(PackedMaterial, kind_and_form), Checked),
    // The run of a blend's parts, or of a stack's layers.
    (word!(PackedMaterial, color1), CheckedIn(has_run)),
    (word!(PackedMaterial, color1) + 1, CheckedIn(has_run)),
    (word!(PackedMaterial, color1) + 2, CheckedIn(is_blend)),
    (word!(PackedMaterial, emission_flags), Checked),
    (word!(PackedMaterial, color0_texture), Optional(Array::Textures)),
    (word!(PackedMaterial, emission_texture), Optional(Array::Textures)),
    (word!(PackedMaterial, color1_texture), Optional(Array::Textures)),
    (word!(PackedMaterial, roughness_texture), Optional(Array::Textures)),
    (word!(PackedMaterial, normal_map), Optional(Array::Textures)),
    (word!(PackedMaterial, further), Checked),
];

const PARAMETER: [(usize, Word); 1] = [(word!(PackedParameter, texture), Optional(Array::Textures))];

const BLEND_PART: [(usize, Word); 3] = [
    (word!(PackedBlendPart, material), Index(Array::Materials)),
    (word!(PackedBlendPart, first_factor), Checked),
    (word!(PackedBlendPart, factor_count), Checked),
];

const LAYER: [(usize, Word); 4] = [
    (word!(PackedLayer, interface), Index(Array::Materials)),
    (word!(PackedLayer, slab_flags), Checked),
    (word!(PackedLayer, thickness_texture), Optional(Array::Textures)),
    (word!(PackedLayer, phase), CheckedIn(is_filled)),
];

const WEIGHT: [(usize, Word); 2] =
    [(word!(PackedBlendWeight, kind_and_flags), Checked), (word!(PackedBlendWeight, texture), CheckedIn(is_of_no_axis))];

const LIGHT: [(usize, Word); 7] = [
    (word!(PackedLight, kind_and_flags), Checked),
    (word!(PackedLight, alias), Index(Array::Lights)),
    // A texture in delta lights, attributes in others.
    (word!(PackedLight, attributes), Checked),
    // Index of a density.
    (word!(PackedLight, radiance), CheckedIn(is_warped)),
    (word!(PackedLight, radiance) + 1, CheckedIn(is_warped)),
    (word!(PackedLight, radiance) + 2, CheckedIn(is_warped)),
    // A profile in delta lights, a material in others.
    (word!(PackedLight, material), Checked),
];

const LIGHT_NODE: [(usize, Word); 2] =
    [(word!(LightCluster, link), Checked), (size_of::<LightCluster>() / 4 + word!(LightCluster, link), Checked)];

const LIGHT_PROFILE: [(usize, Word); 2] = [(word!(PackedProfile, first_word), Checked), (word!(PackedProfile, counts), Checked)];

const TEXTURE: [(usize, Word); 6] = [
    (word!(PackedTexture, kind_and_flags), Checked),
    (word!(PackedTexture, first_texel_or_seed), CheckedIn(is_image)),
    (word!(PackedTexture, width_or_octaves), CheckedIn(|texture| is_image(texture) || is_perlin(texture))),
    (word!(PackedTexture, height), CheckedIn(is_image)),
    (word!(PackedTexture, first_value), CheckedIn(|texture| is_image(texture) && has_values(texture))),
    (word!(PackedTexture, times), Checked),
];

fn is_filled(layer: &[u32]) -> bool {
    layer[word!(PackedLayer, slab_flags)] != 0
}

fn has_run(material: &[u32]) -> bool {
    [BLEND, LAYERED].contains(&(material[word!(PackedMaterial, kind_and_form)] & 255))
}

fn is_blend(material: &[u32]) -> bool {
    material[word!(PackedMaterial, kind_and_form)] & 255 == BLEND
}

fn is_warped(light: &[u32]) -> bool {
    bytemuck::from_bytes::<PackedLight>(bytemuck::cast_slice(light)).is_warped()
}

fn is_image(texture: &[u32]) -> bool {
    texture[word!(PackedTexture, kind_and_flags)] & 255 == PackedTextureKind::Image as u32
}

fn has_values(texture: &[u32]) -> bool {
    bytemuck::from_bytes::<PackedTexture>(bytemuck::cast_slice(texture)).values() > 0
}

fn is_perlin(texture: &[u32]) -> bool {
    texture[word!(PackedTexture, kind_and_flags)] & 255 == PackedTextureKind::Perlin as u32
}

/// Any other weight names a texture, or none.
fn is_of_no_axis(weight: &[u32]) -> bool {
    weight[word!(PackedBlendWeight, kind_and_flags)] & 255 != WeightKind::Up as u32
}

fn has_inner_children(node: &[u32]) -> bool {
    node[word!(Node, exponents_and_flags)] >> 24 & 15 != 0
}
