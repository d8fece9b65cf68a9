//! Tests that need no graphics device: files and their errors, packing, plans, shader texts, samplers, and
//! pictures by the reference.

#[path = "../common/mod.rs"]
mod common;
#[path = "../statistics/mod.rs"]
mod statistics;

mod architecture;
mod bad_lights;
mod bad_materials;
mod bad_scenes;
mod blends;
mod builtin_scenes;
mod cameras;
mod daylight;
mod deformations;
mod flip;
mod hierarchy;
mod imports;
mod instances;
mod learn;
mod light_groups;
mod light_links;
mod light_strategies;
mod many_parts;
mod media;
mod models;
mod picture_files;
mod picture_test;
mod plan;
mod profiles;
mod referee;
mod samplers;
mod scene_files;
mod schema_agreement;
mod shader_imports;
mod shaders;
