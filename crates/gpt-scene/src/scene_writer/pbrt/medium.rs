//! Media, and where they are.

use super::Writer;
use super::directive::Directive;
use crate::scene::{MaterialId, Medium, Phase, PhaseKind};
use crate::scene_writer::surroundings::{Content, Sides, absorbs};
use crate::spectrum::Spectrum;

impl Writer<'_> {
    /// All media, those of bodies that absorb too.
    pub fn media(&mut self) {
        let scene = self.scene;
        for (id, medium) in scene.media.iter().enumerate() {
            let name = self.media.get(id).to_owned();
            let directive = self.medium(medium, &name);
            self.push(directive);
        }
        for (id, material) in scene.materials.iter().enumerate() {
            if let Some(absorption) = absorbs(&material.kind).filter(|_| material.interior.is_none()) {
                self.push(homogeneous(&self.body_name(id), absorption, Spectrum::BLACK));
            }
        }
    }

    fn medium(&mut self, medium: &Medium, name: &str) -> Directive {
        let place = format!("medium `{name}`");
        let (mut absorption, mut scattering) = (medium.absorption, medium.scattering);
        if let Some(grids) = &medium.grids {
            let density = grids.density();
            let values = density.grid.values();
            let mean = values.iter().map(|value| f64::from(*value)).sum::<f64>() / values.len().max(1) as f64 * density.scale;
            self.approximate("grid of a medium", &place, "it is as dense everywhere as it is in the mean");
            (absorption, scattering) = (absorption * mean, scattering * mean);
        }
        let directive = homogeneous(name, absorption, scattering);
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

    /// The one phase function there is Henyey and Greenstein's.
    fn mean_cosine(&mut self, Phase(lobes): &Phase, place: &str) -> f64 {
        if let [lobe] = lobes.as_slice()
            && let PhaseKind::HenyeyGreenstein { g } = lobe.kind
        {
            return g;
        }
        self.approximate("phase function", place, "Henyey and Greenstein's of the same mean cosine is taken");
        let of_kind = |kind: PhaseKind| if let PhaseKind::HenyeyGreenstein { g } = kind { g } else { 0.0 };
        lobes.iter().map(|lobe| lobe.weight * of_kind(lobe.kind)).sum()
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

fn homogeneous(name: &str, absorption: Spectrum, scattering: Spectrum) -> Directive {
    let medium = Directive::new("MakeNamedMedium", &[name]).string("type", "homogeneous");
    medium.rgb("sigma_a", absorption).rgb("sigma_s", scattering)
}
