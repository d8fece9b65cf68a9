//! `[[medium]]`

use std::sync::Arc;

use schemars::JsonSchema;
use serde::Deserialize;

use super::colour::Rgb;
use super::light_group::LightGroupName;
use super::light_link::ReceiverName;
use super::resolver::Resolver;
use super::value::{Checked, Fraction, GasTemperature, LARGEST, Located, MeanCosine, NonNegative, Positive};
use super::volume::{VolumeEntry, write_volume};
use super::writer::{Writer, colour, line, list, number, table, text};
use crate::black_body::glow;
use crate::load::error::SceneError;
use crate::scene::{GridsOfMedium, Medium, MediumGrids, Outside, Phase, PhaseKind, PhaseLobe, Volume, VoxelGrid};
use crate::spectrum::Spectrum;

/// A medium that fills bodies (`interior` of a material) or the space around the camera (`medium` of the camera). Either `absorption` and
/// `scattering` say how dense it is, or `albedo` and `mean_free_path` do. With `density` it differs from place to place.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
#[schemars(rename = "MediumEntry", extend(
    "dependentRequired" = {
        "albedo": ["mean_free_path"], "albedo_grid": ["density", "mean_free_path"], "emission_grid": ["density", "emission"],
        "temperature": ["density", "emission"], "light_group": ["emission"],
    },
    "allOf" = [
        { "if": { "required": ["mean_free_path"] }, "then": { "anyOf": [{ "required": ["albedo"] }, { "required": ["albedo_grid"] }] } },
        { "not": { "required": ["albedo", "albedo_grid"] } },
        { "not": { "required": ["emission_grid", "temperature"] } },
    ],
))]
pub struct MediumEntry {
    /// Name by which materials and the camera refer to the medium.
    #[schemars(extend("minLength" = 1))]
    pub name: Located<String>,
    /// Share of light that is absorbed, per scene unit; 0 when left out.
    pub absorption: Option<Located<Rgb<NonNegative>>>,
    /// Share of light that is scattered, per scene unit; 0 when left out.
    pub scattering: Option<Located<Rgb<NonNegative>>>,
    /// In place of `absorption` and `scattering`: the share that is scattered of the light that is lost to a ray.
    pub albedo: Option<Located<Rgb<Fraction>>>,
    /// With `albedo`: how far light goes on average before it is absorbed or scattered, in scene units.
    pub mean_free_path: Option<Located<Rgb<Positive>>>,
    /// Radiance that is given off, per scene unit; none when left out.
    pub emission: Option<Rgb<NonNegative>>,
    /// How scattered light is spread over directions; isotropic when left out.
    pub phase: Option<PhaseEntry>,
    /// A grid in the space of the scene, of one number for each voxel or of red, green and blue: from place to place, what is absorbed, scattered and given off is multiplied by it.
    pub density: Option<Box<Located<VolumeEntry>>>,
    /// With `density`, in place of `albedo`: a grid of the share that is scattered of the light that is lost to a ray.
    pub albedo_grid: Option<Box<Located<VolumeEntry>>>,
    /// With `density`: a grid by which `emission` is multiplied as well.
    pub emission_grid: Option<Box<Located<VolumeEntry>>>,
    /// With `density`, in place of `emission_grid`: a grid of temperatures in kelvin. A black body's light is given off, whose brightest channel where
    /// the grid is hottest is `emission`.
    pub temperature: Option<Box<Located<VolumeEntry>>>,
    /// With `emission`: the light group in which `--aov groups` keeps what is given off apart; "rest" when left out.
    pub light_group: Option<Located<LightGroupName>>,
    /// The group of receivers to which places within belong, where the medium scatters light of lamps that say what they light; "rest" when left out.
    pub receiver: Option<Located<ReceiverName>>,
}

/// A phase function.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(rename = "key:type", rename_all = "snake_case")]
#[schemars(tag = "type", rename = "PhaseEntry")]
pub enum PhaseEntry {
    /// All directions alike.
    Isotropic(NoKeys),
    /// Henyey and Greenstein's, which is ahead or back as `g` says.
    HenyeyGreenstein(HenyeyGreensteinKeys),
    /// Scattering by what is much smaller than the wavelength.
    Rayleigh(NoKeys),
    /// A mean of other phase functions.
    Blend(PhaseBlendKeys),
}

#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct NoKeys {}

#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct HenyeyGreensteinKeys {
    /// Mean cosine between the directions before and after, from -0.999 to 0.999: below 0 light is thrown back, above it goes ahead.
    pub g: Checked<MeanCosine>,
}

#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct PhaseBlendKeys {
    /// The phase functions.
    #[schemars(extend("minItems" = 1))]
    pub phases: Located<Vec<PhaseEntry>>,
    /// The share of each; in all they count as 1.
    pub weights: Located<Vec<Checked<NonNegative>>>,
}

