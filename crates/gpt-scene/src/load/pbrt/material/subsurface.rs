//! Bodies that light gets into: there by a formula for what comes out where, here by a medium within glass.

use std::rc::Rc;

use crate::load::error::SceneError;
use crate::load::file::material::MaterialEntry;
use crate::load::gltf::single_scattering_albedo;
use crate::load::pbrt::converter::Converter;
use crate::load::pbrt::parameter::Entity;
use crate::load::pbrt::spectrum::SpectrumKind;
use crate::spectrum::Spectrum;

impl Converter<'_> {
    pub(super) fn subsurface(&mut self, entity: &Rc<Entity>, wanted: &str) -> Result<MaterialEntry, SceneError> {
        let scale = entity.float_or("scale", 1.0)?;
        let mut g = entity.float_or("g", 0.0)?;
        let name = entity.text("name")?.map(str::to_owned);
        let coefficients = if let Some(measured) = name.and_then(|name| self.measured(entity, "name", &name)) {
            // They go with an isotropic phase function.
            g = 0.0;
            measured
        } else {
            let absorption = self.plain_colour(entity, "sigma_a", SpectrumKind::Unbounded)?;
            let scattering = self.plain_colour(entity, "sigma_s", SpectrumKind::Unbounded)?;
            match (absorption, scattering) {
                (Some(absorption), Some(scattering)) => [absorption, scattering],
                (None, None) => self.of_reflectance(entity)?,
                (Some(_), None) => return Err(entity.spot_of("sigma_a").error("`sigma_a` needs `sigma_s`")),
                (None, Some(_)) => return Err(entity.spot_of("sigma_s").error("`sigma_s` needs `sigma_a`")),
            }
        };
        let instead = "light is followed through a medium within glass";
        self.approximate(&entity.spot, "Material `subsurface`", instead);
        let index = self.index(entity, "eta", 1.33)?;
        let widths = self.widths(entity, "")?;
        let mut entry = self.glass_of(entity, index, widths)?;
        let medium = self.homogeneous(entity, wanted, coefficients.map(|value| value * scale), g)?;
        *entry.common_mut().interior = Some(entity.spot.place().at(medium));
        Ok(entry)
    }

    /// Absorption and scattering of a body that reflects so much; milk where nothing is said.
    fn of_reflectance(&mut self, entity: &Entity) -> Result<[Spectrum; 2], SceneError> {
        let Some(reflectance) = self.plain_colour(entity, "reflectance", SpectrumKind::Albedo)? else {
            return Ok([[0.0011, 0.0024, 0.014], [2.55, 3.21, 3.77]].map(Spectrum::from_rgb));
        };
        let free = self.plain_colour(entity, "mfp", SpectrumKind::Unbounded)?.unwrap_or(Spectrum::WHITE);
        if free.min_component() <= 0.0 {
            return Err(entity.spot_of("mfp").error("`mfp` is above 0"));
        }
        let extinction = Spectrum::WHITE / free;
        let scattering = extinction * reflectance.map(single_scattering_albedo);
        Ok([extinction - scattering, scattering])
    }
}
