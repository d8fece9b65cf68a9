//! `gpt render`.

use std::path::PathBuf;
use std::time::Instant;

use gpt::load;
use gpt::output::{AtomicFile, PictureFormat, PictureSpec, Provenance, check_target};
use gpt::plan::PlanOptions;
use gpt::render::choice::{Choice, ChosenRenderer};
use gpt::render::progressive::error::ErrorEstimate;
use gpt::render::progressive::{self, Goal, Outcome, STREAMS, Stop};
use gpt::renderer::{RenderError, RenderReport, RenderRequest, Renderer};
use gpt::scene::{self, Scene};

use super::arguments::RenderArguments;
use super::exit::{Exit, Failure};
use super::pictures::{Pictures, output_formats};
use super::progress::Progress;
use super::stats::Stats;
use super::{interrupt, settings, terminal};

/// Renders a scene to its picture files. Everything that can be wrong without rendering is found before.
pub fn run(arguments: &RenderArguments) -> Result<Exit, Failure> {
    let started = Instant::now();
    let mut outputs = output_formats(&arguments.outputs, arguments.stats.as_deref())?;
    interrupt::install()?;

    let options = PlanOptions { pixel_list: arguments.goal.adaptive, ..arguments.traversal.options_on(&arguments.device)? };
    let choice = Choice::begin(&arguments.device, &options);
    let scene = load(arguments)?;
    if outputs.is_empty() {
        let default = PathBuf::from(format!("{}.exr", scene.name));
        check_target(&default)?;
        outputs.push((default, PictureFormat::Exr));
    }
    let scene_hash = scene::digest(&scene);
    let load_seconds = started.elapsed().as_secs_f64();

    let (outcome, pictures) = render(arguments, (choice, &options), &scene, &outputs, &scene_hash, started)?;
    let anything = pictures.any();
    let summary = pictures.finish()?;

    let report = outcome.report;
    let mut stats = Stats::new(&scene, &report);
    stats.spp_done = summary.fewest_samples;
    stats.stopped_by = stop_name(outcome.stop);
    stats.adaptive = arguments.goal.adaptive;
    stats.target_error = arguments.goal.target_error;
    stats.expected_error = outcome.error.map(|error| error.mean);
    stats.error_bound = outcome.error.map(|error| error.upper);
    stats.scene_hash = scene_hash;
    stats.first_sample = arguments.estimate.first_sample;
    stats.mean = summary.mean;
    if anything {
        stats.outputs = outputs.iter().map(|(path, _)| path.display().to_string()).collect();
    }
    stats.seconds.load = load_seconds;
    stats.seconds.write = summary.seconds_writing;
    stats.seconds.total = started.elapsed().as_secs_f64();
    if let Some(path) = &arguments.stats {
        let json = serde_json::to_string_pretty(&stats).map_err(|error| Failure::Other(error.to_string()))?;
        AtomicFile::write(path, (json + "\n").as_bytes())?;
    }
    tell(&stats, summary.black, arguments.quiet);
    tell_of_error(arguments, outcome.error, outcome.stop);
    Ok(exit(&report, arguments.strict))
}

/// The scene as the file and the command line together want it.
fn load(arguments: &RenderArguments) -> Result<Scene, Failure> {
    let mut scene = load::load(arguments.scene.as_deref())?;
    for warning in &scene.warnings {
        terminal::warn(warning);
    }
    settings::apply(&arguments.estimate, &mut scene)?;
    let spp = scene.render.spp;
    // Two samples from each stream, so that there is something to look at and something to go on to.
    if arguments.goal.target_error.is_some() && spp < 2 * STREAMS {
        return Err(Failure::usage(format!("--target-error needs at least --spp {}; {spp} are allowed", 2 * STREAMS)));
    }
    Ok(scene)
}

