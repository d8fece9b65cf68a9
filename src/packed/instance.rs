//! Instances of groups of meshes: records of their own, which leaves of the hierarchy name, and what they need of it.

use glam::{DAffine3, DMat3, DVec3, Vec3};

use super::bvh4::{Child, Node};
use super::constants::NONE;
use super::grid::Box3;
use super::motion::PackedMotion;
use super::primitive::{KIND_INSTANCE, Primitive, WorldPrimitive};
use crate::math::outward;
use crate::scene::{MaterialId, ReceiverId};
use crate::shader::shared::shared_constants;

/// Share of the largest coordinate by which boxes grow for the rounding of the way to a group's space and back in single precision.
const ROUNDING: f64 = 4e-6;

shared_constants!(constants {
    /// Words of an instance's record.
    pub const INSTANCE_RECORD_WORDS: u32 = (size_of::<PackedInstance>() / 16) as u32;
    /// Flag beside the root of an instance that turns left hands into right hands.
    pub(super) const INSTANCE_IS_MIRRORED: u32 = 1 << 31;
});

/// The meshes of a group, in its own space.
#[derive(Debug, Clone, Default)]
pub struct WorldGroup {
    pub primitives: Vec<WorldPrimitive>,
}

/// A group in one place, before packing.
#[derive(Debug, Clone, Copy)]
pub struct WorldInstance {
    pub group: usize,
    pub map: DAffine3,
    /// Material of all primitives; a number of the scene, in the end of the packed materials. None: the
    /// group's own.
    pub material: Option<MaterialId>,
    /// Index of its motion, or NONE, and the first word of it.
    pub motion: u32,
    pub motion_word: u32,
    /// The group of receivers that it belongs to.
    pub receiver: ReceiverId,
}

/// 96 bytes. A point p of the group is at forward · p + place, and, where it moves, goes on from there about the place.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct PackedInstance {
    /// First row of the inverse of the linear part.
    pub inverse_0: [f32; 3],
    /// Root of the group's tree; bit 31: mirrored.
    pub root_and_flags: u32,
    pub inverse_1: [f32; 3],
    /// In place of the group's own materials, or NONE.
    pub material: u32,
    pub inverse_2: [f32; 3],
    /// First word of its motion, or NONE.
    pub motion: u32,
    /// Rows of the linear part, each with a coordinate of the place.
    pub forward: [[f32; 4]; 3],
}

impl WorldInstance {
    pub fn pack(&self, root: u32) -> PackedInstance {
        let DAffine3 { matrix3: forward, translation: place } = self.map;
        let inverse = forward.inverse();
        let mirrored = if forward.determinant() < 0.0 { INSTANCE_IS_MIRRORED } else { 0 };
        let inverse_row = |row: usize| inverse.row(row).as_vec3().to_array();
        PackedInstance {
            inverse_0: inverse_row(0),
            root_and_flags: root | mirrored,
            inverse_1: inverse_row(1),
            material: self.material.map_or(NONE, |material| material as u32),
            inverse_2: inverse_row(2),
            motion: self.motion_word,
            forward: [0, 1, 2].map(|row| forward.row(row).as_vec3().extend(place[row] as f32).to_array()),
        }
    }

    /// Bounds of a group inside these boxes, while the shutter is open.
    pub fn bounds(&self, boxes: &[Box3], motions: &[PackedMotion]) -> (Vec3, Vec3) {
        let place = self.map.translation;
        let (low, high) = match motions.get(self.motion as usize) {
            None => {
                let [low, high] = around(boxes, self.map.matrix3);
                (low, high)
            }
            Some(motion) => motion.swept_by(around(boxes, self.map.matrix3), &|map: &DAffine3| {
                let [low, high] = around(boxes, map.matrix3 * self.map.matrix3);
                [low + map.translation, high + map.translation]
            }),
        };
        let margin = ROUNDING * (place.abs() + self.spread(boxes));
        outward(place + low - margin, place + high + margin)
    }

