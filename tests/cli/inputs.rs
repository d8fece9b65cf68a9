//! Files that the program reads: which, how much of them, and what stands for those that are missing.

use std::io::Write;
use std::time::{Duration, Instant};

use super::*;

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n";

impl Workplace {
    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        fs::write(self.path(name), content).expect("a file in a folder of its own");
    }

    /// Does the work of [`Workplace::expect`], within a time that no pipe or device would let it end in.
    fn expect_soon(&self, code: i32, arguments: &str) -> String {
        let mut child =
            self.command(arguments).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("it starts");
        let deadline = Instant::now() + Duration::from_secs(60);
        while child.try_wait().expect("a child").is_none() {
            if Instant::now() > deadline {
                child.kill().expect("it still runs");
                panic!("gpt {arguments} does not end");
            }
            std::thread::sleep(Duration::from_millis(10));
        }
        let output = child.wait_with_output().expect("it ended");
        let stderr = text(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "gpt {arguments}\n{stderr}");
        stderr
    }
}

#[cfg(unix)]
#[test]
#[ignore = "slow"]
fn pipes_and_devices_are_refused_wherever_a_file_is_named() {
    let place = Workplace::new();
    assert!(Command::new("mkfifo").arg(place.path("pipe.toml")).status().expect("mkfifo").success());
    for name in ["pipe.obj", "pipe.png", "pipe.exr", "pipe.mtl"] {
        fs::hard_link(place.path("pipe.toml"), place.path(name)).expect("a link");
    }
    place.write("library.obj", format!("mtllib /dev/zero\nmtllib pipe.mtl\nusemtl a\n{TRIANGLE}f 1 2 3\n"));
    place.write("picture.obj", format!("mtllib picture.mtl\nusemtl a\n{TRIANGLE}f 1/1 2/2 3/3\n"));
    place.write("picture.mtl", "newmtl a\nmap_Kd pipe.png\nmap_Ke /dev/urandom\n");
    place.write(
        "map.toml",
        scene().replace(
            "type = \"point\"\nposition = [3, 4, 5]\nintensity = [40, 30, 20]",
            "type = \"environment\"\nfile = \"pipe.exr\"",
        ),
    );
    for (name, code) in [("pipe.toml", 3), ("pipe.obj", 3), ("map.toml", 3), ("library.obj", 0), ("picture.obj", 0)] {
        let stderr = place.expect_soon(code, &format!("check {name} --json"));
        assert!(stderr.contains("not a regular file"), "{name}: {stderr}");
    }
    let stderr = place.expect_soon(3, "compare pipe.png pipe.exr");
    assert!(stderr.contains("it is a pipe, not a regular file"), "{stderr}");
}

#[test]
fn a_scene_may_come_on_the_standard_input() {
    let place = Workplace::new();
    let mut child = place.command("check - --json").stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().expect("it starts");
    child.stdin.take().expect("a pipe").write_all(scene().as_bytes()).expect("it reads");
    let output = child.wait_with_output().expect("it ends");
    assert_eq!(output.status.code(), Some(0));
    let json: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(json["name"], "stdin");
}

#[test]
fn nothing_outside_of_the_assets_root_is_read() {
    let place = Workplace::new();
    fs::create_dir(place.path("inside")).expect("a folder");
    place.write("outside.obj", format!("{TRIANGLE}f 1 2 3\n"));
    place.write("inside/model.obj", format!("mtllib ../outside.mtl\nusemtl a\n{TRIANGLE}f 1 2 3\n"));
    place.write("outside.mtl", "newmtl a\nKd 1 0 0\n");
    let mesh = |file: &str| {
        scene()
            .replace("type = \"sphere\"", &format!("type = \"mesh\"\nfile = \"{file}\""))
            .lines()
            .filter(|line| !line.starts_with("center") && !line.starts_with("radius"))
            .collect::<Vec<_>>()
            .join("\n")
    };
    place.write("inside/out.toml", mesh("../outside.obj"));
    place.write("inside/in.toml", mesh("model.obj"));
    place.expect(0, "check inside/out.toml --json");
    let stderr = place.expect(3, "check inside/out.toml --json --assets-root inside");
    assert!(stderr.contains("outside") && stderr.contains("--assets-root"), "{stderr}");
    place.expect(0, "check inside/in.toml --json --assets-root inside");
    // The library is outside as well: it is missing then.
    let stderr = place.expect(0, "check inside/model.obj --json --assets-root inside");
    assert!(stderr.contains("outside.mtl cannot be read") && stderr.contains("magenta"), "{stderr}");
    place.expect(3, "check inside/model.obj --json --assets-root absent");
}

