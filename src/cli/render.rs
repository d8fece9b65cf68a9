//! `gpt render`.

use std::path::{Path, PathBuf};
use std::time::Instant;

use gpt::denoise::library::Library;
use gpt::learn::{self, Effort, Pace};
use gpt::load::{self, FileLog, LoadOptions, SceneSource};
use gpt::output::{PartSpec, PictureFormat, PictureSpec, Provenance, check_target};
use gpt::plan::host::{HostNeeds, host_memory};
use gpt::plan::memory::FILM_BYTES;
use gpt::plan::{DeviceLimits, PlanOptions};
use gpt::render::progressive::STREAMS;
use gpt::render::stats::Stats;
use gpt::renderer::{DeviceChoice, RenderError, RenderReport};
use gpt::scene_writer;
use gpt::{Outcome, RenderOptions, Renderer, Scene, Stop};

use super::arguments::RenderArguments;
use super::checkpoint;
use super::exit::{Exit, Failure};
use super::frames::{FrameTime, Span, named};
use super::layers::Layers;
use super::machine_progress::Needs;
use super::pictures::{PictureSummary, Pictures, is_stdout, output_formats};
use super::progress::Progress;
use super::ready::Ready;
use super::render_summary::{tell, tell_of_error, write_stats};
use super::sequence::{Done, Frame, Sequence, has_own_stats, tell_of_keyframes};
use super::view::{Live, Phase, Watching};
use super::{denoise, first_look, interrupt, intervals, layers, outputs, reading, settings, terminal, watch};

/// Renders a scene to its picture files. Everything that can be wrong without rendering is found before.
pub fn run(arguments: &RenderArguments) -> Result<Exit, Failure> {
    let started = Instant::now();
    let frames = &arguments.frames;
    frames.check_names("-o", arguments.outputs.iter().map(PathBuf::as_path))?;
    let first = |path: &Path| named(path, frames.first_number());
    let first_outputs: Vec<PathBuf> = arguments.outputs.iter().map(|path| first(path)).collect();
    let others = written_beside(arguments, &first_outputs);
    let formats = output_formats(&first_outputs, others.iter().map(PathBuf::as_path), named_inputs(arguments))?;
    let outputs: Vec<(PathBuf, PictureFormat)> =
        arguments.outputs.iter().zip(formats).map(|(path, (_, format))| (path.clone(), format)).collect();
    let mut on_stdout = arguments.outputs.iter().map(PathBuf::as_path).chain(arguments.stats.as_deref());
    if arguments.progress.is_some() && on_stdout.any(is_stdout) {
        return Err(Failure::usage("--progress tells of progress on standard output, and -o - or --stats - write there"));
    }
    if arguments.denoise {
        if !outputs.is_empty() {
            denoise::raw_output(&outputs)?;
        }
        // Its absence is reported before anything is rendered. Parts are denoised once they are joined.
        if !arguments.estimate.is_part() {
            Library::open()?;
        }
    }
    interrupt::install()?;
    interrupt::preparation_begins();

    let device = device(arguments)?;
    let options = RenderOptions {
        device: device.clone(),
        first_sample: arguments.estimate.first_sample.unwrap_or(0),
        crop: arguments.estimate.crop,
        time_limit: arguments.goal.time_limit,
        target_error: arguments.goal.target_error,
        adaptive: arguments.goal.adaptive,
        plan: PlanOptions { device_timeout: arguments.device_timeout, ..arguments.traversal.options_on(&device)? },
        ..RenderOptions::default()
    };
    watch::check(arguments)?;
    // The device opens while the scene is read.
    let ready = Ready::Device(Renderer::begin(&options));
    let live = Live::start(&arguments.live, &arguments.display.display())?;
    if arguments.live.watch {
        let again =
            |ready: &mut Option<Ready>, live: &Live, started: Instant| scene(arguments, &options, &outputs, ready, live, started);
        return watch::run(ready, live, started, &again);
    }
    let exit = scene(arguments, &options, &outputs, &mut Some(ready), &live, started)?;
    live.close(exit != Exit::Interrupted);
    Ok(exit)
}

