//! A scene seen in another way from where its camera stands.

use glam::DVec2;

use super::camera::{
    Camera, CameraPreset, CubeLayout, CubeMap, Cylindrical, Equirectangular, Eyes, Fisheye, FisheyeFit, FisheyeMapping,
    Projection, Stereo, StereoLayout,
};
use super::model::Scene;

/// The vertical field of view of a camera that has none, in degrees.
const FIELD_OF_VIEW: f64 = 40.0;
/// One over the share of the distance of what is looked at by which eyes stand apart, a rule of stereoscopic photography.
const EYES_IN_DISTANCE: f64 = 30.0;

impl Camera {
    /// The vertical field of view of a perspective, in degrees.
    fn field_of_view(&self) -> f64 {
        match self.projection {
            Projection::Perspective { vertical_fov_degrees } => vertical_fov_degrees,
            _ => FIELD_OF_VIEW,
        }
    }

    /// Two eyes as the camera has them, or for the point that it looks at.
    fn eyes(&self, layout: StereoLayout) -> Stereo {
        let distance = self.position.distance(self.look_at);
        let own =
            self.stereo.unwrap_or(Stereo { layout, eye_distance: distance / EYES_IN_DISTANCE, convergence: Some(distance) });
        Stereo { layout, ..own }
    }

    /// The camera at its place that sees so.
    fn seeing(&self, preset: CameraPreset) -> Self {
        let fov = self.field_of_view();
        let perspective = Projection::Perspective { vertical_fov_degrees: fov };
        let panorama = Projection::Equirectangular(Equirectangular::default());
        let (projection, stereo) = match preset {
            CameraPreset::Perspective => (perspective, None),
            CameraPreset::Orthographic => {
                let distance = self.position.distance(self.look_at);
                let seen = match self.projection {
                    Projection::Orthographic { height } => height,
                    _ => 2.0 * distance * (0.5 * fov).to_radians().tan(),
                };
                (Projection::Orthographic { height: seen }, None)
            }
            CameraPreset::Equirectangular => (panorama, None),
            CameraPreset::Cylindrical => (Projection::Cylindrical(Cylindrical::default()), None),
            CameraPreset::Fisheye => {
                let fisheye = Fisheye { mapping: FisheyeMapping::Equidistant, fov_degrees: 180.0, fit: FisheyeFit::Inside };
                (Projection::Fisheye(fisheye), None)
            }
            CameraPreset::CubeMap => (Projection::CubeMap(CubeMap { layout: CubeLayout::Row }), None),
            CameraPreset::Stereo => {
                let has_one_eye = self.projection.model().is_some_and(|model| model.eyes() == Eyes::One);
                (if has_one_eye { perspective } else { self.projection }, Some(self.eyes(StereoLayout::SideBySide)))
            }
            CameraPreset::StereoPanorama => (panorama, Some(self.eyes(StereoLayout::TopBottom))),
        };
        let mut camera = Self { projection, stereo, ..self.clone() };
        if camera.projection.model().is_some() {
            (camera.shift, camera.stretch) = ([0.0; 2], 1.0);
        }
        if !camera.measures_depth_along_axis() {
            camera.aperture = None;
        }
        camera
    }
}

impl Scene {
    /// Sees the scene so from where its camera stands, and goes, in a picture as high as before, whose width fits.
    #[doc(hidden)]
    pub fn see_by(&mut self, preset: CameraPreset) {
        let [width, height] = self.camera.view_size(self.film.size);
        // One of several views is as large as the picture shall be.
        let is_flat = self.camera.window(DVec2::new(f64::from(width), f64::from(height))).is_some();
        let flat_width = if is_flat { width } else { height.saturating_mul(4) / 3 }.max(1);
        let times = |factor: u32| height.saturating_mul(factor);
        self.camera = self.camera.seeing(preset);
        self.exposure = self.exposure.iter().map(|pose| pose.seeing(preset)).collect();
        self.film.size = match preset {
            CameraPreset::Perspective | CameraPreset::Orthographic => [flat_width, height],
            CameraPreset::Equirectangular => [times(2), height],
            CameraPreset::Cylindrical => [times(3), height],
            CameraPreset::Fisheye => [height, height],
            CameraPreset::CubeMap => {
                let side = height.div_ceil(2);
                [side.saturating_mul(6), side]
            }
            CameraPreset::Stereo => {
                let is_bent = self.camera.window(DVec2::ONE).is_none();
                [if is_bent { width } else { flat_width }.saturating_mul(2), height]
            }
            CameraPreset::StereoPanorama => [times(2), times(2)],
        };
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::choice::Choice;
    use crate::scene::{Aperture, ApertureShape};

    fn scene() -> Scene {
        let mut scene = Scene::default();
        scene.film.size = [300, 200];
        scene.camera = Camera {
            position: DVec3::new(0.0, 0.0, 6.0),
            shift: [0.1, 0.0],
            stretch: 1.5,
            aperture: Some(Aperture { shape: ApertureShape::Disk, radius: 0.1 }),
            focus_distance: 5.0,
            ..Camera::default()
        };
        scene
    }

    /// Every way from every other one is a camera that can take its picture, in the size that is said of it.
    #[test]
    fn every_preset_is_a_camera_that_can_be() {
        let sizes = [[300, 200], [300, 200], [400, 200], [600, 200], [200, 200], [600, 100], [600, 200], [400, 400]];
        for (preset, size) in CameraPreset::ALL.into_iter().zip(sizes) {
            let mut seen = scene();
            seen.see_by(preset);
            assert_eq!(seen.film.size, size, "{}", preset.name());
            for again in CameraPreset::ALL {
                let mut twice = seen.clone();
                twice.see_by(again);
                assert_eq!(twice.camera.check(twice.film.size), Ok(()), "{}, then {}", preset.name(), again.name());
                assert_eq!(twice.camera.position, seen.camera.position);
            }
        }
        // Negative control: the settings of a window do not fit a panorama.
        let kept = Camera { projection: Projection::Equirectangular(Equirectangular::default()), ..scene().camera };
        assert!(kept.check([400, 200]).is_err());
    }

    #[test]
    fn what_the_scene_states_stays() {
        let mut seen = scene();
        seen.camera.stereo = Some(Stereo { layout: StereoLayout::TopBottom, eye_distance: 0.5, convergence: None });
        seen.film.size = [300, 400];
        seen.see_by(CameraPreset::StereoPanorama);
        assert_eq!(seen.camera.stereo.map(|eyes| (eyes.eye_distance, eyes.convergence)), Some((0.5, None)));
        assert_eq!(seen.film.size, [400, 400]);
        let mut parallel = scene();
        parallel.see_by(CameraPreset::Orthographic);
        let Projection::Orthographic { height } = parallel.camera.projection else { panic!("it is parallel") };
        assert!((height - 12.0 * 20.0_f64.to_radians().tan()).abs() < 1e-12);
        assert_eq!((parallel.camera.shift, parallel.camera.aperture.is_some()), ([0.1, 0.0], true));
    }
}
