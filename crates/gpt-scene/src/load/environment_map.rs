//! Pictures as maps of the light from all directions: lat-long as scenes have it.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use crate::picture_file::{Envelope, Hints};
use crate::scene::{ImageData, MapRows, Texels};
use crate::spectrum::Spectrum;

/// A lat-long map, and how it lies.
pub struct EnvironmentMap {
    pub image: ImageData,
    pub rows: MapRows,
    /// How far it is turned, degrees, beside what the scene says.
    pub rotation_degrees: f64,
}

/// Warnings about a picture that is taken for a map, in sentences without the file's name.
pub fn notes(integer_bits: Option<u16>, hints: &Hints) -> Vec<String> {
    let of_bits = integer_bits.map(|bits| {
        format!(
            "the map has colours of {bits} bits, which are taken for sRGB and made linear: none is brighter than 1, and the sun is no brighter \
             than a cloud; maps for lighting are EXR or HDR"
        )
    });
    let of_view = hints.has_view.then(|| {
        "its header's VIEW says from where it was seen, which is not used: it is taken for a lat-long map, whatever projection it has".to_owned()
    });
    of_bits.into_iter().chain(of_view).collect()
}

/// The map of a picture whose header says how light lies in it; None of one that says nothing, which is a lat-long map as it is.
///
/// OpenEXR (ImfEnvmap) puts the first and the last pixel on the very edges: of a lat-long map, the first and the last row lie on the poles, and the
/// first and the last column are one direction; of a cube, faces share their edges.
///
/// # Errors
/// A cube that is none.
pub fn converted(image: &ImageData, hints: &Hints) -> Result<Option<EnvironmentMap>, String> {
    let [width, height] = [image.width, image.height];
    match hints.envelope {
        None => Ok(None),
        Some(Envelope::LatLong) if width < 2 => Ok(None),
        Some(Envelope::LatLong) => {
            // Without the column that comes twice, columns lie half of one farther than where scenes have them.
            let columns = width as usize - 1;
            let rows = 0..height as usize;
            let colour = |place: usize| image.texels.color(place);
            let texels: Vec<_> =
                rows.flat_map(|row| (0..columns).map(move |column| row * (columns + 1) + column)).map(colour).collect();
            let image = ImageData { width: width - 1, height, texels: texels.into(), has_alpha: false };
            let rotation_degrees = 0.5 / columns as f64 * 360.0;
            Ok(Some(EnvironmentMap { image, rows: MapRows::ToPoles, rotation_degrees }))
        }
        Some(Envelope::Cube) => {
            let side = width;
            if side < 2 || height != 6 * side {
                return Err(format!(
                    "its envmap is a cube, which has six square faces one below the other: {width} x {height} pixels are none"
                ));
            }
            let image = lat_long(image, side as usize);
            Ok(Some(EnvironmentMap { image, rows: MapRows::Inside, rotation_degrees: 0.0 }))
        }
    }
}

/// Samples along each side of a texel.
const SAMPLES: usize = 3;

/// The lat-long map of a cube whose faces have so many pixels a side, with as many rows as a quarter of a turn has on the cube, twice.
fn lat_long(cube: &ImageData, side: usize) -> ImageData {
    let (width, height) = (4 * side, 2 * side);
    let texel = |row: usize, column: usize| {
        let mut sum = Spectrum::BLACK;
        for sample in 0..SAMPLES * SAMPLES {
            let within = |place: usize| (place as f64 + 0.5) / SAMPLES as f64;
            let u = (column as f64 + within(sample % SAMPLES)) / width as f64;
            let v = (row as f64 + within(sample / SAMPLES)) / height as f64;
            sum += look_up(cube, side, direction(u, v));
        }
        (sum / (SAMPLES * SAMPLES) as f64).to_f32()
    };
    let texels: Vec<_> = (0..height).flat_map(|row| (0..width).map(move |column| texel(row, column))).collect();
    ImageData { width: width as u32, height: height as u32, texels: Texels::Float(texels), has_alpha: false }
}

/// The place of a direction in a lat-long map: u = atan2(x, −z)/2π, v = acos(y)/π.
fn direction(u: f64, v: f64) -> DVec3 {
    let (turn, sine) = (TAU * u, (PI * v).sin());
    DVec3::new(sine * turn.sin(), (PI * v).cos(), -sine * turn.cos())
}

/// The colour of a cube in a direction, bilinearly. Faces are +X, −X, +Y, −Y, +Z and −Z, each as it is seen from within, with +Y up and, looking at
/// +Y or −Y, with +Z below or above.
fn look_up(cube: &ImageData, side: usize, towards: DVec3) -> Spectrum {
    let largest = towards.abs().max_element();
    let d = towards / largest;
    // To the right and downwards on the face, from -1 to 1.
    let (face, right, down) = if d.x.abs() == 1.0 {
        if d.x > 0.0 { (0, d.z, -d.y) } else { (1, -d.z, -d.y) }
    } else if d.y.abs() == 1.0 {
        if d.y > 0.0 { (2, d.x, -d.z) } else { (3, d.x, d.z) }
    } else if d.z > 0.0 {
        (4, -d.x, -d.y)
    } else {
        (5, d.x, -d.y)
    };
    let last = (side - 1) as f64;
    let at = |place: f64| (0.5 * (place + 1.0) * last).clamp(0.0, last);
    let (x, y) = (at(right), at(down));
    let texel = |column: f64, row: f64| {
        let [column, row] = [column, row].map(|place| (place as usize).min(side - 1));
        Spectrum::from_f32(cube.texels.color((face * side + row) * side + column).to_array())
    };
    let (left, top) = (x.floor(), y.floor());
    let row = |row: f64| texel(left, row).lerp(texel(left + 1.0, row), x - left);
    row(top).lerp(row(top + 1.0), y - top)
}
