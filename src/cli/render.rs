//! `gpt render`.

use std::path::PathBuf;
use std::time::Instant;

use gpt::output::{AtomicFile, PictureFormat, PictureSpec, Provenance, check_target};
use gpt::render::{RenderError, RenderReport, RenderRequest};
use gpt::renderer::{self, ChosenRenderer};
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

    let scene = load(arguments)?;
    if outputs.is_empty() {
        let default = PathBuf::from(format!("{}.exr", scene.name));
        check_target(&default)?;
        outputs.push((default, PictureFormat::Exr));
    }
    let scene_hash = scene::digest(&scene);
    let load_seconds = started.elapsed().as_secs_f64();

    let (report, pictures) = render(arguments, &scene, &outputs, &scene_hash)?;
    let anything = pictures.any();
    let summary = pictures.finish()?;

    let mut stats = Stats::new(&scene, &report);
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
    Ok(exit(&report, arguments.strict))
}

/// The scene as the file and the command line together want it.
fn load(arguments: &RenderArguments) -> Result<Scene, Failure> {
    let mut scene = scene::load(arguments.scene.as_deref())?;
    for warning in &scene.warnings {
        terminal::warn(warning);
    }
    settings::apply(&arguments.estimate, &mut scene)?;
    Ok(scene)
}

/// Makes the scene ready on its device, and renders it into files that are not in their places yet.
fn render(
    arguments: &RenderArguments,
    scene: &Scene,
    outputs: &[(PathBuf, PictureFormat)],
    scene_hash: &str,
) -> Result<(RenderReport, Pictures), Failure> {
    let ChosenRenderer { mut renderer, notice } = renderer::create(scene, &arguments.device)?;
    if let Some(notice) = notice {
        terminal::note(notice);
    }
    let [width, height] = scene.film.size;
    let first_sample = arguments.estimate.first_sample;
    let provenance = Provenance {
        scene: scene.name.clone(),
        scene_hash: scene_hash.to_owned(),
        settings: scene.render.clone(),
        filter: scene.film.filter,
        first_sample,
        device: renderer.device().to_owned(),
    };
    let mut pictures = Pictures::create(outputs, &PictureSpec { width, height, exposure: arguments.exposure, provenance })?;
    let request = RenderRequest { rows: 0..height, samples: first_sample..first_sample + scene.render.spp };
    let progress = Progress::new(arguments.quiet);
    let outcome = renderer.render(&request, &progress, &mut |band| pictures.write_band(band));
    progress.clear();
    let report = outcome?;
    if pictures.any() || report.interrupted {
        Ok((report, pictures))
    } else {
        Err(RenderError::Internal("the renderer finished without delivering a picture".to_owned()).into())
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
            stats.spp,
            if stats.interrupted { " wanted, interrupted" } else { "" },
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
