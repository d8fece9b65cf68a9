//! Drivers that fail: a layer of Vulkan (tests/faults/layer.rs) makes one call of one function go wrong.

use std::path::PathBuf;
use std::sync::OnceLock;
use std::time::{Duration, Instant};

use super::*;
use crate::common::effort::in_full;

/// The folder with the layer and its manifest; None where no graphics device is tested.
pub fn layer() -> Option<&'static Path> {
    static LAYER: OnceLock<Option<TempDir>> = OnceLock::new();
    let make = || {
        if cfg!(not(target_os = "linux")) || std::env::var("GPT_TEST_GPU").as_deref() == Ok("skip") {
            return None;
        }
        // Beside the program; built with the tests, unless these alone were.
        let folder = Path::new(env!("CARGO_BIN_EXE_gpt")).parent().expect("a folder");
        let profile = match folder.file_name().and_then(|name| name.to_str()) {
            None | Some("debug") => "dev",
            Some(profile) => profile,
        };
        let mut cargo = Command::new(env!("CARGO"));
        cargo
            .args(["build", "--quiet", "--example", "vulkan_faults", "--profile", profile])
            .current_dir(env!("CARGO_MANIFEST_DIR"));
        assert!(cargo.status().expect("cargo").success(), "the layer is not built");
        let library: PathBuf = folder.join("examples").join("libvulkan_faults.so");
        let manifest = serde_json::json!({
            "file_format_version": "1.1.2",
            "layer": {
                "name": "VK_LAYER_GPT_faults",
                "type": "GLOBAL",
                "library_path": library,
                "api_version": "1.3.0",
                "implementation_version": "1",
                "description": "makes a driver fail"
            }
        });
        let place = tempfile::tempdir().expect("a temporary folder");
        fs::write(place.path().join("faults.json"), manifest.to_string()).expect("the manifest");
        Some(place)
    };
    LAYER.get_or_init(make).as_ref().map(TempDir::path)
}

/// Has a program meet a fault.
pub fn make_fail(command: &mut Command, layer: &Path, fault: &str) {
    command.env("VK_LAYER_PATH", layer).env("VK_INSTANCE_LAYERS", "VK_LAYER_GPT_faults").env("GPT_FAULT", fault);
}

/// Runs with a fault, within a time that is far from for ever.
fn run_with(place: &Workplace, layer: &Path, fault: &str, arguments: &str) -> (Option<i32>, String, String) {
    let start = Instant::now();
    let mut command = place.command(arguments);
    make_fail(&mut command, layer, fault);
    let output = command.env("GPT_FAULT_COUNTS", place.path("counts.txt")).output().expect("the program starts");
    assert!(start.elapsed() < Duration::from_secs(100), "{fault}: {:?}", start.elapsed());
    let [stdout, stderr] = [&output.stdout, &output.stderr].map(|bytes| text(bytes));
    assert!(!stderr.contains("panicked"), "{fault}: {stderr}");
    assert!(place.files().iter().all(|name| !name.ends_with(".part")), "{fault}: {:?}", place.files());
    (output.status.code(), stdout, stderr)
}

const RENDER: &str = "render spheres --size 96x64 --spp 64 --device gpu -q -o a.exr";

/// A short time for drivers that never answer; others may be slow.
fn timeout(fault: &str) -> &'static str {
    if fault.ends_with(":never") || fault.ends_with(":hangs") { "--device-timeout 5" } else { "" }
}

/// At twenty calls: none is a panic, none hangs, and each has the exit code that says what to do about it.
#[test]
#[ignore = "slow"]
fn failing_drivers_are_errors_with_the_contracts_exit_codes() {
    let Some(layer) = layer() else { return };
    let place = Workplace::new();
    let (code, _, said) = run_with(&place, layer, "nothing:0:lost", RENDER);
    assert_eq!(code, Some(0), "without a fault: {said}");
    let counts = fs::read_to_string(place.path("counts.txt")).expect("the layer was there");
    for (fault, code) in [
        ("vkQueueSubmit:1:lost", 5),
        ("vkQueueSubmit:2:lost", 5),
        ("vkQueueSubmit:7:lost", 5),
        ("vkQueueSubmit:3:memory", 4),
        ("vkQueueSubmit:4:never", 5),
        ("vkQueueSubmit:5:hangs", 5),
        ("vkWaitSemaphores:1:lost", 5),
        ("vkWaitSemaphores:2:lost", 5),
        ("vkWaitSemaphores:6:lost", 5),
        ("vkWaitSemaphores:4:hangs", 5),
        ("vkWaitSemaphores:5:memory", 4),
        ("vkGetSemaphoreCounterValue:3:lost", 5),
        // The first two pipelines are the interface's own, made while the device is opened.
        ("vkCreateComputePipelines:1:lost", 4),
        ("vkCreateComputePipelines:3:memory", 4),
        ("vkCreateComputePipelines:3:lost", 5),
        ("vkCreateComputePipelines:3:refused", 5),
        ("vkCreateShaderModule:3:memory", 4),
        ("vkAllocateMemory:1:memory", 4),
        ("vkMapMemory:1:memory", 4),
        ("vkCreateBuffer:2:memory", 4),
        ("vkCreateBuffer:20:memory", 4),
        ("vkBeginCommandBuffer:2:lost", 5),
        ("vkEndCommandBuffer:20:memory", 4),
        ("vkCreateDevice:1:refused", 4),
        ("vkCreateDevice:1:memory", 4),
    ] {
        let function = fault.split(':').next().expect("a name");
        assert!(function == "vkCreateDevice" || counts.contains(function), "{function} is never called: {counts}");
        let _ = fs::remove_file(place.path("a.exr"));
        let (found, stdout, said) = run_with(&place, layer, fault, &format!("{RENDER} {}", timeout(fault)));
        assert_eq!(found, Some(code), "{fault}: {said}");
        assert!(said.contains("Error:") && stdout.is_empty(), "{fault}: {said}");
    }
}

