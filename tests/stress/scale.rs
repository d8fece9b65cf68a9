//! One room from a millionth of a unit to a million units wide, and far from the origin.
//!
//! Radiance does not change where all lengths are multiplied by a factor, nor where everything is moved. So the device's picture of the
//! scaled or moved room is held against the reference's picture of the room at its own size, with the same random numbers. A dark or
//! bright spot where a ray met the surface that it started from, a leak between walls, a shadow that starts away from its object: all
//! are paths that do not match.

use std::fmt::Write as _;

use gpt::scene::Scene;

use super::support::{Effort, Finding, judge, scene};

/// Lengths multiplied by `unit`, then moved by `offset` (in the room's own sizes) along each axis.
#[derive(Clone, Copy)]
pub struct Placement {
    pub unit: f64,
    pub offset: f64,
}

impl Placement {
    fn point(self, p: [f64; 3]) -> String {
        self.triple(p.map(|x| (x + self.offset) * self.unit))
    }

    fn vector(self, v: [f64; 3]) -> String {
        self.triple(v.map(|x| x * self.unit))
    }

    fn length(self, x: f64) -> String {
        format!("{:e}", x * self.unit)
    }

    fn triple(self, [x, y, z]: [f64; 3]) -> String {
        format!("[{x:e}, {y:e}, {z:e}]")
    }
}

/// A room of every kind of shape but planes, one unit wide: a box, spheres of glass and of plaster that touch the floor, a tetrahedron, a disk
/// and a mesh for a wall, lit by a panel.
pub fn room(place: Placement) -> Scene {
    let mut text = String::from(MATERIALS);
    let p = |x, y, z| place.point([x, y, z]);
    let _ = write!(text, "[camera]\nposition = {}\nlook_at = {}\nvfov = 40\n", p(0.13, 0.21, 1.71), p(0.03, -0.04, 0.0));
    for (corner, u, v, material) in [
        ([-0.5, -0.5, 0.5], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0], "white"),
        ([-0.5, 0.5, -0.5], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0], "white"),
        ([-0.5, -0.5, -0.5], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], "white"),
        ([-0.5, -0.5, 0.5], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0], "red"),
        ([-0.17, 0.493, -0.13], [0.33, 0.0, 0.0], [0.0, 0.0, 0.29], "light"),
    ] {
        let _ = write!(
            text,
            "[[shape]]\ntype = \"rectangle\"\ncorner = {}\nedge_u = {}\nedge_v = {}\nmaterial = \"{material}\"\n",
            place.point(corner),
            place.vector(u),
            place.vector(v)
        );
    }
    // A mesh's own positions are f32; where it stands is not.
    let stands = format!("[{{ translate = [{0:e}, {0:e}, {0:e}] }}, {{ scale = {1:e} }}]", place.offset, place.unit);
    for (positions, faces, material) in [(WALL, "[[0, 1, 2], [0, 2, 3]]", "green"), (TETRAHEDRON, TETRAHEDRON_FACES, "metal")] {
        let _ = write!(
            text,
            "[[shape]]\ntype = \"mesh\"\npositions = {positions}\nfaces = {faces}\nmaterial = \"{material}\"\ntransform = {stands}\n"
        );
    }
    let _ = write!(
        text,
        "[[shape]]\ntype = \"box\"\nmin = {}\nmax = {}\nmaterial = \"white\"\n",
        p(0.17, -0.5, -0.37),
        p(0.39, -0.07, -0.14)
    );
    for (center, radius, material) in
        [([0.14, -0.35, 0.17], 0.15, "glass"), ([-0.19, -0.42, 0.27], 0.08, "white"), ([0.27, 0.05, -0.26], 0.12, "red")]
    {
        let _ = write!(
            text,
            "[[shape]]\ntype = \"sphere\"\ncenter = {}\nradius = {}\nmaterial = \"{material}\"\n",
            place.point(center),
            place.length(radius)
        );
    }
    let _ = write!(
        text,
        "[[shape]]\ntype = \"disk\"\ncenter = {}\nnormal = [0.3, 0.5, 0.9]\nradius = {}\nmaterial = \"metal\"\n",
        p(-0.31, 0.19, -0.31),
        place.length(0.11)
    );
    scene(&text)
}

const WALL: &str = "[[0.5, -0.5, -0.5], [0.5, -0.5, 0.5], [0.5, 0.5, 0.5], [0.5, 0.5, -0.5]]";
const TETRAHEDRON: &str = "[[-0.41, -0.5, -0.11], [-0.13, -0.5, -0.43], [-0.09, -0.5, 0.02], [-0.23, -0.11, -0.17]]";
const TETRAHEDRON_FACES: &str = "[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]";

const MATERIALS: &str = r#"
[film]
size = [48, 48]
[render]
spp = 8
max_depth = 8
[[material]]
name = "white"
type = "diffuse"
reflectance = 0.7
[[material]]
name = "red"
type = "diffuse"
reflectance = [0.6, 0.1, 0.1]
[[material]]
name = "green"
type = "diffuse"
reflectance = [0.1, 0.6, 0.1]
[[material]]
name = "metal"
type = "conductor"
reflectance = 0.8
roughness = 0.5
[[material]]
name = "glass"
type = "glass"
ior = 1.5
[[material]]
name = "light"
type = "emissive"
radiance = 9
"#;

/// The room at its own size, near the origin.
pub const HERE: Placement = Placement { unit: 1.0, offset: 0.0 };

pub fn findings(effort: Effort) -> Vec<Finding> {
    let truth = room(HERE);
    let all_units: Vec<i32> = (-6..=6).collect();
    let units = effort.pick(vec![-6, -3, 6], all_units);
    let scaled = units.into_iter().flat_map(|power| {
        judge(format!("1e{power} units wide"), &room(Placement { unit: 10f64.powi(power), offset: 0.0 }), &truth)
    });
    let offsets = effort.pick(vec![4, 7], vec![0, 1, 2, 3, 4, 5, 6, 7]);
    let moved = offsets.into_iter().flat_map(|power| {
        judge(format!("moved by 1e{power} times its width"), &room(Placement { unit: 1.0, offset: 10f64.powi(power) }), &truth)
    });
    scaled.chain(moved).collect()
}
