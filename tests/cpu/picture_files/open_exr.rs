//! OpenEXR: windows, layers, parts, luminance and chroma, primaries, and what else its attributes say.

use std::io::Cursor;

use exr::prelude::*;
use glam::DVec3;
use gpt::load;
use gpt::output::{Channels, read_picture};
use gpt::reference::intersect::World;
use gpt::reference::lights::Lights;
use gpt::scene::{MapRows, TextureKind, TextureWrap};

use super::exr_bytes::{Channel, ExrBytes};
use super::{AS_MAP, AS_TEXTURE, environment, expect, expect_named, read, refusal, scene, texel};

/// The number of a pixel by its column and row.
type Number = fn(usize, usize) -> f32;

/// A number that no other pixel has.
fn number(column: usize, row: usize) -> f32 {
    1.0 + column as f32 + 0.125 * row as f32
}

fn colour(column: usize, row: usize) -> [f32; 3] {
    [number(column, row), 0.5 * number(column, row), 0.25]
}

fn rgb() -> Vec<Channel> {
    let channel = |name, number| Channel { name, step: [1, 1], number };
    vec![channel("B", |_, _| 0.25), channel("G", |x, y| 0.5 * number(x, y)), channel("R", number)]
}

/// The picture of a data window in a display window, both as [first column, first row, width, height].
fn placed(data: [i32; 4], display: [i32; 4]) -> impl Fn(usize, usize) -> [f32; 3] {
    move |column, row| {
        let (x, y) = (column as i32 + display[0] - data[0], row as i32 + display[1] - data[1]);
        let is_there = (0..data[2]).contains(&x) && (0..data[3]).contains(&y);
        if is_there { colour(x as usize, y as usize) } else { [0.0; 3] }
    }
}

#[test]
fn pixels_lie_in_the_display_window() {
    let displays = [[0, 0, 8, 6], [-3, -2, 20, 12], [2, 1, 3, 2], [-40, -30, 9, 9], [5, 4, 30, 30]];
    let datas = [[0, 0, 8, 6], [2, 3, 5, 4], [-2, -1, 12, 9], [-38, -31, 4, 40]];
    for display in displays {
        for data in datas {
            for compression in [Compression::Uncompressed, Compression::ZIP16, Compression::PIZ] {
                let file = ExrBytes { data, display, compression, ..ExrBytes::new([1, 1], rgb()) };
                let picture = read("a.exr", &file.bytes());
                expect(&picture, [display[2] as u32, display[3] as u32], 0.0, placed(data, display));
                let shown = (0..2)
                    .all(|axis| data[axis] < display[axis] + display[axis + 2] && display[axis] < data[axis] + data[axis + 2]);
                // A picture without any pixel of its file is black, and says so.
                assert_eq!(picture.notes.is_empty(), shown, "{data:?} in {display:?}: {:?}", picture.notes);
                assert_eq!(!picture.covered[2..].contains(&0), shown);
            }
        }
    }
}

#[test]
fn tiles_levels_and_parts_are_placed_alike() {
    // Written by the library: tiles, or scan lines; a part before that has another window and no colours.
    let [width, height] = [11, 7];
    let plane = |channel: usize| {
        let numbers = (0..height * width).map(|place| colour(place % width, place / width)[channel]).collect();
        FlatSamples::F32(numbers)
    };
    for blocks in [Blocks::Tiles(Vec2(4, 3)), Blocks::ScanLines] {
        let channels = ["R", "G", "B"].iter().enumerate().map(|(place, name)| AnyChannel::new(*name, plane(place)));
        let channels = AnyChannels::sort(channels.collect());
        let encoding = Encoding { compression: Compression::RLE, blocks, line_order: LineOrder::Increasing };
        let attributes = LayerAttributes::named("rgba").with_position(Vec2(-2, 3));
        let picture = Layer::new((width, height), attributes, encoding, channels);
        let depth = AnyChannels::sort([AnyChannel::new("Z", FlatSamples::F32(vec![9.0; 4]))].into_iter().collect());
        let depth = Layer::new((2, 2), LayerAttributes::named("depth"), Encoding::UNCOMPRESSED, depth);
        let window = ImageAttributes::new(IntegerBounds::new((0, 0), (8, 9)));
        let mut bytes = Cursor::new(Vec::new());
        Image::from_layers(window, vec![depth, picture]).write().to_buffered(&mut bytes).expect("it is written");
        let picture = read("a.exr", bytes.get_ref());
        expect(&picture, [8, 9], 0.0, placed([-2, 3, 11, 7], [0, 0, 8, 9]));
        assert!(picture.notes.is_empty(), "{:?}", picture.notes);
    }
}

