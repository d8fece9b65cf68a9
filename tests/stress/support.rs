//! Helpers that the cases share: a device, effort, findings and how they are judged.

pub use crate::common::device::{DEVICE, with_limits};
use crate::common::ray_queries::RAY_QUERY_DEVICE;
use gpt::cpu::ReferenceRenderer;
use gpt::film::Band;
use gpt::gpu::{Device, GpuRenderer};
use gpt::load::load_toml_str;
use gpt::plan::PlanOptions;
use gpt::renderer::{RenderReport, RenderRequest, Renderer, Silent};
use gpt::scene::{SamplerKind, Scene};
use gpt::verify::{self, Verdict};

/// How long a case may take.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effort {
    /// Seconds: what every test run can afford.
    Bounded,
    /// Minutes: what the page shows.
    Full,
}

impl Effort {
    /// One number or the other.
    pub fn pick<T>(self, bounded: T, full: T) -> T {
        if self == Self::Full { full } else { bounded }
    }
}

/// The measurement of one case.
#[derive(Debug, Clone)]
pub struct Finding {
    pub case: String,
    /// Name of the measure and its value, as the page shows them.
    pub measures: Vec<(&'static str, String)>,
    /// The complaint, if something is wrong.
    pub complaint: Option<String>,
}

impl Finding {
    pub fn new(case: impl Into<String>) -> Self {
        Self { case: case.into(), measures: Vec::new(), complaint: None }
    }

    pub fn with(mut self, name: &'static str, value: impl ToString) -> Self {
        self.measures.push((name, value.to_string()));
        self
    }

