//! In builds without the feature `ray-query`: no acceleration structure is ever built.

use super::device::Device;
use crate::packed::PackedScene;

/// A structure that there is none of.
pub enum Acceleration {}

impl Acceleration {
    /// None: plans have no ray queries.
    pub fn build(_: &Device, _: &PackedScene) -> Option<Self> {
        None
    }

    /// Bytes on the device.
    pub fn bytes(&self) -> u64 {
        match *self {}
    }

    /// The resource of a bind group.
    pub fn as_binding(&self) -> wgpu::BindingResource<'_> {
        match *self {}
    }
}
