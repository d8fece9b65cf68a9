//! Photometric files: IES LM-63 of 1986, 1991, 1995, 2002 and 2019, which lamps are sold with, commonly `.ies`.
//!
//! A file is a header of lines with labels, a line `TILT=…`, and numbers from there on. Only type C photometry is read.

use crate::scene::light::{LightProfile, MOST_ANGLES, ProfileFault, ProfileList};

/// Most bytes of a file.
pub const MOST_PROFILE_BYTES: u64 = 1 << 23;

/// A mistake in a file, and its line, counted from 1.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Mistake {
    pub line: usize,
    pub message: String,
}

/// A file that was read.
#[derive(Debug)]
pub struct Photometry {
    pub profile: LightProfile,
    /// Properties that it states and nothing uses, in sentences.
    pub notes: Vec<Mistake>,
}

/// Reads a file.
///
/// # Errors
/// The first mistake in it, or something that it has and that is not read: types A and B of photometry.
pub fn read(bytes: &[u8]) -> Result<Photometry, Mistake> {
    let text = String::from_utf8_lossy(bytes);
    let mut lines =
        (1..).zip(text.trim_start_matches('\u{feff}').split('\n').flat_map(|line| line.trim_end_matches('\r').split('\r')));
    let mut last = 1;
    let mut year = 1986;
    let tilt = loop {
        let Some((line, content)) = lines.next() else {
            return Err(mistake(
                last,
                "there is no line `TILT=NONE` or `TILT=INCLUDE`, so this is no photometric file (IES LM-63)",
            ));
        };
        if line == 1 {
            year = year_of(content).unwrap_or(year);
        }
        let content = content.trim();
        let is_tilt = content.get(..4).is_some_and(|start| start.eq_ignore_ascii_case("TILT"));
        if let Some(how) = content.get(4..).filter(|_| is_tilt).and_then(|rest| rest.trim_start().strip_prefix('=')) {
            break (line, how.trim().to_owned());
        }
        last = line;
    };
    let mut numbers = Numbers { words: lines.flat_map(words).collect::<Vec<_>>().into_iter(), line: tilt.0 };
    let mut notes = Vec::new();
    let (tilt_line, how) = tilt;
    if how.eq_ignore_ascii_case("INCLUDE") {
        let changes = skip_tilt(&mut numbers)?;
        if changes {
            notes.push(mistake(
                tilt_line,
                "its light changes with the tilt of the lamp, which is not used: it is that of a lamp without tilt",
            ));
        }
    } else if !how.eq_ignore_ascii_case("NONE") {
        let what = format!(
            "how its light changes with the tilt of the lamp is in the file `{how}`, which is not used: it is that of a lamp without tilt"
        );
        notes.push(mistake(tilt_line, what));
    }
    let profile = read_table(&mut numbers, year)?;
    let behind = numbers.words.len();
    if let Some((line, _)) = numbers.words.next() {
        notes.push(mistake(line, format!("behind the table of candela there are {behind} words more, which are not used")));
    }
    Ok(Photometry { profile, notes })
}

/// The file of a profile, by the standard of 2002.
pub fn written(profile: &LightProfile) -> String {
    let numbers = |values: &[f64]| values.iter().map(f64::to_string).collect::<Vec<_>>().join(" ");
    let [vertical, horizontal] = [profile.vertical(), profile.horizontal()];
    let planes: Vec<String> = profile.candela().chunks(vertical.len()).map(numbers).collect();
    format!(
        "IESNA:LM-63-2002\n[TEST] none\n[ISSUEDATE] none\n[MANUFAC] none\nTILT=NONE\n1 -1 1 {} {} 1 2 0 0 0\n1 1 0\n{}\n{}\n{}\n",
        vertical.len(),
        horizontal.len(),
        numbers(vertical),
        numbers(horizontal),
        planes.join("\n")
    )
}

