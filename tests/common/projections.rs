//! Places at which cameras show points, by formulas of their own: the map from points to the picture, which renderers never compute.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};
use gpt::film::Band;
use gpt::load;
use gpt::renderer::{RenderRequest, Renderer, Silent};
use gpt::scene::Scene;

/// A camera, and the place of its picture where a point is shown. Points are relative to the camera: to the right, up, forward.
pub struct Projected {
    pub name: &'static str,
    pub size: [u32; 2],
    pub keys: &'static str,
    /// Keys of another camera, which shows points elsewhere.
    pub wrong: &'static str,
    /// For the view with a number, in pixels of the view.
    pub place: fn(DVec3, u32) -> DVec2,
    /// Places of a view, in pixels, see something.
    pub sees: fn(DVec2) -> bool,
    /// Columns and rows of views.
    pub tiles: [u32; 2],
}

const ALL: fn(DVec2) -> bool = |_| true;

/// OpenCV's pinhole with distortion: k1, k2, p1, p2, k3, k4, k5, k6.
fn brown_conrady(point: DVec3, k: [f64; 8], [fx, fy, cx, cy]: [f64; 4]) -> DVec2 {
    let (x, y) = (point.x / point.z, -point.y / point.z);
    let r2 = x * x + y * y;
    let radial = (1.0 + k[0] * r2 + k[1] * r2 * r2 + k[4] * r2.powi(3)) / (1.0 + k[5] * r2 + k[6] * r2 * r2 + k[7] * r2.powi(3));
    let u = x * radial + 2.0 * k[2] * x * y + k[3] * (r2 + 2.0 * x * x);
    let v = y * radial + k[2] * (r2 + 2.0 * y * y) + 2.0 * k[3] * x * y;
    DVec2::new(fx * u + cx, fy * v + cy)
}

/// The place at a distance from a middle, in the direction in which the point lies.
fn around(middle: DVec2, point: DVec3, radius: f64) -> DVec2 {
    let across = point.x.hypot(point.y);
    middle + DVec2::new(point.x, -point.y) / across * radius
}

fn angle_from_axis(point: DVec3) -> f64 {
    point.x.hypot(point.y).atan2(point.z)
}

