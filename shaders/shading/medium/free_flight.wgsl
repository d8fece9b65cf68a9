// The flight of a path through a medium: up to the end of its ray, or to a place where the medium scatters it. src/reference/free_flight.rs is the
// same in f64, and says how the place is drawn.
#import core/layout.wgsl
#import core/math.wgsl
#import shading/medium/medium.wgsl

// The first block of the numbers for flights (src/sampling/dimension.rs).
const FIRST_MEDIUM_BLOCK: u32 = 1u << 27u;

struct Flight {
    is_scattered: bool,
    distance: f32,
    weight: Spectrum,
}

// A point of a light about which the place may be drawn.
struct Pivot {
    exists: bool,
    point: vec3<f32>,
}

// Equi-angular sampling of a ray's first `length` about a point (Kulla and Fajardo 2012).
struct Angles {
    exists: bool,
    // Distance along the ray of its place next to the point, and the distance of that place from the point.
    next: f32,
    aside: f32,
    // The angle under which the point sees the ray, in turns.
    turns: f32,
}

// A point nearer to a ray than this, by its distance from the ray's origin, is on it.
const LEAST_ASIDE: f32 = 1.0e-4;

// Uniform in (0, 1): all bits, and fine near 0, where rare events are.
fn open_float(bits: u32) -> f32 {
    return min((f32(bits) + 0.5) * 2.3283064365386963e-10, LARGEST_NUMBER);
}

fn angles_of(ray: Ray, length_of_ray: f32, pivot: Pivot) -> Angles {
    let to_pivot = pivot.point - ray.origin;
    let next = dot(to_pivot, ray.direction);
    let aside = length(to_pivot - ray.direction * next);
    let exists = pivot.exists && aside > LEAST_ASIDE * length(to_pivot);
    let turns = atan2_turns(length_of_ray * aside, aside * aside - next * (length_of_ray - next));
    return Angles(exists, next, aside, turns);
}

fn distance_by_angle(angles: Angles, u: f32) -> f32 {
    let sine_cosine = sin_cos_turns(u * angles.turns);
    let squared = angles.aside * angles.aside + angles.next * angles.next;
    return sine_cosine.x * squared / (angles.aside * sine_cosine.y + angles.next * sine_cosine.x);
}

// Density of a distance, per unit length.
fn angles_pdf(angles: Angles, distance: f32) -> f32 {
    let beyond = distance - angles.next;
    return angles.aside / (angles.turns * TWO_PI * (angles.aside * angles.aside + beyond * beyond));
}

// -log(1 - x) of x in [0, 1), which does not cancel where x is small.
fn depth_of_share(x: f32) -> f32 {
    let series = x * (1.0 + x * (0.5 + x * (0.33333333 + x * (0.25 + x * (0.2 + x * (0.16666667 + x * 0.14285714))))));
    return select(-natural_log(1.0 - x), series, x < 0.1);
}

fn lost_along(extinction: Spectrum, length_of_ray: f32) -> Spectrum {
    let depth = extinction * length_of_ray;
    return Spectrum(share_lost(depth.x), share_lost(depth.y), share_lost(depth.z));
}

// How often the place is drawn by angle.
fn share_by_angle(angles: Angles, chances: Spectrum, extinction: Spectrum, length_of_ray: f32) -> f32 {
    if HAS_BY_DISTANCE {
        return 0.0;
    } else if HAS_BY_ANGLE {
        return select(0.0, 1.0, angles.exists);
    } else {
        // Light that is lost before the place next to the point lights nothing there.
        let next = clamp(angles.next, 0.0, length_of_ray);
        return select(0.0, 0.5 * dot(chances, light_left(extinction, next)), angles.exists);
    }
}

// Flies along a ray of this length through a medium that scatters, with a path of this throughput.
fn fly(medium: Medium, throughput: Spectrum, ray: Ray, ray_length: f32, pivot: Pivot, random: vec4<u32>) -> Flight {
    let length_of_ray = min(ray_length, FARTHEST);
    let u_event = open_float(random.x);
    let u_distance = open_float(random.y);
    let chances = throughput / (throughput.x + throughput.y + throughput.z);
    let lost = lost_along(medium.extinction, length_of_ray);
    let scatters = dot(chances, lost);
    if u_event >= scatters {
        let left = light_left(medium.extinction, length_of_ray);
        return Flight(false, length_of_ray, left / dot(chances, left));
    }
    let angles = angles_of(ray, length_of_ray, pivot);
    let share = share_by_angle(angles, chances, medium.extinction, length_of_ray);
    let choice = u_event / scatters;
    var distance = 0.0;
    if choice < share {
        distance = distance_by_angle(angles, u_distance);
    } else {
        // Each channel by how much is lost of it.
        let of_channel = (choice - share) / (1.0 - share) * scatters;
        let parts = chances * lost;
        var channel = 2u;
        channel = select(channel, 1u, of_channel < parts.x + parts.y);
        channel = select(channel, 0u, of_channel < parts.x);
        distance = depth_of_share(u_distance * lost[channel]) / medium.extinction[channel];
    }
    distance = clamp(distance, 0.0, length_of_ray);
    let left = light_left(medium.extinction, distance);
    let by_distance = dot(chances, medium.extinction * left);
    var pdf = (1.0 - share) * by_distance;
    if share > 0.0 {
        pdf += share * scatters * angles_pdf(angles, distance);
    }
    if pdf <= 0.0 {
        return Flight(true, 0.0, BLACK);
    }
    return Flight(true, distance, medium.scattering * left / pdf);
}
