//! The record of a light in the device's tables.

use glam::DVec3;

use crate::packed::constants::NONE;
use crate::packed::shape::PrimitiveKind;
use crate::sampling::light_tree::{self, LightNode};
use crate::sampling::solid_angle as strategy;
use crate::scene::LightParameters;
use crate::scene::light::light_table;
use crate::shader::shared::{Constant, Constants, shared_constants};
use crate::spectrum::Spectrum;

/// Kinds below this are those of primitives: an emitting surface is a light of its kind.
const SURFACE_KINDS: u32 = PrimitiveKind::ALL.len() as u32;

/// The rest of the kinds: portals, the environment, and the delta lights of the table of lights.
macro_rules! kinds {
    (environment { $($environment:tt)* } delta { $($delta:ident($type:ident) $module:ident $number:ident $($needed:ident)*,)* }) => {
        /// The kind of a light that is no surface.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[repr(u32)]
        pub enum LightKind {
            /// A portal; the kind of its shape, that of any primitive with an area, stands from bit
            /// `PORTAL_SHIFT` on.
            Portal = SURFACE_KINDS,
            Environment,
            $($delta,)*
        }

        impl LightKind {
            /// The lights that each point sees along one direction alone.
            pub const DELTA: &'static [Self] = &[$(Self::$delta),*];

            /// The name of its number in shaders; for a delta light also the switch that compiles it.
            pub fn number_name(self) -> &'static str {
                match self {
                    Self::Portal => "LIGHT_PORTAL",
                    Self::Environment => "LIGHT_ENVIRONMENT",
                    $(Self::$delta => stringify!($number),)*
                }
            }

            /// The name of a delta light's file in `shaders/shading/light/`, and in the name of its function there.
            pub fn file(self) -> Option<&'static str> {
                match self {
                    Self::Portal | Self::Environment => None,
                    $(Self::$delta => Some(stringify!($module)),)*
                }
            }
        }
    };
}
light_table!(kinds);

impl LightKind {
    /// All, in the order of their numbers.
    pub fn all() -> impl Iterator<Item = Self> {
        [Self::Portal, Self::Environment].into_iter().chain(Self::DELTA.iter().copied())
    }
}

shared_constants!(flags {
    /// Words of a light in the tables.
    pub const LIGHT_WORDS: u32 = (size_of::<PackedLight>() / 16) as u32;
    pub(in crate::packed) const LIGHT_TWO_SIDED: u32 = 256;
    /// The radiance is that of the whole material, seen from where the light goes.
    pub(in crate::packed) const LIGHT_VARIES: u32 = 512;
    /// A rectangle or a triangle whose points are drawn by solid angle where that is large enough.
    pub(in crate::packed) const LIGHT_BY_SOLID_ANGLE: u32 = 2048;
    /// The least solid angle of rectangles, and the least distance of the point from the plane as a share of that of the farthest side.
    const LEAST_RECTANGLE_SOLID_ANGLE: f32 = strategy::LEAST_SOLID_ANGLE as f32;
    const LEAST_RECTANGLE_DISTANCE: f32 = strategy::LEAST_DISTANCE as f32;
    /// The least solid angle and share of triangles; the share is one of a volume.
    const LEAST_TRIANGLE_SOLID_ANGLE: f32 = strategy::LEAST_TRIANGLE_SOLID_ANGLE as f32;
    const LEAST_TRIANGLE_SHARE: f32 = strategy::LEAST_TRIANGLE_SHARE as f32;
    /// Its points move as its attributes say.
    pub(in crate::packed) const LIGHT_MOVES: u32 = 1024;
    /// Its points are drawn by what it shows: where that density stands is in place of the radiance.
    pub(in crate::packed) const LIGHT_WARPED: u32 = 4096;
    /// Its texture coordinates run against its first edge.
    pub(in crate::packed) const LIGHT_REVERSED: u32 = 8192;
    /// Bit from which on the number of a delta light's form stands.
    pub(in crate::packed) const LIGHT_FORM_SHIFT: u32 = 16;
    /// Falloff of a spot light's intensity between its angles.
    const SPOT_FALLOFF_SQUARE: u32 = crate::scene::light::FALLOFF_SQUARE;
    const SPOT_FALLOFF_LINEAR: u32 = crate::scene::light::FALLOFF_LINEAR;
    /// Bit from which on the kind of a portal's shape stands.
    pub(in crate::packed) const PORTAL_SHIFT: u32 = 12;
    /// Words of a node in the tree of lights.
    pub const LIGHT_NODE_WORDS: u32 = (size_of::<LightNode>() / 16) as u32;
    /// Flags of a link there, and what masks its number.
    const LIGHT_LEAF: u32 = light_tree::LEAF;
    const LIGHT_CLUSTER_TWO_SIDED: u32 = light_tree::TWO_SIDED;
    const LIGHT_NUMBER_MASK: u32 = light_tree::NUMBER_MASK;
});