/// Files that are written beside the pictures.
fn written_beside(arguments: &RenderArguments, first_outputs: &[PathBuf]) -> Vec<PathBuf> {
    let stats = arguments.stats.as_deref().map(|path| named(path, arguments.frames.first_number()));
    let is_denoised = arguments.denoise && !arguments.estimate.is_part();
    let state = checkpoint::state_beside(&arguments.checkpoint, first_outputs);
    let others = stats.into_iter().chain(arguments.save_scene.clone()).chain(state);
    others.chain(denoise::files_beside(is_denoised, first_outputs)).collect()
}

/// Files that are read because the command line names them.
fn named_inputs(arguments: &RenderArguments) -> impl Iterator<Item = &Path> {
    let scene = arguments.scene.as_deref().map(Path::new).filter(|path| !is_stdout(path));
    scene.into_iter().chain(arguments.environment.as_deref())
}

/// Reads the scene and renders it. What is ready when it begins stays so where the scene is wrong; without it a device is opened. What rendered the
/// scene is then ready for another one.
///
/// # Errors
/// Errors of the scene, the device, the files and the arguments.
fn scene(
    arguments: &RenderArguments,
    options: &RenderOptions,
    named_outputs: &[(PathBuf, PictureFormat)],
    ready: &mut Option<Ready>,
    live: &Live,
    started: Instant,
) -> Result<Exit, Failure> {
    let frames = &arguments.frames;
    let first = |path: &Path| named(path, frames.first_number());
    let mut scene = load(arguments, live.files())?;
    live.begin(&scene.name);
    let mut outputs = named_outputs.to_vec();
    if outputs.is_empty() {
        for (ending, format) in [("exr", PictureFormat::Exr), ("png", PictureFormat::Png)] {
            let number = frames.first_number().map_or("", |_| ".####");
            let default = PathBuf::from(format!("{}{number}.{ending}", scene.name));
            outputs::check([first(&default).as_path()], None)?;
            outputs.push((default, format));
        }
    }
    let first_files: Vec<_> = outputs.iter().map(|(path, format)| (first(path), *format)).collect();
    check_inputs(&first_files, arguments, live.files())?;
    if let Some(path) = &arguments.save_scene {
        save_scene(&scene, path, live.files())?;
    }
    checkpoint::check(&arguments.checkpoint, &outputs)?;
    let layers = layers::of_files(arguments, &scene, &outputs)?;
    let options = &intervals::asked_for(arguments, (&mut scene, &layers), options)?;
    layers::check(arguments, options, (&scene, &layers))?;
    let times = frames.times(&scene.animation)?;
    // All frames draw from lights in the same way, whichever of them are rendered.
    let effort = Effort { pace: Pace::Processor, time_limit: options.time_limit };
    let scene = if times == [FrameTime::Rest] { scene } else { learn::with_lights_settled(&scene, effort)? };
    if times == [FrameTime::Rest] && !arguments.quiet {
        tell_of_keyframes(&scene);
    }
    let load_seconds = started.elapsed().as_secs_f64();
    let sequence = Sequence { arguments, options, scene: &scene, outputs: &outputs, times: &times, started, load_seconds, live };
    let begun = ready.take().unwrap_or_else(|| Ready::Device(Renderer::begin(options)));
    let (exit, left) = sequence.render(begun, &frame)?;
    *ready = left.map(Ready::for_another_scene);
    Ok(exit)
}

