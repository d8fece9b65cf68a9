// The surface at a hit: position, normals, texture coordinates, material.
#import core/layout.wgsl
#import core/math.wgsl
#import core/spectrum.wgsl
#import geometry/records.wgsl
#import geometry/scene.wgsl
#import shading/texture/coordinates.wgsl
#import shading/material/seen.wgsl
#import shading/shapes.wgsl
#import geometry/instance.wgsl
#import geometry/shape/triangle.wgsl
#import geometry/shape_point.wgsl
#import shading/texture/attributes.wgsl
#import shading/texture/tangents.wgsl
#import geometry/placed.wgsl
#import shading/texture/normal_map.wgsl
#import shading/texture/normal_shadowing.wgsl
#if LIGHT_LINKS
#import shading/light/links.wgsl
#endif

struct Surface {
    position: vec3<f32>,
    // The geometric normal on wo's side.
    facing_normal: vec3<f32>,
    // The shading normal on wo's side.
    shading_normal: vec3<f32>,
    uv: TextureCoordinates,
    // wo is on the side to which the normal points.
    front: bool,
    // A ray of the camera met it that nothing has scattered.
    by_camera: bool,
    // How far along its normal the true surface can lie from `position`.
    error: f32,
    material: u32,
    // Index of the light that this primitive is, or NONE.
    light: u32,
    // For densities of light sampling: area, or 0 for a sphere; center and radius of a sphere.
    area: f32,
    sphere: vec4<f32>,
    // The directions in which texture coordinates grow, of any length, with TANGENTS; 0 where there are none.
    along_u: vec3<f32>,
    along_v: vec3<f32>,
    // With NORMAL_SHADOWING, the shading normal before a map perturbed it, if it shadows the perturbed one; else 0.
    unperturbed_normal: vec3<f32>,
    // With COAT_NORMALS, the shading normal before a map perturbed it, on the front side and of any length.
    coat_normal: vec3<f32>,
    // With COAT_NORMALS and SECOND_UVS, the directions in which second texture coordinates grow; those of the first where there is one set.
    second_along_u: vec3<f32>,
    second_along_v: vec3<f32>,
#if LIGHT_LINKS
    // The receiver that it is, or that a place within a medium is.
    receiver: u32,
#endif
#if CARRIED_LIGHT
    // The throughput of the path that arrives.
    carried: Spectrum,
#endif
}

