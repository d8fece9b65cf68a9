//! Every buffer and texture of a render, by binding number.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::ops::Range;

use wgpu::BufferUsages;
use wgpu::util::DeviceExt;

use super::acceleration::Acceleration;
use super::device::Device;
use super::film_memory::Film;
use crate::packed::PackedScene;
use crate::packed::texture::PackedTextures;
use crate::plan::bindings::Binding;
use crate::plan::chunks::{ATTRIBUTES, INSTANCES, NODES, PRIMITIVES, TEXELS};
use crate::plan::counters::{COUNTER_WORDS, TAKEN_COUNTER};
use crate::plan::parameters::{PassParameters, VertexParameters};
use crate::plan::path_state::{COUNTS, DISPATCH_SIZE_WORDS};
use crate::plan::trace_record::TRACE_BYTES;
use crate::plan::{MAX_SAMPLES_PER_PASS, Plan, StageMode, memory};

/// Vertices that one submission can hold; longer paths take further submissions.
pub const VERTICES_PER_SUBMISSION: u32 = 32;
/// Bytes of the statistics; the list of a band's pixels follows them.
pub const STATISTICS_BYTES: u64 = 4 * COUNTER_WORDS as u64;
/// Offset in the statistics, in bytes, of the number of a pass's pixels that were taken.
pub const TAKEN_PIXELS: u64 = 4 * TAKEN_COUNTER as u64;
/// Distance between the parameters of successive vertices: the largest alignment a device may ask for.
const VERTEX_STRIDE: usize = 256;

/// All device memory of a render.
pub struct Buffers {
    buffers: BTreeMap<u32, wgpu::Buffer>,
    pub film: Film,
    acceleration: Option<Acceleration>,
    pub bytes: u64,
}

