//! `gpt referee export`.

use std::path::{Path, PathBuf};

use gpt::output::AtomicFile;
use gpt::referee::suite::{LICENCE, VERSION};
use gpt::referee::{Test, Truth, TruthPicture};
use serde::Serialize;
use serde_json::Value;
use sha2::{Digest, Sha256};

use super::arguments::{ExportSuiteArguments, SceneForm};
use super::chosen::chosen;
use crate::cli::exit::{Exit, Failure};
use crate::cli::terminal;

/// The JSON beside each test.
#[derive(Serialize)]
struct TestFile<'a> {
    suite: &'static str,
    name: &'a str,
    about: &'a str,
    decides: &'a str,
    truth: &'static str,
    true_picture: &'static str,
    /// The scene file's tables: camera, film, lights, materials, shapes.
    scene: Value,
    forms: Vec<Form>,
    mistakes: Vec<&'static str>,
}

#[derive(Serialize)]
struct Form {
    file: &'static str,
    /// Parts that this form cannot say: then it is not to be judged by it.
    left_out: Vec<String>,
}

#[derive(Serialize)]
struct SuiteFile<'a> {
    suite: &'static str,
    licence: &'static str,
    units: &'static str,
    tests: Vec<&'a str>,
}

/// Writes the suite. Two exports are equal byte for byte.
pub fn run(arguments: &ExportSuiteArguments) -> Result<Exit, Failure> {
    let tests = chosen(&arguments.tests)?;
    let folder = &arguments.folder;
    if folder.exists() && std::fs::read_dir(folder).is_ok_and(|mut entries| entries.next().is_some()) {
        return Err(Failure::usage(format!("{} is not empty: name a folder that does not exist yet", folder.display())));
    }
    for test in &tests {
        write_test(test, &folder.join(test.name))?;
    }
    let suite = SuiteFile {
        suite: VERSION,
        licence: LICENCE,
        units: "linear Rec.709 radiance; lengths in scene units; a box filter of one pixel",
        tests: tests.iter().map(|test| test.name).collect(),
    };
    write(&folder.join("suite.json"), pretty(&suite)?.as_bytes())?;
    write(&folder.join("SHA256SUMS"), checksums(folder)?.as_bytes())?;
    terminal::answer(&format!("{} tests are in {}\n", tests.len(), folder.display()))?;
    Ok(Exit::Done)
}

fn write_test(test: &Test, folder: &Path) -> Result<(), Failure> {
    let mut forms = Vec::new();
    for form in SceneForm::ALL {
        let written = form.write(test, folder)?;
        forms.push(Form { file: form.file_name(), left_out: written.left_out });
    }
    let truth = test.true_picture().map_err(Failure::Other)?;
    write(&folder.join("truth.exr"), &exr_of(&truth)?)?;
    let tables: toml::Table = test.scene.parse().map_err(|error: toml::de::Error| Failure::Other(error.to_string()))?;
    let file = TestFile {
        suite: VERSION,
        name: test.name,
        about: test.about,
        decides: test.decides,
        truth: match test.truth {
            Truth::Formula(_) => "a formula, averaged over each pixel",
            Truth::Shipped => "long renders; the layer `error` holds the standard error of each pixel",
        },
        true_picture: "truth.exr",
        scene: serde_json::to_value(tables).map_err(|error| Failure::Other(error.to_string()))?,
        forms,
        mistakes: test.variants.iter().map(|variant| variant.cause).collect(),
    };
    write(&folder.join("test.json"), pretty(&file)?.as_bytes())
}

fn pretty(value: &impl Serialize) -> Result<String, Failure> {
    serde_json::to_string_pretty(value).map(|text| text + "\n").map_err(|error| Failure::Other(error.to_string()))
}

fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    AtomicFile::write(path, bytes).map_err(Failure::from)
}

/// Means as R, G and B, and their standard errors as the layer `error`.
fn exr_of(truth: &TruthPicture) -> Result<Vec<u8>, Failure> {
    use exr::prelude::*;
    let channel = |name: &str, pixels: &[[f32; 3]], index: usize| {
        AnyChannel::new(name, FlatSamples::F32(pixels.iter().map(|pixel| pixel[index]).collect()))
    };
    let channels = AnyChannels::sort(
        [
            channel("R", &truth.mean, 0),
            channel("G", &truth.mean, 1),
            channel("B", &truth.mean, 2),
            channel("error.R", &truth.standard_errors, 0),
            channel("error.G", &truth.standard_errors, 1),
            channel("error.B", &truth.standard_errors, 2),
        ]
        .into_iter()
        .collect(),
    );
    let size = (truth.width as usize, truth.height as usize);
    let image = Image::from_layer(Layer::new(size, LayerAttributes::default(), Encoding::SMALL_LOSSLESS, channels));
    let mut bytes = std::io::Cursor::new(Vec::new());
    image.write().non_parallel().to_buffered(&mut bytes).map_err(|error| Failure::Other(error.to_string()))?;
    Ok(bytes.into_inner())
}

/// Digests of all files, in the order of their paths, as `sha256sum --check` reads them.
fn checksums(folder: &Path) -> Result<String, Failure> {
    let mut files = Vec::new();
    collect(folder, &mut files)?;
    files.sort();
    let mut text = String::new();
    for path in files {
        let bytes = std::fs::read(&path).map_err(|error| Failure::Other(format!("{}: {error}", path.display())))?;
        let relative = path.strip_prefix(folder).unwrap_or(&path);
        let digest: String = Sha256::digest(&bytes).iter().map(|byte| format!("{byte:02x}")).collect();
        text += &format!("{digest}  {}\n", relative.display());
    }
    Ok(text)
}

fn collect(folder: &Path, files: &mut Vec<PathBuf>) -> Result<(), Failure> {
    let failed = |error: std::io::Error| Failure::Other(format!("{}: {error}", folder.display()));
    for entry in std::fs::read_dir(folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        if path.is_dir() { collect(&path, files)? } else { files.push(path) }
    }
    Ok(())
}
