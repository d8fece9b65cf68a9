//! Drivers whose ray queries were verified.

use std::collections::BTreeSet;
use std::sync::Arc;

/// Devices, each with the driver that ran it, on which `gpt verify --traversal ray-query` passed. There, plans use ray queries unasked.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct VerifiedDrivers(Arc<BTreeSet<String>>);

impl VerifiedDrivers {
    /// Named as [`driver_identity`] does.
    pub fn new(identities: impl IntoIterator<Item = String>) -> Self {
        Self(Arc::new(identities.into_iter().collect()))
    }

    /// Whether the device was verified with its driver.
    pub fn contains(&self, identity: &str) -> bool {
        self.0.contains(identity)
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

/// A device with the interface and the version of the driver, as one text.
pub fn driver_identity(info: &wgpu::AdapterInfo) -> String {
    let driver = [&*info.driver, &*info.driver_info].join(" ");
    format!("{}, {:?}, {}", info.name, info.backend, driver.trim())
}
