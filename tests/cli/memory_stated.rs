//! The host's memory, as it is stated before it is taken and as it is measured.
#![cfg(target_os = "linux")]

use gpt::plan::host::HOST_FACTOR;

use super::checkpoints::devices;
use super::*;

/// A surface of 2 n² triangles.
fn grid(n: usize) -> String {
    let mut text = String::new();
    for index in 0..(n + 1) * (n + 1) {
        let (x, z) = (index % (n + 1), index / (n + 1));
        text += &format!("v {} {} {}\n", x as f64 / n as f64, ((x * 7 + z * 3) % 5) as f64 * 0.01, z as f64 / n as f64);
    }
    for index in 0..n * n {
        let corner = index / n * (n + 1) + index % n + 1;
        text += &format!("f {corner} {} {}\nf {corner} {} {}\n", corner + 1, corner + n + 2, corner + n + 2, corner + n + 1);
    }
    text
}

#[test]
#[ignore = "slow"]
fn memory_is_what_was_stated() {
    let place = Workplace::new();
    fs::write(place.path("grid.obj"), grid(150)).expect("a model");
    for device in devices() {
        let (mut first_expected, mut largest) = (f64::INFINITY, 0.0);
        for arguments in [
            "scene.toml --spp 1",
            "scene.toml --spp 1 --size 1200x1200 --max-depth 1",
            "scene.toml --spp 16 --size 400x400 --max-depth 1 --adaptive --checkpoint 0.1",
            "grid.obj --spp 1 --size 32x32",
            // A narrow region does not take the whole width.
            "scene.toml --spp 1 --size 6000x6000 --max-depth 1 --crop 3000,0,16,6000",
        ] {
            place.expect(0, &format!("render {arguments} --device {device} -q -o a.exr --stats s.json"));
            let stats = place.stats("s.json");
            let [peak, expected] = ["peak_host_bytes", "expected_host_bytes"].map(|key| stats[key].as_f64().expect("a number"));
            let share = peak / expected;
            assert!((1.0 / HOST_FACTOR..=HOST_FACTOR).contains(&share), "{device} {arguments}: {peak} is {share} of {expected}");
            (first_expected, largest) = (expected.min(first_expected), peak.max(largest));
        }
        // The control: what the smallest render is stated to take is too little for the largest, where no driver outweighs both.
        assert!(device != "cpu" || largest > HOST_FACTOR * first_expected, "{largest} {first_expected}");
    }
    let stated = |arguments: &str| -> Value { serde_json::from_slice(&place.run(arguments).stdout).expect("JSON") };
    let [few, many] = ["24x16", "2400x1600"].map(|size| stated(&format!("plan scene.toml --chunks 1 --size {size}")));
    let bytes = |plan: &Value| plan["chunks"][0]["host_bytes"].as_u64().expect("a number");
    assert!(bytes(&many) > bytes(&few) + 2400 * 1600 * 64, "{many}");
    let check = stated("check grid.obj --json");
    assert!(check["host_bytes"].as_u64() > check["cpu_host_bytes"].as_u64(), "{check}");
    assert!(text(&place.run("check scene.toml").stdout).contains("\nhost       "));
}
