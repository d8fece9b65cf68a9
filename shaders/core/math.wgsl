// Small mathematics that every kernel shares.
#import core/layout.wgsl
#export core/spectrum.wgsl

const PI: f32 = 3.14159265358979323846;
const INVERSE_PI: f32 = 0.31830988618379067154;
const TWO_PI: f32 = 6.28318530717958647692;
const INFINITY_DISTANCE: f32 = 3.0e38;

fn max_coordinate(v: vec3<f32>) -> f32 {
    return max(v.x, max(v.y, v.z));
}

// WGSL lets a compiler assume that NaN and infinity never happen; their bit patterns can still be told.
fn is_finite(x: f32) -> bool {
    return (bitcast<u32>(x) & 0x7f800000u) != 0x7f800000u;
}

// Sine and cosine of `turns` whole turns, turns in [0, 1]: the same accuracy (1e-7) on every driver, which the built-in
// functions do not promise.
fn sin_cos_turns(turns: f32) -> vec2<f32> {
    let quarter = round(turns * 4.0);
    let x = (turns - quarter * 0.25) * TWO_PI;
    let x2 = x * x;
    let sine = x * (1.0 + x2 * (-1.6666667e-1 + x2 * (8.3333333e-3 + x2 * (-1.9841270e-4 + x2 * 2.7557319e-6))));
    let cosine = 1.0 + x2 * (-0.5 + x2 * (4.1666667e-2 + x2 * (-1.3888889e-3 + x2 * 2.4801587e-5)));
    let q = u32(quarter) & 3u;
    let swapped = select(vec2<f32>(sine, cosine), vec2<f32>(cosine, sine), (q & 1u) == 1u);
    let signs = vec2<f32>(select(1.0, -1.0, q >= 2u), select(1.0, -1.0, q == 1u || q == 2u));
    return swapped * signs;
}

// atan2(y, x) in whole turns, (-1/2, 1/2], by a polynomial on [0, tan π/8]: the same accuracy (1e-7) on every driver.
fn atan2_turns(y: f32, x: f32) -> f32 {
    let larger = max(abs(x), abs(y));
    if larger == 0.0 {
        return 0.0;
    }
    let smaller = min(abs(x), abs(y));
    let beyond = smaller > 0.41421356 * larger;
    let t = select(smaller / larger, (smaller - larger) / (smaller + larger), beyond);
    let t2 = t * t;
    let arc = t + t * t2 * (-3.33329491539e-1 + t2 * (1.99777106478e-1 + t2 * (-1.38776856032e-1 + t2 * 8.05374449538e-2)));
    var turns = arc / TWO_PI + select(0.0, 0.125, beyond);
    turns = select(turns, 0.25 - turns, abs(y) > abs(x));
    turns = select(turns, 0.5 - turns, x < 0.0);
    return select(turns, -turns, y < 0.0);
}

// The natural logarithm of a normal number above 0: the same accuracy (1e-7) on every driver.
fn natural_log(x: f32) -> f32 {
    let bits = bitcast<u32>(x);
    // A power of 2, and a factor from sqrt(1/2) to sqrt(2).
    let exponent = i32((bits - 0x3f3504f3u) & 0xff800000u) >> 23u;
    let factor = bitcast<f32>(bits - (u32(exponent) << 23u));
    let s = (factor - 1.0) / (factor + 1.0);
    let s2 = s * s;
    let log_of_factor = 2.0 * s * (1.0 + s2 * (0.33333333 + s2 * (0.2 + s2 * (0.14285714 + s2 * 0.11111111))));
    return f32(exponent) * 0.69314718 + log_of_factor;
}

// The cube root of a number above 0.
fn cube_root(x: f32) -> f32 {
    let near = exp(natural_log(x) / 3.0);
    // A step of Newton's method.
    return near - (near - x / (near * near)) / 3.0;
}

struct Frame {
    tangent: vec3<f32>,
    bitangent: vec3<f32>,
    normal: vec3<f32>,
}

// Orthonormal basis around a unit normal (Duff et al. 2017). The sign changes at z = -0.2137, not at 0, so that normals with
// z = +0 and -0 get the same basis in f32 and f64.
fn frame_from_normal(n: vec3<f32>) -> Frame {
    let s = select(1.0, -1.0, n.z < -0.2137);
    let a = -1.0 / (s + n.z);
    let b = n.x * n.y * a;
    return Frame(vec3<f32>(1.0 + s * n.x * n.x * a, s * b, -s * n.x), vec3<f32>(b, s + n.y * n.y * a, -n.y), n);
}

// About a unit normal, x along what of `tangent` is perpendicular to it; any frame where nothing is.
fn frame_along(n: vec3<f32>, tangent: vec3<f32>) -> Frame {
    let along = tangent - n * dot(n, tangent);
    if dot(along, along) == 0.0 {
        return frame_from_normal(n);
    }
    let unit = normalize(along);
    return Frame(unit, cross(n, unit), n);
}

fn frame_to_world(frame: Frame, local: vec3<f32>) -> vec3<f32> {
    return frame.tangent * local.x + frame.bitangent * local.y + frame.normal * local.z;
}

struct Ray {
    origin: vec3<f32>,
    direction: vec3<f32>,
}

// The closest hit of a ray: `primitive` is NONE where there is none. (u, v) are barycentric coordinates of
// the second and third vertex, the coordinates along a quad's edges, and unused for other primitives.
struct Hit {
    t: f32,
    primitive: u32,
    u: f32,
    v: f32,
#if INSTANCES
    // The instance through which the primitive was hit, or NONE.
    instance: u32,
#endif
}

// A hit on a primitive of the world.
fn world_hit(t: f32, primitive: u32, u: f32, v: f32) -> Hit {
    return Hit(
        t, primitive, u, v
#if INSTANCES
        , NONE
#endif
    );
}

// Nothing is met before t_max.
fn no_hit(t_max: f32) -> Hit {
    return world_hit(t_max, NONE, 0.0, 0.0);
}
