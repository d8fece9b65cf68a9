//! Meshes that joints and morph targets bend.

use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec3, Vec3};

use super::curve::{Curve, Moment};
use crate::scene::shape::Mesh;

/// The deformation of a mesh: morph targets first, then joints (linear blend skinning, as glTF 2.0 has it in sections 3.7.2.2 and 3.7.3.3). Both are lists in the order of the mesh's vertices.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Deformation {
    /// Before anything bends it.
    pub base: Arc<Mesh>,
    pub targets: Vec<MorphTarget>,
    pub joints: Vec<Joint>,
    pub influences: Influences,
}

/// By how much vertices are moved where the target counts wholly. Empty lists move nothing.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct MorphTarget {
    pub positions: Vec<Vec3>,
    pub normals: Vec<Vec3>,
    /// How much it counts without a frame.
    pub rest: f64,
    /// Its weight at frames; without keys it stays as it is.
    pub weight: Curve<f64>,
}

/// A joint that takes vertices along.
#[derive(Debug, Clone, PartialEq)]
pub struct Joint {
    /// The node that takes it along, among those of the animation.
    pub node: Option<usize>,
    /// From the mesh before it is deformed to the mesh as it is without a frame.
    pub bind: DAffine3,
}

/// Which joints take each vertex along, and how much each counts.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Influences {
    /// The joints and weights of all vertices, one vertex after the other. Weights of a vertex need not add
    /// up to 1.
    pub pairs: Vec<(u32, f32)>,
    /// The end of each vertex' pairs; empty where no joint takes anything along.
    pub ends: Vec<u32>,
}

/// A mesh of the scene that is deformed at frames.
#[derive(Debug, Clone, PartialEq)]
pub struct DeformationTrack {
    /// Index among the scene's shapes.
    pub shape: usize,
    pub deformation: Arc<Deformation>,
    /// The mesh without a frame, as the shape has it.
    pub rest: Arc<Mesh>,
    /// From the shape's space to the world, without a frame.
    pub place: DAffine3,
}

impl Influences {
    /// Appends a vertex.
    pub fn push(&mut self, pairs: impl IntoIterator<Item = (u32, f32)>) {
        self.pairs.extend(pairs);
        self.ends.push(self.pairs.len() as u32);
    }

    /// Joints and weights of each vertex.
    pub fn of_vertices(&self) -> impl Iterator<Item = &[(u32, f32)]> {
        let starts = std::iter::once(&0).chain(&self.ends);
        starts.zip(&self.ends).map(|(start, end)| &self.pairs[*start as usize..*end as usize])
    }
}

impl Deformation {
    /// Every list is as long as the mesh needs it, every joint is there and every number is finite.
    ///
    /// # Errors
    /// The mistake, in a sentence.
    pub fn check(&self) -> Result<(), String> {
        let count = self.base.positions.len();
        for (index, target) in self.targets.iter().enumerate() {
            for (what, list) in [("positions", &target.positions), ("normals", &target.normals)] {
                if !list.is_empty() && list.len() != count {
                    return Err(format!("target {index} moves {} {what}, and the mesh has {count} vertices", list.len()));
                }
                if let Some(vertex) = list.iter().position(|offset| !offset.is_finite()) {
                    return Err(format!("target {index} moves vertex {vertex} by {}", list[vertex]));
                }
            }
        }
        if !self.influences.ends.is_empty() && self.influences.ends.len() != count {
            return Err(format!("joints take along {} vertices, and the mesh has {count}", self.influences.ends.len()));
        }
        for (vertex, pairs) in self.influences.of_vertices().enumerate() {
            for (joint, weight) in pairs {
                if *joint as usize >= self.joints.len() {
                    return Err(format!("vertex {vertex} hangs on joint {joint}, and there are {}", self.joints.len()));
                }
                if !weight.is_finite() {
                    return Err(format!("vertex {vertex} hangs on joint {joint} with the weight {weight}"));
                }
            }
        }
        Ok(())
    }

