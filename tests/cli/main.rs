//! The program as its users meet it: exit codes, messages and files.

// Some tests are for Unix or Linux alone, and what they share is unused elsewhere.
#![cfg_attr(not(target_os = "linux"), allow(dead_code, unused_imports, unused_mut))]

#[path = "../common/mod.rs"]
mod common;

mod bench;
mod checkpoints;
#[cfg(unix)]
mod continuous_integration;
mod damage;
mod denoising;
mod documents;
mod endings;
mod exr_forms;
mod farm;
mod faults;
mod frames;
mod goals;
mod imports;
mod inputs;
mod installing;
mod kills;
mod mattes;
mod measure;
mod memory_stated;
mod models;
mod odd_models;
#[cfg(unix)]
mod on_unix;
mod outputs;
mod overwriting;
mod part_layers;
mod parts;
mod picture_files;
mod picture_tests;
#[cfg(unix)]
mod projections;
mod referee;
mod regroup;
mod tight_limits;
mod traversal;
mod verify;
mod view;

use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use common::sphere::grey_sphere;
use gpt::output::{Image, read_image};
use gpt::scene::settings::SETTINGS;
use serde_json::Value;
use tempfile::TempDir;

/// A scene that renders fast on the CPU: a lit sphere over nothing.
fn scene() -> String {
    let light = "type = \"point\"\nposition = [3, 4, 5]\nintensity = [40, 30, 20]";
    grey_sphere("[film]\nsize = [24, 16]\n[render]\nspp = 8", light)
}

/// An empty folder with the scene `scene.toml`; the program runs in it.
struct Workplace(TempDir);

impl Workplace {
    fn new() -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        fs::write(folder.path().join("scene.toml"), scene()).expect("the scene file");
        Self(folder)
    }

    fn path(&self, name: &str) -> std::path::PathBuf {
        self.0.path().join(name)
    }

    fn command(&self, arguments: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_gpt"));
        command.args(arguments.split_whitespace()).current_dir(self.0.path()).env_remove("NO_COLOR");
        #[cfg(unix)]
        on_unix::obey_signals(&mut command);
        command
    }

    fn run(&self, arguments: &str) -> Output {
        self.command(arguments).output().expect("the program starts")
    }

    /// Runs, expects this exit code, and returns what went to stderr.
    fn expect(&self, code: i32, arguments: &str) -> String {
        let output = self.run(arguments);
        let stderr = text(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "gpt {arguments}\n{stderr}");
        stderr
    }

    fn files(&self) -> Vec<String> {
        let mut names: Vec<_> = fs::read_dir(self.0.path())
            .expect("the folder")
            .map(|entry| entry.expect("an entry").file_name().into_string().expect("plain names"))
            .collect();
        names.sort();
        names
    }

    fn image(&self, name: &str) -> Image {
        read_image(&self.path(name)).expect("a readable picture")
    }

    fn stats(&self, name: &str) -> Value {
        serde_json::from_slice(&fs::read(self.path(name)).expect("the stats file")).expect("JSON")
    }
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("UTF-8")
}

/// The EXR header's integer of this name.
fn header_number(path: &Path, key: &str) -> i32 {
    use exr::prelude::{AttributeValue, MetaData, Text};
    let meta = MetaData::read_from_file(path, true).expect("a valid EXR header");
    match meta.headers[0].own_attributes.other.get(&Text::from(key)) {
        Some(AttributeValue::I32(number)) => *number,
        other => panic!("{key} is {other:?}"),
    }
}

#[test]
fn a_render_writes_its_files_whole_and_says_nothing_on_stdout() {
    let place = Workplace::new();
    let output = place.run("render scene.toml --device cpu --tonemap clip -o a.exr -o a.png --stats stats.json");
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert_eq!(text(&output.stdout), "");
    assert!(text(&output.stderr).contains("a.exr, a.png: 24x16, 8 spp"), "{}", text(&output.stderr));
    assert_eq!(place.files(), ["a.exr", "a.png", "scene.toml", "stats.json"]);

    let image = place.image("a.exr");
    assert_eq!((image.width, image.height), (24, 16));
    let centre = image.pixels[8 * 24 + 12];
    assert!(centre[0] > centre[2] && centre[2] > 0.0, "the light is warm, but the sphere is {centre:?}");
    assert_eq!(image.pixels[0], [0.0; 3], "nothing is behind the sphere");
    assert_eq!(header_number(&place.path("a.exr"), "gpt:samples"), 8);
    assert_eq!(header_number(&place.path("a.exr"), "gpt:complete"), 1);
    let preview = place.image("a.png");
    assert!((preview.pixels[8 * 24 + 12][0] - centre[0]).abs() < 0.01);
}

