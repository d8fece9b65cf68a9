//! Which textures and materials a scene file has to define.

use crate::load::file::writer::named_file;
use crate::scene::{
    BlendWeight, ColorInput, Geometry, Light, Material, MaterialId, MaterialKind, Scene, Shape, Texture, TextureId,
};

/// All but those that only models bring along whose files are named.
pub struct Needed {
    textures: Vec<bool>,
    materials: Vec<bool>,
}

impl Needed {
    pub fn of(scene: &Scene) -> Self {
        let mut brought = vec![false; scene.materials.len()];
        let mut wanted = vec![false; scene.materials.len()];
        scene.instances.iter().filter_map(|instances| instances.material).for_each(|id| mark(scene, &mut wanted, id));
        for shape in scene.shapes.iter().chain(scene.groups.iter().flat_map(|group| &group.shapes)) {
            match brings_materials(scene, shape) {
                Some(replaced) => shape.materials().for_each(|id| {
                    let stays = replaced.iter().any(|(_, name)| *name == scene.materials[id].name);
                    mark(scene, if stays { &mut wanted } else { &mut brought }, id);
                }),
                None => shape.materials().for_each(|id| mark(scene, &mut wanted, id)),
            }
        }
        let materials: Vec<bool> = wanted.iter().zip(&brought).map(|(wanted, brought)| *wanted || !brought).collect();
        let mut of_written = vec![false; scene.textures.len()];
        let mut of_others = vec![false; scene.textures.len()];
        for (material, written) in scene.materials.iter().zip(&materials) {
            let used = if *written { &mut of_written } else { &mut of_others };
            textures_of(material).into_iter().for_each(|id| used[named_texture(scene, id)] = true);
        }
        scene.lights.iter().filter_map(Light::texture).for_each(|id| of_written[id] = true);
        let is_own = |id: TextureId| named_texture(scene, id) == id;
        let used = of_written.iter().zip(&of_others).map(|(written, other)| *written || !other);
        let textures = used.enumerate().map(|(id, used)| used && is_own(id)).collect();
        Self { textures, materials }
    }

    pub fn textures(&self) -> impl Iterator<Item = TextureId> + '_ {
        marked(&self.textures)
    }

    pub fn materials(&self) -> impl Iterator<Item = MaterialId> + '_ {
        marked(&self.materials)
    }
}

/// The texture that a scene file names for this one: what bends normals in a way of its own is another's copy.
pub fn named_texture(scene: &Scene, id: TextureId) -> TextureId {
    let texture = &scene.textures[id];
    if texture.bends_plainly() {
        return id;
    }
    let is_original = |other: &Texture| {
        let of_kind = std::mem::discriminant(&other.kind) == std::mem::discriminant(&texture.kind);
        other.bends_plainly() && of_kind && (&other.name, other.transform) == (&texture.name, texture.transform)
    };
    scene.textures[..id].iter().position(is_original).unwrap_or(id)
}

fn marked(marks: &[bool]) -> impl Iterator<Item = usize> + '_ {
    marks.iter().enumerate().filter_map(|(id, mark)| mark.then_some(id))
}

/// Materials that the scene puts in the place of those of the shape's file, if the shape uses its file's own
/// ones.
fn brings_materials<'s>(scene: &'s Scene, shape: &Shape) -> Option<&'s [(String, String)]> {
    let Geometry::Mesh(mesh) = &shape.geometry else { return None };
    named_file(scene, mesh).filter(|source| source.own_materials).map(|source| source.replaced.as_slice())
}

/// Marks a material and all that it is made of.
fn mark(scene: &Scene, marks: &mut [bool], id: MaterialId) {
    let mut to_visit = vec![id];
    while let Some(id) = to_visit.pop() {
        if !std::mem::replace(&mut marks[id], true) {
            to_visit.extend_from_slice(scene.materials[id].components());
        }
    }
}

/// Textures that the material itself looks up.
fn textures_of(material: &Material) -> Vec<TextureId> {
    let of_input = |input: ColorInput| input.texture();
    let mut textures: Vec<TextureId> =
        material.kind.lobe().iter().flat_map(|lobe| lobe.inputs()).filter_map(|(_, input)| of_input(input)).collect();
    textures.extend(material.emission.and_then(|emission| of_input(emission.radiance)));
    textures.extend(material.normal_map);
    match &material.kind {
        MaterialKind::Blend { weight, .. } => textures.extend(texture_of_weight(weight)),
        MaterialKind::Layered(layers) => textures.extend(layers.slabs.iter().filter_map(|slab| slab.thickness.texture())),
        _ => {}
    }
    textures
}

fn texture_of_weight(weight: &BlendWeight) -> Option<TextureId> {
    match weight {
        BlendWeight::Texture { texture } | BlendWeight::Channel { texture, .. } => Some(*texture),
        BlendWeight::Reverse { of } | BlendWeight::Threshold { of, .. } => texture_of_weight(of),
        BlendWeight::Constant { .. }
        | BlendWeight::Facing { .. }
        | BlendWeight::Fresnel { .. }
        | BlendWeight::Front
        | BlendWeight::Camera
        | BlendWeight::Up { .. }
        | BlendWeight::Open { .. } => None,
    }
}
