use std::f64::consts::PI;

use glam::DVec3;

use super::table::{GUIDE_COLUMNS, GUIDE_ROWS};
use super::{Arrival, BINS, Guide, GuideCell, learn};
use crate::sampling::cell_grid::facing;
use crate::sampling::hash::mix;
use crate::sampling::sampler::uniform;

/// Arrivals over a floor of side 4, by even directions about its normal, from a bright patch of the sky and a dim rest.
fn arrivals(normal: DVec3, count: u32) -> Vec<Arrival> {
    let number = |index: u32, axis: u32| uniform(mix(mix(index.wrapping_mul(7) + 1).wrapping_add(axis)));
    let arrival = |index: u32| {
        let (z, turns) = (number(index, 0), number(index, 1));
        let (sine, angle) = ((1.0 - z * z).sqrt(), 2.0 * PI * turns);
        let frame = crate::math::Frame::around(normal);
        let wi = frame.to_world(DVec3::new(sine * angle.cos(), sine * angle.sin(), z));
        let position = frame.to_world(DVec3::new(4.0 * number(index, 2), 4.0 * number(index, 3), 0.0));
        let radiance = if bright(&frame.to_local(wi)) { 50.0 } else { 0.5 };
        let [position, normal, wi] = [position, normal, wi].map(|vector| vector.as_vec3());
        Arrival { position, normal, wi, radiance, pdf: (0.5 / PI) as f32, sent_on: [0.25, 1.0] }
    };
    (0..count).map(arrival).collect()
}

fn bright(local: &DVec3) -> bool {
    local.dot(DVec3::new(0.6, 0.0, 0.8)) > 0.97
}

fn guide(normal: DVec3) -> Guide {
    learn(&arrivals(normal, 20_000)).expect("there is light")
}

/// A cell in the middle of the floor.
fn cell(guide: &Guide, normal: DVec3) -> GuideCell<'_> {
    let middle = crate::math::Frame::around(normal).to_world(DVec3::new(2.1, 1.9, 0.0));
    guide.cell(middle, normal).expect("the middle of the floor is known")
}

const NORMALS: [DVec3; 3] = [DVec3::Y, DVec3::NEG_Z, DVec3::new(0.48, -0.6, 0.64)];

#[test]
fn densities_integrate_to_one() {
    for normal in NORMALS {
        let guide = guide(normal);
        let cell = cell(&guide, normal);
        let axis = cell.frame_of_tests();
        // Evenly over the projected hemisphere, where dω = dA / cosθ.
        let (rows, columns) = (10 * GUIDE_ROWS, 10 * GUIDE_COLUMNS);
        let mut sum = 0.0;
        for row in 0..rows {
            let squared_sine = (f64::from(row) + 0.5) / f64::from(rows);
            let (sine, z) = (squared_sine.sqrt(), (1.0 - squared_sine).sqrt());
            for column in 0..columns {
                let angle = 2.0 * PI * (f64::from(column) + 0.5) / f64::from(columns);
                sum += cell.pdf(axis.to_world(DVec3::new(sine * angle.cos(), sine * angle.sin(), z))) / z;
            }
        }
        let integral = sum * PI / f64::from(rows * columns);
        assert!((integral - 1.0).abs() < 1e-9, "{integral}");
        assert_eq!(cell.pdf(-normal), 0.0);
    }
}