#[test]
fn stats_have_the_keys_that_other_programs_rely_on() {
    let place = Workplace::new();
    place.expect(
        0,
        "render scene.toml --device cpu --spp 4 --size 10x6 --seed 9 --light-samples 3 --light-samples-depth 2 --roulette-depth 5 --stats stats.json -q",
    );
    let stats = place.stats("stats.json");
    for key in ["load", "learn", "build", "compile", "render", "write"] {
        assert!(stats["seconds"][key].is_number(), "seconds.{key}");
    }
    for key in ["samples_per_second", "rays", "rays_per_second", "non_finite_samples", "peak_device_bytes"] {
        assert!(stats[key].is_number(), "{key}");
    }
    assert_eq!(stats["scene"], "scene");
    assert_eq!(stats["device"], "CPU reference");
    assert!(stats["hierarchy"].is_null());
    let unguided = serde_json::json!([{
        "about": "directions", "choice": "by BSDFs alone", "because": "the render is too short to learn for",
    }]);
    assert_eq!((&stats["decisions"], &stats["compiled_in"]), (&unguided, &serde_json::json!([])));
    assert_eq!((&stats["width"], &stats["height"], &stats["spp"]), (&10.into(), &6.into(), &4.into()));
    assert_eq!(stats["samples"], 240);
    assert_eq!(stats["seed"], 9);
    assert_eq!((&stats["light_samples"], &stats["light_samples_depth"]), (&3.into(), &2.into()));
    let text = fs::read_to_string(place.path("stats.json")).expect("the stats file");
    for setting in SETTINGS {
        let key = format!("\"{}\":", setting.name);
        assert_eq!(text.matches(&key).count(), 1, "{key} is there once");
    }
    assert_eq!((&stats["filter"], &stats["pixel_sampler"]), (&"box, radius 0.5".into(), &"sobol".into()));
    assert_eq!(stats["interrupted"], false);
    assert_eq!(stats["version"], env!("CARGO_PKG_VERSION"));
    assert!(stats["rays"].as_u64() >= Some(240), "a sample is at least one ray");
}

#[test]
fn the_default_picture_lies_in_the_current_folder() {
    let place = Workplace::new();
    place.expect(0, "render scene.toml --device cpu --spp 1");
    assert_eq!(place.files(), ["scene.exr", "scene.png", "scene.toml"]);
    place.expect(0, "render --device cpu --spp 1 --size 8x8");
    assert_eq!(place.files(), ["cornell.exr", "cornell.png", "scene.exr", "scene.png", "scene.toml"]);
}

#[test]
fn quiet_means_quiet() {
    let place = Workplace::new();
    let output = place.run("render scene.toml --device cpu --quiet");
    assert_eq!((text(&output.stdout), text(&output.stderr)), (String::new(), String::new()));
}

#[test]
fn two_halves_of_the_samples_make_the_whole() {
    let place = Workplace::new();
    place.expect(0, "render scene.toml --device cpu -q --spp 8 -o whole.exr");
    place.expect(0, "render scene.toml --device cpu -q --spp 4 -o first.exr");
    place.expect(0, "render scene.toml --device cpu -q --spp 4 --first-sample 4 -o second.exr");
    assert_eq!(header_number(&place.path("second.exr"), "gpt:firstSample"), 4);
    let [whole, first, second] = ["whole.exr", "first.exr", "second.exr"].map(|name| place.image(name));
    let mut differing_halves = 0;
    for ((whole, first), second) in whole.pixels.iter().zip(&first.pixels).zip(&second.pixels) {
        differing_halves += u32::from(first != second);
        for channel in 0..3 {
            let mean = 0.5 * (first[channel] + second[channel]);
            assert!(
                (whole[channel] - mean).abs() <= 1e-5 * (1.0 + mean),
                "{whole:?} is not the mean of {first:?} and {second:?}"
            );
        }
    }
    assert!(differing_halves > 20, "the halves are not the same samples");
}

