//! `[animation]`, `[[node]]` and keyframes.

use std::sync::Arc;

use crate::load::error::SceneError;
use crate::load::file::keyframes::{
    CameraKeyEntry, InterpolationName, LightKey, LightKeyEntry, TransformKeyEntry, WrittenLightTrack, WrittenTrack,
};
use crate::load::file::node::NodeEntry;
use crate::load::file::resolver::Resolver;
use crate::load::file::syntax::{CameraTable, ProjectionName, SceneFile};
use crate::load::file::value::{Located, Number, vector};
use crate::load::place::Place;
use crate::scene::animation::{
    Animation, CameraTrack, FRAMES_PER_SECOND, Interpolation, Key, LightTrack, Node, ShapeTrack, TransformTrack, Turn,
};
use crate::scene::{Shape, Transform};

impl Resolver<'_> {
    /// `[animation]`, `[[node]]`, and the keyframes of the camera, which has been read.
    pub(super) fn animation(&mut self, file: &SceneFile) -> Result<(), SceneError> {
        let fps = file.animation.as_ref().and_then(|table| table.fps).map_or(FRAMES_PER_SECOND, |fps| fps.0);
        let mut animation = Animation { frames_per_second: fps, ..Animation::default() };
        self.node_names = self.register("node", file.node.iter().map(|node| &node.value.name))?;
        for node in &file.node {
            let node = self.node(&node.value, fps);
            animation.nodes.extend(self.note(node));
        }
        self.check_parents(file, &animation.nodes)?;
        if let Some(camera) = &file.camera {
            animation.camera = self.camera_track(camera, fps)?;
        }
        self.scene.animation = Arc::new(animation);
        Ok(())
    }

    fn node(&self, written: &NodeEntry, fps: f64) -> Result<Node, SceneError> {
        let parent = written.parent.as_ref().map(|name| self.look_up(&self.node_names, name, "node")).transpose()?;
        let rest = written.transform.as_ref().map_or(Ok(Transform::default()), |transform| self.transform(transform))?;
        let track = self.transform_track(written.keyframes.as_ref(), written.interpolation.as_ref(), fps)?;
        Ok(Node { name: written.name.value.clone(), parent, rest: rest.to_affine(), track })
    }

    /// No node is within itself.
    fn check_parents(&self, file: &SceneFile, nodes: &[Node]) -> Result<(), SceneError> {
        // Nodes with mistakes are not there.
        if nodes.len() < file.node.len() {
            return Ok(());
        }
        // True, for each node, where the chain of its parents is known to end.
        let mut ends = vec![false; nodes.len()];
        let mut walk = vec![usize::MAX; nodes.len()];
        for start in 0..nodes.len() {
            let (mut chain, mut next) = (Vec::new(), Some(start));
            while let Some(index) = next.filter(|&index| !ends[index]) {
                if std::mem::replace(&mut walk[index], start) == start {
                    let name = &file.node[index].value.name;
                    return Err(self.error(&name.place, format!("the node `{}` contains itself", name.value)));
                }
                chain.push(index);
                next = nodes[index].parent;
            }
            chain.into_iter().for_each(|index| ends[index] = true);
        }
        Ok(())
    }

    fn transform_track(
        &self,
        keyframes: Option<&Located<Vec<Located<TransformKeyEntry>>>>,
        interpolation: Option<&Located<InterpolationName>>,
        fps: f64,
    ) -> Result<Option<TransformTrack>, SceneError> {
        let Some(keyframes) = keyframes else {
            return self.without_keyframes(interpolation).map(|()| None);
        };
        let frames = self.frames(keyframes, fps, |key| (key.frame, key.time))?;
        let interpolation = interpolation.map_or(Interpolation::default(), |name| name.value.into());
        let mut track = TransformTrack::default();
        (track.scale.interpolation, track.rotation.interpolation) = (interpolation, interpolation);
        track.translation.interpolation = interpolation;
        for (entry, frame) in keyframes.value.iter().zip(frames) {
            let TransformKeyEntry { scale, rotate, degrees, translate, .. } = &entry.value;
            if scale.is_none() && rotate.is_none() && degrees.is_none() && translate.is_none() {
                let message = "a keyframe of a transform states `scale`, `rotate` with `degrees`, or `translate`";
                return Err(self.error(&entry.place, message));
            }
            if let Some(scale) = scale {
                if scale.value.0.abs().min_element() == 0.0 {
                    return Err(self.error(&scale.place, "a scale of 0 flattens the shape"));
                }
                track.scale.keys.push(Key { frame, value: scale.value.0 });
            }
            match (rotate, degrees) {
                (Some(axis), Some(degrees)) => {
                    let value = Turn { axis: self.direction(axis)?, degrees: degrees.value.0 };
                    track.rotation.keys.push(Key { frame, value });
                }
                (Some(_), None) => return Err(self.error(&entry.place, "`rotate` needs the key `degrees`")),
                (None, Some(degrees)) => {
                    return Err(self.error(&degrees.place, "`degrees` belongs to `rotate`, which is missing"));
                }
                (None, None) => {}
            }
            track.translation.keys.extend(translate.map(|offset| Key { frame, value: vector(offset) }));
        }
        Ok(Some(track))
    }

    /// `interpolation` says how keyframes lead from one to the next.
    pub(in crate::load::file) fn without_keyframes(
        &self,
        interpolation: Option<&Located<InterpolationName>>,
    ) -> Result<(), SceneError> {
        let refuse = |written: &Located<_>| {
            Err(self.error(&written.place, "`interpolation` belongs to `keyframes`, of which there are none"))
        };
        interpolation.map_or(Ok(()), refuse)
    }

    /// The frames of keyframes, each later than the one before.
    pub(in crate::load::file) fn frames<T>(
        &self,
        keyframes: &Located<Vec<Located<T>>>,
        fps: f64,
        times: impl Fn(&T) -> (Option<Number>, Option<Number>),
    ) -> Result<Vec<f64>, SceneError> {
        if keyframes.value.is_empty() {
            return Err(self.error(&keyframes.place, "a list of keyframes has at least one"));
        }
        let mut frames: Vec<f64> = Vec::with_capacity(keyframes.value.len());
        for entry in &keyframes.value {
            let frame = match times(&entry.value) {
                (Some(frame), None) => frame.0,
                (None, Some(time)) => time.0 * fps,
                (None, None) => return Err(self.error(&entry.place, "a keyframe states its `frame`, or its `time` in seconds")),
                (Some(_), Some(_)) => {
                    return Err(self.error(&entry.place, "a keyframe states either its `frame` or its `time`, and this has both"));
                }
            };
            if let Some(last) = frames.last().filter(|last| **last >= frame) {
                let message = format!("keyframes stand in the order of their frames, and this one, {frame}, follows {last}");
                return Err(self.error(&entry.place, message));
            }
            frames.push(frame);
        }
        Ok(frames)
    }

    fn camera_track(&self, written: &CameraTable, fps: f64) -> Result<Option<CameraTrack>, SceneError> {
        let node = written.node.as_ref().map(|name| self.look_up(&self.node_names, name, "node")).transpose()?;
        let interpolation = written.interpolation.as_ref();
        let Some(keyframes) = written.keyframes.as_ref() else {
            self.without_keyframes(interpolation)?;
            return Ok(node.map(|node| CameraTrack { node: Some(node), ..CameraTrack::default() }));
        };
        let frames = self.frames(keyframes, fps, |key| (key.frame, key.time))?;
        let interpolation = interpolation.map_or(Interpolation::default(), |name| name.value.into());
        let no_name = if written.calibration.is_some() { ProjectionName::BrownConrady } else { ProjectionName::Perspective };
        let projection = written.projection.as_ref().map_or(no_name, |name| name.value);
        let mut track = CameraTrack { node, ..CameraTrack::default() };
        for (entry, frame) in keyframes.value.iter().zip(frames) {
            let CameraKeyEntry { position, look_at, up, vfov, height, focus_distance, .. } = &entry.value;
            if [position, look_at, up].iter().all(|value| value.is_none())
                && vfov.is_none()
                && height.is_none()
                && focus_distance.is_none()
            {
                let message = "a keyframe of the camera states `position`, `look_at`, `up`, `vfov`, `height` or `focus_distance`";
                return Err(self.error(&entry.place, message));
            }
            for (curve, value) in [(&mut track.position, position), (&mut track.look_at, look_at), (&mut track.up, up)] {
                curve.keys.extend(value.map(|value| Key { frame, value: vector(value) }));
            }
            let misplaced = |span: &Place, key: &str, kind: &str| {
                Err(self.error(span, format!("only keyframes of {kind} cameras state `{key}`")))
            };
            match (vfov, height) {
                (Some(vfov), _) if projection != ProjectionName::Perspective => {
                    return misplaced(&vfov.place, "vfov", "perspective");
                }
                (_, Some(height)) if projection != ProjectionName::Orthographic => {
                    return misplaced(&height.place, "height", "orthographic");
                }
                _ => {}
            }
            let opening = vfov.as_ref().map(|vfov| vfov.value.0).or(height.as_ref().map(|height| height.value.0));
            track.opening.keys.extend(opening.map(|value| Key { frame, value }));
            track.focus_distance.keys.extend(focus_distance.map(|value| Key { frame, value: value.0 }));
        }
        for curve in [&mut track.position, &mut track.look_at, &mut track.up] {
            curve.interpolation = interpolation;
        }
        (track.opening.interpolation, track.focus_distance.interpolation) = (interpolation, interpolation);
        Ok(Some(track))
    }

    /// Values at frames of the scene's next light.
    pub(in crate::load::file) fn light_track<K: LightKeyEntry>(
        &self,
        written: WrittenLightTrack<'_, K>,
    ) -> Result<Option<LightTrack>, SceneError> {
        let WrittenLightTrack { keyframes, interpolation, node } = written;
        let node = node.map(|name| self.look_up(&self.node_names, name, "node")).transpose()?;
        let mut track = LightTrack { light: self.scene.lights.len(), node, ..LightTrack::default() };
        let Some(keyframes) = keyframes else {
            self.without_keyframes(interpolation)?;
            return Ok(node.map(|_| track));
        };
        let times = |entry: &K| (entry.key().frame, entry.key().time);
        let frames = self.frames(keyframes, self.scene.animation.frames_per_second, times)?;
        let interpolation = interpolation.map_or(Interpolation::default(), |name| name.value.into());
        for curve in [&mut track.position, &mut track.direction] {
            curve.interpolation = interpolation;
        }
        track.strength.interpolation = interpolation;
        track.rotation.interpolation = interpolation;
        for (entry, frame) in keyframes.value.iter().zip(frames) {
            let LightKey { position, direction, strength, rotation_degrees, .. } = entry.value.key();
            if position.is_none() && direction.is_none() && strength.is_none() && rotation_degrees.is_none() {
                return Err(self.error(&entry.place, format!("a keyframe of this light states {}", K::STATES)));
            }
            let direction = direction.map(|direction| self.direction(direction)).transpose()?;
            track.position.keys.extend(position.map(|value| Key { frame, value }));
            track.direction.keys.extend(direction.map(|value| Key { frame, value }));
            track.strength.keys.extend(strength.map(|value| Key { frame, value }));
            track.rotation.keys.extend(rotation_degrees.map(|value| Key { frame, value }));
        }
        Ok(Some(track))
    }

    /// Notes where the next shape of the scene is at frames.
    pub(in crate::load::file) fn shape_track(&mut self, written: WrittenTrack<'_>, shape: &Shape) -> Result<(), SceneError> {
        let WrittenTrack { keyframes, interpolation, node, has_motion } = written;
        let fps = self.scene.animation.frames_per_second;
        let track = self.transform_track(keyframes, interpolation, fps)?;
        let node_id = node.map(|name| self.look_up(&self.node_names, name, "node")).transpose()?;
        if track.is_none() && node_id.is_none() {
            return Ok(());
        }
        // One of the two is written.
        let span = keyframes.map(|keys| &keys.place).or(node.map(|name| &name.place)).cloned().unwrap_or_default();
        if has_motion {
            return Err(self
                .error(&span, "a shape has either a `motion` or keyframes")
                .with_help("keyframes say by themselves how the shape moves while the shutter is open"));
        }
        if shape.geometry.is_infinite() {
            return Err(self.error(&span, "an infinite plane cannot move; use a large rectangle"));
        }
        if shape.portal {
            return Err(self.error(&span, "a portal cannot move"));
        }
        if shape.geometry.is_round()
            && let (Some(track), Some(keyframes)) = (&track, keyframes)
            && let Some(at) = track.scale.keys.iter().position(|key| key.value.max_element() != key.value.min_element())
        {
            // The keys of the scale are those entries that state one.
            let entry = keyframes.value.iter().filter(|entry| entry.value.scale.is_some()).nth(at);
            return Err(self.error(entry.map_or(&keyframes.place, |entry| &entry.place), shape.geometry.stays_round()));
        }
        let shape_track = ShapeTrack { shape: self.scene.shapes.len(), track, node: node_id, rest: shape.transform.clone() };
        Arc::make_mut(&mut self.scene.animation).shapes.push(shape_track);
        Ok(())
    }
}
