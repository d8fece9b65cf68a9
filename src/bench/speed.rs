//! How fast a scene renders, where the time goes, and how that grows.

use std::time::Instant;

use serde::Serialize;

use super::growth::Growth;
use super::interval::{Ratio, Spread};
use super::scenes;
use super::subject::{BenchError, Devices, SceneSubject, Subject};
use crate::cpu::ReferenceRenderer;
use crate::gpu::GpuRenderer;
use crate::load::SceneError;
use crate::packed::hierarchy::Traversal;
use crate::plan::{PlanOptions, StageMode, memory};
use crate::renderer::{DeviceChoice, Observer, RenderError, RenderRequest, Renderer};
use crate::scene::Scene;

/// The options of a measurement of speed.
#[derive(Debug, Clone)]
pub struct SpeedOptions {
    pub device: DeviceChoice,
    /// None: the plan decides.
    pub stages: Option<StageMode>,
    /// Everything else that is asked of the plan.
    pub plan: PlanOptions,
    pub growths: Vec<Growth>,
    /// The larger sizes too.
    pub everything: bool,
    pub size: [u32; 2],
    pub spp: u32,
    /// Edges of a path at most; None: as the scenes say.
    pub depth: Option<u32>,
    /// Measured rounds, after one that is thrown away.
    pub rounds: u32,
}

impl SpeedOptions {
    /// Gives a scene the paths' length that is wanted.
    pub(super) fn limit_depth(&self, scene: &mut Scene) {
        scene.render.max_depth = self.depth.unwrap_or(scene.render.max_depth);
    }

    /// The scene of a size, at the base size of pictures, and the samples to take of it.
    ///
    /// # Errors
    /// None that a test would not find.
    fn grown(&self, growth: Growth, size: u32, own: &Scene) -> Result<(Scene, u32), SceneError> {
        let mut scene = match growth {
            Growth::Triangles => scenes::hills(size)?,
            Growth::Lights => scenes::panel(size)?,
            Growth::Leaves => scenes::leaves(size)?,
            Growth::Trees => scenes::forest(size)?,
            Growth::Scenes | Growth::Resolution | Growth::Samples => own.clone(),
        };
        self.limit_depth(&mut scene);
        scene.film.size = if growth == Growth::Resolution { [size, size] } else { self.size };
        Ok((scene, if growth == Growth::Samples { size } else { self.spp }))
    }
}

/// One stage's share of a pass.
#[derive(Debug, Clone, Serialize)]
pub struct StageShare {
    pub stage: String,
    /// Over all edges of a pass.
    pub seconds: Spread,
    pub share: f64,
    pub dispatches: u32,
}

/// The speed of one scene at one size.
#[derive(Debug, Clone, Serialize)]
pub struct Speed {
    pub device: String,
    /// `fused`, `wavefront`, or `cpu`.
    pub stages: String,
    /// The form of the hierarchy that rays go through, as in `--stats`; null where there is none, and on the CPU.
    pub hierarchy: Option<String>,
    pub build_seconds: f64,
    pub compile_seconds: f64,
    /// From nothing to one finished sample of every pixel, the driver's compiler included.
    pub first_picture_seconds: f64,
    pub seconds: Spread,
    pub samples_per_second: Spread,
    pub rays_per_second: Spread,
    pub rays_per_sample: f64,
    /// Time per sample over that of the first row, run by run; none for the first itself.
    pub time_per_sample: Option<Ratio>,
    /// State of a path in flight: ray, throughput, shadow ray, places in queues. None where paths stay in registers.
    pub bytes_per_path: Option<u64>,
    /// On the device, everything together; 0 on the CPU.
    pub device_bytes: u64,
    /// From time stamps of the device, where it has them.
    pub stage_times: Vec<StageShare>,
    /// Paths alive at each edge of a pass, as a share of those that the pool holds.
    pub occupancy: Vec<f64>,
}

/// One line of a table.
#[derive(Debug, Clone, Serialize)]
pub struct SpeedRow {
    pub scene: String,
    /// The quantity that grew; None for scenes as they are.
    pub count: Option<u64>,
    pub width: u32,
    pub height: u32,
    pub spp: u32,
    #[serde(flatten)]
    pub outcome: Outcome,
}

/// A measurement, or why there is none.
#[derive(Debug, Clone, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    Measured(Box<Speed>),
    DoesNotFit(String),
}

/// One table.
#[derive(Debug, Clone, Serialize)]
pub struct SpeedTable {
    pub growth: Growth,
    pub rows: Vec<SpeedRow>,
}

/// A row in the making.
struct Entry<'a> {
    row: SpeedRow,
    subject: Result<Box<Candidate<'a>>, String>,
}

struct Candidate<'a> {
    subject: SceneSubject<'a>,
    stages: &'static str,
    traversal: Option<Traversal>,
    bytes_per_path: Option<u64>,
    device_bytes: u64,
    profile: Profile,
    first_picture_seconds: f64,
    runs: Vec<Timed>,
}

