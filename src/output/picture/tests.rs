//! Pictures of all formats, finished, broken off, and beside others.

use exr::io::PeekRead;
use exr::meta::MetaData;
use exr::meta::attribute::AttributeValue;
use exr::prelude::{Text, Vec2};

use super::*;
use crate::output::{Display, Exposure, ExrCompression, ExrOptions, Provenance, ToneCurve, read_image, srgb_byte};
use crate::scene::settings::SETTINGS;
use crate::scene::{Filter, RenderSettings};

fn spec(width: u32, height: u32, spp: u32) -> PictureSpec {
    let settings = RenderSettings { spp, seed: u32::MAX, ..RenderSettings::default() };
    let provenance = Provenance {
        scene: "küche 厨房".to_owned(),
        scene_hash: "0123abcd".to_owned(),
        settings,
        filter: Filter::default(),
        first_sample: 128,
        target_error: None,
        adaptive: false,
        interval: None,
        device: "a device".to_owned(),
    };
    PictureSpec { width, height, display: Display::CLIP, provenance: Some(provenance), ..PictureSpec::default() }
}

fn value(x: u32, y: u32) -> [f32; 3] {
    [x as f32 * 0.1 - 1.0, 1e6 / (y + 1) as f32, (x * y) as f32 * 1e-6]
}

fn band(first_row: u32, rows: u32, width: u32, samples: u32) -> Arc<Band> {
    let mean = (first_row..first_row + rows).flat_map(|y| (0..width).map(move |x| value(x, y))).collect();
    Arc::new(Band { first_row, width, rows, samples, mean, ..Band::default() })
}

#[test]
fn an_exr_comes_back_bit_by_bit_with_its_attributes() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.exr");
    let mut file = PictureFile::create(&path, PictureFormat::Exr, &spec(37, 41, 64)).unwrap();
    for (first_row, rows) in [(0, 5), (5, 30), (35, 6)] {
        file.write_band(&band(first_row, rows, 37, 64)).unwrap();
    }
    file.finish().unwrap();

    let image = read_image(&path).unwrap();
    assert_eq!((image.width, image.height), (37, 41));
    for (index, pixel) in image.pixels.iter().enumerate() {
        assert_eq!(*pixel, value(index as u32 % 37, index as u32 / 37), "pixel {index}");
    }
    let meta = MetaData::read_from_file(&path, true).unwrap();
    let header = &meta.headers[0];
    assert_eq!(header.shared_attributes.chromaticities.unwrap().red, Vec2(0.64, 0.33));
    let attribute = |name: &str| header.own_attributes.other[&Text::from(name)].clone();
    assert_eq!(attribute("gpt:scene"), AttributeValue::Text(Text::from("küche ??")));
    assert_eq!(attribute("gpt:seed"), AttributeValue::Text(Text::from("4294967295")));
    assert_eq!(attribute("gpt:sampler"), AttributeValue::Text(Text::from("sobol")));
    for setting in SETTINGS {
        assert!(header.own_attributes.other.contains_key(&Text::from(setting.header)), "{}", setting.header);
    }
    assert_eq!(attribute("gpt:lightSampling"), AttributeValue::Text(Text::from("auto")));
    assert_eq!(attribute("gpt:maxDepth"), AttributeValue::I32(16));
    assert_eq!(attribute("gpt:device"), AttributeValue::Text(Text::from("a device")));
    assert_eq!(attribute("gpt:firstSample"), AttributeValue::I32(128));
    assert_eq!(attribute("gpt:samples"), AttributeValue::I32(64));
    assert_eq!(attribute("gpt:complete"), AttributeValue::I32(1));
}