/// χ² over finer bins than the histogram's, and the same test against the cosine distribution as its control.
#[test]
fn samples_follow_their_density() {
    let normal = NORMALS[2];
    let guide = guide(normal);
    let cell = cell(&guide, normal);
    let (rows, columns) = (2 * GUIDE_ROWS as usize, 2 * GUIDE_COLUMNS as usize);
    let count = 200_000_u32;
    let mut found = vec![0.0; rows * columns];
    let axis = cell.frame_of_tests();
    for index in 0..count {
        let wi = cell.sample(uniform(mix(2 * index + 1)), uniform(mix(mix(index) ^ 0x9e37_79b9)));
        assert!((wi.length() - 1.0).abs() < 1e-12 && cell.pdf(wi) > 0.0);
        let local = axis.to_local(wi);
        let turns = (local.y.atan2(local.x) / (2.0 * PI)).rem_euclid(1.0);
        let row = ((1.0 - local.z * local.z) * rows as f64) as usize;
        found[row.min(rows - 1) * columns + ((turns * columns as f64) as usize).min(columns - 1)] += 1.0;
    }
    let statistic = |expected: &dyn Fn(usize, usize) -> f64| {
        let bins = (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column)));
        bins.map(|(row, column)| {
            let expected = expected(row, column) * f64::from(count);
            (found[row * columns + column] - expected).powi(2) / expected
        })
        .sum::<f64>()
    };
    let by_density = statistic(&|row, column| {
        let squared_sine = (row as f64 + 0.5) / rows as f64;
        let angle = 2.0 * PI * (column as f64 + 0.5) / columns as f64;
        let (sine, z) = (squared_sine.sqrt(), (1.0 - squared_sine).sqrt());
        // Per projected solid angle the density is constant in a bin.
        cell.pdf(axis.to_world(DVec3::new(sine * angle.cos(), sine * angle.sin(), z))) / z * PI / (rows * columns) as f64
    });
    let by_cosine = statistic(&|_, _| 1.0 / (rows * columns) as f64);
    let freedom = (rows * columns - 1) as f64;
    // Six standard deviations of χ².
    let limit = freedom + 6.0 * (2.0 * freedom).sqrt();
    assert!(by_density < limit && by_cosine > 10.0 * limit, "{by_density} {by_cosine} {limit}");
}

#[test]
fn a_guide_draws_where_light_comes_from_and_no_direction_is_forgotten() {
    let normal = DVec3::Y;
    let guide = guide(normal);
    let cell = cell(&guide, normal);
    let axis = cell.frame_of_tests();
    let lit = (0..10_000_u32)
        .filter(|&index| bright(&axis.to_local(cell.sample(uniform(mix(index)), uniform(mix(index ^ 0xabcd_1234))))))
        .count();
    // The cosine distribution draws the patch, which has a hundred times the radiance of the rest, in 5 % of its directions.
    assert!(lit > 1500, "{lit}");
    let least = (0..BINS).map(|index| {
        let squared_sine = ((index / 16) as f64 + 0.5) / 8.0;
        let angle = 2.0 * PI * ((index % 16) as f64 + 0.5) / 16.0;
        let (sine, z) = (squared_sine.sqrt(), (1.0 - squared_sine).sqrt());
        cell.pdf(axis.to_world(DVec3::new(sine * angle.cos(), sine * angle.sin(), z))) * PI / z
    });
    assert!(least.fold(f64::INFINITY, f64::min) > 0.02);
}

/// Arrivals in a cube of side 4 full of a medium, by even directions, from a bright patch and a dim rest.
fn guide_of_medium() -> Guide {
    let number = |index: u32, axis: u32| uniform(mix(mix(index.wrapping_mul(7) + 1).wrapping_add(axis)));
    let arrival = |index: u32| {
        let wi = crate::reference::warp::uniform_sphere(number(index, 0), number(index, 1));
        let position = DVec3::new(number(index, 2), number(index, 3), number(index, 4)) * 4.0;
        let radiance = if wi.dot(DVec3::new(0.0, -0.6, -0.8)) > 0.9 { 50.0 } else { 0.5 };
        let pdf = (0.25 / PI) as f32;
        Arrival { position: position.as_vec3(), normal: glam::Vec3::ZERO, wi: wi.as_vec3(), radiance, pdf, sent_on: [0.25, 1.0] }
    };
    learn(&(0..40_000).map(arrival).collect::<Vec<_>>()).expect("there is light")
}

