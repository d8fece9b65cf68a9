//! The receivers of finished bands and of states.

use std::io;

use super::state::BatchState;
use crate::film::Band;

/// Takes finished bands, and what is needed to go on with those that are not.
pub trait Sink {
    /// Takes the next band, in order from the top, each once.
    ///
    /// # Errors
    /// The render cannot go on, because nobody takes what it finishes.
    fn band(&mut self, band: Band) -> io::Result<()>;

    /// True if it takes states. If not, renderers need not be able to give one.
    fn takes_states(&self) -> bool {
        false
    }

    /// True if it is time for the next state.
    fn wants_state(&self) -> bool {
        false
    }

    /// Takes how far the batch is: now and then, and where the render breaks off.
    ///
    /// # Errors
    /// The errors of [`Sink::band`].
    fn state(&mut self, state: BatchState) -> io::Result<()> {
        drop(state);
        Ok(())
    }
}

/// Between two pieces of a render, the first of which is whole: gives the sink the state there, if it is time for one or the render `stops`.
///
/// # Errors
/// The errors of [`Sink::state`].
pub fn keep_between(sink: &mut dyn Sink, stops: bool, state: &BatchState) -> io::Result<()> {
    if sink.takes_states() && (stops || sink.wants_state()) { sink.state(state.clone()) } else { Ok(()) }
}

/// A function takes bands and no states.
impl<F: FnMut(Band) -> io::Result<()>> Sink for F {
    fn band(&mut self, band: Band) -> io::Result<()> {
        self(band)
    }
}
