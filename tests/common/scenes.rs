//! Built-in scenes.

/// What the short form of `tests/gpu/agreement` compares. A test holds that among them they use every switch of the shaders that any built-in scene
/// uses on a software device, but for those below.
pub const ENOUGH: [&str; 5] = ["examples", "theatre", "terrace", "bazaar", "arbour"];

/// What other tests of agreement have scenes of, in `strategies.rs`, `lights.rs`, `materials.rs`, `blends.rs`, `instances.rs` and `tests/gpu/guiding.rs`.
pub const ELSEWHERE: [&str; 19] = [
    "ANISOTROPY_DIRECTIONS",
    "APERTURE_POLYGON",
    "COAT_NORMALS",
    "ESTIMATOR_NEE",
    "FILTER",
    "FILTER_BOX",
    "FILTER_CURVE",
    "GUIDE",
    "INSTANCES",
    "ORTHOGRAPHIC",
    "PICK",
    "PIXEL_DIGITAL_SHIFT",
    "PIXEL_HASHED",
    "PIXEL_ROTATION",
    "PORTALS",
    "SPHERE_LIGHTS_BY_POINT",
    "SPHERE_LIGHTS_VISIBLE_HALF",
    "SUBGROUP_QUEUES",
    "UNIFORM_HEMISPHERE",
];
