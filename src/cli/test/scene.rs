//! The test of one scene.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::time::Instant;

use gpt::RenderOptions;
use gpt::Scene;
use gpt::compare::flip::{PIXELS_PER_DEGREE, flip};
use gpt::device::{ChosenDevice, ChosenRenderer};
use gpt::load::{FileLog, LoadOptions, SceneSource};
use gpt::output::{OutputError, PICTURE_ENDINGS, PictureFormat};
use gpt::picture_test::bless::{Blessed, bless};
use gpt::picture_test::candidate::judge_candidate;
use gpt::picture_test::golden::{Candidate, Golden};
use gpt::picture_test::judge::{Judgement, judge};
use gpt::picture_test::{PictureTestError, TestSettings};
use gpt::plan::PlanOptions;
use gpt::renderer::{DeviceChoice, Renderer};

use super::folder::Job;
use super::report::{Difference, SceneReport, TestOutcome, TestPictures};
use crate::cli::bench::OnlyStops;
use crate::cli::exit::{Exit, Failure};
use crate::cli::test_arguments::TestArguments;
use crate::cli::traversal::TraversalArguments;
use crate::cli::typed::CommandLine;
use crate::cli::{outputs, terminal};

/// Tests a scene, or makes its golden picture. What goes wrong is part of the report.
pub fn test(job: &Job, arguments: &TestArguments, settings: &TestSettings, read: &FileLog) -> SceneReport {
    let started = Instant::now();
    let mut report = blank(job);
    if let Err(failure) = test_into(job, (arguments, settings), read, &mut report) {
        report.verdict = TestOutcome::Failed;
        report.failure = Some(Exit::from(&failure));
        report.message = Some(failure.to_string());
    }
    report.seconds = started.elapsed().as_secs_f64();
    report
}

fn blank(job: &Job) -> SceneReport {
    SceneReport {
        scene: job.name.clone(),
        file: job.file.display().to_string(),
        golden: job.golden.display().to_string(),
        verdict: TestOutcome::Failed,
        message: None,
        device: None,
        width: 0,
        height: 0,
        spp: None,
        golden_spp: None,
        seed: None,
        detectable_change: None,
        share_of_tiles: None,
        suspects: 0,
        differences: Vec::new(),
        flip: None,
        flip_of_noise: None,
        scene_changed: None,
        seconds: 0.0,
        commands: vec![job.again.to_string()],
        failure: None,
        pictures: None,
    }
}

fn test_into(
    job: &Job,
    (arguments, settings): (&TestArguments, &TestSettings),
    read: &FileLog,
    report: &mut SceneReport,
) -> Result<(), Failure> {
    if let Some(folder) = &arguments.candidate_dir {
        return test_candidate(job, folder, (arguments, settings), report);
    }
    let source = SceneSource::parse(Some(job.file.as_os_str()))?;
    let scene = source.load(&LoadOptions { log: read.clone(), ..arguments.files.options(false) })?;
    for warning in &scene.warnings {
        terminal::warn(&format!("{}: {warning}", job.name));
    }
    [report.width, report.height] = scene.film.size;
    outputs::check_unread([job.golden.as_path()], read)?;
    let is_missing = !job.golden.exists();
    if is_missing && !arguments.bless && !arguments.update {
        let command = job.bless_command();
        return Err(Failure::BadScene(format!("there is no golden picture {}; `{command}` makes it", job.golden.display())));
    }
    let golden = if arguments.bless || is_missing { None } else { Some(Golden::read(&job.golden)?) };
    golden.iter().flat_map(|golden| &golden.warnings).for_each(|warning| terminal::warn(warning));
    let mut maker = Maker::new(&scene, arguments)?;
    report.device = Some(maker.renderer.device().to_owned());
    if let Some(golden) = golden {
        let differs = render_and_judge(job, (arguments, settings), &mut maker, &golden, report)?;
        if !(differs && arguments.update) {
            return Ok(());
        }
    }
    make_golden(job, settings, &mut maker, report)
}

/// A scene made ready.
struct Maker<'a> {
    scene: &'a Scene,
    renderer: Box<dyn Renderer>,
}

