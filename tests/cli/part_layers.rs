//! Layers of parts and of regions, and of the picture that they are joined to.

use gpt::output::Channels;

use super::checkpoints::devices;
#[cfg(unix)]
use super::checkpoints::goes_on;
use super::*;

const RENDER: &str = "render spheres -q --size 24x16 --max-depth 4";
/// All that samples make.
const SAMPLED: &str =
    "albedo,normal,position,uv,object_position,motion,depth,alpha,variance,samples,direct,indirect,emission,ids";

fn channels(place: &Workplace, name: &str) -> Channels {
    Channels::read(&place.path(name)).expect("an EXR file")
}

/// True if numbers are equal but for a unit in the last place; where terms cancel, but for their rounding.
fn agree(a: f32, b: f32) -> bool {
    a.to_bits().abs_diff(b.to_bits()) <= 1 || (a - b).abs() < 1e-9
}

/// The channels in which two files differ by more than rounding. A variance is the small difference of two larger numbers.
fn differences(a: &Channels, b: &Channels) -> Vec<String> {
    let differs = |name: &&str| {
        let (a, b) = (a.channel(name).expect("it has it"), b.channel(name).unwrap_or_default());
        let largest = a.iter().copied().fold(0.0, f32::max);
        let near = |a: f32, b: f32| match name.starts_with("Variance") {
            true => (a - b).abs() <= 1e-5 * largest,
            false => agree(a, b),
        };
        a.len() != b.len() || a.iter().zip(b).any(|(a, b)| !near(*a, *b))
    };
    a.names().filter(differs).map(str::to_owned).collect()
}

#[test]
#[ignore = "slow"]
fn layers_of_regions_are_those_of_the_whole_picture() {
    let place = Workplace::new();
    for device in devices() {
        let render = format!("{RENDER} --device {device} --spp 4 --aov {SAMPLED},cryptomatte");
        place.expect(0, &format!("{render} -o whole.exr"));
        let whole = channels(&place, "whole.exr");
        let regions = [("left", [0, 0, 10, 16]), ("top", [10, 0, 14, 9]), ("bottom", [10, 9, 14, 7])];
        for (name, region @ [x, y, columns, rows]) in regions {
            let crop = region.map(|side| side.to_string()).join(",");
            place.expect(0, &format!("{render} --crop {crop} -o {name}.exr"));
            let part = channels(&place, &format!("{name}.exr"));
            for layer in whole.names() {
                let (whole, part) = (whole.channel(layer).expect("it is there"), part.channel(layer).expect("the part has it"));
                for row in 0..rows {
                    let of = |values: &[f32], start: usize| -> Vec<u32> {
                        values[start..start + columns].iter().map(|value| value.to_bits()).collect()
                    };
                    let (ours, theirs) = (of(part, (y + row) * 24 + x), of(whole, (y + row) * 24 + x));
                    assert_eq!(ours, theirs, "{device}, {name}: {layer}, row {row}");
                }
            }
        }
        place.expect(0, "merge bottom.exr left.exr top.exr -o joined.exr");
        let joined = channels(&place, "joined.exr");
        assert!(joined.names().eq(whole.names()));
        assert_eq!(differences(&whole, &joined), Vec::<String>::new(), "{device}");
        let of_mattes = |file: &Channels| file.attribute("cryptomatte/3ae39a5/manifest").map(str::to_owned);
        assert!(of_mattes(&joined).is_some() && of_mattes(&joined) == of_mattes(&whole));
        // The control: other samples make other layers, where samples count.
        place.expect(0, &format!("{render} --seed 4 -o whole.exr"));
        let found = differences(&channels(&place, "whole.exr"), &joined);
        for layer in ["Albedo.R", "N.X", "P.Y", "Z", "A", "Direct.G", "Indirect.B", "Emission.R", "CryptoObject00.G"] {
            assert!(found.iter().any(|name| name == layer), "{device}: {layer} is none of {found:?}");
        }
    }
}

