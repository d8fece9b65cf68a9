//! Keeps the state of a render in a file, and finds the one to go on from.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use super::identity::Identity;
use super::rows::{self, RowsFile};
use super::saved::{Refusal, Saved, StepsState};
use crate::film::{Band, RenderedLayer};
use crate::output::{OutputError, check_target};
use crate::renderer::state::BatchState;

/// Time between two states, where nothing else is asked for.
pub const DEFAULT_INTERVAL: Duration = Duration::from_secs(60);
/// The suffix of the picture's name.
const ENDING: &str = ".checkpoint";

/// Why a render cannot go on from a checkpoint.
#[derive(Debug, thiserror::Error)]
pub enum CheckpointError {
    #[error("{}: {what}; without --resume, the render begins anew and replaces it", path.display())]
    Other { path: PathBuf, what: String },
    #[error("{}: cannot go on from it, because {what}; without --resume, the render begins anew and replaces it", path.display())]
    Unreadable { path: PathBuf, what: String },
}

/// The place of the state of this picture's render.
pub fn path_beside(picture: &Path) -> PathBuf {
    let mut name = picture.file_name().unwrap_or_default().to_os_string();
    name.push(ENDING);
    picture.with_file_name(name)
}

/// The place of the state of one of its layers.
pub fn path_of_layer(picture: &Path, layer: &RenderedLayer) -> PathBuf {
    let mut name = path_beside(picture).into_os_string();
    name.push(format!("-{}", layer.name()));
    name.into()
}

/// A state of the render under way is in its place.
static IS_KEPT: AtomicBool = AtomicBool::new(false);

/// True while a state of the render under way is in its place, so that a process that ends now loses little. It takes no memory and no lock.
pub fn is_kept() -> bool {
    IS_KEPT.load(Ordering::SeqCst)
}

/// Removes a state, if there is one.
pub fn remove_state(path: &Path) {
    IS_KEPT.store(false, Ordering::SeqCst);
    // Nothing is left to be done about a file that cannot be removed.
    let _ = fs::remove_file(path);
    rows::remove_all(path);
}

/// The state of one render on its way to a file.
pub struct Checkpoint {
    path: PathBuf,
    identity: Identity,
    interval: Duration,
    device: String,
    /// When this render began, and what earlier ones took.
    started: Instant,
    seconds_before: f64,
    last: Instant,
    /// Writes while the render goes on.
    writer: Option<JoinHandle<Result<(), OutputError>>>,
    /// Errors of states that could not be written: the render goes on without them.
    failures: Vec<OutputError>,
    rows: Option<RowsFile>,
    saved: Option<Saved>,
    /// A state of this render is in its place.
    is_there: bool,
}

impl Checkpoint {
    /// A checkpoint for a render that began at `started`, on a device of this name.
    ///
    /// # Errors
    /// A place where no file can be.
    pub fn new(
        path: PathBuf,
        identity: Identity,
        device: &str,
        interval: Duration,
        started: Instant,
    ) -> Result<Self, OutputError> {
        check_target(&path)?;
        Ok(Self {
            path,
            identity,
            interval,
            device: device.to_owned(),
            started,
            seconds_before: 0.0,
            last: Instant::now(),
            writer: None,
            failures: Vec::new(),
            rows: None,
            saved: None,
            is_there: false,
        })
    }

    /// The place of the state.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Looks for the state of an earlier render to go on from: what device it was on and how many samples it has, over all pixels; None where
    /// there is none.
    ///
    /// # Errors
    /// One that is damaged, or of another render.
    pub fn find(&mut self, size: [u32; 2]) -> Result<Option<(String, u64)>, CheckpointError> {
        let path = self.path.clone();
        let saved = Saved::read(&self.path, &self.identity, size).map_err(|refusal| match refusal {
            Refusal::Other(what) => CheckpointError::Other { path: path.clone(), what },
            Refusal::Unreadable(what) => CheckpointError::Unreadable { path: path.clone(), what },
        })?;
        let Some(saved) = saved else { return Ok(None) };
        if let Some((name, bytes)) = &saved.rows {
            let unreadable = |error: io::Error| CheckpointError::Unreadable {
                path,
                what: format!("its finished rows are not in {name}: {error}"),
            };
            let rows = RowsFile::resume(&self.path, name, *bytes).and_then(|mut rows| rows.check().map(|()| rows));
            self.rows = Some(rows.map_err(unreadable)?);
        }
        self.seconds_before = saved.seconds;
        let before = saved.steps.as_ref().map_or(0, |steps| steps.tally.samples);
        let found = (saved.device.clone(), before + saved.batch.tally.samples);
        self.is_there = true;
        IS_KEPT.store(true, Ordering::SeqCst);
        self.saved = Some(saved);
        Ok(Some(found))
    }

