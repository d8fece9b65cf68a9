//! Counted rays.

/// Numbers of rays of paths and of shadow rays.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Rays {
    pub path: f64,
    pub shadow: f64,
}

impl Rays {
    pub const PATH: Self = Self { path: 1.0, shadow: 0.0 };
    pub const SHADOW: Self = Self { path: 0.0, shadow: 1.0 };

    pub fn times(self, factor: f64) -> Self {
        Self { path: self.path * factor, shadow: self.shadow * factor }
    }

    pub fn and(self, other: Self) -> Self {
        Self { path: self.path + other.path, shadow: self.shadow + other.shadow }
    }
}
