//! Numbers of vertices and faces as pictures.
//!
//! Every triangle gets a block of 2 × 2 texels of its own: its three corners' values, from which the texture filter `triangle` interpolates as
//! over the triangle itself. Texture coordinates lead from the corners to the texels.

use std::io::Cursor;

use exr::prelude::{Image, SpecificChannels, Vec2 as TexelPosition, WritableImage};
use glam::{Vec2, Vec3};

use crate::load::file::reference::FileOr;
use crate::load::file::syntax::{ImageEntry, TextureFilterEntry, WrapEntry};
use crate::load::image_file::EmbeddedFile;
use crate::load::model::MeshAttribute;
use crate::load::place::Place;
use crate::scene::Mesh;

/// How the blocks of a mesh's triangles lie in a picture.
pub struct Blocks {
    columns: usize,
    rows: usize,
    /// The corners of the triangles, before they had vertices of their own.
    corners: Vec<[u32; 3]>,
}

impl Blocks {
    /// Gives every triangle vertices of its own, with texture coordinates that lead to its block.
    pub fn of(mesh: &mut Mesh) -> Self {
        let (blocks, uvs) = Self::spread(mesh);
        mesh.uvs = uvs;
        blocks
    }

    /// Blocks for a mesh whose own texture coordinates stay: the second ones lead to the blocks.
    pub fn beside(mesh: &mut Mesh) -> Self {
        let own = std::mem::take(&mut mesh.uvs);
        let (blocks, uvs) = Self::spread(mesh);
        mesh.uvs = blocks.corners.iter().flatten().map(|&corner| own[corner as usize]).collect();
        mesh.second_uvs = uvs;
        blocks
    }

    /// Gives every triangle vertices of its own; the coordinates that lead to its block.
    fn spread(mesh: &mut Mesh) -> (Self, Vec<Vec2>) {
        let count = mesh.faces.len().max(1);
        let columns = (count as f64).sqrt().ceil() as usize;
        let rows = count.div_ceil(columns);
        let corners = std::mem::take(&mut mesh.faces);
        let of_corners = |values: &[Vec3]| corners.iter().flatten().map(|&corner| values[corner as usize]).collect::<Vec<_>>();
        mesh.positions = of_corners(&mesh.positions);
        if !mesh.normals.is_empty() {
            mesh.normals = of_corners(&mesh.normals);
        }
        mesh.faces = (0..corners.len() as u32).map(|face| [3 * face, 3 * face + 1, 3 * face + 2]).collect();
        let (width, height) = (2.0 * columns as f64, 2.0 * rows as f64);
        let blocks = (0..corners.len()).map(|face| ((face % columns) as f64, (face / columns) as f64));
        let uvs = blocks.flat_map(|(column, row)| {
            // Middles of texels; v runs upward.
            [(0.5, 0.5), (1.5, 0.5), (0.5, 1.5)]
                .map(|(x, y)| Vec2::new(((2.0 * column + x) / width) as f32, (1.0 - (2.0 * row + y) / height) as f32))
        });
        let uvs = uvs.collect();
        (Self { columns, rows, corners }, uvs)
    }

    /// The corners of the triangles, before they had vertices of their own.
    pub fn corners(&self) -> &[[u32; 3]] {
        &self.corners
    }

