//! Light from outside the scene, as the device reads it.

use glam::DVec4;

/// A map's place among the texels: radiance row by row, then the quadtree that directions are drawn by, three words for each inner node,
/// then the densities of the cells that it lies over.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct PackedMap {
    pub first_texel: u32,
    pub width: u32,
    pub height: u32,
    pub first_node: u32,
    pub first_density: u32,
    pub grid_width: u32,
    pub grid_height: u32,
    pub levels: u32,
}

/// The environment. Where it is black, its mean luminance is 0 and kernels hold nothing of it.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct PackedEnvironment {
    /// Averaged over all directions.
    pub mean_luminance: f64,
    /// Three words of the view, which its shader reads: `View::environment` says what they hold.
    pub words: [DVec4; 3],
    /// The same from everywhere: BSDF sampling finds it without a shadow ray.
    pub is_constant: bool,
    /// What compiles its shader; None: the one that needs no switch.
    pub switch: Option<&'static str>,
    pub map: Option<PackedMap>,
}

impl PackedEnvironment {
    pub fn is_black(&self) -> bool {
        self.mean_luminance == 0.0
    }

    /// Constant ones add up; one that varies stands alone.
    pub fn of(parts: impl Iterator<Item = Self>) -> Self {
        let mut sum = Self { is_constant: true, ..Self::default() };
        for part in parts {
            if !part.is_constant {
                return part;
            }
            sum.mean_luminance += part.mean_luminance;
            sum.words[0] += part.words[0];
        }
        sum
    }
}
