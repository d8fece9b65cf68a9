//! Pictures whose every pixel is known in closed form, rendered on one device alone.
//!
//! The reference cannot err along with the device here: the truth is a formula. All pixels of a scene have the same expectation. Each
//! shifts the sequence of random numbers by a hash of its own, so pixels are independent replications, and Student's t-test judges
//! their mean, with the level shared out over all tests (Šidák) and a margin for what single precision may do.

use std::path::Path;
use std::sync::Mutex;

use serde::Serialize;

use super::planted;
use crate::compare::{Moments, one_sample_t_test_beyond, sidak};
use crate::cpu::ReferenceRenderer;
use crate::film::Band;
use crate::gpu::{Device, GpuRenderer};
use crate::load;
use crate::load::SceneError;
use crate::plan::{Fault, PlanOptions};
use crate::renderer::{RenderError, RenderRequest, Renderer, Silent};
use crate::scene::Scene;

/// Probability that the whole family fails a device that is right; the seeds are fixed, so one that passed goes on passing.
const ALPHA: f64 = 1e-3;
/// Relative error that single precision may make.
const MARGIN: f64 = 2e-5;

/// A scene and its truth.
struct Case {
    name: &'static str,
    /// The formula that gives the truth.
    formula: &'static str,
    text: &'static str,
    expected: [f64; 3],
}

const CASES: [Case; 5] = [
    Case { name: "furnace", formula: "Le / (1 - albedo)", text: include_str!("closed_forms/furnace.toml"), expected: [2.0; 3] },
    Case {
        name: "blend-mirror",
        formula: "albedo / 2 + 1 / 2",
        text: include_str!("closed_forms/blend-mirror.toml"),
        expected: [0.7; 3],
    },
    Case { name: "glass", formula: "1, as all around", text: include_str!("closed_forms/glass.toml"), expected: [1.0; 3] },
    // Lambert's formula for the irradiance of a polygon.
    Case {
        name: "triangle-light",
        formula: "Lambert's polygon formula",
        text: include_str!("closed_forms/triangle-light.toml"),
        expected: [0.261_739_9; 3],
    },
    Case {
        name: "sphere-light",
        formula: "albedo L (R / d)^2",
        text: include_str!("closed_forms/sphere-light.toml"),
        expected: [0.18, 0.36, 0.72],
    },
];

/// The result of one scene.
#[derive(Debug, Serialize)]
pub struct ClosedForm {
    pub closed_form: &'static str,
    pub formula: &'static str,
    pub device: String,
    pub expected: [f64; 3],
    /// Mean of all pixels, and its standard error.
    pub found: [f64; 3],
    pub standard_error: [f64; 3],
    pub non_finite_samples: u64,
    pub agrees: bool,
    /// The fault that was planted on purpose.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub planted: Option<Fault>,
}

/// Why a closed form could not be asked for.
#[derive(Debug, thiserror::Error)]
pub enum ClosedFormError {
    #[error(transparent)]
    Scene(#[from] SceneError),
    #[error(transparent)]
    Render(#[from] RenderError),
}

/// How many there are.
pub fn count() -> usize {
    CASES.len()
}

/// Renders the closed form number `index` on a device and judges it.
///
/// # Errors
/// Errors of rendering.
pub fn check(index: usize, device: &Device, options: &PlanOptions) -> Result<ClosedForm, ClosedFormError> {
    let scene = load(&CASES[index])?;
    let mut gpu = GpuRenderer::on(device, &scene, options)?;
    let closed = judge(&CASES[index], &scene, &mut gpu)?;
    Ok(ClosedForm { planted: planted(&gpu, options), ..closed })
}

/// Checks the reference as [`check`] checks a device.
///
/// # Errors
/// The errors of [`check`].
pub fn check_reference(index: usize) -> Result<ClosedForm, ClosedFormError> {
    let scene = load(&CASES[index])?;
    judge(&CASES[index], &scene, &mut ReferenceRenderer::new(&scene)?)
}

fn judge(case: &Case, scene: &Scene, renderer: &mut dyn Renderer) -> Result<ClosedForm, ClosedFormError> {
    let (pixels, non_finite_samples) = render(renderer, scene)?;
    let mut moments = [Moments::default(); 3];
    for pixel in pixels {
        for (channel, value) in moments.iter_mut().zip(pixel) {
            channel.push(f64::from(value));
        }
    }
    let level = sidak(ALPHA, 3 * CASES.len());
    let holds = |(observed, truth): (&Moments, f64)| one_sample_t_test_beyond(observed, truth, MARGIN * truth).p_value >= level;
    Ok(ClosedForm {
        closed_form: case.name,
        formula: case.formula,
        device: renderer.device().to_owned(),
        expected: case.expected,
        found: moments.map(|observed| observed.mean()),
        standard_error: moments.map(|observed| observed.standard_error()),
        non_finite_samples,
        agrees: non_finite_samples == 0 && moments.iter().zip(case.expected).all(holds),
        planted: None,
    })
}

fn load(case: &Case) -> Result<Scene, SceneError> {
    load::load_toml_str(case.text, case.name, Path::new(""))
}

/// All pixels, and how many samples the film refused.
fn render(renderer: &mut dyn Renderer, scene: &Scene) -> Result<(Vec<[f32; 3]>, u64), RenderError> {
    let pixels = Mutex::new(Vec::new());
    let request = RenderRequest { rows: 0..scene.film.size[1], samples: 0..scene.render.spp };
    let report = renderer.render(&request, &Silent, &mut |band: Band| {
        pixels.lock().unwrap_or_else(std::sync::PoisonError::into_inner).extend(band.mean);
        Ok(())
    })?;
    Ok((pixels.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner), report.non_finite_samples))
}
