//! `gpt render`.

use std::path::PathBuf;
use std::time::Instant;

use gpt::load;
use gpt::output::{AtomicFile, PictureFormat, PictureSpec, Provenance, check_target};
use gpt::render::choice::Choice;
use gpt::render::progressive::STREAMS;
use gpt::renderer::{RenderError, RenderReport};
use gpt::{ErrorEstimate, Outcome, RenderOptions, Renderer, Scene, Stop};

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

    let options = RenderOptions {
        device: arguments.device.clone(),
        first_sample: arguments.estimate.first_sample,
        time_limit: arguments.goal.time_limit,
        target_error: arguments.goal.target_error,
        adaptive: arguments.goal.adaptive,
        plan: arguments.traversal.options_on(&arguments.device)?,
        ..RenderOptions::default()
    };
    // The device opens while the scene is read.
    let choice = Renderer::begin(&options);
    let scene = load(arguments)?;
    if outputs.is_empty() {
        let default = PathBuf::from(format!("{}.exr", scene.name));
        check_target(&default)?;
        outputs.push((default, PictureFormat::Exr));
    }
    let load_seconds = started.elapsed().as_secs_f64();

    let (outcome, pictures, provenance) = render(arguments, (choice, &options), &scene, &outputs, started)?;
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
    stats.scene_hash = provenance.scene_hash;
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
    let mut scene = load::load_with(arguments.scene.as_deref(), &arguments.access.options(arguments.strict))?;
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
    (choice, options): (Choice, &RenderOptions),
    scene: &Scene,
    outputs: &[(PathBuf, PictureFormat)],
    started: Instant,
) -> Result<(Outcome, Pictures, Provenance), Failure> {
    let mut renderer = Renderer::on(choice, scene, options)?;
    if let Some(notice) = renderer.notice() {
        terminal::note(notice);
    }
    let [width, height] = renderer.size();
    let provenance = renderer.provenance().clone();
    let spec = PictureSpec { width, height, exposure: arguments.exposure, provenance: Some(provenance.clone()) };
    let mut pictures = Pictures::create(outputs, &spec)?;
    let progress = Progress::new(arguments.quiet);
    let outcome = renderer.render_from(started, &progress, &mut |band| pictures.write_band(band));
    progress.clear();
    let outcome = outcome?;
    if pictures.any() || outcome.report.interrupted {
        Ok((outcome, pictures, provenance))
    } else {
        Err(RenderError::Internal("the renderer finished without delivering a picture".to_owned()).into())
    }
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
            if stats.interrupted { stats.settings.spp } else { stats.spp_done },
            match stats.stopped_by {
                "interrupted" => " wanted, interrupted".to_owned(),
                "time_limit" => format!(" of {} when time was up", stats.settings.spp),
                "target_error" => format!(" of {} when the error was reached", stats.settings.spp),
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
