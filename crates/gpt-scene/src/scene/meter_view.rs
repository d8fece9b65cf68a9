//! The picture that a meter sees of a scene. Its mean, times a factor, is the quantity.
//!
//! A meter of irradiance looks at a white sheet of paper, which sends on E/π of the light E that reaches it. Only the meter's own rays meet the paper, so it
//! takes no light from anything else.

use glam::DVec3;

use super::camera::{Camera, Projection};
use super::material::{BlendWeight, Material, MaterialKind};
use super::meter::{Meter, MeterKind};
use super::model::Scene;
use super::settings::{Emitters, FilmSettings};
use super::shape::{Geometry, Rectangle, Shape};
use super::texture::ColorInput;

/// Pixels along a side of a meter's picture: its samples are spread over as many cells.
const SIDE: u32 = 16;
/// Distance of the paper from where it measures, and of the eye from the paper, in units of the largest length there is: few enough that light hardly
/// changes, and many times what single precision resolves.
const DISTANCE: f64 = 4e-6;

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
                on_paper(&mut view, position - 0.5 * (across + beside), [across, beside], size)
            }
            MeterKind::IrradianceOfRectangle { corner, edge_u, edge_v } => {
                let size = DISTANCE * length(corner).max(edge_u.length()).max(edge_v.length());
                on_paper(&mut view, corner, [edge_u, edge_v], size)
            }
        };
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

/// Lays paper over a rectangle, at this distance before it; the camera that sees all of it.
fn on_paper(view: &mut Scene, corner: DVec3, [edge_u, edge_v]: [DVec3; 2], distance: f64) -> Camera {
    let normal = edge_u.cross(edge_v).normalize();
    let first = view.materials.len();
    let material = |kind: MaterialKind| Material {
        name: String::new(),
        kind,
        normal_map: None,
        emission: None,
        two_sided: true,
        interior: None,
    };
    let white = MaterialKind::Diffuse { reflectance: ColorInput::grey(1.0) };
    let for_camera = MaterialKind::Blend { materials: [first, first + 1], weight: BlendWeight::Camera };
    view.materials.extend([white, MaterialKind::Pass, for_camera].map(material));
    // Rays at its edges meet it, too.
    let [beyond_u, beyond_v] = [edge_u, edge_v].map(|edge| 0.01 * edge + edge.normalize() * distance);
    let (margin, wide_u, wide_v) = (beyond_u + beyond_v, edge_u + 2.0 * beyond_u, edge_v + 2.0 * beyond_v);
    view.shapes.push(Shape {
        label: "the meter's paper".to_owned(),
        geometry: Geometry::Rectangle(Rectangle { corner: corner - margin + normal * distance, edge_u: wide_u, edge_v: wide_v }),
        material: first + 2,
        transform: Default::default(),
        motion: None,
        portal: false,
    });
    // The camera's edge is no edge of the light that reaches the paper.
    if view.render.max_depth > 0 {
        view.render.max_depth += 1;
    }
    let middle = corner + 0.5 * (edge_u + edge_v);
    let position = middle + normal * (2.0 * distance);
    let height = edge_v.length();
    Camera { up: edge_v, ..parallel(position, -normal, height, edge_u.length() / height) }
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
