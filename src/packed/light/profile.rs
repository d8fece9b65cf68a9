//! Profiles of lights, as the device reads them.

use std::collections::HashMap;
use std::sync::Arc;

use crate::packed::error::PackError;
use crate::packed::texture::PackedTextures;
use crate::scene::{AimedProfile, LightProfile};
use crate::shader::shared::{Constants, shared_constants};

shared_constants!(sizes {
    /// Words of a profile in the tables.
    const LIGHT_PROFILE_WORDS: u32 = (size_of::<PackedProfile>() / 16) as u32;
    /// Bit from which on the number of horizontal angles stands.
    pub(in crate::packed) const PROFILE_HORIZONTAL_SHIFT: u32 = 16;
});

/// Sizes, for WGSL.
pub fn constants() -> Constants {
    sizes()
}

/// 32 bytes, two vec4 of the tables: how a profile lies on a light, and its table among the texels. There stand its vertical angles, its horizontal ones,
/// both in whole turns, and for each horizontal angle the candela of all vertical ones.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct PackedProfile {
    /// The direction of vertical angle 0.
    pub nadir: [f32; 3],
    /// Index of the table's first word.
    pub first_word: u32,
    /// The direction of horizontal angle 0.
    pub zero: [f32; 3],
    /// Vertical angles, two or more; from `PROFILE_HORIZONTAL_SHIFT` on horizontal ones, one or more.
    pub counts: u32,
}

impl PackedProfile {
    /// Vertical and horizontal angles.
    pub fn sides(&self) -> [u32; 2] {
        [self.counts & ((1 << PROFILE_HORIZONTAL_SHIFT) - 1), self.counts >> PROFILE_HORIZONTAL_SHIFT]
    }
}

/// The profiles of the lights so far; lights may share a table.
#[derive(Debug, Default)]
pub struct Profiles {
    pub records: Vec<PackedProfile>,
    first_words: HashMap<*const LightProfile, u32>,
}

impl Profiles {
    /// The number of the light's own record; a table that is not there yet is appended to the texels.
    ///
    /// # Errors
    /// [`PackError::TooManyTexels`] where 32 bits cannot number them.
    pub fn add(&mut self, aimed: &AimedProfile, textures: &mut PackedTextures) -> Result<u32, PackError> {
        let profile = &aimed.profile;
        let sides = [profile.vertical(), profile.horizontal()];
        let address = Arc::as_ptr(profile);
        let first_word = match self.first_words.get(&address) {
            Some(known) => *known,
            None => {
                let first = textures.texel_words();
                let turns = sides.into_iter().flatten().map(|degrees| degrees / 360.0);
                textures.words.extend(turns.chain(profile.candela().iter().copied()).map(|value| (value as f32).to_bits()));
                let end = textures.texel_words();
                let first = u32::try_from(first).ok().filter(|_| u32::try_from(end).is_ok());
                let first = first.ok_or(PackError::TooManyTexels { words: end })?;
                self.first_words.insert(address, first);
                first
            }
        };
        let [zero, _, nadir] = aimed.axes().map(|axis| axis.as_vec3().to_array());
        let [vertical, horizontal] = sides.map(|angles| angles.len() as u32);
        let counts = vertical | horizontal << PROFILE_HORIZONTAL_SHIFT;
        self.records.push(PackedProfile { nadir, first_word, zero, counts });
        Ok(self.records.len() as u32 - 1)
    }
}
