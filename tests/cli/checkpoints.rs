//! Renders that are asked to stop and go on, and states that nobody goes on from.

use std::process::Child;
use std::time::{Duration, Instant};

use super::*;

pub fn start(place: &Workplace, arguments: &str) -> Child {
    place.command(arguments).stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("a process")
}

pub fn devices() -> Vec<&'static str> {
    let gpu = std::env::var("GPT_TEST_GPU").as_deref() != Ok("skip");
    ["cpu", "gpu"].into_iter().filter(|device| *device == "cpu" || gpu).collect()
}

/// A render of `a.exr` that is interrupted once there is the state `waited_for` keeps it, and goes on from one of that name to the picture of a render that
/// is not.
#[cfg(unix)]
pub fn goes_on(place: &Workplace, render: &str, waited_for: &str, gone_on_from: &str) {
    let before = place.files();
    place.expect(0, &format!("{render} -q"));
    let whole = fs::read(place.path("a.exr")).expect("the picture");
    fs::remove_file(place.path("a.exr")).expect("it is there");
    let mut command = place.command(&format!("{render} --checkpoint 0.02"));
    let child = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("a process");
    wait_for(place, waited_for);
    let sent = Command::new("kill").args(["-TERM", &child.id().to_string()]).status().expect("kill");
    assert!(sent.success());
    let output = child.wait_with_output().expect("an end");
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(130), "{said}");
    assert!(said.contains("--resume goes on from it") && !place.path("a.exr").exists(), "{said}");
    // The control: the state is that of this render.
    let other = place.expect(3, &format!("{render} --resume --seed 7"));
    assert!(other.contains("--seed"), "{other}");
    let said = place.expect(0, &format!("{render} --resume"));
    assert!(said.contains(&format!("going on from {gone_on_from}")), "{said}");
    assert!(fs::read(place.path("a.exr")).expect("the picture") == whole);
    assert_eq!(place.files(), [vec!["a.exr".to_owned()], before].concat());
}

/// Waits until the file is there.
#[cfg(unix)]
pub fn wait_for(place: &Workplace, name: &str) {
    let start = Instant::now();
    while !place.path(name).exists() {
        assert!(start.elapsed() < Duration::from_secs(60), "{name} never came");
        std::thread::sleep(Duration::from_millis(20));
    }
}

/// SIGTERM saves what is rendered, in the state and in a picture, unless a finished one stands there.
#[cfg(unix)]
#[test]
fn a_render_that_is_asked_to_stop_goes_on() {
    let place = Workplace::new();
    let terminate = |child: &Child| {
        let sent = Command::new("kill").args(["-TERM", &child.id().to_string()]).status().expect("kill");
        assert!(sent.success());
    };
    place.expect(0, "render scene.toml -q --device cpu --spp 2 --size 64x48 -o a.exr");
    let finished = fs::read(place.path("a.exr")).expect("the picture");
    let render = "render scene.toml --device cpu --size 64x48 --spp 100000000 --checkpoint 0.1 -o a.exr -o b.exr";
    for round in 0..2 {
        let mut command = place.command(&format!("{render}{}", if round > 0 { " --resume" } else { "" }));
        let child = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("a process");
        wait_for(&place, "a.exr.checkpoint");
        std::thread::sleep(Duration::from_millis(500));
        let asked = Instant::now();
        terminate(&child);
        let output = child.wait_with_output().expect("an end");
        let said = text(&output.stderr);
        assert!(asked.elapsed() < Duration::from_secs(10), "{:?}", asked.elapsed());
        assert_eq!(output.status.code(), Some(130), "{said}");
        assert!(said.contains("a.exr.checkpoint: the state is saved; --resume goes on from it"), "{said}");
        assert_eq!(said.contains("going on from a.exr.checkpoint"), round > 0, "{said}");
        assert_eq!(place.files(), ["a.exr", "a.exr.checkpoint", "b.exr", "scene.toml"]);
        assert_eq!(fs::read(place.path("a.exr")).expect("the picture"), finished);
        assert_eq!(header_number(&place.path("b.exr"), "gpt:brokenOff"), 1);
    }
}

