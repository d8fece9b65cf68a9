//! Sides and normals.

use std::f64::consts::PI;

use super::*;

/// Lobes that only reflect, straight and tilted.
fn reflecting() -> Vec<Bsdf> {
    let lobes = [diffuse(orange()), phong(0.4, 0.4, 2.0), gold(0.8), white_metal(0.3)];
    let view = |tilt: f64| [0.0, 35.0, 70.0, 88.0, 125.0, 180.0].map(|wo| view(wo, tilt));
    let views: Vec<View> = [0.0, 25.0].into_iter().flat_map(view).collect();
    lobes.into_iter().flat_map(|lobe| views.clone().into_iter().map(move |view| single(lobe, view))).collect()
}

#[test]
fn nothing_is_reflected_through_the_surface() {
    let mut above_without = 0;
    for bsdf in reflecting() {
        for (theta, phi) in (0..18).flat_map(|i| (0..8).map(move |j| (f64::from(i) * 10.0 + 1.0, f64::from(j)))) {
            let wi = at_degrees(theta, phi);
            let above = wi.dot(bsdf.view.geometric_normal) > 0.0 && wi.dot(bsdf.view.normal()) > 0.0;
            let evaluation = bsdf.evaluate(wi);
            assert!(above || evaluation == Evaluation::default(), "{bsdf:?} {wi}");
            assert_eq!(!evaluation.value.is_black(), evaluation.pdf > 0.0, "{bsdf:?} {wi}");
            above_without += usize::from(above && evaluation.pdf == 0.0);
        }
    }
    assert_eq!(above_without, 0);
}

#[test]
fn normals_face_the_viewer() {
    for wo_degrees in [10.0, 89.0, 91.0, 170.0] {
        for tilt in [-60.0, 0.0, 60.0, 120.0] {
            let view = View::new(at_degrees(wo_degrees, 0.0), DVec3::Z, at_degrees(tilt, 0.0));
            assert_eq!(view.front, wo_degrees < 90.0);
            assert!(view.wo.dot(view.geometric_normal) > 0.0);
            assert!(view.wo.dot(view.normal()) > 0.0);
            assert!(view.normal().dot(view.geometric_normal) > 0.0);
        }
    }
}

/// Transmitted light arrives from the other side by both normals, or not at all.
#[test]
fn nothing_is_transmitted_on_one_side() {
    for lobe in [rough_glass(clear(1.5), 0.5), phong_glass(clear(1.5), 3.0)] {
        for tilt in [0.0, 25.0] {
            let view = view(40.0, tilt);
            for [u, v, _] in cube_points(2000, 8) {
                let wi = crate::reference::warp::uniform_sphere(u, v);
                let sides = [wi.dot(view.geometric_normal) > 0.0, wi.dot(view.normal()) > 0.0];
                if sides[0] != sides[1] {
                    assert_eq!(lobe.evaluate(&view, wi), Evaluation::default());
                }
            }
        }
    }
}

#[test]
fn delta_lobes_take_no_part_in_light_sampling() {
    for lobe in [mirror(1.0), glass(clear(1.5)), gold(0.0)] {
        let bsdf = single(lobe, view(30.0, 0.0));
        let sample = bsdf.sample(0.01, 0.3, 0.7).expect("a delta lobe has a direction");
        assert_eq!(sample.density, Density::Delta);
        assert!((sample.wi - at_degrees(30.0, 0.4 + PI)).length() < 1e-12);
        assert_eq!(bsdf.evaluate(sample.wi), Evaluation::default());
        assert!(!bsdf.has_non_delta_lobe());
    }
}
