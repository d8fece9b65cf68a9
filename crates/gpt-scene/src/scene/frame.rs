//! A scene at another frame.

use std::sync::Arc;

use super::animation::{Moment, motion_between};
use super::model::Scene;
use super::shape::{Geometry, Shape};
use super::transform::{Transform, TransformStep};
use super::validate::InvalidScene;

impl Scene {
    /// The scene as it is at a frame, which need not be a whole number. Shapes whose keys move them while the shutter is open are blurred: they
    /// are exactly where their keys put them as it opens and closes, and move evenly in between. So does the camera, which goes through many
    /// places on its way. Meshes that are deformed are deformed as at the
    /// frame itself. Meshes, textures and whatever else does not change are shared.
    ///
    /// # Errors
    /// A frame that cannot be rendered: a number that is not finite, a camera that looks at the point it stands at, a shape that is flattened.
    pub fn at_frame(&self, frame: f64) -> Result<Self, InvalidScene> {
        if !frame.is_finite() {
            return Err(InvalidScene { part: format!("frame {frame}"), message: "a frame is a finite number".to_owned() });
        }
        let animation = &self.animation;
        let mut scene = self.clone();
        scene.animation = Arc::default();
        scene.first_poses = animation.first_poses();
        scene.camera = animation.camera_at(&self.camera, frame);
        let of = |part: String, message: String| InvalidScene { part: format!("frame {frame}: {part}"), message };
        scene.camera.check(scene.film.size).map_err(|message| of("camera".to_owned(), message))?;
        let shutter = scene.camera.shutter;
        scene.exposure = animation.exposure(&self.camera, frame);
        for camera in &scene.exposure {
            camera.check(scene.film.size).map_err(|message| of("camera, while the shutter is open".to_owned(), message))?;
        }
        for track in &animation.deformations {
            let shape = &mut scene.shapes[track.shape];
            shape.geometry = Geometry::Mesh(Arc::new(track.at(animation, frame)));
            shape.check_place().map_err(|message| of(shape.label.clone(), message))?;
        }
        for track in &animation.shapes {
            let shape = &mut scene.shapes[track.shape];
            let at = |time: f64| track.during(animation, Moment { now: frame + time, opening: frame + shutter[0] });
            let (map, motion) = match motion_between(&at, shutter) {
                Ok(Some((map, motion))) => (map, Some(motion)),
                Ok(None) => (at(shutter[0]), None),
                Err(message) => return Err(of(shape.label.clone(), message.to_owned())),
            };
            shape.transform = Transform { steps: vec![TransformStep::Matrix(map)] };
            shape.motion = motion;
            let checked = shape.check_place().and_then(|()| shape.check_motion(shutter).map_err(|(_, message)| message));
            checked.map_err(|message| of(shape.label.clone(), message))?;
        }
        for track in &animation.lights {
            let light = &mut scene.lights[track.light];
            light.set(&track.taken_along(animation, frame));
            light.check().map_err(|message| of(format!("light[{}] ({})", track.light, light.kind_name()), message))?;
        }
        for track in &animation.materials {
            let rest = &self.materials[track.material];
            scene.materials[track.material] = track.at(rest, frame);
        }
        Ok(scene)
    }
}

impl Shape {
    /// True if both have the same mesh, or neither has one.
    fn has_mesh_of(&self, other: &Self) -> bool {
        match (&self.geometry, &other.geometry) {
            (Geometry::Mesh(mesh), Geometry::Mesh(other)) => Arc::ptr_eq(mesh, other),
            _ => true,
        }
    }
}

impl Scene {
    /// True if all meshes are those of another frame of the same scene: none is deformed differently.
    pub fn has_meshes_of(&self, other: &Self) -> bool {
        self.shapes.len() == other.shapes.len()
            && self.shapes.iter().zip(&other.shapes).all(|(shape, other)| shape.has_mesh_of(other))
    }

    /// True if all shapes stand and move, all lights shine and all materials look as in another frame of the same scene, and the camera moves or rests as there.
    pub fn shapes_stand_as_in(&self, other: &Self) -> bool {
        let same = |(shape, other): (&Shape, &Shape)| shape.transform == other.transform && shape.motion == other.motion;
        self.camera.shutter == other.camera.shutter
            && self.exposure.is_empty() == other.exposure.is_empty()
            && self.shapes.len() == other.shapes.len()
            && self.shapes.iter().zip(&other.shapes).all(same)
            && self.lights.len() == other.lights.len()
            && self.lights.iter().zip(&other.lights).all(|(light, other)| light.shines_as(other))
            && self.materials.len() == other.materials.len()
            && self.materials.iter().zip(&other.materials).all(|(material, other)| material.looks_like(other))
    }
}

#[cfg(test)]
mod tests;
