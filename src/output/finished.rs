//! Tells whether a file is a finished picture of a certain render.

use std::io::Read;
use std::path::Path;

use exr::meta::attribute::{AttributeValue, Text};

use super::developed::software;
use super::format::PictureFormat;
use super::picture::is_finished;
use super::provenance::{COMPLETE_KEY, Entry, SAMPLES_KEY};
use super::read::{ReadPicture, read_picture};
use super::rows::Completeness;
use super::spec::{PartSpec, PictureSpec};
use super::{exr_file, hdr_file, jpeg_file, png_file};
use crate::input;
use crate::picture_file::open_exr::{self, DIGEST_KEY};

/// Entries of headers that do not decide what a picture shows.
const INCIDENTAL: [&str; 6] = ["gpt:version", "gpt:scene", "gpt:device", SAMPLES_KEY, COMPLETE_KEY, DIGEST_KEY];

/// Within so many bytes stands the line that says how a preview was made.
const LONGEST_START: u64 = 70_000;

/// True where a readable picture stands there that was made of the same scene with the same settings, whose render did not break off, and which holds what
/// was written, numbers all. The device does not matter.
pub fn is_finished_picture(path: &Path, format: PictureFormat, spec: &PictureSpec) -> bool {
    let size = [spec.width, spec.height];
    // In an EXR file, a part lies where it belongs in the whole picture.
    let (shown, origin) = match spec.part.or(spec.placed) {
        Some(PartSpec { film, origin }) if format == PictureFormat::Exr => (film, origin),
        _ => (size, [0, 0]),
    };
    let fits = |picture: ReadPicture| {
        let ReadPicture { image, notes, covered } = picture;
        let is_in_place = [image.width, image.height] == shown && covered == [origin[0], origin[1], size[0], size[1]];
        is_in_place && notes.is_empty() && image.pixels.as_flattened().iter().all(|value| value.is_finite())
    };
    path.is_file()
        && is_finished(path)
        && match format {
            PictureFormat::Exr => exr_agrees(path, spec) && holds_what_was_written(path),
            PictureFormat::Png => png_agrees(path, spec),
            PictureFormat::Jpeg | PictureFormat::Hdr => text_agrees(path, format, spec),
        }
        && read_picture(path).is_ok_and(fits)
}

/// The entries that decide what is shown.
fn decisive(spec: &PictureSpec) -> impl Iterator<Item = (&'static str, Entry)> {
    let entries = spec.header_entries(spec.samples_wanted(), Completeness::Finished);
    entries.into_iter().filter(|(key, _)| !INCIDENTAL.contains(key))
}

fn exr_agrees(path: &Path, spec: &PictureSpec) -> bool {
    let headers = input::open_to_decode(path).ok().and_then(|mut file| open_exr::headers(&mut file).ok());
    let Some(header) = headers.as_ref().and_then(|headers| headers.first()) else { return false };
    let mut channels = headers.iter().flatten().flat_map(|header| &header.channels.list);
    if channels.any(|channel| channel.name.eq("Remainder.R")) != spec.part.is_some() {
        return false;
    }
    let found: Vec<(&Text, &AttributeValue)> = header.own_attributes.other.iter().collect();
    let decisive = decisive(spec).map(|(key, entry)| (key, exr_file::attribute(entry)));
    let entries: Vec<_> = decisive.chain(exr_file::layers_entry(spec)).collect();
    let has = |(key, wanted): &(&str, AttributeValue)| found.iter().any(|(name, value)| name.eq(key) && *value == wanted);
    let is_known = |name: &Text| INCIDENTAL.iter().any(|key| name.eq(key)) || entries.iter().any(|(key, _)| name.eq(key));
    // An entry that this render has not, such as an error to reach, decides something too.
    entries.iter().all(has) && found.iter().all(|(name, _)| !name.to_string().starts_with("gpt:") || is_known(name))
}

fn holds_what_was_written(path: &Path) -> bool {
    input::open_to_decode(path).is_ok_and(|file| open_exr::check_digest(file) == Ok(true))
}

