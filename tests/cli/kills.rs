//! Renders that are killed by SIGKILL at random moments, and go on.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::process::Child;
use std::time::{Duration, Instant, SystemTime};

use super::checkpoints::devices;
use super::common::effort::{announce, in_full};
use super::*;

/// A render that is killed. What it does is said by its arguments, and the names of its pictures by what follows their stem.
#[derive(Clone, Copy)]
struct Job {
    scene: &'static str,
    arguments: &'static str,
    /// Samples per pixel to begin with: there are twice as many until the render takes a while.
    spp: u32,
    output: &'static str,
    pictures: &'static [&'static str],
    /// The device has no memory for the whole film.
    has_small_film: bool,
}

const STILL: Job =
    Job { scene: "scene.toml", arguments: "--size 48x32", spp: 100, output: ".exr", pictures: &[".exr"], has_small_film: false };

/// Every way in which a render ends, with states that say something else each.
const JOBS: [Job; 8] = [
    STILL,
    Job { arguments: "--size 48x32 --time-limit 100000", ..STILL },
    Job { arguments: "--size 48x32 --target-error 1e-12", ..STILL },
    Job { arguments: "--size 48x32 --adaptive", ..STILL },
    Job { arguments: "--size 48x32 --adaptive --target-error 1e-12", ..STILL },
    Job { arguments: "--size 48x32 --aov albedo,depth,alpha,indirect", ..STILL },
    Job { arguments: "--size 48x32 --first-sample 32 --crop 5,3,35,25", ..STILL },
    // Some kills are within a frame, and some between two.
    Job {
        scene: "camera.toml",
        arguments: "--size 48x32 --frames 3-5",
        output: ".#.exr",
        pictures: &[".3.exr", ".4.exr", ".5.exr"],
        ..STILL
    },
];

/// More pixels than there is memory for, on either device. A few columns are enough to have all bands.
fn bands_on(device: &str) -> Job {
    match device {
        "cpu" => Job { arguments: "--size 32768x1100 --crop 0,0,4,1100", spp: 1, ..STILL },
        _ => Job { arguments: "--size 2048x4096 --crop 0,0,8,4096", spp: 1, has_small_film: true, ..STILL },
    }
}

/// Numbers that look random and are the same in each run of the tests.
struct Numbers(u32);

impl Numbers {
    fn below(&mut self, end: u32) -> u32 {
        self.0 = gpt::sampling::hash::mix(self.0 + 1);
        self.0 % end
    }
}

/// A job with its samples, on a device.
struct Renders<'a> {
    place: &'a Workplace,
    device: &'static str,
    job: Job,
    spp: u32,
}

impl Renders<'_> {
    fn command(&self, more: &str) -> Command {
        let Job { scene, arguments, .. } = self.job;
        let mut command = self.place.command(&format!("render {scene} -q --device {} {arguments} {more}", self.device));
        if self.job.has_small_film
            && let Some(layer) = super::faults::layer()
        {
            super::faults::make_fail(&mut command, layer, "vkAllocateMemory:2:memory");
        }
        command
    }

    /// Renders to the end; seconds that it took to render, without what comes before, and samples that it found. None where it was finished
    /// before.
    fn to_the_end(&self, more: &str) -> Option<(f64, u64)> {
        let output = self.command(&format!("{more} --stats stats.json")).output().expect("the program starts");
        assert!(output.status.success(), "{} {more}: {}", self.job.arguments, text(&output.stderr));
        if !self.place.path("stats.json").exists() {
            return None;
        }
        let stats = self.place.stats("stats.json");
        fs::remove_file(self.place.path("stats.json")).expect("it is there");
        let frames = stats.as_array().cloned().unwrap_or_else(|| vec![stats.clone()]);
        let seconds = frames.iter().filter_map(|frame| frame["seconds"]["render"].as_f64()).sum();
        Some((seconds, frames.iter().filter_map(|frame| frame["resumed_samples"].as_u64()).sum()))
    }

    /// The pictures of this stem, which are removed.
    fn take(&self, stem: &str) -> Vec<Vec<u8>> {
        let take = |name: &&str| {
            let path = self.place.path(&format!("{stem}{name}"));
            let bytes = fs::read(&path).expect("the picture");
            fs::remove_file(path).expect("it is there");
            bytes
        };
        self.job.pictures.iter().map(take).collect()
    }

    /// States that stand in the folder, with the time at which each was written.
    fn states(&self) -> BTreeSet<(PathBuf, SystemTime)> {
        let entries = fs::read_dir(self.place.path("")).expect("the folder").flatten().map(|entry| entry.path());
        let is_state =
            |path: &PathBuf| path.to_str().is_some_and(|name| name.contains(".exr.checkpoint") && !name.contains("-rows-"));
        let with_time = |path: PathBuf| fs::metadata(&path).and_then(|data| data.modified()).ok().map(|time| (path, time));
        entries.filter(is_state).filter_map(with_time).collect()
    }

    /// Waits until there is a state that was not there before, or the render is over.
    fn wait_for_state(&self, child: &mut Child, before: &BTreeSet<(PathBuf, SystemTime)>) {
        while self.states().is_subset(before) && child.try_wait().expect("a process").is_none() {
            std::thread::sleep(Duration::from_millis(2));
        }
    }
}

