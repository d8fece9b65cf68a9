//! The limits of single precision for a scene: docs/stress.md measures them.

use super::instance::Instances;
use super::model::Scene;
use super::shape::{Extent, Shape};

/// Longest edge of a parallelogram that renders right, in units: its overlap with its neighbours, a millionth of an edge, is then one unit.
const LONGEST_EDGE_OF_QUAD: f64 = 1e6;
/// Triangles, spheres and disks: extents from and up to which their normals are precise.
const SMALLEST: f64 = 1e-9;
const LARGEST: f64 = 1e9;
const EXTENT: &str = "its extent is";
/// Shapes that are named one by one.
const MOST_NAMED: usize = 3;

impl Scene {
    /// Shapes that are larger or smaller than what graphics devices hold in single precision, in sentences.
    pub fn precision_warnings(&self) -> Vec<String> {
        let of_shapes = self.shapes.iter().filter_map(|shape| beyond(shape).map(|(what, length)| (&*shape.label, what, length)));
        let of_instances = self.instances.iter().filter_map(|entry| Some((&*entry.label, EXTENT, self.extent_beyond(entry)?)));
        let found: Vec<(&str, &str, f64)> = of_shapes.chain(of_instances).collect();
        let mut warnings: Vec<String> =
            found.iter().take(MOST_NAMED).map(|(label, what, length)| sentence(label, what, *length)).collect();
        if found.len() > MOST_NAMED {
            warnings.push(format!("{} more shapes are too large or too small for single precision", found.len() - MOST_NAMED));
        }
        warnings
    }

    /// The extent of an instance that is too large or too small.
    fn extent_beyond(&self, instances: &Instances) -> Option<f64> {
        let extents = instances.extents(self.groups.get(instances.group)?.ball()?);
        extents.into_iter().find(|extent| !(SMALLEST..=LARGEST).contains(extent) && !instances.places.is_empty())
    }
}

fn sentence(label: &str, what: &str, length: f64) -> String {
    format!(
        "{label}: {what} {length:.1e} units, beyond what single precision holds (docs/stress.md): the picture may be wrong; choose a larger \
         or smaller unit for the whole scene"
    )
}

/// The kind and length of a part that is too long or too short.
fn beyond(shape: &Shape) -> Option<(&'static str, f64)> {
    match shape.geometry.extent(&shape.transform.to_affine())? {
        Extent::LongestEdge(length) => (length > LONGEST_EDGE_OF_QUAD).then_some(("its longest edge is", length)),
        Extent::Across(length) => (!(SMALLEST..=LARGEST).contains(&length)).then_some((EXTENT, length)),
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::{DVec3, Vec3};

    use super::super::shape::{Cuboid, Disk, Geometry, Mesh, Rectangle, Sphere};
    use super::super::transform::{Transform, TransformStep};
    use super::*;

    /// How many warnings shapes of this size bring: a rectangle, a box, a sphere, a disk and a triangle of unit size, scaled.
    fn warnings(scale: f64) -> usize {
        let triangle = Mesh { positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y], faces: vec![[0, 1, 2]], ..Mesh::default() };
        let geometries = [
            Geometry::Rectangle(Rectangle { corner: DVec3::ZERO, edge_u: DVec3::X, edge_v: DVec3::Y }),
            Geometry::Box(Cuboid { min: DVec3::ZERO, max: DVec3::ONE }),
            Geometry::Sphere(Sphere { center: DVec3::ZERO, radius: 0.5 }),
            Geometry::Disk(Disk { center: DVec3::ZERO, normal: DVec3::Z, radius: 0.5 }),
            Geometry::Mesh(Arc::new(triangle)),
        ];
        let alone = |geometry: Geometry| {
            let transform = Transform { steps: vec![TransformStep::Scale(DVec3::splat(scale))] };
            let shape =
                Shape { label: "shape".into(), geometry, material: 0, transform, motion: None, portal: false, receiver: 0 };
            Scene { shapes: vec![shape], ..Scene::default() }.precision_warnings().len()
        };
        geometries.into_iter().map(alone).sum()
    }

    #[test]
    fn shapes_beyond_what_is_measured_are_named() {
        assert_eq!([1e-6, 1.0, 1e6].map(warnings), [0, 0, 0]);
        assert_eq!(warnings(1.1e6), 2, "the rectangle and the box");
        assert_eq!(warnings(1.1e9), 5);
        assert_eq!(warnings(0.9e-9), 3, "all but those two");
    }

    #[test]
    fn many_are_counted() {
        let geometry = Geometry::Sphere(Sphere { center: DVec3::ZERO, radius: 1e12 });
        let shape = Shape {
            label: "sphere".into(),
            geometry,
            material: 0,
            transform: Transform::default(),
            motion: None,
            portal: false,
            receiver: 0,
        };
        let warnings = Scene { shapes: vec![shape; 10], ..Scene::default() }.precision_warnings();
        assert_eq!(warnings.len(), MOST_NAMED + 1);
        assert!(
            warnings[0].contains("sphere: its extent is 2.0e12 units") && warnings[MOST_NAMED].starts_with("7 more"),
            "{warnings:?}"
        );
    }
}