// How a surface is seen along `wo`.
fn seen_along(surface: Surface, wo: vec3<f32>) -> Seen {
    return Seen(
        clamp(dot(wo, surface.shading_normal), 0.0, 1.0), surface.front, surface.by_camera
#if WEIGHTS_BY_DIRECTION
        , surface.shading_normal
#endif
    );
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

// The material of the primitive that a ray met.
fn hit_material(hit: Hit) -> u32 {
    if HAS_INSTANCES && hit.instance != NONE {
        let replacement = bitcast<u32>(instance_word(hit.instance, 1u).w);
        if replacement != NONE {
            return replacement;
        }
    }
    return primitive_material(primitive_word(hit.primitive, 0u).w);
}

// A place within a medium, at which a ray arrives: as a surface it faces wo, and nothing keeps rays from leaving it.
fn medium_surface(ray: Ray, distance: f32) -> Surface {
    var surface: Surface;
    surface.position = ray.origin + distance * ray.direction;
    surface.facing_normal = -ray.direction;
    surface.shading_normal = -ray.direction;
    surface.front = true;
    surface.material = NONE;
    surface.light = NONE;
    return surface;
}

// True of such a place.
fn is_within_medium(surface: Surface) -> bool {
    return HAS_SCATTERING && surface.material == NONE;
}

fn hit_surface(ray: Ray, hit: Hit) -> Surface {
    let wo = -ray.direction;
    var words = primitive_words(hit.primitive);
    // The coordinates that rounding of the point is relative to, beyond the shape's own.
    var moved = vec3<f32>(0.0);
    if HAS_MOTION {
        let placed = placed_primitive(words);
        words = PrimitiveWords(placed.p0, placed.p1, placed.p2);
        moved = placed.magnitude;
    }
    let p0 = words.w0;
    let p1 = words.w1;
    let p2 = words.w2;
    let kind = primitive_kind(p0.w);
    let first = bitcast<u32>(p2.w);
    var surface: Surface;
    surface.material = primitive_material(p0.w);
    surface.light = bitcast<u32>(p1.w);

    // The point of the shape.
    var point: ShapePoint;
    var placement = no_placement();
    if HAS_INSTANCES {
        placement = instance_placement(hit.instance);
    }
    if HAS_INSTANCES && placement.exists {
        // Groups consist of triangles. Their edges are placed by themselves: the difference of placed vertices has lost digits.
        moved += placed_magnitude(placement, max(abs(p0.xyz), max(abs(p1.xyz), abs(p2.xyz))));
        let edge_u = placed_vector(placement, p1.xyz - p0.xyz);
        point = triangle_point_by_edges(hit, placed_point(placement, p0.xyz), edge_u, placed_vector(placement, p2.xyz - p0.xyz));
        if placement.mirrored {
            // Fronts stay on the side on which they are in the group.
            point.normal = -point.normal;
        }
        if placement.material != NONE {
            surface.material = placement.material;
        }
    } else {
        point = shape_point(kind, ray, hit, p0.xyz, p1.xyz, p2.xyz);
    }
#if LIGHT_LINKS
    surface.receiver = receiver_of_material(primitive_material(p0.w));
#if INSTANCES
    if placement.exists {
        surface.receiver = receiver_of_instance(hit.instance);
    }
#endif
#endif
    surface.position = point.position;
    surface.area = point.area;
    if HAS_SPHERES && kind == KIND_SPHERE {
        surface.sphere = vec4<f32>(p0.xyz, p1.x);
    }
    surface.front = dot(wo, point.normal) > 0.0;
    surface.facing_normal = select(-point.normal, point.normal, surface.front);
    surface.error = POINT_ERROR * dot(abs(surface.facing_normal), point.size + moved) + point.error;

    // Normal interpolated from the vertices: 0 stands for the geometric normal.
    var own_normal = vec3<f32>(0.0);
    surface.uv = only_coordinates(point.uv);
    if HAS_ATTRIBUTES {
        var uv = point.uv;
        if first != NONE {
            var looked_up: Attribute;
            if HAS_INSTANCES && placement.exists {
                looked_up = interpolate_in_instance(placement, first, uv);
            } else {
                looked_up = shape_attribute(kind, first, uv, point.normal);
            }
            uv = looked_up.uv;
            own_normal = looked_up.normal;
        }
        surface.uv = texture_coordinates(kind, first, uv, point.uv);
    }

    // The shading normal, and what it was before a map perturbed it.
    if HAS_NORMAL_SHADOWING && shadows_perturbed_normals(surface.material) {
        surface.unperturbed_normal = shading_normal_towards(own_normal, surface.facing_normal, wo);
    }
    if HAS_COAT_NORMALS {
        surface.coat_normal = select(own_normal, point.normal, dot(own_normal, own_normal) == 0.0);
    }
    if HAS_NORMAL_MAPS {
        own_normal = mapped_normal(surface.material, kind, first, own_normal, point, surface.uv);
    }
    surface.shading_normal = shading_normal_towards(own_normal, surface.facing_normal, wo);
    if HAS_NORMAL_MIRRORING && mirrors_perturbed_normals(surface.material) {
        surface.shading_normal = mirrored_normal_towards(own_normal, surface.unperturbed_normal, surface.facing_normal, wo);
    }
    if HAS_TANGENTS {
        let tangents = shape_tangents(kind, first, point);
        surface.along_u = tangents.along_u;
        surface.along_v = tangents.along_v;
    }
    if HAS_COAT_NORMALS && HAS_SECOND_UVS {
        let tangents = tangents_of_set(kind, first, point, true);
        surface.second_along_u = tangents.along_u;
        surface.second_along_v = tangents.along_v;
    }
    return surface;
}

// The surface point moved off the surface to the side of `toward`, past its error.
fn offset_origin(surface: Surface, toward: vec3<f32>) -> vec3<f32> {
    let side = select(-surface.error, surface.error, dot(toward, surface.facing_normal) > 0.0);
    return surface.position + side * surface.facing_normal;
}
