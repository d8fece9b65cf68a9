//! Scenes of pbrt: what they say is in the scene, and what is wrong with them is told where it is.

mod lights;
mod looks;
mod mistakes;
mod shapes;

use std::ffi::OsStr;
use std::path::PathBuf;

use crate::load::{LoadOptions, SceneError, load_with};
use crate::scene::Scene;

/// A scene with one light; `MORE` is where what is tested stands.
const SCENE: &str = r#"# A scene.
Scale -1 1 1
LookAt 0 0 4  0 0 0  0 1 0
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 40 "integer yresolution" 30
Sampler "halton" "integer pixelsamples" 2
Integrator "volpath" "integer maxdepth" 3
WorldBegin
LightSource "point" "rgb I" [ 10 20 30 ] "point3 from" [ 1 2 3 ]
Material "diffuse" "rgb reflectance" [ 0.7 0.2 0.1 ]
MORE
"#;

struct Folder(tempfile::TempDir);

impl Folder {
    fn new(files: &[(&str, &[u8])]) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        for (name, content) in files {
            std::fs::write(folder.path().join(name), content).expect("it is written");
        }
        Self(folder)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn load(&self, name: &str) -> Result<Scene, SceneError> {
        load_with(Some(OsStr::new(&self.path(name))), &LoadOptions::default())
    }

    fn valid(&self, name: &str) -> Scene {
        self.load(name).unwrap_or_else(|error| panic!("{error}"))
    }
}

/// The scene with more in it.
fn read(more: &str) -> Result<Scene, SceneError> {
    Folder::new(&[("a.pbrt", SCENE.replace("MORE", more).as_bytes())]).load("a.pbrt")
}

fn valid(more: &str) -> Scene {
    read(more).unwrap_or_else(|error| panic!("{error}\n{more}"))
}

/// A whole scene.
fn whole(text: &str) -> Scene {
    Folder::new(&[("a.pbrt", text.as_bytes())]).valid("a.pbrt")
}

/// All that is not exact, as `what: instead`, without its places.
fn report(scene: &Scene) -> String {
    let report = &scene.import_report;
    let items = report.dropped.iter().chain(&report.approximated);
    items.map(|item| format!("{} x{}: {}\n", item.what, item.count, item.instead)).collect()
}