    /// Complains unless `right`. The first complaint stays.
    pub fn require(mut self, right: bool, complaint: impl FnOnce() -> String) -> Self {
        if !right && self.complaint.is_none() {
            self.complaint = Some(complaint());
        }
        self
    }
}

/// Prints all findings and fails on any complaint.
#[allow(dead_code, reason = "the bench prints and does not fail")]
pub fn assert_all(findings: &[Finding]) {
    assert!(!findings.is_empty() || DEVICE.is_none(), "nothing was tried");
    for finding in findings {
        println!("{}", in_one_line(finding));
    }
    let complaints: Vec<String> =
        findings.iter().filter_map(|f| f.complaint.as_ref().map(|why| format!("{}: {why}", f.case))).collect();
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}

#[allow(dead_code, reason = "the bench prints tables instead")]
fn in_one_line(finding: &Finding) -> String {
    let measures: Vec<String> = finding.measures.iter().map(|(name, value)| format!("{name} {value}")).collect();
    format!("{}: {}", finding.case, measures.join(", "))
}

/// A scene from its text. Its sampler is pinned, so that what was measured does not change with a default.
pub fn scene(text: &str) -> Scene {
    let loaded = load_toml_str(text, "stress", std::path::Path::new(""));
    let mut scene = loaded.unwrap_or_else(|error| panic!("{error:?}\n{text}"));
    if !text.contains("sampler = ") {
        scene.render.sampler = SamplerKind::Halton;
    }
    scene
}

/// Share of paths that has to match loosely, unless a case has its own.
pub const LEAST_MATCHING: f64 = 0.99;

/// The device's picture of `scene` against the reference's picture of `truth`, path by path. None without a device.
pub fn compare_with(scene: &Scene, truth: &Scene, options: &PlanOptions) -> Option<Verdict> {
    let device = DEVICE.as_ref()?;
    let mut gpu = GpuRenderer::on(device, scene, options).expect("the scene fits");
    let mut cpu = ReferenceRenderer::new(truth).expect("the scene is supported");
    Some(compare_renderers(truth, &mut gpu, &mut cpu))
}

pub fn compare_renderers(scene: &Scene, gpu: &mut dyn Renderer, cpu: &mut ReferenceRenderer) -> Verdict {
    verify::compare(scene, gpu, cpu, None).expect("both render")
}

/// The usual measures of a comparison; complains where `verify` does.
pub fn judge(case: impl Into<String>, scene: &Scene, truth: &Scene) -> Option<Finding> {
    judge_with(case, scene, truth, LEAST_MATCHING)
}

/// Judges as [`judge`] does, for a case in which a smaller share of paths matches to the last digits. Means
/// are compared all the same.
pub fn judge_with(case: impl Into<String>, scene: &Scene, truth: &Scene, least_matching: f64) -> Option<Finding> {
    compare_with(scene, truth, &PlanOptions::default()).map(|verdict| judged(case, &verdict, least_matching))
}

/// The finding that [`judge_with`] makes of a verdict.
pub fn judged(case: impl Into<String>, verdict: &Verdict, least_matching: f64) -> Finding {
    let right =
        verdict.rejections.is_empty() && verdict.non_finite_samples == 0 && verdict.loosely_matching_share() >= least_matching;
    measured(case, verdict).require(right, || format!("{verdict:#?}"))
}

/// The finding of [`judged`], without a judgement.
pub fn measured(case: impl Into<String>, verdict: &Verdict) -> Finding {
    Finding::new(case)
        .with("paths that match", format!("{:.3} %", 100.0 * verdict.loosely_matching_share()))
        .with("difference of the means", format!("{:.1e}", mean_difference(verdict)))
        .with("rms over the mean", format!("{:.1e}", verdict.rms_difference / mean_of(&verdict.cpu_mean).max(1e-300)))
        .with("not finite", verdict.non_finite_samples)
}

/// The relative difference of the whole pictures, in the worst channel.
pub fn mean_difference(verdict: &Verdict) -> f64 {
    let relative = |channel: usize| (verdict.gpu_mean[channel] / verdict.cpu_mean[channel] - 1.0).abs();
    (0..3).filter(|&channel| verdict.cpu_mean[channel] != 0.0).map(relative).fold(0.0, f64::max)
}

/// The mean of the three channels.
pub fn mean_of(channels: &[f64; 3]) -> f64 {
    channels.iter().sum::<f64>() / 3.0
}

/// The device's picture: the first channel of every pixel. None without a device.
pub fn render(scene: &Scene) -> Option<Vec<f64>> {
    render_with(scene, &PlanOptions::default())
}

/// Renders as [`render`] does, with a plan of its own.
pub fn render_with(scene: &Scene, options: &PlanOptions) -> Option<Vec<f64>> {
    render_band(scene, options).map(|(band, _)| band.mean.iter().map(|pixel| f64::from(pixel[0])).collect())
}

/// The whole picture as one band, and what the render counted.
pub fn render_band(scene: &Scene, options: &PlanOptions) -> Option<(Band, RenderReport)> {
    let device: &Option<Device> = if options.asks_for_ray_queries() { &RAY_QUERY_DEVICE } else { &DEVICE };
    Some(render_band_on(device.as_ref()?, scene, options))
}

/// Renders as [`render_band`] does, on this device.
pub fn render_band_on(device: &Device, scene: &Scene, options: &PlanOptions) -> (Band, RenderReport) {
    let mut renderer = GpuRenderer::on(device, scene, options).expect("the scene fits");
    whole_picture(&mut renderer, scene)
}

/// All rows of a picture put together.
pub fn whole_picture(renderer: &mut dyn Renderer, scene: &Scene) -> (Band, RenderReport) {
    let [width, rows] = scene.film.size;
    let mut whole = Band { width, rows, samples: scene.render.spp, ..Band::default() };
    let request = RenderRequest { rows: 0..rows, samples: 0..scene.render.spp };
    let mut on_band = |band: Band| {
        whole.mean.extend(band.mean);
        whole.second_moment.extend(band.second_moment);
        Ok(())
    };
    let report = renderer.render(&request, &Silent, &mut on_band).expect("rendering succeeds");
    (whole, report)
}
