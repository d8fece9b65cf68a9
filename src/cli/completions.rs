//! `gpt completions` and `gpt man`: what shells and `man` know of the program.

use clap::CommandFactory;
use gpt::output::OutputError;

use super::arguments::Arguments;
use super::exit::{Exit, Failure};
use super::installing_arguments::{CompletionsArguments, ManArguments};
use super::terminal;

/// Prints the completions of a shell.
pub fn completions(arguments: &CompletionsArguments) -> Result<Exit, Failure> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut Arguments::command(), "gpt", &mut script);
    terminal::answer(&String::from_utf8_lossy(&script))?;
    Ok(Exit::Done)
}

/// Prints the man page, or writes all.
pub fn man(arguments: &ManArguments) -> Result<Exit, Failure> {
    let command = Arguments::command();
    if let Some(folder) = &arguments.output {
        let failure = |source| OutputError::Write { path: folder.clone(), source };
        std::fs::create_dir_all(folder).map_err(failure)?;
        clap_mangen::generate_to(command, folder).map_err(failure)?;
        return Ok(Exit::Done);
    }
    let mut page = Vec::new();
    clap_mangen::Man::new(command).render(&mut page).map_err(|error| Failure::Other(error.to_string()))?;
    terminal::answer(&String::from_utf8_lossy(&page))?;
    Ok(Exit::Done)
}
