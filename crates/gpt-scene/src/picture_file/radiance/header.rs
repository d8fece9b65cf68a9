//! The text before the pixels of a Radiance picture.

use std::io::BufRead;

use glam::{DMat3, DVec3};

use crate::picture_file::primaries::Primaries;

/// Most bytes of a header.
const LONGEST: usize = 1 << 20;
/// Lumens of a watt of white light, by which Radiance goes from X, Y and Z, in lm/sr/m², to radiance.
const EFFICACY: f64 = 179.0;
/// Radiance's own white, that of equal energy.
const EQUAL_ENERGY: [f64; 2] = [1.0 / 3.0, 1.0 / 3.0];

/// An axis of the picture, and whether the file goes along it towards greater coordinates, which are to the right and upwards.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Axis {
    is_x: bool,
    increases: bool,
    length: u32,
}

/// In which order pixels stand: scan lines follow the first axis, and pixels of one the second.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Resolution {
    slow: Axis,
    fast: Axis,
}

impl Resolution {
    fn parse(line: &str) -> Option<Self> {
        let words: Vec<&str> = line.split_whitespace().collect();
        let [slow_name, slow_length, fast_name, fast_length] = words[..] else { return None };
        let axis = |name: &str, length: &str| {
            let (sign, axis) = name.split_at_checked(1)?;
            let is_x = match axis {
                "X" | "x" => true,
                "Y" | "y" => false,
                _ => return None,
            };
            let increases = match sign {
                "+" => true,
                "-" => false,
                _ => return None,
            };
            Some(Axis { is_x, increases, length: length.parse().ok()? })
        };
        let (slow, fast) = (axis(slow_name, slow_length)?, axis(fast_name, fast_length)?);
        (slow.is_x != fast.is_x).then_some(Self { slow, fast })
    }

    /// Scan lines, and pixels of one.
    pub fn scan_lines(&self) -> [u32; 2] {
        [self.slow.length, self.fast.length]
    }

    /// Width and height of the picture.
    pub fn size(&self) -> [u32; 2] {
        if self.slow.is_x { [self.slow.length, self.fast.length] } else { [self.fast.length, self.slow.length] }
    }

    /// Column and row, from the top, of a pixel of a scan line.
    pub fn place(&self, line: u32, pixel: u32) -> [usize; 2] {
        let mut place = [0; 2];
        for (axis, at) in [(self.slow, line), (self.fast, pixel)] {
            // Coordinates grow upwards, and rows downwards.
            let is_forward = axis.increases == axis.is_x;
            place[usize::from(!axis.is_x)] = if is_forward { at } else { axis.length - 1 - at } as usize;
        }
        place
    }

    /// Scan lines go from the top, and their pixels from the left.
    pub fn is_usual(&self) -> bool {
        !self.slow.is_x && !self.slow.increases && self.fast.increases
    }
}

/// The statements of the header.
#[derive(Debug, Clone, PartialEq)]
pub struct RadianceHeader {
    pub resolution: Resolution,
    /// By which colours of the file become linear Rec. 709; None: they are that.
    pub matrix: Option<DMat3>,
    /// True if the header states a view, as Radiance's own renders do.
    pub has_view: bool,
    pub notes: Vec<String>,
}

