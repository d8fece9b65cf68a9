//! Files of pixels that are not what was written: none goes into a picture, and none passes for one.

use exr::prelude::{FlatSamples, Levels, WritableImage};

use super::*;

/// The file with one bit of its pixels changed, at one of several places behind the header and the table of offsets.
fn flip(place: &Workplace, [from, to]: [&str; 2], share: f64) {
    let mut bytes = fs::read(place.path(from)).expect("the file");
    // Headers take less than half of these files.
    let start = bytes.len() / 2;
    let at = start + ((bytes.len() - start) as f64 * share) as usize;
    bytes[at] ^= 0x10;
    fs::write(place.path(to), bytes).expect("the file");
}

const SHARES: [f64; 9] = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9];

#[test]
fn a_damaged_part_is_not_joined() {
    let place = Workplace::new();
    for compression in ["none", "rle", "zips", "zip", "piz", "pxr24"] {
        let render = format!("render scene.toml -q --device cpu --size 64x48 --compression {compression}");
        place.expect(0, &format!("{render} --first-sample 0 --spp 4 -o a.exr"));
        place.expect(0, &format!("{render} --first-sample 4 --spp 4 -o b.exr"));
        for share in SHARES {
            flip(&place, ["b.exr", "bad.exr"], share);
            let said = place.expect(3, "merge a.exr bad.exr -o x.exr");
            assert!(said.contains("bad.exr"), "{compression}: {said}");
            assert!(!place.path("x.exr").exists());
        }
        // The control.
        place.expect(0, "merge a.exr b.exr -o x.exr");
        fs::remove_file(place.path("x.exr")).expect("it was written");
    }
}

#[test]
fn a_damaged_picture_is_not_a_finished_one() {
    let place = Workplace::new();
    let render = "render scene.toml --device cpu --size 64x48 --resume -o a.exr";
    place.expect(0, render);
    let whole = fs::read(place.path("a.exr")).expect("the picture");
    assert!(place.expect(0, render).contains("finished before"), "the control");
    for share in SHARES {
        flip(&place, ["a.exr", "a.exr"], share);
        assert!(!place.expect(0, render).contains("finished before"), "{share}");
        assert!(fs::read(place.path("a.exr")).expect("the picture") == whole);
    }
    let half = whole.len() / 2;
    fs::write(place.path("a.exr"), [&whole[..half], &vec![0; whole.len() - half]].concat()).expect("it is zeroed");
    assert!(!place.expect(0, render).contains("finished before"));
}

#[test]
fn a_damaged_golden_picture_and_a_damaged_candidate_are_refused() {
    let place = Workplace::new();
    fs::create_dir(place.path("scenes")).expect("a folder");
    fs::create_dir(place.path("theirs")).expect("a folder");
    fs::write(place.path("scenes/lit.toml"), scene()).expect("a scene");
    let test = "test scenes --device cpu --change 10%";
    let candidates = format!("{test} --candidate-dir theirs");
    place.expect(0, &format!("{test} --bless"));
    place.expect(0, "render scenes/lit.toml --device cpu -q --spp 256 --seed 5 -o good.exr");
    fs::copy(place.path("good.exr"), place.path("theirs/lit.exr")).expect("it is copied");
    place.expect(0, test);
    place.expect(0, &candidates);
    let refused = |arguments: &str| {
        let output = place.run(arguments);
        let said = text(&output.stdout) + &text(&output.stderr);
        assert!(output.status.code() == Some(3) && said.contains("lit.exr"), "{:?} {said}", output.status);
    };
    for share in [0.3, 0.6, 0.9] {
        flip(&place, ["good.exr", "theirs/lit.exr"], share);
        refused(&candidates);
    }
    // A number that is none, in a file of another program.
    let mut image = exr::prelude::read_all_data_from_file(place.path("scenes/golden/lit.exr")).expect("an EXR file");
    let layer = &mut image.layer_data[0];
    layer.attributes.other.retain(|key, _| !key.eq("gpt:digest"));
    for channel in &mut layer.channel_data.list {
        if let Levels::Singular(FlatSamples::F32(values)) = &mut channel.sample_data {
            values[7] = f32::NAN;
        }
    }
    fs::copy(place.path("scenes/golden/lit.exr"), place.path("golden.exr")).expect("it is copied");
    image.write().to_file(place.path("scenes/golden/lit.exr")).expect("it is written");
    refused(test);
    flip(&place, ["golden.exr", "scenes/golden/lit.exr"], 0.6);
    refused(test);
}
