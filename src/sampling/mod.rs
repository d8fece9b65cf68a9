//! Randomness as a pure function of (seed, pixel, sample index, named dimension), the same bits on every device.
//!
//! Every random number starts as 32 bits, a fixed-point fraction of [0, 1). Both devices use its upper 24 bits, so that the f32
//! and the f64 number are the same number. `shaders/core/sampler.wgsl` is the device's half of this module.
//!
//! A sampler is a sequence of points that all pixels share, and a hash by which each pixel moves it ([`sequence::Decorrelation`]). So a
//! point is worked out once per sample on the host, in integers, and a device adds or combines two words to get its number; samplers
//! differ in their quality and not in what they cost. Dimensions beyond the sequence's last come from the hashed generator.

pub mod alias;
pub mod cell_grid;
pub mod choice;
pub mod dimension;
pub mod environment;
pub mod filter;
pub mod guide;
pub mod halton;
pub mod hammersley;
pub mod hash;
pub mod hierarchical_warp;
pub mod lcg;
pub mod light_cells;
pub mod light_list;
pub mod light_sampler;
pub mod light_strategy;
pub mod light_tree;
pub mod mis;
pub mod permutation;
pub mod roulette;
pub mod sampler;
pub mod sequence;
pub mod sobol;
pub mod solid_angle;
pub mod strata;

pub use alias::AliasTable;
pub use dimension::{CameraDimension, Dimension, MediumDimension, VertexDimension};
pub use environment::MapDistribution;
pub use guide::Guide;
pub use hierarchical_warp::{HierarchicalWarp, WarpSample};
pub use light_cells::{LightCells, LightSampleContext};
pub use light_sampler::{LightGroup, LightSampler};
pub use light_tree::LightTree;
pub use sampler::PathSampler;
pub use sequence::{Decorrelation, Sampling, SequencePoint};
