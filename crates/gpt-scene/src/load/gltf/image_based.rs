//! EXT_lights_image_based: the pictures of a cube around the scene, as one lat-long map.
//!
//! Pictures are in the order +X −X +Y −Y +Z −Z. Each is as the extension has it: laid out as the faces of cube maps are, and mirrored from left to right, so
//! that from within, where x leads to the right of who looks along −z, nothing is mirrored. Lux are taken for radiance, as other light of glTF is. PNG with
//! alpha holds colours that are to be divided by it.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use glam::{DAffine3, DQuat, DVec3};
use image::DynamicImage;
use rayon::prelude::*;
use serde_json::Value;

use super::importer::Importer;
use crate::load::error::show;
use crate::load::file::colour::Rgb;
use crate::load::file::light::{LightEntry, environment};
use crate::load::file::reference::FileOr;
use crate::load::file::shape::TransformEntry;
use crate::load::file::value::Checked;
use crate::load::file::writer::picture;
use crate::load::files::MOST_MODEL_BYTES;
use crate::load::image_file::{EmbeddedFile, decoded};
use crate::math::srgb_to_linear;
use crate::scene::{ImageData, Texels};
use crate::spectrum::Spectrum;

const NAME: &str = "EXT_lights_image_based";

/// Faces of a cube.
const FACES: usize = 6;
/// Most rows of the map that is made.
const MOST_ROWS: u32 = 2048;
/// Rows of a map that is made of the coefficients.
const ROWS_OF_COEFFICIENTS: u32 = 32;
/// Places along each side of a texel at which pictures are looked up.
const LOOKUPS: usize = 3;
/// Shares of radiance that a cosine leaves in irradiance, by bands of spherical harmonics (Ramamoorthi and Hanrahan 2001).
const OF_COSINE: [f64; 3] = [PI, TAU / 3.0, PI / 4.0];

/// A picture of one side, linear.
struct Face {
    side: u32,
    texels: Vec<Spectrum>,
}

