//! The files of a bench's results, and its messages meanwhile.

use std::cell::RefCell;
use std::path::{Path, PathBuf};

use gpt::load::FileLog;
use gpt::output::{AtomicFile, OutputError};
use gpt::renderer::Observer;
use serde::Serialize;

use super::arguments::OutputArguments;
use crate::cli::exit::Failure;
use crate::cli::shell::quoted;
use crate::cli::{interrupt, outputs, terminal};

/// An observer that shows nothing, since renders are many and short, and passes on Ctrl-C.
pub struct OnlyStops;

impl Observer for OnlyStops {
    fn progress(&self, _done: u64, _total: u64) {}
    fn stop_requested(&self) -> bool {
        interrupt::requested()
    }
}

/// The folder of one bench's results.
pub struct Results {
    folder: PathBuf,
    bench: &'static str,
    quiet: bool,
    /// The last message.
    last: RefCell<String>,
}

impl Results {
    /// Makes the folder, so that hours of work do not end at a place that cannot be written to.
    ///
    /// # Errors
    /// Errors of the file system.
    pub fn prepare(arguments: &OutputArguments, bench: &'static str, read: &FileLog) -> Result<Self, Failure> {
        let folder = arguments.output.clone().unwrap_or_else(|| Path::new("gpt-bench").join(bench));
        std::fs::create_dir_all(&folder).map_err(|source| OutputError::Write { path: folder.clone(), source })?;
        let files = files(&folder, bench);
        outputs::check(files.iter().map(PathBuf::as_path), None)?;
        outputs::check_unread(files.iter().map(PathBuf::as_path), read)?;
        Ok(Self { folder, bench, quiet: arguments.quiet, last: RefCell::default() })
    }

    /// Tells what is going on, the same thing once.
    pub fn say(&self, what: &str) {
        if !self.quiet && self.last.replace(what.to_owned()) != what {
            terminal::note(what);
        }
    }

    /// Writes the page, all numbers as JSON, and the rows.
    ///
    /// # Errors
    /// Errors of the file system.
    pub fn write(&self, results: &impl Serialize, csv: &[u8], page: &str) -> Result<(), Failure> {
        let json = serde_json::to_vec_pretty(results).map_err(|error| Failure::Other(error.to_string()))?;
        let [json_file, csv_file, report] = files(&self.folder, self.bench);
        AtomicFile::write(&json_file, &json)?;
        AtomicFile::write(&csv_file, csv)?;
        AtomicFile::write(&report, page.as_bytes())?;
        self.say(&format!("wrote {} with {}.json and {}.csv beside it", report.display(), self.bench, self.bench));
        Ok(())
    }
}

/// The numbers, the rows and the page.
fn files(folder: &Path, bench: &str) -> [PathBuf; 3] {
    [format!("{bench}.json"), format!("{bench}.csv"), "report.html".to_owned()].map(|name| folder.join(name))
}

/// The command line as it was typed.
pub fn command() -> String {
    let arguments = std::env::args_os().skip(1).map(|argument| quoted(&argument.to_string_lossy()));
    std::iter::once("gpt".to_owned()).chain(arguments).collect::<Vec<_>>().join(" ")
}
