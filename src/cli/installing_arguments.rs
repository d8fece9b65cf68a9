//! The arguments of `gpt completions` and `gpt man`.

use std::path::PathBuf;

use clap::Args;
use clap_complete::Shell;

#[derive(Debug, Args)]
pub struct CompletionsArguments {
    /// The shell whose completions are printed
    #[arg(value_name = "SHELL")]
    pub shell: Shell,
}

#[derive(Debug, Args)]
pub struct ManArguments {
    /// Write a page for each command, gpt.1 and gpt-COMMAND.1, into this folder [default: print gpt.1]
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
}