    /// Gives every corner of these triangles a vertex of its own; whoever does the same with the mesh keeps them together.
    pub fn spread(&mut self, corners: &[[u32; 3]]) {
        let all = || corners.iter().flatten().map(|&corner| corner as usize);
        for target in &mut self.targets {
            for list in [&mut target.positions, &mut target.normals] {
                if !list.is_empty() {
                    *list = all().map(|corner| list[corner]).collect();
                }
            }
        }
        if !self.influences.ends.is_empty() {
            let of_vertices: Vec<&[(u32, f32)]> = self.influences.of_vertices().collect();
            let mut spread = Influences::default();
            all().for_each(|corner| spread.push(of_vertices[corner].iter().copied()));
            self.influences = spread;
        }
    }

    /// The mesh as it is without a frame.
    pub fn at_rest(&self) -> Mesh {
        let joints: Vec<DAffine3> = self.joints.iter().map(|joint| joint.bind).collect();
        self.deformed(&self.targets.iter().map(|target| target.rest).collect::<Vec<_>>(), &joints)
    }

    /// The mesh while the shutter is open. `along` is by how much a node takes things along, in the mesh's space.
    pub fn during(&self, moment: Moment, along: &dyn Fn(usize) -> DAffine3) -> Mesh {
        let weights: Vec<f64> = self.targets.iter().map(|target| target.weight.during(moment).unwrap_or(target.rest)).collect();
        let map = |joint: &Joint| joint.node.map_or(joint.bind, |node| along(node) * joint.bind);
        self.deformed(&weights, &self.joints.iter().map(map).collect::<Vec<_>>())
    }

    /// The mesh with these weights of its targets and these maps of its joints, without the faces that have no area then.
    fn deformed(&self, weights: &[f64], joints: &[DAffine3]) -> Mesh {
        let mut mesh = Mesh::clone(&self.base);
        for (target, weight) in self.targets.iter().zip(weights).filter(|(_, weight)| **weight != 0.0) {
            let weight = *weight as f32;
            mesh.positions.iter_mut().zip(&target.positions).for_each(|(value, step)| *value += step * weight);
            mesh.normals.iter_mut().zip(&target.normals).for_each(|(value, step)| *value += step * weight);
        }
        // A joint that flattens has no inverse for normals.
        let inverses: Vec<Option<DMat3>> =
            joints.iter().map(|map| map.matrix3.determinant().is_normal().then(|| map.matrix3.inverse().transpose())).collect();
        for (vertex, pairs) in self.influences.of_vertices().enumerate() {
            let total: f64 = pairs.iter().map(|(_, weight)| f64::from(*weight)).sum();
            if total <= 0.0 {
                continue;
            }
            let (mut position, mut normal) = (DVec3::ZERO, DVec3::ZERO);
            for (joint, weight) in pairs {
                let share = f64::from(*weight) / total;
                position += joints[*joint as usize].transform_point3(mesh.positions[vertex].as_dvec3()) * share;
                if let (Some(own), Some(inverse)) = (mesh.normals.get(vertex), inverses[*joint as usize]) {
                    normal += (inverse * own.as_dvec3()) * share;
                }
            }
            mesh.positions[vertex] = position.as_vec3();
            if let Some(own) = mesh.normals.get_mut(vertex) {
                *own = normal.as_vec3();
            }
        }
        for (normal, base) in mesh.normals.iter_mut().zip(&self.base.normals) {
            // One of length 1 stays as it is to the last bit.
            let is_unit = (normal.length_squared() - 1.0).abs() < 1e-6;
            if !is_unit {
                *normal = normal.try_normalize().unwrap_or(*base);
            }
        }
        mesh.drop_degenerate_faces();
        mesh
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Interpolation, Key};
    use super::*;

