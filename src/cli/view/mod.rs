//! A render shown while it goes on: on a page in the browser (`--view`), in tev (`--display`), and again whenever a file changes (`--watch`). The page
//! of `gpt edit` has a panel beside the picture.
//!
//! The render puts what it has on a [`live_state`] and goes on. Threads of the server and of tev read it there.

mod arguments;
mod browser;
mod layers;
mod live_state;
mod panel;
mod request;
mod server;
mod tev;

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use gpt::film::Band;
use gpt::load::FileLog;
use gpt::output::{Display, LayerChannel};
use gpt::{IntervalEstimate, Observer};

pub use arguments::ViewArguments;
use live_state::LiveState;
pub use live_state::Phase;
pub use panel::{Panel, Reply};
use server::Server;

use super::exit::Failure;
use super::progress::Progress;
use super::{interrupt, terminal};

/// Time between two looks at the files of the scene, and between two at Ctrl-C.
const LOOK_INTERVAL: Duration = Duration::from_millis(100);
/// Time between two looks at whether the render is to begin again, which somebody waits for.
const WAKING: Duration = Duration::from_millis(5);
/// A program that writes a file is given so long to end it.
const SETTLING: Duration = Duration::from_millis(40);

/// The places where a render is shown; none, if nobody asked for one.
pub struct Live {
    state: Option<Arc<LiveState>>,
    url: Option<String>,
    tev: Option<tev::Sender>,
    /// A file of the scene has changed.
    changed: Option<Arc<AtomicBool>>,
    /// The files that were read for the scene.
    files: FileLog,
}

impl Live {
    /// Opens what is asked for, and says where.
    ///
    /// # Errors
    /// No server, or no tev at that address.
    pub fn start(arguments: &ViewArguments, display: &Display) -> Result<Self, Failure> {
        let mut live = Self { state: None, url: None, tev: None, changed: None, files: FileLog::default() };
        if !arguments.view && arguments.tev.is_none() {
            return Ok(live);
        }
        let state = Arc::new(LiveState::new(display));
        if let Some(address) = &arguments.tev {
            let refused = |error| Failure::Other(format!("--display {address}: {error}; is tev running there?"));
            live.tev = Some(tev::start(address, state.clone()).map_err(refused)?);
        }
        if arguments.view {
            live.serve(&state, None)?;
        }
        if arguments.watch {
            live.watch(Arc::new(AtomicBool::new(false)))?;
        }
        live.state = Some(state);
        Ok(live)
    }

    /// Opens a page with a panel, whose changes set `changed`, as changes of files do.
    ///
    /// # Errors
    /// No server.
    pub fn with_panel(panel: Arc<dyn Panel>, changed: &Arc<AtomicBool>) -> Result<Self, Failure> {
        let mut live = Self { state: None, url: None, tev: None, changed: None, files: FileLog::default() };
        let state = Arc::new(LiveState::new(&Display::default()));
        live.serve(&state, Some(panel))?;
        live.watch(changed.clone())?;
        live.state = Some(state);
        Ok(live)
    }

    fn serve(&mut self, state: &Arc<LiveState>, panel: Option<Arc<dyn Panel>>) -> Result<(), Failure> {
        let failed = |error| Failure::Other(format!("the page cannot be served: {error}"));
        let server = Server::start(state.clone(), panel).map_err(failed)?;
        terminal::note(&format!("the picture is shown at {}", server.url));
        browser::open(&server.url);
        self.url = Some(server.url);
        Ok(())
    }

    fn watch(&mut self, changed: Arc<AtomicBool>) -> Result<(), Failure> {
        let (flag, files) = (changed.clone(), self.files.clone());
        let watch = move || watch_files(&flag, &files);
        let failed = |error| Failure::Other(format!("files cannot be watched: {error}"));
        thread::Builder::new().name("watch".to_owned()).spawn(watch).map_err(failed)?;
        self.changed = Some(changed);
        Ok(())
    }

    /// True if it is shown anywhere.
    pub fn is_shown(&self) -> bool {
        self.state.is_some()
    }

    /// The list of the files that were read for the scene.
    pub fn files(&self) -> &FileLog {
        &self.files
    }

    /// A scene of this name is about to be rendered.
    pub fn begin(&self, scene: &str) {
        if let Some(state) = &self.state {
            state.begin(scene);
        }
    }

    /// Files are from now on what they are now; changes from now on count.
    pub fn accept_changes(&self) {
        if let Some(changed) = &self.changed {
            changed.store(false, Ordering::SeqCst);
            self.files.accept_changes();
        }
    }

