// The media that a ray is in, within the surfaces that enclose them. src/reference/medium.rs is the same in f64.
#import core/layout.wgsl
#import core/math.wgsl
#import geometry/scene.wgsl
#import shading/surface.wgsl

// The numbers of the media that a ray is in, 16 bits each, from the lower half of x up to the upper half of y: the innermost is the one that was
// entered last. 0 stands for none. A fifth one within the others makes the outermost forgotten.
alias MediumStack = vec2<u32>;

fn around_camera() -> MediumStack {
    return MediumStack(CAMERA_MEDIUM, 0u);
}

fn innermost(media: MediumStack) -> u32 {
    return media.x & 0xffffu;
}

fn enter_medium(media: MediumStack, medium: u32) -> MediumStack {
    return MediumStack((media.x << 16u) | medium, (media.y << 16u) | (media.x >> 16u));
}

// Takes out a medium at its innermost place; those around it move inwards. Media that a ray began in are on no stack.
fn leave_medium(media: MediumStack, medium: u32) -> MediumStack {
    let first = media.x & 0xffffu;
    let second = media.x >> 16u;
    let third = media.y & 0xffffu;
    let fourth = media.y >> 16u;
    if first == medium {
        return MediumStack(second | (third << 16u), fourth);
    }
    if second == medium {
        return MediumStack(first | (third << 16u), fourth);
    }
    if third == medium {
        return MediumStack(media.x, fourth);
    }
    return MediumStack(media.x, select(media.y, third, fourth == medium));
}

// The way along a ray from the surface that it left to its origin, which lies a little above: light loses some there too.
fn way_before(surface: Surface, ray: Ray) -> f32 {
    return max(dot(ray.origin - surface.position, ray.direction), 0.0);
}

// The media on the side of a surface that `toward` points to, given those on wo's side.
fn media_towards(surface: Surface, toward: vec3<f32>, here: MediumStack) -> MediumStack {
    if is_within_medium(surface) {
        return here;
    }
    let inside = bitcast<u32>(tables[surface.material * MATERIAL_WORDS + 2u].w) >> MEDIUM_SHIFT;
    if inside == 0u || dot(toward, surface.facing_normal) > 0.0 {
        return here;
    }
    if surface.front {
        return enter_medium(here, inside);
    }
    return leave_medium(here, inside);
}

// Rays that go straight on through a surface of the material enter its medium or leave it.
fn is_open_boundary(material: u32) -> bool {
    return (bitcast<u32>(tables[material * MATERIAL_WORDS + 2u].w) & OPEN_BOUNDARY) != 0u;
}
