//! The camera.

use glam::{DAffine3, DMat3};
use serde_json::json;

use super::Writer;
use super::node::columns;
use crate::scene::Projection;

/// The nearest that is seen, in distances of what the camera looks at.
const NEAREST: f64 = 1e-4;
/// The farthest that an orthographic camera sees.
const FARTHEST: f64 = 1e9;

impl Writer<'_> {
    pub fn camera(&mut self) {
        let camera = &self.scene.camera;
        let [right, up, backward] = camera.frame();
        let map = DAffine3 { matrix3: DMat3::from_cols(right, up, backward), translation: camera.position };
        let [width, height] = self.scene.film.size.map(f64::from);
        let aspect = width / height * camera.stretch.abs();
        let near = NEAREST * camera.position.distance(camera.look_at);
        let written = match camera.projection {
            Projection::Perspective { vertical_fov_degrees } => json!({
                "type": "perspective",
                "perspective": { "yfov": vertical_fov_degrees.to_radians(), "aspectRatio": aspect, "znear": near },
            }),
            Projection::Orthographic { height } => json!({
                "type": "orthographic",
                "orthographic": { "xmag": 0.5 * height * aspect, "ymag": 0.5 * height, "znear": near, "zfar": FARTHEST },
            }),
            // Flat cameras alone come here.
            _ => return,
        };
        let lost = [
            (camera.aperture.is_some_and(|aperture| aperture.radius > 0.0), "aperture", "everything is in focus"),
            (camera.shift != [0.0; 2], "shift of the camera's window", "it looks along its axis"),
            (camera.stretch < 0.0, "mirrored picture", "it is not mirrored"),
            (!self.scene.exposure.is_empty(), "motion of the camera", "it rests"),
        ];
        let is_stretched = camera.stretch.abs() != 1.0;
        for (_, what, instead) in lost.into_iter().filter(|(is_there, ..)| *is_there) {
            self.drop(what, "camera", instead);
        }
        if is_stretched {
            self.approximate("pixels that are no squares", "camera", "the picture is as wide as what they show");
        }
        self.lists.cameras.push(written);
        self.lists.nodes.push(json!({ "name": "camera", "camera": 0, "matrix": columns(&map) }));
    }
}
