//! The picture that a meter sees of a scene. Its mean, times a factor, is the quantity.
//!
//! A meter of irradiance looks at a white sheet of paper, which sends on E/π of the light E that reaches it. Only the meter's own rays meet the paper, so it
//! takes no light from anything else. Round paper lies before black ground, and what it sends on is seen in the circle of the picture where it lies.

use glam::DVec3;

use super::camera::{Camera, Fisheye, FisheyeFit, FisheyeMapping, Projection};
use super::material::{BlendWeight, Material, MaterialKind};
use super::meter::{Meter, MeterKind};
use super::model::Scene;
use super::settings::{Emitters, FilmSettings};
use super::shape::{Disk, Geometry, Rectangle, Shape, Sphere};
use super::texture::ColorInput;

/// Pixels along a side of a meter's picture: its samples are spread over as many cells.
const SIDE: u32 = 16;
/// Distance of the paper from where it measures, and of the eye from the paper, in units of the largest length there is: few enough that light hardly
/// changes, and many times what single precision resolves.
const DISTANCE: f64 = 4e-6;

/// Reflectances of paper: what measures, and what lies around it.
const WHITE: f64 = 1.0;
const BLACK: f64 = 0.0;

impl Scene {
    /// The scene as a meter sees it: with a camera and a film for it, all emitters visible, and the paper, if there is one.
    #[doc(hidden)]
    pub fn seen_by(&self, meter: &Meter) -> Self {
        let scene = self;
        let mut view = scene.clone();
        view.film = FilmSettings { size: [SIDE; 2], ..FilmSettings::default() };
        view.exposure = Vec::new();
        view.layers = Vec::new();
        view.render.emitters = Emitters::Seen;
        view.camera_medium = meter.medium.or(scene.camera_medium);
        view.name.clone_from(&meter.name);
        let reach = scene.camera.position.distance(scene.camera.look_at);
        let length = |place: DVec3| place.abs().max_element().max(reach);
        view.camera = match meter.kind {
            MeterKind::Radiance { position, direction } => {
                parallel(position, direction, DISTANCE * DISTANCE * length(position), 1.0)
            }
            MeterKind::Distant { direction, target, size } => {
                let outside = target - direction * outside_of(scene, target).max(DISTANCE * length(target));
                parallel(outside, direction, size.max(DISTANCE * DISTANCE * length(target)), 1.0)
            }
            MeterKind::Irradiance { position, normal } => {
                let size = DISTANCE * length(position);
                let across = normal.any_orthonormal_vector() * size;
                let beside = normal.cross(across.normalize()) * size;
                let corner = position - 0.5 * (across + beside);
                lay_sheet(&mut view, WHITE, corner, [across, beside], size);
                above(corner, [across, beside], size)
            }
            MeterKind::IrradianceOfRectangle { corner, edge_u, edge_v } => {
                let distance = DISTANCE * length(corner).max(edge_u.length()).max(edge_v.length());
                lay_sheet(&mut view, WHITE, corner, [edge_u, edge_v], distance);
                above(corner, [edge_u, edge_v], distance)
            }
            MeterKind::IrradianceOfDisk { center, normal, radius } => {
                let distance = DISTANCE * length(center).max(radius);
                let across = normal.any_orthonormal_vector() * (2.0 * radius);
                let beside = normal.cross(across);
                let corner = center - 0.5 * (across + beside);
                let paper = Disk { center: center + normal * distance, normal, radius };
                lay(&mut view, WHITE, Geometry::Disk(paper));
                lay_sheet(&mut view, BLACK, corner, [across, beside], 0.5 * distance);
                above(corner, [across, beside], distance)
            }
            MeterKind::IrradianceOfSphere { center, radius } => {
                let distance = DISTANCE * length(center).max(radius);
                lay(&mut view, WHITE, Geometry::Sphere(Sphere { center, radius: radius + distance }));
                let whole = Fisheye { mapping: FisheyeMapping::Equisolid, fov_degrees: 360.0, fit: FisheyeFit::Inside };
                Camera {
                    projection: Projection::Fisheye(whole),
                    inward_from: radius + 2.0 * distance,
                    ..parallel(center, DVec3::NEG_Z, 1.0, 1.0)
                }
            }
        };
        // The camera's edge is no edge of the light that reaches the paper.
        if meter.kind.is_of_irradiance() && view.render.max_depth > 0 {
            view.render.max_depth += 1;
        }
        view.camera.shutter = scene.camera.shutter;
        view
    }
}

