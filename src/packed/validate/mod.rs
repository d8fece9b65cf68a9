//! Conditions on a packed scene that must hold before a kernel may read it.
//!
//! Kernels are compiled without bounds checks and without bounds on loops. So every word that a kernel makes an index of, or counts a loop
//! by, is checked here first, in time proportional to the scene. [`words`] lists those words; most are plain indices, the others have
//! functions of their own.

mod environment;
mod geometry;
mod shading;
pub mod words;

use rayon::prelude::*;

use super::constants::NONE;
use super::error::PackError;
use super::object;
use super::scene::PackedScene;
use words::{Array, Word};

/// Records that are checked one after the other before another thread is worth its while.
const MANY: usize = 1 << 14;

/// The fault that was found, in words.
type Check = Result<(), String>;

impl PackedScene {
    /// Every index points into its array, every run ends in it, every loop ends, every leaf's primitives exist, each exactly once.
    ///
    /// # Errors
    /// [`PackError::Inconsistent`]
    pub fn validate(&self) -> Result<(), PackError> {
        self.check().map_err(PackError::Inconsistent)
    }

    fn check(&self) -> Check {
        self.check_lengths()?;
        Array::ALL.into_iter().try_for_each(|array| self.check_indices(array))?;
        self.check_motions()?;
        object::check(&self.objects, self.primitives.len())?;
        self.check_instances()?;
        self.check_primitives()?;
        self.check_hierarchy()?;
        self.check_materials()?;
        self.check_textures()?;
        self.check_lights()?;
        let media = self.materials.media.media.len();
        self.links.check([self.materials.materials.len(), self.lights.len(), self.instances.len(), media])?;
        self.check_environment()
    }

    /// Kernels number the words of an array in 32 bits.
    fn check_lengths(&self) -> Check {
        let tables: usize = [
            Array::Materials,
            Array::BlendParts,
            Array::Weights,
            Array::Lights,
            Array::LightNodes,
            Array::LightProfiles,
            Array::Textures,
        ]
        .into_iter()
        .map(|array| array.of(self).len() / 4)
        .sum();
        let lengths = [
            ("primitives", 3 * self.primitives.len()),
            ("attributes", 4 * self.attributes.len()),
            ("instances", 6 * self.instances.len()),
            ("nodes", 3 * self.hierarchy.nodes.len()),
            ("tables", tables + self.motions.len() + self.objects.len()),
            ("texels", self.textures.texel_words()),
        ];
        match lengths.into_iter().find(|&(_, length)| length >= NONE as usize) {
            Some((name, length)) => Err(format!("the {name} have {length} words, more than 32 bits can number")),
            None => Ok(()),
        }
    }

    /// The words that are indices and nothing else.
    fn check_indices(&self, array: Array) -> Check {
        let indices: Vec<(usize, Array, bool)> = array
            .words()
            .iter()
            .filter_map(|&(place, word)| match word {
                Word::Index(into) => Some((place, into, false)),
                Word::Optional(into) => Some((place, into, true)),
                Word::Checked | Word::CheckedIn(_) => None,
            })
            .collect();
        let check = |(number, record): (usize, &[u32])| {
            for &(place, into, optional) in &indices {
                let index = record[place];
                if index as usize >= into.len(self) && !(optional && index == NONE) {
                    return Err(format!("word {place} of number {number} of the {array:?} names number {index} of the {into:?}"));
                }
            }
            Ok(())
        };
        let records = array.of(self).par_chunks_exact(array.record_words());
        records.enumerate().with_min_len(MANY).try_for_each(check)
    }
}

#[cfg(test)]
mod tests;