/// The result of one run.
struct Timed {
    seconds: f64,
    samples: f64,
    rays: f64,
    build_seconds: f64,
    compile_seconds: f64,
}

/// The device's own times of its stages.
#[derive(Default)]
struct Profile {
    stage_times: Vec<StageShare>,
    occupancy: Vec<f64>,
}

/// Measures one table: every entry is made ready, then all take turns. Scenes that do not fit the device say so in their row.
///
/// # Errors
/// Errors of devices but for a scene that does not fit, and [`BenchError::Interrupted`].
pub fn measure(
    growth: Growth,
    own: &[Scene],
    options: &SpeedOptions,
    devices: &mut Devices,
    observer: &dyn Observer,
    say: &mut dyn FnMut(&str),
) -> Result<SpeedTable, BenchError> {
    let mut entries = Vec::new();
    for Planned { scene, spp, count, stages } in plan_rows(growth, own, options, devices)? {
        let what = count.map_or_else(|| scene.name.clone(), |count| format!("{count} {}", growth.label()));
        say(&format!("{}: preparing {what}", growth.label()));
        let [width, height] = scene.film.size;
        let row = SpeedRow { scene: scene.name.clone(), count, width, height, spp, outcome: Outcome::DoesNotFit(String::new()) };
        let subject = match prepare(&scene, stages, options, devices, observer) {
            Err(BenchError::Render(RenderError::DoesNotFit(why))) => Err(why),
            outcome => Ok(Box::new(outcome?)),
        };
        entries.push(Entry { row, subject });
    }
    for round in 0..=options.rounds {
        say(&match round {
            0 => format!("{}: warming up", growth.label()),
            round => format!("{}: round {round} of {}", growth.label(), options.rounds),
        });
        take_turns(&mut entries, round > 0)?;
    }
    let rows = finish(entries);
    Ok(SpeedTable { growth, rows })
}

/// The renders of a row.
struct Planned {
    scene: Scene,
    spp: u32,
    count: Option<u64>,
    stages: Option<StageMode>,
}

/// The rows of a table. Scenes as they are get one for each way of running the stages, where there are two and none was asked for.
fn plan_rows(growth: Growth, own: &[Scene], options: &SpeedOptions, devices: &mut Devices) -> Result<Vec<Planned>, BenchError> {
    let both = [Some(StageMode::Fused), Some(StageMode::Wavefront)];
    let one = [options.stages];
    let on_a_gpu = devices.get(&options.device)?.is_some();
    let ways = if options.stages.is_none() && on_a_gpu { &both[..] } else { &one[..] };
    let mut rows = Vec::new();
    if growth == Growth::Scenes {
        for scene in own {
            let mut scene = scene.clone();
            scene.film.size = options.size;
            options.limit_depth(&mut scene);
            rows.extend(ways.iter().map(|stages| Planned {
                scene: scene.clone(),
                spp: options.spp,
                count: None,
                stages: *stages,
            }));
        }
    } else if let Some(first) = own.first() {
        for size in growth.sizes(options.everything) {
            let (scene, spp) = options.grown(growth, size, first)?;
            let count = if growth == Growth::Resolution { u64::from(size) * u64::from(size) } else { u64::from(size) };
            rows.push(Planned { scene, spp, count: Some(count), stages: options.stages });
        }
    }
    Ok(rows)
}

/// One run of each.
fn take_turns(entries: &mut [Entry<'_>], counts: bool) -> Result<(), BenchError> {
    for entry in entries {
        let spp = entry.row.spp;
        let Ok(candidate) = &mut entry.subject else { continue };
        let run = candidate.subject.render(1, spp)?;
        if counts {
            candidate.runs.push(Timed {
                seconds: run.seconds,
                samples: run.samples as f64,
                rays: run.rays as f64,
                build_seconds: run.build_seconds,
                compile_seconds: run.compile_seconds,
            });
        }
    }
    Ok(())
}

fn prepare<'a>(
    scene: &Scene,
    stages: Option<StageMode>,
    options: &SpeedOptions,
    devices: &mut Devices,
    observer: &'a dyn Observer,
) -> Result<Candidate<'a>, BenchError> {
    // Opening a device is not the scene's cost.
    let device = devices.get(&options.device)?;
    let start = Instant::now();
    let Some(device) = device else {
        let mut renderer = ReferenceRenderer::new(scene)?;
        first_picture(&mut renderer, scene, observer)?;
        return Ok(Candidate {
            first_picture_seconds: start.elapsed().as_secs_f64(),
            subject: SceneSubject { renderer: Box::new(renderer), size: scene.film.size, observer },
            stages: "cpu",
            traversal: None,
            bytes_per_path: None,
            device_bytes: 0,
            profile: Profile::default(),
            runs: Vec::new(),
        });
    };
    let plan = PlanOptions { stages, ..options.plan.clone() };
    let mut renderer = GpuRenderer::on(&device, scene, &plan)?;
    first_picture(&mut renderer, scene, observer)?;
    let first_picture_seconds = start.elapsed().as_secs_f64();
    let wavefront = renderer.plan().stages == StageMode::Wavefront;
    let shadow_rays = if renderer.plan().samples_lights() { renderer.plan().shadow_ray_bytes() } else { 0 };
    Ok(Candidate {
        first_picture_seconds,
        stages: if wavefront { "wavefront" } else { "fused" },
        traversal: renderer.plan().traversal_in_use(),
        bytes_per_path: wavefront.then_some(renderer.plan().path_state_bytes() + memory::QUEUE_BYTES + shadow_rays),
        device_bytes: renderer.plan().memory.total(),
        profile: look_inside(&renderer, options.rounds)?,
        subject: SceneSubject { renderer: Box::new(renderer), size: scene.film.size, observer },
        runs: Vec::new(),
    })
}