/// Renders a picture to its files.
///
/// # Errors
/// Errors of the device, the files and the arguments.
fn frame(frame: Frame<'_>, ready: Ready) -> Result<Done, Failure> {
    let Frame { arguments, options, scene, outputs, time, started, load_seconds, span, live } = frame;
    check_inputs(outputs, arguments, live.files())?;
    let wanted = layers::of_files(arguments, scene, outputs)?;
    let shown = PictureSpec {
        display: arguments.display.display(),
        exr: arguments.exr.options(),
        part: part(arguments, scene.film.size),
        layer_names: wanted.clone(),
        ..PictureSpec::default()
    };
    if arguments.checkpoint.resume && checkpoint::all_are_finished(outputs, (scene, ready.bulk_digest(scene)), options, &shown) {
        checkpoint::remove_beside_finished(&arguments.checkpoint, outputs, scene);
        if !arguments.quiet {
            terminal::note(&format!("{}: finished before, nothing is left to render", names(outputs)));
        }
        return Ok(Done::Before(ready));
    }

    let progress = Progress::of_frame(arguments.quiet, arguments.progress, span);
    let size = options.crop.map_or(scene.film.size, |[_, _, width, height]| [width, height]);
    let watching = live.watching(&progress, size[1]);
    let ready = first_look::show((live, &watching), ready, (scene, options), &wanted).inspect_err(|_| progress.clear())?;
    let layers =
        match layers::render(arguments, options, (scene, wanted), outputs, (started, &progress, &watching.without_rows())) {
            Err(Failure::Interrupted) if live.restarts() => return Ok(Done::Outdated(None)),
            layers => layers?,
        };
    live.layers(layers.channels(), size, layers.groups(scene));
    let needs = needs(arguments, scene, options);
    progress.start(needs);
    let mut renderer = ready.renderer(scene, options).inspect_err(|_| progress.clear())?;
    live.on_device(renderer.device());
    let Rendered { outcome, mut pictures, provenance, mut kept } =
        render(arguments, (&mut renderer, span), (outputs, layers), (started, &progress, &watching))?;
    let broke_off = outcome.stop == Stop::Interrupted;
    if broke_off && live.restarts() {
        return Ok(Done::Outdated(Some(Box::new(renderer))));
    }
    if broke_off && kept.save() {
        pictures.give_up_beside_finished();
    }
    let summary = pictures.finish(broke_off);
    if !broke_off && summary.failures.is_empty() {
        kept.remove();
        checkpoint::remove_of_layers(&arguments.checkpoint, outputs, scene);
    }

    let mut stats = Stats::new(scene, options, &outcome);
    stats.frame = time.frame();
    stats.notice = renderer.notice().map(str::to_owned);
    stats.resumed(kept.resumed_samples);
    stats.expected_host_bytes = Some(needs.host_bytes);
    stats.scene_hash = provenance.scene_hash;
    stats.picture(scene, &outcome, summary.samples[0], summary.mean);
    stats.outputs = summary.places.iter().map(|path| path.display().to_string()).collect();
    stats.seconds.load = load_seconds;
    stats.seconds.write = summary.seconds_writing;
    stats.seconds.total = started.elapsed().as_secs_f64();
    if let Some(path) = arguments.stats.as_ref().filter(|path| has_own_stats(arguments, path)) {
        write_stats(&named(path, time.number()), &stats)?;
    }
    tell(&stats, &summary, arguments.quiet);
    kept.tell();
    progress.end(!broke_off && summary.failures.is_empty(), &stats.outputs);
    tell_of_error(arguments, scene, outcome.error, outcome.stop);
    intervals::tell(arguments, scene, &outcome);
    if !summary.failures.is_empty() {
        return Err(Failure::Outputs(summary.failures));
    }
    if arguments.denoise && arguments.estimate.is_part() && !arguments.quiet {
        terminal::note("--denoise: the part has what denoising needs; `gpt merge --denoise` denoises the whole picture");
    } else if arguments.denoise && !broke_off && !arguments.estimate.is_part() {
        denoise::denoise_render(&Library::open()?, outputs, arguments.display.display(), arguments.quiet)?;
    }
    live.end(if broke_off { Phase::Stopped } else { Phase::Finished }, "", &stats.outputs);
    let exit = exit(&outcome.report, arguments.strict);
    Ok(Done::Now { exit, renderer: Box::new(renderer), stats: Box::new(stats) })
}

