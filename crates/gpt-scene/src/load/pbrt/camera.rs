//! The camera with its film, its filter and its sampler, and the integrator.

use std::num::NonZeroU32;

use glam::DVec3;

use super::color_space::RgbSpace;
use super::converter::Converter;
use super::graphics_state::Maps;
use super::parameter::{Entity, Kind};
use super::world::CameraRecord;
use crate::load::error::SceneError;
use crate::load::file::keyframes::CameraKeyEntry;
use crate::load::file::syntax::{ApertureEntry, CameraTable, FilterEntry, FilterKeys, ProjectionName, RoundAperture};
use crate::load::file::value::{Checked, Exactly, Number};
use crate::load::import::camera_at;
use crate::scene::settings::{MAX_PIXELS, MAX_SIDE};

/// Pixels of a film that states no size.
const DEFAULT_SIZE: [i64; 2] = [1280, 720];
/// Edges of paths from which on there is no end to them here.
const ENDLESS: i64 = 1_000_000;

/// The film's width and height, and the first and the last pixel of what is cropped from it.
struct Film {
    size: [f64; 2],
    low: [f64; 2],
    high: [f64; 2],
}

/// The part of the plane at distance 1 that the whole film shows.
struct Window {
    low: [f64; 2],
    high: [f64; 2],
}

