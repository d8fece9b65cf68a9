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
pub mod gradient;
mod image;
mod lattice;
mod perlin;
mod worley;

use glam::DVec2;

use crate::scene::texture::{mean_of_channel, mean_of_texture};
use crate::scene::{Channel, ChannelInput, ColorInput, Scene, Texture, TextureId, TextureKind};
use crate::spectrum::Spectrum;

/// Texture coordinates at a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coordinates {
    pub first: DVec2,
    /// The second coordinates, for textures that ask for them; the first where there are none.
    pub second: DVec2,
}

impl Coordinates {
    /// The coordinates that a texture asks for.
    fn of(self, texture: &Texture) -> DVec2 {
        if texture.by_second_uvs { self.second } else { self.first }
    }
}

impl From<DVec2> for Coordinates {
    fn from(uv: DVec2) -> Self {
        Self { first: uv, second: uv }
    }
}

/// The colour at `uv`.
pub fn evaluate(scene: &Scene, input: &ColorInput, uv: Coordinates) -> Spectrum {
    match *input {
        ColorInput::Constant(color) => color,
        ColorInput::Texture(texture) => look_up(&scene.textures, texture, uv),
        ColorInput::ScaledTexture(texture, factor) => factor * look_up(&scene.textures, texture, uv),
        ColorInput::SquaredTexture(texture) => look_up(&scene.textures, texture, uv).map(|channel| channel.powf(2.0)),
        ColorInput::Channel(ChannelInput { texture, channel, factor, is_squared }) => {
            let value = factor * look_up_channel(&scene.textures, texture, channel, uv);
            if is_squared { value * value } else { value }
        }
    }
}

/// The colour's mean over the whole texture; of noise, the middle between its two colours.
pub fn mean(scene: &Scene, input: &ColorInput) -> Spectrum {
    match *input {
        ColorInput::Constant(color) => color,
        ColorInput::Texture(texture) => mean_of_texture(&scene.textures, texture),
        ColorInput::ScaledTexture(texture, factor) => factor * mean_of_texture(&scene.textures, texture),
        ColorInput::SquaredTexture(texture) => mean_of_texture(&scene.textures, texture).map(|channel| channel.powf(2.0)),
        ColorInput::Channel(ChannelInput { texture, channel, factor, .. }) => {
            factor * mean_of_channel(&scene.textures, texture, channel)
        }
    }
}

/// The colour of one of the scene's textures at `uv`.
pub fn look_up(textures: &[Texture], texture: TextureId, uv: impl Into<Coordinates>) -> Spectrum {
    let [red, green, blue, _] = texels(textures, texture, uv);
    Spectrum::new(red, green, blue)
}

/// One of its channels.
pub fn look_up_channel(textures: &[Texture], texture: TextureId, channel: Channel, uv: Coordinates) -> f64 {
    channel.of(texels(textures, texture, uv))
}

/// All of its channels, times those of the texture by which it is multiplied.
fn texels(textures: &[Texture], texture: TextureId, uv: impl Into<Coordinates>) -> [f64; 4] {
    let (texture, uv) = (&textures[texture], uv.into());
    let own = own_texels(texture, uv);
    texture.times.map_or(own, |other| {
        let by = own_texels(&textures[other], uv);
        std::array::from_fn(|channel| own[channel] * by[channel])
    })
}

/// All channels of a texture by itself.
fn own_texels(texture: &Texture, uv: Coordinates) -> [f64; 4] {
    let uv = uv.of(texture);
    let at = |scale: [f64; 2]| texture.placed(uv * DVec2::from(scale));
    let between = |a: Spectrum, b: Spectrum, share: f64| (a + share * (b - a)).extend(1.0).to_array();
    match texture.kind {
        TextureKind::Image(ref image) => image::sample(image, at(image.scale)),
        TextureKind::Checker { a, b, scale } => (if checker::is_first(at(scale)) { a } else { b }).extend(1.0).to_array(),
        TextureKind::Perlin { scale, octaves, a, b, seed } => between(a, b, perlin::share(at([scale; 2]), octaves, seed)),
        TextureKind::Worley { scale, a, b, seed } => between(a, b, worley::share(at([scale; 2]), seed)),
    }
}
