//! Additions of shapes to their materials: light, and openings.

use crate::load::error::SceneError;
use crate::load::file::colour::Colour;
use crate::load::file::material::blend_weight::{BlendWeightEntry, NoKeys};
use crate::load::file::material::{MaterialEntry, blend, pass};
use crate::load::file::value::NonNegative;
use crate::load::import::{Input, Relief};
use crate::load::pbrt::converter::Converter;
use crate::load::pbrt::text::Spot;

impl Converter<'_> {
    /// A material that gives off light besides, from its front alone or from both sides.
    pub fn giving_light(&mut self, spot: &Spot, material: &str, light: &Input, both_sides: bool) -> Result<String, SceneError> {
        let place = spot.place();
        let radiance: Colour<NonNegative> = spot.possible(light.colour(&place))?;
        self.variant(
            spot,
            &format!("{material}, giving light"),
            &format!("{material} + {radiance:?} {both_sides}"),
            |entry| {
                let common = entry.common_mut();
                *common.emission = Some(place.at(radiance));
                *common.emission_two_sided = both_sides.then(|| place.at(true));
            },
            material,
        )
    }

    /// A material like another one but for a change, made once.
    fn variant(
        &mut self,
        spot: &Spot,
        wanted: &str,
        key: &str,
        change: impl FnOnce(&mut MaterialEntry),
        material: &str,
    ) -> Result<String, SceneError> {
        if let Some(known) = self.variants.get(key) {
            return Ok(known.clone());
        }
        let Some(mut entry) = self.entry_of(material).cloned() else { return Ok(material.to_owned()) };
        change(&mut entry);
        let name = self.add_material(spot, wanted, entry);
        self.scene.material_variants.insert(name.clone(), material.to_owned());
        self.variants.insert(key.to_owned(), name.clone());
        Ok(name)
    }

    /// A material that is there by a share of the surface; light goes straight through the rest.
    pub fn opening(&mut self, spot: &Spot, material: &str, share: &Input) -> Result<String, SceneError> {
        let key = format!("{material} % {share:?}");
        if let Some(known) = self.variants.get(&key) {
            return Ok(known.clone());
        }
        let weight = spot.possible(share.weight(&spot.place()))?;
        let nothing = self.nothing(spot);
        self.blended(spot, key, &format!("{material}, in part"), [material.to_owned(), nothing], weight)
    }

    /// A material that the camera does not see: a lamp that is not there and gives light.
    pub fn unseen(&mut self, spot: &Spot, material: &str) -> Result<String, SceneError> {
        let key = format!("{material} unseen");
        if let Some(known) = self.variants.get(&key) {
            return Ok(known.clone());
        }
        let nothing = self.nothing(spot);
        let weight = BlendWeightEntry::Camera(NoKeys {});
        self.blended(spot, key, &format!("{material}, unseen"), [nothing, material.to_owned()], weight)
    }

    fn blended(
        &mut self,
        spot: &Spot,
        key: String,
        wanted: &str,
        parts: [String; 2],
        weight: BlendWeightEntry,
    ) -> Result<String, SceneError> {
        // The blend has the map that bends the normals of the part that is there.
        let mut relief = Relief::default();
        let mut flat = parts.clone();
        for part in &mut flat {
            let Some(mut entry) = self.entry_of(part).cloned() else { continue };
            let taken = Relief::take(&mut entry);
            if !taken.is_none() {
                relief = taken;
                *part = self.add_material(spot, &format!("{part}, as it lies"), entry);
            }
        }
        let entry = relief.given_to(MaterialEntry::from(blend::Keys::of(flat, weight, &spot.place())));
        let name = self.add_material(spot, wanted, entry);
        self.variants.insert(key, name.clone());
        Ok(name)
    }

    fn nothing(&mut self, spot: &Spot) -> String {
        if let Some(known) = self.variants.get("(nothing)") {
            return known.clone();
        }
        let name = self.add_material(spot, "what is behind", MaterialEntry::from(pass::Keys::default()));
        self.variants.insert("(nothing)".to_owned(), name.clone());
        name
    }
}
