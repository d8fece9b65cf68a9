//! What a scene file may ask for and the renderers do not do yet. This is the one place that knows: what comes to work is taken out
//! here.

use super::document::Step;
use super::document::Step::{Index, Key};
use crate::scene::{EnvironmentRadiance, Geometry, Light, Material, MaterialKind, Scene, TextureKind};

/// Something that is refused: where it is written and what it is called.
pub struct Refusal {
    pub path: Vec<Step>,
    pub feature: String,
}

/// The first thing in the scene that no renderer does.
pub fn find(scene: &Scene) -> Option<Refusal> {
    textures(scene).or_else(|| materials(scene)).or_else(|| shapes(scene)).or_else(|| lights(scene))
}

fn refuse(path: impl Into<Vec<Step>>, feature: impl Into<String>) -> Option<Refusal> {
    Some(Refusal { path: path.into(), feature: feature.into() })
}

fn textures(scene: &Scene) -> Option<Refusal> {
    scene.textures.iter().enumerate().find_map(|(index, texture)| {
        let kind = match &texture.kind {
            TextureKind::Image(_) => return None,
            TextureKind::Checker { .. } => "checker",
            TextureKind::Perlin { .. } => "perlin",
            TextureKind::Worley { .. } => "worley",
        };
        refuse([Key("texture"), Index(index), Key("type")], format!("the texture type `{kind}`"))
    })
}

fn materials(scene: &Scene) -> Option<Refusal> {
    scene.materials.iter().enumerate().find_map(|(index, material)| self::material(index, material))
}

fn material(index: usize, material: &Material) -> Option<Refusal> {
    let path = |key| [Key("material"), Index(index), Key(key)];
    let kind = match &material.kind {
        MaterialKind::Diffuse { .. } | MaterialKind::Emissive | MaterialKind::Pass => None,
        MaterialKind::Mirror { reflectance } => {
            return reflectance.is_texture().then(|| refuse(path("reflectance"), "a texture of a mirror's reflectance"))?;
        }
        MaterialKind::Glass { reflectance, transmittance, .. } => {
            let textured = reflectance.is_texture() || transmittance.is_texture();
            return textured.then(|| refuse(path("type"), "a texture of glass"))?;
        }
        MaterialKind::Glossy { .. } => Some("glossy"),
        MaterialKind::Phong { .. } => Some("phong"),
        MaterialKind::RoughGlass { .. } => Some("rough_glass"),
        MaterialKind::Conductor { .. } => Some("conductor"),
        MaterialKind::Blend { .. } => Some("blend"),
    };
    if let Some(kind) = kind {
        return refuse(path("type"), format!("the material type `{kind}` (of `{}`)", material.name));
    }
    material.normal_map.and_then(|_| refuse(path("normal_map"), "a normal map"))
}

fn shapes(scene: &Scene) -> Option<Refusal> {
    scene.shapes.iter().enumerate().find_map(|(index, shape)| {
        let path = |key| [Key("shape"), Index(index), Key(key)];
        if shape.motion.is_some() {
            return refuse(path("motion"), "motion");
        }
        if shape.portal {
            return refuse(path("portal"), "a portal");
        }
        textured_shape(scene, index)
    })
}

/// Texture coordinates that the device does not make yet: those of spheres, and of rectangles and boxes turned inside out.
fn textured_shape(scene: &Scene, index: usize) -> Option<Refusal> {
    let shape = &scene.shapes[index];
    let what = match shape.geometry {
        Geometry::Sphere { .. } => "a texture on a sphere",
        Geometry::Rectangle { .. } | Geometry::Box { .. } if shape.is_mirrored() => "a texture on a mirrored rectangle or box",
        _ => return None,
    };
    scene.uses_texture(shape.material).then(|| refuse([Key("shape"), Index(index), Key("material")], what))?
}

fn lights(scene: &Scene) -> Option<Refusal> {
    scene.lights.iter().enumerate().find_map(|(index, light)| {
        let kind = match light {
            Light::Point { .. } => return None,
            Light::Environment(environment) => match environment.radiance {
                EnvironmentRadiance::Constant(_) => return None,
                EnvironmentRadiance::Map(_) => {
                    return refuse([Key("light"), Index(index), Key("file")], "an environment from a file");
                }
                EnvironmentRadiance::Sky { .. } => "sky",
            },
            Light::Spot { .. } => "spot",
            Light::Directional { .. } => "directional",
        };
        refuse([Key("light"), Index(index), Key("type")], format!("the light type `{kind}`"))
    })
}
