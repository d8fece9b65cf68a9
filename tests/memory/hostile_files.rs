//! Files that are not what they should be: random damage to scenes, models, materials and pictures ends in an answer or one clear error, soon,
//! and within a bound of memory. `GPT_FUZZ_CASES` says how many cases of each kind, 15 when left out.

use std::collections::BTreeMap;
use std::io::Cursor;
use std::path::Path;
use std::time::{Duration, Instant};

use crate::counting::{Peak, take_turn};
use crate::random::SplitMix64;
use gpt::load;
use image::ImageFormat;

/// A file of a few thousand bytes is answered within this time, on a busy machine and with 16,384² texels to fill.
const LONGEST: Duration = Duration::from_secs(60);
/// Most memory for reading one picture: as stated in docs/stress.md, 16 bytes for each texel of the largest image, twice while its colours are
/// made linear.
const MOST_FOR_PICTURES: usize = 2 * 16 * 16_384 * 16_384;
/// Most memory for a text of a few thousand bytes.
const MOST_FOR_TEXTS: usize = 64 << 20;

#[test]
fn damaged_files_end_in_an_answer_or_an_error() {
    let _turn = take_turn();
    let cases = std::env::var("GPT_FUZZ_CASES").ok().and_then(|count| count.parse().ok()).unwrap_or(15);
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut random = SplitMix64::new(3);
    let mut extremes = Extremes::default();
    assert!(notices_memory());
    let scenes: Vec<&str> = ["cornell", "spheres", "motion-blur"].into_iter().filter_map(load::builtin_text).collect();
    for text in scenes {
        for _ in 0..cases {
            let bytes = damaged(text.as_bytes(), &mut random, true);
            let text = String::from_utf8_lossy(&bytes).into_owned();
            extremes.bounded("scene", &bytes, MOST_FOR_TEXTS, || drop(load::load_toml_str(&text, "damaged.toml", Path::new(""))));
        }
    }
    let [obj, mtl] = ["model.obj", "model.mtl"].map(|name| folder.path().join(name));
    for damage_materials in [false, true] {
        for _ in 0..2 * cases {
            let (model, materials) = if damage_materials {
                (MODEL.as_bytes().to_vec(), damaged(MATERIALS.as_bytes(), &mut random, true))
            } else {
                (damaged(MODEL.as_bytes(), &mut random, true), MATERIALS.as_bytes().to_vec())
            };
            std::fs::write(&obj, &model).expect("the folder can be written to");
            std::fs::write(&mtl, &materials).expect("the folder can be written to");
            let written = if damage_materials { materials } else { model };
            extremes.bounded("model", &written, MOST_FOR_TEXTS, || drop(load::load(obj.to_str())));
        }
    }
    for (ending, whole) in pictures(folder.path()) {
        let path = folder.path().join(format!("damaged.{ending}"));
        for _ in 0..cases {
            let bytes = damaged(&whole, &mut random, false);
            std::fs::write(&path, &bytes).expect("the folder can be written to");
            extremes.bounded(ending, &bytes, MOST_FOR_PICTURES, || drop(load::read_image(&path, None)));
        }
    }
    for (kind, (longest, most)) in extremes.by_kind {
        println!("{kind}: at most {longest:.1?} and {:.1} MiB", most as f64 / f64::from(1 << 20));
    }
}

/// The longest time and the most memory that a file of each kind took.
#[derive(Default)]
struct Extremes {
    by_kind: BTreeMap<String, (Duration, usize)>,
}

/// The negative control: what allocates more than its bound is noticed.
fn notices_memory() -> bool {
    let peak = Peak::from_now();
    drop(std::hint::black_box(vec![1_u8; MOST_FOR_TEXTS + 1]));
    peak.bytes() > MOST_FOR_TEXTS
}

impl Extremes {
    /// Runs `read` and fails where it panics or takes too long or too much memory. Leaves the file that did it.
    fn bounded(&mut self, kind: &str, bytes: &[u8], most: usize, read: impl FnOnce() + std::panic::UnwindSafe) {
        let peak = Peak::from_now();
        let start = Instant::now();
        let ended = std::panic::catch_unwind(read);
        let (took, used) = (start.elapsed(), peak.bytes());
        let extreme = self.by_kind.entry(kind.to_owned()).or_default();
        *extreme = (extreme.0.max(took), extreme.1.max(used));
        if ended.is_err() || took > LONGEST || used > most {
            let evidence = std::env::temp_dir().join(format!("gpt-hostile-{kind}"));
            let kept = std::fs::write(&evidence, bytes).is_ok();
            let panicked = ended.is_err();
            panic!("{kind}: panicked {panicked}, {took:?}, {used} bytes; the file is kept ({kept}): {}", evidence.display());
        }
    }
}

/// Some bytes or words replaced, cut out, or doubled.
fn damaged(whole: &[u8], random: &mut SplitMix64, text: bool) -> Vec<u8> {
    const WORDS: [&str; 14] =
        ["-1", "nan", "inf", "1e308", "0", "[", "]]", "\"", "=", "99999999999", "-9223372036854775809", "\n", "\u{0}", "/"];
    let mut bytes = whole.to_vec();
    let below = |count: usize, random: &mut SplitMix64| (random.uniform() * count as f64) as usize;
    for _ in 0..1 + below(6, random) {
        if bytes.is_empty() {
            break;
        }
        // Headers say how large a picture is: half of the damage goes there.
        let reach = if !text && random.uniform() < 0.5 { bytes.len().min(64) } else { bytes.len() };
        let start = below(reach, random);
        let end = (start + below(12, random)).min(bytes.len());
        let piece: Vec<u8> = match below(5, random) {
            0 if text => WORDS[below(WORDS.len(), random)].bytes().collect(),
            0 | 1 => vec![[0, 1, 0x7f, 0x80, 0xff][below(5, random)]; end - start],
            2 => bytes[start..end].repeat(2),
            3 => Vec::new(),
            _ => (start..end).map(|_| random.next_u64() as u8).collect(),
        };
        bytes.splice(start..end, piece);
    }
    if random.uniform() < 0.1 {
        bytes.truncate(below(bytes.len() + 1, random));
    }
    bytes
}

/// The same small picture in every format that can be written here.
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

const MODEL: &str = "mtllib model.mtl\no quad\nv -1 0 0\nv 1 0 0 0.5 0.5 0.5\nv 1 2.5e-1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n\
    vn 0 0 1\nvn 0 1 0\ng front\nusemtl red\ns 1\nf 1/1/1 2/2/1 3/3/1 4/4/1\nusemtl glass\nf -4 -3 -2\nf 1//2 2//2 4//2\n\
    f 1/1 2/2 \\\n 3/3\nl 1 2 3\np 1\n# a comment\nv 0 0 1\nf 1 2 5\n";

const MATERIALS: &str = "newmtl red\nKd 0.8 0.1 0.1\nKs 0.2 0.2 0.2\nNs 50\nKe 0 0 0\nillum 2\nd 1\n\
    newmtl glass\nNi 1.5\nTr 0.9\nillum 7\nKd 0 0 0\nTf 1 1 1\nmap_Kd -s 2 2 1 missing.png\nmap_Bump -bm 0.5 missing.png\n";
