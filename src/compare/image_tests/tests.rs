use super::*;
use crate::statistics::random::SplitMix64;

const WIDTH: u32 = 64;
const HEIGHT: u32 = 48;
const SIZE: usize = (WIDTH * HEIGHT) as usize;
/// Standard deviation of a pixel's value over its mean.
const NOISE: f64 = 0.1;

fn settings(alpha: f64) -> TileSettings {
    TileSettings { tile: 16, alpha, relative_margin: 0.0 }
}

/// The values of a noiseless picture.
fn truth(pixel: usize, channel: usize) -> f64 {
    0.2 + 0.1 * channel as f64 + 0.5 * (pixel % WIDTH as usize) as f64 / f64::from(WIDTH)
}

fn noisy(random: &mut SplitMix64, energy: f64) -> Vec<[f32; 3]> {
    let value = |random: &mut SplitMix64, pixel, channel| energy * truth(pixel, channel) * (1.0 + NOISE * random.normal());
    (0..SIZE).map(|pixel| std::array::from_fn(|channel| value(random, pixel, channel) as f32)).collect()
}

fn variances() -> Vec<[f32; 3]> {
    (0..SIZE).map(|pixel| std::array::from_fn(|channel| (NOISE * truth(pixel, channel)).powi(2) as f32)).collect()
}

fn picture(pixels: &[[f32; 3]]) -> ImageView<'_> {
    ImageView { width: WIDTH, pixels }
}

/// Pixels of equal paths on another device: rounding everywhere, and one path in a hundred that went
/// elsewhere.
fn retraced(pixels: &[[f32; 3]], random: &mut SplitMix64, energy: f64) -> Vec<[f32; 3]> {
    let turned = |random: &mut SplitMix64| if random.uniform() < 0.01 { 1.0 + NOISE * random.normal() } else { 1.0 };
    let rounding = |random: &mut SplitMix64| 1.0 + 1e-6 * random.uniform();
    pixels
        .iter()
        .map(|pixel| {
            let factor = energy * turned(random) * rounding(random);
            pixel.map(|value| (f64::from(value) * factor) as f32)
        })
        .collect()
}

type Compare = fn(&mut SplitMix64, f64, &TileSettings) -> ImageComparison;

fn independent(random: &mut SplitMix64, energy: f64, settings: &TileSettings) -> ImageComparison {
    let (a, b, variances) = (noisy(random, energy), noisy(random, 1.0), variances());
    let [a, b, variances] = [&a, &b, &variances].map(|pixels| picture(pixels));
    compare_independent([a, variances], [b, variances], settings).unwrap()
}

fn replications(random: &mut SplitMix64, energy: f64, settings: &TileSettings) -> ImageComparison {
    let mut render = |energy| (0..8).map(|_| noisy(random, energy)).collect::<Vec<_>>();
    let (a, b) = (render(energy), render(1.0));
    let [a, b] = [&a, &b].map(|renders| renders.iter().map(|pixels| picture(pixels)).collect::<Vec<_>>());
    compare_replications(&a, &b, settings).unwrap()
}

fn paired(random: &mut SplitMix64, energy: f64, settings: &TileSettings) -> ImageComparison {
    let a = noisy(random, 1.0);
    let b = retraced(&a, random, energy);
    compare_paired(picture(&a), picture(&b), settings).unwrap()
}

fn disagreements(repetitions: u64, compare: Compare, energy: f64, settings: &TileSettings) -> u64 {
    (0..repetitions).filter(|&seed| !compare(&mut SplitMix64::new(seed << 32), energy, settings).agrees()).count() as u64
}

/// 12 tiles × 3 channels and the whole picture, corrected by Šidák, reject the truth in a share α of all cases.
#[test]
fn false_alarms_come_at_the_stated_rate() {
    let (repetitions, alpha) = (300u64, 0.2);
    let expected = alpha * repetitions as f64;
    let scatter = (expected * (1.0 - alpha)).sqrt();
    let rate = |compare| disagreements(repetitions, compare, 1.0, &settings(alpha)) as f64;
    let alarms = rate(independent);
    assert!((alarms - expected).abs() < 4.0 * scatter, "independent: {alarms} alarms, {expected} expected");
    let alarms = disagreements(60, replications, 1.0, &settings(alpha)) as f64;
    assert!((alarms - 12.0).abs() < 4.0 * (12.0f64 * 0.8).sqrt(), "replications: {alarms} alarms, 12 expected");
    // One-sided: a few stray paths per tile make t's tails lighter than stated.
    let paired_settings = TileSettings { relative_margin: 1e-5, ..settings(alpha) };
    let alarms = disagreements(repetitions, paired, 1.0, &paired_settings) as f64;
    assert!(alarms < expected + 4.0 * scatter, "paired: {alarms} alarms, at most {expected} expected");
}

