//! Pictures of participating media against numbers that owe nothing to the renderer (`tests/common/media`), on every device and by every estimator
//! that can see the light.
//!
//! All pixels of a scene here have the same expectation, and are independent replications, as in `tests/gpu/closed_forms`: Student's t-test judges
//! their mean, at a level that is shared out over the family (Šidák). Every case states what it must be told from, which is 2 % of albedo in most,
//! and fails too where the same test does not.

mod airlight;
mod furnaces;
mod grids;
mod half_space;
mod layers;
mod lines;
mod subsurface;
mod text;
mod truth;
