//! ꟻLIP: how different two pictures look to a person who switches between them.
//!
//! Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström and Fairchild 2020, "ꟻLIP: A Difference Evaluator for Alternating Images", and for
//! pictures of high dynamic range Andersson, Nilsson, Shirley and Akenine-Möller 2021, "Visualizing Errors in Rendered High Dynamic Range
//! Images". Equations and constants are those of the papers; 0 is no visible difference, 1 the largest.

mod colour;
mod exposure;
mod filter;

use crate::compare::metrics::SizeMismatch;
use crate::output::Image;

use colour::{Lab, hunt_adjusted, hyab, lab_of_linear, linear_of_opponent, opponent_of_linear};
use exposure::{exposures, tone_mapped};
use filter::{Detectors, Sensitivity};

/// Pixels per degree of the papers' viewer: 0.7 m from a display of 0.7 m and 3840 pixels across.
pub const PIXELS_PER_DEGREE: f64 = 3840.0 * std::f64::consts::PI / 180.0;

/// Exponent of the colour difference, q_c.
const COLOUR_EXPONENT: f64 = 0.7;
/// Exponent of the feature difference, q_f.
const FEATURE_EXPONENT: f64 = 0.5;
/// Colour differences are compressed from here: share p_c of the largest is brought to p_t.
const COMPRESSED_FROM: f64 = 0.4;
const COMPRESSED_TO: f64 = 0.95;

/// The difference of each pixel, and their mean.
#[derive(Debug, Clone, PartialEq)]
pub struct FlipMap {
    pub width: u32,
    pub height: u32,
    /// Row by row from the top, 0 to 1.
    pub values: Vec<f32>,
}

impl FlipMap {
    /// Mean over all pixels; 0 of a picture without any.
    pub fn mean(&self) -> f64 {
        let sum: f64 = self.values.iter().map(|value| f64::from(*value)).sum();
        sum / (self.values.len() as f64).max(1.0)
    }
}

/// ꟻLIP of pictures whose linear values from 0 to 1 are what a display shows; others are cut off.
///
/// # Errors
/// Pictures of different sizes.
pub fn flip_of_display(picture: &Image, reference: &Image, pixels_per_degree: f64) -> Result<FlipMap, SizeMismatch> {
    check_sizes(picture, reference)?;
    let eye = Eye::new(pixels_per_degree);
    Ok(eye.compare([picture, reference].map(|image| Plane::of(image, |value| f64::from(value).clamp(0.0, 1.0)))))
}

/// ꟻLIP of pictures of any brightness: the largest of each pixel over the exposures at which the reference can be looked at.
///
/// # Errors
/// Pictures of different sizes.
pub fn flip(picture: &Image, reference: &Image, pixels_per_degree: f64) -> Result<FlipMap, SizeMismatch> {
    check_sizes(picture, reference)?;
    let eye = Eye::new(pixels_per_degree);
    let mut largest = FlipMap { width: reference.width, height: reference.height, values: vec![0.0; reference.pixels.len()] };
    for stops in exposures(reference) {
        let shown = [picture, reference].map(|image| Plane::of(image, |value| tone_mapped(f64::from(value) * stops.exp2())));
        let map = eye.compare(shown);
        for (most, value) in largest.values.iter_mut().zip(map.values) {
            *most = most.max(value);
        }
    }
    Ok(largest)
}

fn check_sizes(picture: &Image, reference: &Image) -> Result<(), SizeMismatch> {
    let sizes = [[picture.width, picture.height], [reference.width, reference.height]];
    if sizes[0] == sizes[1] { Ok(()) } else { Err(SizeMismatch { sizes }) }
}

/// Three numbers a pixel.
struct Plane {
    width: usize,
    height: usize,
    pixels: Vec<[f64; 3]>,
}

impl Plane {
    /// A picture in opponent colours, its values shown by `show`. What is not a number is black.
    fn of(image: &Image, show: impl Fn(f32) -> f64) -> Self {
        let shown = |value: f32| if value.is_nan() { 0.0 } else { show(value) };
        let pixels = image.pixels.iter().map(|pixel| opponent_of_linear(pixel.map(shown))).collect();
        Self { width: image.width as usize, height: image.height as usize, pixels }
    }
}

/// The viewer at a distance.
struct Eye {
    sensitivity: Sensitivity,
    detectors: Detectors,
    /// The largest colour difference that there is: between the display's green and blue.
    largest: f64,
}

impl Eye {
    fn new(pixels_per_degree: f64) -> Self {
        let [green, blue] = [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|colour| hunt_adjusted(lab_of_linear(colour)));
        let largest = hyab(green, blue).powf(COLOUR_EXPONENT);
        Self { sensitivity: Sensitivity::new(pixels_per_degree), detectors: Detectors::new(pixels_per_degree), largest }
    }

    fn compare(&self, planes: [Plane; 2]) -> FlipMap {
        let [width, height] = [planes[0].width, planes[0].height];
        let colours = planes.each_ref().map(|plane| self.perceived(plane));
        let features = planes.each_ref().map(|plane| {
            let luminance: Vec<f64> = plane.pixels.iter().map(|pixel| (pixel[0] + 16.0) / 116.0).collect();
            self.detectors.respond(&luminance, width)
        });
        let value = |pixel: usize| {
            let colour = self.compressed(hyab(colours[0][pixel], colours[1][pixel]).powf(COLOUR_EXPONENT));
            let of_feature = |kind: usize| (features[0][pixel][kind] - features[1][pixel][kind]).abs();
            let feature = (of_feature(0).max(of_feature(1)) * std::f64::consts::FRAC_1_SQRT_2).powf(FEATURE_EXPONENT);
            colour.powf(1.0 - feature) as f32
        };
        FlipMap { width: width as u32, height: height as u32, values: (0..width * height).map(value).collect() }
    }

    /// The picture as the eye perceives it: without details that it cannot see, and in a space of even
    /// differences.
    fn perceived(&self, plane: &Plane) -> Vec<Lab> {
        let filtered = self.sensitivity.filter(&plane.pixels, plane.width);
        let seen = |opponent: [f64; 3]| linear_of_opponent(opponent).map(|value| value.clamp(0.0, 1.0));
        filtered.into_iter().map(|opponent| hunt_adjusted(lab_of_linear(seen(opponent)))).collect()
    }

    /// Large differences are compressed into the rest of the range.
    fn compressed(&self, difference: f64) -> f64 {
        let knee = COMPRESSED_FROM * self.largest;
        if difference < knee {
            COMPRESSED_TO / knee * difference
        } else {
            COMPRESSED_TO + (difference - knee) / (self.largest - knee) * (1.0 - COMPRESSED_TO)
        }
    }
}
