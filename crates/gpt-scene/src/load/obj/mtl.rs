//! MTL files: each statement by itself, and what it says wrongly is mended.

use std::borrow::Cow;
use std::collections::{BTreeSet, HashMap};
use std::path::{Path, PathBuf};

use crate::load::encoding;
use crate::load::error::{SceneError, show};
use crate::load::files::{Files, MOST_LIBRARY_BYTES};
use crate::load::mends::Mends;
use crate::load::model::{MtlKey, MtlMaterial, Substitute};
use crate::load::printable::short_list;
use crate::load::spelling::lines::{Statements, before_spaced_comment, first_word, trimmed, without_comment, words};
use crate::load::spelling::names::{canonical, unquoted};
use crate::load::spelling::numbers::{integer, number};
use crate::math::xyz_to_rec709;
use crate::spectrum::Spectrum;

/// All MTL files of one model.
#[derive(Default)]
pub struct Libraries {
    files: BTreeSet<PathBuf>,
    pub materials: Vec<MtlMaterial>,
    /// Places of the materials by their names in canonical form.
    places: HashMap<String, usize>,
    pub warnings: Vec<String>,
    /// Missing and mended things, each with the file where it is.
    pub substitutes: Vec<(PathBuf, Substitute)>,
}

/// Keys whose value is a colour from 0 up.
const COLOURS: [MtlKey; 4] = ["Kd", "Ks", "Ke", "Tf"];
/// Keys whose value is a number, and between which ones.
const NUMBERS: [(MtlKey, [f64; 2]); 11] = [
    ("Ns", [0.0, 1e9]),
    ("Ni", [0.1, 10.0]),
    ("d", [0.0, 1.0]),
    ("Tr", [0.0, 1.0]),
    ("Pr", [0.0, 1.0]),
    ("Pm", [0.0, 1.0]),
    ("Ps", [0.0, 1.0]),
    ("Pc", [0.0, 1.0]),
    ("Pcr", [0.0, 1.0]),
    ("aniso", [0.0, 1.0]),
    ("anisor", [-1e9, 1e9]),
];
/// Keys whose value is a picture, and how else they are spelled.
const MAPS: [(MtlKey, &[&str]); 12] = [
    ("map_Kd", &[]),
    ("map_Ke", &["map_emissive"]),
    ("map_d", &["map_opacity"]),
    ("map_Pr", &[]),
    ("map_Pm", &[]),
    ("map_Ps", &[]),
    ("map_Pc", &[]),
    ("map_Pcr", &[]),
    ("map_aniso", &[]),
    ("norm", &["map_norm", "map_kn"]),
    ("map_Bump", &["bump"]),
    // Read by nobody, and known to end a line before them.
    ("newmtl", &[]),
];
/// Keys that mean nothing to a path tracer, or tell how others are to be shown.
const HARMLESS: [&str; 5] = ["sharpness", "map_ka", "map_aat", "interpolatemap", "km"];
/// Larger numbers are no colours.
const LARGEST: f64 = 1e18;

impl Libraries {
    /// Reads what stands after each `mtllib`: one name, which may contain blanks, or several.
    pub fn read(&mut self, files: &Files, model: &Path, libraries: &[(usize, String)]) -> Result<(), SceneError> {
        let folder = model.parent().unwrap_or(Path::new(""));
        let mut seen = BTreeSet::new();
        for (line, written) in libraries.iter().filter(|(_, written)| seen.insert(written.as_str())) {
            for name in names(files, folder, written) {
                let found = files.find(folder, name);
                let file = found.as_ref().map_or_else(|| folder.join(name), |found| found.path.clone());
                if !self.files.insert(file.clone()) {
                    continue;
                }
                if found.is_some_and(|found| found.is_substitute) {
                    let warning = format!("{}: there is no material library {name}; {} is taken", show(model), show(&file));
                    self.warnings.push(warning);
                }
                match files.read(&file, MOST_LIBRARY_BYTES) {
                    Ok(bytes) => self.add(&file, &bytes),
                    Err(error) => {
                        let what = format!("the material library {} cannot be read: {error}", show(&file));
                        self.substitutes.push((model.to_owned(), Substitute { line: Some(*line), what }));
                    }
                }
            }
        }
        Ok(())
    }

    /// The place of the material that a `usemtl` names. A name may contain the sign of a comment, and a comment may stand behind it.
    pub fn find(&self, written: &str) -> Option<usize> {
        let exact = |name: &str| self.places.get(canonical(name).as_ref()).copied();
        exact(written).or_else(|| exact(before_spaced_comment(written)?)).or_else(|| exact(unquoted(written)))
    }

