//! Limits that leave the program little: each is an answer or a sentence, and none a panic.

use super::*;

/// Runs with so many kibibytes of addresses.
#[cfg(target_os = "linux")]
fn run_within(place: &Workplace, kibibytes: u64, arguments: &str) -> Output {
    let line = format!("ulimit -v {kibibytes}; exec {} {arguments}", env!("CARGO_BIN_EXE_gpt"));
    let mut command = Command::new("sh");
    command.args(["-c", &line]).current_dir(place.0.path()).env("GPT_TEST_GPU", "skip");
    command.output().expect("a shell")
}

#[cfg(target_os = "linux")]
#[test]
fn little_memory_for_threads_is_no_panic() {
    let place = Workplace::new();
    // Below this it does not even start.
    let least = (10_000..).step_by(2000).find(|&most| run_within(&place, most, "--version").status.success());
    let least = least.expect("some limit is enough");
    let mut finished = 0;
    for more in (0..40_000).step_by(2000) {
        for arguments in ["check scene.toml", "render scene.toml --device cpu -q -o a.exr"] {
            let output = run_within(&place, least + more, arguments);
            let said = text(&output.stderr);
            assert!(!said.contains("panicked") && output.status.code() != Some(101), "{} {arguments}: {said}", least + more);
            finished += u32::from(output.status.success());
        }
    }
    // The control: most of these limits are enough for something.
    assert!(finished > 10, "{finished}");
}

/// A state in its place makes it not the end: another try may have more.
#[cfg(target_os = "linux")]
#[test]
#[ignore = "slow"]
fn memory_that_runs_out_midway_is_told_from_a_scene_that_does_not_fit() {
    let place = Workplace::new();
    let render = "render scene.toml --device cpu -q --size 1024x1024 --spp 1000000 --max-depth 1";
    let mut child = place.command(&format!("{render} --checkpoint 0.1 -o a.exr")).spawn().expect("a process");
    while !place.path("a.exr.checkpoint").exists() {
        assert!(child.try_wait().expect("its state").is_none(), "it ended");
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    child.kill().expect("it ends");
    child.wait().expect("it ends");
    let mut codes = std::collections::BTreeSet::new();
    for most in (40_000..240_000).step_by(10_000) {
        let output = run_within(&place, most, &format!("{render} --resume --time-limit 0.1 -o b.exr"));
        // The control: without a state, what does not fit does not fit.
        assert_ne!(output.status.code(), Some(5), "{most}: {}", text(&output.stderr));
        let output = run_within(&place, most, &format!("{render} --resume --time-limit 0.1 -o a.exr"));
        let said = text(&output.stderr);
        assert!(output.status.code() != Some(5) || said.contains("--resume goes on"), "{said}");
        codes.insert(output.status.code());
        if output.status.success() {
            break;
        }
    }
    assert!(codes.contains(&Some(4)) && codes.contains(&Some(5)), "{codes:?}");
}

#[test]
fn a_folder_of_temporary_files_that_is_not_there_is_named() {
    let place = Workplace::new();
    let mut command = place.command("render scene.toml --device cpu -q --aov normal -o a.exr");
    let variable = if cfg!(windows) { "TMP" } else { "TMPDIR" };
    let output = command.env(variable, place.path("nowhere")).output().expect("the program starts");
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{said}");
    let said = said.split_whitespace().collect::<String>();
    assert!(said.contains("nowhere") && said.contains(variable), "{said}");
}

/// In every command that reads scenes.
#[test]
fn files_outside_of_the_folder_are_refused_everywhere() {
    let place = Workplace::new();
    fs::create_dir(place.path("scenes")).expect("a folder");
    fs::write(place.path("ball.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").expect("a model");
    let model = "[[shape]]\ntype = \"mesh\"\nfile = \"../ball.obj\"\nmaterial = \"grey\"\n";
    fs::write(place.path("scenes/lit.toml"), scene() + model).expect("a scene");
    for command in [
        "render scenes/lit.toml --device cpu -q --spp 1 -o x.exr",
        "check scenes/lit.toml",
        "plan scenes/lit.toml --chunks 2 --spp 8 -o x.exr",
        "verify scenes/lit.toml --size 8x8 --spp 2",
        "test scenes --device cpu --bless --change 50%",
        "bench speed scenes/lit.toml --device cpu --size 8x8 --spp 1 --growth lights -o bench",
        "bench convergence scenes/lit.toml --device cpu --size 8x8 --spp 2 -o bench",
    ] {
        let output = place.run(&format!("{command} --assets-root scenes"));
        let said = text(&output.stdout) + &text(&output.stderr);
        let said = said.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(output.status.code() == Some(3) && said.contains("lies outside of"), "{command}: {:?} {said}", output.status);
    }
    // The control.
    place.expect(0, "render scenes/lit.toml --device cpu -q --spp 1 -o x.exr --assets-root .");
}
