//! Morph targets and skins: what bends a primitive, at rest and at frames.

use glam::{DAffine3, DMat4, Vec3};
use serde_json::{Map, Value};

use super::importer::Importer;
use super::json::Primitive;
use super::made::{Bending, MovingNodes, Skinning, WeightTrack};
use super::primitive::accessor;
use crate::load::deformation_file::DeformationRows;
use crate::load::file::keyframes::InterpolationName;
use crate::load::file::place_rows;
use crate::load::file::reference::FileOr;
use crate::load::file::shape::deformation::{DeformationEntry, JointEntry, WeightKeyEntry};
use crate::load::file::value::{Exactly, Number};
use crate::load::place::Place;
use crate::scene::Mesh;
use crate::scene::animation::{Deformation, Influences, Joint, MorphTarget};

impl Importer<'_> {
    /// The skin that moves the vertices of a mesh into the world.
    pub fn skinning(&self, skin: usize, world: &[Option<DAffine3>], moving: &MovingNodes) -> Result<Skinning, String> {
        let found = self.root.skins.get(skin).ok_or_else(|| format!("there is no skins[{skin}]"))?;
        let of_skin = |message: String| format!("skins[{skin}]: {message}");
        let inverse = match found.inverse_bind_matrices {
            Some(accessor) => Some(self.buffers.numbers(accessor, &["MAT4"]).map_err(of_skin)?.0),
            None => None,
        };
        let given = inverse.as_ref().map_or(found.joints.len(), |inverse| inverse.len() / 16);
        if given < found.joints.len() {
            return Err(of_skin(format!("it has {given} inverse bind matrices for {} joints", found.joints.len())));
        }
        let joint = |(place, &joint): (usize, &usize)| {
            let world = world.get(joint).copied().flatten();
            let world = world.ok_or_else(|| of_skin(format!("its joint {joint} is not part of the scene")))?;
            let numbers = inverse.as_ref().and_then(|inverse| inverse.get(16 * place..16 * place + 16));
            let bind = numbers.map_or(DMat4::IDENTITY, |numbers| {
                let numbers: [f64; 16] = std::array::from_fn(|at| numbers[at].into());
                DMat4::from_cols_array(&numbers)
            });
            let map = world * DAffine3::from_mat4(bind);
            if map.is_finite() { Ok(map) } else { Err(of_skin(format!("joint {joint} leaves the range of numbers"))) }
        };
        let maps = found.joints.iter().enumerate().map(joint).collect::<Result<_, String>>()?;
        Ok(Skinning { maps, nodes: found.joints.iter().map(|joint| moving.get(joint).cloned()).collect() })
    }

    /// Deformation of a primitive whose mesh is `base` before that. Nodes of joints are counted as those of
    /// the skin are.
    pub fn deformation(
        &self,
        primitive: &Primitive,
        base: Mesh,
        weights: &[f64],
        bending: Bending,
    ) -> Result<Deformation, String> {
        let mut deformation = Deformation::default();
        for (index, target) in primitive.targets.iter().enumerate() {
            let rest = weights.get(index).copied().unwrap_or(0.0);
            // Targets whose weight is always 0 need not be read, but must exist.
            let is_used = rest != 0.0 || bending.track.is_some();
            let list = |name: &str| -> Result<Vec<Vec3>, String> {
                let offsets = self.triples(target, name).map_err(|message| format!("targets[{index}]: {message}"))?;
                let offsets = offsets.unwrap_or_default();
                if !offsets.is_empty() && offsets.len() != base.positions.len() {
                    let message = format!("{} {name} for {} vertices", offsets.len(), base.positions.len());
                    return Err(format!("targets[{index}] has {message}"));
                }
                Ok(if is_used { offsets } else { Vec::new() })
            };
            let normals = if base.normals.is_empty() { Vec::new() } else { list("NORMAL")? };
            deformation.targets.push(MorphTarget { positions: list("POSITION")?, normals, rest, ..MorphTarget::default() });
        }
        if let Some(skinning) = bending.skinning {
            deformation.influences = self.influences(&primitive.attributes, base.positions.len())?;
            let joints = skinning.maps.iter().zip(&skinning.nodes).enumerate();
            deformation.joints =
                joints.map(|(index, (&bind, node))| Joint { node: node.is_some().then_some(index), bind }).collect();
        }
        deformation.base = base.into();
        deformation.check()?;
        Ok(deformation)
    }

    /// All sets of joints and weights.
    fn influences(&self, attributes: &Map<String, Value>, count: usize) -> Result<Influences, String> {
        let mut sums: Vec<Vec<(u32, f32)>> = vec![Vec::new(); count];
        for set in 0.. {
            let (joint, weight) = (format!("JOINTS_{set}"), format!("WEIGHTS_{set}"));
            let (joints, weights) = match (accessor(attributes, &joint)?, accessor(attributes, &weight)?) {
                (Some(joints), Some(weights)) => (joints, weights),
                (None, None) => break,
                (Some(_), None) => return Err(format!("it has {joint} and no {weight}")),
                (None, Some(_)) => return Err(format!("it has {weight} and no {joint}")),
            };
            let (joints, weights) = (self.buffers.numbers(joints, &["VEC4"])?.0, self.buffers.numbers(weights, &["VEC4"])?.0);
            for (name, numbers) in [(joint, &joints), (weight, &weights)] {
                if numbers.len() != 4 * count {
                    return Err(format!("there are {} {name} for {count} positions", numbers.len() / 4));
                }
            }
            let pairs = joints.as_chunks::<4>().0.iter().zip(weights.as_chunks::<4>().0);
            for (sum, (joints, weights)) in sums.iter_mut().zip(pairs) {
                let used = joints.iter().zip(weights).filter(|(_, weight)| **weight != 0.0);
                sum.extend(used.map(|(joint, weight)| (*joint as u32, *weight)));
            }
        }
        let mut influences = Influences::default();
        sums.into_iter().for_each(|pairs| influences.push(pairs));
        Ok(influences)
    }

    /// The keys of what deforms a mesh at frames.
    pub fn deformation_entry(
        &self,
        deformation: &Deformation,
        bending: Bending,
        place: &Place,
    ) -> Result<DeformationEntry, String> {
        let numbers = |numbers: &mut dyn Iterator<Item = f64>| numbers.map(Number::of).collect::<Result<Vec<_>, _>>();
        let joint = |(map, node): (&DAffine3, &Option<String>)| {
            let matrix = Some(place.at(Exactly::of(place_rows(map))?));
            Ok(JointEntry { node: node.clone().map(|name| place.at(name)), matrix })
        };
        let joints = |skinning: &Skinning| {
            let joints = skinning.maps.iter().zip(&skinning.nodes).map(joint);
            joints.collect::<Result<Vec<_>, String>>().map(|joints| place.at(joints))
        };
        let count = deformation.targets.len();
        let keyframe = |(time, values): &(f64, Vec<f64>)| {
            let weights = numbers(&mut values.iter().copied().chain(std::iter::repeat(0.0)).take(count))?;
            Ok(place.at(WeightKeyEntry { frame: None, time: Some(Number::of(*time)?), weights }))
        };
        let keyframes = |track: &WeightTrack| {
            track.keys.iter().map(keyframe).collect::<Result<Vec<_>, String>>().map(|keyframes| place.at(keyframes))
        };
        let rest = (count > 0).then(|| numbers(&mut deformation.targets.iter().map(|target| target.rest))).transpose()?;
        Ok(DeformationEntry {
            file: place.at(FileOr::InMemory(DeformationRows::of(deformation).into())),
            joints: bending.skinning.map(joints).transpose()?,
            weights: rest.map(|weights| place.at(weights)),
            keyframes: bending.track.map(keyframes).transpose()?,
            interpolation: bending.track.filter(|track| track.is_step).map(|_| place.at(InterpolationName::Step)),
        })
    }
}
