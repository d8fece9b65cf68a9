//! The table of render settings, a row each. Whatever a row says holds everywhere: the scene file's `[render]` and its schema, the flags
//! of `gpt render`, the keys of `--stats` and `gpt check --json`, a picture's header, what `gpt bench convergence` compares, the check
//! of scenes that were built by hand, and the pages `docs/scene-format.md` and `docs/cli.md`. What a setting means for light is
//! in the code that reads its field of [`RenderSettings`].

use std::fmt;

use serde::{Serialize, Serializer};

use super::kinds::{
    BlendMode, DistanceSampling, Emitters, Estimator, Guiding, HemisphereSampling, LightChoice, LightSampling, MisHeuristic,
    PhongCosine, PhongHorizon, PhongSampling, PixelSampler, SamplerKind,
};
use super::number_or_auto::{NumberOrAuto, auto};
use super::row::settings;
use super::value::Values::{Names, Real, Whole, WholeOr};
use super::value::{BadSetting, Field, MOST_SAMPLES, Value, Values};
use crate::choice::Choice;

/// Most light samples at a surface.
pub const MOST_LIGHT_SAMPLES: u32 = 16;
/// Most edges of a path whose surfaces take more than one: their points stand in a table that has to fit a uniform buffer.
pub const MOST_LIGHT_SAMPLES_DEPTH: u32 = 3;

/// Paths of the last round in which a guide is learned: fewer find too little, and of more the host would have to hold too much.
const FEWEST_GUIDING_PATHS: u32 = 1 << 12;
const MOST_GUIDING_PATHS: u32 = 1 << 20;

/// First depth at which Russian roulette may end a path where the scene states none.
const DEFAULT_ROULETTE_DEPTH: u32 = 5;
/// The depth of roulette for guided paths, whose expected contribution is known.
const GUIDED_ROULETTE_DEPTH: u32 = 2;

/// Exponents of the power heuristic: at 0 a strategy would take half of what it cannot find; with the largest, the larger density takes all.
const LEAST_HEURISTIC_EXPONENT: f64 = 0.1;
const MOST_HEURISTIC_EXPONENT: f64 = 64.0;

/// Largest radiance that samples may be clamped to: it is an f32 in shaders.
const LARGEST_CLAMP: f64 = 1e18;

