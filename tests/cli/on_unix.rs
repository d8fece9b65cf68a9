//! Signals and terminals.

use std::os::unix::process::CommandExt;
use std::process::Child;
use std::time::{Duration, Instant};

use super::*;

/// Signals end the program as they do at a terminal, though `nohup`, or a shell's `&`, ignores some for the tests and what they start.
pub fn obey_signals(command: &mut Command) {
    let reset = || {
        for signal in [libc::SIGINT, libc::SIGHUP, libc::SIGQUIT, libc::SIGTERM, libc::SIGXCPU] {
            // SAFETY: `signal` may be called between fork and exec, and SIG_DFL runs no code of this process.
            unsafe { libc::signal(signal, libc::SIG_DFL) };
        }
        Ok(())
    };
    // SAFETY: the closure calls nothing but `signal`, and takes no memory and no lock.
    unsafe { command.pre_exec(reset) };
}

pub fn interrupt(child: &Child) {
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

/// A picture that was finished before stays, and the one that was not lies beside it.
#[test]
fn an_interrupted_picture_replaces_no_finished_one() {
    let place = Workplace::new();
    place.expect(0, "render scene.toml --device cpu --spp 2 -o a.exr -o a.png -q");
    let finished = ["a.exr", "a.png"].map(|name| fs::read(place.path(name)).expect("the picture"));
    let child = start_endless_render(&place);
    std::thread::sleep(Duration::from_secs(2));
    interrupt(&child);
    let output = child.wait_with_output().expect("an end");
    let stderr = text(&output.stderr);
    assert_eq!(output.status.code(), Some(130), "{stderr}");
    assert_eq!(place.files(), ["a.exr", "a.incomplete.exr", "a.incomplete.png", "a.png", "s.json", "scene.toml"]);
    assert_eq!(["a.exr", "a.png"].map(|name| fs::read(place.path(name)).expect("the picture")), finished);
    assert!(stderr.contains("a.incomplete.exr is written beside a finished picture"), "{stderr}");
    assert_eq!(header_number(&place.path("a.incomplete.exr"), "gpt:brokenOff"), 1);
    assert_eq!(header_number(&place.path("a.exr"), "gpt:brokenOff"), 0);
    // The summary says what is in the picture, not what was wanted.
    let done = place.stats("s.json")["spp_done"].as_u64().expect("a number");
    assert!(stderr.contains(&format!(", {done} ")) && stderr.contains("of 100000000 when it was interrupted"), "{stderr}");
    // One that broke off is replaced by a finished one.
    place.expect(0, "render scene.toml --device cpu --spp 2 -o a.incomplete.exr -q");
    assert_eq!(header_number(&place.path("a.incomplete.exr"), "gpt:brokenOff"), 0);
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

/// Signals that end a program leave nothing half written; what asks it to end has it save; `nohup` is obeyed.
#[test]
#[ignore = "slow"]
fn signals_are_obeyed_and_nothing_is_left() {
    let place = Workplace::new();
    for signal in ["-TERM", "-HUP", "-XCPU", "-QUIT"] {
        let child = start_endless_render(&place);
        std::thread::sleep(Duration::from_secs(2));
        let status = Command::new("kill").args([signal, &child.id().to_string()]).status().expect("kill");
        assert!(status.success());
        let output = child.wait_with_output().expect("an end");
        let saves = signal != "-QUIT";
        assert_eq!(output.status.code(), saves.then_some(130), "{signal}: {}", text(&output.stderr));
        let mut files = vec!["scene.toml"];
        if saves {
            files.splice(0..0, ["a.exr", "a.png", "s.json"]);
        }
        assert_eq!(place.files(), files, "{signal}");
        for name in ["a.exr", "a.png", "s.json"].into_iter().filter(|_| saves) {
            fs::remove_file(place.path(name)).expect("it is there");
        }
    }
    // Started by `nohup`.
    let mut command = Command::new("bash");
    let render = "render scene.toml --device cpu --spp 100000000 -o a.exr -o a.png";
    command.args(["-c", &format!("trap '' HUP; exec {} {render}", env!("CARGO_BIN_EXE_gpt"))]).current_dir(place.0.path());
    let mut child = command.stderr(Stdio::null()).spawn().expect("bash");
    std::thread::sleep(Duration::from_secs(3));
    let send = |signal: &str| Command::new("kill").args([signal, &child.id().to_string()]).status().expect("kill").success();
    assert!(send("-HUP"));
    std::thread::sleep(Duration::from_secs(2));
    assert!(send("-TERM"), "it went on");
    assert_eq!(child.wait().expect("an end").code(), Some(130));
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