/// All cameras.
pub fn projections() -> Vec<Projected> {
    vec![
        Projected {
            name: "panorama",
            size: [200, 100],
            keys: "projection = \"equirectangular\"\n",
            wrong: "projection = \"equirectangular\"\nazimuth = [-179.9, 180]\n",
            place: |p, _| {
                let azimuth = p.x.atan2(p.z);
                DVec2::new(200.0 * (0.5 + azimuth / TAU), 100.0 * p.angle_between(DVec3::Y) / PI)
            },
            sees: ALL,
            tiles: [1, 1],
        },
        Projected {
            name: "part of a panorama",
            size: [160, 120],
            keys: "projection = \"equirectangular\"\nazimuth = [-40, 70]\nelevation = [-30, 45]\n",
            wrong: "projection = \"equirectangular\"\nazimuth = [-40, 70]\nelevation = [-30, 45.1]\n",
            place: |p, _| {
                let (azimuth, elevation) = (p.x.atan2(p.z).to_degrees(), (p.y / p.length()).asin().to_degrees());
                DVec2::new(160.0 * (azimuth + 40.0) / 110.0, 120.0 * (45.0 - elevation) / 75.0)
            },
            sees: ALL,
            tiles: [1, 1],
        },
        Projected {
            name: "cylinder",
            size: [180, 90],
            keys: "projection = \"cylindrical\"\nazimuth = [-90, 90]\n",
            wrong: "projection = \"cylindrical\"\nazimuth = [-90, 90]\nelevation = [-40, 40]\n",
            place: |p, _| {
                let pixels = 180.0 / PI;
                DVec2::new(90.0 + pixels * p.x.atan2(p.z), 45.0 - pixels * p.y / p.x.hypot(p.z))
            },
            sees: ALL,
            tiles: [1, 1],
        },
        Projected {
            name: "equidistant fisheye",
            size: [150, 120],
            keys: "projection = \"fisheye\"\nfov = 210\n",
            wrong: "projection = \"fisheye\"\nfov = 210.1\n",
            place: |p, _| around(DVec2::new(75.0, 60.0), p, 60.0 * angle_from_axis(p) / 105_f64.to_radians()),
            sees: |place| place.distance(DVec2::new(75.0, 60.0)) <= 60.0,
            tiles: [1, 1],
        },
        Projected {
            name: "equisolid fisheye",
            size: [160, 120],
            keys: "projection = \"fisheye\"\nfov = 180\nmapping = \"equisolid\"\nfit = \"diagonal\"\n",
            wrong: "projection = \"fisheye\"\nfov = 180\nmapping = \"equidistant\"\nfit = \"diagonal\"\n",
            place: |p, _| around(DVec2::new(80.0, 60.0), p, 100.0 * (0.5 * angle_from_axis(p)).sin() / (PI / 4.0).sin()),
            sees: ALL,
            tiles: [1, 1],
        },
        Projected {
            name: "stereographic fisheye",
            size: [150, 120],
            keys: "projection = \"fisheye\"\nfov = 240\nmapping = \"stereographic\"\nfit = \"width\"\n",
            wrong: "projection = \"fisheye\"\nfov = 240\nmapping = \"stereographic\"\nfit = \"inside\"\n",
            place: |p, _| around(DVec2::new(75.0, 60.0), p, 75.0 * (0.5 * angle_from_axis(p)).tan() / (PI / 3.0).tan()),
            sees: |place| place.distance(DVec2::new(75.0, 60.0)) <= 75.0,
            tiles: [1, 1],
        },
        Projected {
            name: "orthographic fisheye",
            size: [150, 120],
            keys: "projection = \"fisheye\"\nfov = 160\nmapping = \"orthographic\"\nfit = \"height\"\n",
            wrong: "projection = \"fisheye\"\nfov = 161\nmapping = \"orthographic\"\nfit = \"height\"\n",
            place: |p, _| around(DVec2::new(75.0, 60.0), p, 60.0 * angle_from_axis(p).sin() / 80_f64.to_radians().sin()),
            sees: |place| place.distance(DVec2::new(75.0, 60.0)) <= 60.0,
            tiles: [1, 1],
        },
        Projected {
            name: "cube map in a grid",
            size: [150, 100],
            keys: "projection = \"cube_map\"\nlayout = \"grid\"\n",
            wrong: "projection = \"equirectangular\"\n",
            place: cube_side,
            sees: ALL,
            tiles: [3, 2],
        },
        Projected {
            name: "cube map in a row",
            size: [300, 50],
            keys: "projection = \"cube_map\"\n",
            wrong: "projection = \"equirectangular\"\n",
            place: cube_side,
            sees: ALL,
            tiles: [6, 1],
        },
        Projected {
            name: "distorted perspective",
            size: [160, 120],
            keys: "projection = \"brown_conrady\"\nfocal = [152, 144]\nprincipal_point = [86, 56]\nradial = [-0.28, 0.07, -0.01, 0.02, 0.01, 0.003]\n\
                   tangential = [0.004, -0.006]\n",
            wrong: "projection = \"brown_conrady\"\nfocal = [152, 144]\nprincipal_point = [86, 56]\nradial = [-0.28, 0.07, -0.01, 0.02, 0.01, 0.003]\n\
                    tangential = [0.004, -0.0062]\n",
            place: |p, _| brown_conrady(p, [-0.28, 0.07, 0.004, -0.006, -0.01, 0.02, 0.01, 0.003], [152.0, 144.0, 86.0, 56.0]),
            sees: ALL,
            tiles: [1, 1],
        },
        Projected {
            name: "radially distorted perspective",
            size: [160, 120],
            keys: "projection = \"brown_conrady\"\nfocal = [200, 200]\nimage_size = [320, 240]\nradial = [0.2, -0.05]\n",
            wrong: "projection = \"brown_conrady\"\nfocal = [200, 200]\nimage_size = [320, 240]\nradial = [0.2, -0.051]\n",
            place: |p, _| brown_conrady(p, [0.2, -0.05, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], [100.0, 100.0, 80.0, 60.0]),
            sees: ALL,
            tiles: [1, 1],
        },
        Projected {
            name: "calibrated perspective",
            size: [160, 120],
            keys: "projection = \"brown_conrady\"\nfocal = [152, 144]\nprincipal_point = [86, 56]\n",
            wrong: "projection = \"brown_conrady\"\nfocal = [152, 144]\nprincipal_point = [86, 56.1]\n",
            place: |p, _| brown_conrady(p, [0.0; 8], [152.0, 144.0, 86.0, 56.0]),
            sees: ALL,
            tiles: [1, 1],
        },
        Projected {
            name: "polynomial fisheye",
            size: [160, 120],
            keys: "projection = \"kannala_brandt\"\nfocal = [48, 47]\nprincipal_point = [82, 58]\nradial = [-0.02, 0.004, -0.003, 0.0004]\nfov = 190\n",
            wrong: "projection = \"kannala_brandt\"\nfocal = [48, 47]\nprincipal_point = [82, 58]\nradial = [-0.02, 0.004, -0.003, 0.0003]\nfov = 190\n",
            place: |p, _| {
                let t = angle_from_axis(p);
                let shown = t * (1.0 - 0.02 * t.powi(2) + 0.004 * t.powi(4) - 0.003 * t.powi(6) + 0.0004 * t.powi(8));
                let on_plane = around(DVec2::ZERO, p, shown);
                DVec2::new(82.0 + 48.0 * on_plane.x, 58.0 + 47.0 * on_plane.y)
            },
            sees: |place| {
                let t = 95_f64.to_radians();
                let most = t * (1.0 - 0.02 * t.powi(2) + 0.004 * t.powi(4) - 0.003 * t.powi(6) + 0.0004 * t.powi(8));
                ((place - DVec2::new(82.0, 58.0)) / DVec2::new(48.0, 47.0)).length() <= most
            },
            tiles: [1, 1],
        },
        Projected {
            name: "pair of perspectives",
            size: [240, 100],
            keys: "vfov = 90\nstereo = { layout = \"side_by_side\", eye_distance = 0.4, convergence = 6 }\n",
            wrong: "vfov = 90\nstereo = { layout = \"side_by_side\", eye_distance = 0.4 }\n",
            place: |p, tile| {
                let eye = if tile == 0 { -0.2 } else { 0.2 };
                let x = (p.x - eye) / p.z + eye / 6.0;
                DVec2::new(60.0 + 50.0 * x, 50.0 - 50.0 * p.y / p.z)
            },
            sees: ALL,
            tiles: [2, 1],
        },
        Projected {
            name: "omnidirectional stereo",
            size: [160, 160],
            keys: "projection = \"equirectangular\"\nstereo = { layout = \"top_bottom\", eye_distance = 0.4 }\n",
            wrong: "projection = \"equirectangular\"\nstereo = { layout = \"top_bottom\", eye_distance = 0.3 }\n",
            // A point lies as far to the right of the direction as the eye does, on the eye's circle.
            place: |p, tile| {
                let (eye, level) = (if tile == 0 { -0.2 } else { 0.2 }, p.x.hypot(p.z));
                let azimuth = p.x.atan2(p.z) - (eye / level).asin();
                let elevation = p.y.atan2((level * level - eye * eye).sqrt());
                DVec2::new(160.0 * (0.5 + azimuth / TAU), 80.0 * (0.5 - elevation / PI))
            },
            sees: ALL,
            tiles: [1, 2],
        },
    ]
}

