//! Scenes that stand far from the origin, brought near it.
//!
//! Coordinates in single precision have seven digits. Of a room one unit wide that stands a million units away, one digit would be left.
//! The picture depends on where things are relative to the camera alone, so renderers first move such a scene, in double precision, until its camera is the origin. Scenes that stand near the origin stay as they are, to the bit.

use std::borrow::Cow;
use std::sync::Arc;

use glam::DVec3;

use super::model::Scene;
use super::transform::TransformStep;

/// A scene is moved where its camera is this many times as far from the origin as from the nearest shape.
const FAR: f64 = 4.0;

impl Scene {
    /// The point that renderers take for the origin: (0, 0, 0), or the camera's position where the scene
    /// stands far from the origin.
    #[doc(hidden)]
    pub fn center(&self) -> DVec3 {
        let camera = self.camera.position;
        let of_shapes = self.shapes.iter().map(|shape| shape.farthest_from(camera));
        let balls = self.balls();
        let of_instances =
            self.instances.iter().filter_map(|entry| Some(entry.farthest_from((*balls.get(entry.group)?)?, camera)));
        let nearest = of_shapes.chain(of_instances).fold(f64::INFINITY, f64::min);
        if nearest.is_finite() && camera.length() > FAR * nearest { camera } else { DVec3::ZERO }
    }

    /// The scene relative to its [center](Self::center).
    #[doc(hidden)]
    pub fn centered(&self) -> Cow<'_, Self> {
        let center = self.center();
        if center == DVec3::ZERO {
            return Cow::Borrowed(self);
        }
        let mut moved = self.clone();
        for camera in std::iter::once(&mut moved.camera).chain(&mut moved.exposure) {
            camera.position -= center;
            camera.look_at -= center;
        }
        for shape in &mut moved.shapes {
            shape.transform.steps.push(TransformStep::Translate(-center));
        }
        for instances in &mut moved.instances {
            instances.transform.steps.push(TransformStep::Translate(-center));
            instances.pivot = instances.pivot.map(|pivot| pivot - center);
        }
        for light in &mut moved.lights {
            light.translate(-center);
        }
        for grids in moved.media.iter_mut().filter_map(|medium| medium.grids.as_mut()) {
            *grids = Arc::new(grids.translated(-center));
        }
        Cow::Owned(moved)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::load::load_toml_str;
    use crate::scene::Light;

    fn room(offset: f64) -> Scene {
        let text = format!(
            "[camera]\nposition = [{0:?}, 0, 3]\nlook_at = [{0:?}, 0, 0]\nvfov = 40\n\
             [[material]]\nname = \"a\"\ntype = \"diffuse\"\nreflectance = 0.5\n\
             [[shape]]\ntype = \"sphere\"\ncenter = [{0:?}, 0, 0]\nradius = 1\nmaterial = \"a\"\n\
             [[shape]]\ntype = \"mesh\"\npositions = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\nfaces = [[0, 1, 2]]\nmaterial = \"a\"\n\
             transform = [{{ rotate = [0, 1, 0], degrees = 30 }}, {{ translate = [{0:?}, 0, 0] }}]\n\
             [[light]]\ntype = \"point\"\nposition = [{0:?}, 2, 0]\nintensity = 1\n",
            offset
        );
        load_toml_str(&text, "room", std::path::Path::new("")).expect("the scene is valid")
    }

    #[test]
    fn a_scene_near_the_origin_stays_as_it_is() {
        assert!(matches!(room(5.0).centered(), Cow::Borrowed(_)));
        for name in crate::load::builtin_names() {
            assert_eq!(crate::load::load(Some(name)).expect("built-in scenes load").center(), DVec3::ZERO, "{name}");
        }
    }

    #[test]
    fn a_scene_far_away_keeps_what_lies_between_its_parts() {
        let (far, near) = (room(1e7), room(0.0));
        let moved = far.centered();
        assert_eq!(moved.camera.position, DVec3::ZERO);
        let expected = |p: DVec3| p - near.camera.position;
        let corners = |scene: &Scene| scene.shapes[1].world_positions();
        for (corner, before) in corners(&moved).into_iter().zip(corners(&near)) {
            assert!(corner.as_dvec3().distance(expected(before.as_dvec3())) < 1e-6, "{corner} {before}");
        }
        assert!(moved.shapes[0].origin().distance(expected(DVec3::new(-1e7, 0.0, 0.0))) < 1e-6);
        assert!(matches!(&moved.lights[0], Light::Point(light) if light.position == expected(DVec3::Y * 2.0)));
    }
}