/// Makes the scene ready on its device, and renders it into files that are not in their places yet.
fn render(
    arguments: &RenderArguments,
    (choice, options): (Choice, &PlanOptions),
    scene: &Scene,
    outputs: &[(PathBuf, PictureFormat)],
    scene_hash: &str,
    started: Instant,
) -> Result<(Outcome, Pictures), Failure> {
    let ChosenRenderer { mut renderer, notice } = choice.renderer(scene, options)?;
    if let Some(notice) = notice {
        terminal::note(&notice);
    }
    let [width, height] = scene.film.size;
    let provenance = Provenance {
        scene: scene.name.clone(),
        scene_hash: scene_hash.to_owned(),
        settings: scene.render.clone(),
        filter: scene.film.filter,
        first_sample: arguments.estimate.first_sample,
        target_error: arguments.goal.target_error,
        adaptive: arguments.goal.adaptive,
        device: renderer.device().to_owned(),
    };
    let mut pictures = Pictures::create(outputs, &PictureSpec { width, height, exposure: arguments.exposure, provenance })?;
    let progress = Progress::new(arguments.quiet);
    let outcome = render_to(renderer.as_mut(), arguments, scene, started, &progress, &mut pictures);
    progress.clear();
    let outcome = outcome?;
    if pictures.any() || outcome.report.interrupted {
        Ok((outcome, pictures))
    } else {
        Err(RenderError::Internal("the renderer finished without delivering a picture".to_owned()).into())
    }
}

/// Renders all samples, band by band, or, where something else may end the render, step by step.
fn render_to(
    renderer: &mut dyn Renderer,
    arguments: &RenderArguments,
    scene: &Scene,
    started: Instant,
    progress: &Progress,
    pictures: &mut Pictures,
) -> Result<Outcome, RenderError> {
    let first_sample = arguments.estimate.first_sample;
    let samples = first_sample..first_sample + scene.render.spp;
    let on_band = &mut |band| pictures.write_band(band);
    let wish = &arguments.goal;
    if wish.time_limit.is_none() && wish.target_error.is_none() && !wish.adaptive {
        let report = renderer.render(&RenderRequest { rows: 0..scene.film.size[1], samples }, progress, on_band)?;
        let stop = if report.interrupted { Stop::Interrupted } else { Stop::Samples };
        return Ok(Outcome { report, stop, error: None });
    }
    // A limit beyond what the clock can tell is none.
    let deadline = wish.time_limit.and_then(|limit| started.checked_add(limit));
    let goal = Goal { samples, deadline, target_error: wish.target_error, adaptive: wish.adaptive };
    progressive::render(renderer, scene.film.size, scene.render.seed, &goal, progress, on_band)
}

fn stop_name(stop: Stop) -> &'static str {
    match stop {
        Stop::Samples => "samples",
        Stop::TimeLimit => "time_limit",
        Stop::TargetError => "target_error",
        Stop::Interrupted => "interrupted",
    }
}

/// Whether the picture is as good as was asked for.
fn tell_of_error(arguments: &RenderArguments, error: Option<ErrorEstimate>, stop: Stop) {
    let (Some(target), Some(ErrorEstimate { mean, upper })) = (arguments.goal.target_error, error) else { return };
    if stop != Stop::TargetError {
        terminal::warn(&format!(
            "the relative mean squared error of {target} was not reached: {mean:.3e} is expected, and it is below {upper:.3e} with \
             95 % confidence"
        ));
    } else if !arguments.quiet {
        terminal::note(&format!("relative mean squared error: {mean:.3e} expected, below {upper:.3e} with 95 % confidence"));
    }
}

/// What a person should know when it is over.
fn tell(stats: &Stats, black: bool, quiet: bool) {
    if stats.non_finite_samples > 0 {
        terminal::warn(&format!("{} samples were not finite and are left out of the picture", stats.non_finite_samples));
    }
    if black && !stats.interrupted {
        terminal::warn("every pixel is black: does the camera look at the scene, and does light reach what it sees?");
    }
    if stats.outputs.is_empty() {
        terminal::note("interrupted before anything was rendered; nothing is saved");
    } else if !quiet {
        let sample_rate = terminal::with_unit(stats.samples_per_second, "sample/s");
        terminal::note(&format!(
            "{}: {}x{}, {} spp{} in {:.2} s on {} ({sample_rate})",
            stats.outputs.join(", "),
            stats.width,
            stats.height,
            if stats.interrupted { stats.spp } else { stats.spp_done },
            match stats.stopped_by {
                "interrupted" => " wanted, interrupted".to_owned(),
                "time_limit" => format!(" of {} when time was up", stats.spp),
                "target_error" => format!(" of {} when the error was reached", stats.spp),
                _ => String::new(),
            },
            stats.seconds.total,
            stats.device,
        ));
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