/// Right, left, up, down, front, back, each 50 pixels wide.
fn cube_side(p: DVec3, tile: u32) -> DVec2 {
    // Directions to the right, up and forward of a viewer who looks at the side.
    let [right, up, front] =
        [[-p.z, p.y, p.x], [p.z, p.y, -p.x], [p.x, -p.z, p.y], [p.x, p.z, -p.y], [p.x, p.y, p.z], [-p.x, p.y, -p.z]]
            [tile as usize];
    DVec2::new(25.0 + 25.0 * right / front, 25.0 - 25.0 * up / front)
}

/// Radius of the sphere around the camera.
const RADIUS: f64 = 40.0;

/// A camera that stands aslant within a bright sphere, and sees by these keys.
pub fn within_a_sphere(size: [u32; 2], keys: &str) -> Scene {
    let text = format!(
        "[film]\nsize = [{}, {}]\n[render]\nspp = 1\npixel_sampler = \"none\"\n[camera]\nposition = [1, 2, 3]\nlook_at = [3, 1.5, 0.5]\n\
         up = [0.2, 1, 0.1]\n{keys}[[material]]\nname = \"m\"\ntype = \"emissive\"\nradiance = 1\n\
         [[shape]]\ntype = \"sphere\"\ncenter = [1, 2, 3]\nradius = {RADIUS}\nmaterial = \"m\"\n",
        size[0], size[1]
    );
    load::load_toml_str(&text, "test.toml", std::path::Path::new("")).unwrap_or_else(|error| panic!("{error}: {keys}"))
}

