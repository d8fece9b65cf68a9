//! Layers beside the picture, by watching paths: `shaders/shading/path/layer.wgsl` and `surface_layer.wgsl` are the same on the device.

use std::borrow::Cow;

use glam::{DAffine3, DVec3};

use super::bsdf::{BsdfSample, Density, View};
use super::camera::CameraRays;
use super::intersect::{Hit, PathTime, PointAtRest, Ray, Surface, SurfaceId, World};
use super::trace::{LightConnection, PathVisitor};
use crate::film::KernelLayer;
use crate::scene::{Estimator, Guiding, Scene};
use crate::spectrum::Spectrum;

/// Edges of a path at most that a layer of surfaces follows through mirrors and glass.
const MOST_EDGES: u32 = 64;

/// The scene as it is rendered for a layer. Paths to surfaces are followed as far as need be, need no light and are not ended by chance.
pub fn layer_scene(scene: &Scene, layer: KernelLayer) -> Cow<'_, Scene> {
    if !layer.is_of_surfaces() {
        return Cow::Borrowed(scene);
    }
    let mut scene = scene.clone();
    scene.render.estimator = Estimator::Bsdf;
    scene.render.max_depth = MOST_EDGES;
    scene.render.roulette_depth = 0.into();
    scene.render.guiding = Guiding::Off;
    scene.clear_media();
    scene.ready_for = Some(layer);
    Cow::Owned(scene)
}

/// How the layer of depth is measured.
#[derive(Debug, Clone, Copy)]
pub struct DepthMeasure {
    /// From this point.
    pub origin: DVec3,
    /// Along this direction; None: by distance.
    pub forward: Option<DVec3>,
}

impl DepthMeasure {
    /// Depth of a position.
    fn of(&self, position: DVec3) -> f64 {
        let way = position - self.origin;
        self.forward.map_or_else(|| way.length(), |forward| way.dot(forward))
    }
}

/// The facts of the scene that layers of the first surface ask for beside the surface itself.
#[derive(Debug, Clone)]
pub struct ObjectMeasure {
    /// From the world at rest to the space of each shape.
    to_shapes: Vec<DAffine3>,
    /// The scene as the shutter opens and as it closes.
    ends: [PathTime; 2],
    camera: CameraRays,
}

impl ObjectMeasure {
    /// Takes them of a scene that is moved to its center.
    pub fn new(scene: &Scene) -> Self {
        Self {
            to_shapes: scene.shapes.iter().map(|shape| shape.transform.to_affine().inverse()).collect(),
            ends: scene.camera.shutter.map(|time| PathTime::new(scene, time)),
            camera: CameraRays::of(scene),
        }
    }

    /// The place of a hit in the space of its object.
    fn position(&self, world: &World, at_rest: &PointAtRest) -> DVec3 {
        match at_rest.surface {
            // The space of the group.
            SurfaceId::Instanced { .. } => at_rest.position,
            id => self.to_shapes[world.owner(id).shape].transform_point3(at_rest.position),
        }
    }

    /// How far a hit goes across the picture while the shutter is open, in pixels to the right and up; None where it is not always before the camera.
    fn motion(&self, world: &World, at_rest: &PointAtRest, pixel: [u32; 2]) -> Option<DVec3> {
        let place = |end: usize| self.camera.place(pixel, world.place_of(at_rest, &self.ends[end]), end == 1);
        let way = place(1)? - place(0)?;
        Some(DVec3::new(way.x, -way.y, 0.0))
    }
}

/// Watches a path of a [`layer_scene`], and gives it up where the layer's surface is reached.
pub struct LayerVisitor<'a, V> {
    layer: KernelLayer,
    depth: DepthMeasure,
    /// And the pixel whose path is watched; for the layers that need it.
    object: Option<(&'a ObjectMeasure, [u32; 2])>,
    /// The value of the hit, where that says more of it than the surface.
    of_hit: Option<Spectrum>,
    /// Is told of rays, and may give paths up as well.
    other: &'a mut V,
    /// Edges up to the ray's end.
    edges: u32,
    throughput: Spectrum,
    /// The value of the surface that was met last; None where nothing was.
    found: Option<Spectrum>,
    reached: bool,
    light: Spectrum,
}

