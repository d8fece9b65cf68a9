//! `gpt render model.obj`: the dials of a model's view, and the scene file that is made of it.

use super::*;

/// A flat L that stands on its side in a file whose z points up: 1 wide, 3 high, and a small part of another material.
const MODEL: &str = "mtllib model.mtl\nv 0 0 0\nv 1 0 0\nv 1 0 3\nv 0 0 3\nv 0 0.1 0\nv 2 0.1 0\nv 2 0.1 1\nv 0 0.1 1\n\
                     usemtl wood\nf 1 2 3 4\nusemtl iron\nf 5 6 7 8\n";

fn place() -> Workplace {
    let place = Workplace::new();
    place.write("model.obj", MODEL);
    place.write("model.mtl", "newmtl wood\nKd 0.6 0.3 0.1\nnewmtl iron\nKd 0.1 0.2 0.5\nKe 0 0 0\n");
    place
}

fn pixels(place: &Workplace, arguments: &str, name: &str) -> Vec<[f32; 3]> {
    place.expect(0, &format!("render {arguments} --device cpu --spp 2 --size 32x24 -q -o {name}"));
    place.image(name).pixels
}

/// A saved scene renders the same picture, bit for bit, with whatever dials.
#[test]
fn a_saved_scene_renders_the_same_picture() {
    let place = place();
    let map: Vec<f32> = (0..32).map(|index| 0.1 * index as f32).collect();
    exr::prelude::write_rgb_file(place.path("sky.exr"), 8, 4, |x, y| (map[x + 8 * y], 0.5_f32, 1.0_f32)).expect("a map");
    place.write("gold.toml", "[[material]]\nname = \"base\"\ntype = \"conductor\"\npreset = \"gold\"\nroughness = 0.2\n");
    fs::create_dir(place.path("below")).expect("a folder");
    for (index, dials) in [
        "",
        "--up z",
        "--up z --turn 33.3 --elevation 40 --environment sky.exr",
        "--material plastic --smooth --no-ground",
        "--material gold.toml --elevation -20",
    ]
    .into_iter()
    .enumerate()
    {
        let scene = format!("below/{index}.toml");
        let rendered = pixels(&place, &format!("model.obj {dials} --save-scene {scene}"), "a.exr");
        let again = pixels(&place, &scene, "b.exr");
        assert!(rendered == again, "{dials}");
        assert!(rendered.iter().any(|pixel| *pixel != rendered[0]), "{dials}");
        let text = fs::read_to_string(place.path(&scene)).expect("the scene");
        assert!(text.contains("file = \"../model.obj\""), "{text}");
    }
    // Negative control: another view is another picture.
    assert!(pixels(&place, "below/0.toml", "a.exr") != pixels(&place, "below/1.toml", "b.exr"));
}

#[test]
fn a_built_in_scene_is_saved_with_the_files_it_needs() {
    let place = place();
    let rendered = pixels(&place, "loft --max-depth 3 --save-scene loft.toml", "a.exr");
    assert!(place.path("loft.files").is_dir());
    assert!(rendered == pixels(&place, "loft.toml", "b.exr"));
    let stderr = place.expect(2, "render loft.toml --save-scene loft.toml --device cpu -q");
    assert!(stderr.contains("would be overwritten"), "{stderr}");
}

/// The model takes 88 % of the picture's height or width, whatever the picture's shape.
#[test]
fn the_model_fills_the_picture() {
    let place = place();
    for size in ["64x64", "96x32", "32x96"] {
        let arguments =
            format!("render model.obj --up z --no-ground --device cpu --spp 4 --size {size} -q -o a.exr --material white");
        place.expect(0, &arguments);
        let image = place.image("a.exr");
        let background = image.pixels[0];
        let is_model = |x: u32, y: u32| {
            let pixel = image.pixels[(y * image.width + x) as usize];
            pixel.iter().zip(background).any(|(a, b)| (a - b).abs() > 1e-4)
        };
        let columns: Vec<u32> = (0..image.width).filter(|&x| (0..image.height).any(|y| is_model(x, y))).collect();
        let rows: Vec<u32> = (0..image.height).filter(|&y| (0..image.width).any(|x| is_model(x, y))).collect();
        let share = |places: &[u32], side: u32| f64::from(places.last().unwrap() - places[0] + 1) / f64::from(side);
        let (across, along) = (share(&columns, image.width), share(&rows, image.height));
        assert!((0.82..=0.95).contains(&across.max(along)), "{size}: {across} {along}");
        assert!(across.min(along) < 0.95, "{size}: {across} {along}");
        let middle = |places: &[u32]| places.last().unwrap() + places[0];
        assert!(middle(&columns).abs_diff(image.width - 1) <= 4 && middle(&rows).abs_diff(image.height - 1) <= 4, "{size}");
    }
}

