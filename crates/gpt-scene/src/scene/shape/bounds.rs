//! Boxes around shapes.

use glam::{BVec3, DVec3};

use super::{Geometry, Shape};

impl Shape {
    /// The lower and upper corner of an upright box around the shape where its transform puts it; None of what is infinite.
    pub fn bounds(&self) -> Option<[DVec3; 2]> {
        let map = self.transform.to_affine();
        let of_points = |points: &mut dyn Iterator<Item = DVec3>| {
            let mut placed = points.map(|point| map.transform_point3(point));
            let first = placed.next()?;
            Some(placed.fold([first; 2], |[low, high], point| [low.min(point), high.max(point)]))
        };
        let of_box = |low: DVec3, high: DVec3| {
            let corner = |index: usize| DVec3::select(BVec3::new(index & 1 != 0, index & 2 != 0, index & 4 != 0), high, low);
            of_points(&mut (0..8).map(corner))
        };
        match &self.geometry {
            Geometry::Mesh(mesh) => of_points(&mut mesh.positions.iter().map(|position| position.as_dvec3())),
            Geometry::Sphere(sphere) => of_box(sphere.center - sphere.radius, sphere.center + sphere.radius),
            Geometry::Box(cuboid) => of_box(cuboid.min, cuboid.max),
            Geometry::Cylinder(tube) => {
                let [from, to] = [tube.from, tube.to];
                of_box(from.min(to) - tube.radius, from.max(to) + tube.radius)
            }
            Geometry::Disk(disk) => of_box(disk.center - disk.radius, disk.center + disk.radius),
            Geometry::Rectangle(sheet) => {
                let far = sheet.corner + sheet.edge_u + sheet.edge_v;
                of_points(&mut [sheet.corner, sheet.corner + sheet.edge_u, sheet.corner + sheet.edge_v, far].into_iter())
            }
            Geometry::Plane(_) => None,
        }
    }
}