impl<'a> Maker<'a> {
    fn new(scene: &'a Scene, arguments: &TestArguments) -> Result<Self, Failure> {
        let device = match (&arguments.device, arguments.require_device) {
            (DeviceChoice::Cpu, true) => {
                return Err(Failure::usage("--require-device asks for a graphics device, and --device cpu for none"));
            }
            (DeviceChoice::Auto, true) => DeviceChoice::Gpu,
            (device, _) => device.clone(),
        };
        let plan = PlanOptions { device_timeout: arguments.device_timeout, ..TraversalArguments::default().options() };
        let ChosenRenderer { renderer, notice } = ChosenDevice::begin(&device, &plan).renderer(scene, &plan)?;
        if let (Some(notice), false) = (notice, arguments.quiet) {
            terminal::note(&notice);
        }
        Ok(Self { scene, renderer })
    }
}

/// Makes the golden picture and puts it in its place.
fn make_golden(job: &Job, settings: &TestSettings, maker: &mut Maker, report: &mut SceneReport) -> Result<(), Failure> {
    if let Some(folder) = job.golden.parent() {
        std::fs::create_dir_all(folder).map_err(|source| OutputError::Write { path: folder.to_owned(), source })?;
    }
    let scene = maker.scene;
    let provenance = gpt::Renderer::provenance_of(scene, &RenderOptions::default(), maker.renderer.device());
    let identity = (provenance.scene_hash.as_str(), scene.render.seed);
    let Blessed { golden, detection, non_finite_samples, .. } =
        bless(maker.renderer.as_mut(), scene.film.size, identity, settings, &OnlyStops)?;
    golden.write(&job.golden, provenance.clone())?;
    report.verdict = TestOutcome::Made;
    report.spp = golden.samples_of_one();
    report.golden_spp = Some(golden.samples);
    report.detectable_change = Some(detection.change);
    report.share_of_tiles = Some(detection.share);
    report.flip_of_noise = golden.flip_of_noise;
    report.message = shortcomings(detection.change, settings, non_finite_samples);
    if report.differences.is_empty() {
        report.commands = vec![job.bless_command()];
    }
    Ok(())
}

/// The reasons why a test finds less than it should.
fn shortcomings(found: f64, settings: &TestSettings, non_finite_samples: u64) -> Option<String> {
    let mut sentences = Vec::new();
    if found > settings.change {
        sentences.push(format!(
            "{} samples per pixel find changes of {:.1} % of a tile's energy, not {:.1} %: see --max-spp, and --change for larger ones",
            settings.most_samples,
            100.0 * found,
            100.0 * settings.change
        ));
    }
    if non_finite_samples > 0 {
        sentences.push(format!("{non_finite_samples} samples were not finite and are left out"));
    }
    (!sentences.is_empty()).then(|| sentences.join("; "))
}

/// Renders and tests; whether something differs.
fn render_and_judge(
    job: &Job,
    (arguments, settings): (&TestArguments, &TestSettings),
    maker: &mut Maker,
    golden: &Golden,
    report: &mut SceneReport,
) -> Result<bool, Failure> {
    let hash = gpt::Renderer::provenance_of(maker.scene, &RenderOptions::default(), "").scene_hash;
    report.scene_changed = golden.scene_hash.as_ref().map(|theirs| *theirs != hash);
    report.golden_spp = Some(golden.samples);
    report.flip_of_noise = golden.flip_of_noise;
    let theirs = [golden.mean.width, golden.mean.height];
    if theirs != maker.scene.film.size {
        let [[w, h], [gw, gh]] = [maker.scene.film.size, theirs];
        report.verdict = TestOutcome::Differs;
        report.message = Some(format!("the picture has {w}x{h} pixels, and its golden picture {gw}x{gh}"));
        return Ok(true);
    }
    let judged = judge(maker.renderer.as_mut(), golden, arguments.seed, settings, &OnlyStops)?;
    let Judgement { detection, seed, first_look, differences, suspects, picture, non_finite_samples, .. } = judged;
    let map = flip(&picture, &golden.mean, PIXELS_PER_DEGREE)?;
    report.spp = Some(detection.samples);
    report.seed = Some(seed);
    report.detectable_change = Some(detection.change);
    report.share_of_tiles = Some(detection.share);
    report.suspects = suspects;
    report.differences = differences.iter().map(Difference::from).collect();
    report.flip = Some(map.mean());
    report.message = shortcomings(detection.change, settings, non_finite_samples);
    let render = CommandLine::new("render").with(&job.file).with_options(job.on_device.clone());
    let render = render.with_option("--spp", detection.samples.to_string()).with_option("--seed", seed.to_string());
    report.commands.push(format!("{} && {}", render.with_option("-o", "now.exr"), compare(Path::new("now.exr"), &job.golden)));
    let differs = !differences.is_empty() || looks_different(arguments, report);
    report.verdict = if differs { TestOutcome::Differs } else { TestOutcome::Agrees };
    report.pictures = Some(TestPictures { golden: golden.mean.clone(), now: picture, tiles: first_look, flip: map });
    Ok(differs)
}

