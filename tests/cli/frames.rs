//! Frames of scenes with keyframes.

use super::checkpoints::devices;
use super::*;

/// A ball, a block that turns and rises, and a lamp; the camera goes round. Every shape with keyframes is taken along by one of both ways.
const SCENE: &str = r#"
[film]
size = [24, 16]
[render]
spp = 4
max_depth = 3
[animation]
fps = 10
[camera]
position = [0, 1, 6]
look_at = [0, 0, 0]
vfov = 40
shutter = [0, 0.5]
CAMERA
[[node]]
name = "table"
keyframes = [{ frame = 0, rotate = [0, 1, 0], degrees = 0 }, { frame = 20, rotate = [0, 1, 0], degrees = 360 }]
[[material]]
name = "grey"
type = "diffuse"
reflectance = 0.5
[[shape]]
type = "sphere"
center = [0, 0, 0]
radius = 0.8
material = "grey"
BALL
[[shape]]
type = "mesh"
positions = [[1, -1, 0], [2, -1, 0.5], [1.5, 1, 0.2]]
faces = [[0, 1, 2]]
material = "grey"
BLOCK
[[light]]
type = "directional"
direction = [-1, -2, -1]
irradiance = 3
[[light]]
type = "environment"
radiance = 0.3
"#;
const CAMERA: &str = "interpolation = \"smooth\"\nkeyframes = [{ frame = 0, position = [0, 1, 6] }, { time = 1, position = [3, 1, 5], vfov = 30 }, { frame = 20, position = [5, 2, 3], vfov = 45 }]";
const BALL: &str = "keyframes = [{ frame = 0, translate = [0, 0, 0] }, { frame = 4, translate = [0, 1, 0], scale = 0.5 }, { frame = 8, translate = [1, 1, 0], scale = 1 }]";

/// A target that grows, and a joint that takes one corner along.
const BENT: &str = "deformation = { file = \"bent.json\", joints = [{ node = \"table\" }], weights = [0], keyframes = [{ frame = 0, weights = [0] }, { frame = 8, weights = [1] }] }";
const BENDING: &str =
    r#"{ "influences": [[[0, 1]], [], []], "targets": [{ "positions": [[0, 0, 0], [0, 0, 0], [-3, 0, 0.5]] }] }"#;

fn scene(camera: &str, ball: &str, block: &str) -> String {
    SCENE.replace("CAMERA", camera).replace("BALL", ball).replace("BLOCK", block)
}

/// The scene in which only the camera moves.
pub fn moving_camera() -> String {
    scene(CAMERA, "", "")
}

/// A folder with that scene, the one in which shapes do too, and one in which nothing moves but the vertices of a mesh.
fn place() -> Workplace {
    let place = Workplace::new();
    fs::write(place.path("camera.toml"), moving_camera()).expect("the scene file");
    fs::write(place.path("shapes.toml"), scene(CAMERA, BALL, "node = \"table\"")).expect("the scene file");
    fs::write(place.path("bent.toml"), scene("", "", BENT)).expect("the scene file");
    fs::write(place.path("bent.json"), BENDING).expect("the joints and targets");
    place
}

/// Whatever was rendered before it on the same device, a frame is the same file.
#[test]
#[ignore = "slow"]
fn a_frame_of_several_is_the_frame_alone() {
    let place = place();
    for device in devices() {
        for name in ["camera", "shapes", "bent"] {
            let render = format!("render {name}.toml -q --device {device}");
            place.expect(0, &format!("{render} --frames 7,1-5x2 -o all.##.exr --stats all.json"));
            let stats = place.stats("all.json");
            let frames: Vec<f64> = stats.as_array().expect("a list").iter().filter_map(|one| one["frame"].as_f64()).collect();
            assert_eq!(frames, [7.0, 1.0, 3.0, 5.0]);
            let mut pictures = Vec::new();
            for frame in [1, 3, 5, 7] {
                place.expect(0, &format!("{render} --frame {frame} -o alone.exr --stats alone.json"));
                let several = fs::read(place.path(&format!("all.{frame:02}.exr"))).expect("the picture");
                assert!(several == fs::read(place.path("alone.exr")).expect("the picture"), "{device}, {name}, frame {frame}");
                let place_in_list = [7, 1, 3, 5].iter().position(|other| *other == frame).expect("it is one of them");
                assert_eq!(place.stats("alone.json")["scene_hash"], stats[place_in_list]["scene_hash"]);
                pictures.push(several);
            }
            // The control: other frames are other pictures.
            pictures.dedup();
            assert_eq!(pictures.len(), 4, "{device}, {name}");
            // A moment by its time: frame 5 at ten frames a second.
            place.expect(0, &format!("{render} --time 0.5 -o alone.exr"));
            assert!(fs::read(place.path("alone.exr")).expect("the picture") == pictures[2]);
        }
    }
}