/// The largest number of a delta light's form.
pub(in crate::packed) const LIGHT_FORMS: u32 = 3;

/// Kinds, flags and sizes, for WGSL.
pub fn constants() -> Constants {
    let kinds = LightKind::all().map(|kind| (kind.number_name(), Constant::U32(kind as u32)));
    kinds.chain(flags()).collect()
}

/// 80 bytes, the layout of `light_word` in `shaders/shading/light/record.wgsl`.
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
    /// Edges from p0; for a disk, two perpendicular radii. Of a delta light, the vectors of its parameters.
    pub p1: [f32; 3],
    /// The light's trail in the tree of lights, where there is one.
    pub trail: u32,
    pub p2: [f32; 3],
    /// The texture of a projection light, or NONE; attributes of a surface.
    pub attributes: u32,
    /// Radiance of a surface; intensity or irradiance of a delta light; the [`PackedWarp`] of a textured area
    /// light.
    pub radiance: [f32; 3],
    /// Material of a surface; of a delta light its profile, or NONE.
    pub material: u32,
}

/// A density over the unit square among the texels: a quadtree, three words for each inner node, and the densities of the cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PackedWarp {
    pub first_node: u32,
    pub first_density: u32,
    /// Cells.
    pub width: u32,
    pub height: u32,
}

impl PackedWarp {
    /// In the place of a radiance.
    pub(super) fn words(self) -> [f32; 3] {
        [self.first_node, self.first_density, self.width | self.height << 16].map(f32::from_bits)
    }
}

impl PackedLight {
    /// A light that is no surface, of no kind yet and with no probability.
    pub(super) fn at(position: DVec3, radiance: Spectrum) -> Self {
        Self {
            kind_and_flags: 0,
            alias_threshold: u32::MAX,
            alias: 0,
            pmf: 1.0,
            p0: position.as_vec3().to_array(),
            size: 0.0,
            p1: [0.0; 3],
            trail: 0,
            p2: [0.0; 3],
            attributes: NONE,
            radiance: radiance.to_f32(),
            material: NONE,
        }
    }

    /// The light with this kind.
    pub(super) fn of_kind(self, kind: LightKind) -> Self {
        Self { kind_and_flags: self.kind_and_flags | kind as u32, ..self }
    }

    /// A delta light that projects this texture and has this profile; NONE for either stands for none.
    pub(super) fn delta(kind: LightKind, parameters: &LightParameters, texture: u32, profile: u32) -> Self {
        let [p1, p2] = parameters.vectors.map(|vector| vector.as_vec3().to_array());
        let (kind_and_flags, size) = (parameters.form << LIGHT_FORM_SHIFT, parameters.number as f32);
        let plain = Self::at(parameters.position, parameters.color);
        Self { kind_and_flags, size, p1, p2, attributes: texture, material: profile, ..plain }.of_kind(kind)
    }

    /// Number of a delta light's form.
    pub fn form(&self) -> u32 {
        if self.is_delta() { self.kind_and_flags >> LIGHT_FORM_SHIFT & LIGHT_FORMS } else { 0 }
    }

    /// True of a projection light: a delta light with a texture.
    pub fn projects_texture(&self) -> bool {
        self.is_delta() && self.attributes != NONE
    }

    /// True of a delta light whose intensity differs from direction to direction by a profile.
    pub fn has_profile(&self) -> bool {
        self.is_delta() && self.material != NONE
    }

    /// Its radiance is looked up in the whole material.
    pub fn varies(&self) -> bool {
        self.kind_and_flags & LIGHT_VARIES != 0
    }

    /// True of a surface of this kind whose points are sampled by solid angle.
    pub fn is_drawn_by_solid_angle(&self, kind: PrimitiveKind) -> bool {
        self.is_surface() && self.shape() == Some(kind) && self.kind_and_flags & LIGHT_BY_SOLID_ANGLE != 0
    }

    pub fn is_warped(&self) -> bool {
        self.is_surface() && self.kind_and_flags & LIGHT_WARPED != 0
    }

    /// The distribution of its points, where that is not uniform.
    pub fn warp(&self) -> Option<PackedWarp> {
        let [first_node, first_density, size] = self.radiance.map(f32::to_bits);
        let (width, height) = (size & 0xffff, size >> 16);
        self.is_warped().then_some(PackedWarp { first_node, first_density, width, height })
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

    /// True of a surface, whose kind is that of a primitive.
    pub fn is_surface(&self) -> bool {
        self.kind() < SURFACE_KINDS
    }

    /// The shape of a surface or a portal.
    pub fn shape(&self) -> Option<PrimitiveKind> {
        let is_portal = self.is(LightKind::Portal);
        PrimitiveKind::of(if is_portal { self.kind_and_flags >> PORTAL_SHIFT } else { self.kind() })
    }

    pub fn is_delta(&self) -> bool {
        LightKind::DELTA.iter().any(|&kind| self.is(kind))
    }
}
