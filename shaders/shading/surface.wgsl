// What a hit is: position, normals, texture coordinates, material.
#import core/layout.wgsl
#import core/math.wgsl
#import geometry/records.wgsl
#import geometry/scene.wgsl
#import shading/texture/coordinates.wgsl
#import shading/material/seen.wgsl
#import shading/shapes.wgsl
#import geometry/instance.wgsl
#import shading/shape/triangle.wgsl
#import shading/shape_point.wgsl
#import shading/texture/attributes.wgsl
#import shading/texture/tangents.wgsl
#import geometry/placed.wgsl
#import shading/texture/normal_map.wgsl
#import shading/texture/normal_shadowing.wgsl

struct Surface {
    position: vec3<f32>,
    // The geometric normal on wo's side.
    facing_normal: vec3<f32>,
    // The shading normal on wo's side.
    shading_normal: vec3<f32>,
    uv: TextureCoordinates,
    // wo is on the side where the normal points.
    front: bool,
#if WEIGHTS_BY_VIEWER
    // A ray of the camera met it that nothing has scattered.
    by_camera: bool,
#endif
    // How far along its normal the true surface can lie from `position`.
    error: f32,
    material: u32,
    // Index of the light that this primitive is, or NONE.
    light: u32,
    // For densities of light sampling: area, or 0 for a sphere; center and radius of a sphere.
    area: f32,
    sphere: vec4<f32>,
#if TANGENTS
    // The directions in which texture coordinates grow, of any length; 0 where there are none.
    along_u: vec3<f32>,
    along_v: vec3<f32>,
#endif
#if NORMAL_SHADOWING
    // The shading normal before a map bent it, where it shadows the bent one; else 0.
    unbent_normal: vec3<f32>,
#endif
#if COAT_NORMALS
    // The shading normal before a map bent it, on the front side and of any length.
    coat_normal: vec3<f32>,
#if SECOND_UVS
    // The directions in which second texture coordinates grow; of what has one set, those of that.
    second_along_u: vec3<f32>,
    second_along_v: vec3<f32>,
#endif
#endif
}

// How it is seen along `wo`.
fn seen_along(surface: Surface, wo: vec3<f32>) -> Seen {
    var seen = seen_by_light(clamp(dot(wo, surface.shading_normal), 0.0, 1.0), surface.front);
#if WEIGHTS_BY_VIEWER
    seen.by_camera = surface.by_camera;
#endif
    return seen;
}

