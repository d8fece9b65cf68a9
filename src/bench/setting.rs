//! Which settings are compared: every combination of the options given.

use crate::renderer::DeviceChoice;
use crate::scene::{
    BlendMode, Estimator, HemisphereSampling, LightSampling, MisHeuristic, PixelSamplerName, RenderSettings, SamplerKind,
    setting_name,
};

/// Values to try of each option; empty: the scene's own.
#[derive(Debug, Clone, Default)]
pub struct Axes {
    pub devices: Vec<DeviceChoice>,
    pub samplers: Vec<SamplerKind>,
    pub pixel_samplers: Vec<PixelSamplerName>,
    pub estimators: Vec<Estimator>,
    pub heuristics: Vec<MisHeuristic>,
    pub hemispheres: Vec<HemisphereSampling>,
    pub light_samplings: Vec<LightSampling>,
    pub light_samples: Vec<u32>,
    pub light_samples_depths: Vec<u32>,
    pub blends: Vec<BlendMode>,
}

/// One way to render a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Setting {
    /// The values by which it differs from the others.
    pub name: String,
    pub device: DeviceChoice,
    pub render: RenderSettings,
}

impl Axes {
    /// Every combination of the values, the last option changing fastest. A value given twice makes two settings that should come out equal:
    /// a check of the measurement.
    pub fn settings(&self, own: &RenderSettings) -> Vec<Setting> {
        let device = |setting: &mut Setting, value: &DeviceChoice| {
            setting.device = value.clone();
            device_name(value)
        };
        let mut settings = vec![Setting { name: String::new(), device: DeviceChoice::Auto, render: own.clone() }];
        settings = multiply(settings, &self.devices, device);
        macro_rules! axis {
            ($values:ident, $field:ident) => {
                settings = multiply(settings, &self.$values, |setting, value| {
                    setting.render.$field = (*value).into();
                    setting_name(*value)
                });
            };
        }
        axis!(samplers, sampler);
        axis!(pixel_samplers, pixel_sampler);
        axis!(estimators, estimator);
        axis!(heuristics, heuristic);
        axis!(hemispheres, hemisphere);
        axis!(light_samplings, light_sampling);
        settings = multiply(settings, &self.light_samples, |setting, count| {
            setting.render.light_samples = *count;
            if *count == 1 { "1 light sample".to_owned() } else { format!("{count} light samples") }
        });
        settings = multiply(settings, &self.light_samples_depths, |setting, depth| {
            setting.render.light_samples_depth = *depth;
            if *depth == 1 { "at the first surface".to_owned() } else { format!("at {depth} surfaces") }
        });
        axis!(blends, blend);
        name_apart(&mut settings, own);
        settings
    }
}

fn device_name(choice: &DeviceChoice) -> String {
    match choice {
        DeviceChoice::Auto => "auto".to_owned(),
        DeviceChoice::Gpu => "gpu".to_owned(),
        DeviceChoice::Cpu => "cpu".to_owned(),
        DeviceChoice::Named(name) => name.clone(),
    }
}

/// Every setting with every value; the name grows where there is a choice.
fn multiply<T>(settings: Vec<Setting>, values: &[T], set: impl Fn(&mut Setting, &T) -> String) -> Vec<Setting> {
    if values.is_empty() {
        return settings;
    }
    let mut product = Vec::with_capacity(settings.len() * values.len());
    for setting in settings {
        for value in values {
            let mut one = setting.clone();
            let name = set(&mut one, value);
            if values.len() > 1 {
                let comma = if one.name.is_empty() { "" } else { ", " };
                one.name = format!("{}{comma}{name}", one.name);
            }
            product.push(one);
        }
    }
    product
}

/// Names that occur twice get a number, and a setting without alternatives is called by sampler and estimator.
fn name_apart(settings: &mut [Setting], own: &RenderSettings) {
    for setting in settings.iter_mut().filter(|setting| setting.name.is_empty()) {
        let render = &setting.render;
        let own = if render == own { " (the scene's own)" } else { "" };
        setting.name = format!("{}, {}{own}", setting_name(render.sampler), setting_name(render.estimator));
    }
    let plain: Vec<String> = settings.iter().map(|setting| setting.name.clone()).collect();
    for (index, setting) in settings.iter_mut().enumerate() {
        let earlier = plain[..index].iter().filter(|name| **name == plain[index]).count();
        if earlier > 0 {
            setting.name = format!("{} again ({})", plain[index], earlier + 1);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::PixelSampler;

    #[test]
    fn settings_are_every_combination_and_are_named_by_what_differs() {
        let axes = Axes {
            devices: vec![DeviceChoice::Gpu],
            samplers: vec![SamplerKind::Halton, SamplerKind::Sobol],
            pixel_samplers: vec![PixelSamplerName::None],
            estimators: vec![Estimator::Mis, Estimator::Nee],
            ..Axes::default()
        };
        let settings = axes.settings(&RenderSettings::default());
        let names: Vec<&str> = settings.iter().map(|setting| setting.name.as_str()).collect();
        assert_eq!(names, ["halton, mis", "halton, nee", "sobol, mis", "sobol, nee"]);
        assert!(settings.iter().all(|setting| setting.device == DeviceChoice::Gpu));
        assert!(settings.iter().all(|setting| setting.render.pixel_sampler == PixelSampler::Centre));
        assert_eq!(settings[2].render.sampler, SamplerKind::Sobol);
        assert_eq!(settings[1].render.estimator, Estimator::Nee);
    }

    #[test]
    fn no_choice_is_one_setting_and_the_same_twice_is_two() {
        let own = RenderSettings { sampler: SamplerKind::Halton, ..RenderSettings::default() };
        let one = Axes::default().settings(&own);
        assert_eq!((one.len(), one[0].name.as_str()), (1, "halton, mis (the scene's own)"));
        let twice = Axes { samplers: vec![SamplerKind::Halton; 2], ..Axes::default() }.settings(&RenderSettings::default());
        assert_eq!([&twice[0].name, &twice[1].name], ["halton", "halton again (2)"]);
    }
}
