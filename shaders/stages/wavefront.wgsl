// State of the paths in flight, and the queues that say which of them still live and which have shadow rays.
#import core/layout.wgsl
#import core/math.wgsl
#import core/parameters.wgsl
#import shading/path/path.wgsl
#import geometry/motion.wgsl

// Planes of PATH_CAPACITY vec4 each, by the table in src/plan/path_state.rs, which says what they hold.
@group(0) @binding(BINDING_PATH_STATE) var<storage, read_write> path_state: array<vec4<f32>>;
// The queue of paths with shadow rays: for each of LIGHT_SAMPLES rays, planes of PATH_CAPACITY vec4: origin and distance; direction and
// path slot; radiance and, where paths have several and of the first, how many the path has; with OPEN_BOUNDARIES, the media around the origin.
@group(0) @binding(BINDING_SHADOW_RAYS) var<storage, read_write> shadow_rays: array<vec4<f32>>;
// Two queues of PATH_CAPACITY path slots: one is read while the other is filled.
@group(0) @binding(BINDING_QUEUES) var<storage, read_write> queues: array<u32>;
// Paths in queue 0 and 1; paths with shadow rays of vertices that read queue 0 and 1; where paths have several, all shadow rays of a vertex.
@group(0) @binding(BINDING_COUNTS) var<storage, read_write> counts: array<atomic<u32>, COUNTS>;

const SHADOW_ORIGIN: u32 = 0u;
const SHADOW_DIRECTION: u32 = PATH_CAPACITY;
const SHADOW_RADIANCE: u32 = 2u * PATH_CAPACITY;
const SHADOW_MEDIA: u32 = 3u * PATH_CAPACITY;
const SHADOW_PLANES: u32 = SHADOW_RAY_WORDS * PATH_CAPACITY;

const_assert SHADOW_RADIANCE + PATH_CAPACITY <= SHADOW_PLANES;

fn load_ray(slot: u32) -> Ray {
    return Ray(path_state[PLANE_ORIGIN + slot].xyz, path_state[PLANE_DIRECTION + slot].xyz);
}

// To be called before anything is asked of the scene for the path in a slot.
fn set_path_time_of(slot: u32) {
    let identity = bitcast<u32>(path_state[PLANE_ORIGIN + slot].w);
    set_path_time(pass_parameters.first_pixel + (identity & 0x00ffffffu), identity >> 24u);
}

fn load_path(slot: u32) -> Path {
    let origin = path_state[PLANE_ORIGIN + slot];
    let direction = path_state[PLANE_DIRECTION + slot];
    let throughput = path_state[PLANE_THROUGHPUT + slot];
    let identity = bitcast<u32>(origin.w);
    var path: Path;
    path.ray = Ray(origin.xyz, direction.xyz);
    path.throughput = throughput.xyz;
    path.pdf_solid_angle = direction.w;
    path.roulette_scale = throughput.w;
    path.pixel = pass_parameters.first_pixel + (identity & 0x00ffffffu);
    path.sample_in_pass = identity >> 24u;
    if HAS_NULL_SURFACES || HAS_LIGHT_CELLS {
        let vertices_and_facing = bitcast<u32>(path_state[PLANE_RADIANCE + slot].w);
        path.null_vertices = vertices_and_facing & 0x0fffffffu;
        path.reference_facing = vertices_and_facing >> 28u;
    }
#if LIGHT_LINKS
    let vertices_and_receiver = bitcast<u32>(path_state[PLANE_RADIANCE + slot].w);
    path.null_vertices = vertices_and_receiver & 0x003fffffu;
    path.receiver = (vertices_and_receiver >> 22u) & 63u;
#endif
    if HAS_TRANSPARENT_SHADOWS {
        path.reference_point = path_state[PLANE_REFERENCE_POINT + slot].xyz;
    }
    if HAS_MEDIA {
        let around = path_state[PLANE_MEDIA + slot];
        path.media = bitcast<vec2<u32>>(around.xy);
        path.way_before = around.z;
    }
    return path;
}

// Writes all but the radiance, the null vertices, the facing, the receiver and the hit.
fn store_path(slot: u32, path: Path) {
    let identity = (path.pixel - pass_parameters.first_pixel) | (path.sample_in_pass << 24u);
    path_state[PLANE_ORIGIN + slot] = vec4<f32>(path.ray.origin, bitcast<f32>(identity));
    path_state[PLANE_DIRECTION + slot] = vec4<f32>(path.ray.direction, path.pdf_solid_angle);
    path_state[PLANE_THROUGHPUT + slot] = vec4<f32>(path.throughput, path.roulette_scale);
    if HAS_TRANSPARENT_SHADOWS {
        path_state[PLANE_REFERENCE_POINT + slot] = vec4<f32>(path.reference_point, 0.0);
    }
    if HAS_MEDIA {
        path_state[PLANE_MEDIA + slot] = vec4<f32>(bitcast<vec2<f32>>(path.media), path.way_before, 0.0);
    }
}

fn store_hit(slot: u32, hit: Hit) {
#if INSTANCES
    let in_instance = hit.instance != NONE;
    let distance_or_instance = select(bitcast<u32>(hit.t), hit.instance, in_instance);
    let primitive = select(hit.primitive, hit.primitive | HIT_IN_INSTANCE, in_instance);
    path_state[PLANE_HIT + slot] = vec4<f32>(bitcast<f32>(distance_or_instance), bitcast<f32>(primitive), hit.u, hit.v);
#else
    path_state[PLANE_HIT + slot] = vec4<f32>(hit.t, bitcast<f32>(hit.primitive), hit.u, hit.v);
#endif
}

// A hit in an instance, which is always on a triangle, without its distance.
fn load_hit(slot: u32) -> Hit {
    let h = path_state[PLANE_HIT + slot];
    let primitive = bitcast<u32>(h.y);
#if INSTANCES
    let in_instance = primitive != NONE && (primitive & HIT_IN_INSTANCE) != 0u;
    if in_instance {
        return Hit(0.0, primitive & ~HIT_IN_INSTANCE, h.z, h.w, bitcast<u32>(h.x));
    }
#endif
    return world_hit(h.x, primitive, h.z, h.w);
}

// Index among its planes of shadow ray `number` of the path with this index in the queue.
fn shadow_ray_index(index: u32, number: u32) -> u32 {
    return select(0u, number * SHADOW_PLANES, LIGHT_SAMPLES > 1u) + index;
}