#[test]
fn one_per_cent_of_energy_is_found() {
    for (name, compare) in [("independent", independent as Compare), ("replications", replications), ("paired", paired)] {
        let found = disagreements(20, compare, 1.01, &TileSettings { tile: 16, ..TileSettings::default() });
        assert_eq!(found, 20, "{name}: found in {found} of 20");
    }
}

/// An error of one tile only, far too small to move the whole picture's mean.
#[test]
fn a_bad_tile_is_found_where_it_is() {
    let mut random = SplitMix64::new(9);
    let first = noisy(&mut random, 1.0);
    let mut second = retraced(&first, &mut random, 1.0);
    for y in 16..32 {
        for x in 32..48 {
            second[y * WIDTH as usize + x][1] *= 0.98;
        }
    }
    let compared =
        compare_paired(picture(&first), picture(&second), &TileSettings { tile: 16, ..TileSettings::default() }).unwrap();
    let places: Vec<_> =
        compared.rejected().filter(|finding| finding.region.width < WIDTH).map(|f| (f.region, f.channel)).collect();
    assert_eq!(places, [(Region { x: 32, y: 16, width: 16, height: 16 }, 1)]);
    assert_eq!(compared.worst_tile().map(|finding| finding.channel), Some(1));
}

/// Pictures that share their noise are not independent: the z-test then finds nothing, which is why there is a paired test.
#[test]
fn common_noise_hides_an_error_from_the_independent_test() {
    let mut random = SplitMix64::new(10);
    let first = noisy(&mut random, 1.0);
    let second = retraced(&first, &mut random, 1.003);
    let (variances, settings) = (variances(), TileSettings { tile: 16, ..TileSettings::default() });
    let [a, b, variances] = [&first, &second, &variances].map(|pixels| picture(pixels));
    assert!(compare_independent([a, variances], [b, variances], &settings).unwrap().agrees());
    assert!(!compare_paired(a, b, &settings).unwrap().agrees());
}

#[test]
fn rounding_is_within_the_margin_and_noiseless_errors_are_not() {
    let first = [[2.0f32, 2.0, 0.0]; SIZE];
    let compare =
        |second: [f32; 3]| compare_paired(picture(&first), picture(&[second; SIZE]), &TileSettings::default()).unwrap().agrees();
    assert!(compare([2.0, 2.0, 0.0]));
    assert!(compare([2.000_01, 1.999_99, 0.0]));
    assert!(!compare([2.02, 2.0, 0.0]));
    assert!(!compare([2.0, 2.0, 1e-3]));
}

#[test]
fn one_pixel_that_is_not_a_number_fails() {
    let first = noisy(&mut SplitMix64::new(11), 1.0);
    for bad in [f32::NAN, f32::INFINITY] {
        let mut second = first.clone();
        second[77][2] = bad;
        let compared = compare_paired(picture(&first), picture(&second), &TileSettings::default()).unwrap();
        assert!(!compared.agrees());
        // Even where both have it.
        assert!(!compare_paired(picture(&second), picture(&second), &TileSettings::default()).unwrap().agrees());
    }
}

#[test]
fn tiles_cover_each_pixel_once() {
    for (width, height, side) in [(64, 48, 16), (17, 5, 16), (100, 1, 32), (3, 3, 0)] {
        let layout = Layout { width, height };
        let mut pixels: Vec<usize> = layout.tiles(side).into_iter().flat_map(|region| layout.pixels(region)).collect();
        pixels.sort_unstable();
        assert_eq!(pixels, (0..(width * height) as usize).collect::<Vec<_>>(), "{width}×{height} in tiles of {side}");
    }
}

#[test]
fn pictures_that_cannot_be_compared() {
    let pixels = [[1.0f32; 3]; 12];
    let of = |width, count: usize| ImageView { width, pixels: &pixels[..count] };
    let compare = |a, b| compare_paired(a, b, &TileSettings::default()).map(|compared| compared.agrees());
    assert_eq!(compare(of(4, 12), of(4, 12)), Ok(true));
    assert_eq!(compare(of(4, 12), of(3, 12)), Err(ComparisonError::Sizes));
    assert_eq!(compare(of(4, 12), of(4, 8)), Err(ComparisonError::Sizes));
    assert_eq!(compare(of(4, 0), of(4, 0)), Err(ComparisonError::Sizes));
    assert_eq!(compare(of(0, 0), of(0, 0)), Err(ComparisonError::Sizes));
    assert_eq!(compare(of(5, 12), of(5, 12)), Err(ComparisonError::Sizes));
    let one = [of(4, 12)];
    let result = compare_replications(&one, &one, &TileSettings::default());
    assert_eq!(result.map(|compared| compared.agrees()), Err(ComparisonError::Replications));
}
