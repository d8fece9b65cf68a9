//! The camera, the film, and how light is estimated.

use glam::DVec2;

use super::Writer;
use super::directive::{Directive, transform, triple};
use crate::scene::{Aperture, ApertureShape, Camera, Emitters, FilterKind, MaterialKind, Projection, SamplerKind, Window};
use crate::scene_writer::surroundings::has_media;

/// The depth that stands for none.
const ENDLESS: i64 = 1_000_000;

impl Writer<'_> {
    /// Film, filter, sampler and integrator.
    pub fn settings(&mut self) {
        let render = &self.scene.render;
        if render.clamp > 0.0 {
            self.drop("clamp", "render", "bright samples stay as they are");
        }
        if render.emitters == Emitters::Hidden {
            self.drop("hidden emitters", "render", "they are seen");
        }
        // Surfaces that light goes straight through are crossed by this integrator alone.
        let is_crossed = self.scene.materials.iter().any(|material| matches!(material.kind, MaterialKind::Pass));
        let integrator = if has_media(self.scene) || is_crossed { "volpath" } else { "path" };
        // A path that sees an emitter has depth 0 there.
        let depth = if render.max_depth == 0 { ENDLESS } else { i64::from(render.max_depth) - 1 };
        self.push(Directive::new("Integrator", &[integrator]).integer("maxdepth", depth));
        let sampler = if render.sampler == SamplerKind::Independent { "independent" } else { "halton" };
        self.push(Directive::new("Sampler", &[sampler]).integer("pixelsamples", render.spp.into()));
        let film = &self.scene.film;
        let [width, height] = film.size;
        let radius = film.filter.radius;
        let kind = match film.filter.kind {
            FilterKind::Box => "box",
            FilterKind::Tent => "triangle",
            FilterKind::Gaussian => "gaussian",
            FilterKind::BlackmanHarris => {
                self.approximate("filter blackman_harris", "film.filter", "a gaussian is taken");
                "gaussian"
            }
        };
        let filter = Directive::new("PixelFilter", &[kind]).float("xradius", radius).float("yradius", radius);
        self.push(if kind == "gaussian" { filter.float("sigma", radius / 3.0) } else { filter });
        let stem = self.target.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let film = Directive::new("Film", &["rgb"]).string("filename", &format!("{stem}.exr"));
        let film = film.integer("xresolution", width.into()).integer("yresolution", height.into());
        self.push(film.flag("savefp16", false));
    }

    /// The camera, with what is around it.
    pub fn camera(&mut self) {
        let Camera { position, look_at, up, stretch, aperture, focus_distance, .. } = self.scene.camera;
        if !self.scene.exposure.is_empty() {
            self.drop("motion of the camera", "camera", "it rests");
        }
        let size = DVec2::from(self.scene.film.size.map(f64::from));
        let window = self.scene.camera.window(size);
        match window {
            // +X is to the left there of what the camera sees.
            Some(_) => self.line(format!("Scale {} 1 1", if stretch < 0.0 { 1.0 } else { -1.0 })),
            // The middle of a panorama lies towards -X there, and what is to the right of it towards -Z.
            None => self.line("Rotate -90 0 1 0".to_owned()),
        }
        self.line(format!("LookAt {}  {}  {}", triple(position), triple(look_at), triple(up)));
        if let Some(medium) = self.scene.camera_medium {
            let medium = self.media.get(medium).to_owned();
            self.push(Directive::new("MediumInterface", &["", &medium]));
        }
        let Some(Window { half_extent, shift, is_parallel }) = window else {
            self.push(Directive::new("Camera", &["spherical"]).string("mapping", "equirectangular"));
            return;
        };
        // The angle is that from -1 to 1.
        let half_height = if is_parallel { half_extent.y } else { 1.0 };
        let half_width = (half_height * half_extent.x / half_extent.y).abs();
        let [right, above] = [2.0 * half_width * shift.x * stretch.signum(), 2.0 * half_height * shift.y];
        let screen = [right - half_width, right + half_width, above - half_height, above + half_height];
        let camera = match self.scene.camera.projection {
            Projection::Perspective { vertical_fov_degrees } => {
                Directive::new("Camera", &["perspective"]).float("fov", vertical_fov_degrees)
            }
            _ => Directive::new("Camera", &["orthographic"]),
        };
        let lens = aperture.filter(|aperture| aperture.radius > 0.0);
        if let Some(Aperture { shape: ApertureShape::Square | ApertureShape::Polygon { .. }, .. }) = lens {
            self.approximate("aperture that is no disk", "camera.aperture", "a disk of the same radius is taken");
        }
        let camera = camera.floats("screenwindow", &screen).some(lens, |camera, Aperture { radius, .. }| {
            camera.float("lensradius", radius).float("focaldistance", focus_distance)
        });
        self.push(camera);
    }

    /// Lines with the transform in force.
    pub fn placed(&mut self, map: &glam::DAffine3) {
        if *map != glam::DAffine3::IDENTITY {
            self.line(transform("Transform", map));
        }
    }
}