    /// Adds a material that stands for one that no library has, and gives its place.
    pub fn add_missing(&mut self, model: &Path, name: &str) -> usize {
        self.places.insert(canonical(name).into_owned(), self.materials.len());
        self.materials.push(MtlMaterial {
            file: model.to_owned(),
            name: name.to_owned(),
            is_missing: true,
            ..Default::default()
        });
        self.materials.len() - 1
    }

    fn add(&mut self, file: &Path, bytes: &[u8]) {
        let (text, encoding) = encoding::decode(bytes);
        let reported = encoding.map(|encoding| format!("{}: it is not in UTF-8, and read as {encoding}", show(file)));
        self.warnings.extend(reported);
        let mut library = Library::default();
        for (line, statement) in Statements::new(&text, is_statement) {
            library.statement(line, &statement);
        }
        let Library { materials, mut mends, without_effect } = library;
        for (line, mut material) in materials {
            material.file = file.to_owned();
            let name = material.name.clone();
            let commented = before_spaced_comment(&name).filter(|short| !short.is_empty());
            let place = self.materials.len();
            match self.places.get(canonical(&name).as_ref()) {
                // The specification searches the libraries in their order.
                Some(_) => mends.add("a material is there twice, and the first one counts", line, &name),
                None => {
                    self.places.insert(canonical(&name).into_owned(), place);
                    for other in [Some(unquoted(&name)), commented].into_iter().flatten() {
                        self.places.entry(canonical(other).into_owned()).or_insert(place);
                    }
                    self.materials.push(material);
                }
            }
        }
        if !without_effect.is_empty() {
            let list = short_list(&without_effect.iter().collect::<Vec<_>>());
            let what = format!("keys that have no effect: {list}");
            if without_effect.iter().all(|key| HARMLESS.contains(&key.to_ascii_lowercase().as_str())) {
                self.warnings.push(format!("{}: {what}", show(file)));
            } else {
                self.substitutes.push((file.to_owned(), Substitute { line: None, what }));
            }
        }
        self.substitutes.extend(mends.into_substitutes().into_iter().map(|mend| (file.to_owned(), mend)));
    }
}

/// One name with blanks, or several, of which some may have blanks: the longest that are there.
fn names<'w>(files: &Files, folder: &Path, written: &'w str) -> Vec<&'w str> {
    /// Names of more words than that are one name alone.
    const MOST_WORDS: usize = 8;
    let is_there = |name: &str| files.find_exactly(folder, name).is_some();
    if is_there(written) {
        return vec![written];
    }
    let whole = before_spaced_comment(written).unwrap_or(written);
    let place = |word: &str| word.as_ptr() as usize - whole.as_ptr() as usize;
    let mut spans: Vec<std::ops::Range<usize>> = Vec::new();
    for word in words(whole) {
        let end = place(word) + word.len();
        match spans.last_mut() {
            // A backslash escapes the blank behind it.
            Some(last) if whole[..last.end].ends_with('\\') => last.end = end,
            _ => spans.push(place(word)..end),
        }
    }
    let mut names = Vec::new();
    let mut any = false;
    let mut first = 0;
    while first < spans.len() {
        let name = |last: usize| &whole[spans[first].start..spans[last].end];
        let found = (first..spans.len().min(first + MOST_WORDS)).rev().find(|&last| is_there(name(last)));
        any |= found.is_some();
        names.push(name(found.unwrap_or(first)));
        first = found.unwrap_or(first) + 1;
    }
    if any {
        return names;
    }
    // In another case, say, or not at all.
    let is_found = |name: &&str| files.find(folder, name).is_some();
    let libraries = names.iter().filter(|name| name.to_ascii_lowercase().ends_with(".mtl")).count();
    if is_found(&whole) || (libraries < 2 && !names.iter().any(is_found)) { vec![whole] } else { names }
}

/// A material library that is being read.
#[derive(Default)]
struct Library {
    /// Each with the line of its `newmtl`.
    materials: Vec<(usize, MtlMaterial)>,
    mends: Mends,
    without_effect: BTreeSet<String>,
}

fn is_statement(line: &str) -> bool {
    let (key, _) = first_word(line);
    key.eq_ignore_ascii_case("illum") || key.eq_ignore_ascii_case("Ka") || known(key).is_some()
}

/// The kind of a key's value.
enum Kind {
    Colour(MtlKey),
    Number(MtlKey, [f64; 2]),
    Map(MtlKey),
}

