//! Phase functions.

use std::rc::Rc;

use crate::load::error::SceneError;
use crate::load::file::medium::{HenyeyGreensteinKeys, NoKeys, PhaseBlendKeys, PhaseEntry};
use crate::load::file::value::{Checked, MeanCosine, Rule};
use crate::load::mitsuba::converter::Converter;
use crate::load::mitsuba::plugin::Plugin;
use crate::load::mitsuba::transform::numbers;

/// Most phase functions within each other, and in one medium: blends share what they name, and each share is one of its own here.
const DEEPEST: usize = 32;
const MOST: usize = 256;

impl Converter<'_> {
    /// The phase function of a medium; None is the isotropic one.
    pub(super) fn phase_of(&mut self, medium: &Rc<Plugin>) -> Result<Option<PhaseEntry>, SceneError> {
        let within: Vec<Rc<Plugin>> = medium.children_of("phase").into_iter().cloned().collect();
        match &within[..] {
            [] => Ok(None),
            [phase] => self.phase(phase, 0, &mut 0).map(Some),
            more => Err(medium.error(format!("a medium has one phase function, and this one {}", more.len()))),
        }
    }

    fn phase(&mut self, plugin: &Rc<Plugin>, depth: usize, count: &mut usize) -> Result<PhaseEntry, SceneError> {
        *count += 1;
        if depth > DEEPEST || *count > MOST {
            let message =
                format!("a medium has more than {MOST} phase functions, or they lie more than {DEEPEST} deep within each other");
            return Err(plugin.error(message));
        }
        plugin.visited.set(true);
        plugin.without_effect(&["id"]);
        match plugin.name.as_str() {
            "isotropic" => Ok(PhaseEntry::Isotropic(NoKeys {})),
            "rayleigh" => Ok(PhaseEntry::Rayleigh(NoKeys {})),
            "hg" => {
                let cosine = self.plain_number(plugin, "g", 0.8)?;
                self.henyey_greenstein(plugin, cosine)
            }
            "blendphase" => {
                let share = self.volume_mean(plugin, "weight", 0.5)?.mean().clamp(0.0, 1.0);
                self.blend(plugin, &[1.0 - share, share], depth, count)
            }
            "mixturephase" => {
                let text = plugin.text("weights")?.ok_or_else(|| plugin.error("a mixture needs the string `weights`"))?;
                let weights = numbers(&plugin.place, text)?;
                self.blend(plugin, &weights, depth, count)
            }
            "tabphase" => {
                let text = plugin.text("values")?.ok_or_else(|| plugin.error("tabphase needs the string `values`"))?;
                let cosine = mean_cosine(&numbers(&plugin.place, text)?)
                    .ok_or_else(|| plugin.error("`values` of tabphase are two numbers or more, none below 0 and one above 0"))?;
                if let Some(cosine) = cosine {
                    let instead = "Henyey's and Greenstein's of the same mean cosine is taken";
                    self.approximate(plugin, "phase `tabphase`", instead);
                    return self.henyey_greenstein(plugin, cosine);
                }
                Ok(PhaseEntry::Isotropic(NoKeys {}))
            }
            other => {
                let what = format!("phase `{other}`");
                plugin.properties.iter().for_each(|property| property.used.set(true));
                plugin.children.iter().for_each(|child| child.used.set(true));
                let instead = match other {
                    "sggx" | "microflake" => "it is isotropic, and the medium as dense in every direction as it says",
                    _ => "it is isotropic",
                };
                self.approximate(plugin, &what, instead);
                Ok(PhaseEntry::Isotropic(NoKeys {}))
            }
        }
    }

    fn henyey_greenstein(&mut self, plugin: &Plugin, cosine: f64) -> Result<PhaseEntry, SceneError> {
        if cosine.is_nan() || cosine.abs() >= 1.0 {
            return Err(plugin.error(format!("`g` is above -1 and below 1, not {cosine}")));
        }
        let nearest = cosine.clamp(MeanCosine::MINIMUM, MeanCosine::MAXIMUM);
        if nearest != cosine {
            self.approximate(plugin, "mean cosine of a phase function nearer to 1 than 0.999", "it is 0.999");
        }
        Ok(PhaseEntry::HenyeyGreenstein(HenyeyGreensteinKeys { g: plugin.possible(Checked::of(nearest))? }))
    }

    /// The phase functions within, in the order in which they are written.
    fn blend(&mut self, plugin: &Rc<Plugin>, weights: &[f64], depth: usize, count: &mut usize) -> Result<PhaseEntry, SceneError> {
        let within: Vec<Rc<Plugin>> = plugin.children_of("phase").into_iter().cloned().collect();
        if within.len() != weights.len() {
            let message =
                format!("{} has {} phase functions within, and {} weights", plugin.title(), within.len(), weights.len());
            return Err(plugin.error(message));
        }
        let phases = within.iter().map(|phase| self.phase(phase, depth + 1, count)).collect::<Result<_, _>>()?;
        let weights = weights.iter().map(|weight| plugin.possible(Checked::of(*weight))).collect::<Result<_, _>>()?;
        let place = plugin.at();
        Ok(PhaseEntry::Blend(PhaseBlendKeys { phases: place.at(phases), weights: place.at(weights) }))
    }
}

/// The mean cosine of a phase function by values at cosines that are equally far apart from -1 to 1, with straight lines between them; None within
/// where they are all the same. None of what is no phase function.
fn mean_cosine(values: &[f64]) -> Option<Option<f64>> {
    let steps = values.len().checked_sub(1).filter(|steps| *steps > 0)? as f64;
    let well = values.iter().all(|value| *value >= 0.0) && values.iter().any(|value| *value > 0.0);
    if !well {
        return None;
    }
    if values.iter().all(|value| *value == values[0]) {
        return Some(None);
    }
    let cosine = |index: usize| 2.0 * index as f64 / steps - 1.0;
    let (mut total, mut moment) = (0.0, 0.0);
    for (index, pair) in values.windows(2).enumerate() {
        let ([from, to], [low, high]) = ([cosine(index), cosine(index + 1)], [pair[0], pair[1]]);
        total += (low + high) / 2.0;
        moment += (low * (2.0 * from + to) + high * (from + 2.0 * to)) / 6.0;
    }
    Some(Some(moment / total))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_have_the_mean_cosine_of_their_straight_lines() {
        // 1 + c·cos has the mean cosine c/3.
        let found = mean_cosine(&[0.4, 1.0, 1.6]).flatten().expect("it is a phase function");
        assert!((found - 0.2).abs() < 1e-12, "{found}");
        assert_eq!(mean_cosine(&[2.0, 2.0]), Some(None));
        for wrong in [&[][..], &[1.0], &[0.0, 0.0], &[1.0, -1.0], &[f64::NAN, 1.0]] {
            assert_eq!(mean_cosine(wrong), None, "{wrong:?}");
        }
    }
}
