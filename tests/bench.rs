//! `gpt bench` as its users meet it. What its figures are worth is tested beside the code, on estimators whose variance, bias and speed are
//! known.

use std::fs;
use std::process::{Command, Output};

use serde_json::Value;
use tempfile::TempDir;

/// A scene that renders fast on the CPU: a lit sphere over nothing.
const SCENE: &str = r#"
[film]
size = [24, 16]
[camera]
position = [0, 0, 4]
look_at = [0, 0, 0]
vfov = 40
[[material]]
name = "grey"
type = "diffuse"
reflectance = 0.5
[[shape]]
type = "sphere"
center = [0, 0, 0]
radius = 1
material = "grey"
[[light]]
type = "environment"
radiance = 1
"#;

fn workplace() -> TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    fs::write(folder.path().join("scene.toml"), SCENE).expect("the scene file");
    folder
}

fn bench(folder: &TempDir, arguments: &str) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_gpt"));
    command.arg("bench").args(arguments.split_whitespace()).current_dir(folder.path());
    command.env("XDG_CACHE_HOME", folder.path().join("cache")).output().expect("the program starts")
}

/// Runs, expects this exit code, and returns what went to stdout and stderr.
fn expect(folder: &TempDir, code: i32, arguments: &str) -> [String; 2] {
    let output = bench(folder, arguments);
    let [stdout, stderr] = [output.stdout, output.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
    assert_eq!(output.status.code(), Some(code), "gpt bench {arguments}\n{stdout}{stderr}");
    [stdout, stderr]
}

fn json(folder: &TempDir, name: &str) -> Value {
    let text = fs::read(folder.path().join(name)).expect("the results");
    serde_json::from_slice(&text).expect("JSON")
}

#[test]
fn convergence_leaves_numbers_rows_and_a_page_that_asks_for_nothing() {
    let folder = workplace();
    let arguments =
        "convergence scene.toml --device cpu --sampler halton,independent --spp 8 --rungs 3 --replications 6 --output out";
    let [stdout, stderr] = expect(&folder, 0, arguments);
    assert!(stdout.contains("independent") && stdout.contains("slope"), "{stdout}");
    assert!(stderr.contains("rendering the reference"), "{stderr}");

    let results = json(&folder, "out/convergence.json");
    let scene = &results["scenes"][0];
    assert_eq!(scene["settings"].as_array().map(Vec::len), Some(2));
    let last = &scene["settings"][1]["rungs"][2];
    assert_eq!(last["spp"], 8);
    assert!(last["mse"]["low"].as_f64() <= last["mse"]["estimate"].as_f64());
    assert!(scene["settings"][1]["against_first"][0]["efficiency"]["verdict"].is_string());
    assert!(results["machine"]["date"].as_str().is_some_and(|date| date.ends_with("UTC")));

    let rows = fs::read_to_string(folder.path().join("out/convergence.csv")).expect("the rows");
    assert_eq!(rows.lines().count(), 1 + 2 * 3 * 6);
    let page = fs::read_to_string(folder.path().join("out/report.html")).expect("the page");
    assert!(page.contains("<svg") && page.contains("data:image/png;base64,"));
    for outside in ["http://", "https://", "<link", "src=\"/", "@import", "url("] {
        let found = page.replace("http://www.w3.org/2000/svg", "").contains(outside);
        assert!(!found, "the page asks for {outside}");
    }

    // The reference is kept, and found the next time.
    let [_, stderr] = expect(&folder, 0, arguments);
    assert!(stderr.contains("made earlier") && !stderr.contains("rendering the reference"), "{stderr}");
}

#[test]
fn a_reference_that_is_given_is_used_and_must_fit() {
    let folder = workplace();
    let gpt = |arguments: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_gpt"));
        command.args(arguments.split_whitespace()).current_dir(folder.path()).status().expect("the program starts")
    };
    assert!(gpt("render scene.toml --device cpu --spp 64 -q -o right.exr").success());
    assert!(gpt("render scene.toml --device cpu --spp 1 --size 8x8 -q -o wrong.exr").success());
    let common = "convergence scene.toml --device cpu --spp 4 --rungs 2 --replications 2 --reference";
    let [_, stderr] = expect(&folder, 0, &format!("{common} right.exr"));
    assert!(!stderr.contains("rendering the reference"), "{stderr}");
    let results = json(&folder, "gpt-bench/convergence/convergence.json");
    assert!(results["scenes"][0]["reference"]["own_error"].is_null());
    expect(&folder, 3, &format!("{common} wrong.exr"));
    expect(&folder, 3, &format!("{common} missing.exr"));
    expect(&folder, 3, &format!("{common} scene.toml"));
    let [_, stderr] = expect(&folder, 2, &format!("{common} right.exr cornell"));
    assert!(stderr.contains("one scene"), "{stderr}");
}

#[test]
fn mistakes_have_the_contracts_exit_codes() {
    let folder = workplace();
    fs::write(folder.path().join("file"), "").expect("a file");
    let dark = SCENE.replace("radiance = 1", "radiance = 0");
    fs::write(folder.path().join("dark.toml"), dark).expect("the scene file");
    for (code, arguments, said) in [
        (2, "", "Usage"),
        (2, "convergence --sampler haltom", "haltom"),
        (2, "convergence --replications 1", "2.."),
        (2, "convergence --size 0x5", "at least 1"),
        (
            2,
            "convergence --sampler halton,sobol,independent,stratified,quadrant --estimator mis,nee,bsdf --blend mixture,pick --heuristic power,balance",
            "60 settings",
        ),
        (3, "convergence no-such-scene", "no-such-scene"),
        (3, "convergence scene.toml missing.toml", "missing.toml"),
        (3, "convergence dark.toml --device cpu --spp 2", "black"),
        (4, "convergence scene.toml --device no-such-adapter", "no-such-adapter"),
        (1, "convergence scene.toml --device cpu --output file/below", "file/below"),
    ] {
        let [_, stderr] = expect(&folder, code, arguments);
        assert!(stderr.contains(said), "gpt bench {arguments}\n{stderr}");
    }
    let [stdout, _] = expect(&folder, 0, "convergence --help");
    assert!(stdout.contains("--reference-spp") && stdout.contains("Examples"), "{stdout}");
}
