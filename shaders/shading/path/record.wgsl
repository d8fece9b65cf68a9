// A path on its way, and the outcome of one of its vertices.
#import core/layout.wgsl
#import core/math.wgsl
#import shading/path/scatterer.wgsl
#import shading/material/scattering.wgsl
#import shading/surface.wgsl
#import shading/cell_grid.wgsl
#import shading/medium/medium.wgsl
#import shading/medium/stack.wgsl

struct Path {
    ray: Ray,
    throughput: Spectrum,
    // Density of the ray's direction by solid angle; negative after the camera or a delta lobe.
    pdf_solid_angle: f32,
    // The factor by which Russian roulette scales throughputs: the squared index ratios of all refractions so far. A guided path has one over what
    // it was expected to bring at its first guided surface, and 0 before.
    roulette_scale: f32,
    // Pixel over the whole film, and the sample's index within the pass.
    pixel: u32,
    sample_in_pass: u32,
    // Vertices at null surfaces so far.
    null_vertices: u32,
    // With LIGHT_CELLS, the way that the surface faces from which light was last sampled, as normal_facing says.
    reference_facing: u32,
    // With TRANSPARENT_SHADOWS, the reference point of the last light sample: the origin of the ray that went on through the null surfaces last met.
    reference_point: vec3<f32>,
#if LIGHT_LINKS
    // The receiver of the surface or place from which light was last sampled, which only lamps light that are linked to it.
    receiver: u32,
#endif
#if MEDIA
    // The media around the ray.
    media: MediumStack,
    // The way through them from the surface that the ray left to its origin, which lies a little above.
    way_before: f32,
#endif
}

struct ShadowRay {
    ray: Ray,
    distance: f32,
    // The radiance that the path gains if nothing is in the way; all 0: there is no shadow ray.
    radiance: Spectrum,
#if OPEN_BOUNDARIES
    // The media around its origin.
    media: MediumStack,
    // With MEDIUM_GRIDS, the key of the random numbers by which they are passed.
    key: u32,
#endif
}

// The start of light samples of a vertex.
struct ShadedVertex {
    // The path as it arrived there.
    path: Path,
    vertex: u32,
    surface: Surface,
    scatterer: Scatterer,
}

// The outcome of a vertex.
struct Shading {
    // The path goes on along its new ray.
    alive: bool,
    // Radiance found at this vertex, already times throughput and weight.
    radiance: Spectrum,
    // How many light samples are taken here; the first one's shadow ray; what further_shadow_ray makes the others of.
    light_samples: u32,
    shadow: ShadowRay,
    shaded: ShadedVertex,
}

// A path on its first edge.
fn new_path(ray: Ray, pixel: u32, sample_in_pass: u32) -> Path {
    var path: Path;
    path.ray = ray;
    path.throughput = WHITE;
    path.pdf_solid_angle = -1.0;
    path.roulette_scale = select(1.0, 0.0, HAS_GUIDE);
    path.pixel = pixel;
    path.sample_in_pass = sample_in_pass;
    path.reference_point = ray.origin;
#if LIGHT_LINKS
    path.receiver = SEES_ALL_LAMPS;
#endif
    if HAS_MEDIA {
        path.media = around_camera();
    }
    return path;
}

// The camera sees nothing where this path begins.
fn is_blind(path: Path, vertex: u32) -> bool {
    if HAS_BLIND_PIXELS {
        return vertex == 1u && all(path.throughput == BLACK);
    } else {
        return false;
    }
}

// The path's ray from where light was last sampled: shadow rays from there meet the same surfaces as the path, and go on through null ones
// as it does. So what both find is shared out by the densities that they have there.
fn ray_from_reference_point(path: Path) -> Ray {
    if HAS_TRANSPARENT_SHADOWS {
        return Ray(path.reference_point, path.ray.direction);
    } else {
        return path.ray;
    }
}

// The way that a surface faces, where the choice of lights depends on that; else 0.
fn facing_of(surface: Surface) -> u32 {
    if HAS_LIGHT_CELLS {
        return normal_facing(surface.facing_normal);
    } else {
        return 0u;
    }
}

// The way that the surface faces from which light was last sampled; else 0.
fn facing_at_reference_point(path: Path) -> u32 {
    if HAS_LIGHT_CELLS {
        return path.reference_facing;
    } else {
        return 0u;
    }
}

fn no_shadow_ray() -> ShadowRay {
    var none: ShadowRay;
    none.ray.direction = vec3<f32>(0.0, 0.0, 1.0);
    return none;
}

// True where the path may gain anything from the shadow ray.
fn is_needed(shadow: ShadowRay) -> bool {
    return any(shadow.radiance != BLACK);
}

fn no_shading() -> Shading {
    var shading: Shading;
    shading.shadow = no_shadow_ray();
    return shading;
}

// Depth of the path's ray that ends at this vertex.
fn depth_at(path: Path, vertex: u32) -> u32 {
    return vertex - select(0u, path.null_vertices, HAS_NULL_SURFACES);
}

// How many light samples a surface takes that a ray of this depth met.
fn light_samples_at(depth: u32) -> u32 {
    return select(1u, LIGHT_SAMPLES, depth >= 1u && depth <= LIGHT_SAMPLES_DEPTH);
}

// The path's throughput at the end of its ray, of this length.
fn arriving_throughput(path: Path, ray_length: f32) -> Spectrum {
    if HAS_MEDIA {
        return path.throughput * medium_transmittance(innermost(path.media), ray_length);
    } else {
        return path.throughput;
    }
}

// The path along the ray that was drawn where it met a surface.
fn extended_path(incoming: Path, surface: Surface, drawn: BsdfSample, throughput: Spectrum, roulette_scale: f32) -> Path {
    var path = incoming;
    path.ray = Ray(offset_origin(surface, drawn.wi), drawn.wi);
    path.throughput = throughput;
    path.pdf_solid_angle = drawn.pdf_solid_angle;
    path.roulette_scale = roulette_scale;
    path.null_vertices += select(0u, 1u, drawn.is_null);
    if HAS_LIGHT_CELLS {
        path.reference_facing = select(facing_of(surface), incoming.reference_facing, drawn.is_null);
    }
#if LIGHT_LINKS
    path.receiver = select(surface.receiver, incoming.receiver, drawn.is_null);
#endif
    if HAS_TRANSPARENT_SHADOWS {
        // Through a null surface goes the ray that was drawn before.
        path.pdf_solid_angle = select(drawn.pdf_solid_angle, incoming.pdf_solid_angle, drawn.is_null);
        path.reference_point = select(path.ray.origin, incoming.reference_point, drawn.is_null);
    }
    if HAS_MEDIA {
        path.way_before = way_before(surface, path.ray);
    }
    if HAS_MEDIA && (!drawn.is_null || (HAS_OPEN_BOUNDARIES && is_open_boundary(surface.material))) {
        path.media = media_towards(surface, drawn.wi, incoming.media);
    }
    return path;
}
