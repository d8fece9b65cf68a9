//! Cryptomatte: what covers a pixel, by name, in files that compositing programs open.

use gpt::output::Channels;

use super::*;

/// A translucent surface of half opacity before the left of a wall; behind the right edge of the wall there is nothing.
const SCENE: &str = r#"
film.size = [16, 8]
render.spp = 64
camera = { position = [0, 0, 5], look_at = [0, 0, 0], projection = "orthographic", height = 2 }
light = [{ type = "environment", radiance = 1 }]
material = [
  { name = "küche", type = "diffuse", reflectance = 0.5 },
  { name = "veil", type = "diffuse", reflectance = 0.5, opacity = 0.5 },
]
shape = [
  { type = "rectangle", corner = [-3, -2, 0], edge_u = [4.0625, 0, 0], edge_v = [0, 4, 0], material = "küche" },
  { type = "rectangle", corner = [-3, -2, 1], edge_u = [3, 0, 0], edge_v = [0, 4, 0], material = "veil" },
]
"#;

fn file(place: &Workplace, arguments: &str) -> Channels {
    fs::write(place.path("mattes.toml"), SCENE).expect("a scene");
    place.expect(0, &format!("render mattes.toml -q --aov cryptomatte -o mattes.exr {arguments}"));
    Channels::read(&place.path("mattes.exr")).expect("an EXR file")
}

/// Name to identifier, of a layer, and its key in the header.
fn manifest(file: &Channels, layer: &str) -> Vec<(String, f32)> {
    let entry = |key: &str, what: &str| file.attribute(&format!("cryptomatte/{key}/{what}")).map(str::to_owned);
    // The first seven digits of the hash of the layer's name.
    let key = match layer {
        "CryptoObject" => "3ae39a5",
        _ => "be359d6",
    };
    assert_eq!(entry(key, "name").as_deref(), Some(layer));
    assert_eq!(entry(key, "hash").as_deref(), Some("MurmurHash3_32"));
    assert_eq!(entry(key, "conversion").as_deref(), Some("uint32_to_float32"));
    let names: Value = serde_json::from_str(&entry(key, "manifest").expect("a manifest")).expect("JSON");
    let id = |hex: &Value| f32::from_bits(u32::from_str_radix(hex.as_str().expect("text"), 16).expect("eight digits"));
    names.as_object().expect("names").iter().map(|(name, hex)| (name.clone(), id(hex))).collect()
}

/// The names that cover a pixel, the largest share first.
fn cover(file: &Channels, layer: &str, x: usize, y: usize) -> Vec<(String, f32)> {
    let names = manifest(file, layer);
    let at = |channel: &str| file.channel(&format!("{layer}{channel}")).expect("the channel")[y * 16 + x];
    let pairs = [["00.R", "00.G"], ["00.B", "00.A"], ["01.R", "01.G"], ["01.B", "01.A"], ["02.R", "02.G"], ["02.B", "02.A"]];
    let pairs = pairs.map(|[id, share]| (at(id), at(share)));
    assert!(pairs.windows(2).all(|pair| pair[0].1 >= pair[1].1), "{pairs:?}");
    let named = |id: f32| names.iter().find(|(_, known)| known.to_bits() == id.to_bits()).expect("it has a name").0.clone();
    pairs.into_iter().filter(|(_, share)| *share > 0.0).map(|(id, share)| (named(id), share)).collect()
}

#[test]
fn mattes_say_what_covers_a_pixel_and_how_much_of_it() {
    let place = Workplace::new();
    let file = file(&place, "--device cpu");
    let covered = cover(&file, "CryptoMaterial", 3, 4);
    assert_eq!(covered.len(), 2, "{covered:?}");
    assert!(
        covered.iter().all(|(_, share)| (share - 0.5).abs() < 0.08) && (covered[0].1 + covered[1].1 - 1.0).abs() < 1e-6,
        "{covered:?}"
    );
    assert_eq!(cover(&file, "CryptoMaterial", 10, 4), [("küche".to_owned(), 1.0)]);
    // The wall ends a quarter into this pixel, which is a quarter of a unit wide.
    let edge = cover(&file, "CryptoMaterial", 12, 4);
    assert!(edge.len() == 1 && (edge[0].1 - 0.25).abs() < 0.05, "{edge:?}");
    assert_eq!(cover(&file, "CryptoMaterial", 15, 4), []);
    assert_eq!(cover(&file, "CryptoObject", 3, 4).len(), 2);
    let stderr = place.expect(2, "render mattes.toml --aov cryptomatte --compression pxr24 -o a.exr");
    assert!(stderr.contains("pxr24"), "{stderr}");
}

#[test]
fn mattes_are_the_same_on_both_devices() {
    if std::env::var("GPT_TEST_GPU").as_deref() == Ok("skip") {
        return;
    }
    let place = Workplace::new();
    let [cpu, gpu] = ["cpu", "gpu"].map(|device| file(&place, &format!("--device {device}")));
    let mattes: Vec<&str> = cpu.names().filter(|name| name.starts_with("Crypto")).collect();
    assert_eq!(mattes.len(), 24);
    for name in mattes {
        let bits =
            |file: &Channels| file.channel(name).expect("the channel").iter().map(|value| value.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&cpu), bits(&gpu), "{name}");
    }
}

/// `[output]` of a scene asks for layers as `--aov` does, which overrides it.
#[test]
fn a_scene_may_ask_for_layers() {
    let place = Workplace::new();
    fs::write(place.path("asks.toml"), format!("output.aov = [\"albedo\", \"depth\"]\n{SCENE}")).expect("a scene");
    let names = |arguments: &str| {
        place.expect(0, &format!("render asks.toml -q --device cpu --spp 1 -o asks.exr {arguments}"));
        let file = Channels::read(&place.path("asks.exr")).expect("an EXR file");
        file.names().map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(names(""), ["Albedo.B", "Albedo.G", "Albedo.R", "B", "G", "R", "Z"]);
    assert_eq!(names("--aov alpha"), ["A", "B", "G", "R"]);
    place.expect(0, "render asks.toml -q --device cpu --spp 1 -o asks.png");
    fs::write(place.path("asks.toml"), format!("output.aov = [\"albedos\"]\n{SCENE}")).expect("a scene");
    let stderr = place.expect(3, "check asks.toml");
    assert!(stderr.contains("albedos") && stderr.contains("cryptomatte"), "{stderr}");
}

/// OpenImageIO knows mattes by their names, and finds their colours.
#[test]
fn openimageio_finds_the_mattes() {
    if Command::new("oiiotool").arg("--version").output().is_err() {
        super::common::effort::announce("left out: what oiiotool makes of mattes, because it is not installed");
        return;
    }
    let place = Workplace::new();
    file(&place, "--device cpu");
    let tool = |arguments: &str| {
        let output = Command::new("oiiotool").args(arguments.split_whitespace()).current_dir(place.0.path()).output();
        let output = output.expect("it starts");
        assert!(output.status.success(), "{}", text(&output.stderr));
        text(&output.stdout)
    };
    let info = tool("--info -v mattes.exr");
    assert!(info.contains("MurmurHash3_32") && info.contains("CryptoMaterial"), "{info}");
    tool("mattes.exr --cryptomatte-colors CryptoMaterial -o colours.exr");
    let colours = place.image("colours.exr");
    assert_ne!(colours.pixels[4 * 16 + 10], colours.pixels[4 * 16 + 15], "the wall and nothing");
}