/// A device without memory for the whole film renders it in bands, which are the same picture.
#[test]
#[ignore = "slow"]
fn memory_forces_bands() {
    let Some(layer) = layer() else { return };
    let place = Workplace::new();
    let render = "render spheres --size 2048x1024 --spp 1 --device gpu -q --stats s.json -o";
    let film = |place: &Workplace| {
        let stats = place.stats("s.json");
        let decisions = stats["decisions"].as_array().expect("a list").clone();
        decisions.iter().find(|decision| decision["about"] == "film").expect("it is decided")["choice"].to_string()
    };
    for (fault, picture, words) in [
        ("nothing:0:lost", "whole.exr", "all 1024 rows together"),
        ("vkAllocateMemory:2:memory", "bands.exr", "bands of 512 rows"),
    ] {
        let (code, _, said) = run_with(&place, layer, fault, &format!("{render} {picture}"));
        assert_eq!(code, Some(0), "{said}");
        assert!(film(&place).contains(words), "{fault}: {}", film(&place));
    }
    assert!(place.image("whole.exr") == place.image("bands.exr"));
}

/// The samples so far are saved beside a finished picture, and the message says so, however the render was to
/// end.
#[test]
#[ignore = "slow"]
fn a_lost_device_leaves_the_picture_so_far() {
    let Some(layer) = layer() else { return };
    let place = Workplace::new();
    let mut cases = vec![
        ("", "vkQueueSubmit:100@4:lost"),
        // Memory that was enough to begin, and then is not, may be enough another time.
        ("", "vkQueueSubmit:100@4:memory"),
        ("--adaptive --time-limit 600", "vkQueueSubmit:200@4:lost"),
    ];
    if in_full("devices that never answer, and those that are lost while they are waited for") {
        cases.extend([("", "vkQueueSubmit:100@4:never"), ("--time-limit 600", "vkWaitSemaphores:150@4:lost")]);
    }
    // The film is read every two seconds, between two iterations.
    for (goal, fault) in cases {
        fs::write(place.path("a.exr"), "what was there before").expect("a file");
        let render =
            format!("render spheres --size 96x64 --spp 1000000 --device gpu -o a.exr -o b.exr {goal} {}", timeout(fault));
        let (code, _, said) = run_with(&place, layer, fault, &render);
        assert_eq!(code, Some(5), "{fault}: {said}");
        assert!(said.contains("a.incomplete.exr: what was rendered before, "), "{fault}: {said}");
        assert_eq!(fs::read(place.path("a.exr")).expect("it stays"), b"what was there before");
        let picture = place.image("b.exr");
        assert!(picture.pixels.iter().filter(|pixel| pixel[0] > 0.0).count() > 96 * 64 / 2, "{fault}");
        assert!(header_number(&place.path("b.exr"), "gpt:samples") > 0);
        assert_eq!(header_number(&place.path("b.exr"), "gpt:brokenOff"), 1);
        for name in ["a.incomplete.exr", "b.exr"] {
            fs::remove_file(place.path(name)).expect("it is there");
        }
    }
}

/// In the other commands as well.
#[test]
#[ignore = "slow"]
fn every_command_survives_a_lost_device() {
    let Some(layer) = layer() else { return };
    let place = Workplace::new();
    for command in ["verify spheres --size 24x16 --spp 4", "bench speed spheres --size 32x32"] {
        let (code, _, said) = run_with(&place, layer, "vkQueueSubmit:3:lost", command);
        assert_eq!(code, Some(5), "{command}: {said}");
        // And a driver that never signals, within the time that is given.
        let start = Instant::now();
        let (code, _, said) = run_with(&place, layer, "vkQueueSubmit:3:never", &format!("{command} --device-timeout 3"));
        assert_eq!(code, Some(5), "{command}: {said}");
        assert!(said.contains("--device-timeout") && start.elapsed() < Duration::from_secs(40), "{command}: {said}");
    }
}