#[test]
fn alpha_is_0_where_there_is_no_pixel_and_1_without_a_channel() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("a.exr");
    let alpha = Channel { name: "A", step: [1, 1], number: |_, _| 0.5 };
    for (channels, found) in [(rgb(), [1.0, 1.0]), ([alpha].into_iter().chain(rgb()).collect(), [0.0, 0.5])] {
        let file = ExrBytes { data: [1, 0, 1, 1], display: [0, 0, 2, 1], ..ExrBytes::new([1, 1], channels) };
        std::fs::write(&path, file.bytes()).expect("the picture");
        let texels = load::read_image(&path, None).expect("a picture").texels;
        assert_eq!([0, 1].map(|place| texels.get(place)[3]), found);
    }
}

/// A smooth picture, so that chroma of half the resolution follows it.
fn smooth(column: usize, row: usize) -> [f32; 3] {
    let (x, y) = (column as f32, row as f32);
    [0.5 + 0.05 * (0.2 * x).sin(), 0.6 + 0.03 * (0.15 * y).cos(), 0.4 + 0.03 * (0.1 * (x + y)).sin()]
}

/// Rec. 709's red, green and blue in Y.
const WEIGHTS: [f32; 3] = [0.212_639, 0.715_169, 0.072_192];

fn luminance(column: usize, row: usize) -> f32 {
    smooth(column, row).iter().zip(WEIGHTS).map(|(value, weight)| value * weight).sum()
}

fn red_difference(column: usize, row: usize) -> f32 {
    (smooth(column, row)[0] - luminance(column, row)) / luminance(column, row)
}

fn blue_difference(column: usize, row: usize) -> f32 {
    (smooth(column, row)[2] - luminance(column, row)) / luminance(column, row)
}

fn luminance_chroma(step: [usize; 2]) -> Vec<Channel> {
    vec![
        Channel { name: "BY", step, number: blue_difference },
        Channel { name: "RY", step, number: red_difference },
        Channel { name: "Y", step: [1, 1], number: luminance },
    ]
}

#[test]
fn luminance_and_chroma_become_colours() {
    let methods = [Compression::Uncompressed, Compression::RLE, Compression::ZIP1, Compression::ZIP16, Compression::PIZ];
    for compression in methods {
        for (step, tolerance) in [([1, 1], 1e-4), ([2, 2], 8e-3)] {
            let file = ExrBytes { compression, ..ExrBytes::new([40, 36], luminance_chroma(step)) };
            let picture = read("a.exr", &file.bytes());
            expect(&picture, [40, 36], tolerance, smooth);
            // Pixels that have numbers of all three are not interpolated.
            let pixel = picture.image.pixels[20 * 40 + 20];
            assert!(pixel.iter().zip(smooth(20, 20)).all(|(a, b)| (a - b).abs() < 1e-4), "{compression}: {pixel:?}");
            assert!(picture.notes.is_empty());
        }
    }
    // In its display window too.
    let window = ExrBytes { data: [-4, 2, 40, 36], display: [0, 0, 30, 30], ..ExrBytes::new([1, 1], luminance_chroma([2, 2])) };
    expect(
        &read("a.exr", &window.bytes()),
        [30, 30],
        8e-3,
        |column, row| if row < 2 { [0.0; 3] } else { smooth(column + 4, row - 2) },
    );
    // Red and blue of other primaries have other weights; Rec. 2020's Y of green alone.
    let green = vec![
        Channel { name: "BY", step: [2, 2], number: |_, _| -1.0 },
        Channel { name: "RY", step: [2, 2], number: |_, _| -1.0 },
        Channel { name: "Y", step: [1, 1], number: |_, _| 0.677_998 },
    ];
    let wide = ExrBytes::new([4, 4], green).with_floats("chromaticities", "chromaticities", &REC_2020);
    expect(&read("a.exr", &wide.bytes()), [4, 4], 1e-3, |_, _| [-0.5876, 1.1329, -0.1006]);
}

