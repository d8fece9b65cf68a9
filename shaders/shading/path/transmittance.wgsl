// Transmittance of a surface for a shadow ray: the weight of its null lobes. src/reference/emission.rs looks
// weights up alike.
#import core/layout.wgsl
#import core/math.wgsl
#import geometry/prepared_ray.wgsl
#import geometry/records.wgsl
#import geometry/scene.wgsl
#import geometry/shapes.wgsl
#import geometry/placed.wgsl
#import shading/surface.wgsl
#import shading/material/blend.wgsl

// The second crossing, before `limit`, of a ray and the primitive that it meets at `hit`; its primitive is NONE where there is none. Groups of
// instances consist of triangles, which are crossed once.
fn crossed_again(ray: Ray, hit: Hit, limit: f32) -> Hit {
    var again = no_hit(limit);
    if HAS_INSTANCES && hit.instance != NONE {
        return again;
    }
#if MOTION
    let placed = placed_primitive(primitive_words(hit.primitive));
    let words = PrimitiveWords(placed.p0, placed.p1, placed.p2);
#else
    let words = primitive_words(hit.primitive);
#endif
    let found = intersect_again(prepare_ray(ray), limit, primitive_kind(words.w0.w), words.w0.xyz, words.w1.xyz, words.w2.xyz);
    if found.x > 0.0 {
        again = world_hit(found.x, hit.primitive, found.y, found.z);
    }
    return again;
}

// The share of light that comes through the primitive that a ray meets at `hit`, and through its far side where that is nearer than `limit`; 0
// where it is opaque.
fn hit_transmittance(ray: Ray, hit: Hit, limit: f32) -> f32 {
    let material = hit_material(hit);
    var share = 0.0;
    if (bitcast<u32>(tables[material * MATERIAL_WORDS + 2u].w) & LETS_THROUGH) != 0u {
#if BLENDS
        share = 1.0;
        var met = hit;
        for (var crossing = 0; crossing < 2 && met.primitive != NONE; crossing++) {
            share *= null_weight(hit_surface(ray, met), -ray.direction);
            if crossing == 0 {
                met = crossed_again(ray, hit, limit);
            }
        }
#else
        share = 1.0;
#endif
    }
    return share;
}

// The share of light that goes straight on through a surface.
fn null_share(surface: Surface, ray: Ray) -> f32 {
    if (bitcast<u32>(tables[surface.material * MATERIAL_WORDS + 2u].w) & LETS_THROUGH) == 0u {
        return 0.0;
    }
    if HAS_BLENDS {
        return null_weight(surface, -ray.direction);
    } else {
        return 1.0;
    }
}

fn is_null_part(run: PartRun, index: u32) -> bool {
    let material = part_material(run, index);
    return (bitcast<u32>(tables[material * MATERIAL_WORDS].w) & 255u) == NULL_SURFACES;
}

// The weights of all null parts of a surface's material, seen along `wo`.
fn null_weight(surface: Surface, wo: vec3<f32>) -> f32 {
    let seen = seen_along(surface, wo);
    let run = part_run(surface.material);
    var sum = 0.0;
    for (var index = 0u; index < run.count; index++) {
        if is_null_part(run, index) {
            sum += weighted_part(run, index, seen, surface.uv).weight;
        }
    }
    return min(sum, 1.0);
}
