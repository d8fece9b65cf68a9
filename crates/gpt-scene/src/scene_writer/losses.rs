//! The report of an export in the making.

use crate::scene::{ImportReport, LinkMask, Scene};

/// The parts of a scene that a format cannot say, with their places.
pub struct Losses {
    /// The scene, as reports call it.
    scene: String,
    report: ImportReport,
}

impl Losses {
    pub fn of(scene: &str) -> Self {
        Self { scene: scene.to_owned(), report: ImportReport::default() }
    }

    /// Notes what has no effect there.
    pub fn drop(&mut self, what: impl Into<String>, place: &str, instead: impl Into<String>) {
        self.report.drop(what, format!("{}: {place}", self.scene), instead);
    }

    /// Notes what something similar stands for there.
    pub fn approximate(&mut self, what: impl Into<String>, place: &str, instead: impl Into<String>) {
        self.report.approximate(what, format!("{}: {place}", self.scene), instead);
    }

    /// Notes the lamps that light some objects and not others: no other format says that.
    pub fn drop_links(&mut self, scene: &Scene) {
        let links = &scene.light_links;
        for (index, light) in scene.lights.iter().enumerate() {
            if links.of_light(index) != LinkMask::ALL {
                self.drop("light link", &format!("light[{index}] ({})", light.kind_name()), "it lights everything");
            }
        }
        for (id, material) in scene.materials.iter().enumerate() {
            if links.of_material(id) != LinkMask::ALL {
                self.drop("light link", &format!("material `{}`", material.name), "it lights everything");
            }
        }
    }

    pub fn into_report(self) -> ImportReport {
        self.report
    }
}
