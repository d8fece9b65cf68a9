//! Polygons of more than three corners as triangles.
//!
//! A fan of triangles about a polygon's first corner is right where every corner is seen from the first one, as in convex polygons; all
//! others are cut by ear clipping in the plane that fits the corners best.

use earcut::Earcut;
use glam::{DVec2, DVec3};

/// The triangles of a polygon.
pub struct Triangles {
    /// Counter-clockwise about the polygon's normal.
    pub triangles: Vec<[usize; 3]>,
    /// The polygon crosses itself, so that no triangles are right.
    pub crosses: bool,
}

/// None: a fan about the first corner is right, or the polygon has no area anywhere.
pub fn triangulate(corners: &[DVec3]) -> Option<Triangles> {
    let flat = project(corners)?;
    if fan_is_right(&flat) {
        return None;
    }
    let mut indices: Vec<usize> = Vec::new();
    Earcut::new().earcut(flat.iter().map(|point| point.to_array()), &[], &mut indices);
    let turned = |&[a, b, c]: &[usize; 3]| (flat[b] - flat[a]).perp_dot(flat[c] - flat[a]);
    let mut triangles: Vec<[usize; 3]> = indices.as_chunks().0.to_vec();
    triangles.iter_mut().filter(|triangle| turned(triangle) < 0.0).for_each(|[_, b, c]| std::mem::swap(b, c));
    // Ears of a simple polygon cover its area once.
    let covered: f64 = triangles.iter().map(turned).sum();
    let enclosed: f64 = (1..flat.len() - 1).map(|corner| turned(&[0, corner, corner + 1])).sum();
    let crosses = (covered - enclosed).abs() > 1e-6 * covered.max(enclosed.abs());
    Some(Triangles { triangles, crosses })
}

/// The corners in the plane perpendicular to Newell's normal (Sutherland et al. 1974), about which they turn counter-clockwise. None where
/// all of them stand on one line.
fn project(corners: &[DVec3]) -> Option<Vec<DVec2>> {
    let origin = corners[0];
    let size = corners.iter().map(|corner| (*corner - origin).abs().max_element()).fold(0.0, f64::max);
    let local: Vec<DVec3> = corners.iter().map(|corner| (*corner - origin) / size.max(f64::MIN_POSITIVE)).collect();
    let next = local.iter().cycle().skip(1);
    let newell: DVec3 = local.iter().zip(next).map(|(corner, next)| corner.cross(*next)).sum();
    // Opposite loops of a polygon that crosses itself may cancel. Its largest triangle then stands for its plane.
    let fan = local.windows(2).map(|pair| pair[0].cross(pair[1]));
    let normal = match newell.length() > 1e-9 {
        true => newell,
        false => fan.max_by(|a, b| a.length_squared().total_cmp(&b.length_squared()))?,
    };
    // In double precision the product of two single-precision edges is exact but for its last bits.
    let normal = Some(normal).filter(|normal| normal.length() > 1e-14)?.try_normalize()?;
    let (u, v) = normal.any_orthonormal_pair();
    Some(local.iter().map(|corner| DVec2::new(corner.dot(u), corner.dot(v))).collect())
}

