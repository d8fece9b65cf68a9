//! Surfaces below a dielectric coat: stacks of layers, which look alike from both sides.
//!
//! The slab between a coat and its base takes light there: exp(−thickness / cosine) of it is left, whatever the slab scatters.

use std::rc::Rc;

use super::Widths;
use crate::load::error::SceneError;
use crate::load::file::colour::{Rgb, Scalar};
use crate::load::file::material::layered::{Interfaces, Keys, SlabEntry, Slabs};
use crate::load::file::material::{MaterialEntry, conductor};
use crate::load::file::medium::{HenyeyGreensteinKeys, MediumEntry, PhaseEntry};
use crate::load::file::value::{Checked, Located, MeanCosine, Rule};
use crate::load::pbrt::converter::Converter;
use crate::load::pbrt::parameter::Entity;
use crate::load::pbrt::spectrum::SpectrumKind;
use crate::load::pbrt::texture_entry::Use;
use crate::spectrum::Spectrum;

/// Layers up to so thin lose no light that is seen.
const THIN: f64 = 1e-5;
/// From so many crossings of layers on, what is left of light is not seen.
const MANY_CROSSINGS: i64 = 50;

impl Converter<'_> {
    pub(super) fn coated_diffuse(&mut self, entity: &Rc<Entity>, wanted: &str) -> Result<MaterialEntry, SceneError> {
        let ior = self.index(entity, "eta", 1.5)?.central();
        let widths = self.widths(entity, "")?;
        let base = self.diffuse(entity, 0.5)?;
        self.stack(entity, wanted, (ior, widths), base)
    }

    pub(super) fn coated_metal(&mut self, entity: &Rc<Entity>, wanted: &str) -> Result<MaterialEntry, SceneError> {
        let ior = self.index(entity, "interface.eta", 1.5)?.central();
        let widths = self.widths(entity, "interface.")?;
        let keys = self.metal_keys(entity, "conductor.", ior)?;
        let Widths { alpha, alpha_u, alpha_v } = self.widths(entity, "conductor.")?;
        let base = MaterialEntry::from(conductor::Keys { alpha, alpha_u, alpha_v, ..keys });
        self.stack(entity, wanted, (ior, widths), base)
    }

    fn stack(
        &mut self,
        entity: &Rc<Entity>,
        wanted: &str,
        (ior, widths): (f64, Widths),
        base: MaterialEntry,
    ) -> Result<MaterialEntry, SceneError> {
        entity.without_effect(&["nsamples"]);
        let crossings = entity.integer_or("maxdepth", 10)?;
        if crossings < MANY_CROSSINGS {
            let instead = format!("all of them count, and not those within {crossings} crossings of layers alone");
            self.approximate(entity.spot_of("maxdepth"), "reflections between a coat and what is below it", instead);
        }
        let coat = self.glass_of(entity, super::glass::Index::Number(ior), widths)?;
        let coat = self.add_material(&entity.spot, &format!("{wanted}: coat"), coat);
        let base = self.add_material(&entity.spot, &format!("{wanted}: base"), base);
        let place = entity.spot.place();
        let slabs = self.slab(entity, wanted)?.map(|slab| place.at(Slabs(vec![slab])));
        let interfaces = Interfaces(vec![place.at(coat), place.at(base)]);
        Ok(MaterialEntry::from(Keys { interfaces, slabs, mirrored: Some(true), ..Default::default() }))
    }

    /// The slab between the coat and the base; None if it takes no light.
    fn slab(&mut self, entity: &Rc<Entity>, wanted: &str) -> Result<Option<SlabEntry>, SceneError> {
        let place = entity.spot.place();
        let albedo = self.plain_colour(entity, "albedo", SpectrumKind::Albedo)?.unwrap_or(Spectrum::BLACK);
        let albedo = albedo.clamp(Spectrum::BLACK, Spectrum::WHITE);
        let g = self.plain_number(entity, "g", 0.0)?;
        let thickness = match self.float_node(entity, "thickness")? {
            None => Scalar::constant(0.01),
            Some(node) => match node.as_constant() {
                Some(thickness) if thickness.r() <= THIN => return Ok(None),
                Some(thickness) => Scalar::constant(thickness.r()),
                None => self.input(&node, Use::Share, entity.spot_of("thickness"))?.scalar(&place),
            },
        };
        let thickness = Some(entity.possible(thickness)?);
        let medium = Some(place.at(self.slab_medium(entity, wanted, (albedo, g))?));
        Ok(Some(SlabEntry { thickness, medium }))
    }

    /// A medium that loses all of its light per unit, and scatters this share of it.
    fn slab_medium(&mut self, entity: &Entity, wanted: &str, (albedo, g): (Spectrum, f64)) -> Result<String, SceneError> {
        let key = format!("(slab) {albedo:?} {g}");
        if let Some(known) = self.media.get(&key) {
            return Ok(known.clone());
        }
        let place = entity.spot.place();
        let value =
            |value: Spectrum| -> Result<Option<Located<_>>, SceneError> { Ok(Some(place.at(entity.possible(Rgb::of(value))?))) };
        let name = self.scene.free_medium_name(&format!("{wanted}: below the coat"));
        let cosine = Checked::of(g.clamp(MeanCosine::MINIMUM, MeanCosine::MAXIMUM));
        let phase = if g == 0.0 {
            None
        } else {
            Some(PhaseEntry::HenyeyGreenstein(HenyeyGreensteinKeys { g: entity.possible(cosine)? }))
        };
        self.scene.file.medium.push(MediumEntry {
            name: place.at(name.clone()),
            absorption: value(Spectrum::WHITE - albedo)?,
            scattering: value(albedo)?,
            phase,
            ..MediumEntry::default()
        });
        self.media.insert(key, name.clone());
        Ok(name)
    }
}