/// The refusal names the settings in which the state differs, and the state stays.
#[cfg(unix)]
#[test]
fn a_state_of_another_render_is_refused_by_name() {
    let place = Workplace::new();
    let render = "render scene.toml --device cpu --size 64x48 --spp 100000000 -o a.exr";
    let mut child = start(&place, &format!("{render} --checkpoint 0.05"));
    wait_for(&place, "a.exr.checkpoint");
    child.kill().expect("it runs");
    child.wait().expect("an end");
    let state = fs::read(place.path("a.exr.checkpoint")).expect("the state");
    for (flags, words) in [
        ("--seed 5", "it was made with --seed 0, and this render has --seed 5"),
        ("--spp 7", "it was made with --spp 100000000, and this render has --spp 7"),
        ("--size 64x47", "it was made with --size 64x48, and this render has --size 64x47"),
        ("--max-depth 3", "--max-depth"),
        ("--adaptive", "it was made with --adaptive false, and this render has --adaptive true"),
        ("--target-error 0.1", "--target-error none"),
        ("--first-sample 3", "--first-sample 0"),
    ] {
        // The last of two flags counts.
        let flag = flags.split(' ').next().expect("a flag");
        let value = |name: &str, usual: &str| if flag == name { String::new() } else { format!("{name} {usual}") };
        let other = format!(
            "render scene.toml --device cpu -q --resume -o a.exr {flags} {} {}",
            value("--size", "64x48"),
            value("--spp", "100000000")
        );
        let said = place.expect(3, &other);
        assert!(said.replace("\n", " ").split_whitespace().collect::<Vec<_>>().join(" ").contains(words), "{flags}: {said}");
    }
    let changed = scene().replace("position = [3, 4, 5]", "position = [3, 4, 6]");
    assert_ne!(changed, scene());
    fs::write(place.path("scene.toml"), changed).expect("the scene");
    let said = place.expect(3, &format!("{render} --resume"));
    assert!(said.contains("another scene"), "{said}");
    fs::write(place.path("scene.toml"), scene()).expect("the scene");
    assert!(fs::read(place.path("a.exr.checkpoint")).expect("the state") == state);
    // A state that is damaged is none to go on from.
    for bad in [&state[..state.len() / 2], b"", b"something else"] {
        fs::write(place.path("a.exr.checkpoint"), bad).expect("the state");
        let said = place.expect(3, &format!("{render} --resume"));
        assert!(said.contains("a.exr.checkpoint") && said.contains("without --resume"), "{said}");
    }
    // The control: without --resume, the render begins anew and says what it replaces.
    let said = place.expect(0, "render scene.toml --device cpu --spp 1 --checkpoint 60 -o a.exr");
    assert!(said.contains("will be replaced"), "{said}");
    assert_eq!(place.files(), ["a.exr", "scene.toml"]);
}

/// A farm may ask again for what is there.
#[test]
fn finished_pictures_are_not_rendered_again() {
    let place = Workplace::new();
    let render = "render scene.toml --device cpu --resume -o a.exr -o a.png";
    place.expect(0, render);
    let pictures =
        || ["a.exr", "a.png"].map(|name| fs::metadata(place.path(name)).and_then(|data| data.modified()).expect("a file"));
    let made = pictures();
    let said = place.expect(0, render);
    assert!(said.contains("a.exr, a.png: finished before, nothing is left to render"), "{said}");
    assert_eq!(pictures(), made);
    // Controls: other settings, and a picture that is cut off.
    let said = place.expect(0, &format!("{render} --seed 3"));
    assert!(!said.contains("finished before") && pictures() != made, "{said}");
    let bytes = fs::read(place.path("a.exr")).expect("the picture");
    fs::write(place.path("a.exr"), &bytes[..bytes.len() - 9]).expect("it is cut");
    let said = place.expect(0, &format!("{render} --seed 3"));
    assert!(!said.contains("finished before"), "{said}");
    assert!(fs::read(place.path("a.exr")).expect("the picture") == bytes);
    let said = place.expect(2, "render scene.toml --device cpu --resume -o -");
    assert!(said.contains("standard output is none"), "{said}");
}
