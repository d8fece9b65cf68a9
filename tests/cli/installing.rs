//! How the program is packed, and the files of an installation beside it.

use std::collections::BTreeSet;
use std::path::PathBuf;

use super::*;

fn project() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Packs a program that passes on to the one under test, as scripts/archive does: the archive's path.
#[cfg(unix)]
pub fn pack(place: &Workplace, target: &str, folder: &Path) -> PathBuf {
    use std::os::unix::fs::PermissionsExt;

    let program = place.path("passes-on");
    fs::write(&program, format!("#!/bin/sh\nexec '{}' \"$@\"\n", env!("CARGO_BIN_EXE_gpt"))).expect("a program");
    fs::set_permissions(&program, fs::Permissions::from_mode(0o755)).expect("a file of ours");
    let archive = Command::new(project().join("scripts/archive"))
        .args([program.as_path(), Path::new(target), folder])
        .env("SOURCE_DATE_EPOCH", "0")
        .output()
        .expect("bash starts");
    assert!(archive.status.success(), "{}", text(&archive.stderr));
    PathBuf::from(text(&archive.stdout).lines().last().expect("the archive's path"))
}

/// The platforms that release.yml builds for.
fn platforms() -> BTreeSet<String> {
    let workflow = fs::read_to_string(project().join(".github/workflows/release.yml")).expect("the workflow");
    let targets = workflow.split("target: ").skip(1).filter_map(|rest| rest.split([',', ' ', '}']).next());
    targets.filter(|target| !target.starts_with('$')).map(str::to_owned).collect()
}

/// The archive's address below the repository, and the program's path in it, by the templates for cargo-binstall in Cargo.toml.
fn binstall(manifest: &str, target: &str) -> (String, String) {
    let manifest: toml::Value = toml::from_str(manifest).expect("a manifest");
    let settings = &manifest["package"]["metadata"]["binstall"];
    let format = settings.get("overrides").and_then(|of| of.get(target)).unwrap_or(settings);
    let (suffix, exe) = match format["pkg-fmt"].as_str() {
        Some("tgz") => (".tar.gz", ""),
        Some("zip") => (".zip", ".exe"),
        other => panic!("{other:?} is no form of archives here"),
    };
    let values = [
        ("repo", ""),
        ("version", env!("CARGO_PKG_VERSION")),
        ("target", target),
        ("archive-suffix", suffix),
        ("bin", "gpt"),
        ("binary-ext", exe),
    ];
    let filled = |key: &str| {
        let template = settings[key].as_str().expect("a template").to_owned();
        values.iter().fold(template, |text, (name, value)| text.replace(&format!("{{ {name} }}"), value))
    };
    (filled("pkg-url"), filled("bin-dir"))
}

#[cfg(target_os = "linux")]
#[test]
fn an_archive_is_what_installers_look_for() {
    let place = Workplace::new();
    let version = env!("CARGO_PKG_VERSION");
    let platforms = platforms();
    assert_eq!(platforms.len(), 5, "{platforms:?}");
    let manifest = fs::read_to_string(project().join("Cargo.toml")).expect("the manifest");
    let download = fs::read_to_string(project().join("scripts/download-release")).expect("the script");
    // 7z makes archives for Windows, where it is.
    for target in platforms.iter().filter(|target| !target.contains("windows")) {
        let archive = pack(&place, target, &place.path(&format!("releases/download/v{version}")));
        let archive = format!("/{}", archive.strip_prefix(place.0.path()).expect("in the place").display());
        let listed = Command::new("tar").arg("tzf").arg(place.path(&archive[1..])).output().expect("tar starts");
        let listed = text(&listed.stdout);
        let (address, program) = binstall(&manifest, target);
        assert_eq!(address, archive);
        for file in ["man/gpt.1", "man/gpt-render.1", "completions/gpt.bash", "completions/_gpt", "README.md", "LICENSE-MIT"] {
            assert!(listed.contains(&program.replace("/gpt", &format!("/{file}"))), "{target} has no {file}: {listed}");
        }
        assert!(listed.lines().any(|line| line == program), "{target} has no {program}: {listed}");
        assert_eq!(listed.contains("/install-lavapipe"), target.contains("linux"), "{target}: {listed}");
    }
    for target in &platforms {
        assert!(download.contains(&format!("target={target}")), "scripts/download-release does not know {target}");
        assert_eq!(binstall(&manifest, target).0.ends_with(".zip"), target.contains("windows"));
    }
    // The control: a template of other names.
    let other =
        binstall(&manifest.replace("gpt-{ version }-{ target }{", "gpt-v{ version }-{ target }{"), "aarch64-apple-darwin");
    assert_ne!(other.0, binstall(&manifest, "aarch64-apple-darwin").0);
}

/// Cargo reads the workspace from what the Dockerfile copies.
#[cfg(unix)]
#[test]
fn the_image_is_built_from_what_it_copies() {
    let dockerfile = fs::read_to_string(project().join("Dockerfile")).expect("the Dockerfile");
    let copied = dockerfile.lines().filter_map(|line| line.strip_prefix("COPY ")).filter(|line| !line.starts_with("--from"));
    let copied: Vec<&str> = copied.flat_map(|line| line.split_whitespace().rev().skip(1)).collect();
    let reads = |left_out: &str| {
        let place = Workplace::new();
        for source in copied.iter().filter(|&&source| source != left_out) {
            let copy = Command::new("cp").arg("-r").arg(project().join(source)).arg(place.0.path()).status();
            assert!(copy.expect("cp starts").success(), "{source}");
        }
        let mut metadata = Command::new(env!("CARGO"));
        metadata.args(["metadata", "--no-deps", "--offline", "--locked", "--format-version", "1"]);
        metadata.current_dir(place.0.path()).output().expect("cargo starts")
    };
    let all = reads("");
    assert!(all.status.success(), "{}", text(&all.stderr));
    for needed in ["crates", "src"] {
        assert!(!reads(needed).status.success(), "the control: without {needed}");
    }
}

#[test]
fn completions_and_man_pages_know_every_command() {
    let place = Workplace::new();
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = text(&place.run(&format!("completions {shell}")).stdout);
        assert!(["render", "target-error", "compare", "sobol"].iter().all(|word| script.contains(word)), "{shell}: {script}");
    }
    place.expect(2, "completions basic");
    assert!(text(&place.run("man").stdout).starts_with(".ie"), "roff");
    place.expect(0, "man -o pages");
    for page in ["gpt.1", "gpt-render.1", "gpt-test.1", "gpt-bench-speed.1"] {
        let page = fs::read_to_string(place.path("pages").join(page)).expect("a page");
        assert!(page.contains(".TH"), "{page}");
    }
}

/// bash itself reads them.
#[cfg(unix)]
#[test]
fn bash_completes_commands_and_values() {
    let place = Workplace::new();
    fs::write(place.path("gpt.bash"), place.run("completions bash").stdout).expect("a file");
    let complete = |words: &str, last: usize| {
        let script = format!(
            "source gpt.bash; COMP_WORDS=({words}); COMP_CWORD={last}; _gpt gpt \"${{COMP_WORDS[{last}]}}\" \"${{COMP_WORDS[{}]}}\"; echo \"${{COMPREPLY[@]}}\"",
            last - 1
        );
        let output = Command::new("bash").args(["-c", &script]).current_dir(place.0.path()).output().expect("bash starts");
        text(&output.stdout)
    };
    assert_eq!(complete("gpt comp", 1).trim(), "compare completions");
    assert!(complete("gpt render --sampler ha", 3).contains("halton"));
}