#[test]
#[ignore = "slow"]
fn what_is_missing_is_magenta_and_with_strict_an_error() {
    let place = Workplace::new();
    place
        .write("model.obj", format!("mtllib model.mtl absent.mtl\nusemtl a\n{TRIANGLE}f 1/1 2/2 3/3\nusemtl b\nf 1/1 3/3 2/2\n"));
    place.write("model.mtl", "newmtl a\nmap_Kd absent.png\n");
    let stderr = place.expect(0, "check model.obj --json");
    for said in ["absent.mtl cannot be read", "no material library has b", "the material `a`: map_Kd", "magenta stands for it"] {
        assert!(stderr.contains(said), "{said}: {stderr}");
    }
    let stderr = place.expect(3, "check model.obj --json --strict");
    assert!(stderr.contains("absent.mtl cannot be read"), "{stderr}");
    place.expect(3, "render model.obj --device cpu --size 8x8 --spp 1 --strict");
    // The control: nothing is missing.
    place.write("model.obj", format!("mtllib model.mtl\nusemtl a\n{TRIANGLE}f 1/1 2/2 3/3\n"));
    place.write("model.mtl", "newmtl a\nKd 1 0 0\n");
    assert_eq!(place.expect(0, "check model.obj --json --strict"), "");
}

#[test]
#[ignore = "slow"]
fn pictures_in_other_case_and_beside_the_model_are_taken_and_said() {
    let place = Workplace::new();
    image::RgbImage::new(1, 1).save(place.path("Wood.PNG")).expect("a picture");
    place.write("model.obj", format!("mtllib MODEL.mtl\nusemtl Möbel\n{TRIANGLE}f 1/1 2/2 3/3\n"));
    let library: Vec<u8> = "newmtl Möbel\nmap_Kd C:\\textures\\wood.png\n".chars().map(|character| character as u8).collect();
    place.write("model.mtl", library);
    let stderr = place.expect(0, "check model.obj --json --strict");
    for said in ["there is no material library MODEL.mtl", "read as windows-1252", "Wood.PNG is taken"] {
        assert!(stderr.contains(said), "{said}: {stderr}");
    }
    let utf_16 = |text: &str| text.encode_utf16().flat_map(u16::to_le_bytes).collect::<Vec<u8>>();
    place.write("model.mtl", utf_16("newmtl Möbel\nKd 1 0 0\n"));
    let stderr = place.expect(0, "check model.obj --json --strict");
    assert!(stderr.contains("read as UTF-16LE"), "{stderr}");
    place.write("wide.toml", utf_16(&scene()));
    let stderr = place.expect(3, "check wide.toml");
    assert!(stderr.contains("UTF-16LE") && stderr.contains("save it as UTF-8"), "{stderr}");
}

#[test]
fn keys_without_effect_are_named_once() {
    let place = Workplace::new();
    place.write("model.obj", format!("mtllib model.mtl\nusemtl a\n{TRIANGLE}f 1 2 3\n"));
    place.write("model.mtl", "newmtl a\nKd 1 0 0\nPr 0.5\nrefl x.png\nPcr 0.1\nsharpness 30\nnewmtl b\nPr 0.1\nsharpness 60\n");
    let stderr = place.expect(0, "check model.obj --json");
    assert!(stderr.contains("keys that have no effect: refl, sharpness"), "{stderr}");
    assert_eq!(stderr.matches("sharpness").count(), 1, "{stderr}");
}

#[test]
fn all_mistakes_of_a_file_are_told_at_once() {
    let place = Workplace::new();
    let wrong = "[[material]]\nname = \"m\"\ntype = \"mirorr\"\n[[light]]\ntype = \"point\"\nposition = [0, 0]\nintensity = 1\n";
    place.write("unread.toml", scene().replace("spp = 8", "spp = -8") + wrong);
    let output = place.run("check unread.toml --json");
    assert_eq!(output.status.code(), Some(3));
    let answer: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(answer["valid"], false);
    let keys: Vec<&str> = answer["errors"].as_array().expect("a list").iter().filter_map(|error| error["key"].as_str()).collect();
    assert_eq!(keys, ["render.spp", "material[1].type", "light[1].position"]);
    let stderr = text(&output.stderr);
    assert!(["unread.toml:", "mirorr", "light[1].position"].iter().all(|said| stderr.contains(said)), "{stderr}");
    // Names and relations are judged together as well, once all can be read.
    let wrong = "[[shape]]\ntype = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"absent\"\n[[light]]\ntype = \"spot\"\n\
        position = [0, 0, 0]\ndirection = [0, 0, 0]\nintensity = 1\nangle = 20\n";
    place.write("unresolved.toml", scene() + wrong);
    let answer: Value = serde_json::from_slice(&place.run("check unresolved.toml --json").stdout).expect("JSON");
    let keys: Vec<&str> = answer["errors"].as_array().expect("a list").iter().filter_map(|error| error["key"].as_str()).collect();
    assert_eq!(keys, ["shape[1].material", "light[1].direction"]);
}

#[test]
fn pictures_of_different_kinds_are_said_to_be() {
    let place = Workplace::new();
    place.expect(0, "render scene.toml --device cpu --spp 1 -o a.exr -o a.png");
    let output = place.run("compare a.exr a.png");
    assert_eq!(output.status.code(), Some(7));
    let stderr = text(&output.stderr);
    assert!(stderr.contains("a.exr holds linear") && stderr.contains("a.png holds 8-bit"), "{stderr}");
    let json: Value = serde_json::from_slice(&place.run("compare a.png a.exr --json").stdout).expect("JSON");
    assert!(json["warnings"][0].as_str().is_some_and(|warning| warning.contains("8-bit")), "{json}");
    assert_eq!(place.expect(0, "compare a.exr a.exr"), "");
}