fn png_agrees(path: &Path, spec: &PictureSpec) -> bool {
    let Ok(file) = input::open(path) else { return false };
    let Ok(reader) = png::Decoder::new(file).read_info() else { return false };
    let mut texts = reader.info().utf8_text.iter().filter(|text| text.keyword == png_file::KEYWORD);
    let Some(Ok(found)) = texts.next().map(|text| text.get_text()) else { return false };
    is_of(&found, spec)
}

/// True if the line that previews carry is that of this render, whatever the device.
fn is_of(found: &str, spec: &PictureSpec) -> bool {
    let without_device = |text: &str| {
        let words = text.split("; ").filter(|word| !["device=", "scene="].iter().any(|key| word.contains(key)));
        words.filter(|word| !word.contains("version=")).map(str::to_owned).collect::<Vec<_>>()
    };
    without_device(found) == without_device(&software(spec))
}

/// Compares files that have that line near their beginning: a comment of a JPEG, or an entry of a Radiance
/// header.
fn text_agrees(path: &Path, format: PictureFormat, spec: &PictureSpec) -> bool {
    let mut start = Vec::new();
    let Ok(file) = input::open(path) else { return false };
    if file.take(LONGEST_START).read_to_end(&mut start).is_err() {
        return false;
    }
    let text = match format {
        PictureFormat::Jpeg => jpeg_file::comment(&start),
        _ => hdr_file::software_entry(&start),
    };
    text.and_then(|text| std::str::from_utf8(text).ok()).is_some_and(|text| is_of(text, spec))
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::film::Band;
    use crate::output::{PictureFile, Provenance};
    use crate::scene::{Filter, RenderSettings};

    fn spec(seed: u32, device: &str) -> PictureSpec {
        let provenance = Provenance {
            scene: "a scene".to_owned(),
            scene_hash: "0123".to_owned(),
            settings: RenderSettings { seed, ..RenderSettings::default() },
            filter: Filter::default(),
            first_sample: 0,
            target_error: None,
            adaptive: false,
            interval: None,
            device: device.to_owned(),
        };
        PictureSpec { width: 8, height: 4, provenance: Some(provenance), ..PictureSpec::default() }
    }

    #[test]
    fn only_a_finished_picture_of_the_same_render_is_one() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        for (name, format) in [
            ("a.exr", PictureFormat::Exr),
            ("a.png", PictureFormat::Png),
            ("a.jpg", PictureFormat::Jpeg),
            ("a.hdr", PictureFormat::Hdr),
        ] {
            let path = folder.path().join(name);
            let ours = spec(1, "a device");
            assert!(!is_finished_picture(&path, format, &ours), "there is none");
            for breaks_off in [true, false] {
                let mut file = PictureFile::create(&path, format, &ours).expect("a file");
                let mean = vec![[0.5; 3]; 32];
                let band = Band { width: 8, rows: 4, samples: 9, mean, ..Band::default() };
                file.write_band(&Arc::new(band)).expect("it is written");
                if breaks_off {
                    file.finish_broken_off().expect("it is finished");
                } else {
                    file.finish().expect("it is finished");
                }
                assert_eq!(is_finished_picture(&path, format, &ours), !breaks_off, "{name}");
            }
            assert!(is_finished_picture(&path, format, &spec(1, "another device")), "{name}");
            assert!(!is_finished_picture(&path, format, &spec(2, "a device")), "{name}: another seed");
            let larger = PictureSpec { width: 9, ..ours.clone() };
            assert!(!is_finished_picture(&path, format, &larger), "{name}: another size");
            let mut of_error = ours.clone();
            if let Some(provenance) = &mut of_error.provenance {
                provenance.target_error = Some(0.1);
            }
            assert!(!is_finished_picture(&path, format, &of_error), "{name}: an error to reach");
            let bytes = std::fs::read(&path).expect("the picture");
            std::fs::write(&path, &bytes[..bytes.len() - 40]).expect("it is cut");
            assert!(!is_finished_picture(&path, format, &ours), "{name}: cut off");
        }
    }
}