/// A camera of parallel rays through a window so many times as wide as high.
fn parallel(position: DVec3, direction: DVec3, height: f64, stretch: f64) -> Camera {
    Camera {
        position,
        look_at: position + direction,
        up: direction.any_orthonormal_vector(),
        projection: Projection::Orthographic { height },
        stretch,
        ..Camera::default()
    }
}

/// The camera that sees all of a rectangle whose paper lies at this distance before it.
fn above(corner: DVec3, [edge_u, edge_v]: [DVec3; 2], distance: f64) -> Camera {
    let normal = edge_u.cross(edge_v).normalize();
    let position = corner + 0.5 * (edge_u + edge_v) + normal * (2.0 * distance);
    let height = edge_v.length();
    Camera { up: edge_v, ..parallel(position, -normal, height, edge_u.length() / height) }
}

/// Lays paper of this reflectance over a rectangle and somewhat beyond, at this distance before it.
fn lay_sheet(view: &mut Scene, reflectance: f64, corner: DVec3, [edge_u, edge_v]: [DVec3; 2], distance: f64) {
    let normal = edge_u.cross(edge_v).normalize();
    // Rays at its edges meet it, too.
    let [beyond_u, beyond_v] = [edge_u, edge_v].map(|edge| 0.01 * edge + edge.normalize() * distance);
    let (margin, edge_u, edge_v) = (beyond_u + beyond_v, edge_u + 2.0 * beyond_u, edge_v + 2.0 * beyond_v);
    let sheet = Rectangle { corner: corner - margin + normal * distance, edge_u, edge_v };
    lay(view, reflectance, Geometry::Rectangle(sheet));
}

/// Adds paper of this reflectance, which rays of the camera alone meet.
fn lay(view: &mut Scene, reflectance: f64, geometry: Geometry) {
    let first = view.materials.len();
    let material = |kind: MaterialKind| Material {
        name: String::new(),
        kind,
        normal_map: None,
        emission: None,
        two_sided: true,
        interior: None,
    };
    let paper = MaterialKind::Diffuse { reflectance: ColorInput::grey(reflectance) };
    let for_camera = MaterialKind::Blend { materials: [first, first + 1], weight: BlendWeight::Camera };
    view.materials.extend([paper, MaterialKind::Pass, for_camera].map(material));
    view.shapes.push(Shape {
        label: "the meter's paper".to_owned(),
        geometry,
        material: first + 2,
        transform: Default::default(),
        motion: None,
        portal: false,
        receiver: 0,
    });
}

/// A distance from the target beyond which there is nothing of the scene that has bounds.
fn outside_of(scene: &Scene, target: DVec3) -> f64 {
    let farthest = |[low, high]: [DVec3; 2]| (target - low).abs().max((target - high).abs()).length();
    let of_shapes = scene.shapes.iter().filter_map(Shape::bounds).map(farthest);
    let of_instances = scene.instances.iter().flat_map(|instances| {
        let shapes = &scene.groups[instances.group].shapes;
        let balls = shapes.iter().filter_map(Shape::bounds).map(|[low, high]| low.abs().max(high.abs()).length());
        let radius = balls.fold(0.0, f64::max);
        let around = instances.transform.to_affine();
        instances.places.iter().map(move |place| {
            let map = around * *place;
            let scale = [map.matrix3.x_axis, map.matrix3.y_axis, map.matrix3.z_axis].map(|axis| axis.length_squared());
            map.translation.distance(target) + radius * scale.into_iter().sum::<f64>().sqrt()
        })
    });
    1.01 * of_shapes.chain(of_instances).fold(0.0, f64::max)
}
