// The choice of a light by a tree (Conty Estévez and Kulla 2018). src/sampling/light_tree does the same, and says how.
#import core/layout.wgsl
#import core/octahedron.wgsl
#import core/sampler.wgsl
#import geometry/scene.wgsl
#import shading/light/record.wgsl

// A node takes four vec4 of the tables, two for each of its clusters:
//   (center and radius of a sphere around it), (power; axis of the cone; cosines of its spread and reach; link)

// All random bits but the last value.
const WHOLE_LIGHT_RANGE: u32 = 0xffffffffu;

// The point.
alias LightContext = vec3<f32>;

fn light_context(point: vec3<f32>, facing: u32) -> LightContext {
    return point;
}

// Two numbers of 16 bits, the first in the lower half.
fn cluster_numbers(halves: u32) -> vec2<f32> {
    return vec2<f32>(f32(i32(halves << 16u) >> 16u), f32(i32(halves) >> 16u)) * CLUSTER_STEP;
}

// Importance of a cluster at a point: its power times the largest cosine at its lights, 0 where nothing
// arrives; and the squared distance.
fn cluster_seen(sphere: vec4<f32>, words: vec4<u32>, point: vec3<f32>) -> vec2<f32> {
    let power = bitcast<f32>(words.x);
    let away = point - sphere.xyz;
    let squared = dot(away, away);
    let squared_radius = sphere.w * sphere.w;
    if squared <= squared_radius {
        return vec2<f32>(power, squared_radius);
    }
    let distance = sqrt(squared);
    let axis = octahedron_direction(cluster_numbers(words.y));
    let cone = cluster_numbers(words.z);
    let signed_along = dot(axis, away) / distance;
    let aside = length(cross(axis, away)) / distance;
    let along = select(signed_along, abs(signed_along), (words.w & LIGHT_CLUSTER_TWO_SIDED) != 0u);
    // The angle to the nearest direction that is within the spread, cone.x.
    let sine_of_spread = sqrt(max(0.0, 1.0 - cone.x * cone.x));
    let is_beyond = along < cone.x;
    let beyond = select(1.0, along * cone.x + aside * sine_of_spread, is_beyond);
    let sine = select(0.0, aside * cone.x - along * sine_of_spread, is_beyond);
    // Largest cosine over the points of the cluster's bounding sphere.
    let sine_of_sphere = sphere.w / distance;
    let cosine_of_sphere = sqrt(max(0.0, 1.0 - sine_of_sphere * sine_of_sphere));
    let cosine = select(1.0, beyond * cosine_of_sphere + sine * sine_of_sphere, beyond < cosine_of_sphere);
    return vec2<f32>(select(power * max(cosine, LEAST_CLUSTER_COSINE), 0.0, cosine <= cone.y), squared);
}

// A node's links, and how much of a range of random bits is its first cluster's.
struct LightSplit {
    links: vec2<u32>,
    first_part: u32,
}

fn split_lights(node: u32, point: vec3<f32>, range: u32) -> LightSplit {
    let at = FIRST_LIGHT_NODE_WORD + node * LIGHT_NODE_WORDS;
    let first_words = bitcast<vec4<u32>>(tables[at + 1u]);
    let second_words = bitcast<vec4<u32>>(tables[at + 3u]);
    let first = cluster_seen(tables[at], first_words, point);
    let second = cluster_seen(tables[at + 2u], second_words, point);
    let a = first.x * second.y;
    let b = second.x * first.y;
    var share = 0.5;
    if a + b > 0.0 {
        share = clamp(a / (a + b), LEAST_CLUSTER_SHARE, 1.0 - LEAST_CLUSTER_SHARE);
    }
    var part = multiply_high(range, u32(share * 4294967296.0));
    part = select(part, range, second.x == 0.0 && first.x > 0.0);
    part = select(part, 0u, first.x == 0.0 && second.x > 0.0);
    return LightSplit(vec2<u32>(first_words.w, second_words.w), part);
}

// The part of all random bits that a range of them is.
fn light_range_share(range: u32) -> f32 {
    return f32(range) * 2.3283064365386963e-10;
}

// The light inside the scene that 32 random bits choose at a point.
fn choose_local_light(point: vec3<f32>, bits: u32) -> LightChoice {
    var offset = min(bits, WHOLE_LIGHT_RANGE - 1u);
    var range = WHOLE_LIGHT_RANGE;
    var link = 0u;
    loop {
        let split = split_lights(link & LIGHT_NUMBER_MASK, point, range);
        if offset >= split.first_part {
            offset -= split.first_part;
            range -= split.first_part;
            link = split.links.y;
        } else {
            range = split.first_part;
            link = split.links.x;
        }
        if (link & LIGHT_LEAF) != 0u {
            break;
        }
    }
    return LightChoice(link & LIGHT_NUMBER_MASK, light_range_share(range));
}

// Lights at infinity make half of the choices where there are any.
fn choose_light(point: LightContext, bits: u32) -> LightChoice {
    if LIGHTS_AT_INFINITY == 0u {
        return choose_local_light(point, bits);
    }
    let rest = bits << 1u;
    if (bits >> 31u) == 1u {
        let entry = LOCAL_LIGHTS + multiply_high(rest, LIGHTS_AT_INFINITY);
        let remainder = rest * LIGHTS_AT_INFINITY;
        let word = bitcast<vec4<u32>>(tables[FIRST_LIGHT_WORD + entry * LIGHT_WORDS]);
        let light = select(word.z, entry, remainder < word.y);
        return LightChoice(light, distant_light_pmf(point, light));
    }
    let chosen = choose_local_light(point, rest);
    return LightChoice(chosen.light, 0.5 * chosen.pmf);
}

fn light_pmf(point: LightContext, light: u32) -> f32 {
    var trail = bitcast<u32>(tables[FIRST_LIGHT_WORD + light * LIGHT_WORDS + 2u].w);
    var range = WHOLE_LIGHT_RANGE;
    var link = 0u;
    loop {
        let split = split_lights(link & LIGHT_NUMBER_MASK, point, range);
        let is_second = (trail & 1u) == 1u;
        range = select(split.first_part, range - split.first_part, is_second);
        link = select(split.links.x, split.links.y, is_second);
        trail >>= 1u;
        if (link & LIGHT_LEAF) != 0u {
            break;
        }
    }
    return light_range_share(range) * select(1.0, 0.5, LIGHTS_AT_INFINITY > 0u);
}

fn distant_light_pmf(point: LightContext, light: u32) -> f32 {
    return tables[FIRST_LIGHT_WORD + light * LIGHT_WORDS].w;
}