impl Converter<'_> {
    /// How long paths are, and whether media are rendered.
    pub fn integrator(&mut self) -> Result<(), SceneError> {
        let world = self.world.clone();
        let Some(entity) = &world.integrator else { return self.max_depth(5) };
        // They say how light is found, and not which.
        entity.without_effect(&[
            "lightsampler",
            "sampledirect",
            "visualizestrategies",
            "visualizeweights",
            "samplelights",
            "samplebsdf",
            "mutationsperpixel",
            "chains",
            "bootstrapsamples",
            "largestepprobability",
            "sigma",
            "photonsperiteration",
            "radius",
            "seed",
        ]);
        match entity.name.as_str() {
            "volpath" | "simplevolpath" | "bdpt" | "mlt" => {}
            "path" | "simplepath" | "lightpath" | "sppm" | "randomwalk" => self.blind = Some(entity.title()),
            other => {
                let instead = "the light that paths bring is rendered";
                self.approximate(&entity.spot, format!("Integrator `{other}`"), instead);
                self.blind = Some(entity.title());
                entity.all_without_effect();
            }
        }
        if entity.flag_or("regularize", false)? {
            self.drop(entity.spot_of("regularize"), "Integrator: `regularize`", "surfaces are as smooth as they are");
        }
        let depth = entity.integer_or("maxdepth", 5)?;
        self.report_unused(entity);
        if depth < 0 {
            return Err(entity.spot_of("maxdepth").error(format!("`maxdepth` is at least 0, and not {depth}")));
        }
        self.max_depth(depth)
    }

    /// A path that sees an emitter has depth 0 there.
    fn max_depth(&mut self, depth: i64) -> Result<(), SceneError> {
        let edges = if depth >= ENDLESS { 0 } else { depth + 1 };
        let set = self.scene.file.render.set("max_depth", &edges.to_string());
        set.map_err(|message| SceneError::in_file("max_depth", message))
    }

    /// Samples of a pixel; which they are is ours.
    pub fn sampler(&mut self) -> Result<(), SceneError> {
        let world = self.world.clone();
        let Some(entity) = &world.sampler else { return self.samples(16, None) };
        entity.without_effect(&["seed", "randomization", "jitter"]);
        let count = if entity.name == "stratified" {
            entity.integer_or("xsamples", 4)?.saturating_mul(entity.integer_or("ysamples", 4)?)
        } else {
            entity.integer_or("pixelsamples", 16)?
        };
        self.report_unused(entity);
        if !(1..1_000_000_000).contains(&count) {
            return Err(entity.error(format!("samples of a pixel are a whole number of at least 1, and not {count}")));
        }
        self.samples(count, Some(entity))
    }

    fn samples(&mut self, count: i64, entity: Option<&Entity>) -> Result<(), SceneError> {
        let set = self.scene.file.render.set("spp", &count.to_string());
        match entity {
            Some(entity) => entity.possible(set),
            None => set.map_err(|message| SceneError::in_file("spp", message)),
        }
    }

    /// The camera, and the film behind it.
    pub fn camera(&mut self) -> Result<(), SceneError> {
        let world = self.world.clone();
        let film = self.film()?;
        self.filter()?;
        let Some(record) = &world.camera else { return self.expose(None) };
        self.expose(Some(&record.entity))?;
        let CameraRecord { entity, maps, medium } = record;
        let from_camera = maps.map(|map| map.inverse());
        let [map, _] = from_camera;
        let place = entity.spot.place();
        let degenerate = || entity.error("the transform before the camera leaves no direction to look along");
        let axes = [map.matrix3.x_axis, map.matrix3.y_axis, map.matrix3.z_axis];
        let lengths = axes.map(DVec3::length);
        let [side, up, forward] = axes.map(|axis| axis.try_normalize());
        let (side, up, forward) = (side.ok_or_else(degenerate)?, up.ok_or_else(degenerate)?, forward.ok_or_else(degenerate)?);
        if forward.cross(up).length() < 1e-6 {
            return Err(degenerate());
        }
        if [side.dot(up), up.dot(forward), side.dot(forward)].iter().any(|cosine| cosine.abs() > 1e-6) {
            self.approximate(&entity.spot, "shear of the camera", "it is turned and scaled alone");
        }
        let mirrors = forward.cross(up).dot(side) < 0.0;
        let focus = entity.float_or("focaldistance", 1e6)?;
        let lens = entity.float_or("lensradius", 0.0)?;
        let distance = focus * lengths[2];
        let position = map.translation;
        let ahead = if lens > 0.0 { distance } else { 1.0 };
        let mut camera = entity.possible(camera_at(position, position + forward * ahead, up, &place))?;
        let window = self.window(entity, &film)?;
        match entity.name.as_str() {
            "perspective" => {
                let fov = entity.float_or("fov", 90.0)?;
                if !(fov > 0.0 && fov < 180.0) {
                    return Err(entity.spot_of("fov").error(format!("`fov` is an angle above 0 and below 180, and not {fov}")));
                }
                // The angle is that of the window from −1 to 1.
                let half = (0.5 * fov).to_radians().tan() / lengths[2];
                let half_height = 0.5 * (window.high[1] - window.low[1]) * half * lengths[1];
                let is_plain = half_height == (0.5 * fov).to_radians().tan();
                let vertical = if is_plain { fov } else { 2.0 * half_height.atan().to_degrees() };
                camera.vfov = Some(place.at(entity.possible(Checked::of(vertical))?));
            }
            "orthographic" => {
                camera.projection = Some(place.at(ProjectionName::Orthographic));
                let height = (window.high[1] - window.low[1]) * lengths[1];
                camera.height = Some(place.at(entity.possible(Checked::of(height))?));
            }
            // The middle of a panorama lies towards -X there, and what is to the right of it towards -Z.
            "spherical" if entity.text("mapping")? == Some("equirectangular") => {
                camera = entity.possible(camera_at(position, position - side, up, &place))?;
                camera.projection = Some(place.at(ProjectionName::Equirectangular));
                if film.high != film.size || film.low != [0.0; 2] {
                    self.approximate(&entity.spot, "crop of a spherical camera", "all directions are in the picture");
                }
                if !mirrors {
                    self.approximate(&entity.spot, "mirrored spherical camera", "its picture is not mirrored");
                }
            }
            other => {
                let error = entity.error(format!("the camera `{other}` cannot be said here"));
                return Err(
                    error.with_help("perspective, orthographic and spherical ones can, these with the mapping `equirectangular`")
                );
            }
        }
        let is_flat = entity.name != "spherical";
        if is_flat {
            self.place_window(entity, &film, &window, (lengths, mirrors), &mut camera)?;
        }
        if lens > 0.0 && is_flat {
            if (lengths[0] / lengths[1] - 1.0).abs() > 1e-6 {
                self.approximate(&entity.spot, "lens of a camera that is scaled unevenly", "it is a disk");
            }
            let radius = entity.possible(Checked::of(lens * lengths[0]))?;
            camera.aperture = Some(place.at(ApertureEntry::Disk(RoundAperture { radius })));
            camera.focus_distance = Some(entity.possible(Checked::of(distance))?);
        }
        let times = self.shutter(entity)?;
        if times != [0.0, 1.0] {
            camera.shutter = Some(place.at(entity.possible(Exactly::of(times))?));
        }
        self.move_camera(entity, &from_camera, ahead, &mut camera)?;
        if let Some(medium) = self.medium(medium, &entity.spot)? {
            camera.medium = Some(place.at(medium.clone()));
            self.enclosures.around_camera = Some(medium);
        }
        self.report_unused(entity);
        self.scene.file.camera = Some(camera);
        Ok(())
    }

    /// Times at which the shutter opens and closes, 0 where transforms begin and 1 where they end.
    fn shutter(&self, entity: &Entity) -> Result<[f64; 2], SceneError> {
        let [start, end] = self.world.transform_times;
        let [open, close] = [entity.float_or("shutteropen", 0.0)?, entity.float_or("shutterclose", 1.0)?];
        let is_moving = end > start;
        Ok(if is_moving { [open, close].map(|time| (time - start) / (end - start)) } else { [0.0, 1.0] })
    }

    /// A camera that moves has keyframes, from frame 0 to frame 1.
    fn move_camera(&mut self, entity: &Entity, maps: &Maps, ahead: f64, camera: &mut CameraTable) -> Result<(), SceneError> {
        if maps[0] == maps[1] {
            return Ok(());
        }
        let instead = "it rests where its transform begins; with --frame 0 it moves, from place to place evenly";
        self.approximate(&entity.spot, "motion of the camera", instead);
        let place = entity.spot.place();
        let key = |frame: f64, map: &glam::DAffine3| -> Result<CameraKeyEntry, String> {
            let forward = map.matrix3.z_axis.normalize_or_zero();
            let vector = |vector: DVec3| Exactly::of(vector.to_array());
            Ok(CameraKeyEntry {
                frame: Some(Number::of(frame)?),
                time: None,
                position: Some(vector(map.translation)?),
                look_at: Some(vector(map.translation + forward * ahead)?),
                up: Some(vector(map.matrix3.y_axis.normalize_or_zero())?),
                vfov: None,
                height: None,
                focus_distance: None,
            })
        };
        let keys = [entity.possible(key(0.0, &maps[0]))?, entity.possible(key(1.0, &maps[1]))?];
        camera.keyframes = Some(place.at(keys.map(|key| place.at(key)).into()));
        Ok(())
    }

    /// The window of the whole film: as wide as it is for its height, 1 along the shorter side to either direction.
    fn window(&self, entity: &Entity, film: &Film) -> Result<Window, SceneError> {
        let aspect = entity.float_or("frameaspectratio", film.size[0] / film.size[1])?;
        if !(aspect > 0.0 && aspect.is_finite()) {
            return Err(entity.spot_of("frameaspectratio").error("`frameaspectratio` is a number above 0"));
        }
        let [x, y] = if aspect > 1.0 { [aspect, 1.0] } else { [1.0, 1.0 / aspect] };
        let [left, right, below, above] = match entity.list("screenwindow", Kind::Float, 1)? {
            [] => [-x, x, -y, y],
            &[left, right, below, above] => [left, right, below, above],
            _ => return Err(entity.spot_of("screenwindow").error("`screenwindow` has 4 numbers")),
        };
        if !(left < right && below < above) {
            return Err(entity.spot_of("screenwindow").error("`screenwindow` ends where it begins, or before"));
        }
        // Rows go down.
        let at = |from: f64, to: f64, share: f64| from + (to - from) * share;
        let share = |side: usize| [film.low[side] / film.size[side], film.high[side] / film.size[side]];
        let ([first, last], [top, bottom]) = (share(0), share(1));
        Ok(Window {
            low: [at(left, right, first), at(above, below, bottom)],
            high: [at(left, right, last), at(above, below, top)],
        })
    }

    /// How much wider than high the picture is, and where its middle is.
    fn place_window(
        &mut self,
        entity: &Entity,
        film: &Film,
        window: &Window,
        (lengths, mirrors): ([f64; 3], bool),
        camera: &mut CameraTable,
    ) -> Result<(), SceneError> {
        let place = entity.spot.place();
        let [width, height] = [0, 1].map(|side| window.high[side] - window.low[side]);
        let aspect = (film.high[0] - film.low[0]) / (film.high[1] - film.low[1]);
        let stretch = width / height * (lengths[0] / lengths[1]) / aspect;
        let stretch = if (stretch - 1.0).abs() < 1e-9 { 1.0 } else { stretch };
        let sign = if mirrors { -1.0 } else { 1.0 };
        if sign * stretch != 1.0 {
            camera.stretch = Some(place.at(entity.possible(Checked::of(sign * stretch))?));
        }
        let [right, up] = [0, 1].map(|side| 0.5 * (window.low[side] + window.high[side]));
        let shift = [sign * right / width, up / height];
        if shift.iter().any(|shift| shift.abs() > 1e-12) {
            camera.shift = Some(entity.spot.place().at(entity.possible(Exactly::of(shift))?));
        }
        Ok(())
    }

    fn film(&mut self) -> Result<Film, SceneError> {
        let world = self.world.clone();
        let Some(entity) = &world.film else {
            let size = DEFAULT_SIZE.map(|side| side as f64);
            let film = Film { size, low: [0.0; 2], high: size };
            self.size(None, &film)?;
            return Ok(film);
        };
        // They say how the picture is stored.
        entity.without_effect(&["filename", "savefp16", "diagonal", "coordinatesystem", "nbuckets", "lambdamin", "lambdamax"]);
        if !["rgb", "gbuffer", "spectral"].contains(&entity.name.as_str()) {
            return Err(entity.error(format!("there is no film `{}`", entity.name)));
        }
        if world.film_space() != RgbSpace::Srgb {
            self.approximate(&entity.spot, "colour space of the film", "the picture is linear Rec.709");
        }
        let most = entity.float("maxcomponentvalue")?;
        if most.is_some_and(f64::is_finite) {
            self.drop(
                entity.spot_of("maxcomponentvalue"),
                "Film: `maxcomponentvalue`",
                "bright samples stay as they are; `clamp` limits them",
            );
        }
        let size = [entity.integer_or("xresolution", DEFAULT_SIZE[0])?, entity.integer_or("yresolution", DEFAULT_SIZE[1])?];
        let size = size.map(|side| side as f64);
        let mut film = Film { size, low: [0.0; 2], high: size };
        match entity.list("pixelbounds", Kind::Integer, 1)? {
            [] => {}
            &[left, right, top, bottom] => {
                film.low = [left.max(0.0), top.max(0.0)];
                film.high = [right.min(size[0]), bottom.min(size[1])];
            }
            _ => return Err(entity.spot_of("pixelbounds").error("`pixelbounds` has 4 numbers")),
        }
        match entity.list("cropwindow", Kind::Float, 1)? {
            [] => {}
            &[x0, x1, y0, y1] => {
                let ends = |a: f64, b: f64, side: f64| [a.min(b), a.max(b)].map(|share| (share.clamp(0.0, 1.0) * side).ceil());
                let ([left, right], [top, bottom]) = (ends(x0, x1, size[0]), ends(y0, y1, size[1]));
                (film.low, film.high) = ([left, top], [right, bottom]);
            }
            _ => return Err(entity.spot_of("cropwindow").error("`cropwindow` has 4 numbers")),
        }
        self.size(Some(entity), &film)?;
        Ok(film)
    }

    fn size(&mut self, entity: Option<&Entity>, film: &Film) -> Result<(), SceneError> {
        let [width, height] = [0, 1].map(|side| film.high[side] - film.low[side]);
        let fits = |side: f64| (1.0..=f64::from(MAX_SIDE)).contains(&side);
        if !(fits(width) && fits(height) && width * height <= MAX_PIXELS as f64) {
            let message = format!("a picture of {width} x {height} pixels cannot be rendered");
            return Err(entity.map_or_else(|| SceneError::in_file("film", &message), |entity| entity.error(&message)));
        }
        let pixels = |side: f64| NonZeroU32::new(side as u32).unwrap_or(NonZeroU32::MIN);
        self.scene.file.film.size = Some(Exactly([pixels(width), pixels(height)]));
        Ok(())
    }

    /// The film's exposure, by which all light is multiplied: 1 where nothing is said.
    fn expose(&mut self, camera: Option<&Entity>) -> Result<(), SceneError> {
        let (open, close) = match camera {
            Some(camera) => (camera.float_or("shutteropen", 0.0)?, camera.float_or("shutterclose", 1.0)?),
            None => (0.0, 1.0),
        };
        if let Some(camera) = camera.filter(|_| close <= open) {
            return Err(camera.error("the shutter closes before it opens, so the picture would be black"));
        }
        let world = self.world.clone();
        let Some(film) = &world.film else {
            self.exposure = close - open;
            return Ok(());
        };
        let speed = film.float_or("iso", 100.0)?;
        if !(speed > 0.0 && speed.is_finite()) {
            return Err(film.spot_of("iso").error(format!("`iso` is a number above 0, and not {speed}")));
        }
        self.exposure = (close - open) * speed / 100.0;
        let sensor = film.text("sensor")?.unwrap_or("cie1931").to_owned();
        if sensor != "cie1931" {
            let instead = "the CIE's observer of 1931 sees the picture, without the sensor's colours";
            self.approximate(film.spot_of("sensor"), format!("sensor `{sensor}` of the film"), instead);
        }
        if film.float_or("whitebalance", 0.0)? != 0.0 {
            self.drop(film.spot_of("whitebalance"), "Film: `whitebalance`", "D65 is white");
        }
        self.report_unused(film);
        Ok(())
    }

    fn filter(&mut self) -> Result<(), SceneError> {
        let world = self.world.clone();
        let Some(entity) = &world.filter else { return self.set_filter(None, FilterEntry::Gaussian, 1.5) };
        let radius = |default: f64| -> Result<f64, SceneError> {
            let [x, y] = [entity.float_or("xradius", default)?, entity.float_or("yradius", default)?];
            Ok(if x == y { x } else { 0.5 * (x + y) })
        };
        let is_square = entity.float("xradius")? == entity.float("yradius")?;
        let (make, width): (fn(FilterKeys) -> FilterEntry, f64) = match entity.name.as_str() {
            "box" => (FilterEntry::Box, radius(0.5)?),
            "triangle" => (FilterEntry::Tent, radius(2.0)?),
            "gaussian" => {
                let (radius, sigma) = (radius(1.5)?, entity.float_or("sigma", 0.5)?);
                if (3.0 * sigma / radius - 1.0).abs() > 1e-6 {
                    let instead = "a gaussian of that deviation that ends at three deviations is taken";
                    self.approximate(&entity.spot, "PixelFilter `gaussian` that ends elsewhere", instead);
                }
                (FilterEntry::Gaussian, 3.0 * sigma)
            }
            other @ ("mitchell" | "sinc") => {
                entity.without_effect(&["xradius", "yradius", "B", "C", "tau"]);
                let instead = "a gaussian of half a pixel's deviation is taken: filters have no negative parts here";
                self.approximate(&entity.spot, format!("PixelFilter `{other}`"), instead);
                (FilterEntry::Gaussian, 1.5)
            }
            other => return Err(entity.error(format!("there is no filter `{other}`"))),
        };
        if !is_square && ["box", "triangle", "gaussian"].contains(&entity.name.as_str()) {
            self.approximate(&entity.spot, "PixelFilter that is wider than high", "it is as wide as high, by the mean");
        }
        self.report_unused(entity);
        self.set_filter(Some(entity), make, width.clamp(0.5, 16.0))
    }

    fn set_filter(
        &mut self,
        entity: Option<&Entity>,
        make: fn(FilterKeys) -> FilterEntry,
        radius: f64,
    ) -> Result<(), SceneError> {
        let radius = Checked::of(radius);
        let radius = match entity {
            Some(entity) => Some(entity.possible(radius)?),
            None => radius.ok(),
        };
        self.scene.file.film.filter = Some(make(FilterKeys { radius }));
        Ok(())
    }
}
