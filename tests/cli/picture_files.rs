//! Headers of picture files that change what pixels mean or where they lie, in every command that reads one.

use exr::meta::attribute::Chromaticities;
use exr::prelude::{Vec2, WritableImage, read_all_data_from_file};

use super::*;

/// A render of the middle of `scene.toml`, and the whole of it.
const RENDER: &str = "render scene.toml --device cpu -q";
const REGION: [usize; 4] = [6, 4, 10, 8];

/// The file with other attributes of all its parts.
fn change(place: &Workplace, [from, to]: [&str; 2], change: impl FnOnce(&mut exr::meta::header::ImageAttributes)) {
    let mut image = read_all_data_from_file(place.path(from)).expect("an EXR file");
    change(&mut image.attributes);
    image.write().to_file(place.path(to)).expect("it is written");
}

#[test]
fn a_region_lies_where_it_belongs_in_the_whole_picture() {
    let place = Workplace::new();
    let crop = format!("{RENDER} --crop 6,4,10,8 -o part.exr");
    place.expect(0, &format!("{RENDER} -o whole.exr"));
    place.expect(0, &crop);
    let [whole, part] = ["whole.exr", "part.exr"].map(|name| place.image(name));
    assert_eq!([part.width, part.height], [whole.width, whole.height]);
    let [left, top, width, height] = REGION;
    for (pixel, (of_part, of_whole)) in part.pixels.iter().zip(&whole.pixels).enumerate() {
        let (column, row) = (pixel % 24, pixel / 24);
        let is_inside = (left..left + width).contains(&column) && (top..top + height).contains(&row);
        assert_eq!(*of_part, if is_inside { *of_whole } else { [0.0; 3] }, "column {column}, row {row}");
    }
    assert!(part.pixels.iter().any(|pixel| *pixel != [0.0; 3]));
    // `gpt compare` takes this picture, and a finished picture is not rendered again.
    place.expect(7, "compare part.exr whole.exr");
    place.expect(0, "compare part.exr part.exr");
    let before = fs::metadata(place.path("part.exr")).expect("the file").modified().expect("its time");
    place.expect(0, &format!("{crop} --resume"));
    assert_eq!(before, fs::metadata(place.path("part.exr")).expect("the file").modified().expect("its time"));
    // The control: elsewhere it is another picture.
    place.expect(0, &format!("{RENDER} --crop 7,4,10,8 -o part.exr --resume"));
    assert_ne!(place.image("part.exr"), part);
}

#[test]
fn a_region_is_a_texture_and_an_environment_in_its_place() {
    let place = Workplace::new();
    place.expect(0, &format!("{RENDER} --crop 6,4,10,8 -o part.exr"));
    let part = place.image("part.exr");
    // These pixels in a file without windows.
    let pixel = |at: Vec2<usize>| {
        let [red, green, blue] = part.pixels[at.y() * 24 + at.x()];
        (red, green, blue)
    };
    exr::prelude::write_rgb_file(place.path("plain.exr"), 24, 16, |x, y| pixel(Vec2(x, y))).expect("it is written");
    let scene = |file: &str| {
        // The middle of a map is +Z.
        let camera = "[camera]\nposition = [0, 0, -1]\nlook_at = [0, 0, 0]\nvfov = 70\n[film]\nsize = [32, 16]\n";
        fs::write(place.path("map.toml"), format!("{camera}[[light]]\ntype = \"environment\"\nfile = \"{file}\"\n"))
            .expect("the scene");
        place.expect(0, &format!("render map.toml --device cpu -q --spp 4 -o {file}.map.exr"));
    };
    ["part.exr", "plain.exr"].into_iter().for_each(scene);
    place.expect(0, "compare part.exr.map.exr plain.exr.map.exr");
    // The control: it is no constant.
    let map = place.image("part.exr.map.exr");
    assert!(map.pixels.iter().any(|pixel| *pixel != map.pixels[0]));
}

#[test]
fn what_a_header_says_that_is_not_used_is_a_warning_everywhere() {
    let place = Workplace::new();
    place.expect(0, &format!("{RENDER} -o a.exr"));
    change(&place, ["a.exr", "wide.exr"], |attributes| attributes.pixel_aspect = 2.0);
    let said = place.expect(0, "compare wide.exr a.exr");
    assert!(said.contains("wide.exr") && said.contains("pixelAspectRatio") && !said.contains("a.exr:"), "{said}");
    let json: Value = serde_json::from_slice(&place.run("compare wide.exr a.exr --json").stdout).expect("JSON");
    assert!(json["warnings"][0].as_str().is_some_and(|warning| warning.contains("pixelAspectRatio")), "{json}");
    let camera = "[camera]\nposition = [0, 0, 1]\nlook_at = [0, 0, 0]\nvfov = 70\n";
    fs::write(place.path("map.toml"), format!("{camera}[[light]]\ntype = \"environment\"\nfile = \"wide.exr\"\n"))
        .expect("the scene");
    for command in ["check map.toml", "render map.toml --device cpu --spp 1 --size 4x4 -o b.exr"] {
        assert!(place.expect(0, command).contains("pixelAspectRatio"), "{command}");
        assert!(place.expect(3, &format!("{command} --strict")).contains("pixelAspectRatio"), "{command}");
    }
}

#[test]
fn parts_that_another_program_changed_are_not_joined() {
    let place = Workplace::new();
    for (first, name) in [(0, "a"), (4, "b")] {
        place.expect(0, &format!("{RENDER} --first-sample {first} --spp 4 -o {name}.exr"));
    }
    place.expect(0, "merge a.exr b.exr -o whole.exr");
    let corner = |x: f32, y: f32| Vec2(x, y);
    let wide = Chromaticities {
        red: corner(0.708, 0.292),
        green: corner(0.17, 0.797),
        blue: corner(0.131, 0.046),
        white: corner(0.3127, 0.329),
    };
    change(&place, ["b.exr", "c.exr"], |attributes| attributes.chromaticities = Some(wide));
    let said = place.expect(3, "merge a.exr c.exr -o other.exr");
    assert!(said.contains("c.exr") && said.contains("chromaticities"), "{said}");
    // Windows that were moved together are the same picture.
    let mut image = read_all_data_from_file(place.path("b.exr")).expect("an EXR file");
    image.attributes.display_window.position = Vec2(-7, 5);
    image.layer_data[0].attributes.layer_position = Vec2(-7, 5);
    image.write().to_file(place.path("d.exr")).expect("it is written");
    place.expect(0, "merge a.exr d.exr -o moved.exr");
    assert_eq!(place.image("moved.exr"), place.image("whole.exr"));
}