// An interpolated or mapped normal on wo's side; the facing normal where there is none or wo is below its horizon.
fn shading_normal_towards(interpolated: vec3<f32>, facing_normal: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {
    if dot(interpolated, interpolated) == 0.0 {
        return facing_normal;
    }
    let unit = normalize(interpolated);
    let shading_normal = select(-unit, unit, dot(unit, facing_normal) > 0.0);
    return select(facing_normal, shading_normal, dot(shading_normal, wo) > 0.0);
}

// The material of what a ray met.
fn hit_material(hit: Hit) -> u32 {
#if INSTANCES
    if hit.instance != NONE {
        let replacement = bitcast<u32>(instance_word(hit.instance, 1u).w);
        if replacement != NONE {
            return replacement;
        }
    }
#endif
    return primitive_material(primitive_word(hit.primitive, 0u).w);
}

fn hit_surface(ray: Ray, hit: Hit) -> Surface {
#if MOTION
    let placed = placed_primitive(primitive_words(hit.primitive));
    let words = PrimitiveWords(placed.p0, placed.p1, placed.p2);
#else
    let words = primitive_words(hit.primitive);
#endif
    let kind = primitive_kind(words.w0.w);
    let wo = -ray.direction;
#if INSTANCES
    let p0 = words.w0;
    let p1 = words.w1;
    let p2 = words.w2;
    var material = primitive_material(p0.w);
    let placement = instance_placement(hit.instance);
    var magnitude = vec3<f32>(0.0);
    var point: ShapePoint;
    if placement.exists {
        // Groups consist of triangles. Their edges are placed by themselves: the difference of placed vertices has lost digits.
        magnitude = placed_magnitude(placement, max(abs(p0.xyz), max(abs(p1.xyz), abs(p2.xyz))));
        let edge_u = placed_vector(placement, p1.xyz - p0.xyz);
        point = triangle_point_by_edges(hit, placed_point(placement, p0.xyz), edge_u, placed_vector(placement, p2.xyz - p0.xyz));
        if placement.mirrored {
            // Fronts stay on the side on which they are in the group.
            point.normal = -point.normal;
        }
        if placement.material != NONE {
            material = placement.material;
        }
    } else {
        point = shape_point(kind, ray, hit, p0.xyz, p1.xyz, p2.xyz);
    }
#else
    let p0 = words.w0;
    let p1 = words.w1;
    let p2 = words.w2;
    let material = primitive_material(p0.w);
    let point = shape_point(kind, ray, hit, p0.xyz, p1.xyz, p2.xyz);
#endif
    let normal = point.normal;
    var size = point.size;
    var uv = point.uv;
    var sphere = vec4<f32>(0.0);
#if SPHERES
    if kind == KIND_SPHERE {
        sphere = vec4<f32>(p0.xyz, p1.x);
    }
#endif

    let front = dot(wo, normal) > 0.0;
    let facing_normal = select(-normal, normal, front);
    // 0: the geometric normal.
    var own_normal = vec3<f32>(0.0);
#if ATTRIBUTES
    let first = bitcast<u32>(p2.w);
    if first != NONE {
#if INSTANCES
        var looked_up: Attribute;
        if placement.exists {
            looked_up = interpolate_in_instance(placement, first, uv);
        } else {
            looked_up = shape_attribute(kind, first, uv, normal);
        }
#else
        let looked_up = shape_attribute(kind, first, uv, normal);
#endif
        uv = looked_up.uv;
        own_normal = looked_up.normal;
    }
#endif
#if ATTRIBUTES
    let coordinates = texture_coordinates(kind, first, uv, point.uv);
#else
    let coordinates = only_coordinates(uv);
#endif
#if NORMAL_SHADOWING
    var unbent_normal = vec3<f32>(0.0);
    if shadows_bent_normals(material) {
        unbent_normal = shading_normal_towards(own_normal, facing_normal, wo);
    }
#endif
#if COAT_NORMALS
    let coat_normal = select(own_normal, normal, dot(own_normal, own_normal) == 0.0);
#endif
#if NORMAL_MAPS
    own_normal = mapped_normal(material, kind, bitcast<u32>(p2.w), own_normal, point, coordinates);
#endif
#if NORMAL_MIRRORING
    var shading_normal = shading_normal_towards(own_normal, facing_normal, wo);
    if mirrors_bent_normals(material) {
        shading_normal = mirrored_normal_towards(own_normal, unbent_normal, facing_normal, wo);
    }
#else
    let shading_normal = shading_normal_towards(own_normal, facing_normal, wo);
#endif
#if MOTION
    size += placed.magnitude;
#endif
#if INSTANCES
    size += magnitude;
#endif
#if TANGENTS
    let tangents = shape_tangents(kind, bitcast<u32>(p2.w), point);
#endif
#if COAT_NORMALS
#if SECOND_UVS
    let second_tangents = tangents_of_set(kind, bitcast<u32>(p2.w), point, true);
#endif
#endif
    return Surface(
        point.position, facing_normal, shading_normal, coordinates, front,
#if WEIGHTS_BY_VIEWER
        false,
#endif
        POINT_ERROR * dot(abs(facing_normal), size) + point.error,
        material, bitcast<u32>(p1.w), point.area, sphere
#if TANGENTS
        , tangents.along_u, tangents.along_v
#endif
#if NORMAL_SHADOWING
        , unbent_normal
#endif
#if COAT_NORMALS
        , coat_normal
#if SECOND_UVS
        , second_tangents.along_u, second_tangents.along_v
#endif
#endif
    );
}

// The surface point moved off the surface to the side of `toward`, past its error.
fn offset_origin(surface: Surface, toward: vec3<f32>) -> vec3<f32> {
    let side = select(-surface.error, surface.error, dot(toward, surface.facing_normal) > 0.0);
    return surface.position + side * surface.facing_normal;
}
