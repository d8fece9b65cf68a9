//! Surfaces that are not everywhere, or not from everywhere: alpha, backs that are not there, and outlines.

use super::{Surface, channel_weight};
use crate::load::import::Keys;

impl Surface<'_, '_> {
    /// Nothing where it is seen from behind, unless both sides are there.
    pub(super) fn culled(&mut self, keys: Keys) -> Keys {
        if self.material.double_sided || self.has_volume() || keys.text("type") == Some("pass") {
            return keys;
        }
        if self.form.is_outline {
            let keys = self.over_nothing(keys, Keys::of_type("front"), "surface");
            return self.over_nothing(keys, Keys::of_type("camera"), "outline");
        }
        self.over_nothing(keys, Keys::of_type("front"), "front")
    }

    /// A surface by its share, else what is behind. The whole keeps the light and the normals of the surface.
    fn over_nothing(&mut self, keys: Keys, share: Keys, what: &str) -> Keys {
        let on_whole =
            |key: &str| ["normal_map", "normal_scale"].contains(&key) || what == "front" && key.starts_with("emission");
        let (of_whole, of_part): (Vec<_>, Vec<_>) = keys.0.into_iter().partition(|(key, _)| on_whole(key));
        let mut mixed = self.mixed(Keys(of_part), Keys::of_type("pass"), share, what);
        mixed.0.extend(of_whole);
        mixed
    }

    /// The first by its share, the second by the rest.
    fn mixed(&mut self, first: Keys, second: Keys, share: Keys, what: &str) -> Keys {
        let (first, second) = (self.extra(what, first), self.extra("rest", second));
        Keys::of_type("blend").with("materials", vec![first, second]).with("weight", share)
    }

    /// The surface as far as its alpha says, else what is behind.
    pub(super) fn see_through(&mut self, keys: Keys, factor: f64) -> Result<Keys, String> {
        let cutoff = match self.material.alpha_mode.as_deref() {
            None | Some("OPAQUE") => return Ok(keys),
            Some("MASK") => Some(self.material.alpha_cutoff.unwrap_or(0.5)),
            Some("BLEND") => None,
            Some(other) => {
                self.approximate(&format!("alphaMode {other}"), "the surface is opaque");
                return Ok(keys);
            }
        };
        let map = match self.base_colour().1 {
            Some(info) => Some(self.base_texture(&info)?),
            None => self.form.paint.as_ref().filter(|paint| paint.has_alpha).map(|paint| paint.texture.clone()),
        };
        let share = match (map, cutoff) {
            (None, Some(cutoff)) => return Ok(if factor < cutoff { Keys::of_type("pass") } else { keys }),
            (None, None) if factor == 1.0 => return Ok(keys),
            (None, None) if factor == 0.0 => return Ok(Keys::of_type("pass")),
            (None, None) => Keys::of_type("constant").with("value", factor),
            (Some(map), None) => channel_weight(&map, "a", factor),
            (Some(map), Some(cutoff)) => {
                Keys::of_type("threshold").with("tau", cutoff).with("of", channel_weight(&map, "a", factor))
            }
        };
        Ok(self.over_nothing(keys, share, "surface"))
    }
}
