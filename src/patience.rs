//! Files that do not answer. Whoever reads or writes a file of a network file system that is gone hangs in the system, for ever and beyond the
//! reach of signals. So a thread of its own does that, and whoever waits for it waits a bounded time from the last sign of life.

use std::collections::HashMap;
use std::io::{self, BufRead, ErrorKind, Read, Seek, SeekFrom, Write};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, TrySendError, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle, ThreadId};
use std::time::{Duration, Instant};

/// How long a file may take to answer, where nothing else is asked for.
pub const USUAL_LIMIT: Duration = Duration::from_secs(120);
/// Once one did not answer, others are waited for no longer than this: they probably lie on the same file system.
const AFTERWARDS: Duration = Duration::from_secs(2);
/// Bytes that are read at a time: a disk answers at once, and so does a slow network.
const CHUNK: usize = 1 << 18;
/// Between two looks at a thread.
const LOOK: Duration = Duration::from_millis(2);

static LIMIT_MILLISECONDS: AtomicU64 = AtomicU64::new(USUAL_LIMIT.as_millis() as u64);
static ONE_DID_NOT_ANSWER: AtomicBool = AtomicBool::new(false);
/// Since when threads wait for the system to read or write something.
static BUSY: Mutex<Option<HashMap<ThreadId, Instant>>> = Mutex::new(None);

/// Sets how long a file may take to answer, in this process.
pub fn set_limit(limit: Duration) {
    LIMIT_MILLISECONDS.store(u64::try_from(limit.as_millis()).unwrap_or(u64::MAX), Ordering::Relaxed);
}

fn limit() -> Duration {
    let limit = Duration::from_millis(LIMIT_MILLISECONDS.load(Ordering::Relaxed));
    if ONE_DID_NOT_ANSWER.load(Ordering::Relaxed) { limit.min(AFTERWARDS) } else { limit }
}

/// The error of a file that did not answer in time.
fn no_answer(limit: Duration) -> io::Error {
    // Tests of files that hang are no reason for others to hurry.
    ONE_DID_NOT_ANSWER.store(!cfg!(test), Ordering::Relaxed);
    let seconds = limit.as_secs_f64();
    let message = format!("its file system did not answer for {seconds} s and may be gone; --file-timeout waits longer");
    io::Error::new(ErrorKind::TimedOut, message)
}

/// Does a short piece of work with files, such as opening one, and waits for it as long as a file may take to answer.
///
/// # Errors
/// What the work says, and [`ErrorKind::TimedOut`].
pub fn within<T: Send + 'static>(work: impl FnOnce() -> io::Result<T> + Send + 'static) -> io::Result<T> {
    within_limit(limit(), work)
}

fn within_limit<T: Send + 'static>(limit: Duration, work: impl FnOnce() -> io::Result<T> + Send + 'static) -> io::Result<T> {
    let (sender, receiver) = sync_channel(1);
    let work = Arc::new(Mutex::new(Some(work)));
    let take = |work: &Mutex<Option<_>>| work.lock().unwrap_or_else(PoisonError::into_inner).take();
    let of_thread = work.clone();
    let body = move || {
        if let Some(work) = take(&of_thread) {
            // Nobody waits any more, perhaps.
            let _ = sender.send(work());
        }
    };
    if thread::Builder::new().name("files".to_owned()).spawn(body).is_err() {
        // Without a thread to spare, there is nobody to wait for.
        return take(&work).map_or_else(|| Err(io::Error::other("the work is lost")), |work| work());
    }
    match receiver.recv_timeout(limit) {
        Ok(done) => done,
        Err(RecvTimeoutError::Timeout) => Err(no_answer(limit)),
        Err(RecvTimeoutError::Disconnected) => Err(io::Error::other("reading it panicked")),
    }
}

/// Does something that the system may never end, and lets [`join`] and [`send`] know how long that takes.
pub fn busy<T>(work: impl FnOnce() -> T) -> T {
    let me = thread::current().id();
    with_busy(|busy| busy.insert(me, Instant::now()));
    let done = work();
    with_busy(|busy| busy.remove(&me));
    done
}

fn with_busy<T>(look: impl FnOnce(&mut HashMap<ThreadId, Instant>) -> T) -> T {
    look(BUSY.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert_default())
}

/// Whether a thread waits for the system beyond the limit.
fn is_stuck(thread: ThreadId, limit: Duration) -> bool {
    with_busy(|busy| busy.get(&thread).is_some_and(|since| since.elapsed() > limit))
}

/// Waits for the end of a thread that works with files, however long it takes, as long as each file answers.
///
/// # Errors
/// [`ErrorKind::TimedOut`] where one does not; the thread is left behind.
pub fn join<T>(handle: JoinHandle<T>) -> io::Result<thread::Result<T>> {
    join_within(limit(), handle)
}

fn join_within<T>(limit: Duration, handle: JoinHandle<T>) -> io::Result<thread::Result<T>> {
    while !handle.is_finished() {
        if is_stuck(handle.thread().id(), limit) {
            return Err(no_answer(limit));
        }
        thread::sleep(LOOK);
    }
    Ok(handle.join())
}

