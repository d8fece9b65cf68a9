//! `[film]` and `[render]`: how large the picture is and how it is estimated. `table` has a row for each setting of `[render]`.

mod film;
mod kinds;
mod number_or_auto;
mod row;
mod table;
mod value;

pub use film::{FilmSettings, Filter, FilterKind, LARGEST_FILTER_RADIUS, MAX_PIXELS, MAX_SIDE, SMALLEST_FILTER_RADIUS};
pub use kinds::{
    BlendMode, DistanceSampling, Emitters, Estimator, Guiding, HemisphereSampling, LightChoice, LightSampling, MisHeuristic,
    PhongCosine, PhongHorizon, PhongSampling, PixelSampler, SamplerKind,
};
pub use number_or_auto::NumberOrAuto;
pub use table::{Assignment, MOST_LIGHT_SAMPLES, MOST_LIGHT_SAMPLES_DEPTH, RenderSettings, SETTINGS, Setting};
pub use value::{BadSetting, MOST_SAMPLES, Value, Values};