impl Buffers {
    /// Uploads the scene and makes room for the paths and the film of one band.
    pub fn new(device: &Device, packed: &PackedScene, plan: &Plan, width: u32) -> Self {
        let mut buffers = BTreeMap::new();
        let usage = |uniform| if uniform { BufferUsages::UNIFORM } else { BufferUsages::STORAGE };
        let tables = packed.tables().words;
        let mut upload = |number, label, bytes: &[u8], usage| {
            // A binding may not be empty.
            let contents = if bytes.is_empty() { &[0; 48] } else { bytes };
            let descriptor = wgpu::util::BufferInitDescriptor { label: Some(label), contents, usage };
            buffers.insert(number, device.device.create_buffer_init(&descriptor));
        };
        upload(Binding::Tables as u32, "tables", bytemuck::cast_slice(&tables), usage(plan.uniform_tables));
        upload(Binding::View as u32, "view", bytemuck::bytes_of(&packed.view), BufferUsages::UNIFORM | BufferUsages::COPY_DST);
        upload(Binding::Vertex as u32, "vertices", &vertex_parameters(1), BufferUsages::UNIFORM | BufferUsages::COPY_DST);
        let compiled = |switch: &str| plan.switches.enabled.contains(switch);
        let mut nodes: Cow<'_, [u8]> = Cow::Borrowed(bytemuck::cast_slice(&packed.hierarchy.nodes));
        if plan.uniform_nodes {
            nodes.to_mut().resize(packed.hierarchy.uniform_node_bytes(), 0);
        }
        let arrays: [(_, &[u8], _, _); 4] = [
            (PRIMITIVES, bytemuck::cast_slice(&packed.primitives), usage(plan.uniform_primitives), true),
            (NODES, &nodes, usage(plan.uniform_nodes), compiled("BVH")),
            (ATTRIBUTES, bytemuck::cast_slice(&packed.attributes), BufferUsages::STORAGE, compiled("ATTRIBUTES")),
            (INSTANCES, bytemuck::cast_slice(&packed.instances), BufferUsages::STORAGE, compiled("INSTANCES")),
        ];
        for (array, bytes, usage, _) in arrays.into_iter().filter(|(.., is_read)| *is_read) {
            match plan.chunks.iter().find(|chunks| chunks.array == array) {
                Some(chunks) => chunks.bindings().for_each(|(number, range)| upload(number, array.name, &bytes[range], usage)),
                None => upload(array.binding, array.name, bytes, usage),
            }
        }
        if compiled("GUIDE") {
            upload(Binding::Guide as u32, memory::GUIDE, bytemuck::cast_slice(&packed.guide), BufferUsages::STORAGE);
        }
        if compiled("LIGHT_CELLS") {
            let words = bytemuck::cast_slice(&packed.light_cells);
            upload(Binding::LightCells as u32, memory::LIGHT_CELLS, words, BufferUsages::STORAGE);
        }
        if let Some(chunks) = plan.chunks.iter().find(|chunks| chunks.array == TEXELS) {
            for (number, range) in chunks.bindings() {
                buffers.insert(number, upload_texels(device, &packed.textures, range));
            }
        }

        let mut make = |number, label, size: u64, usage| {
            let descriptor = wgpu::BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false };
            buffers.insert(number, device.device.create_buffer(&descriptor));
        };
        let uniform = BufferUsages::UNIFORM | BufferUsages::COPY_DST;
        make(Binding::Pass as u32, "pass", size_of::<PassParameters>() as u64, uniform);
        make(Binding::Sequence as u32, "sequence points", 16 * u64::from(plan.sequence_stride() * MAX_SAMPLES_PER_PASS), uniform);
        let storage = BufferUsages::STORAGE;
        let listed = if plan.switches.enabled.contains("PIXEL_LIST") { width * plan.band_rows } else { 0 };
        let statistics = STATISTICS_BYTES + u64::from(listed) * memory::LIST_BYTES;
        make(Binding::Statistics as u32, "statistics", statistics, storage | BufferUsages::COPY_SRC | BufferUsages::COPY_DST);
        if plan.switches.enabled.contains("TRACE") {
            make(Binding::Trace as u32, "trace", TRACE_BYTES, storage | BufferUsages::COPY_SRC | BufferUsages::COPY_DST);
        }
        if plan.stages == StageMode::Wavefront {
            let paths = u64::from(plan.path_capacity);
            make(Binding::PathState as u32, "path state", paths * plan.path_state_bytes(), storage);
            make(Binding::Queues as u32, "queues", paths * memory::QUEUE_BYTES, storage);
            make(
                Binding::Counts as u32,
                "counts",
                4 * u64::from(COUNTS),
                storage | BufferUsages::COPY_DST | BufferUsages::COPY_SRC,
            );
            make(
                Binding::DispatchSizes as u32,
                "dispatch sizes",
                4 * u64::from(DISPATCH_SIZE_WORDS),
                storage | BufferUsages::INDIRECT,
            );
            if plan.samples_lights() {
                make(Binding::ShadowRays as u32, "shadow rays", paths * plan.shadow_ray_bytes(), storage);
            }
        }
        let acceleration = if compiled("RAY_QUERY") { Acceleration::build(device, packed) } else { None };
        let film_bytes = u64::from(width) * u64::from(plan.band_rows) * memory::FILM_BYTES;
        let bytes = buffers.values().map(wgpu::Buffer::size).sum::<u64>()
            + film_bytes
            + acceleration.as_ref().map_or(0, Acceleration::bytes);
        Self { buffers, film: Film::new(device, plan, width), acceleration, bytes }
    }

    /// The buffer of a binding; None for what this plan does not have.
    pub fn buffer(&self, binding: Binding) -> Option<&wgpu::Buffer> {
        self.buffers.get(&(binding as u32))
    }

    /// The resource of a bind group for binding `number`.
    pub fn resource(&self, number: u32) -> Option<wgpu::BindingResource<'_>> {
        if let Some(half) = number.checked_sub(Binding::FilmSum as u32).filter(|half| *half < 2) {
            return self.film.resource(half as usize);
        }
        if number == Binding::Acceleration as u32 {
            return Some(self.acceleration.as_ref()?.as_binding());
        }
        let buffer = self.buffers.get(&number)?;
        if number == Binding::Vertex as u32 {
            let size = wgpu::BufferSize::new(size_of::<VertexParameters>() as u64);
            return Some(wgpu::BindingResource::Buffer(wgpu::BufferBinding { buffer, offset: 0, size }));
        }
        Some(buffer.as_entire_binding())
    }
}

/// Dynamic offset of the parameters of the submission's vertex number `index`, from 0.
pub fn vertex_offset(index: u32) -> u32 {
    index * VERTEX_STRIDE as u32
}

/// Parameters of a submission's vertices, the first of which is `first_vertex`.
pub fn vertex_parameters(first_vertex: u32) -> Vec<u8> {
    let mut bytes = vec![0; VERTEX_STRIDE * VERTICES_PER_SUBMISSION as usize];
    for (index, slot) in bytes.chunks_mut(VERTEX_STRIDE).enumerate() {
        let vertex = first_vertex + index as u32;
        let parameters = VertexParameters { vertex, queue: (vertex - 1) % 2, padding: [0; 2] };
        slot[..size_of::<VertexParameters>()].copy_from_slice(bytemuck::bytes_of(&parameters));
    }
    bytes
}

/// A run of the texels' bytes, copied from where each image has them.
fn upload_texels(device: &Device, textures: &PackedTextures, range: Range<usize>) -> wgpu::Buffer {
    let buffer = device.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("texels"),
        size: range.len() as u64,
        usage: BufferUsages::STORAGE,
        mapped_at_creation: true,
    });
    // A device that is lost by now has nothing to copy to, and the next call reports it.
    if let Ok(mut mapped) = buffer.get_mapped_range_mut(..) {
        let mut first = 0;
        for piece in textures.pieces(range) {
            mapped.slice(first..first + piece.len()).copy_from_slice(piece);
            first += piece.len();
        }
    }
    buffer.unmap();
    buffer
}
