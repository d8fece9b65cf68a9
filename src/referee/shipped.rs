//! Truths that were found by long renders, embedded in the program.

use super::picture::TruthPicture;

/// A test's name for files, and its truth.
macro_rules! shipped {
    ($($name:literal),* $(,)?) => {
        [$(($name, include_bytes!(concat!("../../scenes/referee/", $name, ".truth")).as_slice())),*]
    };
}

/// Means and standard errors of tests that no formula tells, made by `GPT_BLESS=1 cargo test --release --test cpu shipped_truths`.
const PICTURES: [(&str, &[u8]); 14] = shipped![
    "extensions-anisotropy",
    "extensions-clearcoat",
    "extensions-diffuse-transmission",
    "extensions-dispersion",
    "extensions-emissive-strength",
    "extensions-ior",
    "extensions-iridescence",
    "extensions-sheen",
    "extensions-specular",
    "extensions-transmission",
    "extensions-volume",
    "media-milk",
    "transport-glossy-plates",
    "transport-room",
];

/// Every test's truth lies in one file of this many numbers of 32 bits for each pixel, little-endian: mean and standard error of red, green and blue.
const NUMBERS: usize = 6;

/// The truth of the test with this name and size.
///
/// # Errors
/// A sentence: there is none, or it is of another size.
pub fn picture(name: &str, size: [u32; 2]) -> Result<TruthPicture, String> {
    let Some((_, bytes)) = PICTURES.iter().find(|(own, _)| *own == name) else {
        return Err(format!("the truth of {name} is not shipped"));
    };
    parse(bytes, size).ok_or_else(|| format!("the truth of {name} is of another size"))
}

/// A truth from its bytes.
pub fn parse(bytes: &[u8], [width, height]: [u32; 2]) -> Option<TruthPicture> {
    let pixels = width as usize * height as usize;
    if bytes.len() != pixels * NUMBERS * 4 {
        return None;
    }
    let numbers: Vec<f32> = bytes.as_chunks::<4>().0.iter().map(|&word| f32::from_le_bytes(word)).collect();
    let (pixels, _) = numbers.as_chunks::<NUMBERS>();
    Some(TruthPicture {
        width,
        height,
        mean: pixels.iter().map(|&[r, g, b, ..]| [r, g, b]).collect(),
        standard_errors: pixels.iter().map(|&[.., r, g, b]| [r, g, b]).collect(),
    })
}

/// The bytes of a truth.
pub fn bytes(truth: &TruthPicture) -> Vec<u8> {
    let pixels = truth.mean.iter().zip(&truth.standard_errors);
    pixels
        .flat_map(|(mean, error)| mean.iter().chain(error).flat_map(|number| number.to_le_bytes()).collect::<Vec<_>>())
        .collect()
}
