//! `--traversal`: how rays find what they meet on a graphics device.

use clap::{Args, ValueEnum};
use gpt::plan::{PlanOptions, TraversalChoice};
use gpt::renderer::DeviceChoice;

use super::exit::Failure;
use super::verified_drivers;

/// A way, as it is typed.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub enum TraversalName {
    /// Few primitives are tested one by one, others stand in a bounding volume hierarchy; on hardware on which `gpt verify --traversal ray-query` passed,
    /// they are found by ray queries, unless the scene moves or has instances
    #[default]
    Auto,
    /// A bounding volume hierarchy, however few the primitives
    Bvh,
    /// The device's own acceleration structure, by ray queries, in programs built with the cargo feature `ray-query`; refused where the device has none or the
    /// scene moves
    RayQuery,
}

#[derive(Debug, Default, Args)]
pub struct TraversalArguments {
    /// How rays find what they meet on a graphics device
    #[arg(long, value_name = "WAY", default_value = "auto")]
    traversal: TraversalName,
}

impl TraversalArguments {
    /// The options that a plan is given.
    pub fn options(&self) -> PlanOptions {
        let traversal = match self.traversal {
            TraversalName::Auto => TraversalChoice::Auto,
            TraversalName::Bvh => TraversalChoice::Bvh,
            TraversalName::RayQuery => TraversalChoice::RayQuery,
        };
        PlanOptions { traversal, verified: verified_drivers::known(), ..PlanOptions::default() }
    }

    /// Does the work of [`TraversalArguments::options`] for a command that may run without a graphics device.
    ///
    /// # Errors
    /// A usage error where it is, and a way is asked for.
    pub fn options_on(&self, device: &DeviceChoice) -> Result<PlanOptions, Failure> {
        if *device == DeviceChoice::Cpu && self.traversal != TraversalName::Auto {
            return Err(Failure::Usage {
                message: "the CPU reference has one way to find what rays meet".to_owned(),
                help: Some("leave out --traversal, or choose a graphics device; `gpt devices` lists them".to_owned()),
            });
        }
        Ok(self.options())
    }
}
