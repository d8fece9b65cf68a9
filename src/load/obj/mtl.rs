//! MTL files: checked line by line, then read by `tobj`, which panics on a colour of fewer than three numbers.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use crate::load::encoding;
use crate::load::error::{SceneError, show};
use crate::load::files::{Files, MOST_LIBRARY_BYTES};
use crate::load::model::MtlMaterial;
use crate::load::printable::short_list;
use crate::scene::{Channel, ColorSpace};

/// All MTL files of one model.
#[derive(Default)]
pub struct Libraries {
    files: BTreeSet<PathBuf>,
    pub materials: Vec<MtlMaterial>,
    pub warnings: Vec<String>,
    /// What is missing.
    pub substitutes: Vec<String>,
}

/// An image and how it lies on the surface, from `map_Kd`'s options.
#[derive(Debug, Clone, PartialEq)]
pub struct TextureMap {
    /// As it is written.
    pub file: String,
    /// Factors of u and v (`-s`).
    pub scale: [f64; 2],
    /// Added to u and v after scaling (`-o`).
    pub offset: [f64; 2],
    /// Do not repeat (`-clamp on`).
    pub clamp: bool,
    /// How texels are stored (`-colorspace`), where that is said.
    pub space: Option<ColorSpace>,
    /// Of which a number is taken (`-imfchan`), where that is said; `l`, the luminance, is red in a grey picture.
    pub channel: Option<Channel>,
    /// Options that were left out.
    pub unsupported: Vec<String>,
}

/// Keys that have an effect here. All others are named.
const HONOURED: [&str; 27] = [
    "newmtl",
    "Kd",
    "Ks",
    "Ke",
    "Ns",
    "Ni",
    "d",
    "Tr",
    "Tf",
    "illum",
    "map_Kd",
    "map_Ke",
    "map_d",
    "Pr",
    "Pm",
    "Ps",
    "Pc",
    "Pcr",
    "aniso",
    "anisor",
    "map_Pr",
    "map_Pm",
    "map_Ps",
    "map_Pc",
    "map_Pcr",
    "map_aniso",
    "norm",
];

impl Libraries {
    /// Reads what stands after each `mtllib`: one name, which may contain blanks, or several.
    pub fn read(&mut self, files: &Files, model: &Path, libraries: &[String]) -> Result<(), SceneError> {
        let folder = model.parent().unwrap_or(Path::new(""));
        let mut seen = BTreeSet::new();
        for written in libraries.iter().filter(|written| seen.insert(written.as_str())) {
            let names = if folder.join(written).exists() { vec![written.as_str()] } else { split_names(files, folder, written) };
            for name in names {
                let found = files.find(folder, name);
                let file = found.as_ref().map_or_else(|| folder.join(name), |found| found.path.clone());
                if !self.files.insert(file.clone()) {
                    continue;
                }
                if found.is_some_and(|found| found.is_substitute) {
                    let warning = format!("{}: there is no material library {name}; {} is taken", show(model), show(&file));
                    self.warnings.push(warning);
                }
                self.read_file(files, file)?;
            }
        }
        Ok(())
    }

    /// What `tobj` wants: the materials and the place of each name.
    pub fn for_tobj<Places: FromIterator<(String, usize)>>(&self) -> (Vec<tobj::Material>, Places) {
        let names = self.materials.iter().enumerate().map(|(place, entry)| (entry.material.name.clone(), place)).collect();
        (self.materials.iter().map(|entry| entry.material.clone()).collect(), names)
    }