impl MediumEntry {
    pub fn resolve(&self, resolver: &mut Resolver<'_>) -> Result<Medium, SceneError> {
        let [absorption, scattering] = self.attenuation(resolver)?;
        let phase = self.phase.as_ref().map_or(Ok(Phase::isotropic()), |phase| phase.resolve(resolver))?;
        let emission = self.emission.as_ref().map_or(Spectrum::BLACK, |emission| emission.0);
        let grids = self.grids(resolver)?;
        Ok(Medium { name: self.name.value.clone(), absorption, scattering, emission, phase, grids })
    }

    /// Absorption and scattering per unit length.
    fn attenuation(&self, resolver: &Resolver<'_>) -> Result<[Spectrum; 2], SceneError> {
        let value =
            |written: &Option<Located<Rgb<NonNegative>>>| written.as_ref().map_or(Spectrum::BLACK, |written| written.value.0);
        if let (Some(_), Some(grid)) = (&self.albedo, &self.albedo_grid) {
            return Err(resolver.error(&grid.place, "a medium has `albedo` or `albedo_grid`, not both"));
        }
        let albedo = match (&self.albedo, &self.albedo_grid) {
            (Some(albedo), _) => Some((albedo.value.0, "albedo", &albedo.place)),
            (None, Some(grid)) => Some((Spectrum::WHITE, "albedo_grid", &grid.place)),
            (None, None) => None,
        };
        match (albedo, &self.mean_free_path) {
            (None, None) => Ok([value(&self.absorption), value(&self.scattering)]),
            (Some((albedo, key, _)), Some(path)) => {
                if let Some(other) = self.absorption.as_ref().or(self.scattering.as_ref()) {
                    let message =
                        format!("a medium has `absorption` and `scattering`, or `{key}` and `mean_free_path`, not both");
                    return Err(resolver.error(&other.place, message));
                }
                let extinction = Spectrum::WHITE / path.value.0;
                let scattering = albedo * extinction;
                Ok([extinction - scattering, scattering])
            }
            (Some((_, key, place)), None) => {
                let message = format!("`{key}` needs the key `mean_free_path`, which says how dense the medium is");
                Err(resolver.error(place, message))
            }
            (None, Some(Located { place, .. })) => Err(resolver.error(place, "`mean_free_path` needs the key `albedo`")),
        }
    }

    /// Grids, by which the medium differs from place to place.
    fn grids(&self, resolver: &mut Resolver<'_>) -> Result<Option<Arc<MediumGrids>>, SceneError> {
        let others =
            [("albedo_grid", &self.albedo_grid), ("emission_grid", &self.emission_grid), ("temperature", &self.temperature)];
        let Some(density) = &self.density else {
            let without = others.into_iter().find_map(|(key, grid)| grid.as_ref().map(|grid| (key, &grid.place)));
            return without.map_or(Ok(None), |(key, place)| {
                Err(resolver.error(place, format!("`{key}` needs the key `density`, the grid that says where the medium is")))
            });
        };
        if let (Some(_), Some(grid)) = (&self.emission_grid, &self.temperature) {
            return Err(resolver.error(&grid.place, "a medium has `emission_grid` or `temperature`, not both"));
        }
        for (key, grid) in &others[1..] {
            if let (Some(grid), None) = (grid, &self.emission) {
                let message = format!("`{key}` needs the key `emission`, which says how much light is given off");
                return Err(resolver.error(&grid.place, message));
            }
        }
        let of_density = resolver.volume::<NonNegative>(&density.value, &density.place)?;
        let albedo = match &self.albedo_grid {
            Some(grid) => Some(resolver.volume::<Fraction>(&grid.value, &grid.place)?),
            None => None,
        };
        let emission = match (&self.emission_grid, &self.temperature) {
            (Some(grid), _) => Some(resolver.volume::<NonNegative>(&grid.value, &grid.place)?),
            (None, Some(grid)) => {
                let kelvin = resolver.volume::<GasTemperature>(&grid.value, &grid.place)?;
                Some(glowing(&kelvin).map_err(|reason| resolver.error(&grid.place, reason))?)
            }
            (None, None) => None,
        };
        let grids = MediumGrids::new(GridsOfMedium { density: of_density, albedo, emission });
        grids.check().map_err(|reason| resolver.error(&density.place, reason))?;
        Ok(Some(Arc::new(grids)))
    }
}

/// Steps of the table of what black bodies give off, from the coldest to the hottest.
const GLOW_STEPS: usize = 4096;

