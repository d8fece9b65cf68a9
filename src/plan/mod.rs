//! The plan: resources that a scene needs of the device, and work that is skipped.
//!
//! The plan looks at a packed scene and the device's limits, and decides where geometry lives, which stages run, how many paths are in
//! flight, and which parts of the shaders are compiled at all. `gpt check --plan` prints it.

pub mod bindings;
mod build;
mod camera_models;
pub mod choices;
pub mod chunks;
pub mod counters;
mod decisions;
mod error;
mod estimator;
pub mod fault;
pub mod generated;
pub mod host;
pub mod layout;
pub mod lights;
pub mod limits;
pub mod lobes;
pub mod memory;
mod model;
mod options;
pub mod parameters;
pub mod path_state;
mod ray_query;
pub mod shapes;
pub mod stages;
pub mod switches;
pub mod thin_film;
pub mod trace_record;
mod traversal;
pub mod unroll;
mod verified_drivers;

pub use choices::{FilmStorage, GeometryPlacement, MAX_SAMPLES_PER_PASS, StageMode};
pub use chunks::Chunks;
pub use error::PlanError;
pub use fault::Fault;
pub use limits::{BUILD_HAS_RAY_QUERIES, DeviceLimits, RayQueryDefault, RayQueryLimits};
pub use memory::Memory;
pub use model::Plan;
pub use options::{PlanOptions, TraversalChoice};
pub use verified_drivers::VerifiedDrivers;
