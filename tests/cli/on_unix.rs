//! Signals and terminals.

use std::process::Child;
use std::time::{Duration, Instant};

use super::*;

fn interrupt(child: &Child) {
    let status = Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill");
    assert!(status.success(), "the render had ended before it was interrupted");
}

/// A render of hours, after its temporary files appeared.
fn start_endless_render(place: &Workplace) -> Child {
    let mut command =
        place.command("render scene.toml --device cpu --size 64x64 --spp 100000000 -o a.exr -o a.png --stats s.json");
    let child = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("a process");
    let deadline = Instant::now() + Duration::from_secs(60);
    while place.files().iter().filter(|name| name.ends_with(".part")).count() < 2 {
        assert!(Instant::now() < deadline, "the render never began its files");
        std::thread::sleep(Duration::from_millis(10));
    }
    child
}

#[test]
fn the_first_interrupt_saves_what_is_rendered() {
    let place = Workplace::new();
    let child = start_endless_render(&place);
    // Long enough for the first samples of every pixel.
    std::thread::sleep(Duration::from_secs(2));
    interrupt(&child);
    let output = child.wait_with_output().expect("an end");
    let stderr = text(&output.stderr);
    assert_eq!(output.status.code(), Some(130), "{stderr}");
    assert!(stderr.contains("interrupted"), "{stderr}");
    assert_eq!(place.files(), ["a.exr", "a.png", "s.json", "scene.toml"]);
    let image = place.image("a.exr");
    assert!(image.pixels.iter().any(|pixel| pixel[0] > 0.0), "nothing was saved");
    assert_eq!(header_number(&place.path("a.exr"), "gpt:complete"), 0);
    let samples = header_number(&place.path("a.exr"), "gpt:samples");
    assert!((0..100_000_000).contains(&samples), "{samples}");
    let stats = place.stats("s.json");
    assert_eq!(stats["interrupted"], true);
    assert!(stats["samples"].as_u64() > Some(0));
}

#[test]
fn the_second_interrupt_quits_at_once_and_leaves_nothing_half_written() {
    let place = Workplace::new();
    let mut child = start_endless_render(&place);
    interrupt(&child);
    while child.try_wait().expect("a process").is_none() {
        // Refused once the process is gone, which is what is waited for.
        let _ = Command::new("kill").args(["-INT", &child.id().to_string()]).stderr(Stdio::null()).status();
        std::thread::sleep(Duration::from_millis(5));
    }
    assert_eq!(child.wait().expect("a process").code(), Some(130));
    assert!(place.files().iter().all(|name| !name.ends_with(".part")), "{:?}", place.files());
}

#[cfg(target_os = "linux")]
#[test]
fn no_color_is_honoured_on_a_terminal() {
    let place = Workplace::new();
    // `script` gives the program a terminal.
    let on_a_terminal = |no_color: bool| {
        let mut command = Command::new("script");
        command.args(["-qec", concat!(env!("CARGO_BIN_EXE_gpt"), " render missing.toml"), "/dev/null"]);
        command.current_dir(place.0.path()).env("TERM", "xterm-256color").env_remove("NO_COLOR").stdin(Stdio::null());
        if no_color {
            command.env("NO_COLOR", "1");
        }
        let output = command.output().expect("util-linux's `script`");
        assert_eq!(output.status.code(), Some(3));
        text(&output.stdout)
    };
    assert!(on_a_terminal(false).contains('\u{1b}'), "colours where nothing forbids them");
    assert!(!on_a_terminal(true).contains('\u{1b}'), "no colours with NO_COLOR");
}