    fn strip() -> Mesh {
        Mesh {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::new(2.0, 0.0, 0.0)],
            normals: vec![Vec3::Z; 4],
            faces: vec![[0, 1, 2], [1, 3, 2]],
            smooth: true,
            ..Mesh::default()
        }
    }

    /// An arm along +x of two bones: the second turns by 90 degrees about its joint at x = 1. By hand. A vertex that hangs on both by half is the
    /// mean of where each puts it, and its normal likewise.
    #[test]
    fn joints_take_vertices_along() {
        let mut influences = Influences::default();
        for pairs in [vec![(0, 1.0)], vec![(0, 2.0), (1, 2.0)], vec![], vec![(1, 0.25)]] {
            influences.push(pairs);
        }
        let still = Joint { node: None, bind: DAffine3::IDENTITY };
        let hand = Joint { node: Some(7), bind: DAffine3::IDENTITY };
        let arm = Deformation { base: Arc::new(strip()), joints: vec![still, hand], influences, ..Deformation::default() };
        assert_eq!(arm.check(), Ok(()));
        let about = DAffine3::from_translation(DVec3::X);
        // +x to -z: normals along +z turn to +x.
        let turn = about * DAffine3::from_rotation_y(std::f64::consts::FRAC_PI_2) * about.inverse();
        let deformed = arm.during(Moment::from(1.0), &|node| {
            assert_eq!(node, 7);
            turn
        });
        let expected = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::new(1.0, 0.0, -1.0)];
        for (found, expected) in deformed.positions.iter().zip(expected) {
            assert!((*found - expected).length() < 1e-6, "{found} {expected}");
        }
        let diagonal = Vec3::new(1.0, 0.0, 1.0).normalize();
        for (found, expected) in deformed.normals.iter().zip([Vec3::Z, diagonal, Vec3::Z, Vec3::X]) {
            assert!((*found - expected).length() < 1e-6, "{found} {expected}");
        }
        // The control: at rest nothing is deformed.
        assert_eq!(arm.at_rest().positions, strip().positions);
    }

    #[test]
    fn targets_count_by_their_weights() {
        let keys = vec![Key { frame: 0.0, value: 0.0 }, Key { frame: 10.0, value: 1.0 }];
        let target = MorphTarget {
            positions: vec![Vec3::Z; 4],
            normals: vec![Vec3::new(2.0, 0.0, 0.0); 4],
            rest: 0.25,
            weight: Curve { keys, interpolation: Interpolation::Linear },
        };
        let face = Deformation { base: Arc::new(strip()), targets: vec![target], ..Deformation::default() };
        assert_eq!(face.at_rest().positions[1], Vec3::new(1.0, 0.0, 0.25));
        let half = face.during(Moment::from(5.0), &|_| unreachable!());
        assert_eq!(half.positions[3], Vec3::new(2.0, 0.0, 0.5));
        assert!((half.normals[0] - Vec3::new(1.0, 0.0, 1.0).normalize()).length() < 1e-6);
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        let with = |pairs: Vec<(u32, f32)>, vertices: usize| {
            let mut influences = Influences::default();
            (0..vertices).for_each(|_| influences.push(pairs.clone()));
            let joints = vec![Joint { node: None, bind: DAffine3::IDENTITY }];
            Deformation { base: Arc::new(strip()), joints, influences, ..Deformation::default() }.check()
        };
        assert_eq!(with(vec![(0, 1.0)], 4), Ok(()));
        assert!(with(vec![(1, 1.0)], 4).is_err_and(|error| error.contains("joint 1")));
        assert!(with(vec![(0, f32::NAN)], 4).is_err_and(|error| error.contains("NaN")));
        assert!(with(vec![(0, 1.0)], 3).is_err_and(|error| error.contains("3 vertices")));
        let target = MorphTarget { positions: vec![Vec3::X; 3], ..MorphTarget::default() };
        let short = Deformation { base: Arc::new(strip()), targets: vec![target], ..Deformation::default() };
        assert!(short.check().is_err_and(|error| error.contains("target 0")));
    }
}
