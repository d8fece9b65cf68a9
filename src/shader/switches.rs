//! The table of switches: every part of the shaders that a scene compiles or leaves out, and what each needs of the others.
//!
//! The plan turns switches on, the composer refuses names that are not here, the shader tests draw combinations from here, and the bench
//! forces single ones. A combination is one that a plan may make where it is [closed](close).

use std::collections::BTreeSet;
use std::sync::LazyLock;

use crate::scene::camera::model::camera_table;
use crate::scene::light::light_table;
use crate::scene::material::material_table;
use crate::scene::shape::shape_table;

/// A row of the table.
#[derive(Debug, Clone, Copy)]
pub struct Switch {
    pub name: &'static str,
    /// All of these are on wherever it is.
    pub requires: &'static [&'static str],
    /// At least one of these is on wherever it is; the first is the simplest. Empty: it needs none.
    pub one_of: &'static [&'static str],
    /// None of these is on where it is, but for itself.
    pub excludes: &'static [&'static str],
    /// No ordinary render has it: it is for following a path and for tests of the tests.
    pub debug: bool,
}

const fn switch(name: &'static str) -> Switch {
    Switch { name, requires: &[], one_of: &[], excludes: &[], debug: false }
}

impl Switch {
    const fn requires(self, requires: &'static [&'static str]) -> Self {
        Self { requires, ..self }
    }

    const fn one_of(self, one_of: &'static [&'static str]) -> Self {
        Self { one_of, ..self }
    }

    const fn excludes(self, excludes: &'static [&'static str]) -> Self {
        Self { excludes, ..self }
    }

    const fn debug(self) -> Self {
        Self { debug: true, ..self }
    }
}

/// Names of switches of the finite primitives in the table of shapes, those of some `SurfaceSampling` left out.
macro_rules! names_but {
    ($left_out:ident $suffix:literal [$($name:expr,)*]) => { &[$($name,)*] };
    (Infinite $suffix:literal [$($name:expr,)*] (Infinite $capitals:ident) $($rest:tt)*) => {
        names_but!(Infinite $suffix [$($name,)*] $($rest)*)
    };
    (Own $suffix:literal [$($name:expr,)*] (Own $capitals:ident) $($rest:tt)*) => {
        names_but!(Own $suffix [$($name,)*] $($rest)*)
    };
    (Own $suffix:literal [$($name:expr,)*] (Infinite $capitals:ident) $($rest:tt)*) => {
        names_but!(Own $suffix [$($name,)*] $($rest)*)
    };
    ($left_out:ident $suffix:literal [$($name:expr,)*] ($sampling:ident $capitals:ident) $($rest:tt)*) => {
        names_but!($left_out $suffix [$($name,)* concat!(stringify!($capitals), $suffix),] $($rest)*)
    };
}

/// Switches for each primitive in the table of shapes.
macro_rules! shapes {
    ($($variant:ident($type:ty) $module:ident $name:literal $(=> $primitive:ident $file:ident $capitals:ident $sampling:ident $coordinates:ident $curvature:ident)?,)*) => {
        /// Kinds of primitive that a hierarchy holds.
        const IN_HIERARCHY: &[&str] = names_but!(Infinite "S_IN_HIERARCHY" [] $($(($sampling $capitals))?)*);

        /// Kinds of surfaces of which points are drawn by area, as lights or portals.
        const DRAWN_BY_AREA: &[&str] = names_but!(Own "_LIGHTS" [] $($(($sampling $capitals))?)*);

        const SHAPES: &[&[Switch]] = &[$($(shapes!(@of $sampling $capitals),)?)*];
    };
    (@of Infinite $capitals:ident) => { &[switch(concat!(stringify!($capitals), "S"))] };
    (@of $sampling:ident $capitals:ident) => {
        &[
            switch(concat!(stringify!($capitals), "S")),
            switch(concat!(stringify!($capitals), "S_IN_HIERARCHY")).requires(&[concat!(stringify!($capitals), "S")]),
            switch(concat!(stringify!($capitals), "_LIGHTS")).requires(&[concat!(stringify!($capitals), "S")]),
        ]
    };
}
shape_table!(shapes);

/// The contents of the hierarchy beside triangles alone; these are the first.
const IN_HIERARCHY_BESIDE_TRIANGLES: &[&str] = IN_HIERARCHY.split_at(1).1;

