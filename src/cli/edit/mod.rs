//! `gpt edit`: the materials of a scene file, changed on a page beside the picture, which begins again at each change.

mod arguments;
mod changes;
mod edited_file;
mod looking;
mod references;
mod requests;
#[cfg(test)]
mod tests;
mod values;

use std::sync::Arc;
use std::time::Instant;

use gpt::plan::PlanOptions;
use gpt::scene::{Guiding, LightChoice, LightSampling, NumberOrAuto, RenderSettings};
use gpt::{RenderOptions, Renderer, Stop};

pub use arguments::EditArguments;
use edited_file::EditedFile;

use super::exit::{Exit, Failure};
use super::progress::Progress;
use super::ready::Ready;
use super::view::{Live, Phase};
use super::{interrupt, scene_error, settings, terminal};

/// Shows the page until Ctrl-C, and renders the scene whenever it is changed.
///
/// # Errors
/// A scene file that cannot be edited, no device, and no server. Mistakes in the scene are told on the page, where they can be repaired.
pub fn run(arguments: &EditArguments) -> Result<Exit, Failure> {
    let file = Arc::new(EditedFile::open(&arguments.file()?)?);
    let options = RenderOptions {
        device: arguments.device.clone(),
        plan: PlanOptions { device_timeout: arguments.device_timeout, ..arguments.traversal.options_on(&arguments.device)? },
        ..RenderOptions::default()
    };
    interrupt::install()?;
    // A render leaves nothing to be saved.
    interrupt::render_is_over();
    let mut ready = Some(Ready::Device(Renderer::begin(&options)));
    let live = Live::with_panel(file.clone(), file.changed())?;
    let editing = Editing { arguments, options: &options, file: &file, live: &live };
    let mut is_first = true;
    while !interrupt::requested() {
        live.accept_changes();
        if let Err(failure) = editing.render(&mut ready, is_first) {
            let is_mistake = Exit::from(&failure) == Exit::Input;
            if is_first && !is_mistake {
                return Err(failure);
            }
            live.end(Phase::Failed, &scene_error::drawn(&failure, false), &[]);
            if !is_mistake {
                terminal::print_error(&failure);
            }
        }
        is_first = false;
        live.wait_for_change();
    }
    live.close(false);
    if file.is_unsaved() {
        terminal::warn(&format!("{}: changes that were not saved are lost", arguments.scene.to_string_lossy()));
    }
    Ok(Exit::Done)
}

/// Settles what a render may learn before its first sample: learning would begin anew at each change. The picture's expectation is the same.
fn learn_nothing(settings: &mut RenderSettings) {
    let mut plain = settings.clone();
    if plain.light_choice == LightChoice::Auto {
        plain.light_choice = LightChoice::Tree;
    }
    if plain.light_sampling == LightSampling::Auto {
        plain.light_sampling = LightSampling::Cone;
    }
    if plain.light_samples == NumberOrAuto::Auto {
        plain.light_samples = NumberOrAuto::Number(1);
    }
    if plain.guiding == Guiding::Auto {
        plain.guiding = Guiding::Off;
    }
    if plain.check().is_ok() {
        *settings = plain;
    }
}

/// A scene that is rendered while it is edited.
struct Editing<'a> {
    arguments: &'a EditArguments,
    options: &'a RenderOptions,
    file: &'a EditedFile,
    live: &'a Live,
}

impl Editing<'_> {
    /// Renders the scene as it is now, until it is finished or changed. What rendered it is then ready for the next one.
    ///
    /// # Errors
    /// Mistakes in the scene, and errors of the device.
    fn render(&self, ready: &mut Option<Ready>, is_first: bool) -> Result<(), Failure> {
        let started = Instant::now();
        let options = gpt::load::LoadOptions { log: self.live.files().clone(), ..self.arguments.files.options(false) };
        let mut scene = self.file.scene(&options)?;
        settings::apply_to(self.arguments.size, &self.arguments.settings, &mut scene)?;
        learn_nothing(&mut scene.render);
        if is_first {
            scene.warnings.iter().chain(&scene.precision_warnings()).for_each(|warning| terminal::warn(warning));
        }
        self.live.begin(&scene.name);
        let progress = Progress::of_frame(true, None, None);
        let watching = self.live.watching(&progress, scene.film.size[1]);
        let begun = ready.take().unwrap_or_else(|| Ready::Device(Renderer::begin(self.options)));
        let mut renderer = begun.renderer(&scene, self.options)?;
        if let Some(notice) = renderer.notice().filter(|_| is_first) {
            terminal::note(notice);
        }
        self.live.on_device(renderer.device());
        let outcome = renderer.render_from(started, &watching, None, &mut |band| {
            watching.band(&band);
            Ok(())
        })?;
        *ready = Some(Ready::Other(Box::new(renderer), Box::new(scene)));
        if outcome.stop != Stop::Interrupted {
            self.live.end(Phase::Finished, "", &[]);
        }
        Ok(())
    }
}
