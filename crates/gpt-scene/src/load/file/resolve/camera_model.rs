//! How a camera sees: its projection, perhaps from the file of a calibration.

use std::path::Path;

use crate::load::error::SceneError;
use crate::load::file::calibration::{self, Calibration, Lens};
use crate::load::file::resolver::Resolver;
use crate::load::file::syntax::{CameraTable, ProjectionName};
use crate::load::file::value::Located;
use crate::load::place::Place;
use crate::scene::settings::{MAX_PIXELS, MAX_SIDE};
use crate::scene::{
    BrownConrady, CubeLayout, CubeMap, Cylindrical, Equirectangular, Fisheye, FisheyeFit, FisheyeMapping, Intrinsics,
    KannalaBrandt, Projection,
};

impl Resolver<'_> {
    /// The projection that a camera's keys state. A picture without a size takes that of a calibration.
    pub(super) fn projection(&mut self, written: &CameraTable, has_size: bool) -> Result<Projection, SceneError> {
        let unnamed = if written.calibration.is_some() { ProjectionName::BrownConrady } else { ProjectionName::Perspective };
        let name = written.projection.as_ref().map_or(unnamed, |name| name.value);
        written.check_keys(name).map_err(|(place, message)| self.error(place, message))?;
        if let Some(id) = written.calibration_id.as_ref().filter(|_| written.calibration.is_none()) {
            return Err(self.error(&id.place, "`calibration_id` belongs to `calibration`"));
        }
        if let Some(file) = &written.calibration {
            return self.calibrated(written, file, has_size);
        }
        let value = |value: Option<f64>| value.unwrap_or_default();
        let fov = written.fov.as_ref().map(|fov| fov.value.0);
        let azimuth_degrees = written.azimuth.as_ref().map(|range| range.value.map(|angle| angle.0));
        let elevation_degrees = written.elevation.as_ref().map(|range| range.value.map(|angle| angle.0));
        Ok(match name {
            ProjectionName::Perspective => {
                Projection::Perspective { vertical_fov_degrees: value(written.vfov.as_ref().map(|vfov| vfov.value.0)) }
            }
            ProjectionName::Orthographic => {
                Projection::Orthographic { height: value(written.height.as_ref().map(|height| height.value.0)) }
            }
            ProjectionName::Equirectangular => {
                let full = Equirectangular::default();
                Projection::Equirectangular(Equirectangular {
                    azimuth_degrees: azimuth_degrees.unwrap_or(full.azimuth_degrees),
                    elevation_degrees: elevation_degrees.unwrap_or(full.elevation_degrees),
                })
            }
            ProjectionName::Cylindrical => {
                let azimuth_degrees = azimuth_degrees.unwrap_or(Cylindrical::default().azimuth_degrees);
                Projection::Cylindrical(Cylindrical { azimuth_degrees, elevation_degrees })
            }
            ProjectionName::Fisheye => Projection::Fisheye(Fisheye {
                mapping: written.mapping.as_ref().map_or(FisheyeMapping::Equidistant, |mapping| mapping.value.0),
                fov_degrees: value(fov),
                fit: written.fit.as_ref().map_or(FisheyeFit::Inside, |fit| fit.value.0),
            }),
            ProjectionName::CubeMap => {
                Projection::CubeMap(CubeMap { layout: written.layout.as_ref().map_or(CubeLayout::Row, |layout| layout.value.0) })
            }
            ProjectionName::BrownConrady => {
                let tangential = written.tangential.as_ref().map_or([0.0; 2], |pair| pair.value.map(|number| number.0));
                Projection::BrownConrady(BrownConrady::new(self.intrinsics(written), self.radial(written, name)?, tangential))
            }
            ProjectionName::KannalaBrandt => {
                let radial = self.radial(written, name)?;
                Projection::KannalaBrandt(KannalaBrandt::new(self.intrinsics(written), radial, fov.unwrap_or(360.0)))
            }
        })
    }

    fn intrinsics(&self, written: &CameraTable) -> Intrinsics {
        let image_size = written.image_size.as_ref().map_or(self.scene.film.size, |size| size.value.map(|side| side.get()));
        let middle = image_size.map(|side| 0.5 * f64::from(side));
        Intrinsics {
            image_size,
            focal: written.focal.as_ref().map_or([1.0; 2], |focal| focal.value.map(|length| length.0)),
            principal_point: written.principal_point.as_ref().map_or(middle, |point| point.value.map(|part| part.0)),
        }
    }

    /// Coefficients, those that are left out as 0.
    fn radial<const N: usize>(&self, written: &CameraTable, name: ProjectionName) -> Result<[f64; N], SceneError> {
        let Some(radial) = &written.radial else { return Ok([0.0; N]) };
        if radial.value.len() > N {
            let (found, name) = (radial.value.len(), name.name());
            return Err(self.error(&radial.place, format!("{name} has {N} radial coefficients, and these are {found}")));
        }
        let mut coefficients = [0.0; N];
        for (coefficient, value) in coefficients.iter_mut().zip(&radial.value) {
            *coefficient = value.0;
        }
        Ok(coefficients)
    }

    fn calibrated(&mut self, written: &CameraTable, file: &Located<String>, has_size: bool) -> Result<Projection, SceneError> {
        let path = self.folder.join(&file.value);
        let lens = match written.projection.as_ref().map(|name| name.value) {
            Some(ProjectionName::KannalaBrandt) => Some(Lens::KannalaBrandt),
            Some(_) => Some(Lens::BrownConrady),
            None => None,
        };
        if !self.files().exists(&path) {
            return Err(self.error(&file.place, format!("there is no file {}", crate::load::error::show(&path))));
        }
        let cameras = calibration::read(self.files(), &path, lens)?;
        let Calibration { image_size, focal, principal_point, lens, coefficients, .. } =
            self.chosen(written, file, &path, cameras)?;
        if !has_size && let Some(size) = image_size {
            let pixels = size.into_iter().map(u64::from).product::<u64>();
            if size.into_iter().any(|side| side == 0 || side > MAX_SIDE) || pixels > MAX_PIXELS {
                let message = format!("its pictures have {} × {} pixels, and such ones cannot be rendered", size[0], size[1]);
                return Err(self.error(&file.place, message).with_help("state `size` in [film]"));
            }
            self.scene.film.size = size;
        }
        let intrinsics = Intrinsics { image_size: image_size.unwrap_or(self.scene.film.size), focal, principal_point };
        let [k1, k2, p1, p2, k3, k4, k5, k6] = coefficients;
        Ok(match lens {
            Lens::BrownConrady => Projection::BrownConrady(BrownConrady::new(intrinsics, [k1, k2, k3, k4, k5, k6], [p1, p2])),
            Lens::KannalaBrandt => {
                let fov_degrees = written.fov.as_ref().map_or(360.0, |fov| fov.value.0);
                // A fisheye's four stand in the same places.
                Projection::KannalaBrandt(KannalaBrandt::new(intrinsics, [k1, k2, p1, p2], fov_degrees))
            }
        })
    }

    /// The camera of a file that is asked for.
    fn chosen(
        &self,
        written: &CameraTable,
        file: &Located<String>,
        path: &Path,
        cameras: Vec<Calibration>,
    ) -> Result<Calibration, SceneError> {
        let name = crate::load::error::show(path);
        let ids = cameras.iter().filter_map(|camera| camera.id).map(|id| id.to_string()).collect::<Vec<_>>().join(", ");
        let count = cameras.len();
        match &written.calibration_id {
            Some(id) => cameras.into_iter().find(|camera| camera.id == Some(id.value)).ok_or_else(|| {
                let help = if ids.is_empty() { "its camera has no number".to_owned() } else { format!("it has {ids}") };
                self.error(&id.place, format!("{name} has no camera {}", id.value)).with_help(help)
            }),
            None if count == 1 => Ok(cameras.into_iter().next().unwrap_or_default()),
            None => {
                let message = format!("{name} has {count} cameras: `calibration_id` says which one is meant");
                Err(self.error(&file.place, message).with_help(format!("it has {ids}")))
            }
        }
    }

    /// Checks how the camera sees, and warns where a part of its picture stays black.
    pub(super) fn check_model(&mut self, written: &CameraTable) -> Result<(), SceneError> {
        let camera = &self.scene.camera;
        let anywhere = written.projection.as_ref().map_or(&written.look_at.place, |name| &name.place);
        let of_key = |place: Option<&Place>| place.unwrap_or(anywhere).clone();
        let ranges = [written.azimuth.as_ref().map(|range| &range.place), written.elevation.as_ref().map(|range| &range.place)];
        let place = match camera.projection {
            // The first of two ranges that is wrong is reported.
            Projection::Equirectangular(model) => of_key(ranges[usize::from(model.has_right_azimuth())]),
            Projection::Cylindrical(model) => of_key(ranges[usize::from(model.has_right_azimuth())]),
            Projection::Fisheye(_) => of_key(written.fov.as_ref().map(|fov| &fov.place)),
            _ => anywhere.clone(),
        };
        camera.check_model().map_err(|message| self.error(&place, message))?;
        if camera.aperture.is_some() && !camera.measures_depth_along_axis() {
            let place = of_key(written.aperture.as_ref().map(|aperture| &aperture.place));
            let message = format!("a camera that is {} has no plane to be in focus, so no aperture", camera.projection.name());
            return Err(self.error(&place, message));
        }
        let size = self.scene.film.size;
        camera.check_views(size).map_err(|message| {
            let place = of_key(written.stereo.as_ref().map(|stereo| &stereo.place));
            let [columns, rows] = camera.tiles();
            let [width, height] = [(size[0] / columns).max(1), (size[1] / rows).max(1)];
            // The sides of a cube are squares.
            let height = if matches!(camera.projection, Projection::CubeMap(_)) { width } else { height };
            let error = self.error(&place, message);
            if columns * rows == 1 {
                error
            } else {
                error.with_help(format!("a right size = [{}, {}] in [film]", width * columns, height * rows))
            }
        })?;
        let share = camera.blind_share(size);
        if share > 0.0 {
            let name = self.document.name;
            self.scene.warnings.push(format!(
                "{name}: camera: {:.1} % of the picture see nothing and stay black: they lie beyond where the lens's polynomial turns back",
                100.0 * share
            ));
        }
        Ok(())
    }
}
