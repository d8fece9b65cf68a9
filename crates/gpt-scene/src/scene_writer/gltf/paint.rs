//! Colours of vertices: textures of the filter `triangle`, which have a block of texels for each triangle.

use super::Writer;
use super::made::Made;
use crate::scene::{Mesh, TextureFilter, TextureId, TextureKind};
use crate::scene_writer::inputs::{Colour, ColourMap};
use crate::spectrum::Spectrum;

/// A mesh with the colours of its vertices, if it has some.
pub struct Painted {
    pub mesh: Mesh,
    pub colours: Option<Vec<[f32; 4]>>,
}

impl Writer<'_> {
    /// The texture holds colours of vertices.
    pub fn is_paint(&self, id: TextureId) -> bool {
        matches!(&self.scene.textures[id].kind, TextureKind::Image(image) if image.filter == TextureFilter::Triangle)
    }

    /// The texture of colours of vertices that multiplies a base colour, and what else there is of that.
    pub fn without_paint(&self, colour: Colour) -> (Option<TextureId>, Colour) {
        let Colour::Map(map) = colour else { return (None, colour) };
        if map.is_plain() && self.is_paint(map.texture) {
            return (Some(map.texture), Colour::Constant(map.factor));
        }
        let times = self.scene.textures[map.texture].times.filter(|other| self.is_paint(*other));
        (times, Colour::Map(ColourMap { ..map }))
    }

    /// The mesh with its vertices' colours, and without the texture coordinates that lead to them alone.
    pub fn painted(&mut self, mut mesh: Mesh, material: &Made, place: &str) -> Painted {
        let Some(paint) = material.paint else { return Painted { mesh, colours: None } };
        let texture = &self.scene.textures[paint];
        let TextureKind::Image(image) = &texture.kind else { return Painted { mesh, colours: None } };
        let by_second = texture.by_second_uvs && !mesh.second_uvs.is_empty();
        let uvs = if by_second { std::mem::take(&mut mesh.second_uvs) } else { mesh.uvs.clone() };
        if !by_second && !material.uses_sets[0] {
            mesh.uvs.clear();
        }
        if uvs.is_empty() {
            self.drop("colours of vertices of a mesh without texture coordinates", place, "it is white");
            return Painted { mesh, colours: None };
        }
        let (width, height) = (image.image.width, image.image.height);
        let place_of = |part: f32, count: u32| ((part * count as f32) as i64).clamp(0, i64::from(count) - 1) as usize;
        let colour = |uv: &glam::Vec2| {
            let index = place_of(1.0 - uv.y, height) * width as usize + place_of(uv.x, width);
            let [red, green, blue, alpha] = image.image.texels.get(index);
            let colour = Spectrum::from_f32([red, green, blue]).clamp(Spectrum::BLACK, Spectrum::WHITE).to_f32();
            [colour[0], colour[1], colour[2], if material.paints_alpha { alpha } else { 1.0 }]
        };
        let colours = uvs.iter().map(colour).collect();
        Painted { mesh, colours: Some(colours) }
    }
}
