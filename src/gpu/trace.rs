//! The events along one path on the device, vertex by vertex.

use super::film::read_rows;
use super::passes::Pass;
use super::pipeline::Pipeline;
use crate::packed::NONE;
use crate::plan::bindings::Binding;
use crate::plan::trace_record::{
    TRACE_BYTES, TRACE_WORDS, TRACED_FOUND, TRACED_LIGHT, TRACED_LIGHT_SEEN, TRACED_MEDIUM, TRACED_NULL, TRACED_ROULETTE,
    TRACED_SAMPLE, TRACED_VERTEX,
};
use crate::renderer::{RenderError, Silent, Stopping};
use crate::sampling::Sampling;
use crate::scene::MaterialId;

/// Emission or environment radiance that the path met.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TracedFind {
    pub contribution: [f32; 3],
    /// Weight by multiple importance sampling.
    pub weight: f32,
}

/// A light sample that could contribute.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TracedLight {
    pub light: u32,
    pub wi: [f32; 3],
    /// Per steradian, the choice of the light included; negative for a light that only one direction leads to.
    pub pdf: f32,
    /// Density of BSDF sampling for the same direction.
    pub bsdf_pdf: f32,
    pub weight: f32,
    pub visible: bool,
    /// The light's part of the path's radiance where it is visible.
    pub unshadowed: [f32; 3],
}

/// The direction in which the path went on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TracedSample {
    pub wi: [f32; 3],
    /// Per steradian; negative for a delta lobe.
    pub pdf: f32,
    /// f·|cosθi| / density.
    pub weight: [f32; 3],
    /// Squared ratio of the indices of refraction.
    pub eta_scale: f32,
    pub passes: bool,
}

/// The place of a vertex.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TracedPlace {
    /// Position, shading normal on wo's side, and which of the scene's materials.
    Surface([f32; 3], [f32; 3], MaterialId),
    /// The position.
    Medium([f32; 3]),
    /// The ray left the scene.
    Outside,
}

/// One vertex of a path, or its end outside the scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TracedVertex {
    pub place: TracedPlace,
    /// Direction of the ray that led here.
    pub direction: [f32; 3],
    pub throughput: [f32; 3],
    pub found: Option<TracedFind>,
    pub light: Option<TracedLight>,
    pub sample: Option<TracedSample>,
    /// Probability of surviving Russian roulette.
    pub survival: Option<f32>,
}

/// A path as the device followed it.
#[derive(Debug, Clone, PartialEq)]
pub struct GpuPathTrace {
    pub vertices: Vec<TracedVertex>,
    pub radiance: [f32; 3],
}

/// Follows one path, sample `sample` of the pixel at column `x` and row `y`. `scene_materials`: which of the scene's materials the packed ones
/// are.
///
/// # Errors
/// [`RenderError::Internal`] where the pipeline was not made with [`crate::plan::PlanOptions::trace`]; else what the device reports.
pub(super) fn trace(
    pipeline: &Pipeline,
    sampling: &Sampling,
    [x, y, sample]: [u32; 3],
    scene_materials: &[MaterialId],
) -> Result<GpuPathTrace, RenderError> {
    let missing = || RenderError::Internal("the kernels were not compiled to trace paths".into());
    let source = pipeline.buffers.buffer(Binding::Trace).ok_or_else(missing)?;
    let pass = Pass { first_pixel: x, pixel_count: 1, first_sample: sample, sample_count: 1, film_is_empty: true };
    pipeline.write(Binding::Trace, &vec![0; TRACE_BYTES as usize]);
    pipeline.write_pass(y, &pass, sampling);
    pipeline.run_pass(&pass, &Stopping::new(&Silent, None))?;
    let bytes = pipeline.device.read_start(source, TRACE_BYTES)?;
    let words: Vec<[f32; 4]> = bytes.chunks_exact(16).map(bytemuck::pod_read_unaligned).collect();
    let vertices = words.chunks_exact(TRACE_WORDS as usize).map_while(|words| read_vertex(words, scene_materials)).collect();
    let (sums, _) = read_rows(&pipeline.device, &pipeline.buffers.film, pipeline.width, 0..1)?;
    let [r, g, b, _] = sums[x as usize];
    Ok(GpuPathTrace { vertices, radiance: [r, g, b] })
}

/// None past the last vertex. `scene_materials`: which of the scene's materials the packed ones are.
fn read_vertex(words: &[[f32; 4]], scene_materials: &[MaterialId]) -> Option<TracedVertex> {
    let xyz = |word: usize| [words[word][0], words[word][1], words[word][2]];
    let w = |word: usize| words[word][3];
    let notes = w(3).to_bits();
    let has = |note: u32| notes & note != 0;
    let material = scene_materials.get(w(1).to_bits() as usize);
    let place = match material {
        _ if has(TRACED_MEDIUM) => TracedPlace::Medium(xyz(0)),
        Some(&material) if w(0).to_bits() != NONE => TracedPlace::Surface(xyz(0), xyz(1), material),
        _ => TracedPlace::Outside,
    };
    has(TRACED_VERTEX).then(|| TracedVertex {
        place,
        direction: xyz(2),
        throughput: xyz(3),
        found: has(TRACED_FOUND).then(|| TracedFind { contribution: xyz(4), weight: w(4) }),
        light: has(TRACED_LIGHT).then(|| TracedLight {
            light: words[7][0].to_bits(),
            wi: xyz(5),
            pdf: w(5),
            bsdf_pdf: words[7][1],
            weight: w(6),
            visible: has(TRACED_LIGHT_SEEN),
            unshadowed: xyz(6),
        }),
        sample: has(TRACED_SAMPLE).then(|| TracedSample {
            wi: xyz(8),
            pdf: w(8),
            weight: xyz(9),
            eta_scale: w(9),
            passes: has(TRACED_NULL),
        }),
        survival: has(TRACED_ROULETTE).then_some(words[7][2]),
    })
}