/// The light that black bodies of these temperatures give off, the brightest channel of the hottest voxel 1.
fn glowing(kelvin: &Volume) -> Result<Volume, String> {
    if kelvin.grid.channels() != 1 {
        return Err("the grid has colours, and a temperature is one number".to_owned());
    }
    let hottest = kelvin.range()[1];
    let steps = (0..=GLOW_STEPS).map(|step| glow(hottest * step as f64 / GLOW_STEPS as f64, hottest));
    let table: Vec<Spectrum> = if hottest < 500.0 { vec![Spectrum::BLACK; GLOW_STEPS + 1] } else { steps.collect() };
    let light = |kelvin: f64| {
        let at = if hottest > 0.0 { kelvin / hottest * GLOW_STEPS as f64 } else { 0.0 };
        let low = (at as usize).min(GLOW_STEPS - 1);
        table[low] + (table[low + 1] - table[low]) * (at - low as f64)
    };
    let values = kelvin.grid.values().iter().flat_map(|&value| light(f64::from(value) * kelvin.scale).to_f32()).collect();
    let grid = VoxelGrid::new(kelvin.grid.resolution(), 3, values)?;
    let outside = match kelvin.outside {
        Outside::Border => Outside::Border,
        Outside::Constant(value) => Outside::Constant(light(value.r() * kelvin.scale)),
    };
    Ok(Volume { grid: Arc::new(grid), outside, scale: 1.0, ..kelvin.clone() })
}

impl PhaseEntry {
    fn resolve(&self, resolver: &Resolver<'_>) -> Result<Phase, SceneError> {
        let PhaseBlendKeys { phases, weights } = match self {
            Self::Isotropic(_) => return Ok(Phase::isotropic()),
            Self::HenyeyGreenstein(keys) => return Ok(Phase::of(PhaseKind::HenyeyGreenstein { g: keys.g.0 })),
            Self::Rayleigh(_) => return Ok(Phase::of(PhaseKind::Rayleigh)),
            Self::Blend(keys) => keys,
        };
        if phases.value.len() != weights.value.len() {
            let message =
                format!("{} phase functions need as many weights, and there are {}", phases.value.len(), weights.value.len());
            return Err(resolver.error(&weights.place, message));
        }
        let sum: f64 = weights.value.iter().map(|weight| weight.0).sum();
        if sum <= 0.0 {
            return Err(resolver.error(&weights.place, "the weights of phase functions cannot all be 0"));
        }
        let mut lobes: Vec<PhaseLobe> = Vec::new();
        for (phase, weight) in phases.value.iter().zip(&weights.value) {
            let Phase(parts) = phase.resolve(resolver)?;
            lobes.extend(parts.into_iter().map(|lobe| PhaseLobe { weight: lobe.weight * weight.0 / sum, ..lobe }));
        }
        lobes.retain(|lobe| lobe.weight > 0.0);
        Ok(Phase(lobes))
    }
}

/// The keys of a medium, a line each.
pub fn write(medium: &Medium, writer: &mut Writer<'_>) -> String {
    let mut out = String::new();
    let grids = medium.grids.as_deref();
    if grids.is_some_and(|grids| grids.albedo().is_some()) {
        // The grid says which share of the two together is scattered.
        out += &line("mean_free_path", &colour((Spectrum::WHITE / medium.extinction()).min(Spectrum::grey(LARGEST))));
    } else {
        for (key, value) in [("absorption", medium.absorption), ("scattering", medium.scattering)] {
            if !value.is_black() {
                out += &line(key, &colour(value));
            }
        }
    }
    if !medium.emission.is_black() {
        out += &line("emission", &colour(medium.emission));
    }
    if medium.phase != Phase::isotropic() {
        out += &line("phase", &phase(&medium.phase));
    }
    if let Some(grids) = grids {
        let volumes = [("density", Some(grids.density())), ("albedo_grid", grids.albedo()), ("emission_grid", grids.emission())];
        for (key, volume) in volumes {
            out += &volume.map_or_else(String::new, |volume| line(key, &write_volume(volume, writer)));
        }
    }
    out
}

fn phase(Phase(lobes): &Phase) -> String {
    let of_kind = |kind: PhaseKind| match kind {
        PhaseKind::HenyeyGreenstein { g } => table([("type", text("henyey_greenstein")), ("g", number(g))]),
        PhaseKind::Rayleigh => table([("type", text("rayleigh"))]),
    };
    match lobes.as_slice() {
        [PhaseLobe { weight: 1.0, kind }] => of_kind(*kind),
        lobes => table([
            ("type", text("blend")),
            ("phases", list(lobes.iter().map(|lobe| of_kind(lobe.kind)))),
            ("weights", list(lobes.iter().map(|lobe| number(lobe.weight)))),
        ]),
    }
}