/// Hands something to such a thread, and waits while it has no room.
///
/// # Errors
/// [`ErrorKind::TimedOut`] where a file does not answer, and [`ErrorKind::BrokenPipe`] where the thread ended.
pub fn send<T, R>(sender: &SyncSender<T>, message: T, handle: &JoinHandle<R>) -> io::Result<()> {
    let mut message = message;
    loop {
        match sender.try_send(message) {
            Ok(()) => return Ok(()),
            Err(TrySendError::Disconnected(_)) => return Err(ErrorKind::BrokenPipe.into()),
            Err(TrySendError::Full(back)) => message = back,
        }
        let limit = limit();
        if is_stuck(handle.thread().id(), limit) {
            return Err(no_answer(limit));
        }
        thread::sleep(LOOK);
    }
}

/// A file that is written by a thread for which others wait by [`join`] and [`send`].
#[derive(Debug)]
pub struct Watched<W>(pub W);

impl<W: Write> Write for Watched<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        busy(|| self.0.write(bytes))
    }

    fn flush(&mut self) -> io::Result<()> {
        busy(|| self.0.flush())
    }
}

impl<W: Seek> Seek for Watched<W> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        busy(|| self.0.seek(to))
    }
}

/// A file that is read by a thread of its own, chunk by chunk as it is asked for.
#[derive(Debug)]
pub struct PatientFile<R> {
    reader: Reader<R>,
    limit: Duration,
    length: u64,
    /// Where the chunk begins, and what of it is next.
    start: u64,
    chunk: Vec<u8>,
    next: usize,
}

#[derive(Debug)]
enum Reader<R> {
    /// Asked for the chunk at an offset.
    Thread(SyncSender<u64>, Receiver<io::Result<Vec<u8>>>),
    /// Where the system starts no more threads.
    Direct(R),
    /// It did not answer.
    Gone,
}

impl<R: Read + Seek + Send + 'static> PatientFile<R> {
    /// A file of so many bytes, as far as that is known.
    pub fn new(file: R, length: u64) -> Self {
        Self::with_limit(file, length, limit())
    }

    fn with_limit(file: R, length: u64, limit: Duration) -> Self {
        let (ask, asked) = sync_channel::<u64>(1);
        let (answer, answers) = sync_channel(1);
        let file = Arc::new(Mutex::new(Some(file)));
        let take = |file: &Mutex<Option<R>>| file.lock().unwrap_or_else(PoisonError::into_inner).take();
        let of_thread = file.clone();
        let body = move || {
            let Some(mut file) = take(&of_thread) else { return };
            // Nobody asks any more once the file is dropped.
            while let Ok(offset) = asked.recv() {
                if answer.send(chunk_at(&mut file, offset)).is_err() {
                    break;
                }
            }
        };
        let reader = match thread::Builder::new().name("file".to_owned()).spawn(body) {
            Ok(_) => Reader::Thread(ask, answers),
            Err(_) => take(&file).map_or(Reader::Gone, Reader::Direct),
        };
        Self { reader, limit, length, start: 0, chunk: Vec::new(), next: 0 }
    }

    /// Its length when it was opened.
    pub fn length(&self) -> u64 {
        self.length
    }

    fn load(&mut self, offset: u64) -> io::Result<()> {
        let answer = match &mut self.reader {
            Reader::Direct(file) => chunk_at(file, offset),
            Reader::Gone => Err(no_answer(self.limit)),
            Reader::Thread(ask, answers) => {
                let answer = ask.send(offset).map_err(|_| RecvTimeoutError::Disconnected);
                match answer.and_then(|()| answers.recv_timeout(self.limit)) {
                    Ok(answer) => answer,
                    Err(RecvTimeoutError::Disconnected) => Err(io::Error::other("reading it panicked")),
                    Err(RecvTimeoutError::Timeout) => {
                        self.reader = Reader::Gone;
                        Err(no_answer(self.limit))
                    }
                }
            }
        };
        self.chunk = answer?;
        (self.start, self.next) = (offset, 0);
        Ok(())
    }
}

fn chunk_at(file: &mut (impl Read + Seek), offset: u64) -> io::Result<Vec<u8>> {
    file.seek(SeekFrom::Start(offset))?;
    let mut chunk = vec![0; CHUNK];
    loop {
        match file.read(&mut chunk) {
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            read => {
                chunk.truncate(read?);
                return Ok(chunk);
            }
        }
    }
}

impl<R: Read + Seek + Send + 'static> BufRead for PatientFile<R> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        if self.next >= self.chunk.len() {
            self.load(self.start + self.next as u64)?;
        }
        Ok(&self.chunk[self.next..])
    }

    fn consume(&mut self, bytes: usize) {
        self.next = (self.next + bytes).min(self.chunk.len());
    }
}

impl<R: Read + Seek + Send + 'static> Read for PatientFile<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let read = self.fill_buf()?.read(buffer)?;
        self.consume(read);
        Ok(read)
    }
}