impl Importer<'_> {
    /// Adds the light that the shown scene names.
    pub fn image_based_light(&mut self) -> Result<(), String> {
        let scene = self.root.scene.unwrap_or(0);
        let Some(reference) = self.root.scenes.get(scene).and_then(|scene| scene.extensions.get(NAME)) else { return Ok(()) };
        let number =
            reference.get("light").and_then(Value::as_u64).ok_or_else(|| format!("{NAME}: scenes[{scene}] names no light"))?;
        let lights = self.root.extensions.get(NAME).and_then(|lights| lights.get("lights"));
        let light = lights.and_then(|lights| lights.get(number as usize)).cloned();
        let light = light.ok_or_else(|| format!("there is no {NAME}.lights[{number}]"))?;
        let key = format!("{NAME}.lights[{number}]");
        let of_light = |message: &str| format!("{key}: {message}");
        let intensity = light.get("intensity").map_or(Some(1.0), Value::as_f64).filter(|number| number.is_finite());
        let mut intensity = intensity.ok_or_else(|| of_light("its intensity is no number"))?;
        if intensity < 0.0 {
            self.approximate("light below 0", &key, "it is taken for 0");
            intensity = 0.0;
        }
        let turn = match light.get("rotation") {
            None => DQuat::IDENTITY,
            Some(written) => {
                let numbers = numbers::<4>(written).ok_or_else(|| of_light("its rotation is not of 4 numbers"))?;
                match DQuat::from_array(numbers) {
                    turn if turn.length() > 0.0 && turn.is_finite() => turn.normalize(),
                    _ => {
                        self.approximate("rotation of length 0", &key, "the light is not turned");
                        DQuat::IDENTITY
                    }
                }
            }
        };
        let map = match self.faces(&light) {
            Ok(faces) => {
                if light.get("specularImages").and_then(Value::as_array).is_some_and(|levels| levels.len() > 1) {
                    self.drop(
                        "specularImages of rough materials",
                        &key,
                        "the sharp ones light everything, whatever its roughness",
                    );
                }
                if light.get("irradianceCoefficients").is_some() {
                    self.drop("irradianceCoefficients", &key, "the pictures light what is dull as well");
                }
                let rows = (2 * faces.iter().map(|face| face.side).max().unwrap_or(1)).clamp(16, MOST_ROWS);
                let instead = format!("they are resampled to a lat-long map of {} x {rows} texels", 2 * rows);
                self.approximate("specularImages", &key, &instead);
                lat_long(rows, |direction| look_up(&faces, direction))
            }
            Err(reason) => {
                let coefficients =
                    coefficients(&light).ok_or_else(|| of_light(&format!("{reason}; and it has no 9 irradianceCoefficients")))?;
                let instead = format!("light as smooth as irradianceCoefficients say it is, not below 0: {reason}");
                self.approximate("specularImages that cannot be read", &key, &instead);
                lat_long(ROWS_OF_COEFFICIENTS, |direction| radiance_of(&coefficients, direction))
            }
        };
        let place = self.place(&key);
        let file = EmbeddedFile { name: "environment.exr".to_owned(), bytes: picture(&map).into() };
        let constant = environment::Keys::constant(place.at(Rgb::of(Spectrum::BLACK)?));
        let keys = environment::Keys {
            radiance: None,
            file: Some(place.at(FileOr::InMemory(Arc::new(file)))),
            scale: (intensity != 1.0).then(|| Checked::of(intensity).map(|scale| place.at(scale))).transpose()?,
            transform: TransformEntry::of_map(&DAffine3::from_quat(turn), &place)?,
            ..constant
        };
        self.scene.file.light.push(place.at(LightEntry::Environment(keys)));
        Ok(())
    }

    /// The six pictures of what mirrors show.
    fn faces(&mut self, light: &Value) -> Result<Vec<Face>, String> {
        let first = light.get("specularImages").and_then(|levels| levels.get(0)).and_then(Value::as_array);
        let first = first.filter(|faces| faces.len() == FACES).ok_or("it has no six specularImages")?;
        let face = |number: &Value| {
            let index = number.as_u64().and_then(|index| usize::try_from(index).ok()).ok_or("a specularImage is no number")?;
            let image = self.root.images.get(index).cloned().ok_or_else(|| format!("there is no images[{index}]"))?;
            let of_image = |message: String| format!("images[{index}]: {message}");
            let file = self.picture(index, &image).map_err(of_image)?;
            let bytes = match &file {
                FileOr::OnDisk(path) => {
                    self.files.read(path, MOST_MODEL_BYTES).map_err(|error| format!("{}: {error}", show(path)))?
                }
                FileOr::InMemory(file) => file.bytes.to_vec().into(),
                FileOr::Written(path) => return Err(format!("{path} is not a file of this one")),
            };
            Face::of(&decoded(&bytes).map_err(of_image)?).map_err(of_image)
        };
        first.iter().map(face).collect()
    }
}

/// Numbers of a list of so many.
fn numbers<const COUNT: usize>(written: &Value) -> Option<[f64; COUNT]> {
    let list = written.as_array().filter(|list| list.len() == COUNT)?;
    let mut numbers = [0.0; COUNT];
    for (number, written) in numbers.iter_mut().zip(list) {
        *number = written.as_f64().filter(|number| number.is_finite())?;
    }
    Some(numbers)
}

/// Coefficients of irradiance in the order of Ramamoorthi and Hanrahan: 1; y, z, x; xy, yz, 3z² − 1, xz, x² − y².
fn coefficients(light: &Value) -> Option<[Spectrum; 9]> {
    let list = light.get("irradianceCoefficients")?.as_array().filter(|list| list.len() == 9)?;
    let mut coefficients = [Spectrum::BLACK; 9];
    for (coefficient, written) in coefficients.iter_mut().zip(list) {
        *coefficient = Spectrum::from_rgb(numbers::<3>(written)?);
    }
    Some(coefficients)
}

