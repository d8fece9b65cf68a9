//! Files of places: where many instances of one group stand.

use std::path::Path;

use glam::DAffine3;

/// Numbers of a place: a matrix of three rows and four columns, row by row.
pub const PLACE_NUMBERS: usize = 12;

/// How the numbers of a file are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PlaceFormat {
    /// Little-endian.
    Single,
    Double,
    /// A line for each place.
    Text,
}

impl PlaceFormat {
    /// By the ending of a file's name.
    pub fn of(path: &Path) -> Option<Self> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "f32" => Some(Self::Single),
            "f64" => Some(Self::Double),
            "csv" | "txt" => Some(Self::Text),
            _ => None,
        }
    }

    /// All numbers of a file, a multiple of [`PLACE_NUMBERS`].
    ///
    /// # Errors
    /// A sentence about the mistake in the file.
    pub fn numbers(self, bytes: &[u8]) -> Result<Vec<f64>, String> {
        let numbers: Vec<f64> = match self {
            Self::Single => {
                whole(bytes, 4)?;
                bytes.as_chunks().0.iter().map(|number| f32::from_le_bytes(*number).into()).collect()
            }
            Self::Double => {
                whole(bytes, 8)?;
                bytes.as_chunks().0.iter().map(|number| f64::from_le_bytes(*number)).collect()
            }
            Self::Text => of_lines(bytes)?,
        };
        if numbers.is_empty() { Err("it holds no places".to_owned()) } else { Ok(numbers) }
    }
}

fn whole(bytes: &[u8], size: usize) -> Result<(), String> {
    let place = PLACE_NUMBERS * size;
    if bytes.len().is_multiple_of(place) {
        return Ok(());
    }
    Err(format!(
        "a place takes {place} bytes, {PLACE_NUMBERS} numbers of {size}, and the file has {}: no multiple of that",
        bytes.len()
    ))
}

fn of_lines(bytes: &[u8]) -> Result<Vec<f64>, String> {
    let text = std::str::from_utf8(bytes).map_err(|_| "it is no text in UTF-8".to_owned())?;
    let mut numbers = Vec::new();
    for (index, line) in text.lines().enumerate() {
        let line = line.split('#').next().unwrap_or_default();
        let before = numbers.len();
        for word in line.split([',', ';', ' ', '\t']).filter(|word| !word.is_empty()) {
            let number = word
                .parse::<f64>()
                .map_err(|_| format!("line {}: `{}` is no number", index + 1, crate::load::printable(word)))?;
            numbers.push(number);
        }
        let count = numbers.len() - before;
        if count != 0 && count != PLACE_NUMBERS {
            return Err(format!("line {}: a place has {PLACE_NUMBERS} numbers, this line {count}", index + 1));
        }
    }
    Ok(numbers)
}

/// The places as a file in double precision, which comes back bit for bit.
pub fn write_places(places: &[DAffine3]) -> Vec<u8> {
    places.iter().flat_map(place_rows).flat_map(f64::to_le_bytes).collect()
}

/// The numbers of a place, row by row.
pub fn place_rows(place: &DAffine3) -> [f64; PLACE_NUMBERS] {
    let row =
        |row: usize| [place.matrix3.x_axis[row], place.matrix3.y_axis[row], place.matrix3.z_axis[row], place.translation[row]];
    let [a, b, c] = [row(0), row(1), row(2)];
    [a[0], a[1], a[2], a[3], b[0], b[1], b[2], b[3], c[0], c[1], c[2], c[3]]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_come_back_from_each_format() {
        let place = DAffine3::from_cols_array(&[1.0, 0.25, 0.0, 0.5, 2.0, -1.0, 0.125, 0.0, 4.0, 10.0, 20.0, -30.0]);
        let rows = place_rows(&place);
        assert_eq!(rows, [1.0, 0.5, 0.125, 10.0, 0.25, 2.0, 0.0, 20.0, 0.0, -1.0, 4.0, -30.0]);
        assert_eq!(PlaceFormat::Double.numbers(&write_places(&[place])), Ok(rows.to_vec()));
        let single: Vec<u8> = rows.iter().flat_map(|&number| (number as f32).to_le_bytes()).collect();
        assert_eq!(PlaceFormat::Single.numbers(&single), Ok(rows.to_vec()));
        let text = "# of one tree\n1, 0.5, 0.125, 10, 0.25 2 0 20\t0;-1;4,-3e1\n\n";
        assert_eq!(PlaceFormat::Text.numbers(text.as_bytes()), Ok(rows.to_vec()));
    }

    #[test]
    fn what_is_no_place_is_named() {
        let message = |format: PlaceFormat, bytes: &[u8]| format.numbers(bytes).err().unwrap_or_default();
        assert!(message(PlaceFormat::Single, &[0; 47]).contains("48 bytes"));
        assert!(message(PlaceFormat::Double, &[0; 97]).contains("96 bytes"));
        assert!(message(PlaceFormat::Text, b"1 2 3").contains("line 1: a place has 12 numbers, this line 3"));
        assert!(message(PlaceFormat::Text, b"\n1 x").contains("line 2: `x` is no number"));
        assert!(message(PlaceFormat::Text, &[0xff]).contains("UTF-8"));
        assert!(message(PlaceFormat::Single, b"").contains("no places"));
    }
}
