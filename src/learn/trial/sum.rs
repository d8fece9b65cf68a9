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
