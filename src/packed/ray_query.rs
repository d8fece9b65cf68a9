//! The order of primitives, and the boxes, from which a device builds an acceleration structure of its own.
//!
//! Triangles stand first: the device tests those itself. Of every other shape it knows the box; what is in it, kernels test.

use glam::Vec3;

use super::primitive::WorldPrimitive;
use super::shape::PrimitiveKind;

/// By how much of its size and place a box grows on every side, beyond what rounding of the shape asks for: devices intersect boxes with
/// arithmetic of their own.
const MARGIN: f32 = 1e-6;

/// The box around a shape that is no triangle, as devices read it.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct ShapeBox {
    pub low: [f32; 3],
    pub high: [f32; 3],
}

impl ShapeBox {
    fn around((low, high): (Vec3, Vec3)) -> Self {
        let margin = (high - low + low.abs().max(high.abs())) * MARGIN;
        Self { low: (low - margin).to_array(), high: (high + margin).to_array() }
    }
}

/// The boxes of those of the primitives `inside` that are no triangles, and the order of all of them, as places in `inside`: triangles first.
pub fn build(primitives: &[WorldPrimitive], inside: &[usize]) -> (Vec<ShapeBox>, Vec<usize>) {
    let is_triangle = |place: &usize| primitives[inside[*place]].kind() == PrimitiveKind::Triangle;
    let (triangles, shapes): (Vec<usize>, Vec<usize>) = (0..inside.len()).partition(is_triangle);
    // Planes, which alone have no bounds, are never inside.
    let boxes = shapes.iter().filter_map(|&place| primitives[inside[place]].bounds()).map(ShapeBox::around).collect();
    (boxes, triangles.into_iter().chain(shapes).collect())
}
