//! Drivers whose ray queries were verified.

use std::collections::BTreeSet;
use std::sync::Arc;

/// Devices, each with the driver that ran it, on which `gpt verify --traversal ray-query` passed. There, plans use ray queries unasked.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct VerifiedDrivers(Arc<BTreeSet<String>>);

impl VerifiedDrivers {
    /// Devices by the names that [`crate::gpu::driver_identity`] gives.
    pub fn new(identities: impl IntoIterator<Item = String>) -> Self {
        Self(Arc::new(identities.into_iter().collect()))
    }

    /// Says that the device was verified with its driver.
    pub fn contains(&self, identity: &str) -> bool {
        self.0.contains(identity)
    }

    /// Says that no driver was verified.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}
