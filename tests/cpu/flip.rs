//! ꟻLIP, held against `flip-evaluator` 1.7 of PyPI, by the first authors of the paper: means, and values at four pixels, of pictures that are
//! made of small integers, so that both compute the same ones.

use gpt::compare::flip::{FlipMap, PIXELS_PER_DEGREE, flip, flip_of_display};
use gpt::output::Image;

const WIDTH: u32 = 24;
const HEIGHT: u32 = 16;

fn image(value: impl Fn(u32, u32) -> [f32; 3]) -> Image {
    let pixels = (0..WIDTH * HEIGHT).map(|pixel| value(pixel % WIDTH, pixel / WIDTH)).collect();
    Image { width: WIDTH, height: HEIGHT, pixels }
}

fn pattern(shift: u32) -> Image {
    image(|x, y| {
        [
            ((x * 7 + y * 3 + shift * 5) % 16) as f32 / 15.0,
            ((x * 2 + y * 5 + shift * 11) % 13) as f32 / 12.0,
            ((x * x + y * shift) % 9) as f32 / 8.0,
        ]
    })
}

fn flat(colour: [f32; 3]) -> Image {
    image(|_, _| colour)
}

fn changed(image: &Image, change: impl Fn([f32; 3]) -> [f32; 3], part: impl Fn(u32, u32) -> bool) -> Image {
    let mut changed = image.clone();
    for (index, pixel) in changed.pixels.iter_mut().enumerate() {
        if part(index as u32 % WIDTH, index as u32 / WIDTH) {
            *pixel = change(*pixel);
        }
    }
    changed
}

fn patch(x: u32, y: u32) -> bool {
    (8..12).contains(&x) && (5..9).contains(&y)
}

/// The mean and the values at (0, 0), (5, 3), the middle and the last pixel.
fn holds(name: &str, map: &FlipMap, mean: f64, places: [f32; 4]) {
    assert!((map.mean() - mean).abs() < 1e-3, "{name}: mean {} instead of {mean}", map.mean());
    let at = |x: u32, y: u32| map.values[(y * WIDTH + x) as usize];
    let found = [at(0, 0), at(5, 3), at(WIDTH / 2, HEIGHT / 2), at(WIDTH - 1, HEIGHT - 1)];
    let near = found.iter().zip(places).all(|(a, b)| (a - b).abs() < 1e-3);
    assert!(near, "{name}: {found:?} instead of {places:?}");
}

#[test]
fn displayed_pictures_have_the_values_of_the_authors_program() {
    let flip = |picture: &Image, reference: &Image| flip_of_display(picture, reference, PIXELS_PER_DEGREE).unwrap();
    let (a, b) = (pattern(0), pattern(1));
    holds("pattern", &flip(&b, &a), 0.425_292, [0.816_841, 0.377_807, 0.362_727, 0.703_189]);
    let darker = changed(&a, |pixel| pixel.map(|value| (value * 0.9 + 0.02).clamp(0.0, 1.0)), |_, _| true);
    holds("darker", &flip(&darker, &a), 0.141_527, [0.193_285, 0.137_367, 0.130_203, 0.173_228]);
    let patched = changed(&a, |_| [1.0, 0.0, 0.0], patch);
    holds("patch", &flip(&patched, &a), 0.092_199, [0.002_064, 0.057_387, 0.521_039, 0.0]);
    holds("same", &flip(&a, &a), 0.0, [0.0; 4]);
    let grey = flat([0.5; 3]);
    let dot = changed(&grey, |_| [0.6, 0.5, 0.4], |x, y| (x, y) == (12, 8));
    holds("dot", &flip(&dot, &grey), 0.003_459, [0.0, 0.000_743, 0.035_579, 0.0]);
    holds("black and white", &flip(&flat([1.0; 3]), &flat([0.0; 3])), 0.967_387, [0.967_388; 4]);
    holds("green and blue", &flip(&flat([0.0, 0.0, 1.0]), &flat([0.0, 1.0, 0.0])), 1.0, [1.0; 4]);
    let nearer = flip_of_display(&b, &a, 40.0).unwrap();
    holds("from farther away", &nearer, 0.562_545, [0.972_879, 0.627_050, 0.402_072, 0.793_745]);
}

#[test]
fn bright_pictures_have_the_values_of_the_authors_program() {
    let bright = |shift| changed(&pattern(shift), |pixel| pixel.map(|value| value * 20.0 + 0.01), |_, _| true);
    let (a, b) = (bright(0), bright(1));
    holds("pattern", &flip(&b, &a, PIXELS_PER_DEGREE).unwrap(), 0.453_887, [0.797_054, 0.401_757, 0.394_967, 0.477_295]);
    let patched = changed(&a, |pixel| pixel.map(|value| value * 3.0), patch);
    holds("patch", &flip(&patched, &a, PIXELS_PER_DEGREE).unwrap(), 0.044_651, [0.001_133, 0.035_212, 0.218_185, 0.0]);
}

/// The control: another picture has another value, and sizes must agree.
#[test]
fn what_differs_more_is_larger() {
    let grey = flat([0.5; 3]);
    let value = |level: f32| flip_of_display(&flat([level; 3]), &grey, PIXELS_PER_DEGREE).unwrap().mean();
    assert!(value(0.5) == 0.0 && value(0.51) > 1e-3 && value(0.6) > value(0.55));
    let small = Image { width: 1, height: 1, pixels: vec![[0.5; 3]] };
    assert!(flip(&small, &grey, PIXELS_PER_DEGREE).is_err());
    let holed = changed(&grey, |_| [f32::NAN, f32::INFINITY, -1.0], patch);
    assert!(flip(&holed, &grey, PIXELS_PER_DEGREE).unwrap().values.iter().all(|value| value.is_finite()));
}
