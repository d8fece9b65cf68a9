//! Scenes of pbrt, and what is wrong with them.
