//! The pixels of a trial run as one way of drawing from lights renders them.

use rayon::prelude::*;

use super::super::extent::pixel_count;
use super::super::paths::pixel_of;
use super::sum::{Rays, Sum};
use super::trial_path::{Record, TrialPath};
use super::unguided::{UnguidedEstimate, UnguidedRecord};
use crate::compare::metrics::relative_weight;
use crate::reference::integrator::Integrator;
use crate::reference::work;
use crate::sampling::hash::mix;
use crate::sampling::{PathSampler, Sampling, SequencePoint};
use crate::scene::Scene;
use crate::spectrum::Spectrum;

/// Pixels that are tried at least: fewer tell too little. Under an environment map, where there is most to gain, few are better than none. Of fewer
/// than [`MANY_PIXELS`] a gain must be larger beside the noise.
const FEWEST_PIXELS: u64 = 1 << 7;
const FEWEST_UNDER_A_MAP: u64 = 1 << 5;
pub const MANY_PIXELS: u32 = 1 << 6;
/// One of so many pixels is tried, within these numbers, where the render is long enough.
const ONE_OF_PIXELS: u64 = 1 << 10;
const TRIED_PIXELS: [u64; 2] = [1 << 8, 1 << 10];
/// Each pixel is tried by so many independent pictures of so many samples.
const PICTURES: u32 = 4;
const SAMPLES: u32 = 16;
/// Light in view is looked at in so many times as many pixels, each by so many pictures.
const MORE_PIXELS: u32 = 16;
/// Work after which no more are looked at.
const MOST_WORK_IN_VIEW: u64 = 8 * work::SECOND;
const PICTURES_IN_VIEW: u32 = 2;
/// Pixels that the brightness is averaged over which outliers are relative to.
const PIXELS_OF_PATCH: usize = 16;
/// Least error that another way may leave, beside what there was.
const LEAST_ERROR: f64 = 0.25;
/// Seed of the random numbers.
const SEED: u32 = 0x7069_6c6f;

/// How many pixels of the scene's film are tried, by so many paths at most; None where these are too few.
pub fn tried_pixels(scene: &Scene, paths: f64) -> Option<u32> {
    let [fewest, most] = TRIED_PIXELS;
    let most = (pixel_count(scene) / ONE_OF_PIXELS).clamp(fewest, most);
    let affordable = (paths / TrialResult::paths(1)) as u64;
    let fewest = if scene.has_environment_map() { FEWEST_UNDER_A_MAP } else { FEWEST_PIXELS };
    (affordable >= fewest).then_some(affordable.min(most) as u32)
}

/// The result of one way of drawing from lights.
pub struct TrialResult {
    pixels: Vec<TriedPixel>,
    /// The cost of its paths, in rays of paths.
    pub cost: f64,
    /// The work that went into finding out ([`work`]).
    pub work: u64,
}

impl TrialResult {
    /// Renders so many pixels; the cost is not known yet.
    pub fn new(integrator: &Integrator, pixels: u32) -> Self {
        Self::recorded::<()>(integrator, pixels).0
    }

    /// Renders so many pixels by guided paths, with their estimates of unguided ones.
    pub fn unguided(integrator: &Integrator, pixels: u32) -> (Self, Vec<UnguidedEstimate>) {
        Self::recorded::<UnguidedRecord>(integrator, pixels)
    }

    fn recorded<R: Record>(integrator: &Integrator, pixels: u32) -> (Self, Vec<R::Statistics>) {
        let pictures = pictures(integrator, PICTURES);
        let of_pixel = |number| work::of(|| TriedPixel::of::<R>(integrator, &pictures, number));
        let (tried, works): (Vec<_>, Vec<u64>) = (0..pixels).into_par_iter().map(of_pixel).unzip();
        let (pixels, statistics) = tried.into_iter().unzip();
        (Self { pixels, cost: 0.0, work: works.into_iter().sum() }, statistics)
    }

    /// Paths that each way traces for so many pixels.
    pub fn paths(pixels: u32) -> f64 {
        f64::from(pixels) * f64::from(PICTURES * SAMPLES)
    }

    /// All together.
    pub fn rays(&self) -> Rays {
        self.pixels.iter().fold(Rays::default(), |sum, pixel| sum.and(pixel.rays))
    }

    pub fn has_noise(&self) -> bool {
        self.pixels.iter().any(|pixel| !pixel.variance.is_black())
    }

    /// The pixels, with what their squared errors are multiplied by.
    fn weighed(&self) -> impl Iterator<Item = (&TriedPixel, Spectrum)> {
        self.pixels.iter().map(|pixel| (pixel, weight(pixel.in_view + pixel.mean)))
    }

