//! Meshes whose triangles are divided and smoothed (Loop 1987, "Smooth Subdivision Surfaces Based on Triangles"), up to the limit surface (Hoppe and
//! others 1994, "Piecewise Smooth Surface Reconstruction").

use std::collections::HashMap;
use std::f64::consts::TAU;

use glam::DVec3;

use super::mesh::indices;
use super::{Geometry, Needs};
use crate::load::error::SceneError;
use crate::load::memory;
use crate::load::pbrt::converter::Converter;
use crate::load::pbrt::world::ShapeRecord;
use crate::scene::Mesh;

/// Most levels: each has four times as many triangles as the one before.
const MOST_LEVELS: i64 = 12;
/// Bytes that a triangle takes while it is divided.
const FACE_BYTES: u64 = 400;

impl Converter<'_> {
    pub(super) fn loop_subdivision(&mut self, record: &ShapeRecord, needs: Needs) -> Result<Option<Geometry>, SceneError> {
        let entity = &record.entity;
        entity.without_effect(&["scheme"]);
        let levels = entity.integer_or("levels", 3)?;
        if !(0..=MOST_LEVELS).contains(&levels) {
            return Err(entity.spot_of("levels").error(format!("`levels` is from 0 to {MOST_LEVELS}, and not {levels}")));
        }
        let mesh = self.vertices(entity)?;
        let list = indices(entity, mesh.positions.len(), &[])?;
        let mut surface = Surface {
            positions: mesh.positions.iter().map(|position| position.as_dvec3()).collect(),
            faces: list.chunks_exact(3).map(|face| [face[0], face[1], face[2]]).collect(),
        };
        let needed = (surface.faces.len() as u64).saturating_mul(1 << (2 * levels)).saturating_mul(FACE_BYTES);
        if needed > memory::available() || surface.positions.len() as u64 + needed / FACE_BYTES > u64::from(u32::MAX) {
            return Err(entity.error(format!("there is no memory for {levels} levels of the mesh, about {} MiB", needed >> 20)));
        }
        let Some(rings) = surface.rings() else {
            let what = "Shape `loopsubdiv` of which an edge has more than two faces, or a vertex several fans of them";
            self.approximate(&entity.spot, what, "its triangles are not divided");
            let faces = surface.faces;
            return self.finish_mesh(record, needs, Mesh { faces, normals: Vec::new(), smooth: false, ..mesh });
        };
        let mut rings = rings;
        for _ in 0..levels {
            surface = surface.divided(&rings);
            // A division is as sound as the mesh that it was made of.
            let Some(next) = surface.rings() else { return Ok(None) };
            rings = next;
        }
        let limit: Vec<DVec3> = (0..rings.len()).map(|vertex| surface.limit(vertex, &rings[vertex])).collect();
        surface.positions = limit;
        let normals: Vec<DVec3> = rings.iter().enumerate().map(|(vertex, ring)| surface.normal(vertex, ring)).collect();
        let made = Mesh {
            positions: surface.positions.iter().map(|position| position.as_vec3()).collect(),
            normals: normals.iter().map(|normal| normal.as_vec3()).collect(),
            faces: surface.faces,
            smooth: true,
            ..Mesh::default()
        };
        self.finish_mesh(record, needs, made)
    }
}

struct Surface {
    positions: Vec<DVec3>,
    faces: Vec<[u32; 3]>,
}

/// The vertices around one in their order, counter-clockwise; of one at a border, from border to border.
#[derive(Debug, Default, PartialEq)]
struct Ring {
    around: Vec<u32>,
    is_border: bool,
}

impl Surface {
    /// The rings of all vertices; None where an edge has more than two faces, or a vertex several fans.
    fn rings(&self) -> Option<Vec<Ring>> {
        let mut next: Vec<Vec<(u32, u32)>> = vec![Vec::new(); self.positions.len()];
        for &[a, b, c] in &self.faces {
            for (vertex, from, to) in [(a, b, c), (b, c, a), (c, a, b)] {
                next[vertex as usize].push((from, to));
            }
        }
        next.into_iter().map(|edges| ring(&edges)).collect()
    }

