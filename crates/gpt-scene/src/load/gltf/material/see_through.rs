//! Surfaces that are not everywhere, or not from everywhere: alpha, backs that are not there, and outlines.

use super::{Surface, alpha_weight};
use crate::load::file::material::blend_weight::{BlendWeightEntry, NoKeys, ThresholdWeight};
use crate::load::file::material::{MaterialEntry, blend, pass};
use crate::load::file::value::Number;

impl Surface<'_, '_> {
    /// Nothing where it is seen from behind, unless both sides are there.
    pub(super) fn culled(&mut self, entry: MaterialEntry) -> MaterialEntry {
        if self.material.double_sided || self.has_volume() || matches!(entry, MaterialEntry::Pass(_)) {
            return entry;
        }
        let front = BlendWeightEntry::Front(NoKeys {});
        if self.form.is_outline {
            let entry = self.over_nothing(entry, front, "surface");
            return self.over_nothing(entry, BlendWeightEntry::Camera(NoKeys {}), "outline");
        }
        self.over_nothing(entry, front, "front")
    }

    /// A surface by its share, else what is behind. The whole keeps the light and the normals of the surface.
    fn over_nothing(&mut self, mut entry: MaterialEntry, share: BlendWeightEntry, what: &str) -> MaterialEntry {
        let part = entry.common_mut();
        let (normal_map, normal_scale) = (part.normal_map.take(), part.normal_scale.take());
        let interior = part.interior.take();
        let emission = if what == "front" { (part.emission.take(), part.emission_two_sided.take()) } else { (None, None) };
        let mut mixed = self.mixed(entry, share, what);
        let whole = mixed.common_mut();
        (*whole.normal_map, *whole.normal_scale, *whole.interior) = (normal_map, normal_scale, interior);
        (*whole.emission, *whole.emission_two_sided) = emission;
        mixed
    }

    /// The surface by its share, nothing by the rest.
    fn mixed(&mut self, surface: MaterialEntry, share: BlendWeightEntry, what: &str) -> MaterialEntry {
        let nothing = MaterialEntry::from(pass::Keys::default());
        let (first, second) = (self.extra(what, surface), self.extra("rest", nothing));
        MaterialEntry::from(blend::Keys::of([first, second], share, &self.place()))
    }

    /// The surface as far as its alpha says, else what is behind.
    pub(super) fn see_through(&mut self, entry: MaterialEntry, factor: f64) -> Result<MaterialEntry, String> {
        let cutoff = match self.material.alpha_mode.as_deref() {
            None | Some("OPAQUE") => return Ok(entry),
            Some("MASK") => Some(self.material.alpha_cutoff.unwrap_or(0.5)),
            Some("BLEND") => None,
            Some(other) => {
                self.approximate(&format!("alphaMode {other}"), "the surface is opaque");
                return Ok(entry);
            }
        };
        let map = match self.base_colour().1 {
            Some(info) => Some(self.base_texture(&info)?),
            None => self.form.paint.as_ref().filter(|paint| paint.has_alpha).map(|paint| paint.texture.clone()),
        };
        let nothing = || MaterialEntry::from(pass::Keys::default());
        let place = self.place();
        let share = match (map, cutoff) {
            (None, Some(cutoff)) => return Ok(if factor < cutoff { nothing() } else { entry }),
            (None, None) if factor == 1.0 => return Ok(entry),
            (None, None) if factor == 0.0 => return Ok(nothing()),
            (None, None) => BlendWeightEntry::constant(factor)?,
            (Some(map), None) => alpha_weight(&map, factor, &place)?,
            (Some(map), Some(cutoff)) => BlendWeightEntry::Threshold(ThresholdWeight {
                tau: Number::of(cutoff)?,
                of: Box::new(alpha_weight(&map, factor, &place)?),
            }),
        };
        Ok(self.over_nothing(entry, share, "surface"))
    }
}
