// The flight of a path through a medium: up to the end of its ray, or to a place where the medium scatters it. src/reference/free_flight.rs is the
// same in f64, and says how the place is drawn.
#import core/layout.wgsl
#import core/math.wgsl
#import shading/light/place.wgsl
#import shading/medium/medium.wgsl

// A place where a medium scatters a path.
struct ScatteringPlace {
    distance: f32,
    // Transmittance times scattering per unit length, over the density of the place.
    weight: Spectrum,
}

// How likely a ray of some length is scattered at all.
struct FlightChances {
    // By which a channel is chosen: its share of what the path carries.
    channels: Spectrum,
    // The share of each channel that is lost on the way.
    lost: Spectrum,
    scatters: f32,
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

fn angles_of(ray: Ray, length_of_ray: f32, pivot: LightPlace) -> Angles {
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

// The chances of a path of this throughput whose ray goes this far through a medium that scatters.
fn flight_chances(medium: Medium, throughput: Spectrum, length_of_ray: f32) -> FlightChances {
    let channels = throughput / (throughput.x + throughput.y + throughput.z);
    let lost = shares_lost(medium.extinction * length_of_ray);
    return FlightChances(channels, lost, dot(channels, lost));
}

// The weight of a path that comes to the end of its ray.
fn passing_weight(medium: Medium, chances: FlightChances, length_of_ray: f32) -> Spectrum {
    let left = light_left(medium.extinction, length_of_ray);
    return left / dot(chances.channels, left);
}

// Draws the place: `choice` chooses between distance and angle and among channels, `u` the place. `pivot` is the place of a light.
fn scattering_place(medium: Medium, ray: Ray, length_of_ray: f32, chances: FlightChances, pivot: LightPlace, choice: f32, u: f32) -> ScatteringPlace {
    let angles = angles_of(ray, length_of_ray, pivot);
    let share = share_by_angle(angles, chances.channels, medium.extinction, length_of_ray);
    var distance = 0.0;
    if choice < share {
        distance = distance_by_angle(angles, u);
    } else {
        // Each channel by how much is lost of it.
        let of_channel = (choice - share) / (1.0 - share) * chances.scatters;
        let parts = chances.channels * chances.lost;
        var channel = 2u;
        channel = select(channel, 1u, of_channel < parts.x + parts.y);
        channel = select(channel, 0u, of_channel < parts.x);
        distance = depth_of_share(u * chances.lost[channel]) / medium.extinction[channel];
    }
    distance = clamp(distance, 0.0, length_of_ray);
    let left = light_left(medium.extinction, distance);
    let by_distance = dot(chances.channels, medium.extinction * left);
    var pdf = (1.0 - share) * by_distance;
    if share > 0.0 {
        pdf += share * chances.scatters * angles_pdf(angles, distance);
    }
    if pdf <= 0.0 {
        return ScatteringPlace(0.0, BLACK);
    }
    return ScatteringPlace(distance, medium.scattering * left / pdf);
}
