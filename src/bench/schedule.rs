//! The measurement itself: pictures of rising numbers of samples, over and over, settings in turn.

use super::reference::Reference;
use super::subject::{BenchError, Subject};
use crate::compare::Moments;
use crate::compare::{compare, relative_weight};
use crate::sampling::hash::mix;

/// Which pictures are made.
#[derive(Debug, Clone)]
pub struct SampleSchedule {
    /// Samples per pixel, rising.
    pub levels: Vec<u32>,
    /// Independent pictures of each level and setting.
    pub replications: u32,
    /// Key of all seeds.
    pub seed: u32,
}

impl SampleSchedule {
    /// Levels that double up to `most`, at most `count`.
    pub fn doubling(most: u32, count: u32, replications: u32, seed: u32) -> Self {
        let mut levels: Vec<u32> = (0..count.min(32)).map(|step| most >> step).take_while(|spp| *spp > 0).collect();
        levels.reverse();
        Self { levels, replications, seed }
    }

    /// Every picture of a measurement has random numbers of its own, so that all errors are independent.
    pub fn seed_of(&self, setting: usize, level: usize, replication: u32) -> u32 {
        let place = (setting as u32) << 16 | (level as u32) << 10;
        mix(mix(self.seed ^ 0x6265_6e63).wrapping_add(place)).wrapping_add(mix(replication))
    }

    /// Pictures that are made, the thrown away ones included.
    pub fn pictures(&self, settings: usize) -> usize {
        (self.levels.len() * self.replications as usize + 1) * settings
    }
}

/// One picture's error and cost.
#[derive(Debug, Clone, Copy)]
pub struct Observation {
    pub mse: f64,
    pub relmse: f64,
    pub seconds: f64,
}

/// The observations of one setting.
#[derive(Debug, Clone)]
pub struct Observations {
    /// By level, then by replication.
    pub by_level: Vec<Vec<Observation>>,
    /// Values of the last level's pictures, over replications.
    pub last_level: Vec<[Moments; 3]>,
    pub non_finite_samples: u64,
    /// Seconds of building and of compiling, once.
    pub set_up: (f64, f64),
}

impl Observations {
    /// Replications that are complete.
    pub fn replications(&self) -> usize {
        self.by_level.iter().map(Vec::len).min().unwrap_or(0)
    }

    /// Squared bias of the last level in the measure that the weights give a pixel's value of the reference, with its standard error: what
    /// is left of the squared distance between mean and reference when the variance of the mean is taken away. It still holds the
    /// reference's own error.
    pub fn squared_bias(&self, reference: &Reference, weight: impl Fn(f64) -> f64) -> (f64, f64) {
        let mut excess = Moments::default();
        for (moments, expected) in self.last_level.iter().zip(&reference.image.pixels) {
            let channel = |channel: usize| {
                let (own, expected) = (&moments[channel], f64::from(expected[channel]));
                let noise = own.variance() / own.count() as f64;
                ((own.mean() - expected).powi(2) - noise) * weight(expected)
            };
            excess.push((channel(0) + channel(1) + channel(2)) / 3.0);
        }
        (excess.mean(), excess.standard_error())
    }
}

/// The weight of the plain squared error.
pub fn no_weight(_reference: f64) -> f64 {
    1.0
}

/// The weight of the relative squared error.
pub fn by_brightness(reference: f64) -> f64 {
    relative_weight(reference)
}

/// Makes every picture of the schedule. Settings take turns at every level, and who begins changes, so that all meet the machine in the same
/// state; one picture of each is made before and thrown away. `step` is called before each picture with what it is.
///
/// Renders the schedule. If a subject is interrupted and two replications are complete, the result holds
/// these, and the flag says so.
///
/// # Errors
/// Errors of subjects, and a reference of another size.
pub fn observe_schedule(
    subjects: &mut [Box<dyn Subject + '_>],
    reference: &Reference,
    schedule: &SampleSchedule,
    step: &mut dyn FnMut(&str),
) -> Result<(Vec<Observations>, bool), BenchError> {
    let empty = Observations {
        by_level: vec![Vec::new(); schedule.levels.len()],
        last_level: vec![[Moments::default(); 3]; reference.image.pixels.len()],
        non_finite_samples: 0,
        set_up: (0.0, 0.0),
    };
    let mut all = vec![empty; subjects.len()];
    let middle = schedule.levels.get(schedule.levels.len() / 2).copied().unwrap_or(1);
    for subject in subjects.iter_mut() {
        step("warming up");
        subject.render(schedule.seed, middle)?;
    }
    for replication in 0..schedule.replications {
        for level in 0..schedule.levels.len() {
            for turn in 0..subjects.len() {
                let setting = (turn + replication as usize + level) % subjects.len();
                step(&format!("replication {} of {}", replication + 1, schedule.replications));
                let place = RunIndex { setting, level, replication };
                match observe(subjects[setting].as_mut(), reference, schedule, place, &mut all[setting]) {
                    Err(BenchError::Interrupted) if replication >= 2 => {
                        return Ok((complete(all, replication as usize), true));
                    }
                    outcome => outcome?,
                }
            }
        }
    }
    Ok((all, false))
}

/// The position of a picture in the measurement.
#[derive(Clone, Copy)]
struct RunIndex {
    setting: usize,
    level: usize,
    replication: u32,
}

fn observe(
    subject: &mut dyn Subject,
    reference: &Reference,
    schedule: &SampleSchedule,
    place: RunIndex,
    into: &mut Observations,
) -> Result<(), BenchError> {
    let seed = schedule.seed_of(place.setting, place.level, place.replication);
    let run = subject.render(seed, schedule.levels[place.level])?;
    let comparison = compare(&run.picture, &reference.image)?;
    let observation = Observation { mse: comparison.mse.all, relmse: comparison.relmse.all, seconds: run.seconds };
    into.by_level[place.level].push(observation);
    into.non_finite_samples += run.non_finite_samples;
    into.set_up = (run.build_seconds, run.compile_seconds);
    if place.level + 1 == schedule.levels.len() {
        for (moments, pixel) in into.last_level.iter_mut().zip(&run.picture.pixels) {
            moments.iter_mut().zip(pixel).for_each(|(moments, value)| moments.push(f64::from(*value)));
        }
    }
    Ok(())
}

/// Leaves out what belongs to a replication that was not finished.
fn complete(mut all: Vec<Observations>, replications: usize) -> Vec<Observations> {
    for observations in &mut all {
        observations.by_level.iter_mut().for_each(|level| level.truncate(replications));
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_double_up_to_the_most() {
        assert_eq!(SampleSchedule::doubling(256, 4, 1, 0).levels, [32, 64, 128, 256]);
        assert_eq!(SampleSchedule::doubling(100, 40, 1, 0).levels, [1, 3, 6, 12, 25, 50, 100]);
    }

    #[test]
    fn no_two_pictures_share_a_seed() {
        let schedule = SampleSchedule::doubling(1024, 10, 20, 5);
        let mut seeds: Vec<u32> = (0..12)
            .flat_map(|setting| (0..10).map(move |level| (setting, level)))
            .flat_map(|(setting, level)| (0..20).map(move |replication| (setting, level, replication)))
            .map(|(setting, level, replication)| schedule.seed_of(setting, level, replication))
            .collect();
        let all = seeds.len();
        seeds.sort_unstable();
        seeds.dedup();
        assert_eq!(seeds.len(), all);
    }
}
