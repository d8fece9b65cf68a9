//! The header of a JPEG file.

use std::io::{Read, Result, Seek, SeekFrom};

/// How many components a pixel has; None where the file has no frame.
pub fn components(file: &mut (impl Read + Seek)) -> Result<Option<u8>> {
    let mut start = [0; 2];
    if file.read_exact(&mut start).is_err() || start != [0xff, 0xd8] {
        return Ok(None);
    }
    loop {
        let mut segment = [0; 4];
        if file.read_exact(&mut segment).is_err() || segment[0] != 0xff {
            return Ok(None);
        }
        let length = u16::from_be_bytes([segment[2], segment[3]]);
        match segment[1] {
            // Frames of all kinds; the codes between them are of tables.
            0xc0..=0xcf if !matches!(segment[1], 0xc4 | 0xc8 | 0xcc) => {
                let mut frame = [0; 6];
                return Ok(file.read_exact(&mut frame).is_ok().then_some(frame[5]));
            }
            0xda => return Ok(None),
            _ => {
                file.seek(SeekFrom::Current(i64::from(length.max(2)) - 2))?;
            }
        }
    }
}
