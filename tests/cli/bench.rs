//! `gpt bench` as its users meet it. What its figures are worth is tested beside the code, on estimators whose variance, bias and speed are
//! known.

use std::fs;
use std::process::{Command, Output};

use crate::common::effort::announce;
use crate::common::sphere::grey_sphere;
use serde_json::Value;
use tempfile::TempDir;

/// A scene that renders fast on the CPU: a lit sphere over nothing.
fn scene() -> String {
    grey_sphere("[film]\nsize = [24, 16]", "type = \"environment\"\nradiance = 1")
}

fn workplace() -> TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    fs::write(folder.path().join("scene.toml"), scene()).expect("the scene file");
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
        "convergence scene.toml --device cpu --sampler halton,independent --spp 8 --levels 3 --replications 6 --output out";
    let [stdout, stderr] = expect(&folder, 0, arguments);
    assert!(stdout.contains("independent") && stdout.contains("slope"), "{stdout}");
    assert!(stderr.contains("rendering the reference"), "{stderr}");

    let results = json(&folder, "out/convergence.json");
    let scene = &results["scenes"][0];
    assert_eq!(scene["settings"].as_array().map(Vec::len), Some(2));
    let last = &scene["settings"][1]["levels"][2];
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
    let common = "convergence scene.toml --device cpu --spp 4 --levels 2 --replications 2 --reference";
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
fn speed_leaves_a_table_for_everything_that_grows() {
    let folder = workplace();
    let arguments = "speed scene.toml --device cpu --growth scenes,samples,leaves --size 12x8 --spp 1 --rounds 6 --output out";
    let [stdout, _] = expect(&folder, 0, arguments);
    assert!(stdout.contains("Msample/s") && stdout.contains("leaves of a blend"), "{stdout}");
    let tables = &json(&folder, "out/speed.json")["tables"];
    assert_eq!(tables.as_array().map(Vec::len), Some(3));
    let samples = &tables[1]["rows"];
    assert_eq!(samples[3]["spp"], 64);
    // The first row has nothing to be compared with; the others are compared run by run.
    assert!(samples[0]["measured"]["time_per_sample"].is_null());
    assert!(samples[3]["measured"]["time_per_sample"]["estimate"].as_f64() > Some(0.0));
    let rows = fs::read_to_string(folder.path().join("out/speed.csv")).expect("the rows");
    assert_eq!(rows.lines().count(), 1 + 1 + 4 + 4);
    assert!(fs::read_to_string(folder.path().join("out/report.html")).expect("the page").contains("<svg"));
}

/// Without a GPU these fail, unless `GPT_TEST_GPU=skip` is set.
fn without_a_gpu() -> bool {
    std::env::var("GPT_TEST_GPU").is_ok_and(|value| value == "skip")
}

/// One edge is one ray, without a second for light.
#[test]
fn paths_are_as_long_as_asked_for() {
    let folder = workplace();
    for (depth, least, most) in [(1, 1.0, 1.0), (2, 1.1, 3.0)] {
        let arguments = "speed scene.toml --device cpu --growth scenes,samples --size 12x8 --spp 2 --rounds 1 --output out";
        expect(&folder, 0, &format!("{arguments} --depth {depth}"));
        let tables = &json(&folder, "out/speed.json")["tables"];
        for table in 0..2 {
            let rays = tables[table]["rows"][0]["measured"]["rays_per_sample"].as_f64().unwrap_or(f64::NAN);
            assert!((least..=most).contains(&rays), "{rays} rays at depth {depth}");
        }
    }
}

#[test]
fn stages_are_timed_and_the_pool_is_watched() {
    if without_a_gpu() {
        return;
    }
    let folder = workplace();
    let common = "--device gpu --growth scenes --size 32x32 --spp 1 --rounds 2 --output out";
    expect(&folder, 0, &format!("speed cornell --stages wavefront {common}"));
    let row = &json(&folder, "out/speed.json")["tables"][0]["rows"][0]["measured"];
    let stages: Vec<&str> =
        row["stage_times"].as_array().into_iter().flatten().filter_map(|stage| stage["stage"].as_str()).collect();
    // An adapter without time stamps has no times; Mesa's software adapter has them.
    if stages.is_empty() {
        announce("left out: times of stages, since the adapter has no time stamps");
    } else {
        // In the table's order; a scene may not need all.
        let table: Vec<&str> = gpt::plan::stages::STAGES
            .iter()
            .filter(|stage| stage.mode == gpt::plan::StageMode::Wavefront)
            .map(|stage| stage.entry)
            .collect();
        let in_order: Vec<&str> = table.iter().copied().filter(|stage| stages.contains(stage)).collect();
        assert_eq!(stages, in_order);
        assert!(["generate", "shade", "accumulate"].iter().all(|stage| stages.contains(stage)), "{stages:?}");
        let occupancy: Vec<f64> = row["occupancy"].as_array().into_iter().flatten().filter_map(Value::as_f64).collect();
        assert!((2..=8).contains(&occupancy.len()), "{occupancy:?}");
        assert!(occupancy[0] > 0.0 && occupancy[0] <= 1.0, "{occupancy:?}");
        // Paths end and none begins: in the box, whose front is open, some leave at every edge.
        assert!(occupancy.windows(2).all(|pair| pair[1] < pair[0]), "{occupancy:?}");
    }
    assert_eq!(row["bytes_per_path"], 136);
}

#[test]
#[ignore = "slow"]
fn features_are_compared_off_compiled_in_and_used() {
    if without_a_gpu() {
        return;
    }
    let folder = workplace();
    expect(&folder, 0, "features glass motion --size 32x32 --spp 2 --rounds 6 --output out");
    let features = &json(&folder, "out/features.json")["features"];
    for feature in features.as_array().expect("a list") {
        assert_eq!(feature["compiled_in_agrees"], true, "{feature}");
        assert_eq!(feature["off"]["rays_per_sample"], feature["compiled_in"]["rays_per_sample"]);
        assert_eq!(feature["off"]["time"]["estimate"], 1.0);
        assert!(feature["used"]["time"]["low"].as_f64() > Some(0.0));
    }
    assert_ne!(features[0]["off"]["rays_per_sample"], features[0]["used"]["rays_per_sample"]);
    let [_, stderr] = expect(&folder, 2, "features no-such-feature");
    assert!(stderr.contains("rough glass"), "{stderr}");
    expect(&folder, 4, "features --device cpu");
}

#[test]
fn mistakes_have_the_contracts_exit_codes() {
    let folder = workplace();
    fs::write(folder.path().join("file"), "").expect("a file");
    let dark = scene().replace("radiance = 1", "radiance = 0");
    fs::write(folder.path().join("dark.toml"), dark).expect("the scene file");
    for (code, arguments, said) in [
        (2, "", "Usage"),
        (2, "convergence --sampler haltom", "haltom"),
        (2, "convergence --replications 1", "2.."),
        (2, "convergence --size 0x5", "at least 1"),
        (2, "speed --growth weight", "triangles"),
        (3, "speed no-such-scene", "no-such-scene"),
        (4, "speed --device no-such-adapter", "no-such-adapter"),
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
