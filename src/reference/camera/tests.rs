use super::*;
use crate::compare::sidak;
use crate::scene::EXPOSURE_STRETCHES;
use crate::scene::{Aperture, Projection};
use crate::statistics::{chi_squared_test, random::SplitMix64};

fn camera(projection: Projection, aperture: Option<Aperture>) -> CameraRays {
    let camera = Camera { position: DVec3::new(0.0, 0.0, 5.0), projection, aperture, focus_distance: 4.0, ..Camera::default() };
    CameraRays::new(&camera, &FilmSettings { size: [200, 100], ..FilmSettings::default() })
}

/// The ray through a film position of a picture of one view.
fn ray(camera: &CameraRays, film: [f64; 2], lens: DVec2, time: f64) -> Ray {
    camera.ray([0, 0], film.into(), lens, time).expect("all places see something")
}

const WIDE: Projection = Projection::Perspective { vertical_fov_degrees: 90.0 };
const FLAT: Projection = Projection::Orthographic { height: 3.0 };

#[test]
fn corners_look_where_they_should() {
    let camera = camera(WIDE, None);
    let expect = |film_x, film_y, direction: DVec3| {
        let ray = ray(&camera, [film_x, film_y], DVec2::ZERO, 0.0);
        assert!((ray.direction - direction.normalize()).length() < 1e-15);
    };
    expect(0.0, 0.0, DVec3::new(-2.0, 1.0, -1.0));
    expect(200.0, 100.0, DVec3::new(2.0, -1.0, -1.0));
    expect(100.0, 50.0, -DVec3::Z);
}

#[test]
fn parallel_rays_start_on_the_window() {
    let camera = camera(FLAT, None);
    for (film, origin) in [([0.0, 0.0], DVec3::new(-3.0, 1.5, 5.0)), ([200.0, 50.0], DVec3::new(3.0, 0.0, 5.0))] {
        let ray = ray(&camera, film, DVec2::ZERO, 0.0);
        assert_eq!((ray.origin, ray.direction), (origin, -DVec3::Z));
    }
}

/// The point at which rays of one film position cross a plane `depth` before the camera.
fn crossing(camera: &CameraRays, film: [f64; 2], lens: DVec2, depth: f64) -> DVec3 {
    let ray = ray(camera, film, lens, 0.0);
    ray.origin + ray.direction * ((5.0 - depth - ray.origin.z) / ray.direction.z)
}

/// Rays of one film position meet in the plane in focus; elsewhere they spread by the lens's radius times |1 − depth / focus|.
#[test]
fn rays_meet_in_the_plane_in_focus() {
    let aperture = Aperture { shape: ApertureShape::Disk, radius: 0.5 };
    for projection in [WIDE, FLAT] {
        let camera = camera(projection, Some(aperture));
        for film in [[100.0, 50.0], [13.0, 71.0]] {
            for depth in [1.0, 4.0, 9.0] {
                let middle = crossing(&camera, film, DVec2::ZERO, depth);
                for lens in [DVec2::new(0.5, 0.0), DVec2::new(-0.2, 0.4)] {
                    let spread = crossing(&camera, film, lens, depth) - middle;
                    let expected = lens * (1.0 - depth / 4.0);
                    assert!((spread - DVec3::new(expected.x, expected.y, 0.0)).length() < 1e-12, "{spread} {expected}");
                }
            }
        }
    }
}

const SHAPES: [ApertureShape; 5] = [
    ApertureShape::Disk,
    ApertureShape::Square,
    ApertureShape::Polygon { blades: 3, rotation_degrees: 0.0 },
    ApertureShape::Polygon { blades: 6, rotation_degrees: 17.0 },
    ApertureShape::Polygon { blades: 64, rotation_degrees: -400.0 },
];

/// Says that a point is inside, by the shape's definition: for a polygon, on the inner side of every edge.
fn is_inside(shape: ApertureShape, point: DVec2) -> bool {
    match shape {
        ApertureShape::Disk => point.length_squared() <= 1.0,
        ApertureShape::Square => point.abs().max_element() <= 1.0,
        ApertureShape::Polygon { blades, rotation_degrees } => {
            let step = std::f64::consts::TAU / f64::from(blades);
            (0..blades).all(|edge| {
                let middle = (f64::from(edge) + 0.5) * step + rotation_degrees.to_radians();
                point.dot(DVec2::from_angle(middle)) <= (0.5 * step).cos()
            })
        }
    }
}

const SIDE: usize = 24;