fn known(key: &str) -> Option<Kind> {
    let same = |name: &&str| name.eq_ignore_ascii_case(key);
    if let Some(colour) = COLOURS.into_iter().find(|name| same(name)) {
        return Some(Kind::Colour(colour));
    }
    if let Some((number, range)) = NUMBERS.into_iter().find(|(name, _)| same(name)) {
        return Some(Kind::Number(number, range));
    }
    MAPS.into_iter().find(|(name, others)| same(name) || others.iter().any(&same)).map(|(map, _)| Kind::Map(map))
}

impl Library {
    fn statement(&mut self, line: usize, statement: &str) {
        let (key, rest) = first_word(statement);
        if key.eq_ignore_ascii_case("newmtl") {
            if rest.is_empty() {
                self.mends.add("`newmtl` without a name begins a material without one", line, statement);
            }
            self.materials.push((line, MtlMaterial { name: trimmed(rest).to_owned(), ..Default::default() }));
            return;
        }
        // The ambient colour has no meaning in a path tracer.
        if key.eq_ignore_ascii_case("Ka") {
            return;
        }
        let known = known(key);
        let is_illum = key.eq_ignore_ascii_case("illum");
        if known.is_none() && !is_illum {
            self.without_effect.insert(key.chars().take(40).collect());
            return;
        }
        let Self { materials, mends, .. } = self;
        let Some((_, material)) = materials.last_mut() else {
            mends.add("what stands before the first `newmtl` is left out", line, statement);
            return;
        };
        match known {
            Some(Kind::Colour(key)) => {
                if let Some(colour) = colour(mends, line, statement) {
                    material.colours.insert(key, colour);
                }
            }
            Some(Kind::Number(key, range)) => {
                if let Some(value) = value(mends, line, statement, range) {
                    material.numbers.insert(key, value);
                }
                let [d, tr] = ["d", "Tr"].map(|key| material.number(key));
                if let (Some(d), Some(tr), "d" | "Tr") = (d, tr, key)
                    && (d + tr - 1.0).abs() > 1e-3
                {
                    mends.add("`d` and `Tr` contradict each other, and `d` counts", line, statement);
                }
            }
            Some(Kind::Map(_)) if rest.is_empty() => mends.add("a map without a file is left out", line, statement),
            Some(Kind::Map(key)) => {
                material.maps.insert(key, (line, trimmed(rest).to_owned()));
            }
            None => match illumination(mends, line, statement) {
                Some(model) => material.illumination = Some(model),
                None => mends.add("`illum` that is no number from 0 to 10 is left out", line, statement),
            },
        }
    }
}

fn illumination(mends: &mut Mends, line: usize, statement: &str) -> Option<u8> {
    let mut rest = words(first_word(without_comment(statement)).1);
    let model = integer(rest.next()?)?;
    if rest.next().is_some() {
        mends.add("what follows a number is left out", line, statement);
    }
    (0.0..=10.0).contains(&model.value).then_some(model.value as u8)
}

/// The number after a key, within its range. None where none can be read.
fn value(mends: &mut Mends, line: usize, statement: &str, [least, most]: [f64; 2]) -> Option<f64> {
    let (_, mut rest) = first_word(without_comment(statement));
    if let Some(after) = rest.strip_prefix("-halo") {
        mends.add("`-halo`, which lets the edges of a shape be clearer than its middle, has no effect", line, statement);
        rest = after;
    }
    let numbers = numbers(mends, line, statement, rest);
    let Some(&value) = numbers.as_deref().and_then(<[f64]>::first) else {
        mends.add("a number that cannot be read is as if it were not there", line, statement);
        return None;
    };
    // Some programs repeat a number for red, green and blue.
    if numbers.is_some_and(|numbers| numbers.iter().any(|other| *other != value)) {
        mends.add("what follows a number is left out", line, statement);
    }
    // 0 stands for an index of refraction that nobody gave.
    if value <= 0.0 && least > 0.0 {
        mends.add("a number that can be nowhere is as if it were not there", line, statement);
        return None;
    }
    if !(least..=most).contains(&value) {
        mends.add("the nearest number that can be stands for one that cannot", line, statement);
    }
    Some(value.clamp(least, most))
}

