//! Memory while pictures are written does not grow with their size.

use std::sync::Arc;

use crate::counting::{Peak, take_turn};
use gpt::film::Band;
use gpt::output::{Display, PictureFile, PictureFormat, PictureSpec, Provenance};
use gpt::scene::{Filter, RenderSettings};

/// 8K: 133 MB of 8-bit pixels at three bytes, 398 MB of floats.
const SIZE: [u32; 2] = [7680, 4320];
const BAND_ROWS: u32 = 32;

fn band(first_row: u32) -> Arc<Band> {
    let pixels = SIZE[0] * BAND_ROWS;
    let mean = (0..pixels).map(|pixel| [(first_row + pixel / SIZE[0]) as f32 / SIZE[1] as f32, 0.5, 0.25]).collect();
    Arc::new(Band {
        first_row,
        width: SIZE[0],
        rows: BAND_ROWS,
        samples: 1,
        counts: None,
        mean,
        second_moment: vec![0.0; pixels as usize],
        ..Band::default()
    })
}

#[test]
fn an_8k_picture_takes_a_fraction_of_its_size_in_memory() {
    let _turn = take_turn();
    let folder = tempfile::tempdir().expect("a temporary folder");
    let provenance = Provenance {
        scene: "gradient".to_owned(),
        scene_hash: String::new(),
        settings: RenderSettings { spp: 1, ..RenderSettings::default() },
        filter: Filter::default(),
        first_sample: 0,
        target_error: None,
        adaptive: false,
        interval: None,
        device: "none".to_owned(),
    };
    let (provenance, display) = (Some(provenance), Display::CLIP);
    let spec = PictureSpec { width: SIZE[0], height: SIZE[1], provenance, display, ..PictureSpec::default() };
    let peak = Peak::from_now();
    let mut files = [("a.exr", PictureFormat::Exr), ("a.png", PictureFormat::Png)].map(|(name, format)| {
        PictureFile::create(&folder.path().join(name), format, &spec).expect("a file in a folder that exists")
    });
    for first_row in (0..SIZE[1]).step_by(BAND_ROWS as usize) {
        let band = band(first_row);
        for file in &mut files {
            file.write_band(&band).expect("bands in order");
        }
    }
    for file in files {
        file.finish().expect("a whole picture");
    }
    let grown = peak.bytes() >> 20;
    assert!(grown < 96, "writing took {grown} MiB");

    // The whole picture does not fit into that, so a writer that kept it would have been caught.
    let image = gpt::output::read_image(&folder.path().join("a.exr")).expect("a readable picture");
    assert_eq!(image.pixels.len(), SIZE[0] as usize * SIZE[1] as usize);
    assert!(peak.bytes() >> 20 > 300);
    assert_eq!(image.pixels[SIZE[0] as usize * 2160 + 7], [0.5, 0.5, 0.25]);
}
