// Light and what is multiplied with it: radiance, reflectance, throughput, transmittance, extinction. A name of its own, so that a signature tells
// light from places and directions.

// Linear Rec. 709.
alias Spectrum = vec3<f32>;

const BLACK: Spectrum = Spectrum(0.0);
const WHITE: Spectrum = Spectrum(1.0);

fn luminance(color: Spectrum) -> f32 {
    return dot(color, Spectrum(0.2126, 0.7152, 0.0722));
}

fn max_component(color: Spectrum) -> f32 {
    return max(color.r, max(color.g, color.b));
}
