//! `--traversal`: how rays find what they meet on a graphics device.

use clap::{Args, ValueEnum};
use gpt::packed::hierarchy::HierarchyKind;
use gpt::plan::{GeometryPlacement, PlanOptions};
use gpt::renderer::DeviceChoice;

use super::exit::Failure;

/// A way, as it is typed.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub enum TraversalName {
    /// As the plan decides: few primitives are tested one by one, others stand in a hierarchy of ours; never ray queries
    #[default]
    Auto,
    /// A hierarchy of ours, however few the primitives
    Bvh,
    /// The device's own hierarchy, by its ray queries; what the device lacks, and what moves, is refused
    RayQuery,
}

#[derive(Debug, Default, Args)]
pub struct TraversalArguments {
    /// How rays find what they meet on a graphics device
    #[arg(long, value_name = "WAY", default_value = "auto")]
    traversal: TraversalName,
}

impl TraversalArguments {
    /// What a plan has to be told.
    pub fn options(&self) -> PlanOptions {
        let (geometry, hierarchy) = match self.traversal {
            TraversalName::Auto => (None, None),
            TraversalName::Bvh => (Some(GeometryPlacement::Hierarchy), None),
            TraversalName::RayQuery => (Some(GeometryPlacement::Hierarchy), Some(HierarchyKind::RayQuery)),
        };
        PlanOptions { geometry, hierarchy, ..PlanOptions::default() }
    }

    /// As [`TraversalArguments::options`], for a command that may be told to go without a graphics device.
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
