//! Renders that end early, and what they leave behind.

use std::time::{Duration, Instant};

use super::*;

/// Inside a box of mirrors that lose nothing: no path ever ends.
const MIRROR_BOX: &str = "[film]\nsize = [24, 16]\n[render]\nmax_depth = 1000000000\nroulette_depth = 0\n\
    [camera]\nposition = [0.1, 0.2, 0.3]\nlook_at = [0.7, 0.1, 1]\nvfov = 40\n\
    [[material]]\nname = \"mirror\"\ntype = \"mirror\"\nreflectance = 1\n\
    [[shape]]\ntype = \"box\"\nmin = [-1, -1, -1]\nmax = [1, 1, 1]\nmaterial = \"mirror\"\n\
    [[light]]\ntype = \"environment\"\nradiance = 1\n";

fn devices() -> &'static [&'static str] {
    if std::env::var("GPT_TEST_GPU").as_deref() == Ok("skip") { &["cpu"] } else { &["cpu", "gpu"] }
}

#[test]
#[ignore = "slow"]
fn paths_that_never_end_are_given_up_when_the_time_is_up() {
    let place = Workplace::new();
    fs::write(place.path("mirrors.toml"), MIRROR_BOX).expect("a file");
    for device in devices() {
        let start = Instant::now();
        let said = place.expect(1, &format!("render mirrors.toml --device {device} --time-limit 1 -o a.exr"));
        assert!(said.contains("--max-depth"), "{said}");
        assert!(start.elapsed() < Duration::from_secs(20), "{device}: {:?}", start.elapsed());
        assert_eq!(place.files(), ["mirrors.toml", "scene.toml"]);
    }
    // The control: with an end of paths the same room is rendered.
    place.expect(0, "render mirrors.toml --device cpu --max-depth 8 --spp 1 -o a.exr");
}

#[cfg(unix)]
#[test]
#[ignore = "slow"]
fn paths_that_never_end_are_given_up_at_an_interrupt() {
    let place = Workplace::new();
    fs::write(place.path("mirrors.toml"), MIRROR_BOX).expect("a file");
    for device in devices() {
        let mut command = place.command(&format!("render mirrors.toml --device {device} -o a.exr"));
        let child = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("a process");
        std::thread::sleep(Duration::from_secs(3));
        on_unix::interrupt(&child);
        let asked = Instant::now();
        let output = child.wait_with_output().expect("an end");
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(130), "{said}");
        assert!(said.contains("nothing is saved"), "{said}");
        assert!(asked.elapsed() < Duration::from_secs(15), "{device}: {:?}", asked.elapsed());
        assert_eq!(place.files(), ["mirrors.toml", "scene.toml"]);
    }
}

/// Shapes that single precision does not hold are no silent mistake.
#[test]
fn shapes_beyond_single_precision_are_warned_of() {
    let place = Workplace::new();
    let large = scene().replace("radius = 1", "radius = 1e12");
    assert_ne!(large, scene());
    fs::write(place.path("large.toml"), large).expect("a file");
    for command in ["render large.toml --device cpu --spp 1 -q -o a.exr", "check large.toml"] {
        let said = place.expect(0, command);
        assert!(said.contains("2.0e12 units") && said.contains("single precision"), "{said}");
    }
    assert!(!place.expect(0, "check scene.toml").contains("single precision"));
}

#[test]
fn parts_of_strata_are_refused() {
    let place = Workplace::new();
    let said = place.expect(2, "render scene.toml --device cpu --sampler stratified --first-sample 4 --spp 4");
    assert!(said.contains("stratified"), "{said}");
    place.expect(0, "render scene.toml --device cpu --sampler stratified --spp 4 -q -o a.exr");
}

#[test]
#[ignore = "slow"]
fn a_time_limit_that_is_not_reached_changes_no_bit() {
    let place = Workplace::new();
    for device in devices() {
        for goal in ["", "--adaptive", "--target-error 2e-3", "--adaptive --target-error 2e-3", "--target-error 1e-9"] {
            let render = format!("render scene.toml --device {device} --spp 300 {goal} -q");
            place.expect(0, &format!("{render} -o a.exr"));
            place.expect(0, &format!("{render} --time-limit 1e6 -o b.exr"));
            let [a, b] = ["a.exr", "b.exr"].map(|name| fs::read(place.path(name)).expect("the picture"));
            assert!(a == b, "{device} {goal}: the files differ");
        }
    }
    // The control: a limit that is reached does.
    place.expect(0, "render scene.toml --device cpu --spp 100000000 --adaptive --time-limit 0.3 -q -o b.exr");
    assert!(place.image("a.exr") != place.image("b.exr"));
}
