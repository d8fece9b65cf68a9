//! Forms of OpenEXR files, tiles and parts: all hold the same numbers, and every command reads them.

use exr::meta::{BlockDescription, MetaData};
use gpt::output::Channels;

use super::*;

const RENDER: &str = "render spheres -q --device cpu --size 150x70 --spp 2 --max-depth 3";
const FORMS: [&str; 4] = ["", "--exr tiled", "--exr parts", "--exr tiled,parts"];
const LAYERS: &str = "albedo,normal,depth,uv,object_position,variance,samples,ids,cryptomatte";

fn channels(place: &Workplace, name: &str) -> Channels {
    Channels::read(&place.path(name)).expect("an EXR file")
}

/// The bits of all channels by their names.
fn numbers(file: &Channels) -> Vec<(String, Vec<u32>)> {
    let bits = |name: &str| file.channel(name).expect("it is there").iter().map(|value| value.to_bits()).collect();
    file.names().map(|name| (name.to_owned(), bits(name))).collect()
}

/// Names of the parts, and whether all have tiles.
fn layout(place: &Workplace, name: &str) -> (Vec<String>, bool) {
    let meta = MetaData::read_from_file(place.path(name), true).expect("an EXR file");
    let name =
        |header: &exr::meta::header::Header| header.own_attributes.layer_name.as_ref().map_or(String::new(), ToString::to_string);
    let is_tiled = |header: &exr::meta::header::Header| matches!(header.blocks, BlockDescription::Tiles(_));
    (meta.headers.iter().map(name).collect(), meta.headers.iter().all(is_tiled))
}

#[test]
fn all_forms_hold_the_same_numbers() {
    let place = Workplace::new();
    for (index, form) in FORMS.iter().enumerate() {
        place.expect(0, &format!("{RENDER} --aov {LAYERS} {form} -o {index}.exr"));
    }
    let plain = numbers(&channels(&place, "0.exr"));
    assert!(plain.len() > 20 && plain.iter().any(|(name, _)| name == "UV.U"));
    for (index, form) in FORMS.iter().enumerate().skip(1) {
        let file = channels(&place, &format!("{index}.exr"));
        assert!(numbers(&file) == plain, "{form}");
        assert_eq!(file.attribute("gpt:layers"), channels(&place, "0.exr").attribute("gpt:layers"));
        place.expect(0, &format!("compare {index}.exr 0.exr --metric mse --tolerance 0"));
    }
    // Negative control: another seed is another picture.
    place.expect(0, &format!("{RENDER} --seed 2 --exr tiled,parts -o other.exr"));
    place.expect(7, "compare other.exr 0.exr --metric mse --tolerance 0");
    assert_eq!(layout(&place, "0.exr"), (vec![String::new()], false));
    assert_eq!(layout(&place, "1.exr"), (vec![String::new()], true));
    let (parts, is_tiled) = layout(&place, "3.exr");
    assert!(is_tiled && parts[0] == "rgba", "{parts:?}");
    for name in ["depth", "Albedo", "N", "UV", "ObjectPosition", "SampleCount", "ObjectId", "CryptoObject00"] {
        assert!(parts.iter().any(|part| part == name), "{name}: {parts:?}");
    }
}

/// A picture that is finished is not rendered again, in whichever form it is; one that was damaged is.
#[test]
fn damage_in_any_part_is_found() {
    let place = Workplace::new();
    for form in &FORMS[1..] {
        let render = format!("{RENDER} --aov depth {form} -o a.exr --checkpoint 60 --resume").replace("-q ", "");
        place.expect(0, &render);
        assert!(place.expect(0, &render).contains("finished before"), "{form}");
        let path = place.path("a.exr");
        let mut bytes = fs::read(&path).expect("the picture");
        // Near the end lie numbers of the last part.
        let place_of_bit = bytes.len() - 40;
        bytes[place_of_bit] ^= 0x10;
        fs::write(&path, bytes).expect("it is damaged");
        assert!(!place.expect(0, &render).contains("finished before"), "{form}");
        fs::remove_file(path).expect("it was written anew");
    }
}

