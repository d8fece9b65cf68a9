//! The camera, the film, and how light is estimated.

use super::Writer;
use super::directive::{Directive, transform, triple};
use crate::scene::{Aperture, ApertureShape, Camera, Emitters, FilterKind, MaterialKind, Projection, SamplerKind};
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
        let Camera { position, look_at, up, projection, shift, stretch, aperture, focus_distance, .. } = self.scene.camera;
        if !self.scene.exposure.is_empty() {
            self.drop("motion of the camera", "camera", "it rests");
        }
        // +X is to the left there of what the camera sees.
        let mirror = if stretch < 0.0 { 1.0 } else { -1.0 };
        self.line(format!("Scale {mirror} 1 1"));
        self.line(format!("LookAt {}  {}  {}", triple(position), triple(look_at), triple(up)));
        if let Some(medium) = self.scene.camera_medium {
            let medium = self.media.get(medium).to_owned();
            self.push(Directive::new("MediumInterface", &["", &medium]));
        }
        let [width, height] = self.scene.film.size.map(f64::from);
        let half_height = match projection {
            Projection::Perspective { .. } => 1.0,
            Projection::Orthographic { height } => 0.5 * height,
        };
        let half_width = half_height * width / height * stretch.abs();
        let [right, above] = [2.0 * half_width * shift[0] * -mirror, 2.0 * half_height * shift[1]];
        let window = [right - half_width, right + half_width, above - half_height, above + half_height];
        let camera = match projection {
            // The angle is that from −1 to 1.
            Projection::Perspective { vertical_fov_degrees } => {
                Directive::new("Camera", &["perspective"]).float("fov", vertical_fov_degrees)
            }
            Projection::Orthographic { .. } => Directive::new("Camera", &["orthographic"]),
        };
        let lens = aperture.filter(|aperture| aperture.radius > 0.0);
        if let Some(Aperture { shape: ApertureShape::Square | ApertureShape::Polygon { .. }, .. }) = lens {
            self.approximate("aperture that is no disk", "camera.aperture", "a disk of the same radius is taken");
        }
        let camera = camera.floats("screenwindow", &window).some(lens, |camera, Aperture { radius, .. }| {
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