    fn read_file(&mut self, files: &Files, file: PathBuf) -> Result<(), SceneError> {
        let bytes = match files.read(&file, MOST_LIBRARY_BYTES) {
            Ok(bytes) => bytes,
            Err(error) => {
                self.substitutes.push(format!("the material library {} cannot be read: {error}", show(&file)));
                return Ok(());
            }
        };
        let (text, encoding) = encoding::decode(&bytes);
        let told = encoding.map(|encoding| format!("{}: it is not in UTF-8, and read as {encoding}", show(&file)));
        self.warnings.extend(told);
        let (text, without_effect) = check(&show(&file), &text)?;
        if !without_effect.is_empty() {
            let list = short_list(&without_effect.into_iter().collect::<Vec<_>>());
            self.warnings.push(format!("{}: keys that have no effect: {list}", show(&file)));
        }
        let loaded = tobj::load_mtl_buf(&mut text.as_bytes());
        let (materials, _) = loaded.map_err(|error| SceneError::in_file(show(&file), error.to_string()))?;
        self.materials.extend(materials.into_iter().map(|material| MtlMaterial {
            file: file.clone(),
            material,
            is_missing: false,
        }));
        Ok(())
    }
}

/// The text with every colour as three numbers, and the keys in it that have no effect.
fn check(name: &str, text: &str) -> Result<(String, BTreeSet<String>), SceneError> {
    let mut checked = String::with_capacity(text.len());
    let mut without_effect = BTreeSet::new();
    for (index, line) in text.lines().enumerate() {
        let wrong = |message: String| SceneError::in_line(name, index + 1, message);
        let line = line.trim();
        let (key, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
        let rest = rest.trim();
        match key {
            "Kd" | "Ks" | "Ke" | "Tf" => {
                let [r, g, b] = colour(rest).map_err(|reason| wrong(format!("{key}: {reason}")))?;
                checked.push_str(&format!("{key} {r} {g} {b}\n"));
                continue;
            }
            "Ns" | "Ni" | "d" | "Tr" => {
                let [value, ..] = colour(rest).map_err(|reason| wrong(format!("{key}: {reason}")))?;
                checked.push_str(&format!("{key} {value}\n"));
                continue;
            }
            "illum" if rest.parse::<u8>().is_err() => {
                return Err(wrong(format!("illum: expected an illumination model from 0 to 10, found `{rest}`")));
            }
            "newmtl" | "map_Kd" | "map_Ke" | "map_d" if rest.is_empty() => {
                return Err(wrong(format!("{key}: the name is missing")));
            }
            // The ambient colour has no meaning in a path tracer.
            "Ka" => continue,
            "" => {}
            key if key.starts_with('#') || HONOURED.contains(&key) => {}
            key => {
                without_effect.insert(key.chars().take(40).collect());
                continue;
            }
        }
        checked.push_str(line);
        checked.push('\n');
    }
    Ok((checked, without_effect))
}

/// One or three numbers from 0 up.
fn colour(rest: &str) -> Result<[f64; 3], String> {
    let values: Vec<f64> = rest
        .split_whitespace()
        .map(|word| word.parse().ok().filter(|value| (0.0..=1e18).contains(value)).ok_or(word))
        .collect::<Result<_, _>>()
        .map_err(|word| format!("expected numbers from 0 to 1e18, found `{word}`"))?;
    match values[..] {
        [grey] => Ok([grey; 3]),
        [r, g, b] => Ok([r, g, b]),
        _ => Err(format!("expected 1 or 3 numbers, found {}", values.len())),
    }
}

/// One name with blanks, or several.
fn split_names<'w>(files: &Files, folder: &Path, written: &'w str) -> Vec<&'w str> {
    let names: Vec<&str> = written.split_whitespace().collect();
    if names.len() > 1 && names.iter().all(|name| files.find(folder, name).is_none()) { vec![written] } else { names }
}

