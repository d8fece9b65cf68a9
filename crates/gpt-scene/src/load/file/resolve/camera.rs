//! `[camera]`

use glam::DVec3;

use crate::load::error::SceneError;
use crate::load::file::resolver::Resolver;
use crate::load::file::syntax::{ApertureEntry, CameraTable};
use crate::load::file::value::vector;
use crate::scene::camera::BLADES;
use crate::scene::{Aperture, ApertureShape, Camera, Stereo};

impl Resolver<'_> {
    /// `has_size`: the file states how many pixels its picture has.
    pub(super) fn camera(&mut self, written: &CameraTable, has_size: bool) -> Result<(), SceneError> {
        let position = vector(written.position);
        let look_at = vector(written.look_at.value);
        let up = written.up.as_ref().map_or(DVec3::Y, |up| vector(up.value));
        let Some(forward) = (look_at - position).try_normalize() else {
            return Err(self.error(&written.look_at.place, "the camera looks at the point it stands at"));
        };
        if up.try_normalize().is_none_or(|up| up.cross(forward).length() < 1e-6) {
            let span = written.up.as_ref().map_or(&written.look_at.place, |up| &up.place);
            let message = "`up` is zero or lies along the viewing direction, so which way is up is not known";
            return Err(self.error(span, message).with_help("choose an `up` that is not parallel to look_at - position"));
        }
        let projection = self.projection(written, has_size)?;
        let aperture = self.aperture(written)?;
        let shutter = written.shutter.as_ref().map_or([0.0, 1.0], |shutter| shutter.value.map(|time| time.0));
        if let Some(written) = &written.shutter
            && shutter[0] > shutter[1]
        {
            return Err(self.error(&written.place, "the shutter closes before it opens"));
        }
        let stretch = written.stretch.as_ref().map_or(1.0, |stretch| stretch.value.0);
        if let Some(written) = &written.stretch
            && !(1e-6..=1e6).contains(&stretch.abs())
        {
            return Err(self.error(&written.place, format!("a stretch is from 1e-6 to 1e6, or that below 0, and not {stretch}")));
        }
        self.scene.camera_medium = written.medium.as_ref().map(|name| self.medium_id(name)).transpose()?;
        let stereo = written.stereo.as_ref().map(|written| Stereo {
            layout: written.value.layout.0,
            eye_distance: written.value.eye_distance.0,
            convergence: written.value.convergence.map(|distance| distance.0),
        });
        self.scene.camera = Camera {
            position,
            look_at,
            up,
            projection,
            shift: written.shift.as_ref().map_or([0.0; 2], |shift| shift.value.map(|part| part.0)),
            stretch,
            aperture,
            focus_distance: written.focus_distance.map_or((look_at - position).length(), |distance| distance.0),
            stereo,
            shutter,
            rolling_shutter: written.rolling_shutter.map_or(1.0, |share| share.0),
            inward_from: 0.0,
        };
        self.check_model(written)
    }

    /// None for a pinhole: no aperture, or one of radius 0.
    fn aperture(&self, written: &CameraTable) -> Result<Option<Aperture>, SceneError> {
        let Some(aperture) = &written.aperture else { return Ok(None) };
        if written.focus_distance.is_none() {
            return Err(self.error(&aperture.place, "an aperture needs the key `focus_distance`"));
        }
        let (shape, radius) = match &aperture.value {
            ApertureEntry::Disk(disk) => (ApertureShape::Disk, disk.radius),
            ApertureEntry::Square(square) => (ApertureShape::Square, square.radius),
            ApertureEntry::Polygon(polygon) => {
                let blades = polygon.blades.as_ref().map_or(6, |blades| blades.value);
                if let Some(written) = &polygon.blades
                    && !BLADES.contains(&blades)
                {
                    let message = format!("an aperture has {} to {} blades", BLADES.start(), BLADES.end());
                    return Err(self.error(&written.place, message));
                }
                let rotation_degrees = polygon.rotation.map_or(0.0, |rotation| rotation.0);
                (ApertureShape::Polygon { blades, rotation_degrees }, polygon.radius)
            }
        };
        Ok((radius.0 > 0.0).then_some(Aperture { shape, radius: radius.0 }))
    }
}
