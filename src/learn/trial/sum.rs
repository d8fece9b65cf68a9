//! Values that are added up over paths.

/// A vector, in the sense of mathematics.
pub trait Sum: Copy + Default + Send {
    /// Both together.
    fn and(self, other: Self) -> Self;
    /// So much of it.
    fn times(self, factor: f64) -> Self;
}

/// Nothing is asked.
impl Sum for () {
    fn and(self, (): Self) -> Self {}
    fn times(self, _: f64) -> Self {}
}

/// Numbers of rays of paths and of shadow rays.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Rays {
    pub path: f64,
    pub shadow: f64,
}

impl Rays {
    pub const PATH: Self = Self { path: 1.0, shadow: 0.0 };
    pub const SHADOW: Self = Self { path: 0.0, shadow: 1.0 };
}

impl Sum for Rays {
    fn and(self, other: Self) -> Self {
        Self { path: self.path + other.path, shadow: self.shadow + other.shadow }
    }

    fn times(self, factor: f64) -> Self {
        Self { path: self.path * factor, shadow: self.shadow * factor }
    }
}
