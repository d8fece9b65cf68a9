//! How the decisions of a plan are made.

use super::choices::{GeometryPlacement, MOST_STACK_REGISTERS, StageMode};
use super::error::PlanError;
use super::limits::DeviceLimits;
use super::memory::{self, Memory};
use super::model::Plan;
use super::options::PlanOptions;
use super::path_state::{self, WORKGROUP};
use super::{chunks, decisions, generated, ray_query, switches, unroll};
use crate::film::KernelLayer;
use crate::packed::PackedScene;
use crate::packed::hierarchy::Traversal;
use crate::scene::Scene;
use crate::shader::Switches;
use crate::shader::switches::contradiction;

/// A device that can bind fewer storage buffers to a stage than this may need them for chunks, a guide or cells of lights.
const MANY_STORAGE_BUFFERS: u32 = 16;

impl Plan {
    /// Decides.
    ///
    /// # Errors
    /// [`PlanError::DoesNotFit`] where an array is larger than the device can bind, naming both sizes. [`PlanError::Internal`] where
    /// the scene was packed with another hierarchy than the options say.
    pub fn new(scene: &Scene, packed: &PackedScene, limits: &DeviceLimits, options: &PlanOptions) -> Result<Self, PlanError> {
        let traversal = packed.hierarchy.traversal;
        if !options.allows(traversal, limits) {
            return Err(PlanError::Internal(format!("the scene was packed for another traversal: {}", traversal.key())));
        }
        let ray_queries = traversal == Traversal::RayQuery;
        if ray_queries {
            ray_query::check(packed, limits)?;
        }
        if options.trace && options.stages == Some(StageMode::Wavefront) {
            return Err(PlanError::Internal(
                "a path is written down by the kernel that traces whole paths, not by the wavefront".into(),
            ));
        }
        let (geometry, why_geometry) = decisions::geometry(packed, options);
        let light_samples = if switches::samples_lights(scene, packed) { scene.render.several_light_samples()[0] } else { 1 };
        let of_scene = switches::of_scene(scene, packed);
        let state_bytes = path_state::path_state_bytes(|switch| of_scene.enabled.contains(switch));
        let shadow_ray_words = path_state::shadow_ray_words(|switch| of_scene.enabled.contains(switch));
        let path_capacity = limits.paths_with_shadow_rays(state_bytes, u64::from(light_samples * shadow_ray_words) * 16);
        let needs = decisions::Needs { features: of_scene.enabled.len(), light_samples, path_capacity };
        let (stages, why_stages) = decisions::stages(geometry, needs, &scene.render, limits, options);
        // On software devices that load lane by lane, the lanes of a subgroup go through a hierarchy as one packet, whose nodes are loaded once and whose
        // stack lies in registers, an entry a lane (shaders/geometry/software/packet.wgsl). Where the device gathers, a lane on its own way that starts
        // its next path at once takes 0.65 to 0.97 of the time (docs/notes/2026-11-29-drivers.md). Geometry that is code is met by all lanes anyway.
        let packets = limits.software
            && !limits.gathers
            && stages == StageMode::Fused
            && geometry == GeometryPlacement::Hierarchy
            && !options.trace
            && !ray_queries;
        let lanes = limits.subgroup_size.filter(|lanes| {
            packets
                && (4..=64).contains(lanes)
                && lanes.is_power_of_two()
                && packed.hierarchy.stack_size <= MOST_STACK_REGISTERS * lanes
        });
        // Known practice on hardware, and on lavapipe no slower (docs/notes/2026-11-22-wavefront-queues.md).
        let subgroup_queues = stages == StageMode::Wavefront && limits.subgroups;
        let width = scene.film.size[0];
        let (film, why_film) = decisions::film(scene.film.size, limits, options)?;
        let tables = packed.tables().words;
        let uniform_limit = u64::from(limits.max_uniform_binding);
        // Software devices read uniform buffers faster than storage. Real GPUs serialise reads by lanes that differ (docs/performance.md).
        let fits_uniform = |bytes: usize| bytes as u64 <= uniform_limit.min(limits.max_array);
        let prefers_uniform = limits.software || limits.max_storage_buffers < MANY_STORAGE_BUFFERS;
        let uniform_primitives = prefers_uniform && fits_uniform(size_of_val(&packed.primitives[..]));
        let uniform_tables = prefers_uniform && 16 * tables.len() as u64 <= uniform_limit;
        let uniform_nodes = limits.software && !ray_queries && fits_uniform(packed.hierarchy.uniform_node_bytes());
        let most_rows = limits.band_rows(scene.film.size, film, options.pixel_list);
        let wanted_rows = options.most_film_pixels.map_or(u64::MAX, |pixels| (pixels / u64::from(scene.film.size[0])).max(1));
        let band_rows = most_rows.min(u32::try_from(wanted_rows).unwrap_or(u32::MAX));
        let mut plan = Self {
            geometry,
            traversal,
            uniform_primitives,
            uniform_tables,
            uniform_nodes,
            chunks: Vec::new(),
            stages,
            film,
            path_capacity,
            rays_per_invocation: if limits.software { 32 } else { 1 },
            lanes,
            subgroup_queues,
            light_samples,
            light_samples_depth: if light_samples > 1 { scene.render.light_samples_depth } else { 0 },
            pixel_takers: (limits.software && stages == StageMode::Fused && !options.trace).then_some(limits.threads.max(1)),
            pixels_per_dispatch: limits.max_workgroups.saturating_mul(WORKGROUP),
            band_rows,
            switches: Switches::default(),
            memory: Memory::default(),
            checked_shaders: options.checked_shaders,
            decisions: Vec::new(),
        };
        plan.chunks = chunks::cut(packed, !uniform_primitives, plan.has_nodes() && !uniform_nodes, limits.max_array);
        let in_cells = switches::chooses_lights_by_cells(scene, packed);
        let learned = [!packed.guide.is_empty(), in_cells];
        let other_arrays = u32::from(!uniform_tables) + learned.map(u32::from).iter().sum::<u32>();
        chunks::check(&plan.chunks, other_arrays, learned, limits.max_array, limits)?;
        plan.switches = switches::choose(of_scene, scene, packed, &plan);
        plan.switches.enable("TRACE", options.trace);
        plan.switches.enable("PIXEL_LIST", options.pixel_list && !options.trace);
        let makes_samples = matches!(options.layer, None | Some(KernelLayer::Squares));
        plan.switches.enable("CLAMP", scene.render.clamp > 0.0 && makes_samples);
        for switch in options.layer.map_or(&[][..], KernelLayer::switches) {
            plan.switches.enable(switch, true);
        }
        plan.switches.enable("OBJECT_MAPS", options.layer == Some(KernelLayer::ObjectPosition) && !packed.objects.is_empty());
        for switch in &options.compile_in {
            plan.switches.enable(switch, true);
        }
        if let Some(fault) = options.fault {
            fault.plant(packed, &mut plan.switches);
        }
        let shadow_ray_words = path_state::shadow_ray_words(|switch| plan.switches.enabled.contains(switch));
        plan.switches.constants.insert("SHADOW_RAY_WORDS", shadow_ray_words);
        let planes = path_state::plane_constants(|switch| plan.switches.enabled.contains(switch), path_capacity);
        plan.switches.constants.extend(planes);
        let first_constant = match geometry {
            GeometryPlacement::Unrolled => 0,
            GeometryPlacement::Hierarchy => packed.hierarchy.primitive_count as usize,
        };
        plan.switches.generated.extend(generated::files());
        plan.switches.generated.insert(
            "geometry/constants.wgsl",
            unroll::constants(packed, first_constant, switches::shadows_are_transparent(scene, packed)),
        );
        for array in plan.chunks.iter().filter(|array| !array.is_whole()) {
            plan.switches.enable(array.array.switch, true);
            plan.switches.generated.insert(array.array.file, array.wgsl());
        }
        if let Some(contradiction) = contradiction(&plan.switches.enabled) {
            return Err(PlanError::Internal(format!("the plan turns on switches that do not go together: {contradiction}")));
        }
        plan.memory = count_memory(packed, &plan, width);
        plan.memory.check(limits)?;
        let reasons = decisions::Reasons { geometry: why_geometry, stages: why_stages, film: why_film };
        plan.decisions = decisions::explain(&plan, scene, packed, limits, reasons);
        Ok(plan)
    }
}

