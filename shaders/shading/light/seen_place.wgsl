// Flat lights whose points are drawn by solid angle where it is large enough.
#import core/layout.wgsl
#import shading/light/record.wgsl
#import shading/light/seen_rectangle.wgsl
#import shading/light/seen_triangle.wgsl

struct SeenPlace {
    // Numbers by which the shape's own file samples the point.
    numbers: vec2<f32>,
    // Solid angle, in steradians; 0 where the point is sampled by area.
    solid_angle: f32,
}

// Draws a place on a light that is seen from `reference`.
fn draw_seen_place(light: u32, kind_flags: u32, reference: vec3<f32>, u: f32, v: f32) -> SeenPlace {
    var place = SeenPlace(vec2<f32>(u, v), 0.0);
    if (kind_flags & LIGHT_BY_SOLID_ANGLE) == 0u {
        return place;
    }
    let corner = light_word(light, 1u).xyz;
    let edge_u = light_word(light, 2u).xyz;
    let edge_v = light_word(light, 3u).xyz;
    if HAS_TRIANGLES_BY_SOLID_ANGLE && (kind_flags & 255u) == KIND_TRIANGLE {
        let seen = see_triangle(reference, corner, edge_u, edge_v);
        if seen.solid_angle > 0.0 {
            place = SeenPlace(triangle_numbers(seen, edge_u, edge_v, u, v), seen.solid_angle);
        }
        return place;
    }
#if RECTANGLES_BY_SOLID_ANGLE
    let seen = see_rectangle(reference, corner, edge_u, edge_v);
    if seen.solid_angle > 0.0 {
        place = SeenPlace(rectangle_place(seen, u, v), seen.solid_angle);
    }
#endif
    return place;
}

// The solid angle that points of a light are drawn by; 0 where they are drawn by area.
fn drawn_solid_angle(light: u32, reference: vec3<f32>) -> f32 {
    let kind_flags = bitcast<u32>(light_word(light, 0u).x);
    if (kind_flags & LIGHT_BY_SOLID_ANGLE) == 0u {
        return 0.0;
    }
    let corner = light_word(light, 1u).xyz;
    let edge_u = light_word(light, 2u).xyz;
    let edge_v = light_word(light, 3u).xyz;
    if HAS_TRIANGLES_BY_SOLID_ANGLE && (kind_flags & 255u) == KIND_TRIANGLE {
        return see_triangle(reference, corner, edge_u, edge_v).solid_angle;
    }
    if HAS_RECTANGLES_BY_SOLID_ANGLE {
        return see_rectangle(reference, corner, edge_u, edge_v).solid_angle;
    } else {
        return 0.0;
    }
}
