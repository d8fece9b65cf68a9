//! Functions that rise, and their inverse.

/// A function of a distance that rises from 0 at 0 up to some distance. Beyond it, a lens would show again what it shows further inside: there is
/// nothing to see.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Rising {
    /// Up to where it rises.
    pub end: f64,
    /// Its value there, the largest.
    pub most: f64,
}

/// Steps of the search at most: halving alone takes as many to the last bit.
const STEPS: usize = 200;

impl Rising {
    /// The distance at which the function has a value; None where it has it nowhere. By Newton's method between two distances
    /// that enclose the place, which are halved where a step leads out of them. `function` gives value and slope.
    pub fn inverse(&self, value: f64, function: impl Fn(f64) -> (f64, f64)) -> Option<f64> {
        // A place that is not a number is not seen either.
        if value.is_nan() || value > self.most {
            return None;
        }
        let (mut low, mut high) = (0.0, self.end);
        let mut at = value.min(self.end);
        for _ in 0..STEPS {
            let (found, slope) = function(at);
            if found > value {
                high = at;
            } else {
                low = at;
            }
            let mut next = at - (found - value) / slope;
            if !(next >= low && next <= high) {
                next = 0.5 * (low + high);
            }
            if (next - at).abs() <= f64::EPSILON * next {
                return Some(next);
            }
            at = next;
        }
        Some(at)
    }
}