settings! {
    /// How radiance is estimated. The scene file sets the defaults, the command line overrides them.
    #[derive(Debug, Clone, PartialEq)]
    pub struct RenderSettings, SETTINGS {
        /// Samples per pixel.
        spp: u32 = 256 => {
            values: Whole(1, MOST_SAMPLES),
            flag: "--spp",
            placeholder: "N",
            header: "gpt:samplesWanted",
            compared: false,
            study: false,
        }
        /// Longest path in edges: 1 = only light seen directly, 2 = plus direct lighting, 0 = unlimited (Russian roulette ends paths).
        max_depth: u32 = 16 => {
            values: Whole(0, MOST_SAMPLES),
            flag: "--max-depth",
            placeholder: "N",
            header: "gpt:maxDepth",
            compared: false,
            study: false,
        }
        /// The source of random numbers.
        sampler: SamplerKind = SamplerKind::Sobol => { // the one that measures best: docs/strategies.md
            values: Names(SamplerKind::NAMES),
            flag: "--sampler",
            placeholder: "SAMPLER",
            header: "gpt:sampler",
            compared: true,
            study: false,
        }
        /// The sampler of the position inside the pixel.
        pixel_sampler: PixelSampler = PixelSampler::SameAsPath => {
            values: Names(PixelSampler::NAMES),
            flag: "--pixel-sampler",
            placeholder: "SAMPLER",
            header: "gpt:pixelSampler",
            compared: true,
            study: false,
        }
        /// How light sampling and BSDF sampling are used.
        estimator: Estimator = Estimator::Mis => {
            values: Names(Estimator::NAMES),
            flag: "--estimator",
            placeholder: "ESTIMATOR",
            header: "gpt:estimator",
            compared: true,
            study: false,
        }
        /// How the place is drawn where a medium scatters light.
        distance_sampling: DistanceSampling = DistanceSampling::Mis => {
            values: Names(DistanceSampling::NAMES),
            flag: "--distance-sampling",
            placeholder: "STRATEGY",
            header: "gpt:distanceSampling",
            compared: true,
            study: false,
        }
        /// How a point on a sphere, a rectangle or a triangle that is a light is drawn.
        light_sampling: LightSampling = LightSampling::Auto => {
            values: Names(LightSampling::NAMES),
            flag: "--light-sampling",
            placeholder: "STRATEGY",
            header: "gpt:lightSampling",
            compared: true,
            study: false,
        }
        /// How next event estimation chooses among lights.
        light_choice: LightChoice = LightChoice::Auto => {
            values: Names(LightChoice::NAMES),
            flag: "--light-choice",
            placeholder: "CHOICE",
            header: "gpt:lightChoice",
            compared: true,
            study: false,
        }
        /// Light samples at the first surfaces of a path; later surfaces take one. Several pay where direct light is most of the noise.
        light_samples: NumberOrAuto = NumberOrAuto::Auto => {
            values: WholeOr(1, MOST_LIGHT_SAMPLES, auto("As many as a trial run of some thousand paths finds best, and at as many surfaces.")),
            flag: "--light-samples",
            placeholder: "N",
            header: "gpt:lightSamples",
            compared: true,
            study: false,
        }
        /// How many of a path's first surfaces take `light_samples`, where that is a number; counted by edges from the camera on.
        light_samples_depth: u32 = 1 => {
            values: Whole(1, MOST_LIGHT_SAMPLES_DEPTH),
            flag: "--light-samples-depth",
            placeholder: "EDGES",
            header: "gpt:lightSamplesDepth",
            compared: true,
            study: false,
        }
        /// Draw directions also by a guide, which up to a million paths learn before the first sample.
        guiding: Guiding = Guiding::Auto => {
            values: Names(Guiding::NAMES),
            flag: "--guiding",
            placeholder: "GUIDING",
            header: "gpt:guiding",
            compared: true,
            study: false,
        }
        /// Paths of the last of five rounds in which a guide is learned, each of which has twice as many as the one before. Fewer are quicker; more give a better guide.
        guiding_paths: NumberOrAuto = NumberOrAuto::Auto => {
            values: WholeOr(FEWEST_GUIDING_PATHS, MOST_GUIDING_PATHS, auto("With `guiding = \"on\"` eight for each pixel, from 16,384 to 524,288; with `auto` as many as a tenth of the render pays for.")),
            flag: "--guiding-paths",
            placeholder: "N",
            header: "gpt:guidingPaths",
            compared: true,
            study: false,
        }
        /// Samples per pixel of the whole picture, by which it is measured out how long to learn before the first sample. Parts of one picture (`--first-sample`) state the same number, so that they learn alike.
        expected_spp: NumberOrAuto = NumberOrAuto::Auto => {
            values: WholeOr(1, MOST_SAMPLES, auto("The samples per pixel of this render.")),
            flag: "--expected-spp",
            placeholder: "N",
            header: "gpt:expectedSpp",
            compared: false,
            study: false,
        }
        /// The presence of light sources in the picture: seen by the camera, or hidden from it.
        emitters: Emitters = Emitters::Seen => {
            values: Names(Emitters::NAMES),
            flag: "--emitters",
            placeholder: "EMITTERS",
            header: "gpt:emitters",
            compared: false,
            study: false,
        }
        /// First depth at which Russian roulette may end a path; 0 = never.
        roulette_depth: NumberOrAuto = NumberOrAuto::Auto => {
            values: WholeOr(0, MOST_SAMPLES, auto("5, and 2 where paths are guided.")),
            flag: "--roulette-depth",
            placeholder: "N",
            header: "gpt:rouletteDepth",
            compared: true,
            study: false,
        }
        /// Brightest channel that a sample may have; 0 = off. Brighter samples are darkened to it, which removes fireflies, but also real light.
        clamp: f64 = 0.0 => {
            values: Real(0.0, LARGEST_CLAMP),
            flag: "--clamp",
            placeholder: "RADIANCE",
            header: "gpt:clamp",
            compared: false,
            study: false,
        }
        /// Key of every random number.
        seed: u32 = 0 => {
            values: Whole(0, u32::MAX),
            flag: "--seed",
            placeholder: "N",
            header: "gpt:seed",
            compared: false,
            study: false,
        }
        /// How multiple importance sampling weighs light samples and samples of the BSDF.
        heuristic: MisHeuristic = MisHeuristic::Power => {
            values: Names(MisHeuristic::NAMES),
            flag: "--heuristic",
            placeholder: "HEURISTIC",
            header: "gpt:heuristic",
            compared: true,
            study: true,
        }
        /// Exponent β of the power heuristic.
        heuristic_exponent: f64 = 2.0 => {
            values: Real(LEAST_HEURISTIC_EXPONENT, MOST_HEURISTIC_EXPONENT),
            flag: "--heuristic-exponent",
            placeholder: "BETA",
            header: "gpt:heuristicExponent",
            compared: true,
            study: true,
        }
        /// Threshold α of the cutoff heuristic: 0 is the balance heuristic, 1 the maximum heuristic.
        heuristic_cutoff: f64 = 0.1 => {
            values: Real(0.0, 1.0),
            flag: "--heuristic-cutoff",
            placeholder: "ALPHA",
            header: "gpt:heuristicCutoff",
            compared: true,
            study: true,
        }
        /// How directions over a diffuse surface are drawn.
        hemisphere: HemisphereSampling = HemisphereSampling::Cosine => {
            values: Names(HemisphereSampling::NAMES),
            flag: "--hemisphere",
            placeholder: "HEMISPHERE",
            header: "gpt:hemisphere",
            compared: true,
            study: true,
        }
        /// The cosine with the normal in the cosine-power lobes of `glossy` and `phong`.
        phong_cosine: PhongCosine = PhongCosine::Kept => {
            values: Names(PhongCosine::NAMES),
            flag: "--phong-cosine",
            placeholder: "COSINE",
            header: "gpt:phongCosine",
            compared: false,
            study: true,
        }
        /// How directions of the cosine-power lobes of `glossy` and `phong` are drawn.
        phong_sampling: PhongSampling = PhongSampling::Lobe => {
            values: Names(PhongSampling::NAMES),
            flag: "--phong-sampling",
            placeholder: "SAMPLING",
            header: "gpt:phongSampling",
            compared: true,
            study: true,
        }
        /// The fate of directions that these lobes have below the surface.
        phong_horizon: PhongHorizon = PhongHorizon::Lost => {
            values: Names(PhongHorizon::NAMES),
            flag: "--phong-horizon",
            placeholder: "HORIZON",
            header: "gpt:phongHorizon",
            compared: false,
            study: true,
        }
        /// How a path continues at a blend of materials.
        blend: BlendMode = BlendMode::Mixture => {
            values: Names(BlendMode::NAMES),
            flag: "--blend",
            placeholder: "MODE",
            header: "gpt:blend",
            compared: true,
            study: true,
        }
    }
}

