//! Helpers that test programs share.
#![allow(dead_code, reason = "each program uses some of it")]

pub mod device;
pub mod effort;
pub mod files;
pub mod light_groups;
pub mod media;
pub mod picture;
pub mod pixel_bits;
pub mod projections;
pub mod ray_queries;
pub mod scenes;
pub mod sphere;
pub mod translucent_surfaces;
