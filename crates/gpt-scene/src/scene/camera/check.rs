//! The rules that a camera keeps.

use glam::{DVec2, DVec3};

use super::blind::blind_share;
use super::model::Eyes;
use super::{Camera, Projection};
use crate::scene::check::{Check, is_positive, within_range};

impl Camera {
    /// Checks that pictures of so many pixels can be taken with the camera.
    pub(in crate::scene) fn check(&self, film: [u32; 2]) -> Check {
        if !self.frame().into_iter().all(DVec3::is_finite) || !self.position.is_finite() {
            return Err("it looks at the point it stands at, or along `up`".into());
        }
        within_range(self.position.length())?;
        match self.projection {
            Projection::Perspective { vertical_fov_degrees: angle } if !(angle > 0.0 && angle < 180.0) => {
                return Err(format!("the field of view must be between 0 and 180 degrees and is {angle}"));
            }
            Projection::Orthographic { height } if !is_positive(height) => {
                return Err(format!("the height of its window must be positive and is {height}"));
            }
            _ => {}
        }
        self.check_aperture()?;
        if !self.shift.into_iter().all(f64::is_finite) {
            return Err("its shift must be finite".into());
        }
        if !(self.stretch.is_finite() && self.stretch != 0.0) {
            return Err("its stretch must be finite and not 0".into());
        }
        let [open, close] = self.shutter;
        if !(open.is_finite() && close.is_finite() && open <= close) {
            return Err("the shutter closes before it opens".into());
        }
        if !(0.0..=1.0).contains(&self.rolling_shutter) {
            return Err(format!("rows are exposed for a share of the time from 0 to 1, and not for {}", self.rolling_shutter));
        }
        if !(self.inward_from.is_finite() && self.inward_from >= 0.0) {
            return Err(format!("its rays cannot start {} from its position", self.inward_from));
        }
        self.check_model()?;
        self.check_views(film)
    }

    fn check_aperture(&self) -> Check {
        let Some(aperture) = self.aperture else { return Ok(()) };
        aperture.check()?;
        if !is_positive(self.focus_distance) {
            return Err("the aperture's radius and the distance in focus must be positive".into());
        }
        if !self.measures_depth_along_axis() {
            return Err(format!("a camera that is {} has no plane to be in focus, so no aperture", self.projection.name()));
        }
        Ok(())
    }

    /// Checks what is right for pictures of any size.
    pub(crate) fn check_model(&self) -> Check {
        if let Some(model) = self.projection.model() {
            model.check()?;
            if self.shift != [0.0; 2] || self.stretch != 1.0 {
                return Err(format!("a camera that is {} has no window to shift or stretch", self.projection.name()));
            }
            if self.stereo.is_some() && model.eyes() == Eyes::One {
                return Err(format!("a camera that is {} has one eye", self.projection.name()));
            }
        }
        self.stereo.map_or(Ok(()), |stereo| stereo.check())
    }

    /// Checks that a picture of so many pixels divides into its views, and that these see something.
    ///
    /// # Errors
    /// The mistake, in words.
    pub fn check_views(&self, film: [u32; 2]) -> Check {
        let [columns, rows] = self.tiles();
        if !film[0].is_multiple_of(columns) || !film[1].is_multiple_of(rows) {
            let [width, height] = film;
            return Err(format!(
                "its picture has {columns} × {rows} views, into which {width} × {height} pixels cannot be divided evenly"
            ));
        }
        let size = DVec2::from(self.view_size(film).map(f64::from));
        self.projection.model().map_or(Ok(()), |model| model.check_view(size))
    }

    /// The share of a picture's places that see nothing where a lens with coefficients turns back on itself; 0 for all other cameras.
    pub(crate) fn blind_share(&self, film: [u32; 2]) -> f64 {
        let size = DVec2::from(self.view_size(film).map(f64::from));
        match &self.projection {
            Projection::BrownConrady(model) => blind_share(model, size),
            Projection::KannalaBrandt(model) => blind_share(model, size),
            _ => 0.0,
        }
    }
}
