// The coarse cells of a volume that a ray crosses, one after the other, with the bounds of the values there. src/scene/volume/crossing.rs is the same in f64, and says
// how planes are met.
#import core/layout.wgsl
#import core/math.wgsl
#import geometry/texels.wgsl
#import shading/medium/volume.wgsl

// A ray on its way through a volume.
struct VolumeCrossing {
    // The ray in index space; distances are those of the scene.
    origin: vec3<f32>,
    direction: vec3<f32>,
    // Distance up to which segments were reported, and the one at which they end.
    at: f32,
    end: f32,
    // Distances at which the ray is in the grid's box; equal ones: it is not.
    near: f32,
    far: f32,
    // The coarse cell that comes next.
    cell: vec3<i32>,
}

// A part of a ray over which values have the same bounds.
struct VolumeSegment {
    exists: bool,
    entry: f32,
    exit: f32,
    minimum: f32,
    maximum: f32,
    // In the grid's box, in this coarse cell.
    is_inside: bool,
    cell: vec3<i32>,
}

fn coarse_cells(volume: Volume) -> vec3<i32> {
    return (volume.resolution + volume.side - 1) / volume.side;
}

fn begin_volume_crossing(volume: Volume, ray: Ray, length_of_ray: f32) -> VolumeCrossing {
    let origin = to_index_point(volume, ray.origin);
    let direction = to_index_vector(volume, ray.direction);
    let size = vec3<f32>(volume.resolution);
    let is_still = direction == vec3<f32>(0.0);
    let step = select(direction, vec3<f32>(1.0), is_still);
    let first = (vec3<f32>(0.0) - origin) / step;
    let second = (size - origin) / step;
    // Along an axis on which the ray does not move, it is within everywhere or nowhere.
    let stays_outside = is_still & ((origin < vec3<f32>(0.0)) | (origin > size));
    let entries = select(min(first, second), vec3<f32>(0.0), is_still);
    let exits = select(max(first, second), vec3<f32>(length_of_ray), is_still);
    let near = max(0.0, max(entries.x, max(entries.y, entries.z)));
    var far = min(length_of_ray, min(exits.x, min(exits.y, exits.z)));
    if any(stays_outside) {
        far = near;
    }
    // A ray that misses the box is outside of it from end to end.
    let meets = near < far;
    let within = select(vec2<f32>(length_of_ray), vec2<f32>(near, far), meets);
    let point = origin + direction * within.x;
    let last = vec3<f32>(coarse_cells(volume) - 1);
    let cell = vec3<i32>(clamp(floor(point / f32(volume.side)), vec3<f32>(0.0), last));
    return VolumeCrossing(origin, direction, 0.0, length_of_ray, within.x, within.y, cell);
}

// The segment outside of the box that ends here.
fn segment_outside(volume: Volume, crossing: ptr<function, VolumeCrossing>, exit: f32) -> VolumeSegment {
    let entry = (*crossing).at;
    (*crossing).at = exit;
    let outside = volume.outside;
    var bounds = vec2<f32>(min(outside.x, min(outside.y, outside.z)), max_component(outside));
    if (volume.flags & VOLUME_BORDER) != 0u {
        bounds = volume.bounds * volume.scale;
    }
    return VolumeSegment(true, entry, exit, bounds.x, bounds.y, false, vec3<i32>(0));
}

// The segment that comes next, from near to far.
fn next_segment(volume: Volume, crossing: ptr<function, VolumeCrossing>) -> VolumeSegment {
    if (*crossing).at < (*crossing).near {
        return segment_outside(volume, crossing, (*crossing).near);
    }
    let cells = coarse_cells(volume);
    while (*crossing).at < (*crossing).far {
        let cell = (*crossing).cell;
        let direction = (*crossing).direction;
        let grows = direction > vec3<f32>(0.0);
        let planes = select(cell * volume.side, min((cell + 1) * volume.side, volume.resolution), grows);
        let is_still = direction == vec3<f32>(0.0);
        let distances = select(
            (vec3<f32>(planes) - (*crossing).origin) / select(direction, vec3<f32>(1.0), is_still),
            vec3<f32>(INFINITY_DISTANCE), is_still
        );
        var axis = select(0u, 1u, distances.y < distances.x);
        axis = select(axis, 2u, distances.z < distances[axis]);
        let entry = (*crossing).at;
        let next = cell[axis] + select(-1, 1, grows[axis]);
        (*crossing).cell[axis] = next;
        let is_last = next < 0 || next >= cells[axis];
        (*crossing).at = select(clamp(distances[axis], entry, (*crossing).far), (*crossing).far, is_last);
        if (*crossing).at > entry {
            let index = volume.first_bound + 2u * u32((cell.z * cells.y + cell.y) * cells.x + cell.x);
            let bounds = vec2<f32>(texel_float(index), texel_float(index + 1u)) * volume.scale;
            return VolumeSegment(true, entry, (*crossing).at, bounds.x, bounds.y, true, cell);
        }
    }
    if (*crossing).at < (*crossing).end {
        return segment_outside(volume, crossing, (*crossing).end);
    }
    return VolumeSegment(false, 0.0, 0.0, 0.0, 0.0, false, vec3<i32>(0));
}

// The density at a distance within a segment. Where rounding puts the place into the cell beside, it is that of the nearest point of its own, whose
// bounds hold.
fn density_in_segment(volume: Volume, segment: VolumeSegment, ray: Ray, distance: f32) -> Spectrum {
    if !segment.is_inside && (volume.flags & VOLUME_BORDER) == 0u {
        return volume.outside;
    }
    var at = to_index_point(volume, ray.origin + distance * ray.direction);
    if segment.is_inside {
        let low = vec3<f32>(segment.cell * volume.side);
        var high = min(low + f32(volume.side), vec3<f32>(volume.resolution));
        if (volume.flags & VOLUME_NEAREST) != 0u {
            high -= 0.5;
        }
        at = clamp(at, low, high);
    }
    return value_at_index(volume, at);
}