/// True where every triangle of a fan about the first corner is turned as the polygon is, and the fan is not
/// wound around that corner.
fn fan_is_right(corners: &[DVec2]) -> bool {
    let mut angle = 0.0;
    for pair in corners[1..].windows(2) {
        let (from, to) = (pair[0] - corners[0], pair[1] - corners[0]);
        let turned = from.perp_dot(to);
        if turned < -1e-12 {
            return false;
        }
        angle += turned.atan2(from.dot(to));
    }
    angle < std::f64::consts::TAU - 1e-9
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Area of the triangles that a polygon is cut into, and whether it crosses itself. The control: the area of the fan.
    fn areas(corners: &[[f64; 3]]) -> (f64, f64, bool) {
        let corners: Vec<DVec3> = corners.iter().copied().map(DVec3::from_array).collect();
        let fan: Vec<[usize; 3]> = (1..corners.len() - 1).map(|corner| [0, corner, corner + 1]).collect();
        let area = |triangles: &[[usize; 3]]| -> f64 {
            let doubled = |&[a, b, c]: &[usize; 3]| (corners[b] - corners[a]).cross(corners[c] - corners[a]).length();
            triangles.iter().map(doubled).sum::<f64>() / 2.0
        };
        match triangulate(&corners) {
            Some(cut) => (area(&cut.triangles), area(&fan), cut.crosses),
            None => (area(&fan), area(&fan), false),
        }
    }

    fn flat(corners: &[[f64; 2]]) -> Vec<[f64; 3]> {
        corners.iter().map(|&[x, y]| [x, y, 0.0]).collect()
    }

    fn assert_area(corners: &[[f64; 3]], expected: f64) {
        let (cut, _, crosses) = areas(corners);
        assert!((cut - expected).abs() < 1e-9 * expected && !crosses, "{corners:?}: {cut} instead of {expected}, {crosses}");
    }

    const L: [[f64; 2]; 6] = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];

    #[test]
    fn concave_polygons_are_covered_once_whichever_corner_comes_first() {
        let quad = [[0.0, 0.0], [2.0, 2.0], [0.0, 1.0], [-2.0, 2.0]];
        for (shape, area) in [(&L[..], 3.0), (&quad[..], 2.0)] {
            let mut wrong_fans = 0;
            for first in 0..shape.len() {
                let mut corners = flat(shape);
                corners.rotate_left(first);
                assert_area(&corners, area);
                wrong_fans += usize::from((areas(&corners).1 - area).abs() > 1e-3);
                corners.reverse();
                assert_area(&corners, area);
            }
            // The control: most fans of these cover more.
            assert!(wrong_fans > 1, "{wrong_fans}");
        }
    }

    #[test]
    fn polygons_are_cut_in_their_own_plane_with_their_own_winding() {
        let turned = glam::DMat3::from_euler(glam::EulerRot::XYZ, 0.3, 1.1, -0.7);
        let corners: Vec<DVec3> =
            flat(&L).into_iter().map(|corner| turned * DVec3::from_array(corner) + DVec3::splat(5.0)).collect();
        let rotated = [&corners[2..], &corners[..2]].concat();
        let cut = triangulate(&rotated).expect("no fan about this corner");
        for [a, b, c] in cut.triangles {
            let normal = (rotated[b] - rotated[a]).cross(rotated[c] - rotated[a]).normalize();
            assert!(normal.dot(turned * DVec3::Z) > 0.999_999);
        }
    }

    #[test]
    fn a_polygon_that_is_not_quite_flat_is_cut_as_if_it_were() {
        let mut corners = flat(&L);
        corners.rotate_left(2);
        corners.iter_mut().enumerate().for_each(|(index, corner)| corner[2] = if index % 2 == 0 { 0.01 } else { -0.01 });
        let (area, fan, crosses) = areas(&corners);
        assert!((area - 3.0).abs() < 0.01 && fan > 3.5 && !crosses, "{area}, {fan}, {crosses}");
    }

    #[test]
    fn convex_polygons_stay_fans() {
        let circle = |count: usize| -> Vec<[f64; 3]> {
            let angle = |corner: usize| corner as f64 / count as f64 * std::f64::consts::TAU;
            (0..count).map(|corner| [angle(corner).cos(), 0.0, angle(corner).sin()]).collect()
        };
        for count in [4, 5, 64, 1000] {
            let corners: Vec<DVec3> = circle(count).into_iter().map(DVec3::from_array).collect();
            assert!(triangulate(&corners).is_none(), "{count}");
        }
    }

    #[test]
    fn polygons_without_area_are_left_to_be_dropped() {
        let line: Vec<DVec3> = (0..6).map(|step| DVec3::splat(f64::from(step % 4))).collect();
        assert!(triangulate(&line).is_none());
        assert!(triangulate(&[DVec3::ONE; 5]).is_none());
    }

    #[test]
    fn what_crosses_itself_is_noticed() {
        let bow_tie = flat(&[[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.0]]);
        let lopsided = flat(&[[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 3.0]]);
        let star: Vec<[f64; 3]> = (0..5)
            .map(|corner| (f64::from(corner) * 0.8 * std::f64::consts::PI).sin_cos())
            .map(|(sine, cosine)| [cosine, sine, 0.0])
            .collect();
        for corners in [bow_tie, lopsided, star] {
            assert!(areas(&corners).2, "{corners:?}");
        }
    }

    #[test]
    fn what_touches_itself_does_not_cross() {
        // A square with a hole, joined to its rim by a bridge that is walked twice.
        let ring = [
            [0.0, 0.0],
            [3.0, 0.0],
            [3.0, 3.0],
            [0.0, 3.0],
            [0.0, 0.0],
            [1.0, 1.0],
            [1.0, 2.0],
            [2.0, 2.0],
            [2.0, 1.0],
            [1.0, 1.0],
        ];
        assert_area(&flat(&ring), 8.0);
    }

    #[test]
    fn a_comb_of_many_corners_is_cut() {
        // Teeth of height 1 and width 1/2 on a bar of height 1.
        let teeth = 5000;
        let mut corners = vec![[0.0, -1.0], [f64::from(teeth), -1.0]];
        for tooth in (0..teeth).rev() {
            let x = f64::from(tooth);
            corners.extend([[x + 1.0, 0.0], [x + 0.75, 1.0], [x + 0.25, 1.0], [x, 0.0]]);
        }
        let (area, fan, _) = areas(&flat(&corners));
        let expected = f64::from(teeth) * 1.75;
        assert!((area - expected).abs() < 1e-6 * expected && fan > 1.1 * expected, "{area}, {fan}, {expected}");
    }
}