    /// True if the render is to begin again.
    pub fn restarts(&self) -> bool {
        self.changed.as_ref().is_some_and(|changed| changed.load(Ordering::SeqCst)) && !interrupt::requested()
    }

    /// Notes the device that renders.
    pub fn on_device(&self, device: &str) {
        if let Some(state) = &self.state {
            state.on_device(device);
        }
    }

    /// Layers beside the picture are there, among them those of light groups of these names.
    pub fn layers(&self, channels: &[LayerChannel], size: [u32; 2], groups: Vec<String>) {
        if let Some(state) = &self.state {
            state.layers(layers::layer_images(channels, size), groups);
        }
    }

    /// The render is over.
    pub fn end(&self, phase: Phase, message: &str, files: &[String]) {
        if let Some(state) = &self.state {
            state.end(phase, message, files);
        }
    }

    /// Waits until a file changes, or until Ctrl-C.
    pub fn wait_for_change(&self) {
        while !interrupt::requested() && !self.restarts() {
            thread::sleep(WAKING);
        }
    }

    /// Lets the page stand until Ctrl-C, if there is one, and tev have the last picture.
    pub fn close(self, is_over: bool) {
        if let Some(state) = &self.state {
            if let (Some(url), true) = (&self.url, is_over) {
                interrupt::render_is_over();
                terminal::note(&format!("{url} stays until Ctrl-C"));
                while !interrupt::requested() {
                    thread::sleep(LOOK_INTERVAL);
                }
            }
            state.close();
        }
        if let Some(tev) = self.tev {
            tev.join();
        }
    }

    /// Watches a render of so many rows, whose progress people see there.
    pub fn watching<'a>(&'a self, progress: &'a Progress, height: u32) -> Watching<'a> {
        Watching { live: self, progress, height, shows_rows: true, tells_progress: true, asked: Mutex::new(None) }
    }
}

/// Looks at the files of the scene until the program ends.
fn watch_files(changed: &AtomicBool, files: &FileLog) {
    loop {
        thread::sleep(LOOK_INTERVAL);
        if !changed.load(Ordering::SeqCst) && !files.changed().is_empty() {
            thread::sleep(SETTLING);
            changed.store(true, Ordering::SeqCst);
        }
    }
}

/// Tells people, the page and tev how far a render is.
pub struct Watching<'a> {
    live: &'a Live,
    progress: &'a Progress,
    height: u32,
    shows_rows: bool,
    tells_progress: bool,
    /// When rows were asked for last.
    asked: Mutex<Option<Instant>>,
}

impl Watching<'_> {
    /// An observer without the rows: those of a layer do not belong to the picture.
    pub fn without_rows(&self) -> Self {
        Self { shows_rows: false, asked: Mutex::new(None), ..*self }
    }

    /// An observer without the progress: samples that are rendered again do not count.
    pub fn in_advance(&self) -> Self {
        Self { tells_progress: false, asked: Mutex::new(None), ..*self }
    }

    /// Finished rows; those of a render that begins again are not shown, for they may lack samples.
    pub fn band(&self, band: &Band) {
        if self.live.restarts() {
            return;
        }
        if let Some(state) = &self.live.state {
            state.rows(band.clone(), self.height, Instant::now());
        }
    }

    fn asked(&self) -> std::sync::MutexGuard<'_, Option<Instant>> {
        self.asked.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Observer for Watching<'_> {
    fn progress(&self, done: u64, total: u64) {
        if !self.tells_progress {
            return;
        }
        self.progress.progress(done, total);
        if let Some(state) = &self.live.state {
            let phase = if self.shows_rows { Phase::Rendering } else { Phase::Layers };
            state.progress(phase, done, total);
        }
    }

    fn stop_requested(&self) -> bool {
        self.progress.stop_requested() || self.live.restarts()
    }

    fn is_abandoned(&self) -> bool {
        self.live.restarts()
    }

    fn wants_rows(&self) -> bool {
        let wants = self.shows_rows && self.live.state.as_ref().is_some_and(|state| state.wants_picture());
        if wants {
            self.asked().get_or_insert_with(Instant::now);
        }
        wants
    }

    fn rows_so_far(&self, rows: Band) {
        let asked = self.asked().take().unwrap_or_else(Instant::now);
        if let Some(state) = &self.live.state {
            state.rows(rows, self.height, asked);
        }
    }

    fn interval_so_far(&self, interval: &IntervalEstimate) {
        if let Some(state) = &self.live.state {
            state.interval(interval.widest, interval.confidence);
        }
    }

    fn error_so_far(&self, expected: f64, upper: f64) {
        if let Some(state) = &self.live.state {
            state.error(expected, upper);
        }
    }
}