/// How far, in pixels at most, points that a renderer's pixels see are shown from the middles of these by the camera's formula; infinite where
/// a pixel sees something that should not, or the other way round. The renderer makes the layer of positions of [`within_a_sphere`].
pub fn farthest_off(renderer: &mut dyn Renderer, scene: &Scene, case: &Projected) -> f64 {
    let mut found: Vec<Option<DVec3>> = Vec::new();
    let request = RenderRequest { rows: 0..scene.film.size[1], samples: 0..1 };
    let mut on_band = |band: Band| {
        let counts = band.counts.clone().unwrap_or_else(|| vec![band.samples; band.mean.len()]);
        let means = band.mean.iter().map(|mean| DVec3::from_array(mean.map(f64::from)));
        found.extend(means.zip(counts).map(|(mean, count)| (count > 0).then_some(mean)));
        Ok(())
    };
    renderer.render(&request, &Silent, &mut on_band).expect("rendering succeeds");
    let [right, up, backward] = scene.camera.frame();
    let [width, height] = scene.film.size;
    let view = [width / case.tiles[0], height / case.tiles[1]];
    let center = scene.center();
    let mut farthest = 0.0_f64;
    for (index, seen) in (0_u32..).zip(found) {
        let pixel = [index % width, index / width];
        let tile = pixel[1] / view[1] * case.tiles[0] + pixel[0] / view[0];
        let middle = DVec2::new(f64::from(pixel[0] % view[0]) + 0.5, f64::from(pixel[1] % view[1]) + 0.5);
        let off = match seen {
            Some(point) if (case.sees)(middle) => {
                let way = point + center - scene.camera.position;
                let mut off = (case.place)(DVec3::new(way.dot(right), way.dot(up), -way.dot(backward)), tile) - middle;
                // The edges of a panorama are one.
                if case.keys.contains("\"equirectangular\"") && !case.keys.contains("azimuth") {
                    off.x -= f64::from(view[0]) * (off.x / f64::from(view[0])).round();
                }
                off.length()
            }
            None if !(case.sees)(middle) => 0.0,
            _ => f64::INFINITY,
        };
        farthest = farthest.max(if off.is_nan() { f64::INFINITY } else { off });
    }
    farthest
}