/// An adapter that does not open is no missing one, and a batch may insist on a device.
#[test]
fn an_adapter_that_does_not_open_is_told_of() {
    let Some(layer) = layer() else { return };
    let place = Workplace::new();
    let fault = "vkCreateDevice:1:refused";
    let (code, _, said) = run_with(&place, layer, fault, "render scene.toml --spp 1 -o a.exr");
    assert_eq!(code, Some(0), "{said}");
    assert!(said.contains("rendering on the CPU") && said.contains("cannot be opened"), "{said}");
    assert!(!said.contains("was found"), "{said}");
    let _ = fs::remove_file(place.path("a.exr"));
    let (code, _, said) = run_with(&place, layer, fault, "render scene.toml --spp 1 -q --require-device -o a.exr");
    assert_eq!(code, Some(4), "{said}");
    assert!(!place.path("a.exr").exists());
    place.expect(2, "render scene.toml --require-device --device cpu");
    place.expect(0, "render scene.toml --require-device --spp 1 -q -o a.exr");
}

/// Whatever hangs, a render that is asked to end does so within ten seconds, with what it has: a submission, and what comes before the first.
#[cfg(unix)]
#[test]
#[ignore = "slow"]
fn a_render_that_hangs_ends_when_it_is_asked_to() {
    let Some(layer) = layer() else { return };
    for (fault, code, words, files) in [
        (
            "vkQueueSubmit:100:hangs",
            5,
            "the state is saved",
            ["a.exr", "a.exr.checkpoint", "counts.txt", "scene.toml"].as_slice(),
        ),
        ("vkCreateComputePipelines:3:hangs", 130, "nothing is rendered yet", &["counts.txt", "scene.toml"]),
    ] {
        let place = Workplace::new();
        let mut command = place.command("render spheres --size 96x64 --spp 1000000 --device gpu --checkpoint 0.001 -o a.exr");
        make_fail(&mut command, layer, fault);
        command.env("GPT_FAULT_COUNTS", place.path("counts.txt")).stdout(Stdio::null()).stderr(Stdio::piped());
        let child = command.spawn().expect("a process");
        super::checkpoints::wait_for(&place, "counts.txt");
        let asked = Instant::now();
        assert!(Command::new("kill").args(["-TERM", &child.id().to_string()]).status().expect("kill").success());
        let output = child.wait_with_output().expect("an end");
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{fault}: {said}");
        assert!(said.contains(words), "{fault}: {said}");
        // Sixty seconds would pass without. A machine under load has twice the ten that schedulers give.
        assert!(asked.elapsed() < Duration::from_secs(20), "{fault}: {:?}", asked.elapsed());
        assert_eq!(place.files(), files, "{fault}");
    }
}

/// The state that a lost device leaves is gone on from, on the same device bit for bit, and on another.
#[test]
#[ignore = "slow"]
fn a_render_goes_on_after_its_device_was_lost() {
    let Some(layer) = layer() else { return };
    let place = Workplace::new();
    let render = "render spheres --size 96x64 --spp 400 -q -o";
    place.expect(0, &format!("{render} whole.exr --device gpu"));
    let whole = fs::read(place.path("whole.exr")).expect("the picture");
    for device in ["gpu", "cpu"] {
        let fault = "vkQueueSubmit:25:lost";
        let first = format!("{render} a.exr --device gpu --checkpoint 0.001");
        let (code, _, said) = run_with(&place, layer, fault, &first);
        assert_eq!(code, Some(5), "{said}");
        assert!(said.contains("a.exr.checkpoint: the state is saved"), "{said}");
        assert!(place.path("a.exr.checkpoint").exists());
        let spp = if device == "gpu" { "400" } else { "401" };
        if device == "cpu" {
            // The control: of another number of samples it is not the state.
            place.expect(3, &format!("render spheres --size 96x64 --spp {spp} -q -o a.exr --device cpu --resume"));
        }
        let said = place.expect(0, &format!("{render} a.exr --device {device} --resume --stats s.json"));
        assert_eq!(said.contains("goes on: the picture has the rounding of both"), device == "cpu", "{said}");
        assert!(place.stats("s.json")["resumed_samples"].as_u64() > Some(0));
        assert!(!place.path("a.exr.checkpoint").exists());
        if device == "gpu" {
            assert!(fs::read(place.path("a.exr")).expect("the picture") == whole);
        } else {
            let [a, b] = ["a.exr", "whole.exr"].map(|name| place.image(name));
            let far =
                a.pixels.iter().flatten().zip(b.pixels.iter().flatten()).filter(|(a, b)| (**a - **b).abs() > 1e-3 * (**b + 0.01));
            assert!(far.count() < 96 * 64 * 3 / 50);
        }
        fs::remove_file(place.path("a.exr")).expect("it is there");
    }
}