impl RadianceHeader {
    /// Reads the header and the line of the resolution.
    ///
    /// # Errors
    /// Why it is none.
    pub fn read(file: &mut dyn BufRead) -> Result<Self, String> {
        let mut room = LONGEST;
        let mut notes = Vec::new();
        let (mut factors, mut aspect) = (DVec3::ONE, 1.0);
        let (mut primaries, mut is_xyz, mut has_view) = (None, false, false);
        let mut is_first = true;
        loop {
            let line = read_line(file, &mut room)?;
            if line.is_empty() && !is_first {
                break;
            }
            // A file without the blank line has no end of its header but this.
            is_first = false;
            let Some((key, value)) = line.split_once('=') else { continue };
            let numbers = || value.split_whitespace().map(str::parse).collect::<Result<Vec<f64>, _>>().unwrap_or_default();
            let mut factor = |of: DVec3| {
                if of.is_finite() && of.min_element() > 0.0 {
                    factors *= of;
                    true
                } else {
                    false
                }
            };
            let is_used = match (key, &numbers()[..]) {
                ("FORMAT", _) => match value.trim() {
                    "32-bit_rle_rgbe" => true,
                    "32-bit_rle_xyze" => {
                        is_xyz = true;
                        true
                    }
                    other => {
                        return Err(format!("is a Radiance file of the format `{other}`, which is no picture that is read here"));
                    }
                },
                ("EXPOSURE", [exposure]) => factor(DVec3::splat(*exposure)),
                ("COLORCORR", [red, green, blue]) => factor(DVec3::new(*red, *green, *blue)),
                ("PRIMARIES", [red_x, red_y, green_x, green_y, blue_x, blue_y, white_x, white_y]) => {
                    let given = Primaries::new([*red_x, *red_y], [*green_x, *green_y], [*blue_x, *blue_y], [*white_x, *white_y]);
                    primaries = given.to_xyz().map(|_| given).or(primaries);
                    primaries == Some(given)
                }
                ("PIXASPECT", [ratio]) if *ratio > 0.0 => {
                    aspect *= ratio;
                    true
                }
                ("GAMMA", [gamma]) if (gamma - 1.0).abs() < 1e-6 => true,
                ("EXPOSURE" | "COLORCORR" | "PRIMARIES" | "PIXASPECT" | "GAMMA", _) => false,
                ("VIEW", _) => {
                    has_view = true;
                    true
                }
                _ => true,
            };
            if !is_used {
                notes.push(format!("its header's {key} is `{}`, which is not used", value.trim()));
            }
        }
        if (aspect - 1.0_f64).abs() > 1e-3 {
            notes.push(format!("its header's PIXASPECT is {aspect}, which is not used: pixels are taken for squares"));
        }
        let line = read_line(file, &mut room)?;
        let resolution = Resolution::parse(&line)
            .ok_or_else(|| format!("is a Radiance file whose line of the resolution is `{line}`, and not as `-Y 480 +X 640`"))?;
        Ok(Self { resolution, matrix: matrix(factors, primaries, is_xyz), has_view, notes })
    }
}

/// From the file's numbers to radiance, in linear Rec. 709.
fn matrix(factors: DVec3, primaries: Option<Primaries>, is_xyz: bool) -> Option<DMat3> {
    // White is what Radiance takes for white, also where colours are X, Y and Z.
    let (points, scale) = match primaries {
        _ if is_xyz => {
            let white = primaries.map_or(EQUAL_ENERGY, |primaries| primaries.white.to_array());
            (Primaries { white: EQUAL_ENERGY.into(), ..Primaries::XYZ }, Some((white, 1.0 / EFFICACY)))
        }
        Some(primaries) => (primaries, None),
        // Radiance's own are near those of Rec. 709, for which everyone takes them.
        None => (Primaries::REC_709, None),
    };
    let neutral = scale.map(|(white, _)| white.into());
    let convert = points.to_rec_709(neutral).flatten();
    if convert.is_none() && factors == DVec3::ONE {
        return None;
    }
    let scale = scale.map_or(1.0, |(_, scale)| scale);
    Some(convert.unwrap_or(DMat3::IDENTITY) * DMat3::from_diagonal(scale / factors))
}