#[test]
fn usage_errors_are_refused_before_anything_happens() {
    let place = Workplace::new();
    for (arguments, words) in [
        ("", "Usage"),
        ("paint", "paint"),
        ("render --spp 0", "--spp"),
        ("render --spp -3", "-3"),
        ("render --spp many", "many"),
        ("render --size 0x0", "at least 1"),
        ("render --size 12", "WIDTHxHEIGHT"),
        ("render --size 40000x10", "at most 32768 pixels on a side"),
        ("render --size 32768x32768", "268435456 in all"),
        ("render --seed -1", "-1"),
        ("render --sampler dice", "halton"),
        ("render --hemisphere square", "cosine"),
        ("render --light-sampling guess", "visible"),
        ("render --pixel-sampler dice", "none"),
        ("render --blend guess", "mixture"),
        ("render --estimator guess", "mis"),
        ("render --roulette-depth many", "--roulette-depth"),
        ("render scene.toml --max-depth 0 --roulette-depth 0", "paths would never end"),
        ("render --light-samples 17", "from 1 to 16, or auto"),
        ("render --exposure nan", "--exposure"),
        ("render --first-sample 2147483600 --device cpu", "--first-sample"),
        ("render --exposure bright", "or auto"),
        ("render --white-balance 500", "from 1000 to 40000"),
        ("render --tonemap reinhard", "filmic"),
        ("render --compression zap", "piz"),
        ("render model.obj --elevation 91", "from -90 to 90"),
        ("render model.obj --up x", "--up"),
        ("render scene.toml --turn 30 --smooth", "are for models"),
        ("render scene.toml --save-scene out.txt --device cpu --spp 1 -o -", "ends in .toml"),
        ("scenes cornel", "no built-in scene"),
        ("render -o picture.tif", ".exr"),
        ("render -o picture", "picture"),
        ("render -o a.exr -o ./a.exr", "twice"),
        ("render --nonsense", "--nonsense"),
        ("compare one.exr", "<B>"),
        ("compare a.exr b.exr --metric taste", "relmse"),
        ("compare a.exr b.exr --tolerance -1", "--tolerance"),
        ("check", "SCENE"),
    ] {
        let stderr = place.expect(2, arguments);
        assert!(stderr.contains(words), "gpt {arguments}: `{words}` is not in\n{stderr}");
        assert_eq!(place.files(), ["scene.toml"], "gpt {arguments}");
    }
}

#[test]
fn help_and_version_are_answers() {
    let place = Workplace::new();
    for (arguments, words) in [
        ("--help", "render"),
        ("--version", env!("CARGO_PKG_VERSION")),
        ("render --help", "--max-depth"),
        ("help compare", "--json"),
    ] {
        let output = place.run(arguments);
        assert_eq!(output.status.code(), Some(0));
        assert!(text(&output.stdout).contains(words), "gpt {arguments}");
        assert_eq!(text(&output.stderr), "");
    }
}

#[test]
fn input_errors_name_the_file() {
    let place = Workplace::new();
    fs::write(place.path("broken.toml"), "[film\n").expect("a file");
    fs::write(place.path("broken.exr"), "no picture").expect("a file");
    place.expect(0, "render scene.toml --device cpu --spp 1 -o a.exr");
    for (arguments, words) in [
        ("render missing.toml", "missing.toml"),
        ("render no-such-builtin", "no-such-builtin"),
        ("render broken.toml", "broken.toml"),
        ("check broken.toml", "broken.toml"),
        ("compare a.exr missing.exr", "missing.exr"),
        ("compare broken.exr a.exr", "broken.exr"),
        ("compare a.exr scene.toml", "scene.toml"),
    ] {
        let stderr = place.expect(3, arguments);
        assert!(stderr.contains(words), "gpt {arguments}: `{words}` is not in\n{stderr}");
        assert_eq!(stderr.matches("Error").count(), 1, "one error: {stderr}");
        assert!(!stderr.contains('\u{1b}'), "no colours where stderr is no terminal: {stderr:?}");
    }
}

#[test]
fn an_unknown_device_is_answered_with_what_there_is() {
    let place = Workplace::new();
    let stderr = place.expect(4, "render scene.toml --device Abacus");
    assert!(stderr.contains("Abacus") && stderr.contains("cpu"), "{stderr}");
    assert_eq!(place.files(), ["scene.toml"]);
}

#[test]
fn impossible_targets_are_found_before_rendering() {
    let place = Workplace::new();
    // Rendering these would take days.
    let endless = "render scene.toml --device cpu --size 8192x8192 --spp 1000000";
    for (target, words) in [("-o nowhere/a.exr", "nowhere"), ("--stats nowhere/s.json", "nowhere"), ("-o folder.exr", "folder")] {
        fs::create_dir_all(place.path("folder.exr")).expect("a folder");
        let stderr = place.expect(1, &format!("{endless} {target}"));
        assert!(stderr.contains(words), "{stderr}");
    }
    assert_eq!(place.files(), ["folder.exr", "scene.toml"]);
}

#[test]
fn a_black_picture_is_worth_a_warning() {
    let place = Workplace::new();
    let looking_away = scene().replace("look_at = [0, 0, 0]", "look_at = [0, 0, 9]");
    fs::write(place.path("away.toml"), looking_away).expect("a file");
    assert!(place.expect(0, "render away.toml --device cpu").contains("every pixel is black"));
    assert!(!place.expect(0, "render scene.toml --device cpu").contains("black"));
}