/// One row of the table.
#[derive(Debug)]
pub struct Setting {
    /// Its field of [`RenderSettings`], its key in the scene file's `[render]` and its key in JSON.
    pub name: &'static str,
    /// The row's doc comment, with the blanks that begin its lines.
    doc: &'static str,
    pub values: Values,
    /// The command line's flag, and what stands for its value in help.
    pub flag: &'static str,
    pub placeholder: &'static str,
    /// Its entry in a picture's header.
    pub header: &'static str,
    /// `gpt bench convergence` may compare its values. It cannot where the measurement itself decides the value, or where the value
    /// decides what picture comes out.
    pub compared: bool,
    /// The setting is there to compare strategies. Help and documents list it apart.
    pub study: bool,
    get: fn(&RenderSettings) -> Value,
    set: fn(&mut RenderSettings, Value),
}

impl Setting {
    /// The setting that is called so.
    pub fn find(name: &str) -> Option<&'static Self> {
        SETTINGS.iter().find(|setting| setting.name == name)
    }

    /// The explanation, in one sentence or more.
    pub fn help(&self) -> &'static str {
        self.doc.trim_start()
    }

    /// Its value where nobody sets it.
    pub fn default(&self) -> Value {
        (self.get)(&RenderSettings::default())
    }

    /// The setting with this number.
    ///
    /// # Errors
    /// The values that are allowed, to follow "expected".
    pub fn number(&'static self, number: i64) -> Result<Assignment, String> {
        self.values.number(number).map(|value| Assignment { setting: self, value })
    }

    /// The setting with this number, which need not be whole.
    ///
    /// # Errors
    /// The values that are allowed, to follow "expected".
    pub fn real(&'static self, number: f64) -> Result<Assignment, String> {
        self.values.real(number).map(|value| Assignment { setting: self, value })
    }

    /// The setting with the value that is written so, a number or a name.
    ///
    /// # Errors
    /// The values that are allowed, to follow "expected".
    pub fn text(&'static self, text: &str) -> Result<Assignment, String> {
        self.values.text(text).map(|value| Assignment { setting: self, value })
    }

    /// The setting with the value of this name.
    ///
    /// # Errors
    /// The values that are allowed, to follow "expected".
    pub fn name(&'static self, name: &str) -> Result<Assignment, String> {
        self.values.name(name).map(|value| Assignment { setting: self, value })
    }
}

