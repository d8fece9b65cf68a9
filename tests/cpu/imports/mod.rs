//! Scenes of other programs: what they say is what a scene file of ours says, and what is wrong with them is told in one sentence.

mod bending;
mod gltf;
mod mitsuba;
mod mtl;
mod pbrt;
mod shared_parts;
mod within;

use std::ffi::OsStr;
use std::fs;
use std::path::PathBuf;

use gpt::load::{LoadOptions, SceneError, load_with};
use gpt::scene::Scene;
use gpt::{DeviceChoice, Render, RenderOptions};

/// A folder with files.
struct Folder(tempfile::TempDir);

impl Folder {
    fn new(files: &[(&str, &[u8])]) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        for (name, content) in files {
            fs::write(folder.path().join(name), content).expect("it is written");
        }
        Self(folder)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn load(&self, name: &str) -> Result<Scene, SceneError> {
        self.load_as(name, &LoadOptions::default())
    }

    fn load_as(&self, name: &str, options: &LoadOptions) -> Result<Scene, SceneError> {
        load_with(Some(OsStr::new(&self.path(name))), options)
    }

    fn valid(&self, name: &str) -> Scene {
        self.load(name).unwrap_or_else(|error| panic!("{error}"))
    }

    /// Writes the import as a scene file and reads that.
    fn written(&self, name: &str) -> Scene {
        let target = self.path("written.toml");
        gpt::scene_writer::save_scene(&self.valid(name), &target).unwrap_or_else(|error| panic!("{error}"));
        self.valid("written.toml")
    }
}

/// A small picture by the reference, as bits.
fn picture(scene: &Scene) -> Vec<[u32; 3]> {
    let options = RenderOptions { device: DeviceChoice::Cpu, size: Some([12, 9]), samples: Some(2), ..RenderOptions::default() };
    let image = scene.render(&options).unwrap_or_else(|error| panic!("{error}"));
    image.pixels().iter().map(|pixel| pixel.map(f32::to_bits)).collect()
}

/// The message of what is refused.
fn refusal(result: Result<Scene, SceneError>) -> String {
    match result {
        Ok(_) => panic!("it is read"),
        Err(error) => error.to_string(),
    }
}

/// All that is not exact, as `what: instead`.
fn report(scene: &Scene) -> String {
    let report = &scene.import_report;
    let items = report.dropped.iter().chain(&report.approximated);
    items.map(|item| format!("{} x{}: {}\n", item.what, item.count, item.instead)).collect()
}
