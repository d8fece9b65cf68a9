//! Light groups as layers of files, and `gpt regroup`.

use gpt::output::Channels;

use super::checkpoints::devices;
#[cfg(unix)]
use super::checkpoints::goes_on;
use super::*;

/// Two lamps in groups and one in none, of which one has this radiance. Paths do not depend on how bright lamps are.
fn lamps(radiance: &str) -> String {
    let lamp = |name: &str, radiance: &str, more: &str, center: &str| {
        format!(
            "[[material]]\nname = \"{name}\"\ntype = \"emissive\"\nradiance = {radiance}\n{more}\n\
             [[shape]]\ntype = \"sphere\"\ncenter = {center}\nradius = 0.8\nmaterial = \"{name}\"\n"
        )
    };
    let key = lamp("lamp", radiance, "light_group = \"key\"", "[-2, 3, 1]");
    let fill = lamp("strip", "[1, 3, 5]", "light_group = \"fill\"", "[2.5, 2, 1]");
    let none = lamp("candle", "[2, 1, 0.5]", "", "[0, 0.8, 2]");
    format!(
        "[film]\nsize = [24, 16]\n[render]\nspp = 8\nestimator = \"bsdf\"\n\
         [camera]\nposition = [0, 1.5, 7]\nlook_at = [0, 1, 0]\nvfov = 45\n\
         [[material]]\nname = \"white\"\ntype = \"diffuse\"\nreflectance = 0.7\n\
         [[shape]]\ntype = \"plane\"\npoint = [0, 0, 0]\nnormal = [0, 1, 0]\nmaterial = \"white\"\n{key}{fill}{none}"
    )
}

const NAMES: [&str; 3] = ["key", "fill", "rest"];

fn place() -> Workplace {
    let place = Workplace::new();
    fs::write(place.path("lamps.toml"), lamps("[9, 8, 7]")).expect("the scene");
    place
}

fn channels(place: &Workplace, name: &str) -> Channels {
    Channels::read(&place.path(name)).expect("an EXR file")
}

/// The largest difference of two files' pictures, in parts of the brighter number.
fn apart(place: &Workplace, a: &str, b: &str) -> f32 {
    let [a, b] = [a, b].map(|name| place.image(name).pixels);
    assert_eq!(a.len(), b.len());
    let pairs = a.iter().flatten().zip(b.iter().flatten());
    pairs.map(|(a, b)| (a - b).abs() / a.max(*b).max(1e-6)).fold(0.0, f32::max)
}

#[test]
fn regrouped_pictures_are_those_of_other_lamps() {
    let place = place();
    fs::write(place.path("bright.toml"), lamps("[18, 16, 14]")).expect("the scene");
    fs::write(place.path("blue.toml"), lamps("[9, 0, 14]")).expect("the scene");
    for device in devices() {
        place.expect(0, &format!("render lamps.toml -q --device {device} --aov groups -o lamps.exr"));
        let file = channels(&place, "lamps.exr");
        assert_eq!(file.attribute("gpt:lightGroups"), Some("key,fill,rest"));
        for name in NAMES {
            assert!(file.channel(&format!("{name}.G")).is_some_and(|values| values.iter().any(|value| *value > 0.1)), "{name}");
        }
        place.expect(0, "regroup lamps.exr --group key=1 -o same.exr");
        assert!(apart(&place, "lamps.exr", "same.exr") < 1e-6, "{device}");

        place.expect(0, &format!("render bright.toml -q --device {device} -o bright.exr"));
        place.expect(0, "regroup lamps.exr --group key=2 -o twice.exr -o twice.png --exposure auto");
        assert!(apart(&place, "bright.exr", "twice.exr") < 1e-6, "{device}");
        assert!(place.path("twice.png").exists());
        // Colours are linear: #ff00ff takes all green. The lamp's blue is doubled in a second step.
        place.expect(0, &format!("render blue.toml -q --device {device} -o blue.exr"));
        place.expect(0, "regroup lamps.exr --group key=#ff00ff -o magenta.exr");
        place.expect(0, "regroup magenta.exr --group key=2,#0000ff -o blue_only.exr");
        let [blue, only] = ["blue.exr", "blue_only.exr"].map(|name| place.image(name).pixels);
        let near = |a: f32, b: f32| (a - b).abs() <= 1e-6 * a.max(b);
        assert!(blue.iter().zip(&only).all(|(a, b)| near(a[1], b[1]) && near(a[2], b[2])), "{device}");
        // The controls: of another factor, another picture comes; and nothing is the same by chance.
        place.expect(0, "regroup lamps.exr --group key=1.99 -o nearly.exr");
        assert!(apart(&place, "bright.exr", "nearly.exr") > 1e-3, "{device}");
        assert!(apart(&place, "bright.exr", "lamps.exr") > 0.3, "{device}");
    }
}

