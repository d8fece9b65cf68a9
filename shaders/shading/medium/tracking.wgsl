// Rays through media that differ from place to place. src/reference/tracking.rs is the same in f64, and says how.
#import core/layout.wgsl
#import core/math.wgsl
#import core/stream.wgsl
#import shading/medium/medium.wgsl
#import shading/medium/volume.wgsl
#import shading/medium/volume_crossing.wgsl

// A ray's way through a medium.
struct Passage {
    // The share of light that is left.
    left: Spectrum,
    // The light that the medium gives off, as it arrives at the ray's origin.
    given_off: Spectrum,
}

// A flight of a path.
struct TrackedFlight {
    is_scattered: bool,
    distance: f32,
    // With the albedo of a place where the path is scattered.
    weight: Spectrum,
}

// Depth up to the next collision.
fn draw_depth(stream: ptr<function, Stream>) -> f32 {
    return -natural_log(draw(stream));
}

// Odds that stay finite.
fn limited(odds: Spectrum) -> Spectrum {
    return clamp(odds, BLACK, Spectrum(1.0e30));
}

// The density of a flight of so many collisions and this integral of bounds under each channel, over the mean by the chances with which channels are
// chosen; 0 of channels that the path does not carry. `odds` are the probabilities of what collisions were, beside those by the chosen channel.
fn channel_weights(extinction: Spectrum, chances: Spectrum, chosen: u32, collisions: u32, bounds: f32, odds: Spectrum) -> Spectrum {
    let own = extinction[chosen];
    // Logarithms beside that of the chosen channel, so that equal channels weigh 1 to the last bit.
    var logarithms = BLACK;
    for (var channel = 0u; channel < 3u; channel++) {
        if extinction[channel] != own {
            var of_collisions = 0.0;
            if collisions > 0u {
                // Collisions of a channel without extinction are impossible.
                of_collisions = f32(collisions) * select(-1.0e6, natural_log(extinction[channel] / own), extinction[channel] > 0.0);
            }
            logarithms[channel] = of_collisions - (extinction[channel] - own) * bounds;
        }
    }
    let is_carried = chances > BLACK;
    let largest = max_component(select(Spectrum(-1.0e38), logarithms, is_carried));
    let counts = is_carried & (logarithms - largest > Spectrum(-87.0));
    let of_channels = select(BLACK, exp(max(logarithms - largest, Spectrum(-87.0))) * odds, counts);
    return of_channels / dot(chances, of_channels);
}

// Flies along the first `length_of_ray` of a ray through a medium with grids that scatters, with a path of this throughput.
fn track(medium: Medium, throughput: Spectrum, ray: Ray, length_of_ray: f32, key: u32) -> TrackedFlight {
    let volume = load_volume(medium.first_volume);
    let chances = throughput / (throughput.x + throughput.y + throughput.z);
    var stream = Stream(key, 0u);
    let choice = draw(&stream);
    var channel = 2u;
    channel = select(channel, 1u, choice < chances.x + chances.y);
    channel = select(channel, 0u, choice < chances.x);
    let rate = medium.extinction[channel];
    var depth_left = draw_depth(&stream);
    var bounds = 0.0;
    var collisions = 0u;
    var odds = WHITE;
    var crossing = begin_volume_crossing(volume, ray, length_of_ray);
    var segment = next_segment(volume, &crossing);
    var at = segment.entry;
    while segment.exists {
        let room = segment.maximum * (segment.exit - at);
        if depth_left >= rate * room {
            depth_left -= rate * room;
            bounds += room;
            segment = next_segment(volume, &crossing);
            at = segment.entry;
            continue;
        }
        bounds += depth_left / rate;
        at = min(at + depth_left / (rate * segment.maximum), segment.exit);
        collisions++;
        let real = density_in_segment(volume, segment, ray, at) / segment.maximum;
        let of_chosen = real[channel];
        if draw(&stream) < of_chosen {
            odds = limited(odds * (real / of_chosen));
            var albedo = medium.scattering / max(medium.extinction, Spectrum(1.0e-37));
            if (medium.flags & MEDIUM_HAS_ALBEDOS) != 0u {
                albedo *= volume_value(load_volume(medium.first_volume + 1u), ray.origin + at * ray.direction);
            }
            return TrackedFlight(true, at, albedo * channel_weights(medium.extinction, chances, channel, collisions, bounds, odds));
        }
        odds = limited(odds * ((WHITE - real) / (1.0 - of_chosen)));
        if collisions == MOST_LOOKUPS {
            return TrackedFlight(false, length_of_ray, BLACK);
        }
        depth_left = draw_depth(&stream);
    }
    return TrackedFlight(false, length_of_ray, channel_weights(medium.extinction, chances, channel, collisions, bounds, odds));
}

// Estimates what a ray's first `length_of_ray` through a medium with grids leaves of light, and, where it is asked for, what the medium gives off along it.
fn pass_through(medium: Medium, ray: Ray, length_of_ray: f32, emits: bool, key: u32) -> Passage {
    let volume = load_volume(medium.first_volume);
    let rate = volume.rate;
    var passage = Passage(WHITE, BLACK);
    if rate == 0.0 {
        return passage;
    }
    var stream = Stream(key, 0u);
    var depth_left = draw_depth(&stream);
    var lookups = 0u;
    var crossing = begin_volume_crossing(volume, ray, min(length_of_ray, FARTHEST));
    loop {
        let segment = next_segment(volume, &crossing);
        if !segment.exists {
            break;
        }
        // Light that is given off is looked up where collisions are.
        let control = select(segment.minimum, 0.0, emits);
        let residual = segment.maximum - control;
        passage.left *= exp(-min(medium.extinction * control * (segment.exit - segment.entry), Spectrum(87.0)));
        var at = segment.entry;
        loop {
            let room = rate * residual * (segment.exit - at);
            if depth_left >= room {
                depth_left -= room;
                break;
            }
            at = min(at + depth_left / (rate * residual), segment.exit);
            let share = clamp((density_in_segment(volume, segment, ray, at) - control) / residual, BLACK, WHITE);
            if HAS_MEDIUM_EMISSION && emits {
                var light = medium.emission;
                if (medium.flags & MEDIUM_HAS_GLOW) != 0u {
                    let albedos = select(0u, 1u, (medium.flags & MEDIUM_HAS_ALBEDOS) != 0u);
                    light *= volume_value(load_volume(medium.first_volume + 1u + albedos), ray.origin + at * ray.direction);
                }
                passage.given_off += passage.left * light * share / rate;
            }
            passage.left *= WHITE - medium.extinction * share / rate;
            lookups++;
            var survives = true;
            if max_component(passage.left) < FAINT {
                // Faint light goes on by one half, and then counts twice as much.
                passage.left *= 2.0;
                survives = draw(&stream) < 0.5 && max_component(passage.left) > 0.0;
            }
            if !survives || lookups == MOST_LOOKUPS {
                passage.left = BLACK;
                return passage;
            }
            depth_left = draw_depth(&stream);
        }
    }
    return passage;
}

// The share of light that is left along a ray within the medium of a number; where that differs from place to place an estimate by random numbers of this
// key.
fn transmittance_along(medium: u32, ray: Ray, length_of_ray: f32, key: u32) -> Spectrum {
    if HAS_MEDIUM_GRIDS && medium != 0u {
        let loaded = load_medium(medium);
        if (loaded.flags & MEDIUM_VARIES) != 0u {
            return pass_through(loaded, ray, length_of_ray, false, key).left;
        }
    }
    return medium_transmittance(medium, length_of_ray);
}
