use glam::{DVec2, DVec3};

use super::model::CameraModel;
use super::*;

/// The share of the sphere, in steradians, that all places of a view see together: by the steps of directions from place to place.
fn solid_angle(model: &dyn CameraModel, size: [f64; 2], tile: u32) -> f64 {
    let size = DVec2::from(size);
    let steps = 400;
    let cell = size / f64::from(steps);
    let half_step = 1e-4;
    let seen = |at: DVec2| model.direction(&ViewPlace { tile, at, size }).map(DVec3::normalize);
    let of_place = |index: i32| {
        let at = (DVec2::new(f64::from(index % steps), f64::from(index / steps)) + 0.5) * cell;
        let step = |axis: DVec2| Some((seen(at + half_step * axis)? - seen(at - half_step * axis)?) / (2.0 * half_step));
        let sides = step(DVec2::X).zip(step(DVec2::Y));
        sides.map_or(0.0, |(x, y)| x.cross(y).length() * cell.x * cell.y)
    };
    (0..steps * steps).map(of_place).sum()
}

fn cap(angle_degrees: f64) -> f64 {
    std::f64::consts::TAU * (1.0 - angle_degrees.to_radians().cos())
}

/// The closed form of each model.
#[test]
fn all_places_together_see_as_much_as_the_closed_form() {
    let band = |azimuth: f64, [from, to]: [f64; 2]| azimuth.to_radians() * (to.to_radians().sin() - from.to_radians().sin());
    let intrinsics = Intrinsics { image_size: [300, 300], focal: [60.0, 60.0], principal_point: [150.0, 150.0] };
    let fisheye = |mapping, fov_degrees| Fisheye { mapping, fov_degrees, fit: FisheyeFit::Inside };
    let equirectangular = Equirectangular { azimuth_degrees: [-30.0, 100.0], elevation_degrees: [-70.0, 20.0] };
    let cylindrical = Cylindrical { azimuth_degrees: [-50.0, 90.0], elevation_degrees: Some([-60.0, 30.0]) };
    // A pinhole that sees a square of half the side t has 4·asin(t² / (1 + t²)).
    let side = 2.5_f64;
    let pinhole = 4.0 * (side * side / (1.0 + side * side)).asin();
    let cases: Vec<(&str, Box<dyn CameraModel>, f64)> = vec![
        ("panorama", Box::new(Equirectangular::default()), 4.0 * std::f64::consts::PI),
        ("part of a panorama", Box::new(equirectangular), band(130.0, [-70.0, 20.0])),
        ("cylinder", Box::new(cylindrical), band(140.0, [-60.0, 30.0])),
        ("equidistant", Box::new(fisheye(FisheyeMapping::Equidistant, 220.0)), cap(110.0)),
        ("equisolid", Box::new(fisheye(FisheyeMapping::Equisolid, 300.0)), cap(150.0)),
        ("stereographic", Box::new(fisheye(FisheyeMapping::Stereographic, 250.0)), cap(125.0)),
        ("orthographic", Box::new(fisheye(FisheyeMapping::Orthographic, 160.0)), cap(80.0)),
        ("polynomial fisheye", Box::new(KannalaBrandt::new(intrinsics, [-0.02, 0.003, -0.002, 0.0003], 180.0)), cap(90.0)),
        ("pinhole", Box::new(BrownConrady::new(intrinsics, [0.0; 6], [0.0; 2])), pinhole),
        ("cube's side", Box::new(CubeMap { layout: CubeLayout::Grid }), std::f64::consts::TAU / 3.0),
    ];
    let mut last = 0.0;
    for (name, model, expected) in cases {
        let found = solid_angle(&*model, [300.0, 300.0], 3);
        assert!((found / expected - 1.0).abs() < 2e-3, "{name}: {found} and not {expected}");
        // Negative control: another camera's share is another.
        assert!((found / last - 1.0_f64).abs() > 2e-3, "{name} and the one before: {found}");
        last = found;
    }
}

/// The formula of OpenCV, as its documentation has it.
fn distorted([k1, k2, k3, k4, k5, k6]: [f64; 6], [p1, p2]: [f64; 2], [x, y]: [f64; 2]) -> [f64; 2] {
    let r2 = x * x + y * y;
    let factor = (1.0 + k1 * r2 + k2 * r2.powi(2) + k3 * r2.powi(3)) / (1.0 + k4 * r2 + k5 * r2.powi(2) + k6 * r2.powi(3));
    [x * factor + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x), y * factor + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y]
}

