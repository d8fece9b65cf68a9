// A stack of layers at one hit: where its interfaces and slabs are, and how each interface lies. src/reference/layered/stack.rs is the same in f64.
// Gaps are counted from the outside above, 0: gap i lies above interface i, and the one below the last interface is the outside again.
#import core/layout.wgsl
#import core/math.wgsl
#import geometry/scene.wgsl
#import shading/surface.wgsl
#import shading/material/lobe.wgsl
#import geometry/shape_point.wgsl
#import shading/texture/tangent_space.wgsl
#import shading/texture/texture.wgsl

// The smallest cosine with the normal by which a way through a slab is measured.
const SMALLEST_LAYER_COSINE: f32 = 1.0e-6;

struct Stack {
    first: u32,
    count: u32,
    // The largest breadth of all interfaces and slabs.
    most_breadth: f32,
    flags: u32,
    // The normal on the side of the first interface.
    up: vec3<f32>,
}

// An interface, and the slab below it.
struct LayerInterface {
    material: u32,
    breadth: f32,
    ior: f32,
}

struct Slab {
    flags: u32,
    extinction: Spectrum,
    scattering: Spectrum,
    thickness: f32,
    breadth: f32,
    phase: u32,
}

fn is_stack(material: u32) -> bool {
    return (bitcast<u32>(tables[material * MATERIAL_WORDS].w) & 255u) == LAYERED;
}

fn stack_at(material: u32, surface: Surface) -> Stack {
    let run = tables[material * MATERIAL_WORDS + 1u];
    let flags = bitcast<u32>(run.y);
    let is_above = surface.front || (flags & LAYERS_MIRRORED) != 0u;
    return Stack(bitcast<u32>(run.x), flags & 0xffffu, run.w, flags, select(-surface.shading_normal, surface.shading_normal, is_above));
}

fn layer_word(stack: Stack, number: u32, word: u32) -> vec4<f32> {
    return tables[FIRST_LAYER_WORD + (stack.first + number) * LAYER_WORDS + word];
}

fn layer_interface(stack: Stack, number: u32) -> LayerInterface {
    let word = layer_word(stack, number, 0u);
    return LayerInterface(bitcast<u32>(word.x), word.y, word.z);
}

// The slab in a gap; without flags where nothing takes or scatters light there.
fn slab_in(stack: Stack, surface: Surface, gap: u32) -> Slab {
    var slab: Slab;
    if HAS_SLABS && gap > 0u {
        slab.flags = bitcast<u32>(layer_word(stack, gap - 1u, 0u).w);
        if slab.flags != 0u {
            let extinction = layer_word(stack, gap - 1u, 1u);
            let scattering = layer_word(stack, gap - 1u, 2u);
            let rest = layer_word(stack, gap - 1u, 3u);
            slab.extinction = extinction.xyz;
            slab.scattering = scattering.xyz;
            slab.thickness = material_color(Spectrum(extinction.w), rest.x, surface.uv).x;
            slab.breadth = select(0.0, scattering.w, slab.thickness > 0.0);
            slab.phase = bitcast<u32>(rest.y);
        }
    }
    return slab;
}

// The gap from which a direction that points away from the surface comes.
fn gap_outside(stack: Stack, direction: vec3<f32>) -> u32 {
    return select(stack.count, 0u, dot(direction, stack.up) > 0.0);
}

// The interface that light meets which goes through a gap in a direction; NONE where it goes to the outside.
fn interface_ahead(stack: Stack, gap: u32, direction: vec3<f32>) -> u32 {
    if dot(direction, stack.up) < 0.0 {
        return select(NONE, gap, gap < stack.count);
    }
    return select(NONE, gap - 1u, gap > 0u);
}

// The normal of an interface on its upper side, as its own map bends it.
fn interface_normal(stack: Stack, surface: Surface, material: u32) -> vec3<f32> {
#if BENT_LAYERS
    let texture = bitcast<u32>(tables[material * MATERIAL_WORDS + 4u].y);
    if texture != NONE {
        var local = texture_color(texture, surface.uv) * 2.0 - 1.0;
        if HAS_NORMAL_SCALES {
            local = vec3<f32>(local.xy * texture_word(texture, 2u).w, local.z);
        }
        let mapped = from_tangent_space(stack.up, Tangents(surface.along_u, surface.along_v), local);
        return select(mapped, stack.up, dot(mapped, mapped) == 0.0);
    }
#endif
    return stack.up;
}

// An interface as a way through the stack sees it that carries this much, from wo.
fn interface_surface(stack: Stack, surface: Surface, number: u32, wo: vec3<f32>, carried: Spectrum) -> Surface {
    var seen = surface;
    seen.material = layer_interface(stack, number).material;
    seen.light = NONE;
    seen.front = dot(wo, stack.up) > 0.0;
    seen.facing_normal = select(-stack.up, stack.up, seen.front);
    seen.shading_normal = shading_normal_towards(interface_normal(stack, surface, seen.material), seen.facing_normal, wo);
    seen.by_camera = false;
    seen.unperturbed_normal = vec3<f32>(0.0);
    seen.coat_normal = stack.up;
#if CARRIED_LIGHT
    seen.carried = carried;
#endif
    return seen;
}
