//! The camera of a program that has flat pictures alone.

use std::borrow::Cow;

use glam::DVec2;

use super::losses::Losses;
use crate::scene::{Camera, Projection, Scene};

/// Vertical field of view, in degrees, of what stands for a camera that sees around.
const AROUND: f64 = 90.0;

/// The scene with a camera that has a flat picture and one eye, and what that loses. A projection that the format `has` stays.
pub fn with_flat_camera<'s>(scene: &'s Scene, losses: &mut Losses, has: fn(&Projection) -> bool) -> Cow<'s, Scene> {
    let camera = &scene.camera;
    if camera.stereo.is_none() && (camera.projection.model().is_none() || has(&camera.projection)) {
        return Cow::Borrowed(scene);
    }
    let mut flat = scene.clone();
    if let Some(stereo) = camera.stereo {
        flat.film.size = camera.view_size(scene.film.size);
        let instead = "one eye is in the middle, with half of the picture";
        losses.drop(format!("stereo {}", crate::choice::Choice::name(stereo.layout)), "camera", instead);
    }
    let cameras = std::iter::once(&mut flat.camera).chain(&mut flat.exposure);
    let size = DVec2::from(flat.film.size.map(f64::from));
    cameras.for_each(|camera| *camera = flattened(camera, size, has));
    match camera.projection {
        Projection::BrownConrady(model) if !model.is_undistorted() => {
            losses.approximate("distortion of the lens", "camera", "a pinhole of its focal lengths stands for it");
        }
        Projection::KannalaBrandt(_) => {
            losses.approximate("fisheye lens", "camera", "a pinhole of its focal lengths stands for it");
        }
        Projection::Perspective { .. } | Projection::Orthographic { .. } | Projection::BrownConrady(_) => {}
        other if has(&other) => {}
        other => {
            losses.approximate(format!("projection {}", other.name()), "camera", format!("a perspective of {AROUND} degrees"))
        }
    }
    Cow::Owned(flat)
}

/// The flat camera that is nearest, for a picture of this size.
fn flattened(camera: &Camera, size: DVec2, has: fn(&Projection) -> bool) -> Camera {
    let one_eyed = Camera { stereo: None, ..camera.clone() };
    let intrinsics = match camera.projection {
        Projection::Perspective { .. } | Projection::Orthographic { .. } => return one_eyed,
        Projection::BrownConrady(model) => model.intrinsics,
        Projection::KannalaBrandt(model) => model.intrinsics,
        other if has(&other) => return one_eyed,
        _ => return Camera { projection: Projection::Perspective { vertical_fov_degrees: AROUND }, ..one_eyed },
    };
    let window = intrinsics.window();
    let projection = Projection::Perspective { vertical_fov_degrees: 2.0 * window.half_extent.y.atan().to_degrees() };
    let stretch = window.half_extent.x / window.half_extent.y * size.y / size.x;
    // Square pixels are to be so to the bit.
    let stretch = if (stretch - 1.0).abs() < 1e-9 { 1.0 } else { stretch };
    Camera { projection, shift: window.shift.to_array(), stretch, ..one_eyed }
}
