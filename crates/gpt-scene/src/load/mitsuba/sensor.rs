//! Sensors with their film and sampler, and integrators.

use std::num::NonZeroU32;
use std::rc::Rc;

use glam::DVec3;

use super::converter::Converter;
use super::plugin::Plugin;
use crate::load::error::SceneError;
use crate::load::file::syntax::{ApertureEntry, CameraTable, FilterEntry, FilterKeys, ProjectionName, RoundAperture};
use crate::load::file::value::{Checked, Exactly};
use crate::load::import::camera_at;
use crate::scene::settings::{MAX_PIXELS, MAX_SIDE};

/// Pixels of a film that states no size.
const DEFAULT_SIZE: [f64; 2] = [768.0, 576.0];

/// Width and height of the whole film, and of what is cropped from it, with its first column and row.
struct Film {
    size: [f64; 2],
    crop: [f64; 2],
    offset: [f64; 2],
}

impl Converter<'_> {
    /// Depth and roulette of the integrator.
    pub fn integrator(&mut self, plugin: &Rc<Plugin>) -> Result<(), SceneError> {
        plugin.visited.set(true);
        self.media.note_integrator(plugin);
        plugin.without_effect(&[
            "strict_normals",
            "block_size",
            "timeout",
            "samples_per_pass",
            "monochrome",
            "aovs",
            "samples",
            "hide_environment",
        ]);
        plugin.without_effect(&["shading_samples", "emitter_samples", "bsdf_samples", "sample_center"]);
        if plugin.flag("hide_emitters", false)? {
            self.setting(plugin, "emitters", "hidden")?;
        }
        match plugin.name.as_str() {
            "direct" => {
                return self.setting(plugin, "max_depth", "2");
            }
            "path" | "volpath" | "volpathmis" | "bdpt" | "mlt" | "pssmlt" | "erpt" | "ptracer" | "prb" | "prb_basic"
            | "prbvolpath" | "volpath_simple" | "photonmapper" | "irrcache" | "ppm" | "sppm" | "mis" | "path_mis" => {}
            "aov" | "moment" | "stokes" | "multichannel" | "adaptive" => {
                for within in plugin.children_of("integrator") {
                    self.integrator(within)?;
                }
                return Ok(());
            }
            other => {
                let what = format!("integrator `{other}`");
                self.approximate(plugin, &what, "paths are traced");
            }
        }
        let depth = plugin.number_or("max_depth", -1.0)?;
        let roulette = plugin.number("rr_depth")?;
        if depth.fract() != 0.0 || !(-1.0..1e9).contains(&depth) {
            return Err(plugin.error(format!("`max_depth` is -1 or a whole number, not {depth}")));
        }
        if depth == 0.0 {
            return Err(plugin.error("with `max_depth` 0 the picture is black"));
        }
        self.setting(plugin, "max_depth", &(depth.max(0.0) as i64).to_string())?;
        match roulette.filter(|depth| (1.0..1e9).contains(depth)) {
            Some(roulette) => self.setting(plugin, "roulette_depth", &(roulette as i64).to_string()),
            None => Ok(()),
        }
    }

    fn setting(&mut self, plugin: &Plugin, name: &'static str, value: &str) -> Result<(), SceneError> {
        plugin.possible(self.scene.file.render.set(name, value))
    }

    pub fn sensor(&mut self, plugin: &Rc<Plugin>) -> Result<(), SceneError> {
        plugin.visited.set(true);
        plugin.without_effect(&["near_clip", "far_clip", "srf"]);
        self.clip = Some(plugin.clone());
        let film = self.film(plugin)?;
        if let Some(sampler) = plugin.first_of("sampler") {
            sampler.visited.set(true);
            sampler.without_effect(&["seed", "jitter", "scramble", "dimension"]);
            let count = sampler.number_or("sample_count", 4.0)?;
            if !(1.0..1e9).contains(&count) {
                return Err(sampler.error(format!("`sample_count` is a whole number of at least 1, not {count}")));
            }
            self.setting(sampler, "spp", &(count as i64).to_string())?;
        }
        let to_world = plugin.transform("to_world")?;
        let degenerate = || plugin.error("`to_world` of the sensor leaves no direction to look along");
        let axis = |axis: DVec3| axis.try_normalize().filter(|axis| axis.is_finite()).ok_or_else(degenerate);
        let (forward, up) = (axis(to_world.matrix3.z_axis)?, axis(to_world.matrix3.y_axis)?);
        if up.cross(forward).length() < 1e-6 {
            return Err(degenerate());
        }
        let side = to_world.matrix3.x_axis;
        let mirrors = up.cross(forward).dot(side) < 0.0;
        // Without a distance, far things are in focus.
        let far = plugin.number_or("far_clip", 1e4)?;
        let focus = plugin.number("focus_distance")?;
        let (place, position) = (plugin.at(), to_world.translation);
        let look_at = position + forward * focus.filter(|distance| *distance > 0.0).unwrap_or(1.0);
        let mut camera = plugin.possible(camera_at(position, look_at, up, &place))?;
        let [close, open] = [plugin.number("shutter_close")?, plugin.number("shutter_open")?];
        if close.is_some() || open.is_some() {
            let times = [open.unwrap_or(0.0), close.or(open).unwrap_or(0.0)];
            camera.shutter = Some(place.at(plugin.possible(Exactly::of(times))?));
        }
        match plugin.name.as_str() {
            "orthographic" | "telecentric" => {
                let (width, height) = (side.length(), to_world.matrix3.y_axis.length());
                if (side.dot(to_world.matrix3.y_axis) / (width * height)).abs() > 1e-6 {
                    self.approximate(plugin, "shear of an orthographic sensor", "it is scaled and turned alone");
                }
                camera.projection = Some(place.at(ProjectionName::Orthographic));
                let shown = 2.0 * height * film.size[1] / film.size[0] * film.crop[1] / film.size[1];
                camera.height = Some(place.at(plugin.possible(Checked::of(shown))?));
                let stretch = if (width / height - 1.0).abs() < 1e-9 { 1.0 } else { width / height };
                let stretch = if mirrors { -stretch } else { stretch };
                if stretch != 1.0 {
                    camera.stretch = Some(place.at(plugin.possible(Checked::of(stretch))?));
                }
                self.shift(plugin, &film, &mut camera)?;
            }
            "perspective" | "thinlens" | "perspective_rdist" | "thinlens_rdist" => {
                let vertical = self.field_of_view(plugin, &film)?;
                camera.vfov = Some(place.at(plugin.possible(Checked::of(vertical))?));
                if mirrors {
                    camera.stretch = Some(place.at(plugin.possible(Checked::of(-1.0))?));
                }
                self.shift(plugin, &film, &mut camera)?;
                if plugin.name.ends_with("_rdist") {
                    self.distortion(plugin, &film, &mut camera)?;
                }
                if plugin.name.starts_with("thinlens") {
                    let radius = plugin.number("aperture_radius")?;
                    let radius = radius.ok_or_else(|| plugin.error("a thin lens needs `aperture_radius`"))?;
                    let distance = focus.unwrap_or(far);
                    if distance.is_nan() || distance <= 0.0 {
                        return Err(plugin.error(format!("`focus_distance` is above 0, not {distance}")));
                    }
                    let radius = plugin.possible(Checked::of(radius))?;
                    camera.aperture = Some(place.at(ApertureEntry::Disk(RoundAperture { radius })));
                    camera.focus_distance = Some(plugin.possible(Checked::of(distance))?);
                }
            }
            // The middle of the picture is straight ahead there too.
            "spherical" => {
                if film.crop != film.size {
                    self.approximate(plugin, "crop of a spherical sensor", "all directions are in the picture");
                }
                if mirrors {
                    self.approximate(plugin, "mirrored spherical sensor", "its picture is not mirrored");
                }
                camera.projection = Some(place.at(ProjectionName::Equirectangular));
            }
            other => return Err(plugin.error(format!("the sensor `{other}` cannot be said here; a perspective one can"))),
        }
        camera.medium = self.medium_around(plugin)?;
        self.scene.file.camera = Some(camera);
        Ok(())
    }

    /// Tells of surfaces that are nearer or farther than the sensor sees there; here it sees them.
    pub fn report_clipped(&mut self) -> Result<(), SceneError> {
        let Some(plugin) = self.clip.take().filter(|plugin| plugin.has("near_clip") || plugin.has("far_clip")) else {
            return Ok(());
        };
        let (near, far) = (plugin.number_or("near_clip", 1e-2)?, plugin.number_or("far_clip", 1e4)?);
        let to_world = plugin.transform("to_world")?;
        let forward = to_world.matrix3.z_axis.normalize_or_zero();
        let depths = self.scene.points().into_iter().map(|point| (point - to_world.translation).dot(forward));
        let (is_near, is_far) = depths
            .filter(|depth| *depth > 0.0)
            .fold((false, false), |(is_near, is_far), depth| (is_near || depth < near, is_far || depth > far));
        for (name, is_clipped) in [("near_clip", is_near), ("far_clip", is_far)] {
            if is_clipped {
                let what = format!("{}: `{name}`", plugin.title());
                self.drop(&plugin, &what, "what lies beyond it is seen");
            }
        }
        Ok(())
    }

    /// Vertical angle of what the cropped film shows.
    fn field_of_view(&mut self, plugin: &Rc<Plugin>, film: &Film) -> Result<f64, SceneError> {
        let aspect = film.size[0] / film.size[1];
        let half_width = self.half_width(plugin, aspect)?;
        let axis = plugin.text("fov_axis")?.unwrap_or("x");
        let is_vertical = axis == "y" || aspect == 1.0 && axis != "diagonal";
        if let Some(fov) = plugin.number("fov")?.filter(|_| is_vertical && film.crop == film.size) {
            return Ok(fov);
        }
        let half_height = half_width / aspect * film.crop[1] / film.size[1];
        Ok(2.0 * half_height.atan().to_degrees())
    }

    /// Half the width, at distance 1, of a picture of this aspect whose field of view a plugin states.
    pub fn half_width(&self, plugin: &Plugin, aspect: f64) -> Result<f64, SceneError> {
        Ok(match (plugin.number("fov")?, plugin.value("focal_length")) {
            (Some(fov), _) => {
                let half = (0.5 * fov).to_radians().tan();
                if !(half > 0.0 && half.is_finite() && fov < 180.0) {
                    return Err(plugin.error(format!("`fov` is an angle above 0 and below 180, not {fov}")));
                }
                match plugin.text("fov_axis")?.unwrap_or("x") {
                    "x" => half,
                    "y" => half * aspect,
                    "smaller" => half * aspect.max(1.0),
                    "larger" => half * aspect.min(1.0),
                    "diagonal" => half * aspect / (1.0 + aspect * aspect).sqrt(),
                    other => return Err(plugin.error(format!("`fov_axis` is x, y, smaller, larger or diagonal, not {other}"))),
                }
            }
            (None, focal) => {
                let millimetres = match focal {
                    None => 50.0,
                    Some(super::plugin::PropertyValue::Text(text)) => {
                        super::number::parse_number(&plugin.place, text.trim().trim_end_matches("mm"))?
                    }
                    Some(super::plugin::PropertyValue::Number(number)) => *number,
                    Some(_) => return Err(plugin.error("`focal_length` is a length as 50mm")),
                };
                // The diagonal of 35 mm film is 43.27 mm.
                let half_diagonal = 0.5 * 36.0_f64.hypot(24.0) / millimetres;
                half_diagonal * aspect / (1.0 + aspect * aspect).sqrt()
            }
        })
    }

    /// Pictures whose middle is not on the camera's axis: a crop off the film's middle, or the film moved aside.
    fn shift(&mut self, plugin: &Rc<Plugin>, film: &Film, camera: &mut CameraTable) -> Result<(), SceneError> {
        let names = ["principal_point_offset_x", "principal_point_offset_y"];
        let shift = [0, 1].map(|side| {
            let beside = film.offset[side] + 0.5 * film.crop[side] - 0.5 * film.size[side];
            let principal = match plugin.value(names[side]) {
                Some(super::plugin::PropertyValue::Number(number)) => *number,
                _ => 0.0,
            };
            (beside + principal * film.size[side]) / film.crop[side]
        });
        if shift.iter().any(|shift| shift.abs() > 1e-12) {
            camera.shift = Some(plugin.at().at(plugin.possible(Exactly::of([shift[0], -shift[1]]))?));
        }
        Ok(())
    }

    /// Radial distortion, `kc`: k1 and k2 of the formula that OpenCV has.
    fn distortion(&mut self, plugin: &Rc<Plugin>, film: &Film, camera: &mut CameraTable) -> Result<(), SceneError> {
        let Some(written) = plugin.text("kc")? else { return Ok(()) };
        let words = written.split([',', ' ']).filter(|word| !word.is_empty());
        let numbers = words.map(|word| super::number::parse_number(&plugin.place, word)).collect::<Result<Vec<f64>, _>>()?;
        let [k1, k2] = numbers[..] else {
            return Err(plugin.error(format!("`kc` is two numbers, as \"0.1, 0\", not \"{written}\"")));
        };
        if k1 == 0.0 && k2 == 0.0 {
            return Ok(());
        }
        if camera.stretch.take().is_some() {
            self.approximate(plugin, "mirrored picture of a lens that distorts", "it is not mirrored");
        }
        (camera.vfov, camera.shift) = (None, None);
        let focal = 0.5 * film.size[0] / self.half_width(plugin, film.size[0] / film.size[1])?;
        let principal = [0, 1].map(|side| 0.5 * film.size[side] - film.offset[side]);
        let size = film.crop.map(|side| NonZeroU32::new(side as u32).unwrap_or(NonZeroU32::MIN));
        let place = plugin.at();
        let coefficient = |value: f64| plugin.possible(Checked::of(value));
        camera.projection = Some(place.at(ProjectionName::BrownConrady));
        camera.focal = Some(place.at(Exactly([plugin.possible(Checked::of(focal))?; 2])));
        camera.principal_point = Some(place.at(plugin.possible(Exactly::of(principal))?));
        camera.image_size = Some(place.at(Exactly(size)));
        camera.radial = Some(place.at(vec![coefficient(k1)?, coefficient(k2)?]));
        Ok(())
    }

    fn film(&mut self, sensor: &Rc<Plugin>) -> Result<Film, SceneError> {
        let mut whole = Film { size: DEFAULT_SIZE, crop: DEFAULT_SIZE, offset: [0.0; 2] };
        let Some(film) = sensor.first_of("film").cloned() else {
            self.size(sensor, &whole)?;
            self.filter(None)?;
            return Ok(whole);
        };
        film.visited.set(true);
        film.without_effect(&[
            "pixel_format",
            "component_format",
            "file_format",
            "banner",
            "high_quality_edges",
            "sample_border",
            "compensate",
        ]);
        film.without_effect(&[
            "attach_log",
            "gamma",
            "exposure",
            "key",
            "burn",
            "tonemap_method",
            "file_name",
            "filename",
            "channel_names",
            "label",
        ]);
        whole.size = [film.number_or("width", DEFAULT_SIZE[0])?, film.number_or("height", DEFAULT_SIZE[1])?];
        whole.crop = [film.number_or("crop_width", whole.size[0])?, film.number_or("crop_height", whole.size[1])?];
        whole.offset = [film.number_or("crop_offset_x", 0.0)?, film.number_or("crop_offset_y", 0.0)?];
        self.size(&film, &whole)?;
        self.filter(film.first_of("rfilter"))?;
        Ok(whole)
    }

    fn size(&mut self, plugin: &Plugin, film: &Film) -> Result<(), SceneError> {
        let whole = |side: f64| side.fract() == 0.0 && (1.0..=f64::from(MAX_SIDE)).contains(&side);
        let [width, height] = film.crop;
        if !(film.size.into_iter().all(|side| side >= 1.0)
            && whole(width)
            && whole(height)
            && width * height <= MAX_PIXELS as f64)
        {
            return Err(plugin.error(format!("a picture of {width} x {height} pixels cannot be rendered")));
        }
        let pixels = |side: f64| NonZeroU32::new(side as u32).unwrap_or(NonZeroU32::MIN);
        self.scene.file.film.size = Some(Exactly([pixels(width), pixels(height)]));
        Ok(())
    }

    fn filter(&mut self, filter: Option<&Rc<Plugin>>) -> Result<(), SceneError> {
        let Some(filter) = filter else {
            // Mitsuba's default: a deviation of half a pixel.
            return self.set_filter(None, FilterEntry::Gaussian, 1.5);
        };
        filter.visited.set(true);
        let (make, radius): (fn(FilterKeys) -> FilterEntry, f64) = match filter.name.as_str() {
            "box" => (FilterEntry::Box, filter.number_or("radius", 0.5)?),
            "tent" => (FilterEntry::Tent, filter.number_or("radius", 1.0)?),
            // Cut off at three deviations here, at four there.
            "gaussian" => (FilterEntry::Gaussian, 3.0 * filter.number_or("stddev", 0.5)?),
            other => {
                let what = format!("rfilter `{other}`");
                filter.without_effect(&["b", "c", "lobes", "radius", "stddev"]);
                self.approximate(
                    filter,
                    &what,
                    "a gaussian of half a pixel's deviation is taken: filters have no negative parts here",
                );
                (FilterEntry::Gaussian, 1.5)
            }
        };
        self.set_filter(Some(filter), make, radius.clamp(0.5, 16.0))
    }

    fn set_filter(
        &mut self,
        plugin: Option<&Rc<Plugin>>,
        make: fn(FilterKeys) -> FilterEntry,
        radius: f64,
    ) -> Result<(), SceneError> {
        let radius = Checked::of(radius);
        let radius = match plugin {
            Some(plugin) => Some(plugin.possible(radius)?),
            None => radius.ok(),
        };
        self.scene.file.film.filter = Some(make(FilterKeys { radius }));
        Ok(())
    }
}