/// True if ꟻLIP is above the limit that was given; the report then says so.
fn looks_different(arguments: &TestArguments, report: &mut SceneReport) -> bool {
    let (Some(limit), Some(flip)) = (arguments.flip, report.flip) else { return false };
    if flip > limit {
        report.message = Some(format!("ꟻLIP is {flip:.4}, above the limit of {limit}"));
    }
    flip > limit
}

/// Tests the picture of another program.
fn test_candidate(
    job: &Job,
    folder: &Path,
    (arguments, settings): (&TestArguments, &TestSettings),
    report: &mut SceneReport,
) -> Result<(), Failure> {
    let path = candidate_file(job, folder)?;
    let golden = Golden::read(&job.golden)?;
    let candidate = Candidate::read(&path)?;
    golden.warnings.iter().chain(&candidate.warnings).for_each(|warning| terminal::warn(warning));
    report.file = path.display().to_string();
    [report.width, report.height] = [candidate.mean.width, candidate.mean.height];
    report.golden_spp = Some(golden.samples);
    report.spp = candidate.samples;
    if [golden.mean.width, golden.mean.height] != [report.width, report.height] {
        report.verdict = TestOutcome::Differs;
        let Golden { mean, .. } = &golden;
        report.message = Some(format!(
            "the picture has {}x{} pixels, and its golden picture {}x{}",
            report.width, report.height, mean.width, mean.height
        ));
        return Ok(());
    }
    let compared = judge_candidate(&golden, &candidate, settings)?;
    report.differences = compared.rejected().map(Difference::from).collect();
    report.suspects = report.differences.len();
    let map = flip(&candidate.mean, &golden.mean, PIXELS_PER_DEGREE)?;
    report.flip = Some(map.mean());
    if candidate.samples.is_none() {
        report.message = Some(
            "the picture does not say how its samples vary, so its noise is what the differences of a tile's pixels scatter by"
                .to_owned(),
        );
    }
    report.commands.push(compare(&path, &job.golden).to_string());
    let differs = !report.differences.is_empty() || looks_different(arguments, report);
    report.verdict = if differs { TestOutcome::Differs } else { TestOutcome::Agrees };
    report.pictures = Some(TestPictures { golden: golden.mean, now: candidate.mean, tiles: compared, flip: map });
    Ok(())
}

/// The command that shows how a picture and its golden picture differ.
fn compare(picture: &Path, golden: &Path) -> CommandLine {
    CommandLine::new("compare").with(picture).with(golden).with_option("--html", "now.html")
}

/// The picture of a scene in a folder, whatever its format.
fn candidate_file(job: &Job, folder: &Path) -> Result<PathBuf, Failure> {
    let is_of_scene = |path: &Path| path.file_stem() == Some(OsStr::new(&job.name)) && PictureFormat::from_path(path).is_some();
    let entries = std::fs::read_dir(folder)
        .map_err(|error| Failure::BadScene(format!("cannot read the folder {}: {error}", folder.display())))?;
    let mut found: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).filter(|path| is_of_scene(path)).collect();
    found.sort();
    match found.as_slice() {
        [one] => Ok(one.clone()),
        [] => Err(Failure::BadScene(format!(
            "{} has no picture {} with an ending of {PICTURE_ENDINGS}",
            folder.display(),
            job.name
        ))),
        several => {
            let names: Vec<String> = several.iter().map(|path| path.display().to_string()).collect();
            Err(Failure::BadScene(format!("several pictures are of one scene: {}", names.join(", "))))
        }
    }
}

impl From<PictureTestError> for Failure {
    fn from(error: PictureTestError) -> Self {
        match error {
            PictureTestError::Render(error) => Self::Render(error),
            PictureTestError::Picture(error) => Self::Picture(error),
            PictureTestError::Output(error) => Self::Output(error),
            PictureTestError::Unsuitable(message) => Self::BadScene(message),
            PictureTestError::Interrupted => Self::Interrupted,
        }
    }
}