/// A setting and a value that it may have.
#[derive(Debug, Clone, Copy)]
pub struct Assignment {
    setting: &'static Setting,
    value: Value,
}

impl Assignment {
    pub fn setting(&self) -> &'static Setting {
        self.setting
    }

    pub fn value(&self) -> Value {
        self.value
    }

    pub fn apply(&self, settings: &mut RenderSettings) {
        (self.setting.set)(settings, self.value);
    }
}

/// The words that distinguish it from another value of the same setting: a name, or a number with what it
/// counts.
impl fmt::Display for Assignment {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.value {
            Value::Name(name) => out.write_str(name),
            Value::Number(_) | Value::Real(_) => write!(out, "{} {}", self.setting.name, self.value),
        }
    }
}

impl RenderSettings {
    /// How many light samples the surface takes that a ray of this depth met: 1 is the camera's. One everywhere before a trial run has found a number.
    #[doc(hidden)]
    pub fn light_samples_at(&self, depth: u32) -> u32 {
        match self.light_samples {
            NumberOrAuto::Number(count) if (1..=self.light_samples_depth).contains(&depth) => count,
            _ => 1,
        }
    }

    /// The number of light samples, at least 1, and of first surfaces that take so many, as in [`RenderSettings::light_samples_at`].
    #[doc(hidden)]
    pub fn several_light_samples(&self) -> [u32; 2] {
        [self.light_samples_at(1).clamp(1, MOST_LIGHT_SAMPLES), self.light_samples_depth.clamp(1, MOST_LIGHT_SAMPLES_DEPTH)]
    }

    /// The first depth at which Russian roulette may end a path, guided or not; none where it never does.
    #[doc(hidden)]
    pub fn first_roulette(&self, is_guided: bool) -> Option<u32> {
        match self.roulette_depth {
            NumberOrAuto::Auto if is_guided => Some(GUIDED_ROULETTE_DEPTH),
            NumberOrAuto::Auto => Some(DEFAULT_ROULETTE_DEPTH),
            NumberOrAuto::Number(depth) => (depth > 0).then_some(depth),
        }
    }

    /// Random numbers depend on how many samples there are in all: the first samples of many are not those of few.
    #[doc(hidden)]
    pub fn uses_strata(&self) -> bool {
        [self.pixel_sampler, PixelSampler::Other(self.sampler)].iter().any(|sampler| {
            matches!(sampler, PixelSampler::Other(SamplerKind::Stratified | SamplerKind::Hammersley | SamplerKind::SharedStrata))
        })
    }

    /// Every setting with the value that counts: where the pixel's sampler is the path's, it has that one's name.
    #[doc(hidden)]
    pub fn values(&self) -> impl Iterator<Item = (&'static Setting, Value)> {
        let pixel_sampler = match self.pixel_sampler {
            PixelSampler::SameAsPath => PixelSampler::Other(self.sampler),
            other => other,
        };
        let counted = Self { pixel_sampler, ..self.clone() };
        SETTINGS.iter().map(move |setting| (setting, (setting.get)(&counted)))
    }

