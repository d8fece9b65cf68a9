//! The device against the reference, against closed forms, and against itself. `GPT_TEST_GPU=skip` leaves out what needs a device; what both
//! devices must satisfy is then tested on the CPU alone.

#[path = "../common/mod.rs"]
mod common;
#[path = "../statistics/mod.rs"]
mod statistics;

mod agreement;
mod cameras;
mod checkpoints;
mod chunks;
mod clamp;
mod closed_forms;
mod estimators;
mod film;
mod guiding;
mod layers;
mod media;
mod motion;
mod object_layers;
mod opacity;
mod progressive;
mod ray_queries;
mod strategies;
mod variants;
mod verify;