/// One sample of every pixel.
fn first_picture(renderer: &mut dyn Renderer, scene: &Scene, observer: &dyn Observer) -> Result<(), BenchError> {
    let request = RenderRequest { rows: 0..scene.film.size[1], samples: 0..1 };
    let report = renderer.render(&request, observer, &mut |_| Ok(()))?;
    if report.interrupted { Err(BenchError::Interrupted) } else { Ok(()) }
}

/// Asks the device for the times of its stages, so many times after one that is thrown away.
fn look_inside(renderer: &GpuRenderer, rounds: u32) -> Result<Profile, BenchError> {
    let mut profiles = Vec::new();
    for round in 0..=rounds {
        let Some(profile) = renderer.profile()? else { return Ok(Profile::default()) };
        if round > 0 {
            profiles.push(profile);
        }
    }
    let Some(first) = profiles.first() else { return Ok(Profile::default()) };
    let mut stage_times: Vec<StageShare> = first
        .stages
        .iter()
        .enumerate()
        .map(|(index, stage)| {
            let seconds: Vec<f64> = profiles.iter().map(|profile| profile.stages[index].seconds).collect();
            StageShare { stage: stage.stage.to_owned(), seconds: Spread::of(&seconds), share: 0.0, dispatches: stage.dispatches }
        })
        .collect();
    let all: f64 = stage_times.iter().map(|stage| stage.seconds.median).sum();
    for stage in &mut stage_times {
        stage.share = stage.seconds.median / all;
    }
    let occupancy = first.alive.iter().map(|alive| f64::from(*alive) / f64::from(first.capacity)).collect();
    Ok(Profile { stage_times, occupancy })
}

/// Rows of what was seen; ratios are taken, run by run, against the first row that was measured: of the same scene, where nothing grows.
fn finish(entries: Vec<Entry<'_>>) -> Vec<SpeedRow> {
    let per_sample =
        |candidate: &Candidate<'_>| -> Vec<f64> { candidate.runs.iter().map(|run| run.seconds / run.samples).collect() };
    let mut first: Option<(String, Vec<f64>)> = None;
    let mut rows = Vec::new();
    for Entry { mut row, subject } in entries {
        row.outcome = match subject {
            Err(why) => Outcome::DoesNotFit(why),
            Ok(candidate) => {
                let own = per_sample(&candidate);
                let group = if row.count.is_none() { row.scene.clone() } else { String::new() };
                let ratio = match &first {
                    Some((of, baseline)) if *of == group => Some(Ratio::of_pairs(own.into_iter().zip(baseline.iter().copied()))),
                    _ => {
                        first = Some((group, own));
                        None
                    }
                };
                Outcome::Measured(Box::new(candidate.finish(ratio)))
            }
        };
        rows.push(row);
    }
    rows
}

impl Candidate<'_> {
    fn finish(self, time_per_sample: Option<Ratio>) -> Speed {
        let spread = |of: &dyn Fn(&Timed) -> f64| Spread::of(&self.runs.iter().map(of).collect::<Vec<_>>());
        let last = self.runs.last();
        Speed {
            device: self.subject.renderer.device().to_owned(),
            stages: self.stages.to_owned(),
            hierarchy: self.traversal.map(|traversal| traversal.key().to_owned()),
            build_seconds: last.map_or(f64::NAN, |run| run.build_seconds),
            compile_seconds: last.map_or(f64::NAN, |run| run.compile_seconds),
            first_picture_seconds: self.first_picture_seconds,
            seconds: spread(&|run| run.seconds),
            samples_per_second: spread(&|run| run.samples / run.seconds),
            rays_per_second: spread(&|run| run.rays / run.seconds),
            rays_per_sample: last.map_or(f64::NAN, |run| run.rays / run.samples),
            time_per_sample,
            bytes_per_path: self.bytes_per_path,
            device_bytes: self.device_bytes,
            stage_times: self.profile.stage_times,
            occupancy: self.profile.occupancy,
        }
    }
}
