//! The command line: arguments in, exit code out.

mod access_arguments;
mod arguments;
mod bench;
mod check;
mod checkpoint;
mod choice;
mod compare;
mod completions;
mod denoise;
mod devices;
mod difference_page;
mod edit;
mod exit;
mod export;
mod file_arguments;
mod film;
mod first_look;
mod frames;
mod import;
mod installing_arguments;
mod interrupt;
mod intervals;
mod layers;
mod machine_progress;
mod measure;
mod merge;
mod model_arguments;
mod outputs;
mod picture_arguments;
mod pictures;
mod plan;
mod progress;
mod reading;
mod ready;
mod referee;
#[cfg(test)]
mod reference_pages;
mod regroup;
mod render;
mod render_summary;
mod scene_error;
mod scenes;
mod sequence;
mod setting_flags;
mod settings;
mod shares;
mod shell;
mod terminal;
mod test;
mod test_arguments;
mod traversal;
mod typed;
mod values;
mod verified_drivers;
mod verify;
mod view;
mod watch;
mod xml;

use std::process::ExitCode;
use std::thread::{self, available_parallelism};

use arguments::Command;
use exit::Exit;
use typed::Typed;

/// Starts the threads that do the work, as many as there are cores; where the system starts no more, fewer, down to this one. They are all started now:
/// rayon panics where it cannot start them later, and a pool that failed cannot be asked for again.
fn start_threads() {
    let mut threads = available_parallelism().map_or(1, usize::from);
    while threads > 1 && !can_start(threads) {
        threads /= 2;
    }
    let mut builder = rayon::ThreadPoolBuilder::new().num_threads(threads);
    if threads == 1 {
        builder = builder.use_current_thread();
    }
    // If that fails all the same, what needs it says so.
    let _ = builder.build_global();
}

/// True where the system starts so many threads at a time. They are over when this returns.
fn can_start(threads: usize) -> bool {
    let started: Vec<_> = (0..threads).map_while(|_| thread::Builder::new().spawn(thread::park).ok()).collect();
    let can = started.len() == threads;
    for thread in started {
        thread.thread().unpark();
        // The thread does nothing that could panic.
        let _ = thread.join();
    }
    can
}

/// Parses the program's arguments, does what they say and turns the outcome into the process's exit code.
pub fn run() -> ExitCode {
    let (arguments, typed) = match Typed::parse(std::env::args_os()) {
        Ok(parsed) => parsed,
        Err(error) => {
            // Help and version are answers, not errors, though clap hands them over the same way. A closed stdout has no reader.
            let _ = error.print();
            return if error.use_stderr() { Exit::Usage.into() } else { Exit::Done.into() };
        }
    };
    start_threads();
    let outcome = match arguments.command {
        Command::Render(arguments) => render::run(&arguments),
        Command::Edit(arguments) => edit::run(&arguments),
        Command::Plan(arguments) => plan::run(&arguments, &typed),
        Command::Merge(arguments) => merge::run(&arguments),
        Command::Denoise(arguments) => denoise::run(&arguments),
        Command::Regroup(arguments) => regroup::run(&arguments),
        Command::Compare(arguments) => compare::run(&arguments),
        Command::Test(arguments) => test::run(&arguments, &typed),
        Command::Referee(arguments) => referee::run(&arguments),
        Command::Verify(arguments) => verify::run(&arguments, &typed),
        Command::Bench(arguments) => bench::run(&arguments),
        Command::Measure(arguments) => measure::run(&arguments),
        Command::Check(arguments) => check::run(&arguments),
        Command::Export(arguments) => export::run(&arguments),
        Command::Import(arguments) => import::run(&arguments),
        Command::Scenes(arguments) => scenes::run(&arguments),
        Command::Devices(arguments) => devices::run(&arguments),
        Command::Completions(arguments) => completions::completions(&arguments),
        Command::Man(arguments) => completions::man(&arguments),
    };
    match outcome {
        Ok(exit) => exit.into(),
        Err(failure) => {
            let exit = Exit::from(&failure);
            terminal::print_error(&failure);
            exit.into()
        }
    }
}