    /// The error of light beyond what is in view, and that of what is.
    fn errors(&self, in_view: &InView) -> [f64; 2] {
        let beyond: Spectrum = self.pixels.iter().map(|pixel| pixel.mean).sum();
        let own = self.weighed().map(|(pixel, weight)| (pixel.variance * weight).sum()).sum();
        [own, in_view.error(beyond / self.pixels.len() as f64)]
    }

    /// Error times cost, over that of another way. Errors are relative to what both ways found together:
    /// relative to what one of them found alone, its own outliers would count for less than those of the
    /// other.
    pub fn loss_over(&self, other: &Self, in_view: &InView) -> Loss {
        let together: Vec<Spectrum> = self.together(other).collect();
        self.loss_beside(other, in_view, &together)
    }

    /// [`TrialResult::loss_over`] for a way that makes outliers darker and more frequent. Errors are relative to
    /// the light around a pixel: relative to that in the pixel itself, an outlier would count the same
    /// however bright it is.
    pub fn loss_of_outliers_over(&self, other: &Self, in_view: &InView) -> Loss {
        let mut patches = Patches::new(self.pixels.len());
        (0..).zip(self.together(other)).for_each(|(number, found)| patches.add(number, found));
        let around: Vec<Spectrum> = (0..self.pixels.len() as u32).map(|number| patches.mean_around(number)).collect();
        self.loss_beside(other, in_view, &around)
    }

    /// The light that two ways found beyond light in view, as a mean for each pixel.
    fn together(&self, other: &Self) -> impl Iterator<Item = Spectrum> {
        self.pixels.iter().zip(&other.pixels).map(|(own, others)| 0.5 * (own.mean + others.mean))
    }

    /// With errors relative to so much light beyond what is in view.
    fn loss_beside(&self, other: &Self, in_view: &InView, beyond: &[Spectrum]) -> Loss {
        let of_pixel = |((own, others), beyond): ((&TriedPixel, &TriedPixel), &Spectrum)| {
            let weight = weight(own.in_view + *beyond);
            [(own.variance * weight).sum(), (others.variance * weight).sum()]
        };
        let errors: Vec<[f64; 2]> = self.pixels.iter().zip(&other.pixels).zip(beyond).map(of_pixel).collect();
        let of_view = in_view.error(self.together(other).sum::<Spectrum>() / self.pixels.len() as f64);
        ratio(&errors, of_view).times(self.cost / other.cost)
    }
}

/// Error times cost of one way over that of another, and the standard error of that ratio, from the differences between pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Loss {
    pub value: f64,
    pub standard_error: f64,
}

impl Loss {
    fn times(self, factor: f64) -> Self {
        Self { value: self.value * factor, standard_error: self.standard_error * factor }
    }
}

/// The ratio of two sums of errors over pixels, the first over the second, with an error that both have beside. Its standard error is that of a ratio
/// of means (Cochran 1977, Sampling Techniques, eq. 6.13, of many pixels).
fn ratio(errors: &[[f64; 2]], of_both: f64) -> Loss {
    let [own, others] = errors.iter().fold([of_both; 2], |sums, [own, others]| [sums[0] + own, sums[1] + others]);
    let value = own / others;
    let squares: f64 = errors.iter().map(|[own, others]| (own - value * others).powi(2)).sum();
    let count = errors.len() as f64;
    Loss { value, standard_error: (squares * count / (count - 1.0).max(1.0)).sqrt() / others }
}

/// The error of guided paths, and that of unguided ones. Samples depend on each other by their random
/// numbers, which makes the error less than the variance of a sample says, by the same share either way.
pub fn errors_of_guiding(found: &TrialResult, estimates: &[UnguidedEstimate], in_view: &InView) -> [f64; 2] {
    let mut variances = [0.0; 2];
    for ((pixel, weight), estimate) in found.weighed().zip(estimates) {
        for (variance, moment) in variances.iter_mut().zip([estimate.guided, estimate.unguided]) {
            *variance += ((moment - pixel.mean * pixel.mean) * weight).sum();
        }
    }
    let [error, of_view] = found.errors(in_view);
    // Without noise a guide makes no difference. Estimates may be less than nothing.
    let ratio = if variances[0] > 0.0 { (variances[1] / variances[0]).max(LEAST_ERROR) } else { 1.0 };
    [error + of_view, error * ratio + of_view]
}

/// Means of light over patches of the film.
struct Patches {
    side: u32,
    /// The sum over a patch's pixels, and how many they are.
    sums: Vec<(Spectrum, f64)>,
}