/// p of Pearson's test of points of `map` against the uniform distribution over `shape`, on a grid over the square around it.
fn p_value(shape: ApertureShape, map: impl Fn(u32, u32) -> DVec2) -> f64 {
    let draws = 1_000_000;
    let mut counts = vec![0; SIDE * SIDE];
    let mut random = SplitMix64::new(11);
    for _ in 0..draws {
        let bits = random.next_u64();
        let point = (map(bits as u32, (bits >> 32) as u32) + 1.0) * (0.5 * SIDE as f64);
        let cell = |x: f64| (x as usize).min(SIDE - 1);
        counts[cell(point.y) * SIDE + cell(point.x)] += 1;
    }
    let fine = 64;
    let at = |cell: usize, step: usize| (cell as f64 + (step as f64 + 0.5) / fine as f64) * 2.0 / SIDE as f64 - 1.0;
    let covered = |index: usize| {
        let (x, y) = (index % SIDE, index / SIDE);
        let steps = (0..fine * fine).map(|step| DVec2::new(at(x, step % fine), at(y, step / fine)));
        steps.filter(|&point| is_inside(shape, point)).count() as f64
    };
    let areas: Vec<f64> = (0..SIDE * SIDE).map(covered).collect();
    let whole: f64 = areas.iter().sum();
    let expected: Vec<f64> = areas.iter().map(|area| area / whole * f64::from(draws)).collect();
    // A cell that the fine grid misses may still be touched by the shape's rim.
    let (counts, expected): (Vec<u64>, Vec<f64>) =
        counts.into_iter().zip(expected).filter(|(_, expectation)| *expectation > 20.0).unzip();
    chi_squared_test(&counts, &expected).p_value
}

#[test]
fn apertures_are_covered_evenly() {
    for shape in SHAPES {
        let p = p_value(shape, |u, v| aperture_point(shape, u, v));
        assert!(p > sidak(0.01, SHAPES.len()), "{shape:?}: p = {p}");
        for bits in [0, 1 << 31, u32::MAX] {
            let point = aperture_point(shape, bits, bits.rotate_left(7));
            assert!(is_inside(shape, point * (1.0 - 1e-9)), "{shape:?}: {point}");
        }
    }
}

/// A disk without the square root, a hexagon for a disk, a polygon turned the other way.
#[test]
fn uneven_apertures_are_noticed() {
    let uniform = crate::sampling::sampler::uniform;
    let clumped = |u: u32, v: u32| DVec2::from_angle(std::f64::consts::TAU * uniform(u)) * uniform(v);
    assert!(p_value(ApertureShape::Disk, clumped) < 1e-6);
    assert!(p_value(ApertureShape::Disk, |u, v| aperture_point(SHAPES[3], u, v)) < 1e-6);
    let turned = ApertureShape::Polygon { blades: 6, rotation_degrees: -17.0 };
    assert!(p_value(turned, |u, v| aperture_point(SHAPES[3], u, v)) < 1e-6);
}

/// 1/|det| of the maps' derivatives is one over the area.
#[test]
fn densities_are_one_over_the_area() {
    let square = |x: f64| (x * 4_294_967_296.0) as u32;
    for shape in SHAPES {
        let area = match shape {
            ApertureShape::Disk => std::f64::consts::PI,
            ApertureShape::Square => 4.0,
            ApertureShape::Polygon { blades, .. } => 0.5 * f64::from(blades) * (std::f64::consts::TAU / f64::from(blades)).sin(),
        };
        // Differences within one triangle of a polygon: steps far above the 24 bits of a number, far below a triangle.
        let (u, v, step) = (0.2537, 0.4131, 1e-4);
        let map = |u: f64, v: f64| aperture_point(shape, square(u), square(v));
        let derivative = |du, dv| (map(u + du, v + dv) - map(u - du, v - dv)) / (2.0 * step);
        let density = derivative(step, 0.0).perp_dot(derivative(0.0, step)).abs().recip();
        assert!((density * area - 1.0).abs() < 2e-3, "{shape:?}: {density}, area {area}");
    }
}

/// Against the camera that is turned at each moment; the control is a camera that stops halfway.
#[test]
fn rays_follow_a_camera_that_turns() {
    let scene = |stop: f64| {
        let turned = |step: usize| {
            let angle = (std::f64::consts::FRAC_PI_4 * step as f64 / EXPOSURE_STRETCHES as f64).min(stop);
            Camera {
                look_at: DVec3::new(-angle.sin(), 0.0, -angle.cos()),
                position: DVec3::ZERO,
                projection: WIDE,
                ..Camera::default()
            }
        };
        let exposure: Vec<Camera> = (0..=EXPOSURE_STRETCHES).map(turned).collect();
        let film = FilmSettings { size: [100, 100], ..FilmSettings::default() };
        Scene { camera: exposure[0].clone(), exposure, film, ..Scene::default() }
    };
    let farthest = |stop: f64| {
        let camera = CameraRays::of(&scene(stop));
        let mut farthest = 0.0_f64;
        for step in 0..=100 {
            let time = f64::from(step) / 100.0;
            for [x, y] in [[50.0, 50.0], [0.0, 0.0], [100.0, 20.0]] {
                let turn = glam::DQuat::from_rotation_y(std::f64::consts::FRAC_PI_4 * time);
                let truth = turn * DVec3::new(x / 50.0 - 1.0, 1.0 - y / 50.0, -1.0).normalize();
                farthest = farthest.max(ray(&camera, [x, y], DVec2::ZERO, time).direction.distance(truth).to_degrees());
            }
        }
        farthest
    };
    assert!(farthest(1.0) < 0.01, "{}", farthest(1.0));
    assert!(farthest(0.4) > 10.0);
}
