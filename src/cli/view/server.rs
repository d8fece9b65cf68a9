//! The page's server: on this machine's own address alone, each request in a thread of its own, so that neither a slow browser nor a render waits for
//! the other.

use std::collections::VecDeque;
use std::io::{self, BufRead, BufReader};
use std::net::{Ipv4Addr, Shutdown, TcpListener, TcpStream};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use gpt::film::Band;
use gpt::output::{PictureFile, PictureFormat, PictureSpec};
use serde::Serialize;

use super::live_state::{LivePicture, LiveState, Status, View};
use super::panel::{Panel, Reply};
use super::request::{AccessCheck, Refusal, Request, answer};

/// The page, all in one file, but for a panel.
const PAGE: &str = concat!(
    include_str!("page/head.html"),
    "<style>\n",
    include_str!("page/page.css"),
    "</style>\n",
    include_str!("page/body.html"),
    "<script>\n",
    include_str!("page/display.js"),
    include_str!("page/page.js"),
    include_str!("page/groups.js"),
    "follow();\n",
    "</script>\n"
);

/// Longest time that a browser may take to send a request, or to take a part of an answer.
const PATIENCE: Duration = Duration::from_secs(10);
/// Longest time that a request for news waits for some.
const LONGEST_WAIT: Duration = Duration::from_secs(8);
/// Requests with the secret that are answered at a time, and connections that have not shown it yet.
const MOST_REQUESTS: usize = 32;
const MOST_STRANGERS: usize = 32;

/// A server that is running; it ends with the program.
pub struct Server {
    pub url: String,
}

impl Server {
    /// Begins to answer, at a port that the system chooses. The page has a panel if there is one.
    ///
    /// # Errors
    /// No port, or no thread.
    pub fn start(state: Arc<LiveState>, panel: Option<Arc<dyn Panel>>) -> io::Result<Self> {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0))?;
        let port = listener.local_addr()?.port();
        let secret = secret()?;
        let url = format!("http://127.0.0.1:{port}/{secret}/");
        let access = Arc::new(AccessCheck::new(secret, port));
        let shown = Arc::new(Shown { state, panel });
        thread::Builder::new().name("view".to_owned()).spawn(move || serve(&listener, &access, &shown))?;
        Ok(Self { url })
    }
}

/// 128 bits that nobody can guess.
///
/// # Errors
/// A system without random numbers.
fn secret() -> io::Result<String> {
    let mut bytes = [0; 16];
    getrandom::fill(&mut bytes)?;
    Ok(format!("{:032x}", u128::from_ne_bytes(bytes)))
}

/// All that the page shows.
struct Shown {
    state: Arc<LiveState>,
    panel: Option<Arc<dyn Panel>>,
}

fn serve(listener: &TcpListener, access: &Arc<AccessCheck>, shown: &Arc<Shown>) {
    let (open, strangers) = (Arc::new(AtomicUsize::new(0)), Arc::new(Strangers::default()));
    loop {
        let Ok((connection, _)) = listener.accept() else {
            // Out of file handles, say: some will come back.
            thread::sleep(Duration::from_millis(50));
            continue;
        };
        let connection = Arc::new(connection);
        let stranger = Strangers::enter(&strangers, &connection);
        let (access, shown, open) = (access.clone(), shown.clone(), open.clone());
        // Without a thread the connection is closed, and the browser asks again. A browser that goes away is no failure.
        let _ = thread::Builder::new().name("view request".to_owned()).spawn(move || {
            let _ = converse(&connection, stranger, (&access, &shown, &open));
        });
    }
}

/// Connections that have not shown the secret yet, the oldest first. It makes room for a new one: who holds many open keeps nobody out, for a browser
/// sends its request at once.
#[derive(Default)]
struct Strangers {
    next: AtomicUsize,
    waiting: Mutex<VecDeque<(usize, Arc<TcpStream>)>>,
}

/// A connection among them, as long as it is one.
struct Stranger(Arc<Strangers>, usize);

