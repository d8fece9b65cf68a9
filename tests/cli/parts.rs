//! Parts of a picture, and the picture that they are joined to.

use super::checkpoints::devices;
use super::*;

/// Units in the last place between two numbers that are not negative.
fn units(a: f32, b: f32) -> u32 {
    a.to_bits().abs_diff(b.to_bits())
}

pub fn most_units(a: &Image, b: &Image) -> u32 {
    let pairs = a.pixels.iter().flatten().zip(b.pixels.iter().flatten());
    pairs.map(|(a, b)| units(*a, *b)).max().expect("pixels")
}

/// Whatever the order of the parts: the same file, and but for a last place the picture of one render.
#[test]
#[ignore = "slow"]
fn parts_are_joined_to_the_picture_of_one_render() {
    let place = Workplace::new();
    for device in devices() {
        let render = format!("render scene.toml -q --device {device}");
        place.expect(0, &format!("{render} --spp 61 -o whole.exr"));
        for (name, samples) in
            [("a", "--first-sample 0 --spp 16"), ("b", "--first-sample 16 --spp 23"), ("c", "--first-sample 39 --spp 22")]
        {
            place.expect(0, &format!("{render} {samples} -o {name}.exr"));
        }
        let said = place.expect(0, "merge a.exr b.exr c.exr --spp 61 -o abc.exr");
        assert!(said.contains("abc.exr: 24x16, 61 spp of 3 parts") && said.contains("relative mean squared error"), "{said}");
        place.expect(0, "merge c.exr a.exr b.exr -o cab.exr -o cab.png");
        let [abc, cab] = ["abc.exr", "cab.exr"].map(|name| fs::read(place.path(name)).expect("the picture"));
        assert!(abc == cab);
        let (whole, merged) = (place.image("whole.exr"), place.image("abc.exr"));
        assert!(most_units(&whole, &merged) <= 1, "{device}: {}", most_units(&whole, &merged));
        assert_eq!(header_number(&place.path("abc.exr"), "gpt:samples"), 61);
        assert_eq!(header_number(&place.path("abc.exr"), "gpt:complete"), 1);
        // The control: without one part it is another picture.
        place.expect(0, "merge a.exr b.exr -o ab.exr");
        assert!(most_units(&whole, &place.image("ab.exr")) > 1000);
    }
}

/// The channel of an EXR file by this name.
fn channel(place: &Workplace, name: &str, wanted: &str) -> Vec<f32> {
    use exr::prelude::*;
    let image = read_first_flat_layer_from_file(place.path(name)).expect("an EXR file");
    let channel = image.layer_data.channel_data.list.iter().find(|channel| channel.name.eq(wanted)).expect("it is there");
    channel.sample_data.values_as_f32().collect()
}

/// Variances mean the same in a part and in a layer: of samples, not of their mean. Of grey radiance they are equal.
#[test]
fn the_variances_of_parts_are_those_of_layers() {
    let place = Workplace::new();
    let grey = super::scene().replace("intensity = [40, 30, 20]", "intensity = 30");
    fs::write(place.path("scene.toml"), grey).expect("the scene file");
    for device in devices() {
        let render = format!("render scene.toml -q --spp 40 --device {device}");
        place.expect(0, &format!("{render} --aov variance -o layer.exr"));
        place.expect(0, &format!("{render} --first-sample 0 -o part.exr"));
        let [layer, part] = ["layer.exr", "part.exr"].map(|name| channel(&place, name, "Variance.G"));
        let (mut differ_from_means, largest) = (0, layer.iter().copied().fold(0.0, f32::max));
        for (layer, part) in layer.iter().zip(&part) {
            assert!((layer - part).abs() <= 1e-3 * layer + 1e-5 * largest, "{device}: {layer} {part}");
            // The control: those of the means are forty times less.
            differ_from_means += u32::from((layer / 40.0 - part).abs() > 1e-3 * layer + 1e-5 * largest);
        }
        assert!(differ_from_means > 20, "{device}");
    }
}

