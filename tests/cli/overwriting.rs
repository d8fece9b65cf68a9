//! An output never replaces an input, whichever command writes it and whatever the file is called.

use super::*;

/// A scene of Mitsuba.
const ROOM: &str = "<scene version=\"3.0.0\"><sensor type=\"perspective\"><float name=\"fov\" value=\"40\"/><film type=\"hdrfilm\">\
    <integer name=\"width\" value=\"8\"/><integer name=\"height\" value=\"8\"/></film><transform name=\"to_world\">\
    <lookat origin=\"0, 0, 5\" target=\"0, 0, 0\" up=\"0, 1, 0\"/></transform></sensor><include filename=\"part.xml\"/>\
    <emitter type=\"envmap\"><string name=\"filename\" value=\"sky.exr\"/></emitter></scene>";
const PART: &str = "<scene version=\"3.0.0\"><shape type=\"obj\"><string name=\"filename\" value=\"model.obj\"/></shape></scene>";
const MODEL: &str = "mtllib model.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\n";

/// A folder with everything that commands read.
fn full() -> Workplace {
    let place = Workplace::new();
    place.expect(0, "render scene.toml -q --device cpu --size 8x8 --spp 4 -o sky.exr -o map.png --aov variance,samples");
    place.expect(0, "render scene.toml -q --device cpu --size 8x8 --spp 2 --first-sample 0 --aov albedo -o whole.exr");
    for (index, first) in [0, 4].iter().enumerate() {
        place.expect(0, &format!("render scene.toml -q --device cpu --size 8x8 --spp 4 --first-sample {first} -o p{index}.exr"));
    }
    let write = |name: &str, text: &str| fs::write(place.path(name), text).expect("the file");
    write("room.xml", ROOM);
    write("part.xml", PART);
    write("model.obj", MODEL);
    write("model.mtl", "newmtl m\nKd 0.5 0.5 0.5\nmap_Kd map.png\n");
    write("model.toml", "[[material]]\nname = \"m\"\ntype = \"diffuse\"\nreflectance = 0.5\n");
    let mesh = "[[shape]]\ntype = \"mesh\"\nfile = \"model.obj\"\n[[material]]\nname = \"wood\"\ntype = \"diffuse\"\nreflectance = { texture = \"t\" }\n\
        [[texture]]\nname = \"t\"\ntype = \"image\"\nfile = \"map.png\"\n[[shape]]\ntype = \"rectangle\"\ncorner = [-1, -1, 1]\nedge_u = [2, 0, 0]\nedge_v = [0, 0, -2]\nmaterial = \"wood\"\n";
    write("full.toml", &format!("{}\n{mesh}", scene()));
    fs::create_dir_all(place.path("scenes")).expect("a folder");
    fs::copy(place.path("scene.toml"), place.path("scenes/lit.toml")).expect("the scene");
    place.expect(0, "test scenes --device cpu -q --bless --change 50%");
    fs::create_dir_all(place.path("other")).expect("a folder");
    fs::copy(place.path("scenes/golden/lit.exr"), place.path("other/lit.exr")).expect("the picture");
    place
}

/// Everything in the folder, and in those below.
fn contents(folder: &Path) -> Vec<(std::path::PathBuf, Vec<u8>)> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).expect("the folder").map(|entry| entry.expect("an entry").path()) {
        if entry.is_dir() {
            found.extend(contents(&entry));
        } else {
            let bytes = fs::read(&entry).expect("the file");
            found.push((entry, bytes));
        }
    }
    found.sort();
    found
}

/// Commands with `{}` for what they write, and the files that they read.
const READERS: &[(&str, &[&str])] = &[
    ("render full.toml -q --device cpu --spp 1 -o {}", &["map.png"]),
    ("render full.toml -q --device cpu --spp 1 --environment sky.exr -o {}", &["map.png", "sky.exr"]),
    ("render room.xml -q --device cpu --spp 1 -o {}", &["sky.exr"]),
    ("render room.xml -q --device cpu --spp 1 -o {} --resume", &["sky.exr"]),
    ("render full.toml -q --device cpu --spp 1 -o new.exr --stats {}", &["full.toml", "model.obj", "model.mtl", "map.png"]),
    ("render room.xml -q --device cpu --spp 1 -o new.exr --stats {}", &["room.xml", "part.xml", "model.obj", "sky.exr"]),
    ("render full.toml -q --device cpu --spp 1 -o new.exr --save-scene {}", &["full.toml"]),
    ("render model.obj -q --device cpu --spp 1 --material model.toml -o new.exr --save-scene {}", &["model.toml"]),
    ("import room.xml -o {}", &[]),
    ("import model.obj -o {}", &[]),
    ("export room.xml -o {}", &["room.xml", "part.xml"]),
    ("merge p0.exr p1.exr -o {}", &["p0.exr", "p1.exr"]),
    ("merge p0.exr p1.exr -o new.exr -o {}", &["p0.exr", "p1.exr"]),
    ("denoise sky.exr -o {}", &["sky.exr"]),
    ("regroup sky.exr --group key=2 -o {}", &["sky.exr"]),
    ("compare sky.exr p0.exr --html {}", &["sky.exr", "p0.exr"]),
    ("test scenes -q --device cpu --html {}", &["scenes/lit.toml", "scenes/golden/lit.exr"]),
    ("test scenes -q --device cpu --junit {}", &["scenes/lit.toml", "scenes/golden/lit.exr"]),
    ("test scenes -q --candidate-dir other --junit {}", &["other/lit.exr"]),
];