/// No output is one of the files that the scene was read from.
fn check_inputs(outputs: &[(PathBuf, PictureFormat)], arguments: &RenderArguments, read: &FileLog) -> Result<(), Failure> {
    let outputs: Vec<PathBuf> = outputs.iter().map(|(path, _)| path.clone()).collect();
    let others = written_beside(arguments, &outputs);
    outputs::check_unread(outputs.iter().chain(&others).map(PathBuf::as_path), read)
}

/// Memory that is reported before it is taken: 32 bytes a pixel of the rows that the film has at a time, and
/// all that the host needs.
fn needs(arguments: &RenderArguments, scene: &Scene, options: &RenderOptions) -> Needs {
    let [width, height] = options.crop.map_or(scene.film.size, |[_, _, width, height]| [width, height]);
    let film = scene.film.size.map(u64::from).iter().product::<u64>();
    let kept = film.min(DeviceLimits::default().film_pixels).min(options.most_film_pixels().unwrap_or(u64::MAX));
    let film_bytes = kept * FILM_BYTES;
    let of_host = HostNeeds {
        // A region keeps whole rows of the film.
        pixels: options.most_film_pixels().map_or(u64::from(width) * u64::from(height), |most| most.min(film)),
        on_cpu: options.device == DeviceChoice::Cpu,
        adaptive: options.adaptive,
        target_error: options.target_error.is_some(),
        intervals: options.interval.is_some(),
        checkpoint: arguments.checkpoint.is_asked_for(),
    };
    Needs { width, height, film_bytes, host_bytes: host_memory(scene, &of_host).total() }
}

/// The pictures by name, for messages.
fn names(outputs: &[(PathBuf, PictureFormat)]) -> String {
    outputs.iter().map(|(path, _)| path.display().to_string()).collect::<Vec<_>>().join(", ")
}

/// Writes the scene as a file, with the settings that the command line gave it.
fn save_scene(scene: &Scene, path: &Path, read: &FileLog) -> Result<(), Failure> {
    if !path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("toml")) {
        return Err(Failure::usage(format!("--save-scene {}: a scene file's name ends in .toml", path.display())));
    }
    check_target(path)?;
    scene_writer::save_scene_beside(scene, path, read)?;
    Ok(())
}

/// The device that is asked for.
fn device(arguments: &RenderArguments) -> Result<DeviceChoice, Failure> {
    match (&arguments.device, arguments.require_device) {
        (DeviceChoice::Cpu, true) => {
            Err(Failure::usage("--require-device asks for a graphics device, and --device cpu for none"))
        }
        (DeviceChoice::Auto, true) => Ok(DeviceChoice::Gpu),
        (device, _) => Ok(device.clone()),
    }
}

/// The scene as the file and the command line together want it.
fn load(arguments: &RenderArguments, log: &FileLog) -> Result<Scene, Failure> {
    let source = SceneSource::parse(arguments.scene.as_deref())?;
    let view = arguments.model.view(&source, arguments.environment.clone(), arguments.estimate.size)?;
    let options = LoadOptions { view, log: log.clone(), ..arguments.access.options(arguments.strict) };
    let mut scene = reading::shown(arguments.quiet, &options.progress, || source.load(&options))?;
    for warning in scene.warnings.iter().chain(&scene.precision_warnings()) {
        terminal::warn(warning);
    }
    if let Some(summary) = scene.import_report.summary() {
        if arguments.strict {
            return Err(load::SceneError::in_file(&scene.name, summary).into());
        }
        terminal::warn(&summary);
    }
    settings::apply(&arguments.estimate, &mut scene)?;
    let spp = scene.render.spp;
    // Two samples from each stream, so that there is something to look at and something to go on to.
    if arguments.goal.target_error.is_some() && spp < 2 * STREAMS {
        return Err(Failure::usage(format!("--target-error needs at least --spp {}; {spp} are allowed", 2 * STREAMS)));
    }
    Ok(scene)
}

/// A render that is over; its files are not in their places yet.
struct Rendered {
    outcome: Outcome,
    pictures: Pictures,
    provenance: Provenance,
    kept: checkpoint::Kept,
}