/// Within a medium a guide draws all directions, as densely as it says, and most where light comes from.
#[test]
fn guides_within_media_are_about_all_directions() {
    let guide = guide_of_medium();
    let middle = DVec3::new(2.1, 1.9, 2.2);
    assert!(guide.cell(middle, DVec3::Y).is_none() && guide.cell_in_medium(middle + 9.0 * DVec3::X).is_none());
    let cell = guide.cell_in_medium(middle).expect("the middle is known");
    let (rows, columns) = (2 * GUIDE_ROWS, 2 * GUIDE_COLUMNS);
    let place = |wi: DVec3| {
        let turns = (wi.y.atan2(wi.x) / (2.0 * PI)).rem_euclid(1.0);
        let row = ((0.5 - 0.5 * wi.z) * f64::from(rows)) as u32;
        (row.min(rows - 1) * columns + ((turns * f64::from(columns)) as u32).min(columns - 1)) as usize
    };
    let count = 200_000_u32;
    let mut found = vec![0.0; (rows * columns) as usize];
    let mut bright = 0;
    for index in 0..count {
        let wi = cell.sample(uniform(mix(2 * index + 1)), uniform(mix(mix(index) ^ 0x9e37_79b9)));
        assert!((wi.length() - 1.0).abs() < 1e-12 && cell.pdf(wi) > 0.0);
        found[place(wi)] += 1.0;
        bright += u32::from(wi.dot(DVec3::new(0.0, -0.6, -0.8)) > 0.9);
    }
    let share = |row: u32, column: u32| {
        let z = 1.0 - 2.0 * (f64::from(row) + 0.5) / f64::from(rows);
        let angle = 2.0 * PI * (f64::from(column) + 0.5) / f64::from(columns);
        let sine = (1.0 - z * z).sqrt();
        cell.pdf(DVec3::new(sine * angle.cos(), sine * angle.sin(), z)) * 4.0 * PI / f64::from(rows * columns)
    };
    let bins = || (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column)));
    let sum: f64 = bins().map(|(row, column)| share(row, column)).sum();
    assert!((sum - 1.0).abs() < 1e-9, "{sum}");
    let statistic = |expected: &dyn Fn(u32, u32) -> f64| {
        bins()
            .map(|(row, column)| {
                let expected = expected(row, column) * f64::from(count);
                (found[(row * columns + column) as usize] - expected).powi(2) / expected
            })
            .sum::<f64>()
    };
    let (by_density, evenly) = (statistic(&share), statistic(&|_, _| 1.0 / f64::from(rows * columns)));
    let freedom = f64::from(rows * columns - 1);
    let limit = freedom + 6.0 * (2.0 * freedom).sqrt();
    assert!(by_density < limit && evenly > 10.0 * limit, "{by_density} {evenly} {limit}");
    // Even directions would have a twentieth there.
    assert!(bright > count / 5, "{bright}");
}

/// No point outside, no other facing; and the same arrivals make the same table.
#[test]
fn cells_are_where_arrivals_were() {
    let normal = DVec3::Y;
    let guide = guide(normal);
    let middle = crate::math::Frame::around(normal).to_world(DVec3::new(2.1, 1.9, 0.0));
    assert!(guide.cell(middle, normal).is_some() && guide.cell(middle, -normal).is_none());
    assert!(guide.cell(middle + DVec3::Y, normal).is_none() && guide.cell(DVec3::splat(f64::NAN), normal).is_none());
    // 20,000 arrivals, of which a cell has 3,072 at most.
    assert!((7..30).contains(&guide.cells()), "{}", guide.cells());
    assert_eq!(guide.words(), self::guide(normal).words());
    assert!(learn(&arrivals(normal, 20)).is_none());
}

#[test]
fn facings_have_no_border_at_round_angles() {
    let unit = |x: f64, y: f64, z: f64| DVec3::new(x, y, z).normalize();
    for (normal, expected) in [(unit(1.0, 1.0, 0.0), 2), (unit(-1.0, 0.0, 1.0), 4), (unit(0.0, -1.0, -1.0), 5), (DVec3::NEG_X, 1)]
    {
        assert_eq!(facing(normal), expected);
        assert_eq!(facing((normal + DVec3::new(3e-6, -2e-6, 1e-6)).normalize()), expected);
        assert_eq!(facing((normal - DVec3::new(3e-6, -2e-6, 1e-6)).normalize()), expected);
    }
}
