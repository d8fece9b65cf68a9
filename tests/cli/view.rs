//! `gpt render --view`, `--watch` and `--display`, asked by plain sockets.
#![cfg(unix)]

use std::io::{BufRead, BufReader, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::process::{Child, ChildStderr};
use std::time::{Duration, Instant};

use super::*;

/// Long enough on any machine.
const PATIENCE: Duration = Duration::from_secs(120);

/// A render with a page.
struct Viewed {
    child: Child,
    stderr: BufReader<ChildStderr>,
    address: String,
    secret: String,
}

/// An answer of the server.
struct Answer {
    status: u32,
    head: String,
    body: Vec<u8>,
}

impl Viewed {
    fn start(place: &Workplace, arguments: &str) -> Self {
        let mut command = place.command(arguments);
        command.env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY");
        let mut child = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("a process");
        let mut stderr = BufReader::new(child.stderr.take().expect("its stderr"));
        let mut line = String::new();
        let url = loop {
            line.clear();
            assert!(stderr.read_line(&mut line).expect("what it says") > 0, "it ended without an address");
            if let Some((_, url)) = line.split_once("http://") {
                break url.trim().to_owned();
            }
        };
        let (address, secret) = url.trim_end_matches('/').split_once('/').expect("a secret");
        assert!(address.starts_with("127.0.0.1:") && secret.len() == 32, "{url}");
        Self { child, stderr, address: address.to_owned(), secret: secret.to_owned() }
    }

    /// Sends a whole request.
    fn send(&self, request: &str) -> Answer {
        let mut connection = TcpStream::connect(&self.address).expect("a connection");
        connection.write_all(request.as_bytes()).expect("it is taken");
        let mut bytes = Vec::new();
        connection.read_to_end(&mut bytes).expect("an answer");
        let end = bytes.windows(4).position(|window| window == b"\r\n\r\n").expect("an end of the head");
        let head = text(&bytes[..end]);
        let status = head.split(' ').nth(1).and_then(|code| code.parse().ok()).expect("a status");
        Answer { status, head, body: bytes[end + 4..].to_vec() }
    }

    fn get(&self, path: &str) -> Answer {
        self.send(&format!("GET /{}/{path} HTTP/1.1\r\nHost: {}\r\n\r\n", self.secret, self.address))
    }

    fn state(&self) -> Value {
        serde_json::from_slice(&self.get("state").body).expect("JSON")
    }

    /// The state, once it is as wanted.
    fn wait(&self, what: &str, is_wanted: impl Fn(&Value) -> bool) -> Value {
        let start = Instant::now();
        loop {
            let state = self.state();
            if is_wanted(&state) {
                return state;
            }
            assert!(start.elapsed() < PATIENCE, "never {what}: {state}");
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    /// Width, height, and red, green, blue, samples and standard error of each pixel.
    fn picture(&self, path: &str) -> ([u32; 2], Vec<[f32; 5]>) {
        let body = self.get(path).body;
        let words: Vec<[u8; 4]> = body.chunks_exact(4).map(|word| word.try_into().expect("four bytes")).collect();
        let number = |index: usize| u32::from_le_bytes(words[index]);
        let values: Vec<f32> = words[3..].iter().map(|word| f32::from_le_bytes(*word)).collect();
        ([number(0), number(1)], values.chunks_exact(5).map(|pixel| pixel.try_into().expect("five numbers")).collect())
    }

    /// Ends it by Ctrl-C; the exit code and what it said since its address.
    fn interrupt(mut self) -> (Option<i32>, String) {
        on_unix::interrupt(&self.child);
        let status = self.child.wait().expect("an end");
        let mut said = String::new();
        self.stderr.read_to_string(&mut said).expect("what it said");
        (status.code(), said)
    }
}

#[test]
fn the_page_shows_what_the_file_holds_to_who_knows_the_secret() {
    let place = Workplace::new();
    let viewed =
        Viewed::start(&place, "render scene.toml --device cpu --view --spp 8 --aov normal,depth -o a.exr --exposure auto");
    let state = viewed.wait("finished", |state| state["phase"] == "finished");
    assert_eq!((&state["width"], &state["height"], &state["samples"]), (&24.into(), &16.into(), &serde_json::json!([8, 8])));
    assert_eq!(
        (&state["scene"], &state["device"], &state["done"]),
        (&"scene".into(), &"CPU reference".into(), &(24 * 16 * 8).into())
    );
    assert_eq!((&state["exposure"], &state["tonemap"]), (&"auto".into(), &"agx".into()));
    assert!(state["noise"].as_f64() > Some(0.0), "{state}");

    let (size, pixels) = viewed.picture("picture");
    let file = place.image("a.exr");
    assert_eq!((size, pixels.len()), ([24, 16], file.pixels.len()));
    for (shown, saved) in pixels.iter().zip(&file.pixels) {
        assert_eq!((&shown[..3], shown[3]), (&saved[..], 8.0));
        assert!(shown[4] >= 0.0);
    }
    fs::write(place.path("saved.exr"), viewed.get("picture.exr").body).expect("a file");
    assert_eq!(place.image("saved.exr").pixels, file.pixels);
    assert_eq!(state["layers"], serde_json::json!(["N", "Z"]));
    let (_, normals) = viewed.picture("picture?layer=N");
    let length = |normal: &[f32; 5]| normal[..3].iter().map(|value| value * value).sum::<f32>().sqrt();
    assert!((length(&normals[8 * 24 + 12]) - 1.0).abs() < 0.05 && length(&normals[0]) == 0.0);

    let page = viewed.get("");
    let html = text(&page.body);
    assert!(page.status == 200 && html.starts_with("<!doctype html>") && html.contains("requestAnimationFrame"));
    assert!(!html.contains("http") && !html.contains(" src="), "everything is in it");
    for protection in ["default-src 'none'", "Referrer-Policy: no-referrer", "nosniff", "Cache-Control: no-store", "DENY"] {
        assert!(page.head.contains(protection), "{protection} is not in\n{}", page.head);
    }

    let Viewed { address, secret, .. } = &viewed;
    let ask = |path: &str, host: &str| viewed.send(&format!("GET {path} HTTP/1.1\r\nHost: {host}\r\n\r\n"));
    let wrong = "0".repeat(32);
    for (path, host) in [
        ("/", address.as_str()),
        ("/state", address),
        (&format!("/{wrong}/"), address),
        (&format!("/{wrong}/state"), address),
        (&format!("/{secret}/"), "evil.example"),
        (&format!("/{secret}/state"), &address.replace("127.0.0.1", "evil.example")),
    ] {
        let refused = ask(path, host);
        assert_eq!(refused.status, 403, "{path} of {host}");
        assert!(!text(&refused.body).contains(secret.as_str()));
    }
    assert_eq!(viewed.send(&format!("GET /{secret}/ HTTP/1.1\r\n\r\n")).status, 403, "without a host");
    assert_eq!(ask(&format!("/{secret}/"), &address.replace("127.0.0.1", "localhost")).status, 200, "the control");
    assert_eq!(viewed.send(&format!("POST /{secret}/ HTTP/1.1\r\nHost: {address}\r\n\r\n")).status, 405);
    assert_eq!(viewed.send("nonsense\r\n\r\n").status, 400);
    for missing in ["picture?layer=no", "no", "../state"] {
        assert_eq!(viewed.get(missing).status, 404, "{missing}");
    }
    let (code, said) = viewed.interrupt();
    assert_eq!(code, Some(0), "{said}");
    assert!(said.contains("stays until Ctrl-C") && !said.contains("will be saved"), "{said}");
}

#[test]
fn the_picture_converges_on_the_page_and_slow_browsers_hold_up_nothing() {
    let place = Workplace::new();
    let viewed = Viewed::start(&place, "render scene.toml --device cpu --size 48x32 --view --spp 100000000 -o a.exr");
    let first = viewed.wait("a picture", |state| state["samples"][0].as_u64() > Some(0));
    let silent: Vec<_> = (0..20).map(|_| TcpStream::connect(&viewed.address).expect("a connection")).collect();
    let later = viewed.wait("more samples", |state| state["samples"][0].as_u64() > first["samples"][0].as_u64());
    assert!(later["picture"].as_u64() > first["picture"].as_u64() && later["phase"] == "rendering", "{later}");
    let (_, pixels) = viewed.picture("picture");
    assert!(pixels[16 * 48 + 24][0] > 0.0 && pixels[16 * 48 + 24][3] >= 1.0);
    let (code, said) = viewed.interrupt();
    assert_eq!(code, Some(130), "{said}");
    drop(silent);
    assert!(header_number(&place.path("a.exr"), "gpt:samples") > 0);
}

/// All samples of the layers come before the picture's, but somebody watches: there is something of both at once.
#[test]
fn layers_are_there_with_the_first_picture() {
    let place = Workplace::new();
    for device in checkpoints::devices() {
        let render = format!("render scene.toml --device {device} --view --spp 100000000 --aov normal,depth -o a.exr");
        let viewed = Viewed::start(&place, &render);
        let state = viewed.wait("a picture with layers", |state| {
            state["samples"] == serde_json::json!([4, 4]) && state["layers"] == serde_json::json!(["N", "Z"])
        });
        assert!(["preparing", "layers"].contains(&state["phase"].as_str().unwrap_or_default()), "{state}");
        let middle = |path: &str| viewed.picture(path).1[8 * 24 + 12];
        let ([red, ..], [.., towards, _, _], [depth, ..]) =
            (middle("picture"), middle("picture?layer=N"), middle("picture?layer=Z"));
        assert!(red > 0.0 && (towards - 1.0).abs() < 0.05 && depth > 1.0, "{red} {towards} {depth}");
        viewed.wait("all samples of a layer", |state| state["phase"] == "layers" && state["done"].as_u64() > Some(0));
        assert_eq!(viewed.interrupt().0, Some(130));
    }
}

/// With errors to reach and samples that follow the noise, too.
#[test]
fn renders_in_steps_are_shown_with_their_error() {
    let place = Workplace::new();
    for goal in ["--target-error 1e-12", "--adaptive"] {
        let viewed = Viewed::start(&place, &format!("render scene.toml --device cpu --view --spp 100000000 {goal} -o a.exr"));
        let shows_error = goal.starts_with("--target");
        let state = viewed.wait("an error", |state| {
            state["samples"][0].as_u64() > Some(0) && (!shows_error || state["error"][0].as_f64() > Some(0.0))
        });
        assert_eq!(state["error"].is_null(), !shows_error, "{state}");
        let (_, pixels) = viewed.picture("picture");
        assert!(pixels[8 * 24 + 12][0] > 0.0 && pixels[0][..3] == [0.0; 3]);
        assert_eq!(viewed.interrupt().0, Some(130));
    }
}

#[test]
fn a_watched_scene_is_rendered_again_when_it_changes() {
    let place = Workplace::new();
    for device in checkpoints::devices() {
        fs::write(place.path("scene.toml"), scene()).expect("the scene");
        let viewed = Viewed::start(&place, &format!("render scene.toml --device {device} --view --watch --spp 4 -o a.exr"));
        let rendered =
            |round: u64| viewed.wait("rendered", |state| state["round"].as_u64() >= Some(round) && state["phase"] == "finished");
        let red = |pixels: &[[f32; 5]]| pixels[8 * 24 + 12][0];
        let first = rendered(1);
        let dim = red(&viewed.picture("picture").1);
        let again = |from: &str, to: &str| {
            let changed = scene().replace(from, to);
            assert_ne!(changed, scene());
            fs::write(place.path("scene.toml"), changed).expect("the scene");
        };
        again("[40, 30, 20]", "[80, 30, 20]");
        let second = rendered(first["round"].as_u64().expect("a number") + 1);
        let bright = red(&viewed.picture("picture").1);
        assert!((bright / dim - 2.0).abs() < 1e-3, "{device}: {dim} and {bright}");
        assert_eq!(place.image("a.exr").pixels[8 * 24 + 12][0], bright);

        again("intensity", "intensty");
        let broken = viewed.wait("refused", |state| state["phase"] == "failed");
        let message = broken["message"].as_str().unwrap_or_default();
        assert!(message.contains("intensty"), "{message}");
        assert_eq!(red(&viewed.picture("picture").1), bright, "the last picture stays");

        // The camera alone, and another size.
        again("size = [24, 16]", "size = [30, 20]");
        let third = rendered(second["round"].as_u64().expect("a number") + 1);
        assert_eq!((&third["width"], &third["message"]), (&30.into(), &"".into()));
        let round = third["round"].as_u64().expect("a number");
        fs::write(place.path("scene.toml"), scene().replace("look_at = [0, 0, 0]", "look_at = [0, 0, 9]")).expect("the scene");
        rendered(round + 1);
        assert_eq!(red(&viewed.picture("picture").1), 0.0, "it looks away");
        fs::write(place.path("scene.toml"), scene()).expect("the scene");
        rendered(round + 2);
        assert_eq!(red(&viewed.picture("picture").1), dim, "as at first");
        let (code, said) = viewed.interrupt();
        assert_eq!(code, Some(0), "{said}");
        assert_eq!(place.files(), ["a.exr", "scene.toml"]);
    }
}

#[test]
fn a_render_that_is_outdated_is_given_up() {
    let place = Workplace::new();
    let viewed = Viewed::start(&place, "render scene.toml --device cpu --view --watch -o a.exr --save-scene used.toml");
    viewed.wait("finished", |state| state["phase"] == "finished");
    fs::write(place.path("scene.toml"), scene().replace("spp = 8", "spp = 100000000")).expect("the scene");
    viewed.wait("rendering", |state| {
        state["round"] == 2 && state["samples"][0].as_u64() > Some(0) && state["phase"] == "rendering"
    });
    fs::write(place.path("scene.toml"), scene().replace("spp = 8", "spp = 9")).expect("the scene");
    let state = viewed.wait("finished", |state| state["round"].as_u64() >= Some(3) && state["phase"] == "finished");
    assert_eq!(state["samples"], serde_json::json!([9, 9]));
    assert_eq!(viewed.interrupt().0, Some(0));
    assert_eq!(place.files(), ["a.exr", "scene.toml", "used.toml"], "nothing is left of what was given up");
}

#[test]
fn watching_needs_a_page_and_a_file() {
    let place = Workplace::new();
    for (arguments, words) in [
        ("render scene.toml --watch", "--view"),
        ("render --view --watch", "gpt scenes cornell"),
        ("render - --view --watch", "standard input"),
        ("render scene.toml --view --watch -o -", "again and again"),
        ("render scene.toml --view --watch --resume", "--resume"),
        ("render scene.toml --display tev", "HOST:PORT"),
    ] {
        let said = place.expect(2, arguments);
        assert!(said.contains(words), "gpt {arguments}: {said}");
    }
}

/// A picture as tev would show it: name, width, height and channels by name.
#[derive(Default)]
struct Received {
    name: String,
    size: [usize; 2],
    pixels: Vec<[f32; 3]>,
    updates: u32,
}

/// Reads packets as tev does, until the connection ends.
fn receive(mut connection: TcpStream) -> Received {
    let mut received = Received::default();
    let mut length = [0; 4];
    while connection.read_exact(&mut length).is_ok() {
        let mut packet = vec![0; u32::from_le_bytes(length) as usize - 4];
        connection.read_exact(&mut packet).expect("the whole packet");
        let mut rest = &packet[1..];
        let mut take = |count: usize| {
            let (taken, after) = rest.split_at(count);
            rest = after;
            taken.to_vec()
        };
        let number = |bytes: Vec<u8>| i32::from_le_bytes(bytes.try_into().expect("four bytes")) as usize;
        let string = |take: &mut dyn FnMut(usize) -> Vec<u8>| {
            let letters: Vec<u8> = std::iter::from_fn(|| Some(take(1)[0]).filter(|letter| *letter != 0)).collect();
            text(&letters)
        };
        assert!(take(1)[0] <= 1, "whether it comes to the front");
        let name = string(&mut take);
        match packet[0] {
            4 => {
                let size = [number(take(4)), number(take(4))];
                assert_eq!(number(take(4)), 3);
                assert_eq!(
                    ["R", "G", "B"],
                    [string(&mut take), string(&mut take), string(&mut take)].each_ref().map(String::as_str)
                );
                received = Received { name, size, pixels: vec![[f32::NAN; 3]; size[0] * size[1]], updates: 0 };
            }
            6 => {
                assert_eq!((name.as_str(), number(take(4))), (received.name.as_str(), 3));
                assert_eq!(
                    ["R", "G", "B"],
                    [string(&mut take), string(&mut take), string(&mut take)].each_ref().map(String::as_str)
                );
                let [x, y, width, height] = std::array::from_fn(|_| number(take(4)));
                let long = |bytes: Vec<u8>| i64::from_le_bytes(bytes.try_into().expect("eight bytes")) as usize;
                let offsets: [usize; 3] = std::array::from_fn(|_| long(take(8)));
                let strides: [usize; 3] = std::array::from_fn(|_| long(take(8)));
                let values: Vec<f32> =
                    rest.chunks_exact(4).map(|value| f32::from_le_bytes(value.try_into().expect("four bytes"))).collect();
                for pixel in 0..width * height {
                    let place = (y + pixel / width) * received.size[0] + x + pixel % width;
                    received.pixels[place] = std::array::from_fn(|channel| values[offsets[channel] + pixel * strides[channel]]);
                }
                received.updates += 1;
            }
            kind => panic!("a packet of kind {kind}"),
        }
    }
    received
}

#[test]
fn tev_receives_the_picture() {
    let place = Workplace::new();
    let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
    let port = listener.local_addr().expect("its address").port();
    let receiver = std::thread::spawn(move || receive(listener.accept().expect("a connection").0));
    place.expect(0, &format!("render scene.toml --device cpu --spp 8 --display 127.0.0.1:{port} -o a.exr"));
    let received = receiver.join().expect("packets that tev understands");
    let file = place.image("a.exr");
    assert_eq!((received.name.as_str(), received.size), ("scene (gpt)", [24, 16]));
    assert!(received.pixels == file.pixels && received.updates > 0);
    // The control: with nobody there, nothing is rendered.
    let said = place.expect(1, &format!("render scene.toml --device cpu --display 127.0.0.1:{port} -o b.exr"));
    assert!(said.contains("is tev running"), "{said}");
    assert_eq!(place.files(), ["a.exr", "scene.toml"]);
}

/// The program is asked to end while the viewer stands still, and ends as soon as any render.
#[test]
#[ignore = "slow"]
fn a_tev_that_takes_nothing_does_not_hold_the_end() {
    let place = Workplace::new();
    let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
    let port = listener.local_addr().expect("its address").port();
    // More than the system keeps for a connection that nobody reads.
    let mut command = place.command(&format!(
        "render scene.toml --device cpu --size 2048x1536 --spp 100000000 --max-depth 1 --display 127.0.0.1:{port} -o a.exr"
    ));
    let mut child = command.stderr(Stdio::piped()).spawn().expect("a process");
    let (mut connection, _) = listener.accept().expect("a connection");
    // A picture has begun.
    connection.read_exact(&mut [0; 100_000]).expect("a part of a picture");
    std::thread::sleep(Duration::from_millis(500));
    let asked = Instant::now();
    // The system's own constant for SIGTERM.
    assert!(Command::new("kill").args(["-TERM", &child.id().to_string()]).status().expect("kill").success());
    let mut said = String::new();
    child.stderr.take().expect("its stderr").read_to_string(&mut said).expect("text");
    let status = child.wait().expect("it ends");
    assert!(asked.elapsed() < Duration::from_secs(10), "{:?} {said}", asked.elapsed());
    assert!(status.code() != Some(0) && said.contains("did not take the last picture"), "{status} {said}");
}

/// Connections that never send the secret make room for the page.
#[test]
fn strangers_do_not_keep_the_page_out() {
    let place = Workplace::new();
    let viewed = Viewed::start(&place, "render scene.toml --device cpu --view --spp 100000000 -o a.exr");
    for _ in 0..3 {
        let idle: Vec<TcpStream> = (0..40).map(|_| TcpStream::connect(&viewed.address).expect("a connection")).collect();
        let asked = Instant::now();
        assert_eq!(viewed.get("state").status, 200);
        assert!(asked.elapsed() < Duration::from_secs(3), "{:?}", asked.elapsed());
        drop(idle);
    }
    viewed.interrupt();
}