/// The radiance of which a cosine makes irradiance with these coefficients.
fn radiance_of(coefficients: &[Spectrum; 9], direction: DVec3) -> Spectrum {
    let DVec3 { x, y, z } = direction;
    let [c0, c1, c2] = OF_COSINE.map(f64::recip);
    let basis = [
        0.282_095 * c0,
        0.488_603 * y * c1,
        0.488_603 * z * c1,
        0.488_603 * x * c1,
        1.092_548 * x * y * c2,
        1.092_548 * y * z * c2,
        0.315_392 * (3.0 * z * z - 1.0) * c2,
        1.092_548 * x * z * c2,
        0.546_274 * (x * x - y * y) * c2,
    ];
    coefficients.iter().zip(basis).map(|(coefficient, value)| *coefficient * value).sum()
}

impl Face {
    fn of(image: &DynamicImage) -> Result<Self, String> {
        let (width, height) = (image.width(), image.height());
        if width != height || width == 0 {
            return Err(format!("a side of a cube is a square, and this picture has {width} x {height} texels"));
        }
        let is_divided = image.color().has_alpha();
        let texel = |texel: &image::Rgba<f32>| {
            let [r, g, b, alpha] = texel.0;
            // An alpha of 0 has no colour; the least that a byte says is the nearest.
            let divisor = if is_divided { f64::from(alpha.max(1.0 / 255.0)) } else { 1.0 };
            Spectrum::from_rgb([r, g, b].map(|channel| f64::from(srgb_to_linear(channel)) / divisor))
        };
        Ok(Self { side: width, texels: image.to_rgba32f().pixels().map(texel).collect() })
    }

    /// The colour at a place from 0 to 1 from the left and from the top, between texels.
    fn at(&self, u: f64, v: f64) -> Spectrum {
        let last = f64::from(self.side - 1);
        let [x, y] = [u, v].map(|place| (place * f64::from(self.side) - 0.5).clamp(0.0, last));
        let texel = |x: f64, y: f64| self.texels[(y.min(last) as usize) * self.side as usize + x.min(last) as usize];
        let (left, top) = (x.floor(), y.floor());
        let row = |y: f64| texel(left, y) * (1.0 - (x - left)) + texel(left + 1.0, y) * (x - left);
        row(top) * (1.0 - (y - top)) + row(top + 1.0) * (y - top)
    }
}

/// The colour of a cube in a direction.
fn look_up(faces: &[Face], direction: DVec3) -> Spectrum {
    let DVec3 { x, y, z } = direction;
    let size = direction.abs();
    // Along each face, to the right of cube maps and down.
    let (face, major, across, down) = if size.x >= size.y && size.x >= size.z {
        if x > 0.0 { (0, x, -z, -y) } else { (1, -x, z, -y) }
    } else if size.y >= size.z {
        if y > 0.0 { (2, y, x, z) } else { (3, -y, x, -z) }
    } else if z > 0.0 {
        (4, z, x, -y)
    } else {
        (5, -z, -x, -y)
    };
    faces[face].at(0.5 - 0.5 * across / major, 0.5 + 0.5 * down / major)
}

/// The lat-long map of a radiance by directions: u = atan2(x, −z)/2π, v = acos(y)/π.
fn lat_long(rows: u32, radiance: impl Fn(DVec3) -> Spectrum + Sync) -> ImageData {
    let (width, height) = (2 * rows as usize, rows as usize);
    let within = |place: usize, lookup: usize, side: usize| (place as f64 + (lookup as f64 + 0.5) / LOOKUPS as f64) / side as f64;
    let texel = |index: usize| {
        let places = 0..LOOKUPS * LOOKUPS;
        let sum: Spectrum = places
            .map(|lookup| {
                let (u, v) = (within(index % width, lookup % LOOKUPS, width), within(index / width, lookup / LOOKUPS, height));
                let (turn, sine) = (TAU * u, (PI * v).sin());
                radiance(DVec3::new(sine * turn.sin(), (PI * v).cos(), -sine * turn.cos()))
            })
            .sum();
        (sum / (LOOKUPS * LOOKUPS) as f64).max(Spectrum::BLACK).to_f32()
    };
    let texels = (0..width * height).into_par_iter().map(texel).collect();
    ImageData { width: width as u32, height: height as u32, texels: Texels::Float(texels), has_alpha: false }
}
