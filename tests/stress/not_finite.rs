//! Numbers beyond single precision are refused, counted and reported.

use std::process::Command;

use super::support::{DEVICE, Effort, Finding};

/// A point light of the largest intensity, a hundredth above a floor: beside it, radiance goes past what a film can square.
const OVERFLOW: &str = r#"
[film]
size = [16, 16]
[render]
spp = 2
max_depth = 2
[camera]
position = [0, 1, 0.1]
look_at = [0, 0, 0]
vfov = 5
[[material]]
name = "white"
type = "diffuse"
reflectance = 1
[[shape]]
type = "rectangle"
corner = [-1, 0, 1]
edge_u = [2, 0, 0]
edge_v = [0, 0, -2]
material = "white"
[[light]]
type = "point"
position = [0, 0.01, 0]
intensity = 1e18
"#;

/// The program on both devices: refused samples are told of, counted, and with `--strict` an exit code of 6.
pub fn findings(_: Effort) -> Vec<Finding> {
    let devices = if DEVICE.is_some() { &["cpu", "gpu"][..] } else { &["cpu"] };
    let dim = OVERFLOW.replace("1e18", "1");
    let mut findings = Vec::new();
    for device in devices {
        findings.push(run("radiance beyond 1e19", device, OVERFLOW, &[], 0, true));
        findings.push(run("radiance beyond 1e19, --strict", device, OVERFLOW, &["--strict"], 6, true));
        // The negative control.
        findings.push(run("the same light of intensity 1, --strict", device, &dim, &["--strict"], 0, false));
    }
    findings
}

fn run(case: &str, device: &str, scene: &str, flags: &[&str], code: i32, refuses: bool) -> Finding {
    let folder = tempfile::tempdir().expect("a temporary folder");
    std::fs::write(folder.path().join("scene.toml"), scene).expect("a new folder can be written to");
    let output = Command::new(env!("CARGO_BIN_EXE_gpt"))
        .current_dir(folder.path())
        .args(["render", "scene.toml", "--device", device, "-o", "picture.exr", "--stats", "stats.json"])
        .args(flags)
        .output()
        .expect("the program starts");
    let stats = std::fs::read_to_string(folder.path().join("stats.json")).unwrap_or_default();
    let stats: serde_json::Value = serde_json::from_str(&stats).unwrap_or_default();
    let refused = stats["non_finite_samples"].as_u64();
    let told = String::from_utf8_lossy(&output.stderr).contains("not finite");
    let picture = gpt::output::read_image(&folder.path().join("picture.exr"));
    let finite = picture.is_ok_and(|picture| picture.pixels.iter().flatten().all(|value| value.is_finite()));
    let found = output.status.code();
    Finding::new(format!("{case}, on the {device}"))
        .with("samples refused", refused.map_or("?".to_owned(), |count| count.to_string()))
        .with("exit code", found.map_or("none".to_owned(), |code| code.to_string()))
        .require(found == Some(code), || format!("exit code {found:?} instead of {code}"))
        .require(refused.is_some_and(|count| (count > 0) == refuses), || format!("{refused:?} samples refused"))
        .require(told == refuses, || format!("stderr: {}", String::from_utf8_lossy(&output.stderr)))
        .require(finite, || "the picture is missing or not finite".to_owned())
}
