//! The picture at each doubling of the pixels' samples.

use super::allocation::MOST_DOUBLINGS;
use crate::film::Band;
use crate::math::luminance_f32;

/// Mean luminances per pixel: of samples [0, n/2), [n/2, n), [n, 2n), [2n, 4n), up to as many doublings of n as there may be. Of a doubling
/// that a pixel has not had, 0.
pub struct Doublings {
    width: usize,
    means: Vec<Vec<f32>>,
}

impl Doublings {
    pub fn new([width, height]: [u32; 2]) -> Self {
        let pixels = width as usize * height as usize;
        Self { width: width as usize, means: vec![vec![0.0; pixels]; usize::from(MOST_DOUBLINGS) + 2] }
    }

    /// Makes [`Doublings::new`] with the means of an earlier render; None where they are of another size.
    pub fn with_means([width, height]: [u32; 2], means: Vec<Vec<f32>>) -> Option<Self> {
        let pixels = width as usize * height as usize;
        let fits = means.len() == usize::from(MOST_DOUBLINGS) + 2 && means.iter().all(|means| means.len() == pixels);
        fits.then_some(Self { width: width as usize, means })
    }

    /// The mean luminances of each interval.
    pub fn means(&self) -> &[Vec<f32>] {
        &self.means
    }

    /// Means of the two halves of the first n samples.
    pub fn halves(&self) -> [&[f32]; 2] {
        [&self.means[0], &self.means[1]]
    }

    /// Adds a band's part of the interval number `interval`: `share` of its samples. Pixels that took no part are 0 in the band.
    pub fn add(&mut self, interval: usize, band: &Band, share: f32) {
        let first = band.first_row as usize * self.width;
        for (sum, mean) in self.means[interval][first..].iter_mut().zip(&band.mean) {
            *sum += share * luminance_f32(*mean);
        }
    }

    /// n becomes 2n.
    pub fn double(&mut self) {
        let second = self.means.remove(1);
        self.means[0].iter_mut().zip(&second).for_each(|(first, second)| *first = 0.5 * (*first + second));
        let mut last = second;
        last.fill(0.0);
        self.means.push(last);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn band(value: f32) -> Band {
        Band { first_row: 1, width: 1, rows: 1, samples: 1, mean: vec![[value; 3]], ..Band::default() }
    }

    #[test]
    fn doubling_makes_one_half_of_two() {
        let mut doublings = Doublings::new([1, 2]);
        doublings.add(0, &band(1.0), 1.0);
        doublings.add(1, &band(3.0), 0.5);
        doublings.add(1, &band(5.0), 0.5);
        doublings.add(2, &band(7.0), 1.0);
        let close = |doublings: &Doublings, wanted: [f32; 2]| {
            doublings.halves().iter().zip(wanted).all(|(half, wanted)| half[0] == 0.0 && (half[1] - wanted).abs() < 1e-5)
        };
        assert!(close(&doublings, [1.0, 4.0]));
        doublings.double();
        assert!(close(&doublings, [2.5, 7.0]));
        doublings.double();
        assert!(close(&doublings, [4.75, 0.0]));
    }
}
