//! Scenes that are elsewhere at another frame.
//!
//! What of a scene has keys stands beside it: the scene itself is what it shows without a frame. [`Scene::at_frame`] gives another scene, which
//! is all that renderers ever see. Frames are counted in one time: frame f is f / [`Animation::frames_per_second`] seconds after the start, and
//! shutter time 1 of frame f is shutter time 0 of frame f + 1.

mod curve;
mod moving;
mod track;

use std::sync::Arc;

use glam::DAffine3;

pub use curve::{Curve, Interpolation, Key, Turn};
pub use track::{CameraTrack, Node, ShapeTrack, TransformTrack};

use super::camera::Camera;
use super::model::Scene;
use super::shape::Shape;
use super::transform::{Transform, TransformStep};
use super::validate::{InvalidScene, check_camera};

/// Frames in a second where nothing else is said.
pub const FRAMES_PER_SECOND: f64 = 24.0;

/// What of a scene has keys.
#[derive(Debug, Clone, PartialEq)]
pub struct Animation {
    pub frames_per_second: f64,
    pub nodes: Vec<Node>,
    pub shapes: Vec<ShapeTrack>,
    pub camera: Option<CameraTrack>,
}

impl Default for Animation {
    fn default() -> Self {
        Self { frames_per_second: FRAMES_PER_SECOND, nodes: Vec::new(), shapes: Vec::new(), camera: None }
    }
}

impl Animation {
    /// Nothing has keys.
    pub fn is_empty(&self) -> bool {
        self.frames().is_none()
    }

    /// The first and the last frame of all keys; None where there are none.
    pub fn frames(&self) -> Option<[f64; 2]> {
        let nodes = self.nodes.iter().filter_map(|node| node.track.as_ref());
        let tracks = nodes.chain(self.shapes.iter().filter_map(|shape| shape.track.as_ref()));
        let frames = tracks.flat_map(TransformTrack::frames).chain(self.camera.iter().flat_map(CameraTrack::frames));
        frames.fold(None, |ends, frame| {
            let [first, last] = ends.unwrap_or([frame; 2]);
            Some([f64::min(first, frame), f64::max(last, frame)])
        })
    }

    /// How many shapes have keys or a node that takes them along.
    pub fn moving_shapes(&self) -> usize {
        self.shapes.len()
    }

    /// By how much a node takes things along from where they stand without a frame.
    fn taken_along(&self, node: Option<usize>, frame: f64) -> DAffine3 {
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
        chain(&|node| node.track.as_ref().map_or(node.rest, |track| track.at(frame))) * rest.inverse()
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
    fn camera_at(&self, rest: &Camera, frame: f64) -> Camera {
        let Some(track) = &self.camera else { return rest.clone() };
        let mut camera = track.at(rest, frame);
        if track.node.is_some_and(|node| self.moves(node)) {
            let along = self.taken_along(track.node, frame);
            camera.position = along.transform_point3(camera.position);
            camera.look_at = along.transform_point3(camera.look_at);
            camera.up = along.transform_vector3(camera.up);
        }
        camera
    }
}

impl ShapeTrack {
    /// From the shape's own space to the world.
    fn at(&self, animation: &Animation, frame: f64) -> DAffine3 {
        let own = self.track.as_ref().map_or_else(|| self.rest.to_affine(), |track| track.at(frame));
        animation.taken_along(self.node, frame) * own
    }
}

impl Scene {
    /// The scene as it is at a frame, which need not be a whole number. Shapes whose keys move them while the shutter is open are blurred: they
    /// are exactly where their keys put them as it opens and closes, and move evenly in between. The camera stands where it is at the frame itself. Meshes,
    /// textures and whatever else does not change are shared.
    ///
    /// # Errors
    /// What cannot be rendered there: a camera that looks at the point it stands at, a shape that is flattened.
    pub fn at_frame(&self, frame: f64) -> Result<Self, InvalidScene> {
        let animation = &self.animation;
        let mut scene = self.clone();
        scene.animation = Arc::default();
        scene.camera = animation.camera_at(&self.camera, frame);
        let of = |part: String, message: String| InvalidScene { part: format!("frame {frame}: {part}"), message };
        check_camera(&scene.camera).map_err(|message| of("camera".to_owned(), message))?;
        let shutter = scene.camera.shutter;
        for track in &animation.shapes {
            let shape = &mut scene.shapes[track.shape];
            let at = |time: f64| track.at(animation, frame + time);
            let (map, motion) = match moving::motion_between(&at, shutter) {
                Ok(Some((map, motion))) => (map, Some(motion)),
                Ok(None) => (at(shutter[0]), None),
                Err(message) => return Err(of(shape.label.clone(), message.to_owned())),
            };
            shape.transform = Transform { steps: vec![TransformStep::Matrix(map)] };
            shape.motion = motion;
            let checked = shape.check_place().and_then(|()| shape.check_motion(shutter).map_err(|(_, message)| message));
            checked.map_err(|message| of(shape.label.clone(), message))?;
        }
        Ok(scene)
    }
}

impl Scene {
    /// Whether all shapes stand and move as in another frame of the same scene.
    pub fn shapes_stand_as_in(&self, other: &Self) -> bool {
        let same = |(shape, other): (&Shape, &Shape)| shape.transform == other.transform && shape.motion == other.motion;
        self.camera.shutter == other.camera.shutter
            && self.shapes.len() == other.shapes.len()
            && self.shapes.iter().zip(&other.shapes).all(same)
    }
}

#[cfg(test)]
mod tests;