    /// Each triangle as four.
    fn divided(&self, rings: &[Ring]) -> Self {
        let at = |vertex: u32| self.positions[vertex as usize];
        let mut positions: Vec<DVec3> = (0..rings.len()).map(|vertex| self.smoothed(vertex, &rings[vertex])).collect();
        let mut opposite: HashMap<(u32, u32), [Option<u32>; 2]> = HashMap::with_capacity(self.faces.len() * 2);
        for &[a, b, c] in &self.faces {
            for (from, to, third) in [(a, b, c), (b, c, a), (c, a, b)] {
                let thirds = opposite.entry((from.min(to), from.max(to))).or_default();
                let free = usize::from(thirds[0].is_some());
                thirds[free] = Some(third);
            }
        }
        let mut middles: HashMap<(u32, u32), u32> = HashMap::with_capacity(opposite.len());
        let mut middle = |from: u32, to: u32| {
            let key = (from.min(to), from.max(to));
            *middles.entry(key).or_insert_with(|| {
                let place = match opposite.get(&key) {
                    Some([Some(left), Some(right)]) => 0.375 * (at(key.0) + at(key.1)) + 0.125 * (at(*left) + at(*right)),
                    _ => 0.5 * (at(key.0) + at(key.1)),
                };
                positions.push(place);
                positions.len() as u32 - 1
            })
        };
        let mut faces = Vec::with_capacity(4 * self.faces.len());
        for &[a, b, c] in &self.faces {
            let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
            faces.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        Self { positions, faces }
    }

    fn sum_around(&self, ring: &Ring) -> DVec3 {
        ring.around.iter().map(|vertex| self.positions[*vertex as usize]).sum()
    }

    /// The two neighbours along the border.
    fn ends(&self, ring: &Ring) -> DVec3 {
        let end = |vertex: Option<&u32>| vertex.map_or(DVec3::ZERO, |vertex| self.positions[*vertex as usize]);
        end(ring.around.first()) + end(ring.around.last())
    }

    /// The share of a neighbour.
    fn share(valence: usize) -> f64 {
        if valence == 3 { 3.0 / 16.0 } else { 3.0 / (8.0 * valence as f64) }
    }

    fn weighted(&self, vertex: usize, ring: &Ring, share: f64, of_border: f64) -> DVec3 {
        let own = self.positions[vertex];
        match (ring.around.len(), ring.is_border) {
            // No face has it.
            (0, _) => own,
            (_, true) => (1.0 - 2.0 * of_border) * own + of_border * self.ends(ring),
            (valence, false) => (1.0 - valence as f64 * share) * own + share * self.sum_around(ring),
        }
    }

    fn smoothed(&self, vertex: usize, ring: &Ring) -> DVec3 {
        let valence = ring.around.len();
        let share = if valence == 6 { 1.0 / 16.0 } else { Self::share(valence) };
        self.weighted(vertex, ring, share, 1.0 / 8.0)
    }

    /// The place of a vertex after infinitely many levels.
    fn limit(&self, vertex: usize, ring: &Ring) -> DVec3 {
        let valence = ring.around.len();
        let share = 1.0 / (valence as f64 + 3.0 / (8.0 * Self::share(valence)));
        self.weighted(vertex, ring, share, 1.0 / 5.0)
    }

    /// The normal of the limit surface, by two directions along it.
    fn normal(&self, vertex: usize, ring: &Ring) -> DVec3 {
        let own = self.positions[vertex];
        let around: Vec<DVec3> = ring.around.iter().map(|vertex| self.positions[*vertex as usize]).collect();
        let valence = around.len();
        let (Some(first), Some(last)) = (around.first(), around.last()) else { return DVec3::Z };
        let (along, across) = if ring.is_border {
            let across = match valence {
                2 => *first + *last - 2.0 * own,
                3 => around[1] - own,
                4 => -*first + 2.0 * around[1] + 2.0 * around[2] - *last - 2.0 * own,
                _ => {
                    let angle = 0.5 * TAU / (valence - 1) as f64;
                    let mut sum = angle.sin() * (*first + *last);
                    for (step, place) in around.iter().enumerate().take(valence - 1).skip(1) {
                        sum += (2.0 * angle.cos() - 2.0) * (step as f64 * angle).sin() * *place;
                    }
                    -sum
                }
            };
            (*last - *first, across)
        } else {
            let turn = |step: usize| TAU * step as f64 / valence as f64;
            let sum =
                |part: fn(f64) -> f64| around.iter().enumerate().map(|(step, place)| part(turn(step)) * *place).sum::<DVec3>();
            (sum(f64::cos), sum(f64::sin))
        };
        let normal = along.cross(across);
        // At a border, the ring runs from right to left seen from within.
        let normal = if ring.is_border { -normal } else { normal };
        normal.normalize_or(DVec3::Z)
    }
}

/// Puts the edges that faces have opposite of a vertex in a row.
fn ring(edges: &[(u32, u32)]) -> Option<Ring> {
    let Some(&(any, _)) = edges.first() else { return Some(Ring::default()) };
    let mut next: HashMap<u32, u32> = HashMap::with_capacity(edges.len());
    let mut before: HashMap<u32, u32> = HashMap::with_capacity(edges.len());
    for &(from, to) in edges {
        if next.insert(from, to).is_some() || before.insert(to, from).is_some() {
            return None;
        }
    }
    let begin = edges.iter().map(|(from, _)| *from).find(|from| !before.contains_key(from));
    let is_border = begin.is_some();
    let begin = begin.unwrap_or(any);
    let mut around = vec![begin];
    let mut at = begin;
    while let Some(&to) = next.get(&at).filter(|to| **to != begin) {
        around.push(to);
        at = to;
    }
    let all = edges.len() + usize::from(is_border);
    (around.len() == all).then_some(Ring { around, is_border })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn octahedron() -> Surface {
        let positions = vec![DVec3::X, DVec3::Y, DVec3::NEG_X, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];
        let faces = vec![[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4], [1, 0, 5], [2, 1, 5], [3, 2, 5], [0, 3, 5]];
        Surface { positions, faces }
    }

    #[test]
    fn an_octahedron_becomes_a_ball() {
        let mut surface = octahedron();
        for _ in 0..3 {
            let rings = surface.rings().expect("it is sound");
            surface = surface.divided(&rings);
        }
        let rings = surface.rings().expect("it is sound");
        assert_eq!((surface.faces.len(), surface.positions.len()), (512, 258));
        let limit: Vec<DVec3> = (0..rings.len()).map(|vertex| surface.limit(vertex, &rings[vertex])).collect();
        surface.positions = limit;
        // By symmetry the limit of a corner stays on its axis, and its normal too.
        let corner = surface.positions[4];
        assert!(corner.x.abs() < 1e-12 && corner.y.abs() < 1e-12 && corner.z > 0.4, "{corner}");
        for (vertex, ring) in rings.iter().enumerate() {
            let (at, normal) = (surface.positions[vertex], surface.normal(vertex, ring));
            assert!(normal.dot(at.normalize()) > 0.9, "{at} {normal}");
        }
        assert!(surface.normal(4, &rings[4]).distance(DVec3::Z) < 1e-9);
    }

    /// A flat sheet stays flat, its border straight, its normals up.
    #[test]
    fn a_sheet_stays_flat() {
        let positions = (0..9).map(|index| DVec3::new(f64::from(index % 3), f64::from(index / 3), 0.0)).collect();
        let quad = |a: u32| [[a, a + 1, a + 4], [a, a + 4, a + 3]];
        let faces = [0, 1, 3, 4].into_iter().flat_map(quad).collect();
        let sheet = Surface { positions, faces };
        let rings = sheet.rings().expect("it is sound");
        assert!(rings[0].is_border && !rings[4].is_border);
        let divided = sheet.divided(&rings);
        let rings = divided.rings().expect("it is sound");
        for (vertex, ring) in rings.iter().enumerate() {
            let at = divided.positions[vertex];
            assert!(at.z == 0.0 && at.x >= 0.0 && at.y >= 0.0, "{at}");
            assert!(divided.normal(vertex, ring).distance(DVec3::Z) < 1e-9, "{at} {ring:?} {}", divided.normal(vertex, ring));
        }
    }

    #[test]
    fn edges_of_three_faces_are_found() {
        let positions = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::NEG_Y, DVec3::Z];
        let fan = |faces: Vec<[u32; 3]>| Surface { positions: positions.clone(), faces }.rings().is_some();
        assert!(fan(vec![[0, 1, 2], [1, 0, 3]]));
        assert!(!fan(vec![[0, 1, 2], [1, 0, 3], [0, 1, 4]]));
        assert!(!fan(vec![[0, 1, 2], [0, 1, 2]]));
    }
}
