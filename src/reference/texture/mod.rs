//! Parameters that vary over a surface, looked up by its texture coordinates.
//!
//! | shape     | u                                               | v                          |
//! | --------- | ----------------------------------------------- | -------------------------- |
//! | mesh      | interpolated from the vertices' uvs             | likewise                   |
//! | sphere    | atan2(x, −z)/2π mod 1, in the sphere's space    | acos(−y)/π                 |
//! | rectangle | along `edge_u` as written, 0 at the corner      | along `edge_v`             |
//! | box       | as for a rectangle, each face with its own two edges (`box_faces` in `intersect/world.rs`) ||
//! | disk, plane, mesh without uvs | none: a textured material on them is refused   |        |

mod checker;
mod image;
mod lattice;
mod perlin;
mod worley;

use glam::{DVec2, DVec3};

use crate::scene::{ColorInput, Scene, Texture, TextureId, TextureKind};

/// The colour at `uv`.
pub fn evaluate(scene: &Scene, input: &ColorInput, uv: DVec2) -> DVec3 {
    match *input {
        ColorInput::Constant(color) => color,
        ColorInput::Texture(texture) => look_up(&scene.textures, texture, uv),
        ColorInput::ScaledTexture(texture, factor) => factor * look_up(&scene.textures, texture, uv),
        ColorInput::SquaredTexture(texture) => look_up(&scene.textures, texture, uv).powf(2.0),
    }
}

/// The colour's mean over the whole texture; of noise, the middle between its two colours.
pub fn mean(scene: &Scene, input: &ColorInput) -> DVec3 {
    match *input {
        ColorInput::Constant(color) => color,
        ColorInput::Texture(texture) => mean_of_texture(scene, texture),
        ColorInput::ScaledTexture(texture, factor) => factor * mean_of_texture(scene, texture),
        ColorInput::SquaredTexture(texture) => mean_of_texture(scene, texture).powf(2.0),
    }
}

/// The colour of one of the scene's textures at `uv`.
pub fn look_up(textures: &[Texture], texture: TextureId, uv: DVec2) -> DVec3 {
    match textures[texture].kind {
        TextureKind::Image(ref image) => image::sample(image, uv),
        TextureKind::Checker { a, b, scale } => {
            if checker::is_first(uv, scale) {
                a
            } else {
                b
            }
        }
        TextureKind::Perlin { scale, octaves, a, b, seed } => a + perlin::share(uv * scale, octaves, seed) * (b - a),
        TextureKind::Worley { scale, a, b, seed } => a + worley::share(uv * scale, seed) * (b - a),
    }
}

fn mean_of_texture(scene: &Scene, texture: TextureId) -> DVec3 {
    match scene.textures[texture].kind {
        TextureKind::Image(ref image) => image::mean(image),
        TextureKind::Checker { a, b, .. } | TextureKind::Perlin { a, b, .. } | TextureKind::Worley { a, b, .. } => 0.5 * (a + b),
    }
}