#[test]
fn what_a_model_cannot_have_is_said() {
    let place = place();
    let stderr = place.expect(3, "render model.obj --material gld --device cpu");
    assert!(stderr.contains("did you mean `gold`"), "{stderr}");
    let stderr = place.expect(3, "render model.obj --environment absent.exr --device cpu");
    assert!(stderr.contains("absent.exr"), "{stderr}");
    place.write("bad.toml", "[[material]]\nname = \"a\"\ntype = \"diffuse\"\nreflectance = 2\n");
    let stderr = place.expect(3, "render model.obj --material bad.toml --device cpu");
    assert!(stderr.contains("bad.toml:4") && stderr.contains("reflectance"), "{stderr}");
    let stderr = place.expect(0, "render model.obj --elevation -5 --device cpu --spp 1 --size 8x8 -o a.exr");
    assert!(stderr.contains("the ground is left out"), "{stderr}");
}

#[test]
fn built_in_scenes_are_listed_and_printed() {
    let place = Workplace::new();
    let list = text(&place.run("scenes").stdout);
    assert!(list.lines().count() > 20 && list.contains("cornell") && list.contains("The Cornell box"), "{list}");
    let printed = text(&place.run("scenes veach-mis").stdout);
    place.write("printed.toml", &printed);
    place.expect(0, "render printed.toml --device cpu --spp 1 --size 8x8 -q -o a.exr");
    place.expect(0, "render veach-mis --device cpu --spp 1 --size 8x8 -q -o b.exr");
    assert_eq!(place.image("a.exr").pixels, place.image("b.exr").pixels);
}

#[test]
fn colours_are_written_in_the_ways_people_have_them() {
    let place = Workplace::new();
    let scene = |colour: &str| {
        format!(
            "[camera]\nposition = [0, 0, 3]\nlook_at = [0, 0, 0]\nvfov = 40\n[[material]]\nname = \"a\"\ntype = \"emissive\"\n\
             radiance = {colour}\ntwo_sided = true\n[[shape]]\ntype = \"disk\"\ncenter = [0, 0, 0]\nnormal = [0, 0, 1]\nradius = 5\n\
             material = \"a\"\n"
        )
    };
    // Code 0x80 is 0.2158605 in sRGB.
    for (colour, expected) in [("\"#ff8000\"", [1.0, 0.215_860_5, 0.0]), ("\"#FF8000\"", [1.0, 0.215_860_5, 0.0])] {
        place.write("colour.toml", scene(colour));
        place.expect(0, "render colour.toml --device cpu --spp 1 --size 4x4 -q -o a.exr");
        let found = place.image("a.exr").pixels[5];
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-6), "{colour}: {found:?}");
    }
    place.write("colour.toml", scene("{ kelvin = 2700, factor = 5 }"));
    place.expect(0, "render colour.toml --device cpu --spp 1 --size 4x4 -q -o a.exr");
    let [red, green, blue] = place.image("a.exr").pixels[5];
    assert!((red - 5.0).abs() < 1e-5 && green < 4.0 && blue < 2.0 && blue > 0.3, "{red} {green} {blue}");
    for (colour, words) in [
        ("\"#ff80\"", "#ff80"),
        ("\"red\"", "#ff8800"),
        ("{ kelvin = 500 }", "from 1000 to 40000"),
        ("{ kelvn = 500 }", "kelvin"),
        ("{ kelvin = 3000, texture = \"a\" }", "one of the keys"),
    ] {
        place.write("colour.toml", scene(colour));
        let stderr = place.expect(3, "render colour.toml --device cpu");
        assert!(stderr.contains(words) && stderr.contains("colour.toml:8"), "{colour}: {stderr}");
    }
}

#[test]
fn previews_are_shown_as_the_command_line_says() {
    let place = Workplace::new();
    let files = "-o clip.png -o clip.jpg -o linear.hdr -o linear.exr";
    place.expect(0, &format!("render scene.toml --device cpu --spp 2 --tonemap clip {files} -q"));
    place.expect(0, "render scene.toml --device cpu --spp 2 -o agx.png -q");
    place
        .expect(0, "render scene.toml --device cpu --spp 2 --exposure auto --tonemap filmic --white-balance 3000 -o auto.png -q");
    place.expect(0, "render scene.toml --device cpu --spp 2 --half --compression zip -o half.exr -q");
    let centre = |name: &str| place.image(name).pixels[8 * 24 + 12];
    let near = |name: &str, tolerance: f32| {
        let (found, wanted) = (centre(name), centre("linear.exr"));
        found.iter().zip(wanted).all(|(a, b)| (a - b.min(1.0)).abs() < tolerance)
    };
    assert!(near("clip.png", 0.01) && near("clip.jpg", 0.05) && near("linear.hdr", 0.01) && near("half.exr", 1e-3));
    assert!(!near("agx.png", 0.01) && !near("auto.png", 0.01));
    let meta = exr::meta::MetaData::read_from_file(place.path("half.exr"), true).expect("an EXR file");
    let half = meta.headers[0].channels.list.iter().all(|channel| channel.sample_type == exr::meta::attribute::SampleType::F16);
    assert!(half && meta.headers[0].compression == exr::prelude::Compression::ZIP16);
}

