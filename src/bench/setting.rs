//! Which settings are compared: every combination of the options given.

use crate::choice::Choice;
use crate::renderer::DeviceChoice;
use crate::scene::RenderSettings;
use crate::scene::settings::Assignment;

/// Values to try; empty: the scene's own.
#[derive(Debug, Clone, Default)]
pub struct Axes {
    pub devices: Vec<DeviceChoice>,
    /// A list for each setting that is tried.
    pub settings: Vec<Vec<Assignment>>,
    /// Settings of denoising, on and off; empty means off.
    pub denoise: Vec<bool>,
}

/// One way to render a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Variant {
    /// The values by which it differs from the others.
    pub name: String,
    pub device: DeviceChoice,
    pub render: RenderSettings,
    /// Pictures are denoised.
    pub denoise: bool,
}

impl Axes {
    /// Every combination of the values, the last option changing fastest. A value given twice makes two settings that should come out equal:
    /// a check of the measurement.
    pub fn variants(&self, own: &RenderSettings) -> Vec<Variant> {
        let device = |setting: &mut Variant, value: &DeviceChoice| {
            setting.device = value.clone();
            device_name(value)
        };
        let mut settings = vec![Variant { name: String::new(), device: DeviceChoice::Auto, render: own.clone(), denoise: false }];
        settings = multiply(settings, &self.devices, device);
        for values in &self.settings {
            settings = multiply(settings, values, |setting, value| {
                value.apply(&mut setting.render);
                value.to_string()
            });
        }
        settings = multiply(settings, &self.denoise, |setting, &denoise| {
            setting.denoise = denoise;
            if denoise { "denoised" } else { "raw" }.to_owned()
        });
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
fn multiply<T>(settings: Vec<Variant>, values: &[T], set: impl Fn(&mut Variant, &T) -> String) -> Vec<Variant> {
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
fn name_apart(settings: &mut [Variant], own: &RenderSettings) {
    for setting in settings.iter_mut().filter(|setting| setting.name.is_empty()) {
        let (render, denoised) = (&setting.render, if setting.denoise { ", denoised" } else { "" });
        let own = if render == own { " (the scene's own)" } else { "" };
        setting.name = format!("{}, {}{denoised}{own}", render.sampler.name(), render.estimator.name());
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
    use crate::scene::settings::Setting;
    use crate::scene::{Estimator, PixelSampler, SamplerKind};

    fn names(setting: &str, names: &[&str]) -> Vec<Assignment> {
        let row = Setting::find(setting).expect("a setting");
        names.iter().map(|name| row.name(name).expect("one of its values")).collect()
    }

    #[test]
    fn settings_are_every_combination_and_are_named_by_what_differs() {
        let axes = Axes {
            devices: vec![DeviceChoice::Gpu],
            settings: vec![
                names("sampler", &["halton", "sobol"]),
                names("pixel_sampler", &["none"]),
                names("estimator", &["mis", "nee"]),
                Vec::new(),
            ],
            denoise: Vec::new(),
        };
        let settings = axes.variants(&RenderSettings::default());
        let names: Vec<&str> = settings.iter().map(|setting| setting.name.as_str()).collect();
        assert_eq!(names, ["halton, mis", "halton, nee", "sobol, mis", "sobol, nee"]);
        assert!(settings.iter().all(|setting| setting.device == DeviceChoice::Gpu));
        assert!(settings.iter().all(|setting| setting.render.pixel_sampler == PixelSampler::Centre));
        assert_eq!(settings[2].render.sampler, SamplerKind::Sobol);
        assert_eq!(settings[1].render.estimator, Estimator::Nee);
    }

    #[test]
    fn numbers_say_what_they_count() {
        let row = Setting::find("light_samples").expect("a setting");
        let counts = [1, 4].map(|count| row.number(count).expect("a possible number"));
        let settings = Axes { settings: vec![counts.to_vec()], ..Axes::default() }.variants(&RenderSettings::default());
        let found: Vec<_> = settings.iter().map(|setting| (setting.name.as_str(), setting.render.light_samples)).collect();
        assert_eq!(found, [("light_samples 1", 1.into()), ("light_samples 4", 4.into())]);
    }

    #[test]
    fn raw_pictures_are_compared_with_denoised_ones() {
        let samplers = names("sampler", &["halton", "sobol"]);
        let axes = Axes { settings: vec![samplers], denoise: vec![false, true], ..Axes::default() };
        let settings = axes.variants(&RenderSettings::default());
        let found: Vec<_> = settings.iter().map(|setting| (setting.name.as_str(), setting.denoise)).collect();
        assert_eq!(found, [("halton, raw", false), ("halton, denoised", true), ("sobol, raw", false), ("sobol, denoised", true)]);
    }

    #[test]
    fn no_choice_is_one_setting_and_the_same_twice_is_two() {
        let own = RenderSettings { sampler: SamplerKind::Halton, ..RenderSettings::default() };
        let one = Axes::default().variants(&own);
        assert_eq!((one.len(), one[0].name.as_str()), (1, "halton, mis (the scene's own)"));
        let samplers = names("sampler", &["halton", "halton"]);
        let twice = Axes { settings: vec![samplers], ..Axes::default() }.variants(&RenderSettings::default());
        assert_eq!([&twice[0].name, &twice[1].name], ["halton", "halton again (2)"]);
    }
}
