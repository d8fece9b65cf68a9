use super::*;

/// Candela that differ everywhere.
fn uneven(vertical: &[f64], horizontal: &[f64]) -> LightProfile {
    let candela = (0..vertical.len() * horizontal.len()).map(|index| 10.0 + ((index * 37) % 23) as f64).collect();
    LightProfile::new(vertical.to_vec(), horizontal.to_vec(), candela).expect("it is possible")
}

#[test]
fn tables_unfold_by_their_symmetry() {
    let vertical = [0.0, 45.0, 90.0];
    let at = |profile: &LightProfile, horizontal: f64| profile.candela_at(60.0, horizontal);
    let same = |a: f64, b: f64| (a - b).abs() < 1e-12;
    let quarter = uneven(&vertical, &[0.0, 20.0, 90.0]);
    assert_eq!(quarter.horizontal(), [0.0, 20.0, 90.0, 160.0, 180.0, 200.0, 270.0, 340.0, 360.0]);
    let half = uneven(&vertical, &[0.0, 20.0, 100.0, 180.0]);
    assert_eq!(half.horizontal(), [0.0, 20.0, 100.0, 180.0, 260.0, 340.0, 360.0]);
    // Alike to both sides of the plane through 90 and 270, by LM-63-1995.
    let side = uneven(&vertical, &[90.0, 150.0, 250.0, 270.0]);
    assert_eq!(side.horizontal(), [0.0, 30.0, 90.0, 150.0, 250.0, 270.0, 290.0, 360.0]);
    let whole = uneven(&vertical, &[0.0, 20.0, 100.0, 180.0, 260.0, 360.0]);
    let (mut by_quarters, mut by_halves, mut by_sides) = (0, 0, 0);
    for angle in (0..72).map(|step| 5.0 * f64::from(step) + 1.0) {
        assert!(same(at(&quarter, angle), at(&quarter, 180.0 - angle)) && same(at(&quarter, angle), at(&quarter, -angle)));
        assert!(same(at(&half, angle), at(&half, -angle)));
        assert!(same(at(&side, angle), at(&side, 180.0 - angle)), "{angle}");
        by_quarters += u32::from(same(at(&half, angle), at(&half, 180.0 - angle)));
        by_halves += u32::from(same(at(&whole, angle), at(&whole, -angle)));
        by_sides += u32::from(same(at(&half, angle), at(&half, 180.0 - angle)));
    }
    // The controls: what has less symmetry differs.
    assert!([by_quarters, by_halves, by_sides].into_iter().all(|alike| alike < 8), "{by_quarters} {by_halves} {by_sides}");
    // A table of 90 to 270 without a plane at 180 is interpolated there, and at 0.
    assert!(same(at(&side, 0.0), at(&side, 180.0)) && same(at(&side, 180.0), 0.7 * at(&side, 150.0) + 0.3 * at(&side, 250.0)));
}

#[test]
fn between_angles_it_is_bilinear_and_past_them_dark() {
    let candela = vec![1.0, 5.0, 9.0, 3.0, 7.0, 2.0, 1.0, 5.0, 9.0];
    let profile = LightProfile::new(vec![30.0, 50.0, 110.0], vec![0.0, 90.0, 360.0], candela).unwrap();
    for (vertical, horizontal, expected) in [
        (30.0, 0.0, 1.0),
        (50.0, 90.0, 7.0),
        (40.0, 45.0, 4.0),
        (80.0, 90.0, 4.5),
        (110.0, 225.0, 5.5),
        (110.0, 360.0, 9.0),
        (29.999, 0.0, 0.0),
        (110.001, 0.0, 0.0),
    ] {
        let found = profile.candela_at(vertical, horizontal);
        assert!((found - expected).abs() < 1e-12, "{vertical} {horizontal}: {found}");
    }
    assert_eq!(profile.extent(), [30.0, 110.0]);
}

/// Lumen of lamps whose integral is known: even, a cosine by degrees, and half of the sphere.
#[test]
fn integrals_over_the_sphere_are_right() {
    let even = LightProfile::new(vec![0.0, 180.0], vec![0.0], vec![3.0; 2]).unwrap();
    assert!((even.integral(|_| 1.0, &[]) / (12.0 * PI) - 1.0).abs() < 1e-9);
    // A quarter of it lies within 60 degrees.
    let within = even.integral(|angle| if angle < 60.0 { 1.0 } else { 0.0 }, &[60.0]);
    assert!((within / (3.0 * PI) - 1.0).abs() < 1e-8, "{within}");
    let degrees: Vec<f64> = (0..=90).map(f64::from).collect();
    let cosine: Vec<f64> = degrees.iter().map(|angle| angle.to_radians().cos()).collect();
    let lambert = LightProfile::new(degrees, vec![0.0], cosine).unwrap();
    // Linear pieces lie below the cosine by 1/12 of the squared step, on average.
    let lumen = lambert.integral(|_| 1.0, &[]);
    assert!((lumen / PI - 1.0).abs() < 5e-5 && (lumen / PI - 1.0).abs() > 1e-6, "{lumen}");
    // A mean around: planes weigh by the angle that they stand for.
    let uneven = LightProfile::new(vec![0.0, 180.0], vec![0.0, 90.0, 360.0], vec![1.0, 1.0, 5.0, 5.0, 1.0, 1.0]).unwrap();
    assert!((uneven.integral(|_| 1.0, &[]) / (12.0 * PI) - 1.0).abs() < 1e-9);
}