/// The outcome of the kills of a job.
#[derive(Debug, Default)]
struct Told {
    kills: u32,
    /// Kills after which there was a state.
    with_state: u32,
    /// Pictures that were compared, and those whose last render found samples.
    pictures: u32,
    resumed: u32,
}

/// Kills renders until there were so many kills, and so many of them left a state. Every picture is the uninterrupted one, byte for byte, and
/// stands alone in its folder.
fn kill_and_resume(place: &Workplace, (kills, with_state): (u32, u32), device: &'static str, job: Job) {
    let begun = Instant::now();
    let what = format!("{device} {}", job.arguments);
    let files = place.files();
    let mut renders = Renders { place, device, job, spp: job.spp };
    // Long enough that many passes are between the first and the last.
    let seconds = loop {
        let (seconds, _) = renders.to_the_end(&format!("--spp {} -o whole{}", renders.spp, job.output)).expect("it is rendered");
        if seconds > 0.5 {
            break seconds;
        }
        renders.spp *= 2;
    };
    let expected = renders.take("whole");
    let resume = format!("--spp {} --checkpoint 0.01 --resume -o a{}", renders.spp, job.output);
    let mut numbers = Numbers(kills ^ job.arguments.len() as u32);
    let mut told = Told::default();
    while told.kills < kills || told.with_state < with_state {
        assert!(told.pictures < 4 * kills, "{what}: hardly any render is killed in time, {told:?}");
        let mut has_state = false;
        for _ in 0..=numbers.below(3) {
            let before = renders.states();
            let mut command = renders.command(&resume);
            let mut child = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("a process");
            // Some moments are before the first sample, and some are after a state that this render wrote.
            let longest = if numbers.below(3) == 0 {
                (2.0 * seconds * 1000.0) as u32
            } else {
                renders.wait_for_state(&mut child, &before);
                (0.4 * seconds * 1000.0) as u32
            };
            std::thread::sleep(Duration::from_millis(u64::from(numbers.below(longest.max(2)))));
            // Refused where it is over.
            let _ = child.kill();
            let status = child.wait().expect("an end");
            if status.success() {
                has_state = false;
                break;
            }
            assert!(status.code().is_none(), "{what}: {status}");
            has_state = !renders.states().is_empty();
            told.kills += 1;
            told.with_state += u32::from(has_state);
        }
        let resumed = renders.to_the_end(&resume).map(|(_, samples)| samples);
        told.resumed += u32::from(resumed > Some(0));
        told.pictures += 1;
        // The state may be a layer's, or that of a frame that the kill came after.
        let is_of_picture = has_state && job.pictures.len() == 1 && !job.arguments.contains("--aov");
        assert!(resumed != Some(0) || !is_of_picture, "{what}: the state is not used");
        assert!(renders.take("a") == expected, "{what}: {told:?}");
        assert_eq!(place.files(), files, "{what}: something is left");
    }
    // The control: another seed is another picture.
    renders.to_the_end(&format!("--seed 9 --spp {} -o whole{}", renders.spp, job.output));
    assert!(renders.take("whole") != expected, "{what}");
    announce(&format!("{what}: {told:?} in {:.0} s", begun.elapsed().as_secs_f64()));
}

/// A folder with a still scene and one whose camera moves.
fn place_to_kill_in() -> Workplace {
    let place = Workplace::new();
    fs::write(place.path("camera.toml"), super::frames::moving_camera()).expect("the scene file");
    place
}

#[test]
#[ignore = "slow"]
fn a_render_that_is_killed_goes_on_bit_for_bit() {
    let in_full = in_full("200 kills of renders, and kills of every kind of render on graphics devices");
    let kills = if in_full { (12, 6) } else { (2, 1) };
    let place = place_to_kill_in();
    for device in devices() {
        // A state holds the same on all devices, but for how the film is read.
        let step = if in_full || device == "cpu" { 1 } else { 4 };
        JOBS.into_iter().step_by(step).for_each(|job| kill_and_resume(&place, kills, device, job));
    }
}

#[test]
#[ignore = "long: kills of pictures in bands"]
fn long_a_picture_in_bands_that_is_killed_goes_on_bit_for_bit() {
    let place = place_to_kill_in();
    let has_layer = super::faults::layer().is_some();
    for device in devices().into_iter().filter(|device| *device == "cpu" || has_layer) {
        kill_and_resume(&place, (8, 4), device, bands_on(device));
    }
}
