//! The checkerboard.

use glam::DVec2;

/// True if a place lies in a field of the first colour: floor(x) + floor(y) is even.
pub fn is_first(place: DVec2) -> bool {
    let field = place.floor();
    // Far out the conversion saturates; NaN becomes 0.
    (field.x as i64).wrapping_add(field.y as i64) & 1 == 0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_alternate_across_zero_too() {
        let row = |v: f64| (-2..3).map(|i| is_first(DVec2::new(f64::from(i) + 0.5, v))).collect::<Vec<_>>();
        assert_eq!(row(0.5), [true, false, true, false, true]);
        assert_eq!(row(-0.5), [false, true, false, true, false]);
        assert!(!is_first(DVec2::new(1.2, 0.6)));
    }
}
