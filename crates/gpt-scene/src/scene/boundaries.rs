//! Media whose boundaries cannot be what was meant.

use super::material::Material;
use super::medium::MediumId;
use super::model::Scene;
use super::shape::{Enclosure, Shape};

impl Scene {
    /// Sentences about media that are nowhere, and about surfaces behind which a medium begins and never ends.
    pub fn boundary_warnings(&self) -> Vec<String> {
        if self.media.is_empty() {
            return Vec::new();
        }
        let own = self.materials.iter().map(|material| material.interior).collect();
        let inside: Vec<Option<MediumId>> = self.with_that_of_parts(own, |_| true);
        let shapes: Vec<&Shape> = self.shapes.iter().chain(self.groups.iter().flat_map(|group| &group.shapes)).collect();
        let bounds = |shape: &Shape, medium: MediumId| shape.materials().any(|material| inside[material] == Some(medium));
        let in_slabs: Vec<MediumId> = self.materials.iter().flat_map(Material::media_of_slabs).collect();
        let mut warnings = Vec::new();
        for (id, medium) in self.media.iter().enumerate() {
            let boundary: Vec<&Shape> = shapes.iter().copied().filter(|shape| bounds(shape, id)).collect();
            if boundary.is_empty() && self.camera_medium != Some(id) && !in_slabs.contains(&id) {
                let what = "no shape has a material whose `interior` or slab it is, and the camera is not within it";
                warnings.push(format!("the medium `{}` is nowhere: {what}", medium.name));
            }
            // Several open shapes may close each other.
            if let [shape] = boundary[..]
                && let Some(fault) = fault_of(shape)
            {
                warnings.push(format!("{}: {fault} the medium `{}`", shape.label, medium.name));
            }
        }
        warnings
    }
}

/// The reason why a shape by itself is no boundary of a body, to be followed by the medium's name.
fn fault_of(shape: &Shape) -> Option<&'static str> {
    const OPEN: &str = "the shape is open, so a ray that goes around its edge does not leave";
    match shape.geometry.enclosure() {
        Enclosure::Surroundings => Some("the fronts of its faces look inward, so everything around it is filled with"),
        // Faces of other materials may close it.
        Enclosure::None if shape.face_materials_agree() => Some(OPEN),
        Enclosure::None | Enclosure::Body | Enclosure::Half => None,
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use crate::load::load_toml_str;

    fn warnings(shapes: &str) -> Vec<String> {
        let scene = format!(
            "[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\nvfov = 40\n[[light]]\ntype = 'environment'\nradiance = 1\n\
             [[medium]]\nname = 'fog'\nscattering = 1\n[[material]]\nname = 'edge'\ntype = 'pass'\ninterior = 'fog'\n\
             [[material]]\nname = 'mixed'\ntype = 'blend'\nmaterials = ['edge', 'edge']\nweight = {{ type = 'constant', value = 0.5 }}\n{shapes}"
        );
        load_toml_str(&scene, "media", Path::new("")).expect("a scene").warnings
    }

    const MESH: &str =
        "[[shape]]\ntype = 'mesh'\nmaterial = 'edge'\npositions = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]\nfaces = ";
    const DISK: &str = "[[shape]]\ntype = 'disk'\ncenter = [0, 0, 0]\nnormal = [0, 1, 0]\nradius = 1\nmaterial = 'mixed'\n";

    #[test]
    fn bodies_are_no_cause_for_a_warning() {
        let sphere = "[[shape]]\ntype = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nmaterial = 'mixed'\n";
        assert_eq!(warnings(sphere), [""; 0]);
        assert_eq!(warnings(&format!("{MESH}[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]\n")), [""; 0]);
        assert_eq!(warnings(&format!("{DISK}{DISK}")), [""; 0]);
    }

    #[test]
    fn what_bounds_nothing_is_reported() {
        let only = |shapes: &str, part: &str| {
            let found = warnings(shapes);
            assert!(matches!(&found[..], [warning] if warning.contains(part)), "{shapes}: {found:?}");
        };
        only("", "the medium `fog` is nowhere");
        only(DISK, "shape[0] (disk): the shape is open");
        only(&format!("{MESH}[[0, 2, 1], [0, 1, 3], [0, 3, 2]]\n"), "shape[0] (mesh): the shape is open");
        only(&format!("{MESH}[[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]\n"), "look inward");
    }
}
