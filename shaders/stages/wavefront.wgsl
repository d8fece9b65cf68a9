// State of the paths in flight, and the queues that say which of them still live.
#import core/math.wgsl
#import core/parameters.wgsl
#import shading/path.wgsl

// Five planes of PATH_CAPACITY vec4 each:
//   ray origin and pixel within the pass (within the band where pixels are listed) | sample in the pass << 24; ray direction and its density; throughput and eta scale;
//   radiance and vertices passed; hit
@group(0) @binding(9) var<storage, read_write> path_state: array<vec4<f32>>;
// Three planes of PATH_CAPACITY vec4: origin and distance; direction and path slot; radiance.
@group(0) @binding(10) var<storage, read_write> shadow_rays: array<vec4<f32>>;
// Two queues of PATH_CAPACITY path slots: one is read while the other is filled.
@group(0) @binding(11) var<storage, read_write> queues: array<u32>;
// Paths in queue 0 and 1, shadow rays of edges that read queue 0 and 1.
@group(0) @binding(12) var<storage, read_write> counts: array<atomic<u32>, 4>;

const PLANE_ORIGIN: u32 = 0u;
const PLANE_DIRECTION: u32 = PATH_CAPACITY;
const PLANE_THROUGHPUT: u32 = 2u * PATH_CAPACITY;
const PLANE_RADIANCE: u32 = 3u * PATH_CAPACITY;
const PLANE_HIT: u32 = 4u * PATH_CAPACITY;

const SHADOW_ORIGIN: u32 = 0u;
const SHADOW_DIRECTION: u32 = PATH_CAPACITY;
const SHADOW_RADIANCE: u32 = 2u * PATH_CAPACITY;

const WORKGROUP: u32 = 64u;

fn load_ray(slot: u32) -> Ray {
    return Ray(path_state[PLANE_ORIGIN + slot].xyz, path_state[PLANE_DIRECTION + slot].xyz);
}

#if MOTION
// To be called before anything is asked of the scene for the path in a slot.
fn set_path_time_of(slot: u32) {
    let identity = bitcast<u32>(path_state[PLANE_ORIGIN + slot].w);
    set_path_time(pass_parameters.first_pixel + (identity & 0x00ffffffu), identity >> 24u);
}
#endif

fn load_path(slot: u32) -> Path {
    let p0 = path_state[PLANE_ORIGIN + slot];
    let p1 = path_state[PLANE_DIRECTION + slot];
    let p2 = path_state[PLANE_THROUGHPUT + slot];
    let identity = bitcast<u32>(p0.w);
    var path: Path;
    path.ray = Ray(p0.xyz, p1.xyz);
    path.throughput = p2.xyz;
    path.pdf_solid_angle = p1.w;
    path.eta_scale = p2.w;
    path.pixel = pass_parameters.first_pixel + (identity & 0x00ffffffu);
    path.sample_in_pass = identity >> 24u;
#if PASS
    path.passed = bitcast<u32>(path_state[PLANE_RADIANCE + slot].w);
#endif
    return path;
}

// Writes all but the radiance and the hit.
fn store_path(slot: u32, path: Path) {
    let identity = (path.pixel - pass_parameters.first_pixel) | (path.sample_in_pass << 24u);
    path_state[PLANE_ORIGIN + slot] = vec4<f32>(path.ray.origin, bitcast<f32>(identity));
    path_state[PLANE_DIRECTION + slot] = vec4<f32>(path.ray.direction, path.pdf_solid_angle);
    path_state[PLANE_THROUGHPUT + slot] = vec4<f32>(path.throughput, path.eta_scale);
}