/// Layers beside the picture, by their names in EXR files.
#[test]
fn layers_stand_beside_the_picture() {
    let place = Workplace::new();
    let layers = "albedo,normal,position,depth,alpha,variance,samples,direct,indirect,emission,ids";
    place.expect(0, &format!("render spheres --device cpu --spp 4 --size 24x16 -q --aov {layers} -o layers.exr"));
    place.expect(0, "render spheres --device cpu --spp 4 --size 24x16 -q -o plain.exr");
    assert_eq!(place.image("layers.exr").pixels, place.image("plain.exr").pixels);

    let read = exr::prelude::read_first_flat_layer_from_file(place.path("layers.exr")).expect("an EXR file");
    let list = &read.layer_data.channel_data.list;
    let names: Vec<String> = list.iter().map(|channel| channel.name.to_string()).collect();
    let expected = "A Albedo.B Albedo.G Albedo.R B Direct.B Direct.G Direct.R Emission.B Emission.G Emission.R G Indirect.B Indirect.G \
                    Indirect.R MaterialId N.X N.Y N.Z ObjectId P.X P.Y P.Z R SampleCount Variance.B Variance.G Variance.R Z";
    assert_eq!(names.join(" "), expected);
    let channel = |name: &str| -> Vec<f32> {
        let place = names.iter().position(|other| other == name).expect(name);
        list[place].sample_data.values_as_f32().collect()
    };
    assert!(channel("SampleCount").iter().all(|count| *count == 4.0));
    let (alpha, ids, depth, variance) = (channel("A"), channel("ObjectId"), channel("Z"), channel("Variance.G"));
    for pixel in 0..24 * 16 {
        assert!(alpha[pixel] == 0.0 || depth[pixel] > 0.0, "{pixel}");
        assert!(alpha[pixel] != 1.0 || ids[pixel] > 0.0, "{pixel}");
        assert!(variance[pixel] >= 0.0);
    }
    assert!(variance.iter().any(|value| *value > 0.0) && ids.iter().any(|id| *id > 1.0));
    for colour in ["R", "G", "B"] {
        let parts = ["Emission", "Direct", "Indirect"].map(|part| channel(&format!("{part}.{colour}")));
        for (pixel, value) in channel(colour).iter().enumerate() {
            let sum: f32 = parts.iter().map(|part| part[pixel]).sum();
            assert!((sum - value).abs() <= 1e-5 * (1.0 + value), "{colour} {pixel}: {sum} {value}");
        }
    }
    let stderr = place.expect(2, "render spheres --device cpu --spp 1 --aov normal -o a.png");
    assert!(stderr.contains(".exr"), "{stderr}");
    let stderr = place.expect(2, "render spheres --aov normals -o a.exr");
    assert!(stderr.contains("albedo"), "{stderr}");
}

/// By the tool of OpenImageIO, another implementation of the format, where it is installed: the names, and the mean of every channel of floats.
#[test]
fn other_programs_read_the_layers() {
    if Command::new("oiiotool").arg("--version").output().is_err() {
        super::common::effort::announce("left out: what oiiotool makes of layers, because it is not installed");
        return;
    }
    let place = Workplace::new();
    place.expect(0, "render spheres --device cpu --spp 2 --size 24x16 -q --aov albedo,normal,depth,samples,ids -o layers.exr");
    let output = Command::new("oiiotool").args(["--info", "-v", "--stats"]).arg(place.path("layers.exr")).output();
    let said = text(&output.expect("it starts").stdout);
    assert!(said.contains("24 x   16, 13 channel"), "{said}");
    let after = |what: &str| {
        let line = said.lines().find_map(|line| line.trim().strip_prefix(what));
        line.unwrap_or_else(|| panic!("{what} is not in {said}"))
    };
    let theirs: Vec<(&str, &str)> =
        after("channel list: ").split(", ").map(|channel| channel.split_once(' ').expect("a name and a type")).collect();
    let means = after("Stats Avg: ").split_whitespace().map_while(|mean| mean.parse::<f64>().ok());
    let read = exr::prelude::read_first_flat_layer_from_file(place.path("layers.exr")).expect("an EXR file");
    let ours = |name: &str| {
        let list = &read.layer_data.channel_data.list;
        let channel = list.iter().find(|channel| channel.name.to_string() == name).unwrap_or_else(|| panic!("{name} in {said}"));
        let values: Vec<f32> = channel.sample_data.values_as_f32().collect();
        values.iter().map(|value| f64::from(*value)).sum::<f64>() / values.len() as f64
    };
    let mut compared = 0;
    for ((name, kind), mean) in theirs.into_iter().zip(means) {
        match kind {
            "(float)" => assert!((mean - ours(name)).abs() < 2e-6 * (1.0 + mean.abs()), "{name}: {mean} and {}", ours(name)),
            // Its statistics take whole numbers for shares of the largest one.
            _ => assert_eq!((kind, ours(name) > 0.5), ("(uint)", true), "{name}"),
        }
        compared += 1;
    }
    assert_eq!(compared, 13, "{said}");
}
