//! tev, a viewer of pictures that takes them over TCP: packets of a length, a kind, and what the kind says, little-endian throughout.

use std::io::{self, Write};
use std::net::{TcpStream, ToSocketAddrs};
use std::sync::Arc;
use std::sync::mpsc::channel;
use std::thread;
use std::time::{Duration, Instant};

use super::super::terminal;
use super::live_state::{LivePicture, LiveState};

/// How long a connection may take to come about, with the search for its address, and a packet to be taken.
const CONNECT: Duration = Duration::from_secs(3);
const PATIENCE: Duration = Duration::from_secs(30);
/// How long the last picture may take when the render is over: a viewer that takes no more does not hold the program.
const LAST_PICTURE: Duration = Duration::from_secs(3);
/// Between two looks at whether it was taken.
const LOOK: Duration = Duration::from_millis(2);
/// Pixels of a packet, in whole rows.
const PIXELS_AT_ONCE: u32 = 1 << 16;

/// Kinds of packets (tev's `IpcPacket`).
const CLOSE_IMAGE: u8 = 2;
const CREATE_IMAGE: u8 = 4;
/// With several channels, and where their numbers stand.
const UPDATE_IMAGE: u8 = 6;

/// Sends every picture of the state, in a thread of its own, as long as there is somebody at the other end.
///
/// # Errors
/// There is nobody from the beginning.
pub fn start(address: &str, state: Arc<LiveState>) -> io::Result<Sender> {
    let connection = connect_in_time(address)?;
    state.receivers(1);
    let (address, of_thread) = (address.to_owned(), address.to_owned());
    let thread = thread::Builder::new().name("tev".to_owned()).spawn(move || {
        if let Err(error) = send_pictures(&connection, &state) {
            terminal::warn(&format!("--display {of_thread} takes no more pictures: {error}; the render goes on"));
        }
        state.receivers(-1);
    })?;
    Ok(Sender { address, thread })
}

/// Sends pictures until the state is closed.
pub struct Sender {
    address: String,
    thread: thread::JoinHandle<()>,
}

impl Sender {
    /// Waits a while for the last picture to be sent. The state is closed.
    pub fn join(self) {
        let closed = Instant::now();
        while !self.thread.is_finished() && closed.elapsed() < LAST_PICTURE {
            thread::sleep(LOOK);
        }
        if !self.thread.is_finished() {
            let (address, seconds) = (self.address, LAST_PICTURE.as_secs());
            terminal::warn(&format!(
                "--display {address} did not take the last picture within {seconds} s, and may show an earlier one"
            ));
        }
    }
}

/// Does the work of [`connect`], however long a name takes to be found.
fn connect_in_time(address: &str) -> io::Result<TcpStream> {
    let (sender, receiver) = channel();
    let of_thread = address.to_owned();
    thread::Builder::new().name("tev address".to_owned()).spawn(move || {
        // Nobody waits any more, perhaps.
        let _ = sender.send(connect(&of_thread));
    })?;
    receiver.recv_timeout(CONNECT).unwrap_or_else(|_| Err(io::ErrorKind::TimedOut.into()))
}

fn connect(address: &str) -> io::Result<TcpStream> {
    let mut last = io::Error::new(io::ErrorKind::NotFound, "the name leads nowhere");
    for address in address.to_socket_addrs()? {
        match TcpStream::connect_timeout(&address, CONNECT) {
            Ok(connection) => {
                connection.set_write_timeout(Some(PATIENCE))?;
                connection.set_nodelay(true)?;
                return Ok(connection);
            }
            Err(error) => last = error,
        }
    }
    Err(last)
}

fn send_pictures(mut connection: &TcpStream, state: &LiveState) -> io::Result<()> {
    let (mut version, mut number, mut shown) = (0, 0, None);
    loop {
        let view = state.view_after(version, Duration::from_millis(500), false);
        version = view.version;
        let picture = &view.picture;
        if picture.number != number && !picture.mean.is_empty() {
            number = picture.number;
            let name = format!("{} (gpt)", view.status.scene);
            let what = (name.clone(), picture.width, picture.height);
            if shown.as_ref() != Some(&what) {
                if let Some((before, ..)) = &shown {
                    connection.write_all(&close(before))?;
                }
                connection.write_all(&create(&name, [picture.width, picture.height]))?;
                shown = Some(what);
            }
            send(connection, &name, picture)?;
        } else if view.is_closed {
            return Ok(());
        }
    }
}

fn send(mut connection: &TcpStream, name: &str, picture: &LivePicture) -> io::Result<()> {
    let at_once = (PIXELS_AT_ONCE / picture.width).max(1);
    for first in (0..picture.height).step_by(at_once as usize) {
        let end = (first + at_once).min(picture.height);
        let pixels = &picture.mean[first as usize * picture.width as usize..end as usize * picture.width as usize];
        connection.write_all(&update(name, [0, first, picture.width, end - first], pixels))?;
    }
    Ok(())
}

fn close(name: &str) -> Vec<u8> {
    packet(CLOSE_IMAGE, |bytes| text(bytes, name))
}

fn create(name: &str, size: [u32; 2]) -> Vec<u8> {
    packet(CREATE_IMAGE, |bytes| {
        bytes.push(1); // it comes to the front
        text(bytes, name);
        size.iter().for_each(|side| bytes.extend(side.to_le_bytes()));
        channels(bytes);
    })
}

/// Pixels of a region: first column and row, width and height.
fn update(name: &str, region: [u32; 4], pixels: &[[f32; 3]]) -> Vec<u8> {
    packet(UPDATE_IMAGE, |bytes| {
        bytes.push(0); // it stays where it is
        text(bytes, name);
        channels(bytes);
        region.iter().for_each(|number| bytes.extend(number.to_le_bytes()));
        // For each channel, where its first number stands and how far apart its numbers are.
        [0_u64, 1, 2, 3, 3, 3].iter().for_each(|number| bytes.extend(number.to_le_bytes()));
        pixels.iter().flatten().for_each(|value| bytes.extend(value.to_le_bytes()));
    })
}

fn channels(bytes: &mut Vec<u8>) {
    bytes.extend(3_u32.to_le_bytes());
    ["R", "G", "B"].iter().for_each(|channel| text(bytes, channel));
}

/// Ends with a zero, so none may be in it.
fn text(bytes: &mut Vec<u8>, text: &str) {
    bytes.extend(text.bytes().filter(|byte| *byte != 0));
    bytes.push(0);
}

/// The length counts itself.
fn packet(kind: u8, fill: impl FnOnce(&mut Vec<u8>)) -> Vec<u8> {
    let mut bytes = vec![0, 0, 0, 0, kind];
    fill(&mut bytes);
    let length = (bytes.len() as u32).to_le_bytes();
    bytes[..4].copy_from_slice(&length);
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packets_are_laid_out_as_tev_reads_them() {
        assert_eq!(close("a"), [7, 0, 0, 0, 2, b'a', 0]);
        let created = create("a\0b", [3, 2]);
        let expected = [&[27, 0, 0, 0, 4, 1, b'a', b'b', 0, 3, 0, 0, 0, 2, 0, 0, 0, 3, 0, 0, 0][..], b"R\0G\0B\0"].concat();
        assert_eq!(created, expected);
    }
}
