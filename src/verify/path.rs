//! One path on both devices, side by side: where do they part?

use std::fmt::{self, Write as _};

use glam::DVec3;
use serde::Serialize;

use super::cause::{self, Cause, Differing};
use super::{PATH_TOLERANCE, planted};
use crate::cpu::ReferenceRenderer;
use crate::gpu::trace::{TracedPlace, TracedVertex};
use crate::gpu::{Device, GpuRenderer};
use crate::plan::trace_record::TRACED_VERTICES;
use crate::plan::{Fault, PlanOptions};
use crate::reference::bsdf::Density;
use crate::reference::trace::{FoundLight, PathTrace, PathVertex};
use crate::renderer::RenderError;
use crate::scene::Scene;
use crate::spectrum::Spectrum;

/// Quantities of a path part where they differ by more than this share of their size: rounding, which bounces off curved surfaces
/// multiply, stays below it for a few vertices.
pub const QUANTITY_TOLERANCE: f64 = 1e-3;
/// Differences below this are none, however small the quantity.
const SMALLEST: f64 = 1e-6;

/// A device's value of a quantity.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Value {
    Vector([f64; 3]),
    Number(f64),
    Text(String),
}

impl Value {
    /// Relative difference; infinite for texts that differ and for a density against a delta lobe.
    fn difference(&self, other: &Self) -> f64 {
        match (self, other) {
            (Self::Vector(a), Self::Vector(b)) => relative_difference(a, b),
            (Self::Number(a), Self::Number(b)) => relative_difference(&[*a], &[*b]),
            (a, b) => {
                if a == b {
                    0.0
                } else {
                    f64::INFINITY
                }
            }
        }
    }
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Vector([x, y, z]) => write!(f, "{x:.6} {y:.6} {z:.6}"),
            Self::Number(x) if *x != 0.0 && !(1e-3..1e6).contains(&x.abs()) => write!(f, "{x:.6e}"),
            Self::Number(x) => write!(f, "{x:.6}"),
            Self::Text(text) => f.write_str(text),
        }
    }
}

fn relative_difference(a: &[f64], b: &[f64]) -> f64 {
    let size = a.iter().chain(b).fold(0.0_f64, |largest, x| largest.max(x.abs()));
    let apart = a.iter().zip(b).fold(0.0_f64, |largest, (x, y)| largest.max((x - y).abs()));
    if apart.is_nan() || size.is_nan() {
        return f64::INFINITY;
    }
    if apart <= SMALLEST * size.min(1.0) { 0.0 } else { apart / size }
}

/// One quantity at one vertex; None where a device has none.
#[derive(Debug, Clone, Serialize)]
pub struct Row {
    /// From 1.
    pub vertex: usize,
    pub quantity: &'static str,
    pub cpu: Option<Value>,
    pub gpu: Option<Value>,
    /// The two differ by more than [`QUANTITY_TOLERANCE`].
    pub parts: bool,
}

/// A path on both devices.
#[derive(Debug, Serialize)]
pub struct PathComparison {
    pub scene: String,
    pub device: String,
    pub size: [u32; 2],
    pub pixel: [u32; 2],
    pub sample: u32,
    pub seed: u32,
    pub rows: Vec<Row>,
    pub cpu_radiance: [f64; 3],
    pub gpu_radiance: [f64; 3],
    /// The explanation of the difference, where the path's radiance does not agree to [`PATH_TOLERANCE`].
    pub cause: Option<Cause>,
    /// There is no difference, or rounding explains it.
    pub agrees: bool,
    /// The fault that was planted on purpose.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub planted: Option<Fault>,
}

/// Follows one path on both devices.
///
/// # Errors
/// Errors of either renderer.
pub fn compare_path(
    device: &Device,
    scene: &Scene,
    [x, y]: [u32; 2],
    sample: u32,
    options: &PlanOptions,
) -> Result<PathComparison, RenderError> {
    let options = PlanOptions { trace: true, ..options.clone() };
    let gpu = GpuRenderer::on(device, scene, &options)?;
    let ours = gpu.trace(x, y, sample)?;
    let reference = ReferenceRenderer::of_length(scene, None, gpu.effort())?;
    let theirs = reference.trace(x, y, sample);
    let gpu_radiance = ours.radiance.map(f64::from);
    let cpu_radiance = theirs.radiance.to_rgb();
    let cpu = reference_vertices(scene, &theirs);
    let gpu_vertices: Vec<Quantities> = ours.vertices.iter().map(|vertex| device_vertex(scene, vertex)).collect();
    let differing = Differing { path: [x, y, sample], first: ours.radiance, second: theirs.radiance.to_f32() };
    let cause = (!differing.agrees_to(PATH_TOLERANCE)).then(|| cause::of(&differing, &reference));
    Ok(PathComparison {
        scene: scene.name.clone(),
        device: device.name.clone(),
        size: scene.film.size,
        pixel: [x, y],
        sample,
        seed: scene.render.seed,
        rows: side_by_side(&cpu, &gpu_vertices),
        cpu_radiance,
        gpu_radiance,
        cause,
        agrees: cause != Some(Cause::Unexplained),
        planted: planted(&gpu, &options),
    })
}

