// Grids of values in space. `Volume` of src/scene/volume is the same in f64.
#import core/layout.wgsl
#import core/spectrum.wgsl
#import geometry/scene.wgsl
#import geometry/texels.wgsl

struct Volume {
    // Rows of the map to index space, where a voxel is a cube of side 1.
    rows: array<vec4<f32>, 3>,
    resolution: vec3<i32>,
    flags: u32,
    first_value: u32,
    first_bound: u32,
    // Voxels along the side of a coarse cell.
    side: i32,
    scale: f32,
    // The value outside of the box, with the factor.
    outside: Spectrum,
    // The smallest and the largest of all values, without the factor.
    bounds: vec2<f32>,
    // Attenuation per unit length and density by which places are drawn where light passes.
    rate: f32,
}

fn load_volume(number: u32) -> Volume {
    let at = FIRST_VOLUME_WORD + number * VOLUME_WORDS;
    let sizes = bitcast<vec4<u32>>(tables[at + 3u]);
    let places = tables[at + 4u];
    let last = tables[at + 6u];
    return Volume(
        array<vec4<f32>, 3>(tables[at], tables[at + 1u], tables[at + 2u]),
        vec3<i32>(sizes.xyz),
        sizes.w,
        bitcast<u32>(places.x),
        bitcast<u32>(places.y),
        bitcast<i32>(places.z),
        places.w,
        tables[at + 5u].xyz,
        last.xy,
        last.z
    );
}

fn to_index_point(volume: Volume, point: vec3<f32>) -> vec3<f32> {
    let p = vec4<f32>(point, 1.0);
    return vec3<f32>(dot(volume.rows[0], p), dot(volume.rows[1], p), dot(volume.rows[2], p));
}

fn to_index_vector(volume: Volume, direction: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(
        dot(volume.rows[0].xyz, direction), dot(volume.rows[1].xyz, direction), dot(volume.rows[2].xyz, direction)
    );
}

fn channels_of(volume: Volume) -> u32 {
    return select(1u, 3u, (volume.flags & VOLUME_COLORED) != 0u);
}

// One value of the voxel that is nearest to this one.
fn voxel(volume: Volume, at: vec3<i32>, channel: u32) -> f32 {
    let within = vec3<u32>(clamp(at, vec3<i32>(0), volume.resolution - 1));
    let size = vec3<u32>(volume.resolution);
    let index = (within.z * size.y + within.y) * size.x + within.x;
    return texel_float(volume.first_value + index * channels_of(volume) + channel);
}

// The blend along x, then y, then z, at a point of index space.
fn blended_voxels(volume: Volume, at: vec3<f32>, channel: u32) -> f32 {
    let from_middle = clamp(at, vec3<f32>(0.0), vec3<f32>(volume.resolution)) - 0.5;
    let lower = floor(from_middle);
    let share = from_middle - lower;
    let low = vec3<i32>(lower);
    let before = vec4<f32>(
        voxel(volume, low, channel), voxel(volume, low + vec3<i32>(0, 1, 0), channel),
        voxel(volume, low + vec3<i32>(0, 0, 1), channel), voxel(volume, low + vec3<i32>(0, 1, 1), channel)
    );
    let behind = vec4<f32>(
        voxel(volume, low + vec3<i32>(1, 0, 0), channel), voxel(volume, low + vec3<i32>(1, 1, 0), channel),
        voxel(volume, low + vec3<i32>(1, 0, 1), channel), voxel(volume, low + vec3<i32>(1, 1, 1), channel)
    );
    let along_x = before + (behind - before) * share.x;
    let along_y = along_x.xz + (along_x.yw - along_x.xz) * share.y;
    return along_y.x + (along_y.y - along_y.x) * share.z;
}

// One value at a point of index space, or at the point of the box that is nearest to it, without the factor.
fn value_of_channel(volume: Volume, at: vec3<f32>, channel: u32) -> f32 {
    if (volume.flags & VOLUME_NEAREST) != 0u {
        // Points far outside may be beyond any integer.
        return voxel(volume, vec3<i32>(floor(clamp(at, vec3<f32>(-1.0), vec3<f32>(volume.resolution)))), channel);
    }
    return blended_voxels(volume, at, channel);
}

// The value at a point of index space, or at the point of the box that is nearest to it.
fn value_at_index(volume: Volume, at: vec3<f32>) -> Spectrum {
    // Drivers copy a function to each of its calls.
    var value = BLACK;
    for (var channel = 0u; channel < channels_of(volume); channel++) {
        value[channel] = value_of_channel(volume, at, channel);
    }
    return select(Spectrum(value.x), value, channels_of(volume) > 1u) * volume.scale;
}

// The value at a point of the scene.
fn volume_value(volume: Volume, point: vec3<f32>) -> Spectrum {
    let at = to_index_point(volume, point);
    let is_inside = all(at >= vec3<f32>(0.0)) && all(at <= vec3<f32>(volume.resolution));
    if !is_inside && (volume.flags & VOLUME_BORDER) == 0u {
        return volume.outside;
    }
    return value_at_index(volume, at);
}