#[test]
fn layers_that_hold_no_light_go_along() {
    let place = place();
    place.expect(0, "render lamps.toml -q --device cpu --aov groups,albedo,depth,variance,samples,ids,cryptomatte -o lamps.exr");
    let said = place.expect(0, "regroup lamps.exr --group fill=0 --group rest=0.5 -o other.exr");
    assert!(said.contains("left out: variance"), "{said}");
    let (before, after) = (channels(&place, "lamps.exr"), channels(&place, "other.exr"));
    let kept = ["Albedo.G", "Z", "SampleCount", "ObjectId", "CryptoObject00.R", "CryptoMaterial01.A", "key.B"];
    for name in kept {
        let [a, b] = [&before, &after].map(|file| file.channel(name).unwrap_or_else(|| panic!("{name}")).to_vec());
        assert!(a.iter().zip(&b).all(|(a, b)| a.to_bits() == b.to_bits()), "{name}");
    }
    assert!(after.channel("Variance.R").is_none());
    assert!(after.channel("fill.R").is_some_and(|values| values.iter().all(|value| *value == 0.0)));
    assert_eq!(after.attribute("gpt:layers"), Some("albedo,depth,samples,groups,ids,cryptomatte"));
    assert_eq!(after.attribute("gpt:regrouped"), Some("key=1 1 1; fill=0 0 0; rest=0.5 0.5 0.5"));
    let manifest = "cryptomatte/3ae39a5/manifest";
    assert!(after.attribute(manifest).is_some() && after.attribute(manifest) == before.attribute(manifest));
}

#[test]
fn mistakes_are_told() {
    let place = place();
    place.expect(0, "render lamps.toml -q --device cpu --aov groups -o lamps.exr");
    place.expect(0, "render lamps.toml -q --device cpu -o plain.exr");
    let said = place.expect(2, "regroup lamps.exr --group kay=2 -o x.exr");
    assert!(said.contains("no light group \"kay\"; its groups are key, fill, rest"), "{said}");
    let said = place.expect(2, "regroup lamps.exr --group key=2 --group key=3 -o x.exr");
    assert!(said.contains("two weights"), "{said}");
    for bad in ["key", "key=-1", "key=#fff", "key=1,2"] {
        place.expect(2, &format!("regroup lamps.exr --group {bad} -o x.exr"));
    }
    let said = place.expect(3, "regroup plain.exr --group key=2 -o x.exr");
    assert!(said.contains("`gpt render --aov groups`"), "{said}");
    place.expect(3, "regroup missing.exr --group key=2 -o x.exr");
    place.expect(3, "regroup lamps.toml --group key=2 -o x.exr");
    for (options, word) in [
        ("--clamp 2", "clamp"),
        ("--adaptive --target-error 0.1 --spp 64", "--adaptive"),
        ("--target-error 0.1 --spp 64", "--target-error"),
        ("--time-limit 5", "--time-limit"),
        ("--target-interval 0.5 --spp 64", "--target-interval"),
    ] {
        let said = place.expect(2, &format!("render lamps.toml -q --device cpu {options} --aov groups -o x.exr"));
        assert!(said.contains("light groups") && said.contains(word), "{options}: {said}");
    }
    let said = place.expect(2, "render scene.toml -q --device cpu --aov groups -o x.exr");
    assert!(said.contains("no emitter of the scene names a light group"), "{said}");
    let said = place.expect(2, "plan scene.toml --chunks 2 --aov groups");
    assert!(said.contains("no emitter of the scene names a light group"), "{said}");
    assert!(!place.path("x.exr").exists());
}