/// The colour after a key: one number, three, or three of CIE XYZ after `xyz`. None where none can be read.
fn colour(mends: &mut Mends, line: usize, statement: &str) -> Option<Spectrum> {
    let (_, rest) = first_word(without_comment(statement));
    let (word, after) = first_word(rest);
    if word.eq_ignore_ascii_case("spectral") {
        mends.add("a spectrum in a file is not read: the colour is as if it were not there", line, statement);
        return None;
    }
    let is_xyz = word.eq_ignore_ascii_case("xyz");
    let rest = if is_xyz || word.eq_ignore_ascii_case("rgb") { after } else { rest };
    let numbers = numbers(mends, line, statement, rest);
    let colour = match numbers.as_deref() {
        Some([grey]) => Spectrum::grey(*grey),
        Some([r, g]) => {
            mends.add("a colour of two numbers has its second one for blue too", line, statement);
            Spectrum::new(*r, *g, *g)
        }
        Some([r, g, b, more @ ..]) => {
            if !more.is_empty() {
                mends.add("what follows three numbers of a colour is left out", line, statement);
            }
            Spectrum::new(*r, *g, *b)
        }
        _ => {
            mends.add("a colour that cannot be read is as if it were not there", line, statement);
            return None;
        }
    };
    if is_xyz {
        let linear = xyz_to_rec709(colour.to_vector());
        if linear.min_component() < -1e-3 {
            mends.add("a colour outside of Rec.709 loses what is below 0", line, statement);
        }
        return Some(linear.max(Spectrum::BLACK));
    }
    if colour.min_component() < 0.0 {
        mends.add("0 stands for colours below", line, statement);
    }
    Some(colour.max(Spectrum::BLACK))
}