/// Without a frame, keyframes have no effect, and the program says so.
#[test]
fn without_a_frame_the_scene_is_what_stands_beside_the_keyframes() {
    let place = place();
    let still = scene("", "", "").replace("keyframes = ", "# keyframes = ");
    fs::write(place.path("still.toml"), still).expect("the scene file");
    let said = place.expect(0, "render shapes.toml --device cpu -o a.exr");
    assert!(said.contains("keyframes from frame 0 to frame 20; without --frame"), "{said}");
    let said = place.expect(0, "render still.toml --device cpu -o b.exr");
    assert!(!said.contains("keyframes"), "{said}");
    assert_eq!(place.image("a.exr").pixels, place.image("b.exr").pixels);
    place.expect(0, "render shapes.toml --device cpu --frame 0 -q -o b.exr");
    assert_ne!(place.image("a.exr").pixels, place.image("b.exr").pixels, "the shutter is open, and something moves");
    let said = place.expect(0, "check shapes.toml");
    assert!(said.is_empty(), "{said}");
}

/// With `--resume`, finished frames are left as they are, and those that are missing, or of other settings, are rendered.
#[test]
fn frames_that_are_finished_are_skipped() {
    let place = place();
    let before = place.files();
    let render = "render camera.toml --device cpu --resume -o out.####.exr --frames";
    place.expect(0, &format!("{render} 1-2"));
    let old = fs::metadata(place.path("out.0001.exr")).and_then(|file| file.modified()).expect("a time");
    let said = place.expect(0, &format!("{render} 1-3"));
    assert!(said.contains("out.0001.exr: finished before") && said.contains("out.0002.exr: finished before"), "{said}");
    assert!(said.contains("out.0003.exr: 24x16"), "{said}");
    assert_eq!(fs::metadata(place.path("out.0001.exr")).and_then(|file| file.modified()).expect("a time"), old);
    let said = place.expect(0, &format!("{render} 1 --spp 5"));
    assert!(said.contains("out.0001.exr: 24x16, 5 spp"), "{said}");
    let left: Vec<String> = place.files().into_iter().filter(|name| !before.contains(name)).collect();
    assert_eq!(left, ["out.0001.exr", "out.0002.exr", "out.0003.exr"]);
}

#[test]
fn frames_go_together_with_regions_layers_and_progress() {
    let place = place();
    let render = "render shapes.toml --device cpu -q --frames 2-3";
    place.expect(0, &format!("{render} -o whole.#.exr --aov depth"));
    place.expect(0, &format!("{render} --crop 4,2,10,8 -o part.#.exr"));
    let (whole, part) = (place.image("whole.3.exr"), place.image("part.3.exr"));
    let row = |image: &Image, start: u32| image.pixels[start as usize..start as usize + 10].to_vec();
    // A part is read as the picture that it is a part of, black around it.
    assert_eq!(row(&whole, 2 * 24 + 4), row(&part, 2 * 24 + 4));
    assert_eq!(row(&part, 0), [[0.0; 3]; 10]);
    let output = place.run(&format!("{render} --time-limit 100 --progress json -o p.#.exr"));
    assert_eq!(output.status.code(), Some(0));
    let lines = text(&output.stdout);
    let events: Vec<Value> = lines.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect();
    let of = |kind: &str| events.iter().filter(|event| event["event"] == kind).collect::<Vec<_>>();
    assert_eq!((of("start").len(), of("frame").len(), of("end").len()), (2, 2, 1), "{lines}");
    assert_eq!(of("frame")[1]["outputs"], serde_json::json!(["p.3.exr"]));
    let percent: Vec<f64> = of("progress").iter().filter_map(|event| event["percent"].as_f64()).collect();
    assert!(percent.is_sorted() && percent.first() <= Some(&50.0) && percent.last() > Some(&50.0), "{percent:?}");
}