/// Renders what is ready on its device.
fn render(
    arguments: &RenderArguments,
    (renderer, span): (&mut Renderer, Option<Span>),
    (outputs, layers): (&[(PathBuf, PictureFormat)], Layers),
    (started, progress, watching): (Instant, &Progress, &Watching<'_>),
) -> Result<Rendered, Failure> {
    if let Some(notice) = renderer.notice().filter(|_| span.is_none_or(|span| span.index == 0)) {
        progress.clear();
        terminal::note(notice);
    }
    let [width, height] = renderer.size();
    let part = part(arguments, renderer.film());
    let provenance = renderer.provenance().clone();
    let (display, exr) = (arguments.display.display(), arguments.exr.options());
    let spec = PictureSpec { width, height, display, exr, provenance: Some(provenance.clone()), part, ..PictureSpec::default() };
    let spec = layers.in_picture(spec);
    let mut kept = checkpoint::Kept::begin(&arguments.checkpoint, renderer, outputs, started, arguments.quiet)?;
    let mut pictures = Pictures::create(outputs, &spec)?;
    let outcome = renderer.render_from(started, watching, kept.checkpoint.as_mut(), &mut |band| {
        watching.band(&band);
        pictures.write_band(band)
    });
    progress.clear();
    match outcome {
        // The files themselves say more than that none could take any more.
        Err(RenderError::Output(error)) => {
            let failures = pictures.take_failures();
            Err(if failures.is_empty() { RenderError::Output(error).into() } else { Failure::Outputs(failures) })
        }
        Err(error) => {
            let is_kept = kept.save();
            kept.tell();
            if pictures.any() && matches!(error, RenderError::DeviceLost(_)) {
                if is_kept {
                    pictures.give_up_beside_finished();
                }
                save_rest(pictures);
            }
            Err(error.into())
        }
        Ok(Outcome { stop: Stop::TimeLimit, .. }) if !pictures.any() => Err(Failure::Other(
            "the time was up before a sample of every pixel was finished; nothing is saved: paths in this scene may hardly ever end, \
             see --max-depth and --roulette-depth"
                .to_owned(),
        )),
        Ok(outcome) if pictures.any() || outcome.report.interrupted => Ok(Rendered { outcome, pictures, provenance, kept }),
        Ok(_) => Err(RenderError::Internal("the renderer finished without delivering a picture".to_owned()).into()),
    }
}

/// The place of the picture in the whole, if it is a part of one.
fn part(arguments: &RenderArguments, film: [u32; 2]) -> Option<PartSpec> {
    let origin = arguments.estimate.crop.map_or([0, 0], |[x, y, ..]| [x, y]);
    arguments.estimate.is_part().then_some(PartSpec { film, origin })
}

/// Saves what there is of a picture whose render failed, and says where.
fn save_rest(pictures: Pictures) {
    let PictureSummary { places, failures, samples: [fewest, most], .. } = pictures.finish(true);
    let done = if fewest == most { fewest.to_string() } else { format!("{fewest} to {most}") };
    for place in places {
        terminal::note(&format!("{}: what was rendered before, {done} spp, is saved", place.display()));
    }
    for failure in failures {
        terminal::warn(&failure.to_string());
    }
}

fn exit(report: &RenderReport, strict: bool) -> Exit {
    if report.interrupted {
        Exit::Interrupted
    } else if strict && report.non_finite_samples > 0 {
        Exit::NonFinite
    } else {
        Exit::Done
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_report_decides_the_exit_code() {
        let report =
            |interrupted, non_finite_samples| RenderReport { interrupted, non_finite_samples, ..RenderReport::default() };
        assert_eq!(exit(&report(false, 0), true), Exit::Done);
        assert_eq!(exit(&report(false, 1), false), Exit::Done);
        assert_eq!(exit(&report(false, 1), true), Exit::NonFinite);
        assert_eq!(exit(&report(true, 1), true), Exit::Interrupted);
    }
}
