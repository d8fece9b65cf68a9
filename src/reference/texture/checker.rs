//! The checkerboard.

use glam::DVec2;

/// Whether uv lies in a field of the first colour: floor(u·scale.x) + floor(v·scale.y) is even.
pub fn is_first(uv: DVec2, scale: [f64; 2]) -> bool {
    let field = (uv * DVec2::from(scale)).floor();
    // Far out the conversion saturates; NaN becomes 0.
    (field.x as i64).wrapping_add(field.y as i64) & 1 == 0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_alternate_across_zero_too() {
        let row = |v: f64| (-2..3).map(|i| is_first(DVec2::new(f64::from(i) + 0.5, v), [1.0, 1.0])).collect::<Vec<_>>();
        assert_eq!(row(0.5), [true, false, true, false, true]);
        assert_eq!(row(-0.5), [false, true, false, true, false]);
        assert!(!is_first(DVec2::new(0.3, 0.3), [4.0, 2.0]));
    }
}
