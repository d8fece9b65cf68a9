//! The Utah teapot (Martin Newell, 1975): 32 bicubic Bézier patches, with the bottom that was added to it later, in the proportions of
//! the widely used data set (Crow, "The Origins of the Teapot", IEEE Computer Graphics and Applications 7(1), 1987).
//!
//! The published patches are symmetric: rim, body, lid and bottom are quarters of surfaces of revolution, handle and spout are halves
//! of tubes. Here each ring of control points is written once. The lid leaves the gap to the rim that Newell's teapot has.

use glam::{DVec2, DVec3};

use super::surface::{Surface, Vertex};

/// First line of the file.
pub const ABOUT: &str = "The Utah teapot from its published Bezier patches: height 1, on y = 0, spout along +x.";

/// Height of the knob in the published numbers.
const HEIGHT: f64 = 3.15;
/// Faces along a quarter of a turn, and across half a tube.
const COLUMNS: usize = 12;

/// A ring of control points about the axis: radius, height.
type Ring = (f64, f64);
/// Half a ring of control points of a tube, in the plane of the handle: the first corner's x and z, the second's, the half width.
type TubeRing = [f64; 5];

/// Profiles from top to bottom, with the number of faces along each.
const PROFILES: [([Ring; 4], usize); 6] = [
    ([(1.4, 2.4), (1.3375, 2.53125), (1.4375, 2.53125), (1.5, 2.4)], 6),
    ([(1.5, 2.4), (1.75, 1.875), (2.0, 1.35), (2.0, 0.9)], 10),
    ([(2.0, 0.9), (2.0, 0.45), (1.5, 0.225), (1.5, 0.15)], 10),
    ([(0.0, 3.15), (0.8, 3.15), (0.0, 2.85), (0.2, 2.7)], 12),
    ([(0.2, 2.7), (0.4, 2.55), (1.3, 2.55), (1.3, 2.4)], 10),
    ([(1.5, 0.15), (1.5, 0.075), (1.425, 0.0), (0.0, 0.0)], 8),
];

const TUBES: [([TubeRing; 4], usize); 4] = [
    // The handle, from the rim down.
    (
        [
            [-1.6, 2.025, -1.5, 2.25, 0.3],
            [-2.3, 2.025, -2.5, 2.25, 0.3],
            [-2.7, 2.025, -3.0, 2.25, 0.3],
            [-2.7, 1.8, -3.0, 1.8, 0.3],
        ],
        12,
    ),
    (
        [
            [-2.7, 1.8, -3.0, 1.8, 0.3],
            [-2.7, 1.575, -3.0, 1.35, 0.3],
            [-2.5, 1.125, -2.65, 0.9375, 0.3],
            [-2.0, 0.9, -1.9, 0.6, 0.3],
        ],
        12,
    ),
    // The spout, from the body up to its lip.
    (
        [[1.7, 1.425, 1.7, 0.6, 0.66], [2.6, 1.425, 3.1, 0.825, 0.66], [2.3, 2.1, 2.4, 2.025, 0.25], [2.7, 2.4, 3.3, 2.4, 0.25]],
        14,
    ),
    (
        [
            [2.7, 2.4, 3.3, 2.4, 0.25],
            [2.8, 2.475, 3.525, 2.49375, 0.25],
            [2.9, 2.475, 3.45, 2.5125, 0.15],
            [2.8, 2.4, 3.2, 2.4, 0.15],
        ],
        18,
    ),
];

/// The whole teapot.
pub fn teapot() -> Surface {
    let mut surface = Surface::default();
    for (rings, rows) in PROFILES {
        for quarter in 0..4 {
            let patch = Patch(rings.map(|ring| quarter_ring(ring, quarter)));
            surface.add_grid(COLUMNS, rows, |u, v| patch.vertex(u, v, DVec2::new((f64::from(quarter) + u) / 4.0, v)));
        }
    }
    for (rings, rows) in TUBES {
        for half in 0..2 {
            let patch = Patch(rings.map(|ring| half_ring(ring, half == 1)));
            surface.add_grid(COLUMNS, rows, |u, v| patch.vertex(u, v, DVec2::new((f64::from(half) + u) / 2.0, v)));
        }
    }
    surface
}

/// Control points of a quarter of a circle, nearly: from +x to −y, and turned on by so many quarters.
fn quarter_ring((radius, height): Ring, quarter: i32) -> [DVec3; 4] {
    // The published numbers take 0.56 times the radius everywhere but at the knob, where 0.45 to 0.8 is 0.5625. (A cubic is
    // nearest to the circle with 0.5523.)
    let handle = radius * if height == HEIGHT { 0.5625 } else { 0.56 };
    [(radius, 0.0), (radius, -handle), (handle, -radius), (0.0, -radius)].map(|(x, y)| {
        let (x, y) = (0..quarter).fold((x, y), |(x, y), _| (y, -x));
        DVec3::new(x, y, height)
    })
}

/// Control points of half a ring of a tube; the `mirrored` half leads from the second corner back to the first.
fn half_ring([first_x, first_z, second_x, second_z, width]: TubeRing, mirrored: bool) -> [DVec3; 4] {
    let half = [
        DVec3::new(first_x, 0.0, first_z),
        DVec3::new(first_x, -width, first_z),
        DVec3::new(second_x, -width, second_z),
        DVec3::new(second_x, 0.0, second_z),
    ];
    if !mirrored {
        return half;
    }
    let [first, second, third, fourth] = half.map(|point| DVec3::new(point.x, -point.y, point.z));
    [fourth, third, second, first]
}

/// Control points of a bicubic Bézier patch: u runs along a row, v from row to row. Along u × along v points outward.
struct Patch([[DVec3; 4]; 4]);

impl Patch {
    /// The point at (u, v), in our coordinates.
    fn vertex(&self, u: f64, v: f64, texture: DVec2) -> Vertex {
        let (weights_u, weights_v) = (bernstein(u), bernstein(v));
        let (slopes_u, slopes_v) = (bernstein_slopes(u), bernstein_slopes(v));
        let position = self.sum(weights_u, weights_v);
        let mut along_u = self.sum(slopes_u, weights_v);
        if along_u.length() < 1e-9 {
            // A pole: the row is one point, and the direction along u is that of the rows beside it.
            along_u = self.sum(slopes_u, slopes_v) * if v < 0.5 { 1.0 } else { -1.0 };
        }
        let normal = along_u.cross(self.sum(weights_u, slopes_v)).normalize();
        Vertex { position: turned(position) / HEIGHT, normal: turned(normal), uv: DVec2::new(1.0 - texture.x, 1.0 - texture.y) }
    }

    fn sum(&self, weights_u: [f64; 4], weights_v: [f64; 4]) -> DVec3 {
        let rows = self.0.iter().map(|row| row.iter().zip(weights_u).map(|(&point, weight)| weight * point).sum::<DVec3>());
        rows.zip(weights_v).map(|(point, weight)| weight * point).sum()
    }
}

/// The published data has z up, ours y.
fn turned(vector: DVec3) -> DVec3 {
    DVec3::new(vector.x, vector.z, -vector.y)
}

/// Cubic Bernstein polynomials.
fn bernstein(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t]
}

/// Their derivatives.
fn bernstein_slopes(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    [-3.0 * s * s, 3.0 * s * (s - 2.0 * t), 3.0 * t * (2.0 * s - t), 3.0 * t * t]
}
