//! The places of pictures and statistics.

use super::*;

#[test]
fn a_file_that_cannot_be_written_does_not_take_the_others_along() {
    let place = Workplace::new();
    // The encoder meets the limit, not the beginning of the file.
    let mut command = Command::new("bash");
    let render = "render scene.toml --device cpu --spp 1 --size 256x256 -o a.exr -o a.png --stats s.json";
    command.args(["-c", &format!("ulimit -f 100; exec {} {render}", env!("CARGO_BIN_EXE_gpt"))]).current_dir(place.0.path());
    let output = command.output().expect("bash");
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("cannot write a.exr") && !said.contains("cannot write a.png"), "{said}");
    // The float picture is larger than 100 KiB, and the preview is not.
    assert_eq!(place.files(), ["a.png", "s.json", "scene.toml"]);
    assert_eq!(place.stats("s.json")["outputs"], serde_json::json!(["a.png"]));
    assert_eq!(place.image("a.png").width, 256);
}

#[test]
fn a_dash_is_standard_output() {
    let place = Workplace::new();
    place.expect(0, "render scene.toml --device cpu --spp 2 -q -o a.exr");
    let output = place.run("render scene.toml --device cpu --spp 2 -q -o -");
    assert_eq!(output.status.code(), Some(0));
    assert!(output.stdout == fs::read(place.path("a.exr")).expect("the picture"), "another picture than in the file");
    let output = place.run("render scene.toml --device cpu --spp 2 -q -o b.exr --stats -");
    let stats: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!((&stats["spp"], &stats["outputs"]), (&2.into(), &serde_json::json!(["b.exr"])));
    assert_eq!(place.files(), ["a.exr", "b.exr", "scene.toml"]);
    place.expect(2, "render scene.toml --device cpu -o - --stats -");
}

#[cfg(unix)]
#[test]
fn one_file_is_named_once() {
    use std::os::unix::fs::symlink;
    let place = Workplace::new();
    fs::create_dir(place.path("folder")).expect("a folder");
    symlink("folder", place.path("also")).expect("a link");
    symlink("a.exr", place.path("link.exr")).expect("a link");
    for twice in
        ["-o folder/a.exr -o also/a.exr", "-o a.exr -o link.exr", "-o a.exr -o folder/../a.exr", "-o a.exr --stats ./a.exr"]
    {
        let said = place.expect(2, &format!("render scene.toml --device cpu --spp 1 {twice}"));
        assert!(said.contains("named twice"), "{said}");
    }
    // A link that leads nowhere yet stays a link.
    place.expect(0, "render scene.toml --device cpu --spp 1 -o link.exr");
    assert!(fs::symlink_metadata(place.path("link.exr")).expect("it is there").is_symlink());
    assert!(place.path("a.exr").is_file());
}

/// Whatever name it has, and whatever it is of the scene.
#[test]
fn files_of_the_scene_are_not_overwritten() {
    let place = Workplace::new();
    place.expect(0, "render scene.toml --device cpu --spp 1 -q -o sky.exr");
    let with_map = scene() + "\n[[light]]\ntype = \"environment\"\nfile = \"sky.exr\"\n";
    fs::write(place.path("map.toml"), &with_map).expect("a file");
    #[cfg(unix)]
    std::os::unix::fs::symlink("sky.exr", place.path("link.exr")).expect("a link");
    let sky = fs::read(place.path("sky.exr")).expect("the map");
    let links: &[&str] = if cfg!(unix) { &["-o link.exr"] } else { &[] };
    for output in ["--stats map.toml", "-o sky.exr", "-o a.png -o ./sky.exr"].iter().chain(links) {
        let said = place.expect(2, &format!("render map.toml --device cpu --spp 1 {output}"));
        assert!(said.contains("is a file that is read, and would be overwritten"), "{said}");
    }
    assert!(fs::read(place.path("sky.exr")).expect("the map") == sky);
    assert!(fs::read_to_string(place.path("map.toml")).expect("the scene") == with_map);
    // The control: what this scene does not read may be written over.
    place.expect(0, "render scene.toml --device cpu --spp 1 -q -o sky.exr");
}

#[test]
fn equal_renders_are_equal_files() {
    let place = Workplace::new();
    for name in ["a.exr", "b.exr"] {
        place.expect(0, &format!("render scene.toml --device cpu --spp 2 -q -o {name}"));
    }
    assert!(fs::read(place.path("a.exr")).expect("one") == fs::read(place.path("b.exr")).expect("the other"));
}

/// The next render into the same folder removes the files that a killed process left.
#[test]
fn what_a_killed_render_left_is_removed() {
    let place = Workplace::new();
    let mut command = place.command("render scene.toml --device cpu --spp 100000000 -o a.exr");
    let mut child = command.stderr(Stdio::null()).spawn().expect("a process");
    while !place.files().iter().any(|name| name.ends_with(".part")) {
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    // While it lives, its file stays.
    place.expect(0, "render scene.toml --device cpu --spp 1 -q -o b.exr");
    assert_eq!(place.files().iter().filter(|name| name.ends_with(".part")).count(), 1);
    child.kill().expect("it lives");
    child.wait().expect("an end");
    assert_eq!(place.files().iter().filter(|name| name.ends_with(".part")).count(), 1);
    place.expect(0, "render scene.toml --device cpu --spp 1 -q -o b.exr");
    assert_eq!(place.files(), ["b.exr", "scene.toml"]);
}

#[test]
fn a_folder_of_shaders_that_is_missing_is_told() {
    if std::env::var("GPT_TEST_GPU").as_deref() == Ok("skip") {
        return;
    }
    let place = Workplace::new();
    let mut command = place.command("render scene.toml --device gpu --spp 1 -o a.exr");
    let output = command.env("GPT_SHADERS", "/nonexistent").output().expect("the program starts");
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("GPT_SHADERS names /nonexistent"), "{said}");
    let shaders = concat!(env!("CARGO_MANIFEST_DIR"), "/shaders");
    let mut command = place.command("render scene.toml --device gpu --spp 1 -o a.exr");
    assert_eq!(command.env("GPT_SHADERS", shaders).output().expect("the program starts").status.code(), Some(0));
}
