//! The device's own acceleration structure, which kernels ask by ray queries.

use std::sync::atomic::{AtomicU64, Ordering};

use wgpu::util::DeviceExt;
use wgpu::{
    AccelerationStructureFlags, AccelerationStructureGeometryFlags, AccelerationStructureUpdateMode, BlasAabbGeometry,
    BlasGeometries, BlasGeometrySizeDescriptors, BlasTriangleGeometry, BufferUsages,
};

use super::device::Device;
use crate::packed::PackedScene;
use crate::packed::hierarchy::Traversal;
use crate::packed::primitive::Primitive;
use crate::packed::ray_query::ShapeBox;
use crate::plan::memory::ACCELERATION_BYTES;

/// Not moved.
const IN_PLACE: [f32; 12] = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0];
/// Distance between the vertices of a triangle: a primitive is three points, each with a fourth word.
const VERTEX_STRIDE: u64 = size_of::<Primitive>() as u64 / 3;

/// A structure over all that a scene's hierarchy holds: an instance of its triangles and one of the boxes of its other shapes, as far as
/// there are any. Their custom data is the first primitive of each.
pub struct Acceleration {
    structure: wgpu::Tlas,
    bytes: u64,
}

/// Structures built so far: each has a name of its own, under which its memory is found.
static BUILT: AtomicU64 = AtomicU64::new(0);

impl Acceleration {
    /// Has the device build it. None where the scene was packed with nodes.
    pub fn build(device: &Device, packed: &PackedScene) -> Option<Self> {
        if packed.hierarchy.traversal != Traversal::RayQuery {
            return None;
        }
        let boxes = &packed.hierarchy.boxes;
        let triangles = packed.hierarchy.primitive_count - boxes.len() as u32;
        let name = format!("acceleration structure {}", BUILT.fetch_add(1, Ordering::Relaxed));
        let parts = [
            (triangles > 0).then(|| BottomLevel::of_triangles(device, &name, &packed.primitives[..triangles as usize])),
            (!boxes.is_empty()).then(|| BottomLevel::of_boxes(device, &name, boxes, triangles)),
        ];
        let mut structure = device.device.create_tlas(&wgpu::CreateTlasDescriptor {
            label: Some(&name),
            max_instances: parts.len() as u32,
            flags: AccelerationStructureFlags::PREFER_FAST_TRACE,
            update_mode: AccelerationStructureUpdateMode::Build,
        });
        for (slot, part) in parts.iter().flatten().enumerate() {
            structure[slot] = Some(wgpu::TlasInstance::new(&part.blas, IN_PLACE, part.first_primitive, 0xff));
        }
        let entries: Vec<_> = parts.iter().flatten().map(BottomLevel::entry).collect();
        let mut encoder = device.device.create_command_encoder(&Default::default());
        encoder.build_acceleration_structures(&entries, [&structure]);
        // Whoever renders waits for it, and sees what went wrong.
        device.queue.submit([encoder.finish()]);
        let estimate = ACCELERATION_BYTES * u64::from(packed.hierarchy.primitive_count);
        Some(Self { structure, bytes: allocated(device, &name).unwrap_or(estimate) })
    }

    /// Bytes on the device; an estimate where the device does not tell.
    pub fn bytes(&self) -> u64 {
        self.bytes
    }

    /// The resource of a bind group.
    pub fn as_binding(&self) -> wgpu::BindingResource<'_> {
        self.structure.as_binding()
    }
}

/// Bytes that the device holds under a name. None where the interface does not tell.
fn allocated(device: &Device, name: &str) -> Option<u64> {
    let report = device.device.generate_allocator_report()?;
    Some(report.allocations.iter().filter(|allocation| allocation.name == name).map(|allocation| allocation.size).sum())
}

/// Primitives of one kind.
struct BottomLevel {
    blas: wgpu::Blas,
    input: wgpu::Buffer,
    size: Size,
    first_primitive: u32,
}

enum Size {
    Triangles(wgpu::BlasTriangleGeometrySizeDescriptor),
    Boxes(wgpu::BlasAABBGeometrySizeDescriptor),
}

impl BottomLevel {
    fn of_triangles(device: &Device, name: &str, primitives: &[Primitive]) -> Self {
        let size = wgpu::BlasTriangleGeometrySizeDescriptor {
            vertex_format: wgpu::VertexFormat::Float32x3,
            vertex_count: 3 * primitives.len() as u32,
            index_format: None,
            index_count: None,
            flags: AccelerationStructureGeometryFlags::OPAQUE,
        };
        Self::new(device, name, bytemuck::cast_slice(primitives), Size::Triangles(size), 0)
    }

    fn of_boxes(device: &Device, name: &str, boxes: &[ShapeBox], first_primitive: u32) -> Self {
        let size = wgpu::BlasAABBGeometrySizeDescriptor {
            primitive_count: boxes.len() as u32,
            flags: AccelerationStructureGeometryFlags::empty(),
        };
        Self::new(device, name, bytemuck::cast_slice(boxes), Size::Boxes(size), first_primitive)
    }

    fn new(device: &Device, name: &str, contents: &[u8], size: Size, first_primitive: u32) -> Self {
        let descriptor =
            wgpu::util::BufferInitDescriptor { label: Some("acceleration input"), contents, usage: BufferUsages::BLAS_INPUT };
        let input = device.device.create_buffer_init(&descriptor);
        let sizes = match &size {
            Size::Triangles(size) => BlasGeometrySizeDescriptors::Triangles { descriptors: vec![size.clone()] },
            Size::Boxes(size) => BlasGeometrySizeDescriptors::AABBs { descriptors: vec![size.clone()] },
        };
        let descriptor = wgpu::CreateBlasDescriptor {
            label: Some(name),
            flags: AccelerationStructureFlags::PREFER_FAST_TRACE,
            update_mode: AccelerationStructureUpdateMode::Build,
        };
        Self { blas: device.device.create_blas(&descriptor, sizes), input, size, first_primitive }
    }

    /// The entry that the device builds the structure from.
    fn entry(&self) -> wgpu::BlasBuildEntry<'_> {
        let geometry = match &self.size {
            Size::Triangles(size) => BlasGeometries::TriangleGeometries(vec![BlasTriangleGeometry {
                size,
                vertex_buffer: &self.input,
                first_vertex: 0,
                vertex_stride: VERTEX_STRIDE,
                index_buffer: None,
                first_index: None,
                transform_buffer: None,
                transform_buffer_offset: None,
            }]),
            Size::Boxes(size) => BlasGeometries::AabbGeometries(vec![BlasAabbGeometry {
                size,
                stride: size_of::<ShapeBox>() as u64,
                aabb_buffer: &self.input,
                primitive_offset: 0,
            }]),
        };
        wgpu::BlasBuildEntry { blas: &self.blas, geometry }
    }
}
