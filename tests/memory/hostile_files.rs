//! Files that are not what they should be: random damage to scenes, models, materials and pictures ends in an answer or one clear error, soon,
//! and within a bound of memory. `GPT_FUZZ_CASES` says how many cases of each kind.

use std::io::Cursor;
use std::path::Path;

use crate::counting::take_turn;
use crate::hostile::{MOST_FOR_TEXTS, Tally, answer_of, cases, damaged};
use crate::random::SplitMix64;
use gpt::load;
use image::ImageFormat;

/// Most memory for reading one picture: as stated in docs/stress.md, 16 bytes for each texel of the largest image, twice while its colours are
/// made linear.
const MOST_FOR_PICTURES: usize = 2 * 16 * 16_384 * 16_384;

/// How many of each kind in the short form and in the long one.
fn how_many() -> usize {
    cases(15, 25_000)
}

#[test]
fn damaged_scene_files() {
    let (_turn, cases) = (take_turn(), how_many());
    let random = &mut SplitMix64::new(3);
    let mut tally = Tally::new("scene", MOST_FOR_TEXTS);
    for name in ["cornell", "spheres", "motion-blur"] {
        let whole = load::builtin_text(name).expect("it is built in").as_bytes();
        let read = |bytes: &[u8]| {
            let text = String::from_utf8_lossy(bytes);
            answer_of(load::load_toml_str(&text, "damaged.toml", Path::new("")))
        };
        tally.undamaged(whole, read);
        tally.hunt(whole, cases, random, |bytes, _, random| damaged(bytes, random, true), read);
    }
    tally.judge();
}

#[test]
fn damaged_models_and_libraries() {
    let (_turn, cases) = (take_turn(), how_many());
    let (folder, random) = (tempfile::tempdir().expect("a temporary folder"), &mut SplitMix64::new(4));
    let folder = folder.path();
    let [obj, mtl, png] = ["model.obj", "model.mtl", "picture.png"].map(|name| folder.join(name));
    let write = |path: &Path, bytes: &[u8]| std::fs::write(path, bytes).expect("the folder can be written to");
    image::RgbImage::new(2, 2).save(&png).expect("the folder can be written to");
    for (kind, whole, target) in [("model", MODEL, &obj), ("material library", MATERIALS, &mtl)] {
        write(&obj, MODEL.as_bytes());
        write(&mtl, MATERIALS.as_bytes());
        let read = |bytes: &[u8]| {
            write(target, bytes);
            answer_of(load::load(obj.to_str()))
        };
        let mut tally = Tally::new(kind, MOST_FOR_TEXTS);
        tally.undamaged(whole.as_bytes(), read);
        tally.hunt(whole.as_bytes(), 2 * cases, random, |bytes, _, random| damaged(bytes, random, true), read);
        tally.judge();
    }
}

#[test]
fn damaged_ply_models() {
    let (_turn, cases) = (take_turn(), how_many());
    let (folder, random) = (tempfile::tempdir().expect("a temporary folder"), &mut SplitMix64::new(5));
    let path = folder.path().join("model.ply");
    let read = |bytes: &[u8]| {
        std::fs::write(&path, bytes).expect("the folder can be written to");
        answer_of(load::load(path.to_str()))
    };
    for (kind, whole, is_text) in [("PLY model", PLY.as_bytes().to_vec(), true), ("binary PLY model", binary_ply(), false)] {
        let mut tally = Tally::new(kind, MOST_FOR_TEXTS);
        tally.undamaged(&whole, read);
        tally.hunt(&whole, 2 * cases, random, |bytes, _, random| damaged(bytes, random, is_text), read);
        tally.judge();
    }
}

#[test]
fn damaged_pictures() {
    let (_turn, cases) = (take_turn(), how_many());
    let (folder, random) = (tempfile::tempdir().expect("a temporary folder"), &mut SplitMix64::new(6));
    let folder = folder.path();
    for (ending, whole) in pictures(folder) {
        let mut tally = Tally::new(ending, MOST_FOR_PICTURES);
        let path = folder.join(format!("damaged.{ending}"));
        let read = |bytes: &[u8]| {
            std::fs::write(&path, bytes).expect("the folder can be written to");
            load::read_image(&path, None).map(|_| String::new()).map_err(|error| error.to_string())
        };
        tally.undamaged(&whole, read);
        tally.hunt(&whole, cases, random, |bytes, _, random| damaged(bytes, random, false), read);
        tally.judge();
    }
}