#[test]
fn what_cannot_be_is_said() {
    let place = place();
    for (arguments, words) in [
        ("render camera.toml --frames 1-3 -o a.exr", "several frames would be written to one file"),
        ("render camera.toml --frames 1-3 -o -", "several frames would be written to one file"),
        ("render scene.toml --frames 1-3 -o a.#.exr", "the scene has no keyframes"),
        ("render camera.toml --frames 5-3 -o a.#.exr", "the range ends before it begins"),
        ("render camera.toml --frame 1 --frames 1-3 -o a.#.exr", "cannot be used with"),
    ] {
        let said = place.expect(2, arguments);
        assert!(said.contains(words), "{arguments}: {said}");
    }
    let keys = "keyframes = [{ frame = 0, scale = 1 }, { frame = 10, scale = -1 }]";
    fs::write(place.path("bad.toml"), scene("shutter = [0, 0]", "", keys).replace("shutter = [0, 0.5]\n", "")).expect("a file");
    let said = place.expect(3, "render bad.toml --device cpu --frames 4-6 -o a.#.exr");
    assert!(said.contains("frame 5: shape[1] (mesh): the transform is singular"), "{said}");
    let camera = "keyframes = [{ frame = 0, look_at = [0, 0, 0] }, { frame = 10, look_at = [0, 1, 6] }]";
    fs::write(place.path("bad.toml"), scene(camera, "", "")).expect("a file");
    let said = place.expect(3, "render bad.toml --device cpu --frame 10 -o a.#.exr");
    assert!(said.contains("frame 10: camera: it looks at the point it stands at"), "{said}");
    fs::write(place.path("bad.toml"), scene("keyframes = [{ frame = 0 }]", "", "")).expect("a file");
    let said = place.expect(3, "check bad.toml");
    assert!(said.contains("bad.toml:") && said.contains("a keyframe of the camera states `position`"), "{said}");
    for (keys, words) in [
        ("keyframes = [{ frame = 1, scale = 1 }, { frame = 1, scale = 2 }]", "order of their frames"),
        ("keyframes = [{ scale = 1 }]", "states its `frame`"),
        ("keyframes = [{ frame = 1, time = 1, scale = 1 }]", "this has both"),
        ("keyframes = [{ frame = 1 }]", "states `scale`"),
        ("keyframes = [{ frame = 1, scale = [1, 2, 1] }]", "can only be scaled by the same factor"),
        ("keyframes = [{ frame = 1, rotate = [0, 1, 0] }]", "`rotate` needs the key `degrees`"),
        ("keyframes = []", "at least one"),
        ("interpolation = \"smooth\"", "belongs to `keyframes`"),
        ("node = \"tabel\"", "there is no node named `tabel`"),
        ("node = \"table\"\nmotion = [{ translate = [1, 0, 0] }]", "either a `motion` or keyframes"),
    ] {
        fs::write(place.path("bad.toml"), scene("", keys, "")).expect("a file");
        let said = place.expect(3, "check bad.toml");
        assert!(said.contains(words), "{keys}: {said}");
    }
    let nodes = "[[node]]\nname = \"a\"\nparent = \"b\"\n[[node]]\nname = \"b\"\nparent = \"a\"";
    fs::write(place.path("bad.toml"), scene("", "", "") + nodes).expect("a file");
    let said = place.expect(3, "check bad.toml");
    assert!(said.contains("contains itself"), "{said}");
}

/// Ctrl-C ends the sequence; frames that are finished stay.
#[cfg(unix)]
#[test]
fn an_interrupt_ends_the_sequence() {
    let place = place();
    let mut command = place.command("render camera.toml --device cpu --frames 0-20 --spp 600 --size 64x48 -o s.##.exr -q");
    let child = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("a process");
    super::checkpoints::wait_for(&place, "s.00.exr");
    let sent = Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill");
    assert!(sent.success());
    let output = child.wait_with_output().expect("an end");
    assert_eq!(output.status.code(), Some(130), "{}", text(&output.stderr));
    assert_eq!(header_number(&place.path("s.00.exr"), "gpt:complete"), 1);
    assert!(!place.path("s.20.exr").exists());
}