#[test]
fn compare_judges_by_difference_metric_and_tolerance() {
    let place = Workplace::new();
    place.expect(0, "render scene.toml --device cpu -o a.exr");
    place.expect(0, "render scene.toml --device cpu -o again.exr");
    place.expect(0, "render scene.toml --device cpu --seed 1 -o other.exr");
    place.expect(0, "render scene.toml --device cpu --size 24x15 -o small.exr");
    place.expect(0, "compare a.exr again.exr");
    place.expect(7, "compare a.exr other.exr");
    place.expect(0, "compare a.exr other.exr --tolerance 1000");
    place.expect(0, "compare a.exr other.exr --metric mse --tolerance 1000");
    place.expect(7, "compare a.exr other.exr --metric mse");
    place.expect(0, "compare a.exr again.exr --metric psnr");
    place.expect(7, "compare a.exr other.exr --metric psnr --tolerance 200");
    place.expect(0, "compare a.exr other.exr --metric psnr --tolerance 1");
    let stderr = place.expect(3, "compare a.exr small.exr");
    assert!(stderr.contains("24x16") && stderr.contains("24x15"), "{stderr}");

    let output = place.run("compare a.exr other.exr --json");
    let verdict: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(verdict["equal"], false);
    let [mse, mae] = ["mse", "mae"].map(|metric| verdict[metric]["all"].as_f64().expect("a number"));
    assert!(mse > 0.0 && mae > 0.0 && mae * mae <= mse * 1.000_001, "Jensen: {mae}² ≤ {mse}");
    let one_metric = text(&place.run("compare a.exr other.exr --metric mae").stdout);
    assert!(one_metric.contains("mae") && !one_metric.contains("relmse"), "{one_metric}");
}

#[test]
fn check_says_what_is_in_the_scene() {
    let place = Workplace::new();
    let output = place.run("check scene.toml");
    assert_eq!(output.status.code(), Some(0));
    let report = text(&output.stdout);
    for words in ["24x16", "8 spp", "1 sphere", "1 diffuse", "1 point"] {
        assert!(report.contains(words), "`{words}` is not in\n{report}");
    }
    let summary: Value = serde_json::from_slice(&place.run("check scene.toml --json").stdout).expect("JSON");
    assert_eq!(summary["shapes"]["sphere"], 1);
    assert!(
        summary["valid"] == true && summary["device_bytes"].as_u64() > Some(0) && summary["cpu_seconds"].as_f64() > Some(0.0)
    );
    // The parts of kernels are shown to those who ask.
    assert!(report.starts_with("valid\n") && !report.contains("compiled in") && summary["plan"].is_null(), "{report}");
    assert!(text(&place.run("check scene.toml --plan").stdout).contains("compiled in"));
    // Lights chosen as a trial run finds best, and so many light samples, of pictures that are worth one.
    for (scene, because) in [
        ("veach-mis", "cells over 5 lights (a trial run found"),
        ("bazaar", "light samples  4 at each of the first 2 surfaces (a trial run found"),
        ("scene.toml", "light samples  1 (the render is too short to learn for"),
    ] {
        let report = text(&place.run(&format!("check {scene} --plan")).stdout);
        assert!(report.contains(because), "`{because}` is not in\n{report}");
    }
    let plan: Value = serde_json::from_slice(&place.run("check scene.toml --plan --json").stdout).expect("JSON");
    assert!(plan["plan"]["compiled_in"].as_array().is_some_and(|switches| !switches.is_empty()));
    let schema: Value = serde_json::from_slice(&place.run("check --schema").stdout).expect("JSON");
    assert!(schema["properties"]["camera"].is_object(), "{schema}");
}

#[test]
fn devices_always_has_the_cpu_and_one_automatic_choice() {
    let place = Workplace::new();
    let output = place.run("devices");
    assert_eq!(output.status.code(), Some(0));
    let list = text(&output.stdout);
    assert!(list.contains("CPU reference"), "{list}");
    assert_eq!(list.matches("<- auto").count(), 1, "{list}");
    let json: Value = serde_json::from_slice(&place.run("devices --json").stdout).expect("JSON");
    let adapters = json.as_array().expect("a list");
    assert!(adapters.iter().filter(|adapter| adapter["chosen_by_auto"] == true).count() <= 1);
}

#[test]
fn a_reader_that_goes_away_is_no_failure() {
    let place = Workplace::new();
    let mut child = place.command("check --schema").stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("a process");
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("an end");
    assert_eq!((output.status.code(), text(&output.stderr)), (Some(0), String::new()));
}