#[test]
fn parts_of_renders_are_merged_in_any_form() {
    let place = Workplace::new();
    let layers = "--aov albedo,depth,uv,motion,object_position";
    place.expect(0, &format!("{RENDER} {layers} -o whole.exr"));
    place.expect(0, &format!("{RENDER} {layers} --exr tiled,parts --crop 0,0,97,70 -o left.exr"));
    place.expect(0, &format!("{RENDER} {layers} --crop 97,0,53,70 -o right.exr"));
    place.expect(0, "merge left.exr right.exr -o joined.exr");
    let (whole, joined) = (channels(&place, "whole.exr"), channels(&place, "joined.exr"));
    for (name, values) in numbers(&whole) {
        let found = joined.channel(&name).expect("it is there");
        let far = found.iter().zip(&values).filter(|(a, b)| a.to_bits().abs_diff(**b) > 1).count();
        assert_eq!(far, 0, "{name}");
    }
    // Samples, in two forms.
    let half = RENDER.replace("--spp 2", "--spp 1");
    place.expect(0, &format!("{half} {layers} --exr parts --first-sample 0 -o first.exr"));
    place.expect(0, &format!("{half} {layers} --exr tiled --first-sample 1 -o second.exr"));
    place.expect(0, "merge first.exr second.exr -o joined.exr");
    let joined = channels(&place, "joined.exr");
    for name in ["R", "UV.U", "ObjectPosition.Z", "Motion.X"] {
        let (a, b) = (whole.channel(name).expect("it is there"), joined.channel(name).expect("it is there"));
        assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() <= 1e-5 * (1.0 + a.abs())), "{name}");
    }
}

#[test]
fn other_commands_read_all_forms() {
    let place = Workplace::new();
    for form in &FORMS[1..] {
        place.expect(0, &format!("render lanterns -q --device cpu --size 80x70 --spp 2 --aov normal {form} -o a.exr"));
        let read = place.image("a.exr");
        assert_eq!([read.width, read.height], [80, 70], "{form}");
    }
    fs::write(
        place.path("groups.toml"),
        "[film]\nsize = [70, 66]\n[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\nvfov = 40\n[[material]]\nname = \"grey\"\ntype = \"diffuse\"\n\
         reflectance = 0.5\n[[shape]]\ntype = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"grey\"\n[[light]]\ntype = \"point\"\nposition = [2, 3, 4]\n\
         intensity = 40\nlight_group = \"key\"\n[[light]]\ntype = \"point\"\nposition = [-2, 3, 4]\nintensity = 9\nlight_group = \"fill\"\n",
    )
    .expect("a scene");
    let render = "render groups.toml -q --device cpu --spp 2 --aov groups,uv,motion";
    for (index, form) in FORMS.iter().enumerate() {
        place.expect(0, &format!("{render} {form} -o groups-{index}.exr"));
        place.expect(0, &format!("regroup groups-{index}.exr --group key=0 -o dark-{index}.exr"));
        let dark = numbers(&channels(&place, &format!("dark-{index}.exr")));
        assert!(dark == numbers(&channels(&place, "dark-0.exr")), "{form}");
        assert!(dark.iter().any(|(name, _)| name == "UV.U"), "{form}");
    }
    // A golden picture is that of candidates in any form, and not of one that is brighter.
    fs::create_dir(place.path("scenes")).expect("a folder");
    let scene = fs::read_to_string(place.path("groups.toml")).expect("the scene").replace("[70, 66]", "[24, 16]");
    fs::write(place.path("scenes/ball.toml"), &scene).expect("a scene");
    fs::write(place.path("bright.toml"), scene.replace("intensity = 40", "intensity = 60")).expect("a scene");
    place.expect(0, "test scenes --bless --device cpu --change 10%");
    fs::create_dir(place.path("candidates")).expect("a folder");
    let candidate = "-q --device cpu --spp 16 --aov variance,samples -o candidates/ball.exr";
    for form in &FORMS[1..] {
        place.expect(0, &format!("render scenes/ball.toml {form} {candidate}"));
        place.expect(0, "test scenes --candidate-dir candidates --change 10%");
    }
    place.expect(0, &format!("render bright.toml --exr tiled,parts {candidate}"));
    place.expect(7, "test scenes --candidate-dir candidates --change 10%");
    let said = place.expect(2, &format!("{RENDER} --exr tiles -o a.exr"));
    assert!(said.contains("tiled") && said.contains("parts"), "{said}");
}