type Quantities = Vec<(&'static str, Value)>;

/// In the order in which things happen along a path.
const ORDER: [&str; 20] = [
    "direction",
    "shape",
    "material",
    "position",
    "shading normal",
    "throughput",
    "found weight",
    "found",
    "light",
    "light direction",
    "light pdf",
    "BSDF pdf of it",
    "light weight",
    "light visible",
    "light adds",
    "sampled direction",
    "sampled pdf",
    "sampled weight",
    "lobe",
    "roulette survival",
];

fn side_by_side(cpu: &[Quantities], gpu: &[Quantities]) -> Vec<Row> {
    let mut rows = Vec::new();
    for index in 0..cpu.len().max(gpu.len()) {
        let find = |vertices: &[Quantities], quantity| {
            let vertex = vertices.get(index)?;
            vertex.iter().find(|(name, _)| *name == quantity).map(|(_, value)| value.clone())
        };
        for quantity in ORDER {
            let (cpu_value, gpu_value) = (find(cpu, quantity), find(gpu, quantity));
            let parts = match (&cpu_value, &gpu_value) {
                (None, None) => continue,
                (Some(a), Some(b)) => a.difference(b) > QUANTITY_TOLERANCE,
                // The packed scene knows no shapes; vertices past the last that the kernel writes down are not its fault.
                // At the end of a path, only one of them may ask for the normal.
                _ => !["shape", "shading normal"].contains(&quantity) && index < TRACED_VERTICES as usize,
            };
            rows.push(Row { vertex: index + 1, quantity, cpu: cpu_value, gpu: gpu_value, parts });
        }
    }
    rows
}

fn vector(v: DVec3) -> Value {
    Value::Vector(v.to_array())
}

fn color(color: Spectrum) -> Value {
    Value::Vector(color.to_rgb())
}

fn single(v: [f32; 3]) -> Value {
    Value::Vector(v.map(f64::from))
}

fn pdf_or_delta(pdf: Option<f64>) -> Value {
    pdf.map_or_else(|| Value::Text("delta".into()), Value::Number)
}

fn yes_or_no(yes: bool) -> Value {
    Value::Text(if yes { "yes" } else { "no" }.into())
}

fn lobe(passes: bool, eta_scale: f64) -> Value {
    let text = if passes {
        "passes"
    } else if eta_scale == 1.0 {
        "reflects"
    } else {
        "refracts"
    };
    Value::Text(text.into())
}

fn outside() -> (&'static str, Value) {
    ("material", Value::Text("(left the scene)".into()))
}

fn within_medium() -> (&'static str, Value) {
    ("material", Value::Text("(within a medium)".into()))
}

fn reference_vertices(scene: &Scene, trace: &PathTrace) -> Vec<Quantities> {
    let mut vertices: Vec<Quantities> = trace.vertices.iter().map(|vertex| reference_vertex(scene, vertex)).collect();
    if let Some(escaped) = trace.escaped {
        let mut last = vec![outside()];
        if let Some((sample, vertex)) = trace.vertices.last().and_then(|vertex| Some((vertex.scattered?, vertex))) {
            let survival = vertex.roulette.map_or(1.0, |(survival, _)| survival);
            last.push(("direction", vector(sample.wi)));
            last.push(("throughput", color(vertex.throughput * sample.weight / survival)));
        } else if let Some(ray) = trace.rays.first() {
            last.push(("direction", vector(ray.direction)));
            last.push(("throughput", color(Spectrum::WHITE)));
        }
        push_found(&mut last, Some(escaped));
        vertices.push(last);
    }
    vertices
}

fn push_found(quantities: &mut Quantities, found: Option<FoundLight>) {
    if let Some(found) = found.filter(|found| !found.contribution.is_black()) {
        quantities.push(("found weight", Value::Number(found.weight)));
        quantities.push(("found", color(found.contribution)));
    }
}

fn reference_vertex(scene: &Scene, vertex: &PathVertex) -> Quantities {
    let mut quantities = vec![
        ("direction", vector(-vertex.wo)),
        ("position", vector(vertex.position + scene.center())),
        ("throughput", color(vertex.throughput)),
    ];
    match &vertex.surface {
        Some(surface) => quantities.extend([
            ("shape", Value::Text(scene.label_of(surface.shape))),
            ("material", Value::Text(scene.materials[surface.material].name.clone())),
        ]),
        None => quantities.push(within_medium()),
    }
    if let Some(normal) = vertex.shading_normal {
        quantities.push(("shading normal", vector(normal)));
    }
    push_found(&mut quantities, vertex.emission);
    if let Some(connection) = vertex.light {
        let light = connection.light;
        quantities.extend([
            ("light", Value::Text(format!("number {}", light.light))),
            ("light direction", vector(light.wi)),
            ("light pdf", pdf_or_delta((!light.delta).then_some(light.pdf))),
            ("BSDF pdf of it", Value::Number(connection.bsdf_pdf)),
            ("light weight", Value::Number(connection.weight)),
            ("light visible", yes_or_no(connection.visible)),
            ("light adds", color(connection.contribution)),
        ]);
    }
    if let Some(sample) = vertex.scattered {
        let pdf = match sample.density {
            Density::SolidAngle(pdf) => Some(pdf),
            Density::Delta => None,
        };
        quantities.extend([
            ("sampled direction", vector(sample.wi)),
            ("sampled pdf", pdf_or_delta(pdf)),
            ("sampled weight", color(sample.weight)),
            ("lobe", lobe(sample.is_null, sample.eta * sample.eta)),
        ]);
    }
    if let Some((survival, _)) = vertex.roulette {
        quantities.push(("roulette survival", Value::Number(survival)));
    }
    quantities
}

fn device_vertex(scene: &Scene, vertex: &TracedVertex) -> Quantities {
    let mut quantities = vec![("direction", single(vertex.direction)), ("throughput", single(vertex.throughput))];
    let position = |position: [f32; 3]| ("position", vector(DVec3::from(position.map(f64::from)) + scene.center()));
    match vertex.place {
        TracedPlace::Outside => quantities.push(outside()),
        TracedPlace::Medium(place) => quantities.extend([within_medium(), position(place)]),
        TracedPlace::Surface(place, normal, material) => {
            quantities.push(("material", Value::Text(scene.materials[material].name.clone())));
            quantities.extend([position(place), ("shading normal", single(normal))]);
        }
    }
    if let Some(found) = vertex.found.filter(|found| found.contribution != [0.0; 3]) {
        quantities.push(("found weight", Value::Number(f64::from(found.weight))));
        quantities.push(("found", single(found.contribution)));
    }
    if let Some(light) = vertex.light {
        quantities.extend([
            ("light", Value::Text(format!("number {}", light.light))),
            ("light direction", single(light.wi)),
            ("light pdf", pdf_or_delta((light.pdf >= 0.0).then_some(f64::from(light.pdf)))),
            ("BSDF pdf of it", Value::Number(f64::from(light.bsdf_pdf))),
            ("light weight", Value::Number(f64::from(light.weight))),
            ("light visible", yes_or_no(light.visible)),
            ("light adds", single(if light.visible { light.unshadowed } else { [0.0; 3] })),
        ]);
    }
    if let Some(sample) = vertex.sample {
        quantities.extend([
            ("sampled direction", single(sample.wi)),
            ("sampled pdf", pdf_or_delta((sample.pdf >= 0.0).then_some(f64::from(sample.pdf)))),
            ("sampled weight", single(sample.weight)),
            ("lobe", lobe(sample.passes, f64::from(sample.eta_scale))),
        ]);
    }
    if let Some(survival) = vertex.survival {
        quantities.push(("roulette survival", Value::Number(f64::from(survival))));
    }
    quantities
}

impl fmt::Display for PathComparison {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ([width, height], [x, y]) = (self.size, self.pixel);
        writeln!(f, "{} {width}x{height}, pixel {x},{y}, sample {}, seed {}", self.scene, self.sample, self.seed)?;
        writeln!(f, "  {:<18}  {:<36} {}", "", "CPU reference", self.device)?;
        let mut vertex = 0;
        for row in &self.rows {
            if row.vertex != vertex {
                vertex = row.vertex;
                writeln!(f, "vertex {vertex}")?;
            }
            let show = |value: &Option<Value>| value.as_ref().map_or_else(|| "-".to_owned(), Value::to_string);
            let mark = if row.parts { '*' } else { ' ' };
            writeln!(f, "{}", format!("{mark} {:<18}  {:<36} {}", row.quantity, show(&row.cpu), show(&row.gpu)).trim_end())?;
        }
        let radiance = |value: [f64; 3]| Value::Vector(value).to_string();
        writeln!(f, "radiance\n  {:<18}  {:<36} {}", "", radiance(self.cpu_radiance), radiance(self.gpu_radiance))?;
        let mut end = String::from(match self.cause {
            None => "the radiance agrees",
            Some(Cause::Decision) => "the radiance differs, because rounding turns a decision over",
            Some(Cause::Steepness) => "the radiance differs, no more than the path magnifies rounding",
            Some(Cause::Unexplained) => "the radiance DIFFERS",
        });
        match self.rows.iter().find(|row| row.parts) {
            Some(row) => write!(end, "; the paths part at vertex {}: {}", row.vertex, row.quantity)?,
            None => end.push_str("; the paths do not part"),
        }
        writeln!(f, "{end}")
    }
}
