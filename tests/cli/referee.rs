//! `gpt referee`, with runners that are shell scripts.

use std::fs;

use serde_json::Value;

use crate::{Workplace, text};

/// Exit code, answer and messages.
fn said(work: &Workplace, arguments: &str) -> (i32, String, String) {
    let output = work.run(arguments);
    (output.status.code().expect("it ends"), text(&output.stdout), text(&output.stderr))
}

/// Two tests, as files in the folder `suite`.
fn exported() -> Workplace {
    let work = Workplace::new();
    assert_eq!(said(&work, "referee export suite lights/point textures/srgb").0, 0);
    work
}

/// A runner that copies the true picture of the test whose scene it gets, after what `before` does.
fn runner(work: &Workplace, name: &str, body: &str) -> String {
    fs::write(work.path(name), format!("set -e\nscene=$1 output=$2\n{body}\n")).expect("a file");
    format!("sh {} {{scene}} {{output}}", work.path(name).display())
}

const COPY: &str =
    "case $scene in *lights-point*) cp suite/lights/point/truth.exr $output;; *) cp suite/textures/srgb/truth.exr $output;; esac";

fn judged(work: &Workplace, command: &str, more: &[&str]) -> (i32, Value) {
    let mut arguments = vec!["referee", "run", "lights/point", "textures/srgb", "--json", "--quiet", "--command", command];
    arguments.extend(more);
    let output = work.command("").args(arguments).output().expect("the program starts");
    let answer = text(&output.stdout);
    let value = serde_json::from_str(&answer).unwrap_or_else(|_| panic!("{answer} {}", text(&output.stderr)));
    (output.status.code().expect("it ends"), value)
}

fn verdicts(report: &Value) -> Vec<&str> {
    report["tests"].as_array().expect("a list").iter().map(|test| test["verdict"].as_str().expect("a word")).collect()
}

#[test]
fn tests_are_listed() {
    let work = Workplace::new();
    let (status, answer, _) = said(&work, "referee list --json");
    let list: Value = serde_json::from_str(&answer).expect("JSON");
    assert_eq!(status, 0);
    assert!(list.as_array().expect("a list").len() >= 80);
    let (status, _, errors) = said(&work, "referee list no-such-test");
    assert!(status == 2 && errors.contains("no-such-test"), "{errors}");
}

#[test]
fn exports_are_equal_and_whole() {
    let work = exported();
    assert_eq!(said(&work, "referee export again lights/point textures/srgb").0, 0);
    let sums = |folder: &str| fs::read_to_string(work.path(folder).join("SHA256SUMS")).expect("digests");
    assert_eq!(sums("suite"), sums("again"));
    for file in ["scene.toml", "scene.xml", "scene.glb", "scene.pbrt", "truth.exr", "test.json"] {
        assert!(sums("suite").contains(&format!("textures/srgb/{file}")), "{file}");
    }
    let folder = work.path("suite").display().to_string();
    let xml = fs::read_to_string(work.path("suite/textures/srgb/scene.xml")).expect("a scene");
    assert!(xml.contains("codes.png") && !xml.contains(&folder), "{xml}");
    // A folder with files in it is left alone.
    let (status, _, errors) = said(&work, "referee export suite lights/point");
    assert!(status == 2 && errors.contains("not empty"), "{errors}");
}

#[test]
#[ignore = "slow"]
fn a_right_renderer_agrees_and_wrong_ones_are_told_why() {
    let work = exported();
    let right = runner(&work, "right.sh", COPY);
    let (status, report) = judged(&work, &right, &[]);
    assert_eq!((status, verdicts(&report)), (0, vec!["agrees", "agrees"]));

    // The scene of a mistake, rendered: an sRGB texture that is read as linear.
    let program = env!("CARGO_BIN_EXE_gpt");
    let body = format!(
        "sed 's/\"srgb\"/\"linear\"/' $scene > $scene.wrong.toml\n{program} render $scene.wrong.toml --device cpu --spp 32 --quiet -o $output"
    );
    let linear = runner(&work, "linear.sh", &body);
    let (status, report) = judged(&work, &linear, &[]);
    assert_eq!((status, verdicts(&report)), (7, vec!["agrees", "differs"]));
    let test = &report["tests"][1];
    assert_eq!(test["looks_like"][0], "an sRGB texture that is read as linear");
    assert!(test["at_least"].as_f64().is_some_and(|share| share > 0.05), "{test}");
}

