//! Which keys belong to which projections.

use schemars::Schema;
use serde_json::{Value, json};

use super::projection_name::ProjectionName::{
    self, BrownConrady, CubeMap, Cylindrical, Equirectangular, Fisheye, KannalaBrandt, Orthographic, Perspective,
};

/// A key that belongs to some projections alone.
pub struct Rule {
    pub key: &'static str,
    pub projections: &'static [ProjectionName],
}

macro_rules! rules {
    ($($key:ident [$($projection:ident),*];)*) => {
        &[$(Rule {
            key: stringify!($key),
            projections: &[$($projection),*],
        }),*]
    };
}

/// Keys that belong to some projections alone.
pub const RULES: &[Rule] = rules! {
    height [Orthographic];
    vfov [Perspective];
    azimuth [Equirectangular, Cylindrical];
    elevation [Equirectangular, Cylindrical];
    fov [Fisheye, KannalaBrandt];
    mapping [Fisheye];
    fit [Fisheye];
    layout [CubeMap];
    focal [BrownConrady, KannalaBrandt];
    principal_point [BrownConrady, KannalaBrandt];
    image_size [BrownConrady, KannalaBrandt];
    radial [BrownConrady, KannalaBrandt];
    tangential [BrownConrady];
    calibration [BrownConrady, KannalaBrandt];
    shift [Perspective, Orthographic];
    stretch [Perspective, Orthographic];
    aperture [Perspective, Orthographic, BrownConrady];
    stereo [Perspective, Orthographic, Equirectangular, Cylindrical, Fisheye, BrownConrady, KannalaBrandt];
};

/// The keys that a calibration states.
pub const CALIBRATED: [&str; 5] = ["focal", "principal_point", "image_size", "radial", "tangential"];

/// The key that a projection cannot be without.
pub fn needed(projection: ProjectionName) -> Option<&'static str> {
    match projection {
        Perspective => Some("vfov"),
        Orthographic => Some("height"),
        Fisheye => Some("fov"),
        BrownConrady | KannalaBrandt => Some("focal"),
        Equirectangular | Cylindrical | CubeMap => None,
    }
}

/// Adds to a camera's schema which keys each projection has.
pub fn add(schema: &mut Schema) {
    let own: Vec<Value> = ProjectionName::ALL.iter().map(|&projection| of_projection(projection)).collect();
    let calibrated = [BrownConrady, KannalaBrandt].map(|projection| {
        let mut foreign = foreign(projection);
        foreign.retain(|key| !CALIBRATED.contains(key));
        foreign.extend(CALIBRATED);
        let mut rule = json!({
            "required": ["calibration"],
            "not": any_of(&foreign),
            "properties": { "projection": { "const": projection.name() } },
        });
        // A file says itself what it is of.
        if projection == KannalaBrandt {
            rule["required"] = json!(["calibration", "projection"]);
        }
        rule
    });
    schema.insert("allOf".to_owned(), json!([{ "oneOf": own.into_iter().chain(calibrated).collect::<Vec<_>>() }]));
}

/// The keys that do not belong to a projection.
fn foreign(projection: ProjectionName) -> Vec<&'static str> {
    RULES.iter().filter(|rule| !rule.projections.contains(&projection)).map(|rule| rule.key).collect()
}

fn any_of(keys: &[&str]) -> Value {
    json!({ "anyOf": keys.iter().map(|key| json!({ "required": [key] })).collect::<Vec<_>>() })
}

/// The rule of a projection whose keys are written.
fn of_projection(projection: ProjectionName) -> Value {
    let mut foreign = foreign(projection);
    if !foreign.contains(&"calibration") {
        foreign.push("calibration");
    }
    let mut required: Vec<&str> = needed(projection).into_iter().collect();
    if projection != Perspective {
        required.push("projection");
    }
    let mut properties = json!({ "projection": { "const": projection.name() } });
    if projection == KannalaBrandt {
        properties["radial"] = json!({ "maxItems": 4 });
    }
    json!({ "required": required, "not": any_of(&foreign), "properties": properties })
}