#[test]
fn groups_of_parts_are_joined_to_those_of_one_render() {
    let place = place();
    for device in devices() {
        let render = format!("render lamps.toml -q --device {device} --aov groups");
        place.expect(0, &format!("{render} --spp 8 -o whole.exr"));
        for (name, first, spp) in [("a", 0, 3), ("b", 3, 5)] {
            place.expect(0, &format!("{render} --first-sample {first} --spp {spp} -o {name}.exr"));
        }
        place.expect(0, "merge b.exr a.exr --spp 8 -o joined.exr");
        place.expect(0, &format!("{render} --crop 4,2,10,8 -o region.exr"));
        let (whole, joined) = (channels(&place, "whole.exr"), channels(&place, "joined.exr"));
        assert!(joined.names().eq(whole.names()), "{device}");
        let region = channels(&place, "region.exr");
        for name in NAMES.map(|name| format!("{name}.R")) {
            let [one, other, of_region] = [&whole, &joined, &region].map(|file| file.channel(&name).expect("it is there"));
            assert!(one.iter().zip(other).all(|(a, b)| a.to_bits().abs_diff(b.to_bits()) <= 1), "{device}: {name}");
            let inside = (2..10).flat_map(|row| (4..14).map(move |column| row * 24 + column));
            assert!(inside.clone().all(|pixel| one[pixel].to_bits() == of_region[pixel].to_bits()), "{device}: {name}");
            // The control: a part has other samples.
            let part = channels(&place, "a.exr");
            assert!(part.channel(&name).expect("it is there") != one, "{device}: {name}");
        }
        place.expect(0, "regroup joined.exr --group key=0.5 -o dim.exr");
        place.expect(0, "regroup region.exr --group key=0.5 -o dim_region.exr");
        let [whole, region] = ["dim.exr", "dim_region.exr"].map(|name| place.image(name).pixels);
        let near = |a: f32, b: f32| (a - b).abs() <= 1e-6 * a.max(b);
        let pixel = 5 * 24 + 6;
        assert!((0..3).all(|channel| near(whole[pixel][channel], region[pixel][channel])), "{device}");
    }
}

#[test]
fn a_scene_file_asks_for_groups_and_frames_have_them() {
    let place = place();
    let keyed = lamps("0\nkeyframes = [{ frame = 1, radiance = [9, 8, 7] }, { frame = 2, radiance = [18, 16, 14] }]");
    fs::write(place.path("keyed.toml"), format!("{keyed}[output]\naov = [\"groups\"]\n")).expect("the scene");
    place.expect(0, "render keyed.toml -q --device cpu --frames 1-2 -o frame.####.exr");
    let light = |name: &str, group: &str| {
        channels(&place, name)
            .channel(&format!("{group}.R"))
            .expect("it is there")
            .iter()
            .map(|value| f64::from(*value))
            .sum::<f64>()
    };
    let [first, second] = ["frame.0001.exr", "frame.0002.exr"].map(|name| light(name, "key"));
    assert!((second / first - 2.0).abs() < 1e-5 && first > 0.0, "{first} {second}");
    assert_eq!(light("frame.0001.exr", "fill"), light("frame.0002.exr", "fill"));
}

#[cfg(unix)]
#[test]
#[ignore = "slow"]
fn a_group_that_is_interrupted_goes_on() {
    let render = "render lamps.toml --device cpu --size 64x48 --spp 800 --aov groups -o a.exr";
    goes_on(&place(), render, "a.exr.checkpoint-groups-fill", "a.exr.checkpoint-groups-");
}