/// All numbers of a statement. None where a word is none.
fn numbers(mends: &mut Mends, line: usize, statement: &str, rest: &str) -> Option<Vec<f64>> {
    let mut rest = Cow::Borrowed(rest);
    // `0.5, 0.5, 0.5` and `0.5,0.5,0.5`, but not the decimal commas of `0,5 0,5 0,5`.
    if rest.contains(',') && (rest.contains('.') || rest.matches(',').count() >= 2 && words(&rest).count() == 1) {
        rest = rest.replace(',', " ").into();
    }
    let mut is_odd = matches!(rest, Cow::Owned(_));
    let mut values = Vec::new();
    for word in words(&rest) {
        let number = number::<f64>(word).filter(|number| number.value.abs() <= LARGEST)?;
        is_odd |= number.is_odd;
        values.push(number.value);
    }
    if is_odd {
        mends.add("numbers in an odd spelling are read as what they most likely are", line, statement);
    }
    Some(values)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Libraries {
        let mut libraries = Libraries::default();
        libraries.add(Path::new("a.mtl"), text.as_bytes());
        libraries
    }

    /// The first material of a library, and what was mended.
    fn material(keys: &str) -> (MtlMaterial, Vec<String>) {
        let mut libraries = read(&format!("newmtl a\n{keys}\n"));
        let reported =
            libraries.substitutes.iter().map(|(_, mend)| format!("{}: {}", mend.line.unwrap_or(0), mend.what)).collect();
        (libraries.materials.swap_remove(0), reported)
    }

    #[test]
    fn what_is_right_needs_no_mend() {
        let (material, reported) = material(
            "\tKd .5 0 0 # red\nKs 0.5\nKe 1 2 3\nTf 1 1 1\r\nNs 1e3\nNi 1.5 \nd 0.5\nillum 2 # phong\nmap_Kd a.png\n\nKa 1 1\nPr .1\n\
             bump -bm 2 h.png",
        );
        assert!(reported.is_empty(), "{reported:?}");
        assert_eq!(material.colour("Kd"), Some(Spectrum::new(0.5, 0.0, 0.0)));
        assert_eq!(material.colour("Ks"), Some(Spectrum::grey(0.5)));
        assert_eq!((material.number("Ns"), material.number("Ni"), material.number("d")), (Some(1000.0), Some(1.5), Some(0.5)));
        assert_eq!(material.illumination, Some(2));
        assert_eq!(material.maps["map_Kd"].1, "a.png");
        assert_eq!(material.maps["map_Bump"].1, "-bm 2 h.png");
    }

    #[test]
    fn keys_are_known_in_any_case() {
        let (material, reported) = material("kd 1 0 0\nMAP_KD a.png\nMap_bump h.png\nNEWMTL b");
        assert!(reported.is_empty(), "{reported:?}");
        assert_eq!(material.colour("Kd"), Some(Spectrum::new(1.0, 0.0, 0.0)));
        assert_eq!(material.maps.len(), 2);
    }

    #[test]
    fn one_odd_statement_is_mended_and_named() {
        let colour = |text: &str| material(text).0.colour("Kd");
        let rows: [(&str, Option<Spectrum>); 12] = [
            ("Kd 0.5 0.25", Some(Spectrum::new(0.5, 0.25, 0.25))),
            ("Kd", None),
            ("Kd nan", None),
            ("Kd 1 nan 0", None),
            ("Kd red", None),
            ("Kd 1e400", None),
            ("Kd spectral file.rfl 1", None),
            ("Kd -1 0 1", Some(Spectrum::new(0.0, 0.0, 1.0))),
            ("Kd 1 0 0 1", Some(Spectrum::new(1.0, 0.0, 0.0))),
            ("Kd 0,5 0,25 1", Some(Spectrum::new(0.5, 0.25, 1.0))),
            ("Kd 0.5, 0.25, 1", Some(Spectrum::new(0.5, 0.25, 1.0))),
            ("Kd 0.5f 0.25f 1.0f", Some(Spectrum::new(0.5, 0.25, 1.0))),
        ];
        for (text, expected) in rows {
            assert_eq!(colour(text), expected, "{text}");
            let reported = material(text).1;
            assert!(reported.len() == 1 && reported[0].starts_with("2: ") && reported[0].contains(text), "{text}: {reported:?}");
        }
        let number = |text: &str, key: MtlKey| material(text).0.number(key);
        let rows: [(&str, MtlKey, Option<f64>); 10] = [
            ("d -halo 0.5", "d", Some(0.5)),
            ("d 1.5", "d", Some(1.0)),
            ("Tr -1", "Tr", Some(0.0)),
            ("d", "d", None),
            ("d x", "d", None),
            ("Ns -3", "Ns", Some(0.0)),
            ("Ni 100", "Ni", Some(10.0)),
            ("Ni 0", "Ni", None),
            ("Pr 2", "Pr", Some(1.0)),
            ("Ns 10 20", "Ns", Some(10.0)),
        ];
        for (text, key, expected) in rows {
            assert_eq!(number(text, key), expected, "{text}");
            assert_eq!(material(text).1.len(), 1, "{text}: {:?}", material(text).1);
        }
        for text in ["illum", "illum glass", "illum 11", "illum -1", "illum 2.5", "map_Kd", "newmtl", "d 0.5\nTr 0.2"] {
            assert_eq!(material(text).1.len(), 1, "{text}: {:?}", material(text).1);
        }
        assert_eq!(material("illum 2.0").0.illumination, Some(2));
    }

    #[test]
    fn xyz_is_a_colour_of_cie() {
        // The white of Rec.709 is D65.
        let (white, reported) = material("Kd xyz 0.9504559 1.0 1.0890577");
        assert!(reported.is_empty(), "{reported:?}");
        assert!(
            white.colour("Kd").is_some_and(|colour| (colour - Spectrum::WHITE).map(f64::abs).max_component() < 1e-4),
            "{white:?}"
        );
        let (green, reported) = material("Kd xyz 0 1 0");
        assert_eq!(reported.len(), 1);
        assert!(green.colour("Kd").is_some_and(|colour| colour.r() == 0.0 && colour.g() > 1.8), "{green:?}");
    }

    #[test]
    fn the_first_of_two_materials_counts_and_what_stands_before_all_is_left_out() {
        let libraries = read("Kd 1 0 0\nnewmtl a\nKd 0 1 0\nnewmtl a\nKd 0 0 1\nnewmtl Material #25\nnewmtl b # the second\n");
        assert_eq!(libraries.materials[0].colour("Kd"), Some(Spectrum::new(0.0, 1.0, 0.0)));
        assert_eq!(libraries.substitutes.len(), 2, "{:?}", libraries.substitutes);
        assert_eq!([" a", "Material #25", "b", "b # again", "\"a\""].map(|name| libraries.find(name)), [0, 1, 2, 2, 0].map(Some));
        assert_eq!(libraries.find("A"), None);
    }

    #[test]
    fn composed_and_decomposed_names_are_one() {
        let libraries = read("newmtl Mo\u{308}bel\n");
        assert_eq!(libraries.find("Möbel"), Some(0));
    }

    #[test]
    fn comments_and_continued_lines() {
        let (material, reported) = material("# a \\\nKd 1 0 \\\n0\nmap_Kd C:\\textures\\\nNs 3");
        assert!(reported.is_empty(), "{reported:?}");
        assert_eq!(material.colour("Kd"), Some(Spectrum::new(1.0, 0.0, 0.0)));
        assert_eq!(material.number("Ns"), Some(3.0));
    }
}
