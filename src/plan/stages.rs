//! The pipeline: which kernels run after which, over how much, and what state each reads and writes.
//!
//! Besides, every stage reads the scene's arrays and the parameters of its pass and vertex.

use super::bindings::Binding::{self, *};
use super::choices::StageMode;
use super::model::Plan;
use super::path_state::{CONNECT_SIZE, EXTEND_SIZE, SHADE_SIZE};

/// When a stage runs within a pass.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum When {
    PassStart,
    /// Once for each vertex of the pass's paths, one after the other.
    EachVertex,
    PassEnd,
}

/// The items over which a stage is dispatched, one invocation each; a workgroup has
/// [`super::path_state::WORKGROUP`] of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Over {
    /// The paths that a pass begins with.
    Paths,
    /// The pixels of a pass.
    Pixels,
    /// The pixels of a pass; where [invocations take them](Plan::pixel_takers), a workgroup for each thread of the
    /// device.
    PixelsThatAreTaken,
    /// Nothing: one workgroup of one invocation.
    Once,
    /// Entries of a queue. The device knows how many there are, and wrote the number of workgroups at this
    /// word of the dispatch sizes. The first vertex's queues hold all paths of the pass.
    Queue { size: u32, rays: bool },
}

/// A row of the table.
#[derive(Debug, Clone, Copy)]
pub struct Stage {
    pub mode: StageMode,
    /// Within `shaders/`.
    pub file: &'static str,
    /// The entry point, which is the stage's name.
    pub entry: &'static str,
    pub when: When,
    pub over: Over,
    /// State that it reads.
    pub reads: &'static [Binding],
    /// State that it writes.
    pub writes: &'static [Binding],
    /// True for the plans, among those of its mode, that have the stage.
    needed: fn(&Plan) -> bool,
}

const PATHS_ALIVE: Over = Over::Queue { size: SHADE_SIZE, rays: false };
const RAYS_OF_PATHS: Over = Over::Queue { size: EXTEND_SIZE, rays: true };
const PATHS_WITH_SHADOW_RAYS: Over = Over::Queue { size: CONNECT_SIZE, rays: true };
const FILM: &[Binding] = &[FilmSum, FilmCompensation];
const FILM_AND_COUNTS: &[Binding] = &[FilmSum, FilmCompensation, Statistics];

macro_rules! stages {
    ($($mode:ident $file:literal $entry:literal $when:ident $over:expr, reads $reads:expr, writes $writes:expr, if $needed:expr;)*) => {
        /// The table, in the order in which stages run.
        pub const STAGES: &[Stage] = &[$(Stage {
            mode: StageMode::$mode,
            file: $file,
            entry: $entry,
            when: When::$when,
            over: $over,
            reads: $reads,
            writes: $writes,
            needed: $needed,
        }),*];
    };
}

stages! {
    Wavefront "stages/generate.wgsl" "generate" PassStart Over::Paths,
        reads &[], writes &[PathState, Queues], if |_| true;
    Wavefront "stages/extend.wgsl" "extend" EachVertex RAYS_OF_PATHS,
        reads &[Counts, Queues, PathState], writes &[PathState], if |_| true;
    Wavefront "stages/shade.wgsl" "shade" EachVertex PATHS_ALIVE,
        reads &[Counts, Queues, PathState], writes &[PathState, Queues, Counts, ShadowRays], if |_| true;
    Wavefront "stages/prepare.wgsl" "prepare" EachVertex Over::Once,
        reads &[Counts], writes &[Counts, DispatchSizes, Statistics], if |_| true;
    Wavefront "stages/connect.wgsl" "connect" EachVertex PATHS_WITH_SHADOW_RAYS,
        reads &[Counts, ShadowRays, PathState], writes &[PathState], if Plan::samples_lights;
    Wavefront "stages/accumulate.wgsl" "accumulate" PassEnd Over::Pixels,
        reads &[PathState, FilmSum, FilmCompensation], writes FILM_AND_COUNTS, if |_| true;

    Fused "stages/fused.wgsl" "trace_paths" PassStart Over::PixelsThatAreTaken,
        reads FILM, writes FILM_AND_COUNTS, if |plan| plan.lanes.is_none();
    Fused "stages/fused_lanes.wgsl" "trace_paths" PassStart Over::PixelsThatAreTaken,
        reads FILM, writes FILM_AND_COUNTS, if |plan| plan.lanes.is_some();
}

impl Plan {
    /// The stages that run, in order.
    pub fn pipeline(&self) -> impl Iterator<Item = &'static Stage> {
        STAGES.iter().filter(|stage| stage.mode == self.stages && (stage.needed)(self))
    }
}