/// Whatever the compression and the channels; and where a bit is another, it is not.
#[test]
fn the_digest_of_a_file_is_that_of_what_it_holds() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.exr");
    let check = || crate::picture_file::open_exr::check_digest(crate::input::open_to_decode(&path).unwrap());
    let counts: Vec<u32> = (0..37 * 20).map(|pixel| if pixel < 100 { 7 } else { 3 }).collect();
    for compression in ExrCompression::ALL {
        for (half, is_part, tiled, parts) in [
            (false, false, false, false),
            (true, false, false, false),
            (false, true, false, false),
            (false, false, true, false),
            (false, true, true, true),
        ] {
            let part = is_part.then_some(crate::output::PartSpec { film: [100, 50], origin: [11, 7] });
            let spec = PictureSpec { exr: ExrOptions { half, compression, tiled, parts }, part, ..spec(37, 20, 1) };
            let mut file = PictureFile::create(&path, PictureFormat::Exr, &spec).unwrap();
            let band = Band { counts: Some(counts.clone()), ..Band::clone(&band(0, 20, 37, 3)) };
            file.write_band(&Arc::new(band)).unwrap();
            file.finish().unwrap();
            assert_eq!(check(), Ok(true), "{compression:?} {half} {is_part}");
            let (bytes, whole) = (std::fs::read(&path).unwrap(), read_image(&path).unwrap());
            // Blocks begin where the table of offsets says.
            let mut reader = std::io::Cursor::new(&bytes);
            let meta = MetaData::read_from_buffered(&mut reader, true).unwrap();
            let tables = MetaData::read_offset_tables(&mut PeekRead::new(&mut reader), &meta.headers).unwrap();
            let start = tables[0].iter().copied().min().unwrap() as usize;
            for index in (start..bytes.len()).step_by(((bytes.len() - start) / 60).max(1)) {
                let mut bad = bytes.clone();
                bad[index] ^= 1 << (index % 8);
                std::fs::write(&path, bad).unwrap();
                // A bit that no decoder looks at does no harm.
                let is_harmless = || read_image(&path).is_ok_and(|image| image == whole);
                assert!(check() != Ok(true) || is_harmless(), "{compression:?} {half} {is_part}: byte {index}");
            }
        }
    }
}

#[test]
fn an_unfinished_render_says_so_and_is_black_where_nothing_came() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.exr");
    for (rows_rendered, samples_expected) in [(20, 0), (40, 7)] {
        let mut file = PictureFile::create(&path, PictureFormat::Exr, &spec(8, 40, 64)).unwrap();
        file.write_band(&band(0, 10, 8, 64)).unwrap();
        file.write_band(&band(10, rows_rendered - 10, 8, 7)).unwrap();
        file.finish().unwrap();
        let image = read_image(&path).unwrap();
        let black = image.pixels.iter().filter(|pixel| **pixel == [0.0; 3]).count();
        assert_eq!(black, (40 - rows_rendered as usize) * 8);
        let meta = MetaData::read_from_file(&path, true).unwrap();
        let attribute = |name: &str| meta.headers[0].own_attributes.other[&Text::from(name)].clone();
        assert_eq!(attribute("gpt:samples"), AttributeValue::I32(samples_expected));
        assert_eq!(attribute("gpt:samplesWanted"), AttributeValue::I32(64));
        assert_eq!(attribute("gpt:complete"), AttributeValue::I32(0));
    }
}

#[test]
fn equal_pictures_are_equal_files() {
    let folder = tempfile::tempdir().unwrap();
    // Ten attributes in the order of a hash map agree by chance once in millions.
    for format in ["exr", "png", "jpg", "hdr"] {
        let [a, b] = ["a", "b"].map(|name| {
            let path = folder.path().join(name).with_extension(format);
            let mut file = PictureFile::create(&path, PictureFormat::from_path(&path).unwrap(), &spec(64, 40, 8)).unwrap();
            file.write_band(&band(0, 40, 64, 8)).unwrap();
            file.finish().unwrap();
            std::fs::read(&path).unwrap()
        });
        assert!(a == b, "{format}");
    }
}