/// The arrays of a plan, and their sizes, for films of this width.
fn count_memory(packed: &PackedScene, plan: &Plan, width: u32) -> Memory {
    let tables = packed.tables().words;
    let pixels = u64::from(width) * u64::from(plan.band_rows);
    let mut arrays = vec![
        (memory::PRIMITIVES, memory::PRIMITIVE_BYTES * packed.primitives.len() as u64),
        (memory::TABLES, 16 * tables.len() as u64),
        (memory::FILM_SUM, pixels * memory::FILM_BYTES / 2),
        (memory::FILM_COMPENSATION, pixels * memory::FILM_BYTES / 2),
    ];
    if plan.switches.enabled.contains("RAY_QUERY") {
        arrays.push((memory::ESTIMATED_ACCELERATION, memory::ACCELERATION_BYTES * u64::from(packed.hierarchy.primitive_count)));
    }
    if plan.has_nodes() {
        let nodes = &packed.hierarchy;
        let bytes = if plan.uniform_nodes { nodes.uniform_node_bytes() } else { size_of_val(&nodes.nodes[..]) };
        arrays.push((memory::NODES, bytes as u64));
    }
    if packed.has_attributes() {
        arrays.push((memory::ATTRIBUTES, memory::ATTRIBUTE_BYTES * packed.attributes.len() as u64));
    }
    if !packed.instances.is_empty() {
        arrays.push((memory::INSTANCES, size_of_val(&packed.instances[..]) as u64));
    }
    if !packed.guide.is_empty() {
        arrays.push((memory::GUIDE, size_of_val(&packed.guide[..]) as u64));
    }
    if plan.switches.enabled.contains("LIGHT_CELLS") {
        arrays.push((memory::LIGHT_CELLS, size_of_val(&packed.light_cells[..]) as u64));
    }
    if packed.textures.texel_words() > 0 {
        arrays.push((memory::TEXELS, packed.textures.texel_bytes()));
    }
    if plan.switches.enabled.contains("PIXEL_LIST") {
        arrays.push(("pixels", pixels * memory::LIST_BYTES));
    }
    if plan.stages == StageMode::Wavefront {
        let paths = u64::from(plan.path_capacity);
        arrays.push(("path state", paths * plan.path_state_bytes()));
        arrays.push(("queues", paths * memory::QUEUE_BYTES));
        if plan.samples_lights() {
            arrays.push(("shadow rays", paths * plan.shadow_ray_bytes()));
        }
    }
    Memory { arrays }
}