    /// A bound on coordinates on the way from the world to the group's space and back.
    fn spread(&self, boxes: &[Box3]) -> DVec3 {
        let absolute = |m: DMat3| DMat3::from_cols(m.x_axis.abs(), m.y_axis.abs(), m.z_axis.abs());
        let farthest = boxes.iter().map(|of| of.low.abs().max(of.high.abs())).fold(Vec3::ZERO, Vec3::max).as_dvec3();
        let (forward, back) = (absolute(self.map.matrix3), absolute(self.map.matrix3.inverse()));
        let there = forward * farthest;
        there + forward * (back * there)
    }
}

/// Bounds of boxes that a linear map has turned.
fn around(boxes: &[Box3], linear: DMat3) -> [DVec3; 2] {
    let absolute = DMat3::from_cols(linear.x_axis.abs(), linear.y_axis.abs(), linear.z_axis.abs());
    boxes.iter().fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[low, high], of| {
        let (least, most) = (of.low.as_dvec3(), of.high.as_dvec3());
        let (center, half) = (linear * (0.5 * (least + most)), absolute * (0.5 * (most - least)));
        [low.min(center - half), high.max(center + half)]
    })
}

/// The boxes of the children of a tree's root, and in place of inner ones those of their children: they fit a turned group better than its own
/// box does.
pub fn upper_boxes(nodes: &[Node], root: usize) -> Vec<Box3> {
    let node = &nodes[root];
    let of_child = |(child, own): (Child, Box3)| match child {
        Child::Inner(inner) => nodes[inner].boxes(),
        Child::Leaf { .. } => vec![own],
    };
    node.children().into_iter().zip(node.boxes()).flat_map(of_child).collect()
}

/// The record that stands in a leaf for an instance.
pub fn leaf_record(instance: u32) -> Primitive {
    Primitive {
        p0: [0.0; 3],
        kind_and_material: KIND_INSTANCE << 28 | instance,
        p1: [0.0; 3],
        light: NONE,
        p2: [0.0; 3],
        attributes: NONE,
    }
}

impl PackedInstance {
    pub fn root(&self) -> u32 {
        self.root_and_flags & !INSTANCE_IS_MIRRORED
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::hash::mix;

    /// Corners of the boxes, turned by any map, are inside the bounds, which are not much larger.
    #[test]
    fn bounds_hold_turned_boxes() {
        let boxes = [
            Box3 { low: Vec3::new(-1.0, 0.0, 2.0), high: Vec3::new(0.5, 3.0, 2.5) },
            Box3 { low: Vec3::ONE, high: Vec3::splat(2.0) },
        ];
        let mut seed = 1;
        let mut draw = || {
            seed = mix(seed + 1);
            f64::from(seed) / 2_147_483_648.0 - 1.0
        };
        for _ in 0..200 {
            let columns = [0; 3].map(|_| DVec3::new(draw(), draw(), draw()));
            let matrix3 = DMat3::from_cols(columns[0], columns[1], columns[2]);
            if matrix3.determinant().abs() < 0.05 {
                continue;
            }
            let map = DAffine3 { matrix3, translation: DVec3::new(draw(), draw(), draw()) * 1e3 };
            let instance = WorldInstance { group: 0, map, material: None, motion: NONE, motion_word: NONE, receiver: 0 };
            let (low, high) = instance.bounds(&boxes, &[]);
            let corners = boxes.iter().flat_map(|of| {
                (0..8).map(move |corner| {
                    let pick = |axis: usize| if corner >> axis & 1 == 0 { of.low[axis] } else { of.high[axis] };
                    map.transform_point3(DVec3::new(pick(0).into(), pick(1).into(), pick(2).into()))
                })
            });
            let (mut least, mut most) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
            for corner in corners {
                least = least.min(corner);
                most = most.max(corner);
            }
            assert!(low.as_dvec3().cmplt(least).all() && high.as_dvec3().cmpgt(most).all(), "{low} {least} {most} {high}");
            assert!((least - low.as_dvec3()).max_element() < 0.02 && (high.as_dvec3() - most).max_element() < 0.02);
        }
    }
}
