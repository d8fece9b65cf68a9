// Films about as thin as the wavelengths of light; src/reference/bsdf/thin_film.rs has the model.
#import core/layout.wgsl
#import core/math.wgsl
#import shading/microfacet/thin_film_waves.wgsl

struct ThinFilm {
    // Micrometres; 0: there is none.
    thickness: f32,
    ior: f32,
}

// A film by its thickness in nanometres and by the other parameter of lobes: its index and what is added to the thickness.
fn thin_film_of(thickness: f32, film: vec3<f32>) -> ThinFilm {
    return ThinFilm(1.0e-3 * (thickness + film.y), film.x);
}

fn complex_product(a: vec2<f32>, b: vec2<f32>) -> vec2<f32> {
    return vec2<f32>(a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x);
}

fn complex_quotient(a: vec2<f32>, b: vec2<f32>) -> vec2<f32> {
    return vec2<f32>(a.x * b.x + a.y * b.y, a.y * b.x - a.x * b.y) / dot(b, b);
}

// The root without negative parts; the imaginary part of z is not negative.
fn complex_root(z: vec2<f32>) -> vec2<f32> {
    let larger = sqrt(0.5 * (length(z) + abs(z.x)));
    let smaller = select(0.0, 0.5 * z.y / max(larger, 1.0e-30), larger > 0.0);
    return select(vec2<f32>(smaller, larger), vec2<f32>(larger, smaller), z.x >= 0.0);
}

// The boundaries of a film for one polarization.
struct FilmBoundaries {
    mean: f32,
    swing: f32,
    to_and_fro: vec2<f32>,
}

fn film_boundaries(a: f32, b: f32, c: vec2<f32>, d: vec2<f32>) -> FilmBoundaries {
    let outer = (a - b) / (a + b);
    let reflected = outer * outer;
    let transmitted = 4.0 * (a / (a + b)) * (b / (a + b));
    let sum = c + d;
    let inner = complex_quotient(c - d, sum);
    let passed = max(4.0 * dot(c, d) / dot(sum, sum), 0.0);
    // 1 - R12 R23, with all its digits where both are near 1.
    let escaping = max(transmitted + reflected * passed, 1.0e-30);
    return FilmBoundaries(
        reflected + transmitted * (transmitted / escaping) * dot(inner, inner), 2.0 * passed * (transmitted / escaping), -outer * inner
    );
}

// The share of light that a channel reflects from outside over a base of index eta + ik.
fn film_reflectance(film: ThinFilm, channel: u32, cosine_outside: f32, eta: f32, k: f32) -> f32 {
    let cosine = clamp(cosine_outside, 1.0e-6, 1.0);
    let sine2 = (1.0 - cosine) * (1.0 + cosine);
    let index2 = film.ior * film.ior;
    let within = sqrt((film.ior - 1.0) * (film.ior + 1.0) + cosine * cosine);
    let base = vec2<f32>((eta - k) * (eta + k), 2.0 * eta * k);
    let below = complex_root(base - vec2<f32>(sine2, 0.0));
    let perpendicular = film_boundaries(cosine, within, vec2<f32>(within, 0.0), below);
    let parallel = film_boundaries(index2 * cosine, within, base * within, below * index2);
    let path = 2.0 * film.thickness * within;
    var interference = vec2<f32>(0.0);
    for (var index = first_film_wave(channel); index < first_film_wave(channel + 1u); index++) {
        let wave = film_wave(index);
        let width = PI * wave.z * path;
        let narrow = exp(-min(2.0 * width * width, 80.0));
        let turn = sin_cos_turns(fract(wave.y * path)).yx;
        // Each order turns by as much, and the part that is left of it is narrow^(m²).
        var left = narrow;
        var next = narrow * narrow * narrow;
        let step_s = complex_product(perpendicular.to_and_fro, turn);
        let step_p = complex_product(parallel.to_and_fro, turn);
        var power_s = step_s;
        var power_p = step_p;
        for (var order = 0u; order < MOST_FILM_ORDERS; order++) {
            if left * dot(abs(power_s) + abs(power_p), vec2<f32>(1.0)) < LEAST_FILM_ORDER {
                break;
            }
            interference += wave.x * left * vec2<f32>(power_s.x, power_p.x);
            power_s = complex_product(power_s, step_s);
            power_p = complex_product(power_p, step_p);
            left *= next;
            next *= narrow * narrow;
        }
    }
    let sum = perpendicular.mean - perpendicular.swing * interference.x + parallel.mean - parallel.swing * interference.y;
    return clamp(0.5 * sum, 0.0, 1.0);
}

// The reflectance of a film over a base by what its channels reflect along the normal without one.
fn film_reflectance_over(film: ThinFilm, cosine: f32, normal_incidence: Spectrum) -> Spectrum {
    let root = sqrt(min(normal_incidence, Spectrum(MOST_REFLECTED_BY_BASE)));
    let eta = (1.0 + root) / (1.0 - root);
    return film_reflectances(film, cosine, eta, BLACK);
}

// The reflectance of a film over a base of complex indices of refraction.
fn film_reflectances(film: ThinFilm, cosine: f32, eta: Spectrum, k: Spectrum) -> Spectrum {
    var reflected = BLACK;
    for (var channel = 0u; channel < 3u; channel++) {
        reflected[channel] = film_reflectance(film, channel, cosine, eta[channel], k[channel]);
    }
    return reflected;
}
