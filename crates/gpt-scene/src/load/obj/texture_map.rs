//! The value of `map_Kd` and its like in an MTL file: a picture, and options before or behind it.

use crate::load::mends::Mends;
use crate::load::spelling::lines::{before_spaced_comment, first_word, trimmed, words};
use crate::load::spelling::names::unquoted;
use crate::load::spelling::numbers::number;
use crate::scene::{Channel, ColorSpace};

/// An image and how it lies on the surface.
#[derive(Debug, Clone, PartialEq)]
pub struct TextureMap {
    /// The name as it is written; empty where none is.
    pub file: String,
    /// Factors of u and v (`-s`).
    pub scale: [f64; 2],
    /// Added to u and v after scaling (`-o`).
    pub offset: [f64; 2],
    /// Do not repeat (`-clamp on`).
    pub clamp: bool,
    /// How texels are stored (`-colorspace`), where that is said.
    pub space: Option<ColorSpace>,
    /// The channel of which a number is taken (`-imfchan`), where that is said; `l`, the luminance, is red in a grey picture.
    pub channel: Option<Channel>,
    /// The factor of heights (`-bm`).
    pub bump: f64,
    /// The number that is added to a texel, and before that its factor (`-mm`).
    pub range: [f64; 2],
}

impl Default for TextureMap {
    fn default() -> Self {
        Self {
            file: String::new(),
            scale: [1.0; 2],
            offset: [0.0; 2],
            clamp: false,
            space: None,
            channel: None,
            bump: 1.0,
            range: [0.0, 1.0],
        }
    }
}

/// The values that follow an option.
enum Values {
    /// One number to so many.
    Numbers(usize),
    Word(&'static [&'static str]),
}

const SWITCH: &[&str] = &["on", "off"];

const OPTIONS: [(&str, Values); 14] = [
    ("-s", Values::Numbers(3)),
    ("-o", Values::Numbers(3)),
    ("-t", Values::Numbers(3)),
    ("-mm", Values::Numbers(2)),
    ("-bm", Values::Numbers(1)),
    ("-boost", Values::Numbers(1)),
    // Sides of a picture, in few programs two of them.
    ("-texres", Values::Numbers(2)),
    ("-clamp", Values::Word(SWITCH)),
    ("-blendu", Values::Word(SWITCH)),
    ("-blendv", Values::Word(SWITCH)),
    ("-cc", Values::Word(SWITCH)),
    ("-imfchan", Values::Word(&["r", "g", "b", "m", "l", "z"])),
    ("-colorspace", Values::Word(&["srgb", "linear", "raw", "non-color"])),
    ("-type", Values::Word(&["sphere", "cube_top", "cube_bottom", "cube_front", "cube_back", "cube_left", "cube_right", "cube"])),
];

/// Options that mean something to other renderers and nothing to this one, and would change what is seen.
const WITHOUT_EFFECT: [&str; 3] = ["-t", "-cc", "-type"];

impl TextureMap {
    /// Parses `[options] file [options]`. `is_there` tells whether there is a file of a name, which may have blanks, and contain what looks like
    /// an option or a comment.
    pub fn parse(written: &str, line: usize, is_there: &dyn Fn(&str) -> bool, mends: &mut Mends) -> Self {
        let mut map = Self::default();
        let mut name = map.options(trimmed(written), line, is_there, mends);
        if !is_there(name) {
            name = before_spaced_comment(name).unwrap_or(name);
            if let Some(start) = (!is_there(name)).then(|| first_option(name)).flatten() {
                let behind = map.options(&name[start..], line, is_there, mends);
                if !behind.is_empty() {
                    mends.add("what follows a picture's name and options is left out", line, written);
                }
                name = trimmed(&name[..start]);
            }
        }
        unquoted(name).clone_into(&mut map.file);
        map
    }

    /// By what texels are multiplied, where `-mm` does that alone.
    pub fn gain(&self) -> f64 {
        let [base, gain] = self.range;
        if base == 0.0 { gain.max(0.0) } else { 1.0 }
    }

    /// Takes options as long as there are some, and gives what follows.
    fn options<'w>(&mut self, text: &'w str, line: usize, is_there: &dyn Fn(&str) -> bool, mends: &mut Mends) -> &'w str {
        let mut rest = text;
        while rest.starts_with('-') && !is_there(rest) {
            let (option, after) = first_word(rest);
            let option = option.to_ascii_lowercase();
            let known = OPTIONS.iter().find(|(name, _)| *name == option);
            rest = match known {
                Some((name, Values::Numbers(most))) => {
                    let (numbers, after) = take_numbers(after, *most, is_there);
                    if numbers.is_empty() || numbers.contains(&None) {
                        mends.add("a texture's option without the number that belongs there is left out", line, rest);
                    } else {
                        self.set_numbers(name, &numbers.into_iter().flatten().collect::<Vec<_>>());
                    }
                    after
                }
                Some((name, Values::Word(words))) => {
                    let (word, behind) = first_word(after);
                    let value = word.to_ascii_lowercase();
                    if words.contains(&value.as_str()) {
                        self.set_word(name, &value);
                        behind
                    } else {
                        mends.add("a texture's option without the word that belongs there is left out", line, rest);
                        // The word there is a wrong one, or the picture's name already.
                        if behind.is_empty() || word.starts_with('-') || is_there(after) { after } else { behind }
                    }
                }
                None => {
                    mends.add("a texture's option that is not known is left out", line, rest);
                    let (_, behind) = take_numbers(after, usize::MAX, is_there);
                    let (word, behind_word) = first_word(behind);
                    if SWITCH.contains(&word) { behind_word } else { behind }
                }
            };
            if let Some(name) = WITHOUT_EFFECT.into_iter().find(|name| *name == option) {
                mends.add("texture options without effect", line, name);
            }
        }
        rest
    }

    fn set_numbers(&mut self, option: &str, numbers: &[f64]) {
        let pair = match option {
            "-s" => &mut self.scale[..],
            "-o" => &mut self.offset[..],
            "-mm" => &mut self.range[..],
            "-bm" => std::slice::from_mut(&mut self.bump),
            _ => return,
        };
        // One factor alone is that of u; the third is for volumes.
        pair.iter_mut().zip(numbers).for_each(|(slot, number)| *slot = *number);
    }

    fn set_word(&mut self, option: &str, value: &str) {
        match option {
            "-clamp" => self.clamp = value == "on",
            "-colorspace" => self.space = Some(if value == "srgb" { ColorSpace::Srgb } else { ColorSpace::Linear }),
            "-imfchan" => {
                self.channel = Some(match value {
                    "g" => Channel::G,
                    "b" => Channel::B,
                    "m" => Channel::A,
                    _ => Channel::R,
                });
            }
            _ => {}
        }
    }
}