/// A switch for each lobe in the table of materials.
macro_rules! lobes {
    ($($(#[$doc:meta])* $material:ident $(($($boxed:tt)*))? $({$($fields:tt)*})? $type_name:ident { $($lobe:ident $file:ident $switch:ident $support:ident $(($($slots:tt)*))? $([$($parameters:tt)*])?)* })*) => {
        const LOBES: &[Switch] = &[$($(lobes!(@requires $support stringify!($switch)),)*)*];
    };
    (@requires Sphere $name:expr) => { switch($name).requires(&["NON_DELTA_TRANSMISSION"]) };
    (@requires $other:ident $name:expr) => { switch($name) };
}
material_table!(lobes);

/// A switch for each light in the table of lights.
macro_rules! lights {
    (environment { $($environment:ident($outside:ident) $environment_module:ident $switch:ident $($needed:ident)*,)* }
     delta { $($delta:ident($type:ident) $module:ident $number:ident $($delta_needed:ident)*,)* }) => {
        /// Lights to which one direction leads from each point.
        const DELTA: &[&str] = &[$(stringify!($number)),*];

        /// Light from outside the scene that is not the same from everywhere: one at most.
        const OUTSIDE: &[&str] = &[$(stringify!($switch)),*];

        const LIGHTS: &[Switch] = &[
            $(switch(stringify!($switch)).requires(&["ENVIRONMENT", $(stringify!($needed)),*]).excludes(OUTSIDE),)*
            $(switch(stringify!($number)).requires(&["DELTA_LIGHTS", $(stringify!($delta_needed)),*]),)*
        ];
    };
}
light_table!(lights);

/// A switch for each model in the table of cameras.
macro_rules! cameras {
    ($($(#[$meta:meta])* $variant:ident $module:ident $switch:ident $($needed:ident)*,)*) => {
        /// Models of cameras whose picture is not flat: one at most.
        const CAMERA_MODELS: &[&str] = &[$(stringify!($switch)),*];

        const CAMERAS: &[Switch] = &[
            $(switch(stringify!($switch)).requires(&["CAMERA_MODEL", $(stringify!($needed)),*]).excludes(CAMERA_MODELS),)*
        ];
    };
}
camera_table!(cameras);

/// Ways in which the texels of images are kept.
const TEXEL_FORMATS: &[&str] = &["TEXELS_IN_BYTES", "TEXELS_IN_FLOATS", "TEXELS_IN_HALF_FLOATS", "TEXELS_IN_SHORTS"];

/// Kinds of sampled light; where lights are sampled there is one at least.
const LIGHT_KINDS: &[&str] = &["DELTA_LIGHTS", "AREA_LIGHTS", "SPHERE_LIGHTS", "ENVIRONMENT_LIGHT", "PORTALS"];

/// Lobes that are a power of the cosine about the mirror direction.
const COSINE_POWER_LOBES: &[&str] = &["GLOSSY", "PHONG"];

/// Layers, of which a render makes one at most. The first is made of the picture's samples, the others of something else.
const LAYERS: &[&str] = &[
    "LAYER_SQUARES",
    "LAYER_ALBEDO",
    "LAYER_DEPTH",
    "LAYER_DIRECT",
    "LAYER_EMISSION",
    "LAYER_INDIRECT",
    "LAYER_MOTION",
    "LAYER_NORMAL",
    "LAYER_OBJECT_POSITION",
    "LAYER_POSITION",
    "LAYER_UV",
];

/// Layers that are made of something other than the picture's samples.
const CLAMPED_BY_NONE: &[&str] = LAYERS.split_at(1).1;

/// Layers of the first surface alone.
const OF_FIRST_SURFACE: &[&str] = &["LAYER_DEPTH", "LAYER_MOTION", "LAYER_OBJECT_POSITION", "LAYER_POSITION", "LAYER_UV"];

/// The table, in alphabetical order.
pub static SWITCHES: LazyLock<Vec<Switch>> = LazyLock::new(|| {
    let mut rows = [&[OF_FEATURES, LOBES, LIGHTS, CAMERAS], SHAPES].concat().concat();
    rows.sort_by_key(|row| row.name);
    rows
});

/// All but lobes, shapes, and lights that are no surfaces.
const OF_FEATURES: &[Switch] = &[
    switch("ANISOTROPY").requires(&["FURTHER_PARAMETERS", "TANGENTS"]),
    // The direction of some anisotropy comes from a texture.
    switch("ANISOTROPY_DIRECTIONS").requires(&["ANISOTROPY", "PRINCIPLED", "TEXTURES"]),
    switch("APERTURE_POLYGON").requires(&["LENS"]).excludes(&["APERTURE_SQUARE"]),
    switch("APERTURE_SQUARE").requires(&["LENS"]),
    switch("AREA_LIGHTS").one_of(DRAWN_BY_AREA),
    switch("AREA_LIGHTS_BY_PICTURE").requires(&["AREA_LIGHTS", "LIGHTS_BY_PICTURE"]),
    switch("ATTRIBUTES"),
    switch("ATTRIBUTE_CHUNKS").requires(&["ATTRIBUTES"]),
    switch("BECKMANN"),
    // Some interface of a stack has a normal map of its own.
    switch("BENT_LAYERS").requires(&["LAYERED", "NORMAL_MAPS", "TANGENTS"]),
    // Some place of the picture sees nothing.
    switch("BLIND_PIXELS"),
    switch("BLENDS").one_of(&["MIXTURE", "PICK"]),
    // Places of scattering are drawn by angle alone, or by distance alone.
    switch("BY_ANGLE").requires(&["SCATTERING"]).excludes(&["BY_DISTANCE"]),
    switch("BY_DISTANCE").requires(&["SCATTERING"]),
    // Some normal map holds heights.
    switch("BUMP_MAPS").requires(&["NORMAL_MAPS"]),
    // Kernels walk nodes.
    switch("BVH").one_of(IN_HIERARCHY).excludes(&["RAY_QUERY"]),
    // The picture is not flat.
    switch("CAMERA_MODEL").one_of(CAMERA_MODELS).excludes(&["ORTHOGRAPHIC"]),
    // The picture consists of several views.
    // Rays come from all around back to the camera's position.
    switch("CAMERA_INWARD").requires(&["FISHEYE"]).excludes(&["STEREO"]),
    switch("CAMERA_TILES"),
    // The camera moves while the shutter is open.
    switch("CAMERA_MOTION"),
    // Surfaces know what the path carries to them.
    switch("CARRIED_LIGHT").one_of(&["PRINCIPLED_DISPERSION", "ROUGH_SPECTRAL_GLASS", "SPECTRAL_GLASS"]),
    switch("CHECKERS").requires(&["PROCEDURAL_TEXTURES"]),
    // Coats lie about other normals than what is below them.
    switch("COAT_NORMALS").requires(&["FURTHER_PARAMETERS", "PRINCIPLED", "TANGENTS", "TEXTURES"]),
    switch("COLOR1"),
    switch("COMPENSATION").requires(&["FURTHER_PARAMETERS", "PRINCIPLED"]),
    switch("DELTA_LIGHTS").one_of(DELTA),
    // The layer of depth is the distance from the camera.
    switch("DEPTH_BY_DISTANCE"),
    switch("DIGITAL_SHIFT").requires(&["SEQUENCE"]),
    switch("CLAMP").excludes(CLAMPED_BY_NONE),
    switch("EMISSION"),
    switch("ENVIRONMENT"),
    switch("ENVIRONMENT_LIGHT").requires(&["ENVIRONMENT_SAMPLED"]),
    switch("ENVIRONMENT_SAMPLED").requires(&["ENVIRONMENT", "LIGHTS"]).one_of(&["ENVIRONMENT_LIGHT", "PORTALS"]),
    // The map is turned about another axis than +Y.
    switch("ENVIRONMENT_TURNED").requires(&["ENVIRONMENT_MAP"]),
    // A path either samples a light or goes on.
    switch("ESTIMATOR_CHOOSE").requires(&["ESTIMATOR_MIS"]),
    switch("ESTIMATOR_MIS").excludes(&["ESTIMATOR_NEE"]),
    switch("ESTIMATOR_NEE"),
    switch("FILM_TEXTURE"),
    switch("FILTER"),
    switch("FILTER_BOX").requires(&["FILTER"]).excludes(&["FILTER_CURVE"]),
    switch("FILTER_CURVE").requires(&["FILTER"]),
    // Points of some are drawn by solid angle.
    switch("FLAT_LIGHTS_BY_SOLID_ANGLE")
        .requires(&["AREA_LIGHTS", "LIGHTS"])
        .one_of(&["RECTANGLES_BY_SOLID_ANGLE", "TRIANGLES_BY_SOLID_ANGLE"]),
    // Layers of surfaces follow mirrors and glass alone.
    switch("GUIDE").excludes(&["LAYER_OF_SURFACES"]),
    switch("HEURISTIC_CUTOFF").excludes(&["HEURISTIC_EXPONENT", "HEURISTIC_POWER"]),
    // The power heuristic's exponent is not 2.
    switch("HEURISTIC_EXPONENT").excludes(&["HEURISTIC_POWER"]),
    switch("HEURISTIC_POWER"),
    // Rays of the camera go through what gives light, as they do through null surfaces.
    switch("HIDDEN_EMITTERS").requires(&["NULL_SURFACES"]),
    switch("FURTHER_PARAMETERS"),
    switch("IMAGES").requires(&["TEXELS", "TEXTURES"]).one_of(TEXEL_FORMATS),
    switch("INSTANCES").requires(&["BVH", "TRIANGLES_IN_HIERARCHY"]),
    switch("INSTANCE_CHUNKS").requires(&["INSTANCES"]),
    // Some material is a stack of layers, through which light walks or goes straight.
    switch("LAYERED").requires(&["NON_DELTA_TRANSMISSION"]).one_of(&["LAYERS_BY_WALK", "LAYERS_STRAIGHT_THROUGH"]),
    switch("LAYERS_BY_WALK").requires(&["LAYERED"]),
    switch("LAYERS_STRAIGHT_THROUGH").requires(&["LAYERED"]),
    // These layers are rendered in place of the picture.
    switch("LAYER_ALBEDO").requires(&["LAYER_OF_SURFACES"]).excludes(LAYERS),
    switch("LAYER_DEPTH").requires(&["LAYER_OF_FIRST_SURFACE"]).excludes(LAYERS),
    switch("LAYER_DIRECT").excludes(LAYERS),
    switch("LAYER_EMISSION").excludes(LAYERS),
    switch("LAYER_INDIRECT").excludes(LAYERS),
    switch("LAYER_MOTION").requires(&["LAYER_OF_FIRST_SURFACE"]).excludes(LAYERS),
    switch("LAYER_NORMAL").requires(&["LAYER_OF_SURFACES"]).excludes(LAYERS),
    switch("LAYER_OBJECT_POSITION").requires(&["LAYER_OF_FIRST_SURFACE"]).excludes(LAYERS),
    switch("LAYER_OF_FIRST_SURFACE").requires(&["LAYER_OF_SURFACES"]).one_of(OF_FIRST_SURFACE),
    switch("LAYER_OF_SURFACES").one_of(&[
        "LAYER_DEPTH",
        "LAYER_ALBEDO",
        "LAYER_MOTION",
        "LAYER_NORMAL",
        "LAYER_OBJECT_POSITION",
        "LAYER_POSITION",
        "LAYER_UV",
    ]),
    switch("LAYER_POSITION").requires(&["LAYER_OF_FIRST_SURFACE"]).excludes(LAYERS),
    switch("LAYER_SQUARES").excludes(LAYERS),
    switch("LAYER_UV").requires(&["LAYER_OF_FIRST_SURFACE"]).excludes(LAYERS),
    // Numbers of a path come from a linear congruential generator.
    switch("LCG").excludes(&["SEQUENCE"]),
    switch("LENS"),
    switch("LIGHTS").one_of(LIGHT_KINDS),
    // Points of some are drawn by what they show.
    switch("LIGHTS_BY_PICTURE")
        .requires(&["LIGHTS", "TEXELS", "TEXTURES", "VARYING_LIGHTS"])
        .one_of(&["AREA_LIGHTS_BY_PICTURE", "SPHERE_LIGHTS_BY_PICTURE"]),
    // Some lamp lights some objects and not others.
    switch("LIGHT_LINKS"),
    // The intensity of some delta light differs from direction to direction by a profile.
    switch("LIGHT_PROFILES").requires(&["DELTA_LIGHTS", "TEXELS"]).one_of(&["POINT_LIGHT", "SPOT_LIGHT"]),
    // Some delta light projects a texture.
    switch("LIGHT_TEXTURES").requires(&["DELTA_LIGHTS", "TEXTURES"]),
    // Some surface encloses a medium that takes or gives light, or the camera is within one.
    switch("MEDIA"),
    switch("MEDIUM_EMISSION").requires(&["MEDIA"]),
    switch("MEDIUM_GRIDS").requires(&["MEDIA", "OPEN_BOUNDARIES", "TEXELS"]),
    switch("MEDIUM_PASSAGE").requires(&["MEDIUM_GRIDS"]),
    switch("MIXTURE").requires(&["BLENDS"]).excludes(&["PICK"]),
    // A mixture has lobes besides the diffuse one.
    switch("MORE_LOBES").requires(&["MIXTURE"]),
    // A moving shape stands in the hierarchy and has its attributes.
    switch("MOTION").requires(&["ATTRIBUTES", "BVH"]),
    switch("LIGHT_CELLS").requires(&["LIGHTS"]).excludes(&["LIGHT_TREE", "ONE_LIGHT"]),
    switch("LIGHT_TREE").requires(&["LIGHTS"]).excludes(&["ONE_LIGHT"]),
    switch("MOVING_LIGHTS").requires(&["MOTION"]),
    switch("NODE_CHUNKS").requires(&["BVH"]).excludes(&["UNIFORM_NODES"]),
    switch("NON_DELTA_TRANSMISSION"),
    switch("NORMAL_MAPS").requires(&["TEXTURES"]),
    switch("NORMAL_MIRRORING").requires(&["NORMAL_SHADOWING"]),
    switch("NORMAL_SCALES").requires(&["NORMAL_MAPS"]),
    switch("NORMAL_SHADOWING").requires(&["NORMAL_MAPS"]),
    // Some shape stands elsewhere than in its own space.
    switch("OBJECT_MAPS").requires(&["LAYER_OBJECT_POSITION"]),
    switch("ONE_LIGHT"),
    switch("ONE_SIDED"),
    switch("ONLY_TRIANGLES_IN_HIERARCHY").requires(&["TRIANGLES_IN_HIERARCHY"]).excludes(IN_HIERARCHY_BESIDE_TRIANGLES),
    // Null surfaces bound media.
    switch("OPEN_BOUNDARIES").requires(&["MEDIA"]),
    switch("ORTHOGRAPHIC"),
    // The light of one group is rendered, and that from outside the scene is in another.
    switch("OUTSIDE_UNSEEN").requires(&["ENVIRONMENT"]).excludes(&["LAYER_OF_SURFACES"]),
    switch("PACKETS").requires(&["BVH"]).excludes(&["TRACE"]),
    switch("PERLIN").requires(&["PROCEDURAL_TEXTURES"]),
    // Studies of cosine-power lobes.
    switch("PHONG_BY_HEMISPHERE").one_of(COSINE_POWER_LOBES),
    switch("PHONG_FLIPPED").one_of(COSINE_POWER_LOBES),
    switch("PHONG_WITHOUT_COSINE").one_of(COSINE_POWER_LOBES),
    switch("PICK").requires(&["BLENDS"]),
    switch("PIXEL_CENTRE").excludes(&["PIXEL_DIGITAL_SHIFT", "PIXEL_HASHED", "PIXEL_ROTATION"]),
    switch("PIXEL_DIGITAL_SHIFT").excludes(&["PIXEL_HASHED", "PIXEL_ROTATION"]),
    switch("PIXEL_HASHED").excludes(&["PIXEL_ROTATION"]),
    switch("PIXEL_LCG").excludes(&["PIXEL_CENTRE", "PIXEL_DIGITAL_SHIFT", "PIXEL_HASHED", "PIXEL_ROTATION"]),
    switch("PIXEL_LIST").excludes(&["TRACE"]),
    switch("PIXEL_ROTATION"),
    switch("PLANT_BRDF").debug(),
    switch("PLANT_LIGHT").requires(&["LIGHTS"]).debug(),
    switch("PLANT_MIS").requires(&["ESTIMATOR_MIS", "LIGHTS"]).debug(),
    switch("PORTALS").requires(&["ENVIRONMENT_SAMPLED"]),
    switch("PRIMITIVE_CHUNKS").excludes(&["UNIFORM_PRIMITIVES"]),
    switch("PRINCIPLED_DIFFUSE_TRANSMISSION").requires(&["FURTHER_PARAMETERS", "PRINCIPLED"]),
    switch("PRINCIPLED_DISPERSION").requires(&["CARRIED_LIGHT", "FURTHER_PARAMETERS", "PRINCIPLED", "PRINCIPLED_TRANSMISSION"]),
    switch("PRINCIPLED_TRANSMISSION"),
    switch("PROCEDURAL_TEXTURES").requires(&["TEXTURES"]).one_of(&["CHECKERS", "PERLIN", "WORLEY"]),
    // Acceleration structures hold a scene at rest.
    switch("RAY_QUERY").one_of(IN_HIERARCHY).excludes(&["MOTION"]),
    // Among them are lights.
    switch("RECTANGLES_BY_SOLID_ANGLE").requires(&["FLAT_LIGHTS_BY_SOLID_ANGLE", "QUAD_LIGHTS"]),
    // Rows of the picture are exposed one after the other.
    switch("ROLLING_SHUTTER").one_of(&["CAMERA_MOTION", "MOTION"]),
    switch("ROUGHNESS"),
    switch("ROULETTE"),
    // Some texture lies by the second texture coordinates of meshes.
    switch("SECOND_UVS").requires(&["ATTRIBUTES", "TEXTURES"]),
    switch("SCATTERING").requires(&["MEDIA"]),
    switch("SEPARABLE_MASKING"),
    switch("SEQUENCE"),
    switch("SHEEN").requires(&["FURTHER_PARAMETERS", "PRINCIPLED"]),
    // Slabs of stacks take light, and scatter it.
    switch("SLABS").requires(&["LAYERED"]),
    switch("SLABS_SCATTER").requires(&["SLABS"]),
    switch("SPHERE_LIGHTS_BY_PICTURE").requires(&["ATTRIBUTES", "LIGHTS_BY_PICTURE", "SPHERE_POINTS"]),
    switch("SPHERE_LIGHTS_BY_POINT").requires(&["SPHERE_POINTS"]),
    switch("SPHERE_LIGHTS_VISIBLE_HALF").requires(&["SPHERE_LIGHTS_BY_POINT"]),
    // Points of sphere lights are drawn by area, and not their directions.
    switch("SPHERE_POINTS").requires(&["SPHERE_LIGHTS"]).one_of(&["SPHERE_LIGHTS_BY_PICTURE", "SPHERE_LIGHTS_BY_POINT"]),
    // The intensity of some spot light falls otherwise than by the smooth step.
    switch("SPOT_FALLOFFS").requires(&["SPOT_LIGHT"]),
    // Two eyes have a view each.
    switch("STEREO").requires(&["CAMERA_TILES"]).excludes(&["CUBE_MAP"]),
    switch("SUBGROUP_QUEUES"),
    switch("TAKEN_PIXELS").excludes(&["TRACE"]),
    // The directions of texture coordinates matter to some lobe.
    switch("TANGENTS").one_of(&["BENT_LAYERS", "FURTHER_PARAMETERS"]),
    switch("TEXELS"),
    switch("TEXELS_IN_BYTES").requires(&["IMAGES"]),
    switch("TEXELS_IN_FLOATS").requires(&["IMAGES"]),
    switch("TEXELS_IN_HALF_FLOATS").requires(&["IMAGES"]),
    switch("TEXELS_IN_SHORTS").requires(&["IMAGES"]),
    switch("TEXEL_CHUNKS").requires(&["TEXELS"]),
    switch("TEXTURES"),
    // The texels of some image are triangles' corners.
    switch("TEXTURES_OF_TRIANGLES").requires(&["IMAGES"]),
    // One channel counts of some image.
    switch("TEXTURE_CHANNELS").requires(&["IMAGES"]),
    switch("TEXTURE_PRODUCTS").requires(&["TEXTURES"]),
    switch("TEXTURE_ROTATION").requires(&["TEXTURES"]),
    // A film on some surface makes light interfere.
    switch("THIN_FILM").requires(&["FURTHER_PARAMETERS"]),
    switch("TRACE").debug(),
    // Among them are lights.
    switch("TRIANGLES_BY_SOLID_ANGLE").requires(&["FLAT_LIGHTS_BY_SOLID_ANGLE", "TRIANGLE_LIGHTS"]),
    // Shadow rays go on through null surfaces.
    switch("TRANSPARENT_SHADOWS").requires(&["LIGHTS", "NULL_SURFACES"]),
    // Each eye is on a circle, where the other is beside it for who looks that way.
    switch("TURNING_EYES").requires(&["STEREO"]).one_of(&["CYLINDRICAL", "EQUIRECTANGULAR"]),
    switch("UNIFORM_HEMISPHERE"),
    switch("UNIFORM_NODES").requires(&["BVH"]),
    switch("UNIFORM_PRIMITIVES"),
    switch("UNIFORM_TABLES"),
    switch("VARYING_LIGHTS").requires(&["EMISSION", "LIGHTS"]),
    // Some weight of a blend depends on the angle from which it is seen.
    switch("WEIGHTS_BY_ANGLE").requires(&["BLENDS"]),
    // Some weight of a blend depends on the direction of the surface's normal.
    switch("WEIGHTS_BY_DIRECTION").requires(&["BLENDS"]),
    switch("WEIGHTS_BY_SIDE").requires(&["BLENDS"]),
    switch("WEIGHTS_BY_VIEWER").requires(&["BLENDS"]),
    switch("WORLEY").requires(&["PROCEDURAL_TEXTURES"]),
];

/// The row of a name.
pub fn find(name: &str) -> Option<&'static Switch> {
    SWITCHES.binary_search_by(|row| row.name.cmp(name)).ok().map(|index| &SWITCHES[index])
}

/// A rule of the table that a set of switches breaks, in words; None where a plan may make the set.
pub fn contradiction(enabled: &BTreeSet<&'static str>) -> Option<String> {
    enabled.iter().find_map(|name| {
        let Some(row) = find(name) else { return Some(format!("there is no switch {name}")) };
        if let Some(missing) = row.requires.iter().find(|needed| !enabled.contains(*needed)) {
            return Some(format!("{name} requires {missing}"));
        }
        if !row.one_of.is_empty() && !row.one_of.iter().any(|other| enabled.contains(other)) {
            return Some(format!("{name} requires one of {}", row.one_of.join(", ")));
        }
        row.excludes
            .iter()
            .find(|other| **other != row.name && enabled.contains(*other))
            .map(|other| format!("{name} excludes {other}"))
    })
}

/// A set that keeps to the table, as near to `wanted` as taking what is required goes; of two that exclude each other, what stands first in
/// the table stays. So every switch can be tried with every other that may stand beside it.
pub fn close(wanted: &BTreeSet<&'static str>) -> BTreeSet<&'static str> {
    let mut closed = BTreeSet::new();
    for row in SWITCHES.iter().filter(|row| wanted.contains(row.name)) {
        let mut with = closed.clone();
        add(row, wanted, &mut with);
        if contradiction(&with).is_none() {
            closed = with;
        }
    }
    closed
}

/// Adds a switch and what it requires; of those of which it needs one, a wanted one if there is any.
fn add(row: &Switch, wanted: &BTreeSet<&'static str>, into: &mut BTreeSet<&'static str>) {
    if !into.insert(row.name) {
        return;
    }
    for other in row.requires.iter().filter_map(|name| find(name)) {
        add(other, wanted, into);
    }
    if !row.one_of.iter().any(|name| into.contains(name)) {
        let chosen = row.one_of.iter().find(|name| wanted.contains(*name)).or(row.one_of.first());
        if let Some(other) = chosen.and_then(|name| find(name)) {
            add(other, wanted, into);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_is_sorted_and_names_only_its_own_rows() {
        assert!(SWITCHES.windows(2).all(|pair| pair[0].name < pair[1].name));
        for row in SWITCHES.iter() {
            for name in row.requires.iter().chain(row.one_of).chain(row.excludes) {
                assert!(find(name).is_some(), "{}: there is no switch {name}", row.name);
            }
        }
    }

    #[test]
    fn every_switch_can_be_on_and_a_closed_set_has_no_contradiction() {
        for row in SWITCHES.iter() {
            let closed = close(&BTreeSet::from([row.name]));
            assert!(closed.contains(row.name) && contradiction(&closed).is_none(), "{}: {closed:?}", row.name);
        }
        let everything = close(&SWITCHES.iter().map(|row| row.name).collect());
        assert_eq!(contradiction(&everything), None);
    }

    #[test]
    fn contradictions_are_named() {
        let of = |names: &[&'static str]| contradiction(&names.iter().copied().collect()).unwrap_or_default();
        assert_eq!(of(&["MIRORR"]), "there is no switch MIRORR");
        assert_eq!(of(&["CHECKERS"]), "CHECKERS requires PROCEDURAL_TEXTURES");
        assert_eq!(of(&["LIGHTS"]), format!("LIGHTS requires one of {}", LIGHT_KINDS.join(", ")));
        assert_eq!(of(&["ESTIMATOR_MIS", "ESTIMATOR_NEE"]), "ESTIMATOR_MIS excludes ESTIMATOR_NEE");
        assert_eq!(of(&["MIRROR"]), "");
    }
}
