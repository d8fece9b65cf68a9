// The end of a path's ray: the light that the medium on the way gives off, and the path's throughput there or at the place where the
// medium scatters the path.
#import core/layout.wgsl
#import core/math.wgsl
#import core/sampler.wgsl
#import shading/light/place.wgsl
#import shading/medium/free_flight.wgsl
#import shading/medium/medium.wgsl
#import shading/medium/tracking.wgsl
#import shading/medium/stack.wgsl
#import shading/path/record.wgsl
#import shading/surface.wgsl

struct Arrival {
    // Light that the medium gives off, already times the throughput.
    radiance: Spectrum,
    throughput: Spectrum,
    // The phase lobes of a medium that scatters the path at this distance; 0: none does.
    phase: u32,
    distance: f32,
}

// Light that the medium around a path's ray of this length gives off.
fn radiance_of_medium(path: Path, ray_length: f32) -> Spectrum {
    let number = innermost(path.media);
    if number == 0u {
        return BLACK;
    }
    return path.throughput * light_given_off(load_medium(number), ray_length);
}

// The place of a light about which the place of scattering is drawn: of the light that light sample 0 of the next vertex chooses, but at the middle of
// the ray, or as far as light goes.
fn pivot_of(path: Path, extinction: Spectrum, ray_length: f32, vertex: u32) -> LightPlace {
    let random = random_block(path.pixel, path.sample_in_pass, 2u * vertex);
    let way = min(0.5 * ray_length, 3.0 / (extinction.x + extinction.y + extinction.z));
    let middle = path.ray.origin + way * path.ray.direction;
    return light_place(middle, facing_of(medium_surface(path.ray, way)), random);
}

// A path whose ray of this length leads to vertex number `vertex`.
fn arrive(path: Path, ray_length: f32, vertex: u32) -> Arrival {
    if HAS_MEDIUM_GRIDS && innermost(path.media) != 0u {
        let medium = load_medium(innermost(path.media));
        if (medium.flags & MEDIUM_VARIES) != 0u {
            return arrive_through_grids(path, medium, ray_length, vertex);
        }
    }
    if HAS_SCATTERING {
        return arrive_through_medium(path, ray_length, vertex);
    }
    var radiance = BLACK;
    if HAS_MEDIUM_EMISSION {
        radiance = radiance_of_medium(path, ray_length);
    }
    return Arrival(radiance, arriving_throughput(path, ray_length), 0u, ray_length);
}

// Such a path within a medium that differs from place to place.
fn arrive_through_grids(path: Path, medium: Medium, ray_length: f32, vertex: u32) -> Arrival {
    var arrival = Arrival(BLACK, path.throughput, 0u, ray_length);
    let random = random_block(path.pixel, path.sample_in_pass, FIRST_MEDIUM_BLOCK + vertex - 1u);
    let scatters = (medium.flags & MEDIUM_SCATTERS) != 0u;
    // The medium begins at the surface that the ray left.
    let ray = Ray(path.ray.origin - path.way_before * path.ray.direction, path.ray.direction);
    let length_of_ray = min(ray_length + path.way_before, FARTHEST);
    if HAS_MEDIUM_PASSAGE {
        let emits = HAS_MEDIUM_EMISSION && (medium.flags & MEDIUM_GIVES_LIGHT) != 0u;
        if emits || !scatters {
            let passage = pass_through(medium, ray, length_of_ray, emits, random.w);
            arrival.radiance = path.throughput * passage.given_off;
            if !scatters {
                arrival.throughput *= passage.left;
            }
        }
    }
    if HAS_SCATTERING {
        if scatters {
            let flight = track(medium, path.throughput, ray, length_of_ray, random.z);
            arrival.throughput *= flight.weight;
            arrival.phase = select(0u, medium.phase, flight.is_scattered);
            arrival.distance = max(flight.distance - path.way_before, 0.0);
        }
    }
    return arrival;
}

// Such a path in a scene with media that scatter.
fn arrive_through_medium(path: Path, ray_length: f32, vertex: u32) -> Arrival {
    let number = innermost(path.media);
    var arrival = Arrival(BLACK, path.throughput, 0u, ray_length);
    if number == 0u {
        return arrival;
    }
    let medium = load_medium(number);
    if HAS_MEDIUM_EMISSION {
        arrival.radiance = path.throughput * light_given_off(medium, ray_length);
    }
    if (medium.flags & MEDIUM_SCATTERS) == 0u {
        arrival.throughput *= light_left(medium.extinction, ray_length);
        return arrival;
    }
    // The medium begins at the surface that the ray left.
    let length_of_ray = min(ray_length + path.way_before, FARTHEST);
    let random = random_block(path.pixel, path.sample_in_pass, FIRST_MEDIUM_BLOCK + vertex - 1u);
    let chances = flight_chances(medium, path.throughput, length_of_ray);
    let event = open_float(random.x);
    if event >= chances.scatters {
        arrival.throughput *= passing_weight(medium, chances, length_of_ray);
        return arrival;
    }
    var pivot = LightPlace(false, vec3<f32>(0.0));
    if HAS_LIGHTS && !HAS_BY_DISTANCE {
        if (medium.flags & MEDIUM_IS_LIGHT_SAMPLED) != 0u {
            pivot = pivot_of(path, medium.extinction, ray_length, vertex);
        }
    }
    let place =
        scattering_place(medium, path.ray, length_of_ray, chances, pivot, event / chances.scatters, open_float(random.y));
    arrival.throughput *= place.weight;
    arrival.phase = medium.phase;
    arrival.distance = max(place.distance - path.way_before, 0.0);
    return arrival;
}