#[test]
fn pixels_that_differ_in_their_samples_carry_them() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.exr");
    let counts: Vec<u32> = (0..8 * 40).map(|pixel| if pixel < 100 { 7 } else { 3 }).collect();
    let mut file = PictureFile::create(&path, PictureFormat::Exr, &spec(8, 40, 64)).unwrap();
    for (first_row, pixels) in [(0, 0..160), (20, 160..320)] {
        let band = Band::clone(&band(first_row, 20, 8, 3));
        file.write_band(&Arc::new(Band { counts: Some(counts[pixels].to_vec()), ..band })).unwrap();
    }
    file.finish().unwrap();
    let image = exr::prelude::read_first_flat_layer_from_file(&path).unwrap();
    let channels = &image.layer_data.channel_data.list;
    assert_eq!(channels.iter().map(|channel| channel.name.to_string()).collect::<Vec<_>>(), ["B", "G", "R", "SampleCount"]);
    let found: Vec<u32> = channels[3].sample_data.values_as_f32().map(|count| count as u32).collect();
    assert_eq!(found, counts);
    assert_eq!(read_image(&path).unwrap().pixels[5], value(5, 0));
}

/// In its own place only where no finished picture is.
#[test]
fn a_picture_that_broke_off_replaces_no_finished_one() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, samples: u32, is_finished: bool| {
        let path = folder.path().join(name);
        let mut file = PictureFile::create(&path, PictureFormat::from_path(&path).unwrap(), &spec(8, 40, 64)).unwrap();
        file.write_band(&band(0, 40, 8, samples)).unwrap();
        let place = if is_finished { file.finish().map(|()| path) } else { file.finish_broken_off() };
        place.unwrap().file_name().unwrap().to_str().unwrap().to_owned()
    };
    for ending in ["exr", "png", "jpg", "hdr"] {
        let [a, beside] = [format!("a.{ending}"), format!("a.incomplete.{ending}")];
        // Fewer samples than wanted, as a time limit leaves them, are no break.
        for (samples, is_finished, place) in
            [(3, false, &a), (4, false, &a), (5, true, &a), (6, false, &beside), (7, false, &beside), (8, true, &a)]
        {
            assert_eq!(write(&a, samples, is_finished), *place, "{samples} samples");
        }
        assert_eq!(write(&beside, 9, true), beside);
        assert_eq!(write(&a, 10, false), format!("a.incomplete-2.{ending}"));
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 4 * 3);
}

#[test]
fn a_png_holds_the_exposed_picture_in_srgb() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    let display = Display { exposure: Exposure::Stops(-2.0), ..Display::CLIP };
    let spec = PictureSpec { display, ..spec(30, 20, 1) };
    let mut file = PictureFile::create(&path, PictureFormat::Png, &spec).unwrap();
    file.write_band(&band(0, 20, 30, 1)).unwrap();
    file.finish().unwrap();
    let decoded = image::open(&path).unwrap().into_rgb8();
    for (x, y, pixel) in decoded.enumerate_pixels() {
        assert_eq!(pixel.0, value(x, y).map(|radiance| srgb_byte(radiance / 4.0)));
    }
    let bytes = std::fs::read(&path).unwrap();
    assert!(bytes.windows(4).any(|window| window == b"sRGB"));
}

/// The last rows of the picture are brighter by far. JPEG is tried as well, with its losses.
#[test]
fn automatic_exposure_sees_the_whole_picture() {
    let folder = tempfile::tempdir().unwrap();
    let grey = |rows: u32, first_row, value: f32| {
        let mean = vec![[value; 3]; rows as usize * 16];
        Arc::new(Band { first_row, width: 16, rows, samples: 1, mean, ..Band::default() })
    };
    for (name, tolerance) in [("a.png", 0), ("a.jpg", 3)] {
        let path = folder.path().join(name);
        let display = Display { exposure: Exposure::Auto, ..Display::CLIP };
        let spec = PictureSpec { display, ..spec(16, 32, 1) };
        let mut file = PictureFile::create(&path, PictureFormat::from_path(&path).unwrap(), &spec).unwrap();
        file.write_band(&grey(16, 0, 0.01)).unwrap();
        file.write_band(&grey(16, 16, 1.0)).unwrap();
        file.finish().unwrap();
        // The geometric mean, 0.1, becomes 0.18.
        let decoded = image::open(&path).unwrap().into_rgb8();
        for (row, value) in [(0, 0.018), (31, 1.8)] {
            let found = decoded.get_pixel(3, row).0[1];
            assert!(found.abs_diff(srgb_byte(value)) <= tolerance, "{name}, row {row}: {found}");
        }
    }
}