impl Strangers {
    fn enter(strangers: &Arc<Self>, connection: &Arc<TcpStream>) -> Stranger {
        let number = strangers.next.fetch_add(1, Ordering::Relaxed);
        let mut waiting = strangers.waiting();
        waiting.push_back((number, connection.clone()));
        if waiting.len() > MOST_STRANGERS
            && let Some((_, oldest)) = waiting.pop_front()
        {
            // Its thread finds that it is closed.
            let _ = oldest.shutdown(Shutdown::Both);
        }
        Stranger(strangers.clone(), number)
    }

    fn waiting(&self) -> MutexGuard<'_, VecDeque<(usize, Arc<TcpStream>)>> {
        self.waiting.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Drop for Stranger {
    fn drop(&mut self) {
        self.0.waiting().retain(|(number, _)| *number != self.1);
    }
}

/// A request under way.
struct Counted<'a>(&'a AtomicUsize);

impl<'a> Counted<'a> {
    /// None: there are too many.
    fn begin(open: &'a AtomicUsize) -> Option<Self> {
        let counted = Self(open);
        (open.fetch_add(1, Ordering::SeqCst) < MOST_REQUESTS).then_some(counted)
    }
}

impl Drop for Counted<'_> {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::SeqCst);
    }
}

/// Ends a read at a time, however slowly bytes come.
struct Until<'a>(&'a TcpStream, Instant);

impl io::Read for Until<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let left = self.1.saturating_duration_since(Instant::now());
        if left.is_zero() {
            return Err(io::ErrorKind::TimedOut.into());
        }
        self.0.set_read_timeout(Some(left))?;
        self.0.read(buffer)
    }
}

fn converse(
    connection: &TcpStream,
    stranger: Stranger,
    (access, shown, open): (&AccessCheck, &Shown, &AtomicUsize),
) -> io::Result<()> {
    connection.set_nodelay(true)?;
    connection.set_write_timeout(Some(PATIENCE))?;
    let mut reader = BufReader::new(Until(connection, Instant::now() + PATIENCE));
    let request = match Request::read(&mut reader) {
        Ok(request) => request,
        Err(error) if error.kind() == io::ErrorKind::InvalidData => {
            return answer(connection, "400 Bad Request", TEXT, b"This is no request.\n", true);
        }
        Err(error) => return Err(error),
    };
    let with_body = request.method != "HEAD";
    let Some(path) = access.admit(&request) else {
        request.skip_body(&mut reader);
        let words = b"The address that gpt printed has a secret in it, and this one has not.\n";
        return answer(connection, "403 Forbidden", TEXT, words, with_body);
    };
    drop(stranger);
    let Some(_counted) = Counted::begin(open) else {
        return answer(connection, "503 Service Unavailable", TEXT, b"There are too many requests at a time.\n", with_body);
    };
    let state = &shown.state;
    match (request.method.as_str(), &shown.panel) {
        ("GET" | "HEAD", _) => {}
        ("POST", Some(panel)) => return change(connection, &mut reader, (&request, path), panel.as_ref()),
        _ => {
            request.skip_body(&mut reader);
            return answer(connection, "405 Method Not Allowed", TEXT, b"There is only something to get.\n", true);
        }
    }
    match path {
        "" => {
            let page = PAGE.to_owned() + &shown.panel.as_ref().map(|panel| panel.parts()).unwrap_or_default();
            answer(connection, "200 OK", "text/html; charset=utf-8", page.as_bytes(), with_body)
        }
        "state" => {
            let after = request.parameter("after").and_then(|after| after.parse().ok()).unwrap_or(0);
            let view = state.view_after(after, if after > 0 { LONGEST_WAIT } else { Duration::ZERO }, true);
            let body = serde_json::to_vec(&State::of(&view))?;
            answer(connection, "200 OK", "application/json", &body, with_body)
        }
        "picture" => {
            let view = state.view_after(0, Duration::ZERO, true);
            match pixels(&view, request.parameter("layer")) {
                Some(body) => answer(connection, "200 OK", "application/octet-stream", &body?, with_body),
                None => answer(connection, "404 Not Found", TEXT, b"There is no such layer.\n", with_body),
            }
        }
        "picture.exr" => {
            let view = state.view_after(0, Duration::ZERO, true);
            if view.picture.mean.is_empty() {
                return answer(connection, "404 Not Found", TEXT, b"There is no picture yet.\n", with_body);
            }
            answer(connection, "200 OK", "image/x-exr", &exr(&view.picture)?, with_body)
        }
        _ => match shown.panel.as_ref().and_then(|panel| panel.get(path)) {
            Some(Reply { status, kind, body }) => answer(connection, status, kind, &body, with_body),
            None => answer(connection, "404 Not Found", TEXT, b"There is no such page.\n", with_body),
        },
    }
}

