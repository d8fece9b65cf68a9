//! Tests that are ignored say which run they belong to, as `scripts/test` tells them apart.
//!
//! `#[ignore = "slow"]` stands in the suites of a push and is for `scripts/test --rest`, which takes what is ignored there. `#[ignore = "long: …"]`
//! is for `scripts/test --full`, and its function begins with `long_`, by which the rest leaves it out.

use std::fs;
use std::path::Path;

/// Folders of the suites whose ignored tests `scripts/test --rest` runs.
const SUITES: [&str; 3] = ["tests/cli/", "tests/cpu/", "tests/gpu/"];

/// The faults of a file, by lines.
fn faults(path: &str, text: &str) -> Vec<String> {
    let lines: Vec<&str> = text.lines().map(str::trim_start).collect();
    let mut found = Vec::new();
    for (index, line) in lines.iter().enumerate().filter(|(_, line)| line.starts_with("#[ignore")) {
        let name = lines[index..].iter().find_map(|line| line.strip_prefix("fn ")).unwrap_or_default();
        let is_sound = match line.strip_prefix("#[ignore = \"").and_then(|rest| rest.strip_suffix("\"]")) {
            Some("slow") => !name.starts_with("long_") && SUITES.iter().any(|suite| path.starts_with(suite)),
            Some(reason) => reason.starts_with("long: ") && name.starts_with("long_"),
            None => false,
        };
        if !is_sound {
            found.push(format!("{path}:{}: {line}", index + 1));
        }
    }
    found
}

/// The faults of all Rust files in a folder.
fn faults_within(root: &Path, folder: &str, found: &mut Vec<String>) {
    for entry in fs::read_dir(root.join(folder)).expect("the folder can be listed") {
        let name = entry.expect("the folder can be listed").file_name();
        let path = format!("{folder}/{}", name.to_string_lossy());
        if root.join(&path).is_dir() {
            faults_within(root, &path, found);
        } else if path.ends_with(".rs") {
            found.extend(faults(&path, &fs::read_to_string(root.join(&path)).expect("sources are UTF-8")));
        }
    }
}

#[test]
fn ignored_tests_are_slow_or_long() {
    let mut found = Vec::new();
    for folder in ["src", "crates/gpt-scene/src", "tests"] {
        faults_within(Path::new(env!("CARGO_MANIFEST_DIR")), folder, &mut found);
    }
    assert!(found.is_empty(), "neither `slow` nor `long: …` with a name to it:\n{}", found.join("\n"));
}

/// The control.
#[test]
fn ignored_tests_of_no_run_are_found() {
    let attribute = |reason: &str, name: &str| format!("#[test]\n#[ignore{reason}]\nfn {name}() {{}}\n");
    let is_sound = |path: &str, reason: &str, name: &str| faults(path, &attribute(reason, name)).is_empty();
    assert!(is_sound("tests/gpu/film.rs", " = \"slow\"", "sums"));
    assert!(is_sound("tests/gpu/film.rs", " = \"long: all\"", "long_sums"));
    assert!(is_sound("src/film.rs", " = \"long: all\"", "long_sums"));
    assert!(!is_sound("src/film.rs", " = \"slow\"", "sums"));
    assert!(!is_sound("tests/gpu/film.rs", " = \"slow\"", "long_sums"));
    assert!(!is_sound("tests/gpu/film.rs", " = \"long: all\"", "sums"));
    assert!(!is_sound("tests/gpu/film.rs", " = \"fails\"", "sums"));
    assert!(!is_sound("tests/gpu/film.rs", "", "sums"));
}