#[test]
fn tone_curves_show_in_the_picture() {
    let folder = tempfile::tempdir().unwrap();
    let mut bytes = Vec::new();
    for tone_curve in ToneCurve::ALL {
        let path = folder.path().join("a.png");
        let spec = PictureSpec { display: Display { tone_curve, ..Display::CLIP }, ..spec(30, 20, 1) };
        let mut file = PictureFile::create(&path, PictureFormat::Png, &spec).unwrap();
        file.write_band(&band(0, 20, 30, 1)).unwrap();
        file.finish().unwrap();
        bytes.push(image::open(&path).unwrap().into_rgb8().into_raw());
    }
    assert!(bytes[0] != bytes[1] && bytes[1] != bytes[2] && bytes[0] != bytes[2]);
}

/// Without loss, but for pxr24 and for halves, which keep 16 and 11 bits.
#[test]
fn exr_files_keep_what_their_options_promise() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.exr");
    for compression in ExrCompression::ALL {
        // A picture of several tiles; its rows come in bands that do not end where tiles do.
        for (half, tiled) in [(false, false), (true, false), (false, true), (true, true)] {
            let [width, height] = if tiled { [150, 131] } else { [37, 20] };
            let exr = ExrOptions { half, compression, tiled, parts: false };
            let mut file =
                PictureFile::create(&path, PictureFormat::Exr, &PictureSpec { exr, ..spec(width, height, 1) }).unwrap();
            for first in (0..height).step_by(20) {
                file.write_band(&band(first, (height - first).min(20), width, 1)).unwrap();
            }
            file.finish().unwrap();
            let tolerance = match (half, compression) {
                (true, _) => 2.0_f32.powi(-11),
                (false, ExrCompression::Pxr24) => 2.0_f32.powi(-16),
                (false, _) => 0.0,
            };
            for (index, found) in read_image(&path).unwrap().pixels.iter().enumerate() {
                let wanted = value(index as u32 % width, index as u32 / width);
                for (found, wanted) in found.iter().zip(wanted) {
                    let wanted = if half { wanted.min(65_504.0) } else { wanted };
                    let error = (found - wanted).abs();
                    // Below 2^-14, halves have steps of 2^-24.
                    assert!(
                        error <= tolerance * wanted.abs() + if half { 3e-8 } else { 0.0 },
                        "{compression:?} {half}: {found} {wanted}"
                    );
                }
            }
        }
    }
}

#[test]
fn a_radiance_file_is_read_back_within_its_eight_bits() {
    let folder = tempfile::tempdir().unwrap();
    // Rows of fewer than 8 pixels are written another way.
    for width in [5, 300] {
        let path = folder.path().join("a.hdr");
        let mut file = PictureFile::create(&path, PictureFormat::Hdr, &spec(width, 20, 1)).unwrap();
        file.write_band(&band(0, 20, width, 1)).unwrap();
        file.finish().unwrap();
        for (index, found) in read_image(&path).unwrap().pixels.iter().enumerate() {
            let wanted = value(index as u32 % width, index as u32 / width).map(|channel| channel.max(0.0));
            let largest = wanted.into_iter().fold(0.0, f32::max);
            for (found, wanted) in found.iter().zip(wanted) {
                assert!((found - wanted).abs() <= largest / 128.0, "{index}: {found} {wanted}");
            }
        }
    }
}

#[test]
fn a_broken_off_render_leaves_no_file_and_bad_bands_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    for (name, format) in [("a.exr", PictureFormat::Exr), ("a.png", PictureFormat::Png), ("a.jpg", PictureFormat::Jpeg)] {
        let mut file = PictureFile::create(&folder.path().join(name), format, &spec(8, 40, 64)).unwrap();
        file.write_band(&band(0, 10, 8, 64)).unwrap();
        assert!(file.write_band(&band(5, 10, 8, 64)).is_err(), "an overlap");
        assert!(file.write_band(&band(10, 10, 7, 64)).is_err(), "another width");
        assert!(file.write_band(&band(30, 11, 8, 64)).is_err(), "past the end");
        drop(file);
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}