    /// Seconds that earlier renders took.
    pub fn seconds_before(&self) -> f64 {
        self.seconds_before
    }

    /// Hands over the rows that are finished, and the state that was found, once.
    ///
    /// # Errors
    /// Rows that cannot be read, and what `on_band` says.
    pub(in crate::render) fn resume(&mut self, on_band: &mut dyn FnMut(Band) -> io::Result<()>) -> io::Result<Option<Saved>> {
        if let Some(rows) = &mut self.rows {
            rows.read(on_band)?;
        }
        Ok(self.saved.take())
    }

    /// True if it is time for the next state, and the last one is written.
    pub(in crate::render) fn is_due(&self) -> bool {
        self.last.elapsed() >= self.interval && self.writer.as_ref().is_none_or(JoinHandle::is_finished)
    }

    /// Keeps a band that is finished, of a picture that is rendered in bands.
    pub(in crate::render) fn keep_band(&mut self, band: &Band) -> io::Result<()> {
        if self.rows.is_none() {
            self.rows = Some(RowsFile::create(&self.path)?);
        }
        self.rows.as_mut().map_or(Ok(()), |rows| rows.append(band))
    }

    /// Begins to write a state.
    pub(in crate::render) fn keep(&mut self, batch: BatchState, steps: Option<StepsState>) {
        self.wait();
        let rows = match self.rows.as_ref().map(RowsFile::flushed).transpose() {
            Ok(rows) => rows,
            Err(source) => return self.failures.push(OutputError::Write { path: self.path.clone(), source }),
        };
        let seconds = self.seconds_before + self.started.elapsed().as_secs_f64();
        let saved = Saved { seconds, device: self.device.clone(), batch, steps, rows };
        let (path, identity) = (self.path.clone(), self.identity.clone());
        let write = {
            let saved = saved.clone();
            let (path, identity) = (path.clone(), identity.clone());
            move || saved.write(&path, &identity).inspect(|()| IS_KEPT.store(true, Ordering::SeqCst))
        };
        match thread::Builder::new().name("checkpoint".to_owned()).spawn(write) {
            Ok(writer) => self.writer = Some(writer),
            // Without a thread to spare, the render waits.
            Err(_) => match saved.write(&path, &identity) {
                Ok(()) => {
                    self.is_there = true;
                    IS_KEPT.store(true, Ordering::SeqCst);
                }
                Err(failure) => self.failures.push(failure),
            },
        }
        self.last = Instant::now();
    }

    /// Waits for the state that is being written.
    fn wait(&mut self) {
        match self.writer.take().map(JoinHandle::join) {
            None => {}
            Some(Ok(Ok(()))) => {
                self.is_there = true;
                // This state makes up for the ones that failed before.
                self.failures.clear();
            }
            Some(Ok(Err(failure))) => self.failures.push(failure),
            Some(Err(_)) => {
                self.failures.push(OutputError::Encode { path: self.path.clone(), what: "its writer panicked".to_owned() });
            }
        }
    }

    /// Waits until the last state is in its place. Whether there is one of this render.
    ///
    /// # Errors
    /// Why there is none.
    pub fn finish(&mut self) -> Result<bool, OutputError> {
        self.wait();
        match self.failures.pop() {
            Some(failure) => Err(failure),
            None => Ok(self.is_there),
        }
    }

    /// Removes it: the picture is there.
    pub fn remove(mut self) {
        self.wait();
        self.rows = None;
        remove_state(&self.path);
    }
}

impl Drop for Checkpoint {
    fn drop(&mut self) {
        self.wait();
    }
}