impl Patches {
    /// Patches of about [`PIXELS_OF_PATCH`] tried pixels each, as many along either side of the film.
    fn new(pixels: usize) -> Self {
        let side = (pixels / PIXELS_OF_PATCH).isqrt().max(1) as u32;
        Self { side, sums: vec![(Spectrum::BLACK, 0.0); (side * side) as usize] }
    }

    fn index(&self, number: u32) -> usize {
        let [column, row] = pixel_of(number, [self.side; 2]);
        (row * self.side + column) as usize
    }

    /// Adds the light of the pixel with this number.
    fn add(&mut self, number: u32, found: Spectrum) {
        let index = self.index(number);
        let (sum, count) = &mut self.sums[index];
        (*sum, *count) = (*sum + found, *count + 1.0);
    }

    fn mean_around(&self, number: u32) -> Spectrum {
        let (sum, count) = self.sums[self.index(number)];
        sum / count
    }
}

/// The weight of squared errors, for each channel.
fn weight(mean: Spectrum) -> Spectrum {
    mean.map(relative_weight)
}

/// Emitters and the environment as they are in view. All ways of drawing from lights have the same noise at
/// their edges, which few pixels show: those that are tried may miss them.
pub struct InView {
    /// Mean and variance of pixels.
    pixels: Vec<[Spectrum; 2]>,
    /// So many times as many as are tried.
    times: u32,
}

impl InView {
    /// Beside so many pixels that are tried.
    pub fn new(integrator: &mut Integrator, pixels: u32) -> Self {
        let max_depth = integrator.set_max_depth(1);
        let pictures = pictures(integrator, PICTURES_IN_VIEW);
        let look = |number| {
            let found = pictures.iter().map(|picture| picture.show::<()>(integrator, number).in_view);
            mean_and_variance(&found.collect::<Vec<Spectrum>>())
        };
        let (mut found, mut times, mut spent) = (Vec::new(), 0, 0);
        while times < MORE_PIXELS && spent <= MOST_WORK_IN_VIEW {
            let numbers = times * pixels..(times + 1) * pixels;
            let looked: Vec<_> = numbers.into_par_iter().map(|number| work::of(|| look(number))).collect();
            for (pixel, work) in looked {
                found.push(pixel);
                spent += work;
            }
            times += 1;
        }
        integrator.set_max_depth(max_depth);
        Self { pixels: found, times }
    }

    /// The error of light in view in as many pixels as are tried; `beyond` is the light that comes from
    /// elsewhere.
    fn error(&self, beyond: Spectrum) -> f64 {
        let error: f64 = self.pixels.iter().map(|[mean, variance]| (*variance * weight(*mean + beyond)).sum()).sum();
        error / f64::from(self.times)
    }
}

/// The random numbers of one of the independent pictures.
struct Replication {
    sampling: Sampling,
    points: Vec<SequencePoint>,
}

fn pictures(integrator: &Integrator, count: u32) -> Vec<Replication> {
    let picture = |number: u32| {
        let seed = mix(SEED.wrapping_add(number));
        let sampling = Sampling { seed, samples: SAMPLES, ..Sampling::from(&integrator.scene().render) };
        Replication { sampling, points: (0..SAMPLES).map(|sample| SequencePoint::new(&sampling, sample)).collect() }
    };
    (0..count).map(picture).collect()
}

impl Replication {
    /// Renders a pixel.
    fn show<R: Record>(&self, integrator: &Integrator, number: u32) -> PixelEstimate<R::Statistics> {
        let size = integrator.scene().film.size;
        let [x, y] = pixel_of(number, size);
        let pixel = y.wrapping_mul(size[0]).wrapping_add(x);
        let mut shown: PixelEstimate<R::Statistics> = PixelEstimate::default();
        for point in &self.points {
            let mut path = TrialPath::<R>::new(&integrator.scene().render);
            let found = integrator.radiance(x, y, &PathSampler::new(&self.sampling, pixel, point), &mut path);
            // The film leaves out what is not finite, too.
            if found.is_finite() {
                shown.in_view += path.in_view / f64::from(SAMPLES);
                shown.beyond += (found - path.in_view) / f64::from(SAMPLES);
                shown.statistics = shown.statistics.and(path.record.statistics());
            }
            shown.rays = shown.rays.and(path.rays);
        }
        shown
    }
}

/// Light that the first edges of a pixel's paths find, and light beyond those.
#[derive(Default)]
struct PixelEstimate<T> {
    in_view: Spectrum,
    beyond: Spectrum,
    rays: Rays,
    /// By all samples together.
    statistics: T,
}

