//! Common parts of previews: rows of 8-bit colours, and a line that says how they were made.

use std::io::{BufReader, BufWriter, Read, Seek, Write};

use super::display::{Developer, Exposure, Meter};
use super::provenance::{BROKEN_OFF_KEY, COMPLETE_KEY, Entry, SAMPLES_KEY};
use super::rows::{Abandoned, Completeness, Rows};
use super::spec::PictureSpec;
use super::temporary::{in_temporary_folder, temporary_file};

/// Hands over the picture's rows as sRGB, three bytes a pixel, from the top; then waits until the render is over. Automatic exposure has to
/// see the whole picture first, which waits in a temporary file, not in memory. Errors are sentences.
pub(super) fn developed_rows(
    mut rows: Rows,
    spec: &PictureSpec,
    mut each: impl FnMut(&[u8]) -> Result<(), String>,
) -> Result<Completeness, String> {
    let mut bytes = Vec::with_capacity(spec.width as usize * 3);
    let mut develop = |row: &[[f32; 3]], developer: &Developer| {
        bytes.clear();
        bytes.extend(row.iter().flat_map(|&pixel| developer.bytes(pixel)));
        each(&bytes)
    };
    if spec.display.exposure != Exposure::Auto {
        let developer = Developer::new(&spec.display, &Meter::default());
        for _ in 0..spec.height {
            develop(rows.next_row().map_err(abandoned)?.mean, &developer)?;
        }
        return rows.wait_for_finish().map_err(abandoned);
    }
    let in_words = |error: std::io::Error| error.to_string();
    let mut meter = Meter::default();
    let mut waiting = BufWriter::new(temporary_file().map_err(in_words)?);
    for _ in 0..spec.height {
        let row = rows.next_row().map_err(abandoned)?.mean;
        meter.add(row);
        waiting.write_all(bytemuck::cast_slice(row)).map_err(in_temporary_folder).map_err(in_words)?;
    }
    let completeness = rows.wait_for_finish().map_err(abandoned)?;
    let developer = Developer::new(&spec.display, &meter);
    let mut file = waiting.into_inner().map_err(|error| error.to_string())?;
    file.rewind().map_err(in_words)?;
    let mut waiting = BufReader::new(file);
    let mut row = vec![[0.0; 3]; spec.width as usize];
    for _ in 0..spec.height {
        waiting.read_exact(bytemuck::cast_slice_mut(&mut row)).map_err(in_words)?;
        develop(&row, &developer)?;
    }
    Ok(completeness)
}

/// The picture's provenance as one line, since a preview has no typed header, and how it is shown. Sample counts are left out: they are
/// only known once the header is written.
pub(super) fn software(spec: &PictureSpec) -> String {
    let entries = spec.header_entries(spec.samples_wanted(), Completeness::Finished);
    let wanted = entries.iter().filter(|(key, _)| !matches!(*key, SAMPLES_KEY | COMPLETE_KEY | BROKEN_OFF_KEY));
    let words: Vec<_> = wanted
        .map(|(key, entry)| match entry {
            Entry::Text(text) => format!("{}={text}", key.trim_start_matches("gpt:")),
            Entry::Number(number) => format!("{}={number}", key.trim_start_matches("gpt:")),
        })
        .chain([spec.display.to_string()])
        .collect();
    format!("gpt {}", words.join("; ")).trim_end().to_owned()
}

pub(super) fn abandoned(_: Abandoned) -> String {
    "the render broke off".to_owned()
}