#[test]
fn luminance_alone_is_grey_and_other_channels_of_reduced_resolution_are_filled() {
    let grey = ExrBytes::new([5, 3], vec![Channel { name: "Y", step: [1, 1], number }]);
    expect(&read("a.exr", &grey.bytes()), [5, 3], 0.0, |column, row| [number(column, row); 3]);
    let channels = vec![
        Channel { name: "B", step: [4, 1], number: |x, _| x as f32 },
        Channel { name: "G", step: [2, 2], number: |_, _| 0.5 },
        Channel { name: "R", step: [1, 1], number },
    ];
    // Between two numbers goes a straight line, and beyond the last one it stays.
    let file = ExrBytes::new([8, 4], channels);
    expect(&read("a.exr", &file.bytes()), [8, 4], 1e-4, |column, row| [number(column, row), 0.5, column.min(4) as f32]);
}

#[test]
fn one_layer_is_the_picture_and_of_several_one_is_named() {
    let layer = |prefix: &'static [&'static str; 3], scale: fn(usize, usize) -> f32| {
        prefix.iter().map(move |name| Channel { name, step: [1, 1], number: scale })
    };
    let one = ExrBytes::new([3, 2], layer(&["diffuse.B", "diffuse.G", "diffuse.R"], number).collect());
    let picture = read("a.exr", &one.bytes());
    expect(&picture, [3, 2], 0.0, |column, row| [number(column, row); 3]);
    assert!(picture.notes.is_empty(), "{:?}", picture.notes);
    let half: fn(usize, usize) -> f32 = |x, y| 0.5 * number(x, y);
    let several = layer(&["albedo.B", "albedo.G", "albedo.R"], half).chain(layer(&["beauty.B", "beauty.G", "beauty.R"], number));
    let several = ExrBytes::new([3, 2], several.collect()).bytes();
    expect(&read("a.exr", &several), [3, 2], 0.0, |column, row| [number(column, row); 3]);
    expect_named("a.exr", &several, "beauty");
    // Plain channels are the picture, whatever layers are beside them.
    let plain = layer(&["albedo.B", "albedo.G", "albedo.R"], half).chain(rgb());
    let mut plain: Vec<Channel> = plain.collect();
    plain.sort_by_key(|channel| channel.name);
    let picture = read("a.exr", &ExrBytes::new([3, 2], plain).bytes());
    expect(&picture, [3, 2], 0.0, colour);
    assert!(picture.notes.is_empty(), "{:?}", picture.notes);
    // A channel alone, and two of three.
    for (channels, word, truth) in [(vec!["depth"], "depth", [1.0, 1.0, 1.0]), (vec!["G", "R"], "no channel B", [1.0, 1.0, 0.0])]
    {
        let channels = channels.into_iter().map(|name| Channel { name, step: [1, 1], number: |_, _| 1.0 }).collect();
        let bytes = ExrBytes::new([3, 2], channels).bytes();
        expect(&read("a.exr", &bytes), [3, 2], 0.0, |_, _| truth);
        expect_named("a.exr", &bytes, word);
    }
    let none = ["U", "V"].map(|name| Channel { name, step: [1, 1], number });
    assert!(refusal("a.exr", &ExrBytes::new([3, 2], none.into()).bytes()).contains("U, V"));
}

const REC_2020: [f32; 8] = [0.708, 0.292, 0.17, 0.797, 0.131, 0.046, 0.3127, 0.329];
const ACES_CG: [f32; 8] = [0.713, 0.293, 0.165, 0.83, 0.128, 0.044, 0.32168, 0.33767];

fn ones() -> Vec<Channel> {
    ["B", "G", "R"].map(|name| Channel { name, step: [1, 1], number: |_, _| 1.0 }).into()
}