#[test]
fn an_output_never_replaces_an_input() {
    let place = full();
    let before = contents(&place.path(""));
    let mut tried = 0;
    for (command, inputs) in READERS {
        for input in *inputs {
            let (folder, name) = input.rsplit_once('/').unwrap_or((".", input));
            let ending = name.rsplit_once('.').expect("an ending").1;
            let mut names = vec![(*input).to_owned(), format!("{folder}/../{}/{name}", place_name(&place, folder))];
            #[cfg(unix)]
            {
                let links = [format!("soft.{ending}"), format!("hard.{ending}")];
                std::os::unix::fs::symlink(place.path(input), place.path(&links[0])).expect("a link");
                fs::hard_link(place.path(input), place.path(&links[1])).expect("a link");
                names.extend(links);
            }
            for name in &names {
                let stderr = place.expect(2, &command.replace("{}", name));
                assert!(stderr.contains("would be overwritten"), "{command} to {name}: {stderr}");
                tried += 1;
            }
            for link in ["soft", "hard"] {
                let _ = fs::remove_file(place.path(&format!("{link}.{ending}")));
            }
            assert!(contents(&place.path("")) == before, "{command} to {input}");
        }
    }
    assert!(tried > 50, "{tried}");
}

/// The folder's own name, to which a way round leads.
fn place_name(place: &Workplace, folder: &str) -> String {
    let folder = fs::canonicalize(place.path(folder)).expect("the folder");
    folder.file_name().expect("a name").to_string_lossy().into_owned()
}

/// The control: the same commands write what is not read, also where it stands there already.
#[test]
#[ignore = "slow"]
fn outputs_are_replaced() {
    let place = full();
    let endings =
        [("render", "exr"), ("import", "toml"), ("export", "xml"), ("merge", "exr"), ("compare", "html"), ("test", "xml")];
    for (command, _) in READERS {
        let Some((_, ending)) = endings.iter().find(|(name, _)| command.starts_with(name)) else { continue };
        let ending = if command.contains("--save-scene") { "toml" } else { ending };
        let output = format!("out.{ending}");
        for _ in 0..2 {
            let done = place.run(&command.replace("{}", &output));
            // A comparison may find a difference.
            assert!([Some(0), Some(7)].contains(&done.status.code()), "{command}: {}", text(&done.stderr));
            assert!(place.path(&output).is_file(), "{command}");
        }
        fs::remove_file(place.path(&output)).expect("the output");
    }
    // Blessing is meant to replace.
    place.expect(0, "test scenes --device cpu -q --bless --change 50%");
    place.expect(0, "test scenes --device cpu -q --update --change 50%");
    // A picture that is finished is looked at, and written again where it is another one.
    for spp in ["1", "2"] {
        place.expect(0, &format!("render scene.toml -q --device cpu --spp {spp} --resume -o again.exr"));
    }
}

/// Without `-o`, pictures are called as the scene is: beside it there may be a texture of that name.
#[test]
fn default_names_replace_no_input() {
    let place = Workplace::new();
    place.expect(0, "render scene.toml -q --device cpu --size 8x8 --spp 1 -o room.png");
    let texture = "[[texture]]\nname = \"t\"\ntype = \"image\"\nfile = \"room.png\"\n[[material]]\nname = \"w\"\ntype = \"diffuse\"\nreflectance = { texture = \"t\" }\n\
        [[shape]]\ntype = \"rectangle\"\ncorner = [-1, -1, 1]\nedge_u = [2, 0, 0]\nedge_v = [0, 0, -2]\nmaterial = \"w\"\n";
    fs::write(place.path("room.toml"), format!("{}\n{texture}", scene())).expect("the scene");
    let before = contents(&place.path(""));
    let stderr = place.expect(2, "render room.toml -q --device cpu --spp 1");
    assert!(stderr.contains("room.png is a file that is read, and would be overwritten"), "{stderr}");
    assert!(contents(&place.path("")) == before);
}

#[test]
fn one_file_is_written_once() {
    let place = full();
    for command in [
        "render scene.toml -q --device cpu --spp 1 -o a.exr -o ./a.exr",
        "render scene.toml -q --device cpu --spp 1 -o a.exr --stats a.exr",
        "render scene.toml -q --device cpu --spp 1 -o a.exr --stats a.toml --save-scene a.toml",
        "render scene.toml -q --device cpu --spp 1 -o a.exr --checkpoint 1 --stats a.exr.checkpoint",
        "merge p0.exr p1.exr -o a.exr -o a.exr",
        "denoise sky.exr -o a.exr -o ./a.exr",
        "test scenes -q --device cpu --html a --junit ./a",
    ] {
        let stderr = place.expect(2, command);
        assert!(stderr.contains("named twice"), "{command}: {stderr}");
        assert!(place.files().iter().all(|name| !name.starts_with("a.") && name != "a"), "{command}");
    }
}
