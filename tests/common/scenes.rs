//! Built-in scenes.

/// The scenes of `tests/gpu/agreement`, but for `--full`. A test holds that among them they use every switch
/// of the shaders that any built-in scene uses on a software device, but for those below.
pub const ENOUGH: [&str; 5] = ["examples", "paints", "terrace", "bazaar", "arbour"];

/// Switches of which other tests of agreement have scenes: in `tests/gpu/agreement`, and `GUIDE` in
/// `tests/gpu/guiding.rs`.
pub const ELSEWHERE: [&str; 38] = [
    "ANISOTROPY_DIRECTIONS",
    "APERTURE_POLYGON",
    "AREA_LIGHTS_BY_PICTURE",
    "BUMP_MAPS",
    "COAT_NORMALS",
    "ENVIRONMENT_TURNED",
    "ESTIMATOR_NEE",
    "FILTER",
    "FILTER_BOX",
    "FILTER_CURVE",
    "GUIDE",
    "INSTANCES",
    "LIGHTS_BY_PICTURE",
    "LIGHT_CELLS",
    "LIGHT_LINKS",
    "LIGHT_TEXTURES",
    "MEDIUM_EMISSION",
    "MEDIUM_GRIDS",
    "MEDIUM_PASSAGE",
    "NORMAL_MIRRORING",
    "NORMAL_SHADOWING",
    "OPEN_BOUNDARIES",
    "ORTHOGRAPHIC",
    "PICK",
    "PIXEL_DIGITAL_SHIFT",
    "PIXEL_HASHED",
    "PIXEL_ROTATION",
    "PORTALS",
    "ROLLING_SHUTTER",
    "SECOND_UVS",
    "SPHERE_LIGHTS_BY_PICTURE",
    "SPHERE_LIGHTS_BY_POINT",
    "SPHERE_LIGHTS_VISIBLE_HALF",
    "SPHERE_POINTS",
    "TEXTURES_OF_TRIANGLES",
    "TEXTURE_PRODUCTS",
    "UNIFORM_HEMISPHERE",
    "VARYING_LIGHTS",
];