fn reds() -> Vec<Channel> {
    let zero: fn(usize, usize) -> f32 = |_, _| 0.0;
    let one: fn(usize, usize) -> f32 = |_, _| 1.0;
    [("B", zero), ("G", zero), ("R", one)].map(|(name, number)| Channel { name, step: [1, 1], number }).into()
}

#[test]
fn other_primaries_become_rec_709() {
    let of = |file: ExrBytes| read("a.exr", &file.bytes());
    let chromaticities =
        |points: &[f32; 8], channels| ExrBytes::new([2, 2], channels).with_floats("chromaticities", "chromaticities", points);
    // ITU-R BT.2087, and the ACES project's matrix from AP1, whose white is Rec. 709's white afterwards.
    expect(&of(chromaticities(&REC_2020, reds())), [2, 2], 1e-3, |_, _| [1.6605, -0.1246, -0.0182]);
    expect(&of(chromaticities(&ACES_CG, reds())), [2, 2], 1e-3, |_, _| [1.70505, -0.13026, -0.02400]);
    expect(&of(chromaticities(&ACES_CG, ones())), [2, 2], 1e-3, |_, _| [1.0; 3]);
    // X, Y and Z of D65.
    let xyz = [1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0 / 3.0, 1.0 / 3.0];
    let white: [(&'static str, Number); 3] = [("B", |_, _| 1.08906), ("G", |_, _| 1.0), ("R", |_, _| 0.95046)];
    let white = white.map(|(name, number)| Channel { name, step: [1, 1], number });
    expect(&of(chromaticities(&xyz, white.into())), [2, 2], 1e-3, |_, _| [1.0; 3]);
    // An ACES container without them is AP0, as an ID may say; IDs of sRGB have its curve.
    let aces = [2.52169, -0.27648, -0.01538];
    expect(
        &of(ExrBytes::new([2, 2], reds()).with("acesImageContainerFlag", "int", &1_i32.to_le_bytes())),
        [2, 2],
        2e-3,
        |_, _| aces,
    );
    expect(&of(ExrBytes::new([2, 2], reds()).with("colorInteropID", "string", b"lin_ap0_scene")), [2, 2], 2e-3, |_, _| aces);
    let half = ["B", "G", "R"].map(|name| Channel { name, step: [1, 1], number: |_, _| 0.5 });
    let srgb = ExrBytes::new([2, 2], half.into()).with("colorInteropID", "string", b"srgb_rec709_scene");
    expect(&of(srgb), [2, 2], 1e-5, |_, _| [0.214_041_1; 3]);
    // The neutral colour becomes white: D65 where the numbers say a warmer one is.
    let warm = chromaticities(&[0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.329], ones()).with_floats(
        "adoptedNeutral",
        "v2f",
        &[0.3457, 0.3585],
    );
    let found = of(warm).image.pixels[0];
    assert!(found[0] < 0.95 && found[2] > 1.05, "{found:?}");
    // Numbers that are no colours are left as they are, with a word.
    let folder = tempfile::tempdir().expect("a temporary folder");
    std::fs::write(folder.path().join("a.exr"), chromaticities(&REC_2020, reds()).bytes()).expect("the picture");
    let raw = scene(folder.path(), &AS_TEXTURE.replace("file =", "color_space = \"linear\"\nfile ="), false).expect("a scene");
    assert!(texel(&raw, 0, 0) == [1.0, 0.0, 0.0] && raw.warnings[0].contains("chromaticities"), "{:?}", raw.warnings);
}

#[test]
fn what_is_not_used_is_named_and_strict_refuses_it() {
    let plain = || ExrBytes::new([2, 2], ones());
    expect_named("a.exr", &plain().with_floats("pixelAspectRatio", "float", &[2.0]).bytes(), "pixelAspectRatio");
    expect_named("a.exr", &plain().with_floats("whiteLuminance", "float", &[100.0]).bytes(), "whiteLuminance");
    expect_named("a.exr", &plain().with("colorInteropID", "string", b"g22_ap1_scene").bytes(), "g22_ap1_scene");
    expect_named("a.exr", &plain().with("oiio:ColorSpace", "string", b"ACEScct").bytes(), "ACEScct");
    let views: Vec<u8> =
        ["left", "right"].iter().flat_map(|name| (name.len() as i32).to_le_bytes().into_iter().chain(name.bytes())).collect();
    expect_named("a.exr", &plain().with("multiView", "stringvector", &views).bytes(), "left");
    let apart = ExrBytes { data: [9, 9, 2, 2], display: [0, 0, 4, 4], ..plain() };
    expect_named("a.exr", &apart.bytes(), "displayWindow");
    // Attributes that say nothing of pixels are not named.
    let file = plain()
        .with_floats("whiteLuminanceOfTheRoom", "float", &[3.0])
        .with("owner", "string", b"me")
        .with("comments", "string", b"none");
    assert!(read("a.exr", &file.bytes()).notes.is_empty());
}

#[test]
fn what_is_not_read_is_refused_with_what_to_do() {
    // Deep data, and methods that the library does not know.
    let mut deep = ExrBytes { flags: 2 | 1 << 11, ..ExrBytes::new([2, 2], ones()) }.with("type", "string", b"deepscanline");
    deep = deep.with("version", "int", &1_i32.to_le_bytes()).with("maxSamplesPerPixel", "int", &1_i32.to_le_bytes());
    deep = deep.with("name", "string", b"deep").with("chunkCount", "int", &2_i32.to_le_bytes());
    assert!(refusal("a.exr", &deep.bytes()).contains("--flatten"));
    for method in [10_u8, 11] {
        let mut bytes = ExrBytes::new([2, 2], ones()).bytes();
        let name = b"compression\0compression\0";
        let place = bytes.windows(name.len()).position(|window| window == name).expect("the attribute") + name.len() + 4;
        bytes[place] = method;
        let error = refusal("a.exr", &bytes);
        assert!(error.contains("HTJ2K") && error.contains("oiiotool"), "{error}");
    }
    let crooked = ExrBytes { data: [1, 0, 4, 4], ..ExrBytes::new([4, 4], luminance_chroma([2, 2])) };
    assert!(refusal("a.exr", &crooked.bytes()).contains("xSampling"));
}

#[test]
fn textures_go_on_as_their_file_says_unless_the_scene_does() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let wrap = |modes: &[u8], key: &str| {
        std::fs::write(folder.path().join("a.exr"), ExrBytes::new([2, 2], ones()).with("wrapmodes", "string", modes).bytes())
            .expect("the picture");
        let scene = scene(folder.path(), &AS_TEXTURE.replace("file =", &format!("{key}\nfile =")), false).expect("a scene");
        match &scene.textures[0].kind {
            TextureKind::Image(image) => (image.wrap, scene.warnings.len()),
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(wrap(b"clamp", ""), ([TextureWrap::Clamp; 2], 0));
    assert_eq!(wrap(b"mirror,mirror", ""), ([TextureWrap::Mirror; 2], 0));
    assert_eq!(wrap(b"clamp,periodic", ""), ([TextureWrap::Clamp, TextureWrap::Repeat], 0));
    assert_eq!(wrap(b"periodic,periodic", ""), ([TextureWrap::Repeat; 2], 0));
    assert_eq!(wrap(b"clamp", "wrap = \"repeat\""), ([TextureWrap::Repeat; 2], 0));
    assert_eq!(wrap(b"black,black", ""), ([TextureWrap::Repeat; 2], 1));
}

/// The colour in a direction of the environments below, which changes linearly, so that interpolation keeps it.
fn sky([x, y, z]: [f64; 3]) -> [f32; 3] {
    [2.0 + x as f32, 2.0 + y as f32, 2.0 + z as f32]
}

fn of_lat_long(column: usize, row: usize, channel: usize) -> f32 {
    // ImfEnvmap: 17 columns and 9 rows, from longitude π to −π, and latitude π/2 to −π/2; longitude 0 is +Z, and π/2 is +X.
    let longitude = std::f64::consts::PI * (1.0 - column as f64 / 8.0);
    let latitude = std::f64::consts::PI * (0.5 - row as f64 / 8.0);
    sky([longitude.sin() * latitude.cos(), latitude.sin(), longitude.cos() * latitude.cos()])[channel]
}

fn of_cube(column: usize, row: usize, channel: usize) -> f32 {
    const LAST: f64 = 8.0;
    let (face, right, down) = (row / 9, 2.0 * column as f64 / LAST - 1.0, 2.0 * (row % 9) as f64 / LAST - 1.0);
    let [x, y, z] = match face {
        0 => [1.0, -down, right],
        1 => [-1.0, -down, -right],
        2 => [right, 1.0, -down],
        3 => [right, -1.0, down],
        4 => [-right, -down, 1.0],
        _ => [right, -down, -1.0],
    };
    let length = (x * x + y * y + z * z).sqrt();
    sky([x / length, y / length, z / length])[channel]
}

#[test]
fn environments_lie_as_envmap_says() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let lat_long: [(&'static str, Number); 3] =
        [("B", |x, y| of_lat_long(x, y, 2)), ("G", |x, y| of_lat_long(x, y, 1)), ("R", |x, y| of_lat_long(x, y, 0))];
    let cube: [(&'static str, Number); 3] =
        [("B", |x, y| of_cube(x, y, 2)), ("G", |x, y| of_cube(x, y, 1)), ("R", |x, y| of_cube(x, y, 0))];
    // Between directions 22.5° apart a straight line is off by 0.04; a cube's map has 18 rows, of which the first is half of one from the pole.
    let errors = [0.06, 0.02 + (std::f64::consts::PI / 36.0).sin()];
    for (size, kind, channels, error) in [([17, 9], 0_u8, lat_long, errors[0]), ([9, 54], 1, cube, errors[1])] {
        let channels = channels.map(|(name, number)| Channel { name, step: [1, 1], number }).into();
        std::fs::write(folder.path().join("a.exr"), ExrBytes::new(size, channels).with("envmap", "envmap", &[kind]).bytes())
            .expect("the picture");
        let scene = scene(folder.path(), AS_MAP, true).expect("a scene");
        let lights = Lights::new(&scene, &World::new(&scene).expect("a sound scene"));
        let light = environment(&scene);
        assert_eq!(light.rows == MapRows::ToPoles, kind == 0);
        for direction in [
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 1.0],
            [-1.0, 0.0, 0.0],
            [0.0, -1.0, 0.0],
            [0.0, 0.0, -1.0],
            [0.6, 0.64, -0.48],
        ] {
            let found = lights.outside().radiance(DVec3::from(direction)).to_rgb();
            let expected = sky(direction);
            let is_near = found.iter().zip(expected).all(|(a, b)| (a - f64::from(b)).abs() < error);
            assert!(is_near, "envmap {kind}, {direction:?}: {found:?} and not {expected:?}");
        }
    }
    // A map that is no cube is refused.
    std::fs::write(folder.path().join("a.exr"), ExrBytes::new([2, 2], ones()).with("envmap", "envmap", &[1]).bytes())
        .expect("the picture");
    assert!(scene(folder.path(), AS_MAP, false).expect_err("it is refused").contains("cube"));
}

#[test]
fn layers_of_a_file_lie_where_its_picture_does() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("a.exr");
    let mut channels = rgb();
    channels.push(Channel { name: "SampleCount", step: [1, 1], number: |_, _| 7.0 });
    let file = ExrBytes { data: [1, 1, 2, 1], display: [0, 0, 4, 3], ..ExrBytes::new([1, 1], channels) };
    std::fs::write(&path, file.bytes()).expect("the picture");
    let (layers, picture) = (Channels::read(&path).expect("layers"), read_picture(&path).expect("a picture"));
    let counts: Vec<f32> = (0..12).map(|place| if place == 5 || place == 6 { 7.0 } else { 0.0 }).collect();
    assert_eq!((layers.width, layers.height, layers.channel("SampleCount")), (4, 3, Some(&counts[..])));
    assert_eq!((layers.colours(["R", "G", "B"]), picture.covered), (Some(picture.image.pixels), [1, 1, 2, 1]));
}