#[test]
fn nadir_and_the_front_are_where_they_are_aimed() {
    let names = uneven(&[0.0, 90.0, 180.0], &[0.0, 90.0, 180.0, 270.0, 360.0]);
    let at = |vertical: f64, horizontal: f64| names.candela_at(vertical, horizontal);
    let aimed = AimedProfile { profile: Arc::new(names.clone()), nadir: DVec3::NEG_Y, front: DVec3::new(2.0, 1.0, 0.0) };
    // Seen from above, +X is to the right and +Z downwards: counter-clockwise from +X lies -Z.
    for (direction, vertical, horizontal) in [
        (DVec3::NEG_Y, 0.0, 0.0),
        (DVec3::X, 90.0, 0.0),
        (DVec3::NEG_Z, 90.0, 90.0),
        (DVec3::NEG_X, 90.0, 180.0),
        (DVec3::Z, 90.0, 270.0),
    ] {
        assert!((aimed.candela(direction) - at(vertical, horizontal)).abs() < 1e-9, "{direction}");
    }
    // The controls: no two of those directions have the same light.
    let around: Vec<f64> = [0.0, 90.0, 180.0, 270.0].map(|angle| at(90.0, angle)).to_vec();
    assert!((1..4).all(|index| !around[..index].contains(&around[index])) && !around.contains(&at(0.0, 0.0)), "{around:?}");
}

#[test]
fn cones_hold_all_of_the_light() {
    let cone = |vertical: &[f64], candela: &[f64]| {
        let profile = Arc::new(LightProfile::new(vertical.to_vec(), vec![0.0], candela.to_vec()).unwrap());
        let cone = AimedProfile { profile, nadir: DVec3::NEG_Y, front: DVec3::X }.cone();
        cone.map(|(axis, end)| (axis, end.to_degrees().round()))
    };
    assert_eq!(cone(&[0.0, 30.0, 60.0, 90.0], &[1.0, 1.0, 0.0, 0.0]), Some((DVec3::NEG_Y, 60.0)));
    assert_eq!(cone(&[0.0, 100.0, 140.0, 180.0], &[0.0, 0.0, 1.0, 1.0]), Some((DVec3::Y, 80.0)));
    assert_eq!(cone(&[0.0, 180.0], &[1.0, 0.0]), None);
}

#[test]
fn mistakes_name_the_number() {
    let fault = |vertical: &[f64], horizontal: &[f64], candela: &[f64]| {
        let fault = LightProfile::new(vertical.to_vec(), horizontal.to_vec(), candela.to_vec()).unwrap_err();
        (fault.list, fault.index, fault.message)
    };
    for (vertical, horizontal, candela, list, index, words) in [
        (&[0.0][..], &[0.0][..], &[1.0][..], ProfileList::Vertical, 0, "1 vertical angles"),
        (&[0.0, 50.0, 40.0], &[0.0], &[1.0; 3], ProfileList::Vertical, 2, "ascend"),
        (&[0.0, 50.0, 50.0], &[0.0], &[1.0; 3], ProfileList::Vertical, 2, "ascend"),
        (&[0.0, 190.0], &[0.0], &[1.0; 2], ProfileList::Vertical, 1, "not from 0 to 180"),
        (&[0.0, f64::NAN], &[0.0], &[1.0; 2], ProfileList::Vertical, 1, "not from 0 to 180"),
        (&[0.0, 90.0], &[0.0, 45.0], &[1.0; 4], ProfileList::Horizontal, 1, "0 alone"),
        (&[0.0, 90.0], &[10.0], &[1.0; 2], ProfileList::Horizontal, 0, "0 alone"),
        (&[0.0, 90.0], &[0.0], &[1.0; 3], ProfileList::Candela, 2, "need 2 candela"),
        (&[0.0, 90.0], &[0.0], &[1.0, -1.0], ProfileList::Candela, 1, "-1 candela"),
        (&[0.0, 90.0], &[0.0], &[0.0, 0.0], ProfileList::Candela, 0, "no light"),
    ] {
        let found = fault(vertical, horizontal, candela);
        assert_eq!((found.0, found.1), (list, index), "{found:?}");
        assert!(found.2.contains(words), "{found:?}");
    }
}
