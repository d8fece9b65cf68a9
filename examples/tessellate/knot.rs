//! A trefoil knot on a turned pedestal: a smooth solid with holes and hidden places, above one with creases.

use std::f64::consts::{FRAC_PI_2, TAU};

use glam::{DVec2, DVec3};

use super::surface::{Surface, Vertex};

/// First line of the file.
pub const ABOUT: &str = "A trefoil knot on a turned pedestal: height 1, on y = 0, the knot in the plane of x and y.";

/// The knot winds about a torus of these radii, twice one way and three times the other.
const RING: f64 = 0.235;
const TUBE: f64 = 0.098;
/// Half the thickness of the knot itself, more than half the distance of its strands.
const THICKNESS: f64 = 0.062;
/// Height of the torus's centre, so that the top is at 1.
const CENTRE: f64 = 0.605;
const KNOT_FACES: [usize; 2] = [160, 20];
const PEDESTAL_COLUMNS: usize = 64;

/// The knot and its pedestal.
pub fn knot() -> Surface {
    let mut surface = Surface::default();
    surface.add_grid(KNOT_FACES[0], KNOT_FACES[1], knot_vertex);
    for (rows, piece) in PROFILE {
        surface.add_grid(PEDESTAL_COLUMNS, rows, |u, v| piece.vertex(u, v));
    }
    surface
}

/// Where the knot's centre line is at `t`, a turn being 2π, and the direction away from the torus it lies on.
fn centre_line(t: f64) -> (DVec3, DVec3) {
    let (about, around) = (2.0 * t + FRAC_PI_2, 3.0 * t);
    let out = DVec3::new(about.cos(), about.sin(), 0.0);
    let away = around.cos() * out + around.sin() * DVec3::Z;
    (RING * out + TUBE * away, away)
}

fn knot_vertex(u: f64, v: f64) -> Vertex {
    let t = TAU * u;
    let (centre, away) = centre_line(t);
    // The derivative of the centre line.
    let about = 2.0 * t + FRAC_PI_2;
    let out = DVec3::new(about.cos(), about.sin(), 0.0);
    let along_ring = DVec3::new(-about.sin(), about.cos(), 0.0);
    let (sin, cos) = (3.0 * t).sin_cos();
    let along = 2.0 * (RING + TUBE * cos) * along_ring + 3.0 * TUBE * (cos * DVec3::Z - sin * out);
    // `away` is at right angles to it, as the line lies on the torus.
    let side = along.cross(away).normalize();
    let (sin, cos) = (TAU * v).sin_cos();
    let normal = cos * away + sin * side;
    let position = DVec3::new(0.0, CENTRE, 0.0) + centre + THICKNESS * normal;
    Vertex { position, normal, uv: DVec2::new(u, v) }
}

/// A piece of the pedestal's profile, from top to bottom; pieces meet at creases.
#[derive(Debug, Clone, Copy)]
enum Piece {
    /// From one (radius, height) to another.
    Line([f64; 2], [f64; 2]),
    /// A quarter of a circle about a centre, with a radius: hollow, from straight above the centre to beside it.
    Cove([f64; 2], f64),
    /// The same, bulging.
    Round([f64; 2], f64),
}

/// The pieces with the number of faces along each.
const PROFILE: [(usize, Piece); 9] = [
    (3, Piece::Line([0.0, 0.3], [0.2, 0.3])),
    (1, Piece::Line([0.2, 0.3], [0.22, 0.28])),
    (1, Piece::Line([0.22, 0.28], [0.22, 0.25])),
    (1, Piece::Line([0.22, 0.25], [0.16, 0.25])),
    (8, Piece::Cove([0.3, 0.25], 0.14)),
    (2, Piece::Line([0.3, 0.11], [0.32, 0.11])),
    (8, Piece::Round([0.32, 0.06], 0.05)),
    (1, Piece::Line([0.37, 0.06], [0.37, 0.0])),
    (3, Piece::Line([0.37, 0.0], [0.0, 0.0])),
];

impl Piece {
    fn vertex(self, u: f64, v: f64) -> Vertex {
        let (point, normal) = self.at(v);
        let (sin, cos) = (TAU * u).sin_cos();
        let turned = |[radius, height]: [f64; 2]| DVec3::new(radius * cos, height, -radius * sin);
        Vertex { position: turned(point), normal: turned(normal), uv: DVec2::new(u, point[1]) }
    }

    /// The point so far along, as radius and height, and the unit normal there.
    fn at(self, v: f64) -> ([f64; 2], [f64; 2]) {
        match self {
            Self::Line([r0, h0], [r1, h1]) => {
                let length = (r1 - r0).hypot(h1 - h0);
                ([r0 + v * (r1 - r0), h0 + v * (h1 - h0)], [(h0 - h1) / length, (r1 - r0) / length])
            }
            Self::Cove([r, h], radius) => {
                let (sin, cos) = (FRAC_PI_2 * v).sin_cos();
                ([r - radius * cos, h - radius * sin], [cos, sin])
            }
            Self::Round([r, h], radius) => {
                let (sin, cos) = (FRAC_PI_2 * v).sin_cos();
                ([r + radius * sin, h + radius * cos], [sin, cos])
            }
        }
    }
}
