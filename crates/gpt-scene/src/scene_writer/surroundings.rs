//! The media within shapes and around them, by the boxes around all bodies.

use glam::DVec3;

use crate::scene::{ColorInput, Material, MaterialId, MaterialKind, MediumId, Scene, Shape};
use crate::spectrum::Spectrum;

/// The content of a body.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Content {
    /// A medium of the scene.
    Medium(MediumId),
    /// Nothing but the absorption that a material states.
    Absorption(MaterialId),
}

/// A shape's place and what it holds.
struct Hull {
    bounds: [DVec3; 2],
    /// None: nothing.
    holds: Option<Content>,
}

impl Hull {
    fn size(&self) -> f64 {
        self.bounds[0].distance(self.bounds[1])
    }
}

/// The bodies of a scene, by which it is found what is around a shape.
#[derive(Default)]
pub struct Surroundings {
    /// The smallest first.
    hulls: Vec<Hull>,
    /// The medium around all of them.
    around_camera: Option<Content>,
    /// For each material: something else is within its surfaces than around them. Empty where the scene has no media.
    is_hull: Vec<bool>,
    /// For each material: the content of its bodies. Empty where the scene has no media.
    within: Vec<Option<Content>>,
}

/// The contents of a surface's two sides.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sides {
    pub inside: Option<Content>,
    pub outside: Option<Content>,
}

impl Surroundings {
    /// Finds what stands around what. A scene without media has no surroundings.
    pub fn of(scene: &Scene) -> Self {
        if !has_media(scene) {
            return Self::default();
        }
        let is_hull = scene.materials_that(is_hull);
        let bodies = scene.shapes.iter().filter(|shape| is_hull[shape.material]);
        let own = |(id, material): (MaterialId, &Material)| match material.interior {
            Some(medium) => Some(Content::Medium(medium)),
            None => absorbs(&material.kind).map(|_| Content::Absorption(id)),
        };
        let within = scene.with_that_of_parts(scene.materials.iter().enumerate().map(own).collect(), |_| true);
        let hull = |shape: &Shape| Some(Hull { bounds: shape.bounds()?, holds: within[shape.material] });
        let mut hulls: Vec<Hull> = bodies.filter_map(hull).collect();
        hulls.sort_by(|a, b| a.size().total_cmp(&b.size()));
        // A body of that medium around the camera is left by rays that go out of it.
        let camera = scene.camera.position;
        let is_left = |medium: &Content| {
            let is_around = |[low, high]: [DVec3; 2]| camera.cmpge(low).all() && camera.cmple(high).all();
            hulls.iter().any(|hull| hull.holds == Some(*medium) && is_around(hull.bounds))
        };
        let around_camera = scene.camera_medium.map(Content::Medium).filter(|medium| !is_left(medium));
        Self { hulls, around_camera, is_hull, within }
    }

    /// The contents within a surface of the material and around it; None where the surface bounds no medium. Without bounds, as in a group, it is
    /// the camera's medium that is around it.
    pub fn sides(&self, material: MaterialId, bounds: Option<[DVec3; 2]>) -> Option<Sides> {
        let is_hull = self.is_hull.get(material) == Some(&true);
        is_hull.then(|| Sides { inside: self.within[material], outside: self.around(bounds) })
    }

    /// The content around a box.
    fn around(&self, bounds: Option<[DVec3; 2]>) -> Option<Content> {
        let hull = bounds.and_then(|[low, high]| {
            self.hulls.iter().find(|hull| {
                let slack = (hull.bounds[1] - hull.bounds[0]) * 1e-6;
                let is_within = low.cmpge(hull.bounds[0] - slack).all() && high.cmple(hull.bounds[1] + slack).all();
                is_within && low.distance(high) < hull.size()
            })
        });
        hull.map_or(self.around_camera, |hull| hull.holds)
    }
}

/// The scene with the medium of each material that scatters light below its surface as the medium within its bodies, into which the surface lets
/// light.
pub fn with_media_below_surfaces(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    for material in &mut scene.materials {
        if let MaterialKind::Principled(principled) = &mut material.kind
            && let Some(subsurface) = principled.subsurface.take()
        {
            principled.transmission = subsurface.weight;
            if material.interior.is_none() && principled.transmission != ColorInput::grey(0.0) {
                let mut medium = subsurface.medium();
                medium.name = format!("below {}", material.name);
                material.interior = Some(scene.media.len());
                scene.media.push(medium);
            }
        }
    }
    scene
}

/// Something is around the camera, or within bodies, that takes light or scatters it.
pub fn has_media(scene: &Scene) -> bool {
    let is_filled = |material: &Material| material.interior.is_some() || absorbs(&material.kind).is_some();
    scene.camera_medium.is_some() || scene.materials.iter().any(is_filled)
}

/// Something else is within surfaces of the material itself than around them.
fn is_hull(material: &Material) -> bool {
    let is_body = match &material.kind {
        MaterialKind::Glass { thin, .. } | MaterialKind::RoughGlass { thin, .. } => !thin,
        MaterialKind::Principled(principled) => !principled.thin && principled.transmission != ColorInput::grey(0.0),
        _ => false,
    };
    material.interior.is_some() || is_body
}

/// The share of light that a body of glass absorbs per unit length, where its material says so.
pub fn absorbs(kind: &MaterialKind) -> Option<Spectrum> {
    let MaterialKind::Principled(principled) = kind else { return None };
    principled.attenuation.map(|attenuation| attenuation.extinction())
}
