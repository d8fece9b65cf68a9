//! Pictures that a thread makes and Python takes one by one.

use std::panic::resume_unwind;
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};

use pyo3::prelude::*;

use crate::errors::raised;
use crate::task::{Finished, Rendered};
use crate::watching::{INTERVAL, STACK_BYTES, Watcher};

/// A message of the thread.
pub enum Message {
    /// A picture as it is now.
    Look(Box<Look>),
    Finished(Box<Finished>),
    Failed(gpt::Error),
}

/// A picture on the way, and what is known of it, as JSON.
pub struct Look {
    pub image: gpt::Image,
    pub stats: String,
}

/// Nobody takes pictures any more.
pub struct Left;

/// Hands a picture over and waits until it is taken.
pub type HandsOver<'a> = &'a (dyn Fn(Message) -> Result<(), Left> + Sync);

/// Pictures in the making. Whoever lets go of them ends the render.
#[pyclass(frozen, module = "gpt_pathtracer._native")]
pub struct Pictures {
    watcher: Arc<Watcher>,
    taken: Mutex<Taken>,
    progress: Option<Py<PyAny>>,
}

/// Both are None once it has ended.
struct Taken {
    receiver: Option<Receiver<Message>>,
    worker: Option<JoinHandle<()>>,
}

impl Pictures {
    /// Begins `work` in a thread.
    ///
    /// # Errors
    /// The system gives no thread.
    pub fn begin(
        progress: Option<Py<PyAny>>,
        work: impl FnOnce(&Watcher, HandsOver<'_>) -> Result<(), gpt::Error> + Send + 'static,
    ) -> PyResult<Self> {
        let watcher = Arc::new(Watcher::default());
        let (sender, receiver) = sync_channel(0);
        let working = {
            let watcher = watcher.clone();
            move || {
                let hands_over = |message: Message| sender.send(message).map_err(|_| Left);
                if let Err(error) = work(&watcher, &hands_over) {
                    let _ = hands_over(Message::Failed(error));
                }
            }
        };
        let worker = thread::Builder::new().name("render".to_owned()).stack_size(STACK_BYTES).spawn(working)?;
        Ok(Self { watcher, taken: Mutex::new(Taken { receiver: Some(receiver), worker: Some(worker) }), progress })
    }

    /// The next message; None at the end.
    fn message(&self) -> PyResult<Option<Message>> {
        let mut taken = self.taken.lock().unwrap_or_else(PoisonError::into_inner);
        let Some(receiver) = &taken.receiver else { return Ok(None) };
        self.watcher.wait_for(true);
        let received = loop {
            match receiver.recv_timeout(INTERVAL) {
                Ok(message) => break Some(message),
                Err(RecvTimeoutError::Disconnected) => break None,
                Err(RecvTimeoutError::Timeout) => {}
            }
            let looked = Python::attach(|py| {
                py.check_signals()?;
                self.watcher.tell(py, self.progress.as_ref())
            });
            if let Err(raised) = looked {
                taken.end(&self.watcher);
                return Err(raised);
            }
        };
        self.watcher.wait_for(false);
        if let (None, Some(worker)) = (&received, taken.worker.take()) {
            taken.receiver = None;
            worker.join().unwrap_or_else(|panic| resume_unwind(panic));
        }
        Ok(received)
    }
}

impl Taken {
    fn end(&mut self, watcher: &Watcher) {
        watcher.abandon();
        // A thread that waits to hand a picture over waits no more.
        self.receiver = None;
        if let Some(worker) = self.worker.take() {
            // Nobody is there to be told of a panic.
            let _ = worker.join();
        }
    }
}

#[pymethods]
impl Pictures {
    /// The next picture, and whether it is a finished one; None at the end.
    fn next(&self, py: Python<'_>) -> PyResult<Option<(Rendered, bool)>> {
        match py.detach(|| self.message())? {
            None => Ok(None),
            Some(Message::Failed(error)) => Err(raised(error)),
            Some(Message::Finished(finished)) => {
                // Whoever is told of progress is told of the end too.
                self.watcher.tell(py, self.progress.as_ref())?;
                Ok(Some((finished.rendered(py)?, true)))
            }
            Some(Message::Look(look)) => {
                let Look { image, stats } = *look;
                let nothing = Finished {
                    image,
                    channels: Vec::new(),
                    layers: Vec::new(),
                    groups: Vec::new(),
                    notes: Vec::new(),
                    stats: Ok(stats),
                };
                Ok(Some((nothing.rendered(py)?, false)))
            }
        }
    }

    /// Ends the render.
    fn close(&self, py: Python<'_>) {
        // Whoever waits for a picture in another thread waits no more.
        self.watcher.abandon();
        py.detach(|| self.taken.lock().unwrap_or_else(PoisonError::into_inner).end(&self.watcher));
    }
}

impl Drop for Pictures {
    fn drop(&mut self) {
        Python::attach(|py| self.close(py));
    }
}