/// A region has the random numbers of the whole picture.
#[test]
#[ignore = "slow"]
fn a_region_is_the_same_pixels_of_the_whole_picture() {
    let place = Workplace::new();
    for device in devices() {
        let render = format!("render scene.toml -q --spp 13 --device {device}");
        place.expect(0, &format!("{render} -o whole.exr"));
        let whole = place.image("whole.exr");
        let regions = [("left", [0, 0, 10, 16]), ("top", [10, 0, 14, 9]), ("bottom", [10, 9, 14, 7])];
        for (name, region @ [x, y, columns, rows]) in regions {
            let crop = region.map(|side| side.to_string()).join(",");
            place.expect(0, &format!("{render} --crop {crop} -o {name}.exr"));
            let part = place.image(&format!("{name}.exr"));
            // The part lies where it belongs in the whole picture.
            assert_eq!((part.width, part.height), (whole.width, whole.height));
            for row in 0..rows {
                let start = ((y + row) * 24 + x) as usize;
                let [ours, theirs] = [&part, &whole].map(|image| &image.pixels[start..start + columns as usize]);
                assert_eq!(ours, theirs, "{device}, {name}, row {row}");
            }
        }
        place.expect(0, "merge bottom.exr left.exr top.exr -o joined.exr");
        assert!(most_units(&whole, &place.image("joined.exr")) <= 1);
        let said = place.expect(3, "merge left.exr top.exr -o x.exr");
        assert!(said.contains("samples 0 to 12 are missing of 98 of its 384 pixels"), "{said}");
        place.expect(0, &format!("{render} --crop 5,5,10,2 -o other.exr"));
        let said = place.expect(3, "merge left.exr top.exr bottom.exr other.exr -o x.exr");
        assert!(said.contains("overlap"), "{said}");
        // The control: other samples are another picture.
        place.expect(0, &format!("{render} --seed 4 --crop 0,0,10,16 -o left.exr"));
        let other = place.image("left.exr");
        assert!((0..16).any(|row| other.pixels[row * 10..row * 10 + 10] != whole.pixels[row * 24..row * 24 + 10]));
    }
    place.expect(2, "render scene.toml --crop 20,0,5,5 -o x.exr");
    place.expect(2, "render scene.toml --crop 0,0,5,5 --adaptive -o x.exr");
    assert!(!place.path("x.exr").exists());
}

#[test]
fn what_does_not_belong_together_is_refused_in_a_sentence() {
    let place = Workplace::new();
    let part = |name: &str, flags: &str| {
        place.expect(0, &format!("render scene.toml -q --device cpu {flags} -o {name}.exr"));
    };
    part("a", "--first-sample 0 --spp 4");
    part("b", "--first-sample 4 --spp 4");
    part("seed", "--first-sample 4 --spp 4 --seed 3");
    part("size", "--first-sample 4 --spp 4 --size 24x15");
    part("far", "--first-sample 12 --spp 4");
    part("twice", "--first-sample 3 --spp 4");
    part("plain", "--spp 4");
    fs::write(place.path("scene.toml"), scene().replace("intensity = [40", "intensity = [41")).expect("the scene");
    part("scene", "--first-sample 4 --spp 4");
    fs::write(place.path("text.exr"), "this is no picture").expect("a file");
    for (parts, words) in [
        ("a.exr seed.exr", "are parts of different pictures: --seed is 0 and 3"),
        ("a.exr size.exr", "the pictures have 24x16 and 24x15 pixels"),
        ("a.exr scene.exr", "their scenes differ"),
        ("a.exr twice.exr", "a.exr and twice.exr overlap: both have samples 3 to 3"),
        ("a.exr a.exr", "overlap"),
        ("a.exr far.exr", "samples 4 to 11 are missing"),
        ("b.exr", "samples 0 to 3 are missing"),
        ("a.exr b.exr --spp 9", "samples 8 are missing"),
        ("a.exr b.exr --spp 7", "beyond the 7 that are wanted"),
        ("a.exr plain.exr", "plain.exr: it is no part of a picture"),
        ("a.exr text.exr", "text.exr"),
        ("a.exr none.exr", "none.exr"),
    ] {
        let said = place.expect(3, &format!("merge {parts} -o x.exr"));
        let said = said.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(said.contains(words), "{parts}: {said}");
        assert!(!place.path("x.exr").exists());
    }
    place.expect(2, "merge a.exr b.exr -o a.exr");
    // Controls: what belongs together, and holes that are allowed.
    place.expect(0, "merge a.exr b.exr --spp 8 -o x.exr");
    let said = place.expect(0, "merge a.exr far.exr --partial -o y.exr");
    assert!(said.contains("samples 4 to 11 are missing"), "{said}");
    let output = place.run("merge a.exr b.exr --target-error 1e-9 --json -o x.exr");
    let report: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!((&report["parts"], &report["first_sample"], &report["end_sample"]), (&2.into(), &0.into(), &8.into()));
    assert!(report["parts_to_target"].as_u64() > Some(10) && report["error_bound"].as_f64() > Some(0.0), "{report}");
}