/// One small picture in every format that can be written here.
fn pictures(folder: &Path) -> Vec<(&'static str, Vec<u8>)> {
    let bytes = image::RgbImage::from_fn(7, 5, |x, y| image::Rgb([30 * x as u8, 50 * y as u8, 200]));
    let floats = image::Rgb32FImage::from_fn(7, 5, |x, y| image::Rgb([x as f32, y as f32 * 0.5, 3.0]));
    let formats = [
        ("png", ImageFormat::Png),
        ("jpg", ImageFormat::Jpeg),
        ("bmp", ImageFormat::Bmp),
        ("tga", ImageFormat::Tga),
        ("tiff", ImageFormat::Tiff),
        ("gif", ImageFormat::Gif),
        ("webp", ImageFormat::WebP),
        ("ppm", ImageFormat::Pnm),
    ];
    let mut pictures: Vec<(&'static str, Vec<u8>)> = formats
        .into_iter()
        .map(|(ending, format)| {
            let mut file = Cursor::new(Vec::new());
            bytes.write_to(&mut file, format).expect("memory can be written to");
            (ending, file.into_inner())
        })
        .collect();
    let mut hdr = Cursor::new(Vec::new());
    floats.write_to(&mut hdr, ImageFormat::Hdr).expect("memory can be written to");
    pictures.push(("hdr", hdr.into_inner()));
    let path = folder.join("whole.exr");
    exr::prelude::write_rgb_file(&path, 7, 5, |x, y| (x as f32, y as f32 * 0.5, 3.0_f32)).expect("the folder can be written to");
    pictures.push(("exr", std::fs::read(path).expect("it was just written")));
    pictures
}

const MODEL: &str = "mtllib model.mtl\no quad\nv -1 0 0 1 0 0\nv 1 0 0 0.5 0.5 0.5\nv 1 2.5e-1 0\nv -1 1 0 0 0 1\n\
    vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\nvn 0 1 0\ng front\nusemtl red\ns 1\nf 1/1/1 2/2/1 3/3/1 4/4/1\nf 1/1 2/2 \\\n 3/3\n\
    usemtl glass\nf -4 -3 -2\nf 1//2 2//2 4//2\nl 1 2 3\np 1\n# a comment\nv 0 0 1 1 1 1\nf 1 2 5\n";

const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty double z\nproperty float nx\n\
    property float ny\nproperty float nz\nproperty float s\nproperty float t\nelement face 2\nproperty list uchar int vertex_indices\n\
    element tristrips 1\nproperty list uint int vertex_indices\nend_header\n0 0 0 0 0 1 0 0\n1 0 0 0 0 1 1 0\n1 1 0 0 0 1 1 1\n\
    0.5 0.2 0 0 0 1 0.5 0.5\n0 1 -1e-1 0 0 1 0 1\n5 0 1 2 3 4\n3 0 1 2\n6 0 1 2 -1 3 4\n";

/// The file [`PLY`] in binary form.
fn binary_ply() -> Vec<u8> {
    let (header, data) = PLY.split_once("end_header\n").expect("a header has an end");
    let mut bytes = format!("{}end_header\n", header.replace("ascii", "binary_little_endian")).into_bytes();
    let rows: Vec<Vec<&str>> = data.lines().map(|line| line.split(' ').collect()).collect();
    let number = |word: &str| -> f32 { word.parse().expect("a number") };
    let index = |word: &&str| -> i32 { word.parse().expect("an index") };
    for row in &rows[..5] {
        for (column, word) in row.iter().enumerate() {
            match column {
                2 => bytes.extend(f64::from(number(word)).to_le_bytes()),
                _ => bytes.extend(number(word).to_le_bytes()),
            }
        }
    }
    for (row, length_bytes) in rows[5..].iter().zip([1, 1, 4]) {
        bytes.extend(&index(&row[0]).to_le_bytes()[..length_bytes]);
        row[1..].iter().for_each(|word| bytes.extend(index(word).to_le_bytes()));
    }
    bytes
}

const MATERIALS: &str = "newmtl red\nKd 0.8 0.1 0.1\nKs 0.2 0.2 0.2\nNs 50\nKe 0 0 0\nillum 2\nd 1\nmap_Kd -s 2 2 1 picture.png\n\
    newmtl glass\nNi 1.5\nTr 0.9\nillum 7\nKd 0 0 0\nTf 1 1 1\nmap_Bump -bm 0.5 picture.png\n";