#[test]
fn a_map_of_few_bits_is_taken_and_said() {
    let place = Workplace::new();
    image::RgbImage::new(4, 2).save(place.path("sky.png")).expect("a picture");
    let map = "type = \"environment\"\nfile = \"sky.png\"";
    place.write("map.toml", scene() + "[[light]]\n" + map);
    let stderr = place.expect(0, "render map.toml --device cpu --spp 1 --quiet -o a.exr");
    assert!(stderr.contains("sky.png: the map has colours of 8 bits"), "{stderr}");
}

#[test]
fn other_formats_are_named_with_what_converts_them() {
    let place = Workplace::new();
    for (name, said) in [("a.blend", "Blender"), ("a.stl", "assimp export"), ("a.usdz", "USD"), ("a.jpg", "is a picture")] {
        place.write(name, "x");
        let stderr = place.expect(3, &format!("render {name}"));
        assert!(stderr.contains(said) && stderr.contains("scene files (.toml), models (.obj, .ply)"), "{name}: {stderr}");
    }
}

#[cfg(unix)]
#[test]
fn names_that_no_terminal_should_obey_and_names_that_are_no_unicode() {
    use std::os::unix::ffi::OsStrExt;
    let place = Workplace::new();
    place.write("\u{1b}[2Jevil.toml", "nonsense = \"\u{1b}]0;owned\u{7}\"\n");
    let output = place.command("check").arg("\u{1b}[2Jevil.toml").output().expect("it starts");
    let stderr = text(&output.stderr);
    assert!(output.status.code() == Some(3) && !stderr.contains('\u{1b}') && !stderr.contains('\u{7}'), "{stderr:?}");
    assert!(stderr.contains("␛[2Jevil.toml"), "{stderr}");
    let name = std::ffi::OsStr::from_bytes(b"sc\xe4ne.toml");
    place.write("scene.toml", scene());
    fs::copy(place.path("scene.toml"), place.0.path().join(name)).expect("a copy");
    let output = place.command("render --device cpu --size 8x8 --spp 1 -o a.exr").arg(name).output().expect("it starts");
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
}

#[cfg(target_os = "linux")]
#[test]
#[ignore = "slow"]
fn where_memory_is_used_up_the_scene_does_not_fit() {
    let place = Workplace::new();
    // Six pictures that are small as files and large as texels.
    image::RgbImage::new(9000, 9000).save(place.path("p0.png")).expect("a picture");
    let mut textures = String::new();
    for index in 0..6 {
        if index > 0 {
            fs::copy(place.path("p0.png"), place.path(&format!("p{index}.png"))).expect("a copy");
        }
        textures += &format!("[[texture]]\nname = \"t{index}\"\ntype = \"image\"\nfile = \"p{index}.png\"\n");
    }
    place.write("pictures.toml", scene() + &textures);
    place.write("model.obj", "v 0 0 0\n".repeat(10_000_000));
    let limited = |megabytes: u64, arguments: &str| {
        let shell = format!("ulimit -v {}; exec \"$0\" {arguments}", megabytes << 10);
        let output = Command::new("bash")
            .args(["-c", &shell, env!("CARGO_BIN_EXE_gpt")])
            .current_dir(place.0.path())
            .output()
            .expect("bash");
        (output.status.code(), text(&output.stderr))
    };
    let start = Instant::now();
    let (code, stderr) = limited(2000, "check pictures.toml --json");
    assert!(code == Some(3) && stderr.contains("9000 x 9000") && stderr.contains("pictures may take"), "{code:?} {stderr}");
    assert!(start.elapsed() < Duration::from_secs(30), "nothing large was decoded");
    let (code, stderr) = limited(150, "check model.obj --json");
    assert!(code == Some(4) && stderr.contains("not enough memory"), "{code:?} {stderr}");
    // The control: less fits.
    assert_eq!(limited(1000, "render scene.toml --device cpu --quiet -o a.exr").0, Some(0));
}

/// The time is guessed by paths, and these would go on for minutes.
#[test]
#[ignore = "slow"]
fn closed_mirrors_are_checked_at_once() {
    let place = Workplace::new();
    let mirrors = "camera = { position = [0, 0, 0], look_at = [0.3, 0.2, -1], vfov = 40 }\nrender.max_depth = 3_000_000\nrender.roulette_depth = 3_000_000\n\
        material = [{ name = \"mirror\", type = \"mirror\", reflectance = [1, 1, 1] }]\nlight = [{ type = \"environment\", radiance = 1 }]\n\
        shape = [{ type = \"box\", min = [-1, -1, -1], max = [1, 1, 1], material = \"mirror\" }]\n";
    fs::write(place.path("mirrors.toml"), mirrors).expect("a file");
    let start = std::time::Instant::now();
    let output = place.run("check mirrors.toml");
    assert!(output.status.success() && text(&output.stdout).starts_with("valid"), "{}", text(&output.stderr));
    assert!(start.elapsed() < std::time::Duration::from_secs(30), "{:?}", start.elapsed());
}
