//! Media, and where they are.

use glam::DVec3;

use super::Writer;
use super::directive::Directive;
use crate::scene::{MaterialId, Medium, MediumGrids, Outside, Phase, VolumeFilter};
use crate::scene_writer::surroundings::{Content, Sides, absorbs};
use crate::spectrum::Spectrum;

impl Writer<'_> {
    /// All media, those of bodies that absorb too.
    pub fn media(&mut self) {
        let scene = self.scene;
        for (id, medium) in scene.media.iter().enumerate() {
            let name = self.media.get(id).to_owned();
            let directive = self.medium(medium, &name);
            match &medium.grids {
                // The box of a grid lies as the transform in force says.
                Some(grids) => {
                    self.placed(&grids.density().to_index.inverse());
                    self.push(directive);
                    self.line("Identity".to_owned());
                }
                None => self.push(directive),
            }
        }
        for (id, material) in scene.materials.iter().enumerate() {
            if let Some(absorption) = absorbs(&material.kind).filter(|_| material.interior.is_none()) {
                self.push(homogeneous(&self.body_name(id), absorption, Spectrum::BLACK));
            }
        }
    }

    fn medium(&mut self, medium: &Medium, name: &str) -> Directive {
        let place = format!("medium `{name}`");
        let (absorption, scattering) = (medium.absorption, medium.scattering);
        let directive = match &medium.grids {
            Some(grids) => self.grid(medium, grids, name, &place),
            None => homogeneous(name, absorption, scattering),
        };
        let g = self.mean_cosine(&medium.phase, &place);
        let directive = if g == 0.0 { directive } else { directive.float("g", g) };
        if medium.emission.is_black() {
            return directive;
        }
        // The medium gives off there what its absorption is multiplied by.
        let ([absorbed, emitted], mut is_lost) = ([absorption, medium.emission].map(Spectrum::to_rgb), false);
        let given: [f64; 3] = std::array::from_fn(|channel| {
            is_lost |= absorbed[channel] == 0.0 && emitted[channel] > 0.0;
            if absorbed[channel] > 0.0 { emitted[channel] / absorbed[channel] } else { 0.0 }
        });
        if is_lost {
            self.drop("emission of a medium that absorbs nothing", &place, "it gives off no light");
        }
        directive.rgb("Le", Spectrum::from_rgb(given))
    }

    /// A medium that is as dense as a grid says, in the space of the grid's voxels.
    fn grid(&mut self, medium: &Medium, grids: &MediumGrids, name: &str, place: &str) -> Directive {
        let density = grids.density();
        let mut scattering = medium.scattering;
        if density.filter == VolumeFilter::Nearest {
            self.approximate("grid of a medium without interpolation", place, "it is interpolated");
        } else {
            self.approximate("border of the grid of a medium", place, "it fades within half a voxel");
        }
        let goes_on = match density.outside {
            Outside::Border => true,
            Outside::Constant(value) => !value.is_black(),
        };
        if goes_on {
            self.drop("density of a medium outside of its grid", place, "it ends with the grid");
        }
        if let Some(albedo) = grids.albedo() {
            self.approximate("albedo of a medium by a grid", place, "its mean is taken");
            scattering = scattering * mean(albedo.grid.values()) * albedo.scale;
        }
        let absorption = medium.extinction() - scattering;
        if grids.emission().is_some() && !medium.emission.is_black() {
            self.approximate("emission of a medium by a grid", place, "it is given off in proportion to the density");
        }
        let channels = density.grid.channels();
        if channels > 1 {
            self.approximate("coloured density of a medium", place, "the mean of its colours is taken");
        }
        let values: Vec<f32> = density.grid.values().chunks_exact(channels).map(|voxel| mean(voxel) as f32).collect();
        let [x, y, z] = density.grid.resolution();
        let directive = Directive::new("MakeNamedMedium", &[name]).string("type", "uniformgrid");
        let directive = directive.rgb("sigma_a", absorption).rgb("sigma_s", scattering).float("scale", density.scale);
        let directive = directive.point("p0", DVec3::ZERO).point("p1", DVec3::new(x.into(), y.into(), z.into()));
        let directive = directive.integer("nx", x.into()).integer("ny", y.into()).integer("nz", z.into());
        directive.coordinates("float", "density", values)
    }

    /// The one phase function there is Henyey and Greenstein's.
    fn mean_cosine(&mut self, phase: &Phase, place: &str) -> f64 {
        if !phase.is_henyey_greenstein() {
            self.approximate("phase function", place, "Henyey and Greenstein's of the same mean cosine is taken");
        }
        phase.mean_cosine()
    }

    fn body_name(&self, material: MaterialId) -> String {
        self.media.get(self.scene.media.len() + material).to_owned()
    }

    fn name_of(&self, content: Option<Content>) -> String {
        match content {
            Some(Content::Medium(id)) => self.media.get(id).to_owned(),
            Some(Content::Absorption(material)) => self.body_name(material),
            None => String::new(),
        }
    }

    /// The line about the two sides of a surface; None where they are alike.
    pub fn interface(&self, Sides { inside, outside }: Sides) -> Option<Directive> {
        let [inside, outside] = [inside, outside].map(|content| self.name_of(content));
        (inside != outside).then(|| Directive::new("MediumInterface", &[&inside, &outside]))
    }
}

fn mean(values: &[f32]) -> f64 {
    values.iter().map(|value| f64::from(*value)).sum::<f64>() / values.len().max(1) as f64
}

fn homogeneous(name: &str, absorption: Spectrum, scattering: Spectrum) -> Directive {
    let medium = Directive::new("MakeNamedMedium", &[name]).string("type", "homogeneous");
    medium.rgb("sigma_a", absorption).rgb("sigma_s", scattering)
}