    /// The attribute as a texture with an empty name, which stands at a place of the imported file. `alpha`, where there is one, holds a number
    /// for each value.
    pub fn texture(&self, attribute: &MeshAttribute, alpha: Option<&[f32]>, at: &Place) -> Option<ImageEntry> {
        let value = |face: usize, corner: usize| {
            let place = if attribute.of_faces { face } else { self.corners.get(face)?[corner] as usize };
            let alpha = alpha.map_or(Some(1.0), |alpha| alpha.get(place).copied())?;
            attribute.values.get(place).map(|value| value.extend(alpha))
        };
        let texel = |place: TexelPosition<usize>| -> (f32, f32, f32, f32) {
            let face = place.y() / 2 * self.columns + place.x() / 2;
            let [first, second, third] = [0, 1, 2].map(|corner| value(face, corner).unwrap_or_default());
            let texel = match (place.x() % 2, place.y() % 2) {
                (0, 0) => first,
                (1, 0) => second,
                (0, 1) => third,
                // Nothing looks it up.
                _ => (first + second + third) / 3.0,
            };
            texel.to_array().map(|number| number.max(0.0)).into()
        };
        let size = (2 * self.columns, 2 * self.rows);
        let mut bytes = Vec::new();
        let to = Cursor::new(&mut bytes);
        if alpha.is_some() {
            Image::from_channels(size, SpecificChannels::rgba(texel)).write().to_buffered(to).ok()?;
        } else {
            let texel = |place: TexelPosition<usize>| -> (f32, f32, f32) {
                let (red, green, blue, _) = texel(place);
                (red, green, blue)
            };
            Image::from_channels(size, SpecificChannels::rgb(texel)).write().to_buffered(to).ok()?;
        }
        let file = EmbeddedFile { name: format!("{}.exr", attribute.name), bytes: bytes.into() };
        let file = at.at(FileOr::InMemory(file.into()));
        Some(ImageEntry {
            wrap: Some(WrapEntry::Clamp),
            filter: Some(TextureFilterEntry::Triangle),
            ..ImageEntry::of_file(at.at(String::new()), file)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::load::files::Files;
    use crate::load::image_file::{PictureSource, Pictures};

    /// The plane through a block's first three texels, at texture coordinates.
    fn look_up(image: &crate::scene::ImageData, uv: Vec2) -> Vec3 {
        let (width, height) = (image.width as usize, image.height as usize);
        let place = Vec2::new(uv.x * width as f32, (1.0 - uv.y) * height as f32) - 0.5;
        let low = (place + 1e-3).floor();
        let texel = |x: usize, y: usize| {
            let [red, green, blue, _] =
                image.texels.get((low.y as usize + y).min(height - 1) * width + (low.x as usize + x).min(width - 1));
            Vec3::new(red, green, blue)
        };
        let (first, part) = (texel(0, 0), place - low);
        first + (texel(1, 0) - first) * part.x + (texel(0, 1) - first) * part.y
    }

    /// Looked up at any point of any triangle, the picture gives what interpolation over the triangle does.
    #[test]
    fn pictures_interpolate_as_triangles_do() {
        let positions = (0..7).map(|index| Vec3::new(index as f32, (index * index % 5) as f32, 0.0)).collect();
        let faces: Vec<[u32; 3]> = (0..5).map(|face| [face, face + 2, face + 1]).collect();
        let mut mesh = Mesh { positions, faces: faces.clone(), ..Mesh::default() };
        let values: Vec<Vec3> = (0..7).map(|index| Vec3::new(0.1 * index as f32, 1.0 / (1.0 + index as f32), 0.5)).collect();
        let of_vertices = MeshAttribute { name: "color".into(), of_faces: false, values: values.clone() };
        let of_faces = MeshAttribute { name: "color".into(), of_faces: true, values: values[..5].to_vec() };
        let blocks = Blocks::of(&mut mesh);
        assert_eq!((mesh.positions.len(), mesh.uvs.len(), mesh.faces.len()), (15, 15, 5));
        for attribute in [of_vertices, of_faces] {
            let keys = blocks.texture(&attribute, None, &Place::default()).expect("it can be written");
            assert!(matches!(keys.filter, Some(TextureFilterEntry::Triangle)));
            let FileOr::InMemory(file) = keys.file.value else { panic!("it is in memory") };
            let picture = Pictures::new(Files::default()).read(&PictureSource::Embedded(file), None);
            let image = picture.expect("it is a picture").image;
            for (face, corners) in faces.iter().enumerate() {
                for [b, c] in [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.3, 0.3], [0.1, 0.8], [0.45, 0.55]] {
                    let mix = |values: [Vec3; 3]| values[0] * (1.0 - b - c) + values[1] * b + values[2] * c;
                    let uv = mix(mesh.faces[face].map(|corner| mesh.uvs[corner as usize].extend(0.0))).truncate();
                    let expected =
                        if attribute.of_faces { values[face] } else { mix(corners.map(|corner| values[corner as usize])) };
                    let found = look_up(&image, uv);
                    assert!((found - expected).abs().max_element() < 1e-4, "{face} {b} {c}: {found} and not {expected}");
                }
            }
        }
    }
}