/// Lenses from weak to violent: wherever a place sees something, the formula shows that at the place, to a millionth of a pixel; and what it sees
/// is on the branch that begins on the axis.
#[test]
fn distortion_is_inverted_wherever_it_can_be() {
    let intrinsics = Intrinsics { image_size: [640, 480], focal: [500.0, 505.0], principal_point: [322.0, 238.0] };
    let mut numbers = 0x2545_f491_4f6c_dd1d_u64;
    let mut uniform = move |scale: f64| {
        numbers ^= numbers << 13;
        numbers ^= numbers >> 7;
        numbers ^= numbers << 17;
        ((numbers >> 11) as f64 / (1_u64 << 53) as f64 * 2.0 - 1.0) * scale
    };
    let (mut seen, mut blind) = (0, 0);
    for lens in 0..300 {
        let scale = [0.0, 0.1, 0.5, 2.0, 20.0][lens % 5];
        let radial: [f64; 6] = std::array::from_fn(|_| uniform(scale));
        let tangential = if lens % 3 == 0 { [0.0; 2] } else { [uniform(0.02 * scale), uniform(0.02 * scale)] };
        let model = BrownConrady::new(intrinsics, radial, tangential);
        for _ in 0..100 {
            let at = DVec2::new(320.0 + uniform(320.0), 240.0 + uniform(240.0));
            let place = ViewPlace { tile: 0, at, size: DVec2::new(640.0, 480.0) };
            let Some(direction) = model.direction(&place) else {
                blind += 1;
                continue;
            };
            seen += 1;
            let [x, y] = distorted(radial, tangential, [direction.x, -direction.y]);
            let shown = DVec2::new(322.0 + 500.0 * x, 238.0 + 505.0 * y);
            let tolerance = if tangential == [0.0; 2] { 1e-6 } else { 3e-3 };
            assert!(shown.distance(at) < tolerance, "{radial:?} {tangential:?} at {at}: {shown}");
            // Along the way from the axis to the direction, the radial part rises.
            let end = direction.truncate();
            let values = (1..=64).map(|step| {
                let [x, y] = distorted(radial, [0.0; 2], (end * f64::from(step) / 64.0).to_array());
                x.hypot(y)
            });
            let values: Vec<f64> = values.collect();
            assert!(values.windows(2).all(|pair| pair[0] <= pair[1] * (1.0 + 1e-9)), "{radial:?} at {at}: {values:?}");
        }
    }
    // Both happen, so that neither goes untried.
    assert!(seen > 10_000 && blind > 1_000, "{seen} {blind}");
}

/// A wrong coefficient is noticed.
#[test]
fn a_lens_with_another_coefficient_shows_things_elsewhere() {
    let intrinsics = Intrinsics { image_size: [640, 480], focal: [500.0; 2], principal_point: [320.0, 240.0] };
    let radial = [-0.3, 0.1, 0.0, 0.0, 0.0, 0.0];
    let model = BrownConrady::new(intrinsics, radial, [1e-3, 0.0]);
    let place = ViewPlace { tile: 0, at: DVec2::new(30.0, 60.0), size: DVec2::new(640.0, 480.0) };
    let direction = model.direction(&place).expect("it is seen");
    let pixel = |radial, tangential| {
        let [x, y] = distorted(radial, tangential, [direction.x, -direction.y]);
        DVec2::new(320.0 + 500.0 * x, 240.0 + 500.0 * y).distance(place.at)
    };
    assert!(pixel(radial, [1e-3, 0.0]) < 1e-6);
    for wrong in 0..6 {
        let mut other = radial;
        other[wrong] += 1e-3;
        assert!(pixel(other, [1e-3, 0.0]) > 1e-3, "k{}", wrong + 1);
    }
    assert!(pixel(radial, [0.0, 1e-3]) > 1e-3);
}

/// The angle that a fisheye lens shows at a place is the only one on the rising branch, and beyond it the place sees nothing.
#[test]
fn a_polynomial_that_turns_back_ends_what_is_seen() {
    let intrinsics = Intrinsics { image_size: [400, 400], focal: [100.0; 2], principal_point: [200.0; 2] };
    // θ(1 − θ²/3) turns back at 1 radian, where it is 2/3.
    let model = KannalaBrandt::new(intrinsics, [-1.0 / 3.0, 0.0, 0.0, 0.0], 360.0);
    let at =
        |pixels: f64| model.direction(&ViewPlace { tile: 0, at: DVec2::new(200.0 + pixels, 200.0), size: DVec2::splat(400.0) });
    let angle = |pixels: f64| at(pixels).map(|direction| direction.x.atan2(-direction.z));
    assert!((angle(66.0).expect("it is seen") - 0.9).abs() < 0.1);
    assert!(angle(66.6).is_some() && angle(66.7).is_none());
    for theta in [0.1_f64, 0.5, 0.9] {
        let shown = 100.0 * theta * (1.0 - theta * theta / 3.0);
        assert!((angle(shown).expect("it is seen") - theta).abs() < 1e-12);
    }
    assert!(blind::blind_share(&model, DVec2::splat(400.0)) > 0.5);
}

/// Beside each other: the same thing at the same place at the distance of convergence, and apart elsewhere.
#[test]
fn eyes_meet_where_they_converge() {
    let stereo = Stereo { layout: StereoLayout::SideBySide, eye_distance: 0.2, convergence: Some(5.0) };
    for (eyes, direction) in [(Eyes::Pair, DVec3::new(0.3, -0.2, -1.0)), (Eyes::Turning, DVec3::new(0.6, 0.0, 0.8))] {
        let point = |tile: u32, distance: f64| {
            let eye = stereo.eye(eyes, direction, tile);
            eye + distance * (direction - stereo.inverse_convergence() * eye)
        };
        assert!(point(0, 5.0).distance(point(1, 5.0)) < 1e-12);
        assert!((point(0, 0.0).distance(point(1, 0.0)) - 0.2).abs() < 1e-12);
        assert!(point(0, 10.0).distance(point(1, 10.0)) > 0.1);
        // The eyes that turn are to the left and to the right for who looks that way.
        assert!(eyes == Eyes::Pair || point(1, 0.0).dot(direction).abs() < 1e-12);
    }
}
