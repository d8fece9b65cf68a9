//! The truth of a test: a formula, or a picture that is shipped.

use rayon::prelude::*;

use super::formulas::gauss_legendre;
use super::picture::TruthPicture;
use super::shipped;

/// How the truth is known.
pub enum Truth {
    /// By a formula.
    Formula(Formula),
    /// By long renders of the reference and of the device, which agree; their mean and its error are shipped.
    Shipped,
}

/// A function over the film.
pub struct Formula {
    value: Box<dyn Fn(f64, f64) -> [f64; 3] + Send + Sync>,
    pub shape: FormulaShape,
}

/// How a function behaves within a pixel, by which its mean is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FormulaShape {
    /// Derivatives exist.
    Smooth,
    /// Its derivatives jump.
    Kinks,
    /// The function itself jumps.
    Edges,
}

/// Nodes of Gauss and Legendre along the side of a pixel.
const NODES: usize = 4;
/// Cells along the side of a pixel with kinks.
const CELLS: usize = 16;
/// Cells along the side of a pixel that an edge crosses.
const FINE_CELLS: usize = 128;
/// A pixel whose values differ by more than this share of the largest has an edge.
const JUMP: f64 = 0.1;

impl Formula {
    /// A function with derivatives.
    pub fn smooth(value: impl Fn(f64, f64) -> [f64; 3] + Send + Sync + 'static) -> Self {
        Self { value: Box::new(value), shape: FormulaShape::Smooth }
    }

    /// Its mean over each pixel of a picture of this size.
    pub fn picture(&self, [width, height]: [u32; 2]) -> TruthPicture {
        let rules = Rules { gauss: gauss_legendre(NODES), cells: cells(CELLS), fine: cells(FINE_CELLS) };
        let pixel = |index: u32| {
            let corner = [f64::from(index % width), f64::from(index / width)];
            let value = |x: f64, y: f64| (self.value)((corner[0] + x) / f64::from(width), (corner[1] + y) / f64::from(height));
            let mean = match self.shape {
                FormulaShape::Smooth => rules.mean(&rules.gauss, &value),
                FormulaShape::Kinks => rules.mean(&rules.cells, &value),
                FormulaShape::Edges if rules.jumps(&value) => rules.mean(&rules.fine, &value),
                FormulaShape::Edges => rules.mean(&rules.gauss, &value),
            };
            mean.map(|channel| channel as f32)
        };
        let mean: Vec<_> = (0..width * height).into_par_iter().map(pixel).collect();
        let standard_errors = vec![[0.0; 3]; mean.len()];
        TruthPicture { width, height, mean, standard_errors }
    }
}

/// Nodes and weights along the side of a pixel.
type Rule = Vec<(f64, f64)>;

fn cells(count: usize) -> Rule {
    (0..count).map(|cell| ((cell as f64 + 0.5) / count as f64, 1.0 / count as f64)).collect()
}

struct Rules {
    gauss: Rule,
    cells: Rule,
    fine: Rule,
}

impl Rules {
    fn mean(&self, rule: &Rule, value: &impl Fn(f64, f64) -> [f64; 3]) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for &(x, weight_x) in rule {
            for &(y, weight_y) in rule {
                let value = value(x, y);
                for channel in 0..3 {
                    sum[channel] += weight_x * weight_y * value[channel];
                }
            }
        }
        sum
    }

    /// True if the function differs much within a pixel: at the middles of cells, at corners and along the sides.
    fn jumps(&self, value: &impl Fn(f64, f64) -> [f64; 3]) -> bool {
        let (mut least, mut most) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        let ends = [1e-6, 1.0 - 1e-6];
        let places = || self.cells.iter().map(|&(place, _)| place).chain(ends);
        for x in places() {
            for y in places() {
                let value = value(x, y);
                for channel in 0..3 {
                    least[channel] = least[channel].min(value[channel]);
                    most[channel] = most[channel].max(value[channel]);
                }
            }
        }
        (0..3).any(|channel| most[channel] - least[channel] > JUMP * most[channel].abs().max(least[channel].abs()))
    }
}

impl Truth {
    /// The true picture of the test with this name, in strokes for files, and this size.
    ///
    /// # Errors
    /// A sentence: the shipped picture is missing or damaged.
    pub fn picture(&self, file_name: &str, size: [u32; 2]) -> Result<TruthPicture, String> {
        match self {
            Self::Formula(formula) => Ok(formula.picture(size)),
            Self::Shipped => shipped::picture(file_name, size),
        }
    }
}
