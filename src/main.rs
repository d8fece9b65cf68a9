//! The program `gpt`; what it does is in the library, how it is asked is in `cli`.

mod allocator;
mod cli;

use std::process::ExitCode;

fn main() -> ExitCode {
    cli::run()
}