#[test]
#[ignore = "slow"]
fn layers_of_parts_are_joined_to_those_of_one_render() {
    let place = Workplace::new();
    for device in devices() {
        let render = format!("{RENDER} --device {device} --aov {SAMPLED}");
        place.expect(0, &format!("{render} --spp 13 -o whole.exr"));
        for (name, first, spp) in [("a", 0, 3), ("b", 3, 9), ("c", 12, 1)] {
            place.expect(0, &format!("{render} --first-sample {first} --spp {spp} -o {name}.exr"));
        }
        place.expect(0, "merge a.exr b.exr c.exr --spp 13 -o abc.exr");
        place.expect(0, "merge c.exr a.exr b.exr -o cab.exr -o cab.png");
        let [abc, cab] = ["abc.exr", "cab.exr"].map(|name| fs::read(place.path(name)).expect("the picture"));
        assert!(abc == cab, "{device}: the order of parts matters");
        let (whole, joined) = (channels(&place, "whole.exr"), channels(&place, "abc.exr"));
        assert!(joined.names().eq(whole.names()));
        assert_eq!(differences(&whole, &joined), Vec::<String>::new(), "{device}");
        // The control: a part is no whole picture, and its layers are not the whole picture's.
        place.expect(0, "merge a.exr b.exr --spp 12 -o ab.exr");
        let found = differences(&whole, &channels(&place, "ab.exr"));
        for layer in ["Albedo.R", "N.X", "P.Y", "Z", "A", "Variance.G", "SampleCount", "Direct.G", "Indirect.B", "Emission.R"] {
            assert!(found.iter().any(|name| name == layer), "{device}: {layer} is none of {found:?}");
        }
        assert!(!found.iter().any(|name| name == "ObjectId"));
    }
    // Missing samples are named with layers as without, and where they are allowed to be missing, means are
    // over the samples that are there.
    let said = place.expect(3, "merge a.exr c.exr --spp 13 -o x.exr");
    assert!(said.contains("samples 3 to 11 are missing"), "{said}");
    place.expect(0, "merge a.exr c.exr --spp 13 --partial -o x.exr");
    let (partial, whole) = (channels(&place, "x.exr"), channels(&place, "whole.exr"));
    let covered = |file: &Channels, pixel: usize| file.channel("A").expect("it is there")[pixel] == 1.0;
    let depth = |file: &Channels, pixel: usize| file.channel("Z").expect("it is there")[pixel];
    let near = |pixel: usize| (depth(&partial, pixel) / depth(&whole, pixel) - 1.0).abs() < 0.2;
    let pixels: Vec<usize> = (0..24 * 16).filter(|pixel| covered(&whole, *pixel)).collect();
    assert!(pixels.len() > 100 && pixels.iter().all(|pixel| covered(&partial, *pixel)));
    // At silhouettes, a few samples see now this and now that.
    assert!(pixels.iter().filter(|pixel| near(**pixel)).count() * 10 > pixels.len() * 9);
}

#[test]
fn what_layers_cannot_be_joined_is_said() {
    let place = Workplace::new();
    let render = format!("{RENDER} --device cpu");
    place.expect(0, &format!("{render} --first-sample 0 --spp 1 --aov albedo -o a.exr"));
    place.expect(0, &format!("{render} --first-sample 1 --spp 1 --aov depth -o depth.exr"));
    place.expect(0, &format!("{render} --first-sample 1 --spp 1 -o plain.exr"));
    for (part, words) in [("depth", "the layers of one are albedo, and of the other depth"), ("plain", "of the other nothing")] {
        let said = place.expect(3, &format!("merge a.exr {part}.exr -o x.exr"));
        let said = said.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(said.contains(words), "{said}");
    }
    let said = place.expect(2, &format!("{render} --first-sample 1 --spp 1 --aov cryptomatte -o x.exr"));
    assert!(said.contains("six largest shares"), "{said}");
    let said = place.expect(2, "plan spheres --chunks 4 --spp 8 --aov cryptomatte");
    assert!(said.contains("six largest shares"), "{said}");
    assert!(!place.path("x.exr").exists());
    let plan: Value =
        serde_json::from_slice(&place.run("plan spheres --chunks 2 --spp 2 --aov depth,albedo").stdout).expect("JSON");
    assert!(plan["chunks"][1]["shell"].as_str().is_some_and(|command| command.contains("--aov depth,albedo")), "{plan}");
    // The control: equal layers, in whatever order they were asked for.
    place.expect(0, &format!("{render} --first-sample 1 --spp 1 --aov albedo,albedo -o b.exr"));
    place.expect(0, "merge a.exr b.exr -o x.exr");
}

/// A finished part is skipped where it has the layers that are asked for, and only there.
#[test]
fn finished_layers_are_not_rendered_again() {
    let place = Workplace::new();
    let render = "render scene.toml --device cpu --resume -o a.exr";
    for part in ["", "--first-sample 8"] {
        place.expect(0, &format!("{render} {part} --aov albedo,depth"));
        let said = place.expect(0, &format!("{render} {part} --aov depth,albedo"));
        assert!(said.contains("a.exr: finished before"), "{said}");
        for other in ["--aov albedo", "", "--aov albedo,depth,normal"] {
            let said = place.expect(0, &format!("{render} {part} {other}"));
            assert!(!said.contains("finished before"), "{part} {other}: {said}");
        }
    }
}

/// An interrupt while a layer is rendered keeps its state, and the picture is the uninterrupted one.
#[cfg(unix)]
#[test]
#[ignore = "slow"]
fn a_layer_that_is_interrupted_goes_on() {
    let render = "render scene.toml --device cpu --size 64x48 --spp 800 --aov indirect -o a.exr";
    goes_on(&Workplace::new(), render, "a.exr.checkpoint-indirect", "a.exr.checkpoint-indirect");
}