impl TextureMap {
    /// Parses `[options] file`.
    pub fn parse(written: &str) -> Result<Self, String> {
        let mut map = Self {
            file: String::new(),
            scale: [1.0; 2],
            offset: [0.0; 2],
            clamp: false,
            space: None,
            channel: None,
            unsupported: Vec::new(),
        };
        let mut rest = written.trim();
        while rest.starts_with('-') {
            let (option, after) = next_word(rest);
            rest = after;
            match option {
                "-s" => rest = numbers(rest, &mut map.scale)?,
                "-o" => rest = numbers(rest, &mut map.offset)?,
                "-clamp" => {
                    let (state, after) = next_word(rest);
                    map.clamp = state == "on";
                    rest = after;
                }
                "-colorspace" => {
                    let (name, after) = next_word(rest);
                    rest = after;
                    map.space = match name.to_ascii_lowercase().as_str() {
                        "srgb" => Some(ColorSpace::Srgb),
                        "linear" | "raw" | "non-color" => Some(ColorSpace::Linear),
                        other => return Err(format!("the colour space `{other}` is neither `sRGB` nor `linear`")),
                    };
                }
                "-t" => rest = numbers(rest, &mut [0.0; 2])?,
                "-mm" => rest = next_word(next_word(rest).1).1,
                "-imfchan" => {
                    let (name, after) = next_word(rest);
                    map.channel = Some(match name {
                        "r" | "l" => Channel::R,
                        "g" => Channel::G,
                        "b" => Channel::B,
                        "m" => Channel::A,
                        other => return Err(format!("the channel `{other}` is none of r, g, b, m and l")),
                    });
                    rest = after;
                }
                "-blendu" | "-blendv" | "-cc" | "-boost" | "-texres" | "-bm" | "-type" => rest = next_word(rest).1,
                other => return Err(format!("the texture option `{other}` is not known")),
            }
            if !["-s", "-o", "-clamp", "-colorspace", "-imfchan", "-blendu", "-blendv", "-texres"].contains(&option) {
                map.unsupported.push(option.to_owned());
            }
        }
        if rest.is_empty() {
            return Err(format!("`{written}` names no image"));
        }
        rest.clone_into(&mut map.file);
        Ok(map)
    }
}

/// Reads one to three numbers, the second and third being optional.
fn numbers<'a>(rest: &'a str, into: &mut [f64; 2]) -> Result<&'a str, String> {
    let mut rest = rest;
    for place in 0..3 {
        let (word, after) = next_word(rest);
        match word.parse::<f64>() {
            Ok(value) if value.is_finite() && value.abs() < 1e18 => {
                // One factor alone is that of u; the third is for volumes.
                if let Some(slot) = into.get_mut(place) {
                    *slot = value;
                }
                rest = after;
            }
            _ if place == 0 => return Err(format!("expected a number, found `{word}`")),
            _ => break,
        }
    }
    Ok(rest)
}

fn next_word(text: &str) -> (&str, &str) {
    let (word, rest) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
    (word, rest.trim_start())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texture_options_are_read() {
        let map = TextureMap::parse("-s 2 3 1 -o 0.5 -clamp on my wood.png");
        let expected = TextureMap {
            file: "my wood.png".to_owned(),
            scale: [2.0, 3.0],
            offset: [0.5, 0.0],
            clamp: true,
            space: None,
            channel: None,
            unsupported: Vec::new(),
        };
        assert_eq!(map, Ok(expected));
        let space = |written: &str| TextureMap::parse(written).map(|map| (map.space, map.file));
        assert_eq!(space("-colorspace sRGB a.png"), Ok((Some(ColorSpace::Srgb), "a.png".to_owned())));
        assert_eq!(space("-colorspace linear a.png"), Ok((Some(ColorSpace::Linear), "a.png".to_owned())));
        assert!(space("-colorspace red a.png").is_err());
        assert!(TextureMap::parse("-s wood.png").is_err());
        assert!(TextureMap::parse("-clamp on").is_err());
        assert!(TextureMap::parse("-nonsense 3 wood.png").is_err());
    }

    #[test]
    fn a_short_colour_is_grey_and_a_wrong_one_names_its_line() {
        let (text, _) = check("a.mtl", "newmtl a\nKd 0.5\nKa 1\nmap_Kd a.png").unwrap_or_default();
        assert_eq!(text, "newmtl a\nKd 0.5 0.5 0.5\nmap_Kd a.png\n");
        let error = check("a.mtl", "newmtl a\nKd 0.5 0.5").map_err(|error| error.to_string());
        assert_eq!(error, Err("a.mtl:2:1: Kd: expected 1 or 3 numbers, found 2".to_owned()));
    }
}