impl<R: Read + Seek + Send + 'static> Seek for PatientFile<R> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let here = self.start + self.next as u64;
        let place = match to {
            SeekFrom::Start(place) => Some(place),
            SeekFrom::Current(by) => here.checked_add_signed(by),
            SeekFrom::End(by) => self.length.checked_add_signed(by),
        };
        let place = place.ok_or_else(|| io::Error::new(ErrorKind::InvalidInput, "a place before the file's beginning"))?;
        match place.checked_sub(self.start) {
            Some(next) if next <= self.chunk.len() as u64 => self.next = next as usize,
            _ => (self.start, self.next, self.chunk) = (place, 0, Vec::new()),
        }
        Ok(place)
    }
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;

    const SHORT: Duration = Duration::from_millis(80);

    /// A file that hangs once so many reads were answered, each after a while.
    struct Hangs {
        file: Cursor<Vec<u8>>,
        answers: u32,
        each: Duration,
    }

    impl Read for Hangs {
        fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
            if self.answers == 0 {
                hang();
            }
            self.answers -= 1;
            thread::sleep(self.each);
            self.file.read(buffer)
        }
    }

    impl Seek for Hangs {
        fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
            self.file.seek(to)
        }
    }

    /// For longer than any test.
    fn hang() {
        thread::sleep(Duration::from_secs(3600));
    }

    fn bytes() -> Vec<u8> {
        (0..5 * CHUNK as u32 / 2).map(|index| (index / 7) as u8).collect()
    }

    #[test]
    fn a_file_that_stops_answering_is_an_error_and_a_slow_one_is_read() {
        let file = |answers, each| Hangs { file: Cursor::new(bytes()), answers, each };
        let mut read = Vec::new();
        let mut gone = PatientFile::with_limit(file(2, Duration::ZERO), 0, SHORT);
        let error = gone.read_to_end(&mut read).unwrap_err();
        assert_eq!((error.kind(), read.len()), (ErrorKind::TimedOut, 2 * CHUNK));
        assert!(error.to_string().contains("--file-timeout"), "{error}");
        // Nor is it waited for again.
        let again = Instant::now();
        assert!(gone.read_to_end(&mut read).is_err() && again.elapsed() < SHORT);
        // The control: one that takes longer in all, but answers each time, is read to its end.
        let limit = Duration::from_secs(60);
        let mut slow = PatientFile::with_limit(file(9, Duration::from_millis(30)), 0, limit);
        let mut read = Vec::new();
        slow.read_to_end(&mut read).unwrap();
        assert!(read == bytes());
    }

    #[test]
    fn places_are_found_as_in_any_file() {
        let all = bytes();
        let mut file = PatientFile::new(Cursor::new(all.clone()), all.len() as u64);
        let mut plain = Cursor::new(all);
        let places = [
            SeekFrom::Start(5),
            SeekFrom::Current(3 * CHUNK as i64 / 2),
            SeekFrom::Current(-70),
            SeekFrom::End(-9),
            SeekFrom::Start(CHUNK as u64),
            SeekFrom::End(50),
            SeekFrom::Start(0),
        ];
        for place in places {
            assert_eq!(file.seek(place).unwrap(), plain.seek(place).unwrap(), "{place:?}");
            let [mut ours, mut theirs] = [[0; 40]; 2];
            let [ours_read, theirs_read] = [file.read(&mut ours).unwrap(), plain.read(&mut theirs).unwrap()];
            assert_eq!((&ours[..ours_read], ours_read), (&theirs[..ours_read], theirs_read), "{place:?}");
        }
        assert!(file.seek(SeekFrom::Current(-1000)).is_err());
        assert_eq!(file.length(), 5 * CHUNK as u64 / 2);
    }

    #[test]
    fn work_that_never_ends_is_given_up() {
        let error = within_limit(SHORT, || {
            hang();
            Ok(1)
        });
        assert_eq!(error.unwrap_err().kind(), ErrorKind::TimedOut);
        assert_eq!(within(|| Ok(7)).unwrap(), 7);
        assert_eq!(within(|| Err::<(), _>(ErrorKind::NotFound.into())).unwrap_err().kind(), ErrorKind::NotFound);
    }

    #[test]
    fn a_thread_is_waited_for_as_long_as_files_answer() {
        let stuck = thread::spawn(|| busy(hang));
        let error = join_within(SHORT, stuck).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::TimedOut);
        // The controls: a thread that computes for longer, and one whose files answer.
        let computing = thread::spawn(|| {
            thread::sleep(3 * SHORT);
            5
        });
        assert_eq!(join_within(SHORT, computing).unwrap().unwrap(), 5);
        let limit = Duration::from_secs(60);
        let mut file = Watched(Cursor::new(Vec::new()));
        let writing = thread::spawn(move || {
            file.write_all(&[1; 9]).and_then(|()| file.seek(SeekFrom::Start(0))).map(|_| file.0.into_inner())
        });
        assert_eq!(join_within(limit, writing).unwrap().unwrap().unwrap(), [1; 9]);
        let (sender, receiver) = sync_channel(1);
        let reading = thread::spawn(move || receiver.iter().sum::<u32>());
        (1..=9).for_each(|number| send(&sender, number, &reading).unwrap());
        drop(sender);
        assert_eq!(join(reading).unwrap().unwrap(), 45);
    }
}
