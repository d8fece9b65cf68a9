//! `gpt render --watch`: again and again, on a device that stays open.

use std::time::Instant;

use gpt::load::SceneSource;

use super::arguments::RenderArguments;
use super::exit::{Exit, Failure};
use super::pictures::is_stdout;
use super::ready::Ready;
use super::view::{Live, Phase};
use super::{interrupt, terminal};

/// Checks that there is a file that can change, if the scene is to be watched.
///
/// # Errors
/// A usage error.
pub fn check(arguments: &RenderArguments) -> Result<(), Failure> {
    if !arguments.live.watch {
        return Ok(());
    }
    if arguments.outputs.iter().any(|path| is_stdout(path)) {
        return Err(Failure::usage("--watch renders again and again, and -o - can be written once"));
    }
    match SceneSource::parse(arguments.scene.as_deref())? {
        SceneSource::BuiltIn(name) => Err(Failure::Usage {
            message: format!("--watch: {name} is a built-in scene, which does not change"),
            help: Some(format!("gpt scenes {name} > {name}.toml makes a file of it")),
        }),
        SceneSource::StandardInput => Err(Failure::usage("--watch: what came on standard input does not change")),
        SceneSource::File(_) | SceneSource::Model(_) | SceneSource::Import(_) => Ok(()),
    }
}

/// Renders once: with what is ready, for the view, since a time.
type Rendering<'a> = dyn Fn(&mut Option<Ready>, &Live, Instant) -> Result<Exit, Failure> + 'a;

/// Renders the scene, and again whenever it changes, until Ctrl-C. `render` takes what is ready, leaves it ready for another scene, and is told when
/// it began.
///
/// # Errors
/// Errors that keep the first render from beginning, but for mistakes in the scene, which can be repaired.
pub fn run(ready: Ready, live: Live, mut started: Instant, render: &Rendering<'_>) -> Result<Exit, Failure> {
    let mut ready = Some(ready);
    let mut last = Exit::Done;
    let mut is_first = true;
    while !interrupt::requested() {
        live.accept_changes();
        match render(&mut ready, &live, started) {
            Ok(exit) => last = exit,
            Err(failure) => {
                let exit = Exit::from(&failure);
                if is_first && exit != Exit::Input {
                    return Err(failure);
                }
                live.end(Phase::Failed, &failure.to_string(), &[]);
                terminal::print_error(&failure);
                last = exit;
            }
        }
        is_first = false;
        live.wait_for_change();
        started = Instant::now();
    }
    live.close(false);
    Ok(last)
}