#[test]
fn what_is_no_picture_is_a_verdict() {
    let work = exported();
    fs::write(work.path("codes.png"), b"\x89PNG\r\n\x1a\n").expect("a file");
    for (body, reason) in [
        ("echo broken >&2; exit 3", "broken"),
        ("true", "no picture"),
        ("cp codes.png $output", "codes for a display"),
        ("echo nothing > $output", "Format"),
    ] {
        let command = runner(&work, "wrong.sh", body);
        let (status, report) = judged(&work, &command, &[]);
        assert_eq!((status, verdicts(&report)), (7, vec!["failed", "failed"]), "{body}");
        let said = report["tests"][0]["reason"].as_str().expect("a reason");
        assert!(said.contains(reason) || reason == "Format", "{said}");
    }
    // A status of its own says that the scene cannot be said, which is no fault.
    let unable = runner(&work, "unable.sh", "echo it knows no lamps; exit 64");
    let (status, report) = judged(&work, &unable, &[]);
    assert_eq!((status, verdicts(&report)), (0, vec!["not_supported", "not_supported"]));
    assert_eq!(report["tests"][0]["reason"], "it knows no lamps");
    let slow = runner(&work, "slow.sh", "exec sleep 60");
    let (status, report) = judged(&work, &slow, &["--timeout", "0.2"]);
    assert_eq!((status, verdicts(&report)), (7, vec!["failed", "failed"]));
}

#[test]
fn reports_are_written_and_exceptions_are_no_failure() {
    let work = exported();
    // Each gets the other's picture.
    let body = "case $scene in *lights-point*) cp suite/textures/srgb/truth.exr $output;; *) cp suite/textures/srgb/truth.exr $output;; esac";
    let command = runner(&work, "other.sh", body);
    fs::write(work.path("known.toml"), "\"lights/point\" = \"it has no point lights\"\n").expect("a file");
    let reports = ["--junit", "a.xml", "--html", "a.html", "--badge", "a.svg"];
    let (status, report) = judged(&work, &command, &[&["--exceptions", "known.toml"], &reports[..]].concat());
    assert_eq!((status, verdicts(&report)), (0, vec!["excepted", "agrees"]));
    let read = |name: &str| fs::read_to_string(work.path(name)).expect("a report");
    assert!(read("a.xml").contains("it has no point lights") && read("a.xml").contains("skipped=\"1\""));
    assert!(read("a.html").contains("lights/point") && read("a.svg").contains("1 of 2 agree"));
    // The control: without the exception it is wrong.
    let (status, report) = judged(&work, &command, &[]);
    assert_eq!((status, verdicts(&report)), (7, vec!["differs", "agrees"]));
    fs::write(work.path("known.toml"), "\"lights/no-such-test\" = \"\"\n").expect("a file");
    let arguments = ["referee", "run", "--command", &command, "--exceptions", "known.toml"];
    let output = work.command("").args(arguments).output().expect("the program starts");
    assert_eq!(output.status.code(), Some(3));
}

#[test]
fn commands_without_their_words_are_refused() {
    let work = Workplace::new();
    for command in ["mine {scene}", "mine {output}", "", "mine '{scene} {output}"] {
        let output = work.command("").args(["referee", "run", "--command", command]).output().expect("the program starts");
        assert_eq!(output.status.code(), Some(2), "{command}");
    }
    let (status, ..) = said(&work, "referee run");
    assert_eq!(status, 2);
}

#[test]
fn pictures_that_were_made_before_are_judged() {
    let work = exported();
    fs::create_dir(work.path("mine")).expect("a folder");
    fs::copy(work.path("suite/lights/point/truth.exr"), work.path("mine/lights-point.exr")).expect("a copy");
    let (status, answer, errors) = said(&work, "referee run lights/point textures/srgb --pictures mine");
    assert_eq!(status, 0, "{errors}");
    assert!(answer.contains("agrees         lights/point") && answer.contains("not supported  textures/srgb"), "{answer}");
}