/// A line without its end, which may be LF, CR LF or CR LF's other half alone.
fn read_line(file: &mut dyn BufRead, room: &mut usize) -> Result<String, String> {
    let mut bytes = Vec::new();
    loop {
        let buffer = file.fill_buf().map_err(|error| format!("cannot be read: {error}"))?;
        if buffer.is_empty() {
            return Err("is a Radiance file whose header does not end".to_owned());
        }
        let end = buffer.iter().position(|byte| *byte == b'\n');
        let taken = end.map_or(buffer.len(), |end| end + 1);
        bytes.extend_from_slice(&buffer[..taken]);
        file.consume(taken);
        *room = room.checked_sub(taken).ok_or("is a Radiance file whose header does not end")?;
        if end.is_some() {
            break;
        }
    }
    while matches!(bytes.last(), Some(b'\n' | b'\r')) {
        bytes.pop();
    }
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(header: &str) -> Result<RadianceHeader, String> {
        RadianceHeader::read(&mut header.as_bytes())
    }

    #[test]
    fn all_orientations_say_where_pixels_lie() {
        // The second pixel of the first scan line, and the first of the second one, of 3 columns and 2 rows.
        for (line, size, second, next) in [
            ("-Y 2 +X 3", [3, 2], [1, 0], [0, 1]),
            ("-Y 2 -X 3", [3, 2], [1, 0], [2, 1]),
            ("+Y 2 -X 3", [3, 2], [1, 1], [2, 0]),
            ("+Y 2 +X 3", [3, 2], [1, 1], [0, 0]),
            ("+X 3 +Y 2", [3, 2], [0, 0], [1, 1]),
            ("-X 3 +Y 2", [3, 2], [2, 0], [1, 1]),
            ("-X 3 -Y 2", [3, 2], [2, 1], [1, 0]),
            ("+X 3 -Y 2", [3, 2], [0, 1], [1, 0]),
        ] {
            let resolution = Resolution::parse(line).expect(line);
            assert_eq!((resolution.size(), resolution.place(0, 1), resolution.place(1, 0)), (size, second, next), "{line}");
            assert_eq!(resolution.is_usual(), line == "-Y 2 +X 3");
        }
        for wrong in ["", "-Y 2 +Y 3", "-Y 2", "2 3", "-Y a +X 3", "*Y 2 +X 3", "-Y -2 +X 3"] {
            assert_eq!(Resolution::parse(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn exposures_multiply_and_lines_may_end_as_on_windows() {
        let header = "#?RADIANCE\r\nEXPOSURE=2\r\n\tEXPOSURE=7\r\nFORMAT=32-bit_rle_rgbe\r\nEXPOSURE= 4\r\nCOLORCORR= 1 .5 2\r\n\r\n-Y 2 +X 3\r\n";
        let header = read(header).expect("a header");
        let found = header.matrix.expect("factors") * DVec3::splat(16.0);
        assert!((found - DVec3::new(2.0, 4.0, 1.0)).abs().max_element() < 1e-12 && header.notes.is_empty(), "{header:?}");
        assert_eq!(read("#?RGBE\n\n-Y 1 +X 1\n").expect("a header").matrix, None);
    }

    #[test]
    fn what_is_not_used_is_named_and_other_formats_are_refused() {
        let header =
            read("#?RADIANCE\nEXPOSURE=0\nGAMMA=2.2\nPIXASPECT=2\nPRIMARIES=1 2\nVIEW= -vta\n\n-Y 1 +X 1\n").expect("a header");
        assert!(header.has_view && header.matrix.is_none());
        for key in ["EXPOSURE", "GAMMA", "PIXASPECT", "PRIMARIES"] {
            assert_eq!(header.notes.iter().filter(|note| note.contains(key)).count(), 1, "{:?}", header.notes);
        }
        for wrong in ["#?RADIANCE\nFORMAT=Spectral\n\n-Y 1 +X 1\n", "#?RADIANCE\n", "#?RADIANCE\n\n3 4\n"] {
            assert!(read(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn tristimulus_values_become_radiance() {
        let white =
            read("#?RADIANCE\nFORMAT=32-bit_rle_xyze\nEXPOSURE=2\n\n-Y 1 +X 1\n").expect("a header").matrix.expect("a matrix");
        let found = white * DVec3::splat(2.0 * 179.0);
        assert!((found - DVec3::ONE).abs().max_element() < 1e-3, "{found}");
        // BT.2020 by its primaries, whose red is beyond Rec. 709's.
        let wide = read("#?RADIANCE\nPRIMARIES= .708 .292 .17 .797 .131 .046 .3127 .329\n\n-Y 1 +X 1\n").expect("a header");
        let red = wide.matrix.expect("a matrix") * DVec3::X;
        assert!((red - DVec3::new(1.6605, -0.1246, -0.0182)).abs().max_element() < 1e-3, "{red}");
    }
}