/// Takes numbers, at most so many, and those that are not finite as none. What may be a picture's name, which a number can be, is left.
fn take_numbers<'w>(text: &'w str, most: usize, is_there: &dyn Fn(&str) -> bool) -> (Vec<Option<f64>>, &'w str) {
    let mut rest = text;
    let mut numbers = Vec::new();
    while numbers.len() < most {
        let (word, after) = first_word(rest);
        let found = number::<f64>(word).map(|number| number.value).filter(|value| value.abs() < 1e18);
        // Rust reads infinity and what is no number as numbers, too.
        if found.is_none() && word.parse::<f64>().is_err() || !numbers.is_empty() && is_there(rest) {
            break;
        }
        numbers.push(found);
        rest = after;
    }
    (numbers, rest)
}

/// The place of the first word that is an option's name, behind another word.
fn first_option(name: &str) -> Option<usize> {
    let place = |word: &str| word.as_ptr() as usize - name.as_ptr() as usize;
    let is_option = |word: &&str| OPTIONS.iter().any(|(option, _)| word.eq_ignore_ascii_case(option));
    words(name).skip(1).find(is_option).map(place)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The map, and what was mended.
    fn parse(written: &str, there: &[&str]) -> (TextureMap, Vec<String>) {
        let mut mends = Mends::default();
        let map = TextureMap::parse(written, 3, &|name| there.contains(&unquoted(name)), &mut mends);
        (map, mends.into_substitutes().into_iter().map(|mend| mend.what).collect())
    }

    #[test]
    fn options_stand_before_and_behind() {
        let expected = TextureMap {
            file: "my wood.png".to_owned(),
            scale: [2.0, 3.0],
            offset: [0.5, 0.0],
            clamp: true,
            bump: 0.25,
            range: [0.0, 2.0],
            space: Some(ColorSpace::Linear),
            channel: Some(Channel::G),
        };
        let options =
            "-s 2 3 1 -o 0.5 -clamp on -bm .25 -mm 0 2 -imfchan g -blendu off -blendv on -boost 2 -texres 512 -colorspace raw";
        for written in [
            format!("{options} my wood.png"),
            format!("my wood.png {options}"),
            format!("\"my wood.png\"\t{options} # a comment"),
            format!("{} my wood.png", options.to_ascii_uppercase()),
        ] {
            for there in [&["my wood.png"][..], &[]] {
                assert_eq!(parse(&written, there), (expected.clone(), vec![]), "{written}");
            }
        }
        let (map, _) = parse("-s 2 2 my wood.png -clamp on", &[]);
        assert_eq!((map.file.as_str(), map.scale, map.clamp), ("my wood.png", [2.0, 2.0], true));
    }

    #[test]
    fn names_may_look_like_options_numbers_and_comments() {
        for name in ["a -s 2.png", "-clamp", "wood #2.png", "a -bm 1", "7", "-s 2 wood.png"] {
            let (map, reported) = parse(name, &[name]);
            assert_eq!((map.file.as_str(), reported.len()), (name, 0), "{reported:?}");
        }
        assert_eq!(parse("-s 2 3 7", &["7"]).0.file, "7");
        assert_eq!(parse("wood #2.png", &[]).0.file, "wood");
    }

    #[test]
    fn an_odd_option_is_left_out_and_reported() {
        for (written, file) in [
            ("-nonsense 3 wood.png", "wood.png"),
            ("-s wood.png", "wood.png"),
            ("-s nan 1 wood.png", "wood.png"),
            ("-clamp wood.png", "wood.png"),
            ("-colorspace red wood.png", "wood.png"),
            ("-imfchan x wood.png", "wood.png"),
            ("-t 1 1 1 wood.png", "wood.png"),
            ("-cc on wood.png", "wood.png"),
            ("-type sphere wood.png", "wood.png"),
            ("wood.png -s", "wood.png"),
            ("-clamp on -bm", ""),
        ] {
            let (map, reported) = parse(written, &[]);
            assert_eq!((map.file.as_str(), reported.len()), (file, 1), "{written}: {reported:?}");
        }
    }
}
