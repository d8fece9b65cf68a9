//! A headless GPU path tracer that proves its pictures against a CPU reference.
//!
//! ```no_run
//! use gpt::Render;
//!
//! let image = gpt::Scene::load("cornell")?.render(&gpt::RenderOptions::default())?;
//! image.save("cornell.exr")?;
//! # Ok::<(), gpt::Error>(())
//! ```
//!
//! A [`Scene`] comes from a scene file, from a model, or by the name of a built-in scene. [`Render::render`] makes an [`Image`] of it on the
//! best device there is: a discrete, an integrated or a software GPU through Vulkan, Metal or Direct3D 12, else the CPU. A [`Renderer`] hands
//! over rows as they are finished, so that memory does not grow with the picture, and tells an [`Observer`] how far it is. [`compare()`] measures
//! how far two pictures are apart. [`verify()`] follows the same paths on the GPU and in the CPU reference and tests whether they agree.
//!
//! This one renders on the CPU, with settings of its own:
//!
//! ```
//! use gpt::Render;
//!
//! let mut scene = gpt::Scene::from_toml(
//!     r#"
//!     [camera]
//!     position = [0, 1, 4]
//!     look_at = [0, 0, 0]
//!     vfov = 40
//!
//!     [[material]]
//!     name = "clay"
//!     type = "diffuse"
//!     reflectance = [0.6, 0.3, 0.2]
//!
//!     [[shape]]
//!     type = "sphere"
//!     center = [0, 0, 0]
//!     radius = 1
//!     material = "clay"
//!
//!     [[light]]
//!     type = "directional"
//!     direction = [-1, -2, -1]
//!     irradiance = 3
//!     "#,
//! )?;
//! scene.render.sampler = gpt::SamplerKind::Halton;
//!
//! let device = gpt::DeviceChoice::Cpu;
//! let options = gpt::RenderOptions { device, size: Some([32, 24]), samples: Some(4), ..Default::default() };
//! let image = scene.render(&options)?;
//! let brightest = image.pixels().iter().flatten().copied().fold(0.0, f32::max);
//! assert!(image.width() == 32 && brightest > 0.1);
//!
//! let again = scene.render(&options)?;
//! assert!(gpt::compare(&image, &again)?.largest.difference == 0.0);
//! # Ok::<(), gpt::Error>(())
//! ```
//!
//! | to | take |
//! | --- | --- |
//! | read a scene, or make one of text | [`Scene::load`], [`Scene::from_toml`] |
//! | render it whole | [`Render::render`] with [`RenderOptions`] |
//! | render row by row, with progress, or again and again | [`Renderer`] and an [`Observer`] |
//! | end at a time, an error, or an interval for the truth | [`RenderOptions`], [`IntervalOptions`]; [`Outcome`] says what ended it |
//! | read, hold, write and compare pictures | [`Image`], [`compare()`] |
//! | test a device | [`verify()`] |
//!
//! # Features
//!
//! `cli`, on by default, is the program `gpt`. A crate that wants the library alone turns it off: `default-features = false`.
//!
//! # Inside
//!
//! Modules are public for the program, its tests and its benchmarks; they are not part of the interface and change without notice.
//!
//! ```text
//! scene file ─▶ Scene ─▶ PackedScene ─▶ Plan ─▶ stages (GPU) ─▶ Film ─▶ EXR / PNG / stats
//!                 └────────────────▶ reference integrator (CPU, f64) ────┘
//! ```

#[cfg(feature = "bench")]
#[doc(hidden)]
pub mod bench;
#[doc(hidden)]
pub mod binary_tree;
#[doc(hidden)]
pub mod compare;
#[doc(hidden)]
pub mod confidence;
#[doc(hidden)]
pub mod cpu;
#[cfg(feature = "denoise")]
#[doc(hidden)]
pub mod denoise;
#[doc(hidden)]
pub mod device;
#[doc(hidden)]
pub mod emission_map;
mod error;
#[doc(hidden)]
pub mod film;
#[doc(hidden)]
pub mod gpu;
#[doc(hidden)]
pub mod learn;
#[doc(hidden)]
pub mod merge;
#[doc(hidden)]
pub mod output;
#[doc(hidden)]
pub mod packed;
#[doc(hidden)]
pub mod picture_test;
#[doc(hidden)]
pub mod plan;
#[doc(hidden)]
pub mod referee;
#[doc(hidden)]
pub mod reference;
#[doc(hidden)]
pub mod regroup;
#[doc(hidden)]
pub mod render;
#[doc(hidden)]
pub mod renderer;
#[doc(hidden)]
pub mod sampling;
#[doc(hidden)]
pub mod shader;
#[doc(hidden)]
pub mod texture;
#[doc(hidden)]
pub mod verify;

#[cfg(test)]
#[path = "../tests/common/effort.rs"]
mod effort;
#[cfg(test)]
#[path = "../tests/statistics/mod.rs"]
mod statistics;

use gpt_scene::{black_body, file_identity, input, picture_file};
#[doc(hidden)]
pub use gpt_scene::{choice, load, math, scene, scene_writer, spectrum};

#[doc(inline)]
pub use {
    compare::{Comparison, Extreme, Metric, MetricValue, SizeMismatch},
    confidence::{IntervalBasis, IntervalEstimate, IntervalOptions, IntervalScope},
    error::Error,
    film::Band,
    load::SceneError,
    render::error_estimate::ErrorEstimate,
    render::image::{Image, compare},
    render::options::RenderOptions,
    render::progressive::{Outcome, Stop},
    render::scene::Render,
    render::stream::Renderer,
    render::verify::verify,
    renderer::{DeviceChoice, Observer, RenderReport, Silent},
    scene::{
        BlendMode, DistanceSampling, Emitters, Estimator, FilmSettings, Filter, FilterKind, Guiding, HemisphereSampling,
        LightChoice, LightSampling, MisHeuristic, NumberOrAuto, PhongCosine, PhongHorizon, PhongSampling, PixelSampler,
        RenderSettings, SamplerKind, Scene,
    },
    verify::Verdict,
};