/// Has the panel answer a request that changes something, if the page itself made it.
fn change(
    connection: &TcpStream,
    reader: &mut impl BufRead,
    (request, path): (&Request, &str),
    panel: &dyn Panel,
) -> io::Result<()> {
    let reply = match request.body_of_own_page(reader) {
        Ok(body) => {
            panel.post(path, &body?).unwrap_or_else(|| Reply::refused("404 Not Found", "There is no such page.\n".to_owned()))
        }
        Err(Refusal { status, why }) => {
            request.skip_body(reader);
            Reply::refused(status, why.to_owned())
        }
    };
    answer(connection, reply.status, reply.kind, &reply.body, true)
}

const TEXT: &str = "text/plain; charset=utf-8";

/// The state that the page gets.
#[derive(Serialize)]
struct State<'a> {
    version: u64,
    #[serde(flatten)]
    status: &'a Status,
    /// Number, width and height of the picture.
    picture: u64,
    width: u32,
    height: u32,
    /// Fewest and most samples of a pixel.
    samples: [u32; 2],
    /// The relative mean squared error, were all samples independent.
    noise: Option<f64>,
    layers: Vec<&'a str>,
    /// The layers that are light groups and add up to the picture.
    groups: &'a [String],
    /// Counts how often there were other layers.
    layered: u64,
}

impl<'a> State<'a> {
    fn of(view: &'a View) -> Self {
        let picture = &view.picture;
        Self {
            version: view.version,
            status: &view.status,
            picture: picture.number,
            width: picture.width,
            height: picture.height,
            samples: picture.sample_range(),
            noise: picture.expected_error(),
            layers: view.layers.iter().map(|layer| layer.name.as_str()).collect(),
            groups: &view.groups,
            layered: view.layered,
        }
    }
}

/// Width, height and number of the picture as 32-bit integers, then five numbers of single precision a pixel, all little-endian: red, green, blue,
/// samples, and the standard error of the luminance. Of a layer, its three numbers in the place of red, green and blue. None: no such layer.
fn pixels(view: &View, layer: Option<&str>) -> Option<io::Result<Vec<u8>>> {
    let picture = &view.picture;
    let write = |[width, height]: [u32; 2], values: &[[f32; 3]]| {
        let mut bytes = Vec::with_capacity(12 + values.len() * 20);
        for number in [width, height, picture.number as u32] {
            bytes.extend(number.to_le_bytes());
        }
        let is_of_picture = values.len() == picture.mean.len();
        let mut errors = picture.standard_errors();
        for (pixel, value) in values.iter().enumerate() {
            let samples = if is_of_picture { picture.samples[pixel] } else { 0 };
            let [r, g, b] = *value;
            let error = errors.next().unwrap_or(f32::NAN);
            [r, g, b, samples as f32, error].iter().for_each(|value| bytes.extend(value.to_le_bytes()));
        }
        bytes
    };
    let Some(name) = layer else { return Some(Ok(write([picture.width, picture.height], &picture.mean))) };
    let layer = view.layers.iter().find(|layer| layer.name == name)?;
    Some(layer.pixels().map(|values| write([layer.width, layer.height], &values)))
}

/// The picture as a file.
fn exr(picture: &LivePicture) -> io::Result<Vec<u8>> {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("picture.exr");
    let failed = |error: gpt::output::OutputError| io::Error::other(error.to_string());
    let spec = PictureSpec { width: picture.width, height: picture.height, ..PictureSpec::default() };
    let mut file = PictureFile::create(&path, PictureFormat::Exr, &spec).map_err(failed)?;
    let [samples, most] = picture.sample_range();
    let counts = (samples != most).then(|| picture.samples.clone());
    let (width, rows) = (picture.width, picture.height);
    file.write_band(&Arc::new(Band { width, rows, samples, counts, mean: picture.mean.clone(), ..Band::default() }))?;
    file.finish().map_err(failed)?;
    std::fs::read(&path)
}
