use gpt::compare::flip::{FlipMap, PIXELS_PER_DEGREE, flip};
use gpt::compare::{ImageComparison, ImageView, Region, TileSettings, compare_paired};
use gpt::output::Image;

use super::*;

fn section<'a>(images: &'a [Image; 2], tiles: &'a ImageComparison, map: &'a FlipMap) -> Section<'a> {
    Section {
        title: "a </script> scene".to_owned(),
        verdict: "differs".to_owned(),
        tone: Tone::Red,
        facts: vec!["a fact".to_owned()],
        findings: vec![(Region { x: 1, y: 2, width: 3, height: 4 }, "a finding".to_owned())],
        commands: vec!["gpt test <here>".to_owned()],
        shown: Some(PicturePair { labels: ["golden", "now"], images: [&images[0], &images[1]], tiles, flip: map }),
    }
}

/// All that the page needs is in it, nothing else is asked for, and names cannot leave their places.
#[test]
fn a_page_stands_by_itself() {
    let images = [0.25, 0.5].map(|value| Image { width: 9, height: 8, pixels: vec![[value; 3]; 72] });
    let picture = |index: usize| ImageView { width: 9, pixels: &images[index].pixels };
    let tiles = compare_paired(picture(0), picture(1), &TileSettings { tile: 4, ..TileSettings::default() }).expect("one size");
    let map = flip(&images[1], &images[0], PIXELS_PER_DEGREE).expect("one size");
    let page = page("a test", "gpt test here", "a method", &[section(&images, &tiles, &map), section(&images, &tiles, &map)]);
    assert!(!page.contains("http") && !page.contains(" src=") && page.contains("a &lt;/script&gt; scene"), "{page}");
    for part in ["data-region=\"1,2,3,4\"", "gpt test &lt;here&gt;", "\"labels\":[\"golden\",\"now\"]", "href=\"#s1\""] {
        assert!(page.contains(part), "{part}");
    }
    // 0.5 is 0x3800 in half precision: 72 pixels of three.
    let halves: Vec<u8> = [0x00, 0x38].repeat(72 * 3);
    assert!(page.contains(&base64::Engine::encode(&base64::engine::general_purpose::STANDARD, halves)));
    let json = data::json(section(&images, &tiles, &map).shown.as_ref().expect("it has pictures"));
    let data: serde_json::Value = serde_json::from_str(&json).expect("it is JSON");
    assert_eq!(data["tiles"].as_array().map(Vec::len), Some(4));
    assert_eq!(data["tiles"][0][4], 99.0, "far more than the golden picture, with no noise");
}

#[test]
fn what_is_too_large_is_left_out() {
    let large = Image { width: 8192, height: 4096, pixels: vec![[0.0; 3]; 8192 * 4096] };
    let map = FlipMap { width: 1, height: 1, values: vec![0.0] };
    let one = [[0.0f32; 3]; 64];
    let tiles =
        compare_paired(ImageView { width: 8, pixels: &one }, ImageView { width: 8, pixels: &one }, &TileSettings::default());
    let images = [large.clone(), large];
    let page = page("a test", "gpt", "a method", &[section(&images, &tiles.expect("one size"), &map)]);
    assert!(page.contains("too large for this page") && page.len() < 100_000);
}