impl<'a, V: PathVisitor> LayerVisitor<'a, V> {
    pub fn new(layer: KernelLayer, depth: DepthMeasure, other: &'a mut V) -> Self {
        let (throughput, light) = (Spectrum::WHITE, Spectrum::BLACK);
        Self { layer, depth, object: None, of_hit: None, other, edges: 1, throughput, found: None, reached: false, light }
    }

    /// With what layers of objects need, for the path of a pixel.
    #[must_use]
    pub fn of_pixel(self, measure: &'a ObjectMeasure, pixel: [u32; 2]) -> Self {
        let needs_it = matches!(self.layer, KernelLayer::ObjectPosition | KernelLayer::Motion);
        Self { object: needs_it.then_some((measure, pixel)), ..self }
    }

    /// The layer's value for a path that found this radiance; None where a layer of surfaces met nothing.
    pub fn value(&self, radiance: Spectrum) -> Option<Spectrum> {
        match self.layer {
            layer if layer.is_of_surfaces() => self.found,
            KernelLayer::Squares => Some(radiance * radiance),
            _ => Some(self.light),
        }
    }

    fn add(&mut self, edges: u32, contribution: Spectrum) {
        if self.layer.holds_light(edges) {
            self.light += contribution;
        }
    }
}

/// A vector as a film keeps it, coordinates in the place of channels.
fn color_of(vector: DVec3) -> Spectrum {
    Spectrum::from_rgb(vector.to_array())
}

impl<V: PathVisitor> PathVisitor for LayerVisitor<'_, V> {
    fn ray(&mut self, ray: &Ray) {
        self.other.ray(ray);
    }

    fn first_hit(&mut self, world: &World, ray: &Ray, time: &PathTime) -> Option<Hit> {
        let hit = self.other.first_hit(world, ray, time);
        if let (Some((measure, pixel)), Some(hit)) = (self.object, &hit) {
            let at_rest = world.at_rest(ray, hit, time);
            self.of_hit = if self.layer == KernelLayer::Motion {
                measure.motion(world, &at_rest, pixel).map(color_of)
            } else {
                Some(color_of(measure.position(world, &at_rest)))
            };
        }
        hit
    }

    fn surface(&mut self, _depth: u32, surface: &Surface, wo: DVec3, throughput: Spectrum) {
        let normal = surface.point.normal;
        self.throughput = throughput;
        self.found = Some(match self.layer {
            KernelLayer::ObjectPosition | KernelLayer::Motion => {
                self.found = self.of_hit;
                return;
            }
            KernelLayer::Uv => color_of(surface.uv.extend(0.0)),
            KernelLayer::Position => color_of(surface.point.position),
            KernelLayer::Depth => Spectrum::grey(self.depth.of(surface.point.position)),
            KernelLayer::Normal => color_of(if normal.dot(wo) > 0.0 { normal } else { -normal }),
            _ => Spectrum::BLACK,
        });
    }

    fn view(&mut self, view: &View) {
        if self.layer == KernelLayer::Normal {
            self.found = Some(color_of(view.normal()));
        }
    }

    fn emission(&mut self, _radiance: Spectrum, _weight: f64, contribution: Spectrum) {
        self.add(self.edges, contribution);
    }

    fn given_off(&mut self, contribution: Spectrum) {
        self.add(self.edges, contribution);
    }

    fn light(&mut self, connection: &LightConnection) {
        self.add(self.edges + 1, connection.contribution);
    }

    fn scattered(&mut self, sample: &BsdfSample) {
        if self.layer.is_of_surfaces() {
            let goes_on = sample.density == Density::Delta && sample.weight.max_component() > 0.0;
            self.reached = !goes_on || (self.layer.is_of_first_surface() && !sample.is_null);
            if self.reached && self.layer == KernelLayer::Albedo {
                self.found = Some(self.throughput * sample.weight);
            }
        }
        self.edges += u32::from(!sample.is_null);
    }

    fn gives_up(&mut self, vertices: u32) -> bool {
        self.reached || self.other.gives_up(vertices)
    }

    fn escaped(&mut self, _radiance: Spectrum, _weight: f64, contribution: Spectrum) {
        self.found = None;
        self.add(self.edges, contribution);
    }
}