/// Numbers, and what they say of the light.
fn read_table(numbers: &mut Numbers<'_>, year: u32) -> Result<LightProfile, Mistake> {
    numbers.number("the number of lamps")?;
    numbers.number("the lumens of a lamp")?;
    let multiplier = numbers.factor("the factor of candela")?;
    let rows = numbers.count("the number of vertical angles")?;
    let planes = numbers.count("the number of horizontal angles")?;
    match numbers.number("the type of photometry")? {
        1.0 => {}
        other => {
            let kind = match other {
                2.0 => "its photometry is of type B".to_owned(),
                3.0 => "its photometry is of type A".to_owned(),
                other => format!("its type of photometry is {other}, which is none"),
            };
            return Err(numbers.mistake(format!("{kind}: only type C, number 1, is read")));
        }
    }
    numbers.number("the unit of lengths")?;
    for what in ["the width of the lamp", "the length of the lamp", "the height of the lamp"] {
        numbers.number(what)?;
    }
    let ballast = numbers.factor("the ballast factor")?;
    // Files of 2002 have 1 for future use here, those of 2019 the number of how they were made.
    let what = "the number behind the ballast factor";
    let of_lamp_and_ballast = if year <= 1995 { numbers.factor(what)? } else { numbers.number(what).map(|_| 1.0)? };
    numbers.number("the input watts")?;
    let factor = multiplier * ballast * of_lamp_and_ballast;
    let vertical = numbers.list(rows, "vertical angle")?;
    let horizontal = numbers.list(planes, "horizontal angle")?;
    let candela = numbers.list(rows * planes, "candela")?;
    let line_of = |ProfileFault { list, index, .. }: &ProfileFault| {
        let list = match list {
            ProfileList::Vertical => &vertical,
            ProfileList::Horizontal => &horizontal,
            ProfileList::Candela => &candela,
        };
        list.lines[*index]
    };
    let scaled = candela.values.iter().map(|value| value * factor).collect();
    LightProfile::new(vertical.values.clone(), horizontal.values.clone(), scaled)
        .map_err(|fault| Mistake { line: line_of(&fault), message: fault.message })
}

/// Goes past the factors by tilt; true where one is not 1.
fn skip_tilt(numbers: &mut Numbers<'_>) -> Result<bool, Mistake> {
    numbers.number("how the lamp lies (behind TILT=INCLUDE)")?;
    let count = numbers.count("the number of angles of tilt")?;
    numbers.list(count, "angle of tilt")?;
    let factors = numbers.list(count, "factor of a tilt")?;
    Ok(factors.values.iter().any(|factor| *factor != 1.0))
}

/// The year of the standard that a first line names; None of one that names none, which those of 1986 are.
fn year_of(first_line: &str) -> Option<u32> {
    let line = first_line.trim();
    if !line.get(..3)?.eq_ignore_ascii_case("IES") {
        return None;
    }
    let digits: String = line.chars().rev().take_while(char::is_ascii_digit).collect::<Vec<_>>().into_iter().rev().collect();
    match digits.parse::<u32>().ok()? {
        // IESNA91, and LM-63-95 as some write it.
        short @ 86..=99 => Some(1900 + short),
        short @ 0..=85 => Some(2000 + short),
        year => Some(year),
    }
}

fn mistake(line: usize, message: impl Into<String>) -> Mistake {
    Mistake { line, message: message.into() }
}

/// The words of a line, which blanks and commas part.
fn words((line, content): (usize, &str)) -> impl Iterator<Item = (usize, &str)> {
    content
        .split(|c: char| c.is_whitespace() || c == ',' || c == '\0')
        .filter(|word| !word.is_empty())
        .map(move |word| (line, word))
}

/// The numbers behind the header, whatever lines they stand in.
struct Numbers<'t> {
    words: std::vec::IntoIter<(usize, &'t str)>,
    /// Line of the last word.
    line: usize,
}

/// Numbers, and the line of each.
struct List {
    values: Vec<f64>,
    lines: Vec<usize>,
}

impl Numbers<'_> {
    fn mistake(&self, message: impl Into<String>) -> Mistake {
        mistake(self.line, message)
    }

    fn number(&mut self, what: &str) -> Result<f64, Mistake> {
        let Some((line, word)) = self.words.next() else {
            return Err(self.mistake(format!("the file ends before {what}")));
        };
        self.line = line;
        let number = word.parse::<f64>().ok().filter(|number| number.is_finite());
        number.ok_or_else(|| self.mistake(format!("expected {what}, found `{word}`")))
    }

    fn factor(&mut self, what: &str) -> Result<f64, Mistake> {
        let factor = self.number(what)?;
        if factor > 0.0 { Ok(factor) } else { Err(self.mistake(format!("{what} is {factor}, and must be above 0"))) }
    }

    fn count(&mut self, what: &str) -> Result<usize, Mistake> {
        let count = self.number(what)?;
        let possible = count.fract() == 0.0 && (1.0..=MOST_ANGLES as f64).contains(&count);
        if possible {
            Ok(count as usize)
        } else {
            Err(self.mistake(format!("{what} is {count}, and must be from 1 to {MOST_ANGLES}")))
        }
    }

    /// Takes no more memory than the file has words for.
    fn list(&mut self, count: usize, what: &str) -> Result<List, Mistake> {
        let left = self.words.len();
        if left < count {
            return Err(self.mistake(format!("expected {count} numbers, one for each {what}, and the file ends after {left}")));
        }
        let mut list = List { values: Vec::with_capacity(count), lines: Vec::with_capacity(count) };
        for number in 1..=count {
            list.values.push(self.number(&format!("{what} {number} of {count}"))?);
            list.lines.push(self.line);
        }
        Ok(list)
    }
}

#[cfg(test)]
mod tests;