    /// Checks that a scene can be rendered this way.
    ///
    /// # Errors
    /// The first value out of its range, and combinations that cannot be.
    #[doc(hidden)]
    pub fn check(&self) -> Result<(), BadSetting> {
        for (setting, value) in self.values() {
            if let Err(expected) = setting.values.check(value) {
                let message = format!("expected {expected}, found {value}");
                return Err(BadSetting { setting: setting.name, message, help: None });
            }
        }
        if self.max_depth == 0 && self.first_roulette(false).is_none() {
            return Err(BadSetting {
                setting: "roulette_depth",
                message: "with max_depth = 0 and roulette_depth = 0 paths would never end".to_owned(),
                help: Some("bound max_depth, or let Russian roulette end paths".to_owned()),
            });
        }
        Ok(())
    }
}

/// A key and a value for each setting.
impl Serialize for RenderSettings {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.values().map(|(setting, value)| (setting.name, value)))
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn rows_are_complete_and_told_apart() {
        let columns: [fn(&Setting) -> &str; 4] = [|row| row.name, |row| row.flag, |row| row.header, |row| row.help()];
        for column in columns {
            assert_eq!(SETTINGS.iter().map(column).collect::<BTreeSet<_>>().len(), SETTINGS.len());
        }
        for row in SETTINGS {
            assert_eq!(row.flag, format!("--{}", row.name.replace('_', "-")));
            assert!(row.header.starts_with("gpt:") && row.help().ends_with('.'), "{row:?}");
        }
        assert_eq!(RenderSettings::default().check(), Ok(()));
    }

    /// Whatever a row lets people write ends up in its own field and in no other.
    #[test]
    fn every_value_goes_into_its_field_and_comes_back() {
        for row in SETTINGS {
            let values: Vec<Value> = match row.values {
                Whole(least, most) => [least, least + 1, most].map(Value::Number).to_vec(),
                WholeOr(least, most, name) => vec![Value::Number(least), Value::Name(name.name), Value::Number(most)],
                Real(least, most) => [least, 0.5 * (least + most), most].map(Value::Real).to_vec(),
                Names(names) => names.iter().map(|name| Value::Name(name.name)).collect(),
            };
            for value in values {
                let mut settings = RenderSettings::default();
                assert_eq!(row.values.check(value), Ok(()));
                Assignment { setting: row, value }.apply(&mut settings);
                for other in SETTINGS {
                    let expected = if other.name == row.name { value } else { other.default() };
                    assert_eq!((other.get)(&settings), expected, "{} after {} = {value}", other.name, row.name);
                }
            }
        }
    }

    #[test]
    fn values_that_cannot_be_are_named() {
        let message = |settings: RenderSettings| settings.check().expect_err("the settings cannot be").to_string();
        let many = RenderSettings { light_samples: 17.into(), ..RenderSettings::default() };
        assert_eq!(message(many), "light_samples: expected a whole number from 1 to 16, or auto, found 17");
        let none = RenderSettings { spp: 0, ..RenderSettings::default() };
        assert_eq!(message(none), "spp: expected a whole number of at least 1, found 0");
        let endless = RenderSettings { max_depth: 0, roulette_depth: 0.into(), ..RenderSettings::default() };
        assert_eq!(message(endless), "roulette_depth: with max_depth = 0 and roulette_depth = 0 paths would never end");
    }

    #[test]
    fn the_pixels_sampler_is_named_even_where_it_is_the_paths() {
        let settings = RenderSettings { sampler: SamplerKind::Halton, ..RenderSettings::default() };
        let json = serde_json::to_value(&settings).expect("names and numbers");
        assert_eq!((&json["sampler"], &json["pixel_sampler"], &json["spp"]), (&"halton".into(), &"halton".into(), &256.into()));
        assert_eq!(Setting::find("pixel_sampler").map(Setting::default), Some(Value::Name("same")));
    }
}
