//! The oracles of participating media (`tests/common/media`), each held against something independent of it.

mod airlight;
mod grid;
mod half_space;
mod phase;
mod slab;
mod transmittance;