/// The mean of some values, and the variance of one of them.
fn mean_and_variance(found: &[Spectrum]) -> [Spectrum; 2] {
    let count = found.len() as f64;
    let mean = found.iter().copied().sum::<Spectrum>() / count;
    [mean, found.iter().map(|one| (*one - mean) * (*one - mean)).sum::<Spectrum>() / (count - 1.0)]
}

/// The result of a pixel.
struct TriedPixel {
    in_view: Spectrum,
    /// Light beyond, and its variance in one of the pictures.
    mean: Spectrum,
    variance: Spectrum,
    rays: Rays,
}

impl TriedPixel {
    /// With the statistics of a sample of it about other ways.
    fn of<R: Record>(integrator: &Integrator, pictures: &[Replication], number: u32) -> (Self, R::Statistics) {
        let shown: Vec<PixelEstimate<R::Statistics>> =
            pictures.iter().map(|picture| picture.show::<R>(integrator, number)).collect();
        let [mean, variance] = mean_and_variance(&shown.iter().map(|shown| shown.beyond).collect::<Vec<Spectrum>>());
        let in_view = shown.iter().map(|shown| shown.in_view).sum::<Spectrum>() / f64::from(PICTURES);
        let statistics = shown.iter().fold(R::Statistics::default(), |sum, shown| sum.and(shown.statistics));
        let rays = shown.iter().fold(Rays::default(), |sum, shown| sum.and(shown.rays));
        (Self { in_view, mean, variance, rays }, statistics.times(1.0 / f64::from(PICTURES * SAMPLES)))
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::load;

    /// An area light before the camera, from so far left to so far right.
    fn area_light(from: f64, to: f64) -> Integrator {
        let text = format!(
            "[film]\nsize = [64, 64]\n[camera]\nposition = [0, 0, 4]\nlook_at = [0, 0, 0]\nvfov = 40\n\
             [[material]]\nname = \"lamp\"\ntype = \"emissive\"\nradiance = 2\n\
             [[shape]]\ntype = \"rectangle\"\ncorner = [{from}, -9, 0]\nedge_u = [{}, 0, 0]\nedge_v = [0, 18, 0]\nmaterial = \"lamp\"\n",
            to - from
        );
        let scene = load::load_toml_str(&text, "lamp", Path::new("")).unwrap_or_else(|error| panic!("{error}"));
        Integrator::new(&scene).expect("the reference can render the scene")
    }

    /// A light's edge within pixels makes their samples differ: by as much whether few pixels are looked at
    /// or all. A light that fills the view does not.
    #[test]
    fn edges_of_emitters_in_view_have_noise() {
        let beyond = Spectrum::BLACK;
        let error = |from, to, pixels| InView::new(&mut area_light(from, to), pixels).error(beyond) / f64::from(pixels);
        assert_eq!(error(-9.0, 9.0, 64), 0.0);
        let [few, all] = [64, 1024].map(|pixels| error(-0.517, 0.391, pixels));
        assert!(all > 0.0 && (few / all - 1.0).abs() < 0.3, "{few} and {all}");
        // Relative to more light, it is less.
        assert!(InView::new(&mut area_light(-0.517, 0.391), 64).error(Spectrum::grey(10.0)) < 0.1 * 64.0 * few);
    }

    /// The ratio lies within one standard error of the truth about as often as a normal variable does, in many trial runs whose pixels have errors of a
    /// long tail.
    #[test]
    fn the_standard_error_of_a_loss_is_that_of_its_noise() {
        let mut state = 1_u32;
        let mut uniform = || {
            state = mix(state.wrapping_add(0x9e37_79b9));
            (f64::from(state) + 0.5) / 4_294_967_296.0
        };
        // Both ways err more in the same pixels; their mean errors are 1.5 and 2.
        let mut pixel = || {
            let in_common = -uniform().ln();
            [in_common - 0.5 * uniform().ln(), in_common - uniform().ln()]
        };
        let runs = 2000;
        let mut within = |share: f64| {
            let inside = (0..runs).filter(|_| {
                let errors: Vec<[f64; 2]> = (0..128).map(|_| pixel()).collect();
                let loss = ratio(&errors, 128.0);
                (loss.value - 2.5 / 3.0).abs() <= share * loss.standard_error
            });
            inside.count() as f64 / f64::from(runs)
        };
        let found = within(1.0);
        assert!((found - 0.683).abs() < 0.05, "{found}");
        // The control: half of it is too little.
        assert!(within(0.5) < 0.45);
    }
}
