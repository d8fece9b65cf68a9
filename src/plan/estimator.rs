//! Constants of the estimator that kernels share with the reference.

use crate::math;
use crate::sampling::light_tree::cluster;
use crate::sampling::{dimension, roulette, sampler};
use crate::scene::material::principled;
use crate::scene::media;
use crate::shader::shared::shared_constants;

shared_constants!(constants {
    const POINT_ERROR: f32 = math::POINT_ERROR as f32;
    const DIRECTION_ERROR: f32 = math::DIRECTION_ERROR as f32;
    const SHADOW_SHORTENING: f32 = math::SHADOW_SHORTENING as f32;
    const FIRST_MEDIUM_BLOCK: u32 = dimension::FIRST_MEDIUM_BLOCK;
    const LEAST_ASIDE: f32 = media::LEAST_ASIDE as f32;
    const FARTHEST: f32 = media::FARTHEST as f32;
    /// Surfaces that a shadow ray goes through at most where they bound media.
    const MOST_CROSSINGS: u32 = media::MOST_CROSSINGS;
    const LARGEST_NUMBER: f32 = sampler::LARGEST_NUMBER as f32;
    const CERTAIN_ROULETTE_DEPTH: u32 = roulette::CERTAIN_ROULETTE_DEPTH;
    const LARGEST_SURVIVAL: f32 = roulette::LARGEST_SURVIVAL as f32;
    const MOST_REFLECTED: f32 = principled::MOST_REFLECTED as f32;
    const LEAST_REFLECTED: f32 = principled::LEAST_REFLECTED as f32;
    const SHEEN_WEIGHT: f32 = principled::SHEEN_WEIGHT as f32;
    const COAT_REFLECTANCE: f32 = principled::COAT_REFLECTANCE as f32;
    const CLUSTER_STEP: f32 = cluster::STEP as f32;
    const LEAST_CLUSTER_SHARE: f32 = cluster::LEAST_SHARE as f32;
    const LEAST_CLUSTER_COSINE: f32 = cluster::LEAST_COSINE as f32;
});
