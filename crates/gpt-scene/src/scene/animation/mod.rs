//! Scenes that are elsewhere at another frame.
//!
//! Keyframes stand beside the scene, and the scene alone is the rest pose. `Scene::at_frame` gives another scene, which is all that renderers ever see. Frames are counted in one time: frame f is f / [`Animation::frames_per_second`] seconds after the start, and shutter time 1 of frame f is shutter time 0 of frame f + 1.

mod curve;
mod deformation;
mod moving;
mod track;

use std::sync::Arc;

use glam::{DAffine3, DMat3};

pub use curve::{Curve, Interpolation, Key, Moment, Turn};
pub use deformation::{Deformation, DeformationTrack, Influences, Joint, MorphTarget};
pub use moving::{motion_between, unevenness};
pub use track::{CameraTrack, LightTrack, MaterialTrack, Node, ShapeTrack, TransformTrack};

use super::camera::{Camera, EXPOSURE_STRETCHES};
use super::light_at::LightAt;
use super::shape::Mesh;

/// Frames in a second where nothing else is said.
pub const FRAMES_PER_SECOND: f64 = 24.0;

/// The keyframes of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Animation {
    pub frames_per_second: f64,
    pub nodes: Vec<Node>,
    pub shapes: Vec<ShapeTrack>,
    pub camera: Option<CameraTrack>,
    pub lights: Vec<LightTrack>,
    pub materials: Vec<MaterialTrack>,
    /// Meshes that are deformed, in the order of their shapes.
    pub deformations: Vec<DeformationTrack>,
}

impl Default for Animation {
    fn default() -> Self {
        Self {
            frames_per_second: FRAMES_PER_SECOND,
            nodes: Vec::new(),
            shapes: Vec::new(),
            camera: None,
            lights: Vec::new(),
            materials: Vec::new(),
            deformations: Vec::new(),
        }
    }
}

impl Animation {
    /// Nothing has keys.
    pub fn is_empty(&self) -> bool {
        self.frames().is_none()
    }

    /// How many shapes have keys, or are deformed by what has some.
    pub fn animated_shapes(&self) -> usize {
        let is_counted = |deformed: &&DeformationTrack| self.shapes.iter().any(|track| track.shape == deformed.shape);
        self.shapes.len() + self.deformations.iter().filter(|deformed| !is_counted(deformed)).count()
    }

    /// The first and the last frame of all keys; None where there are none.
    pub fn frames(&self) -> Option<[f64; 2]> {
        let nodes = self.nodes.iter().filter_map(|node| node.track.as_ref());
        let tracks = nodes.chain(self.shapes.iter().filter_map(|shape| shape.track.as_ref()));
        let frames = tracks.flat_map(TransformTrack::frames).chain(self.camera.iter().flat_map(CameraTrack::frames));
        let frames = frames.chain(self.lights.iter().flat_map(LightTrack::frames));
        let frames = frames.chain(self.materials.iter().flat_map(MaterialTrack::frames));
        let targets = self.deformations.iter().flat_map(|track| &track.deformation.targets);
        let frames = frames.chain(targets.flat_map(|target| target.weight.keys.iter().map(|key| key.frame)));
        frames.fold(None, |ends, frame| {
            let [first, last] = ends.unwrap_or([frame; 2]);
            Some([f64::min(first, frame), f64::max(last, frame)])
        })
    }

    /// The shapes with keys, each as it is turned and scaled at the first frame of all keys; None where neither shapes nor lights have any. It is the
    /// same for all frames. Meshes that are deformed are among them, so that what stands still beside them has a tree of its own.
    pub fn first_poses(&self) -> Option<Arc<[(usize, DMat3)]>> {
        let has_some = !(self.shapes.is_empty() && self.lights.is_empty() && self.deformations.is_empty());
        let [first, _] = self.frames().filter(|_| has_some)?;
        let at = Moment { now: first, opening: first };
        let moved = self.shapes.iter().map(|track| (track.shape, track.during(self, at).matrix3));
        let stands = |deformed: &&DeformationTrack| self.shapes.iter().all(|track| track.shape != deformed.shape);
        let deformed = self.deformations.iter().filter(stands).map(|track| (track.shape, track.place.matrix3));
        Some(moved.chain(deformed).collect())
    }

    /// By how much a node takes things along from where they stand without a frame.
    fn taken_along(&self, node: Option<usize>, moment: Moment) -> DAffine3 {
        let Some(node) = node else { return DAffine3::IDENTITY };
        if !self.moves(node) {
            return DAffine3::IDENTITY;
        }
        let chain = |local: &dyn Fn(&Node) -> DAffine3| {
            let (mut map, mut next) = (DAffine3::IDENTITY, Some(node));
            while let Some(index) = next {
                map = local(&self.nodes[index]) * map;
                next = self.nodes[index].parent;
            }
            map
        };
        let rest = chain(&|node| node.rest);
        chain(&|node| node.track.as_ref().map_or(node.rest, |track| track.during(moment))) * rest.inverse()
    }

    /// The node or one of those around it has keys.
    fn moves(&self, node: usize) -> bool {
        let mut next = Some(node);
        while let Some(index) = next {
            if self.nodes[index].track.is_some() {
                return true;
            }
            next = self.nodes[index].parent;
        }
        false
    }

    /// The camera at a frame.
    pub fn camera_at(&self, rest: &Camera, frame: f64) -> Camera {
        self.camera_during(rest, frame.into())
    }

    /// The camera at even steps of time while the shutter of a frame is open, for [`Scene::exposure`](crate::scene::Scene::exposure).
    pub fn exposure(&self, rest: &Camera, frame: f64) -> Vec<Camera> {
        let [open, close] = rest.shutter;
        let opening = frame + open;
        let at = |step: usize| {
            let now = opening + (close - open) * (step as f64 / EXPOSURE_STRETCHES as f64);
            self.camera_during(rest, Moment { now, opening })
        };
        let cameras: Vec<Camera> = (0..=EXPOSURE_STRETCHES).map(at).collect();
        if cameras.iter().all(|camera| *camera == cameras[0]) { Vec::new() } else { cameras }
    }

    fn camera_during(&self, rest: &Camera, moment: Moment) -> Camera {
        let Some(track) = &self.camera else { return rest.clone() };
        let mut camera = track.during(rest, moment);
        if track.node.is_some_and(|node| self.moves(node)) {
            let along = self.taken_along(track.node, moment);
            camera.position = along.transform_point3(camera.position);
            camera.look_at = along.transform_point3(camera.look_at);
            camera.up = along.transform_vector3(camera.up);
        }
        camera
    }
}

impl LightTrack {
    /// The state of its keys at a frame, moved by its node.
    pub fn taken_along(&self, animation: &Animation, frame: f64) -> LightAt {
        LightAt { along: animation.taken_along(self.node, frame.into()), ..self.at(frame) }
    }
}

impl DeformationTrack {
    /// The mesh at a frame. While the shutter is open it stays so.
    pub fn at(&self, animation: &Animation, frame: f64) -> Mesh {
        let back = self.place.inverse();
        self.deformation.during(frame.into(), &|node| back * animation.taken_along(Some(node), frame.into()) * self.place)
    }
}

impl ShapeTrack {
    /// From the shape's own space to the world.
    pub fn during(&self, animation: &Animation, moment: Moment) -> DAffine3 {
        let own = self.track.as_ref().map_or_else(|| self.rest.to_affine(), |track| track.during(moment));
        animation.taken_along(self.node, moment) * own
    }
}
