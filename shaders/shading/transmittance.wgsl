// What a surface lets through of the light that a shadow ray brings: the weight of its null parts. src/reference/emission.rs looks weights up alike.
#import core/layout.wgsl
#import core/math.wgsl
#import geometry/scene.wgsl
#import shading/surface.wgsl
#if BLENDS
#import shading/blend.wgsl
#endif

// Of the primitive that a ray meets at `hit`, 0 where it is opaque. A sphere is met again on its far side, if that is nearer than `limit`.
fn hit_transmittance(ray: Ray, hit: Hit, limit: f32) -> f32 {
    let material = hit_material(hit);
    var share = 0.0;
    if (bitcast<u32>(tables[material * MATERIAL_WORDS + 2u].w) & LETS_THROUGH) != 0u {
#if BLENDS
        share = 1.0;
        var met = hit;
        var count = 1;
        for (var number = 0; number < count; number++) {
            let surface = hit_surface(ray, met);
            share *= null_weight(surface, -ray.direction);
#if SPHERES
            // The distances of both sides from the point next to the center are the same.
            let middle = dot(surface.sphere.xyz - ray.origin, ray.direction);
            let far = 2.0 * middle - met.t;
            if number == 0 && surface.sphere.w > 0.0 && met.t < middle && far < limit {
                count = 2;
                met.t = far;
            }
#endif
        }
#else
        share = 1.0;
#endif
    }
    return share;
}

#if BLENDS
fn is_null_part(run: PartRun, index: u32) -> bool {
    let material = part_material(run, index);
    return (bitcast<u32>(tables[material * MATERIAL_WORDS].w) & 255u) == NULL_SURFACES;
}

// The weights of all null parts of a surface's material, seen along `wo`.
fn null_weight(surface: Surface, wo: vec3<f32>) -> f32 {
    let cosine = clamp(dot(wo, surface.shading_normal), 0.0, 1.0);
    let run = part_run(surface.material);
    var sum = 0.0;
    for (var index = 0u; index < run.count; index++) {
        if is_null_part(run, index) {
            sum += weighted_part(run, index, cosine, surface.uv).weight;
        }
    }
    return min(sum, 1.0);
}
#endif
