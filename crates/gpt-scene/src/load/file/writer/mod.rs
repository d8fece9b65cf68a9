//! Scene files in the making: what writing any of their entries needs. What an entry's own keys are stands where they are read.

mod names;
mod picture;
mod ply;
mod side_files;
mod value;

use std::sync::Arc;

pub use names::Names;
pub use picture::{picture, picture_format};
pub use ply::ply;
pub use side_files::SideFiles;
pub use side_files::is_on_disk;
pub use value::{colour, direction, flag, numbers, pair_f32, vector, vector_f32};

pub use crate::load::toml_text::{line, list, number, table, text};
use crate::scene::light::LightProfile;
use crate::scene::{Channel, ChannelInput, ColorInput, ColorSpace, ImageData, ImageSource, Mesh, MeshSource, Scene, Shape};

/// A scene file in the making.
pub struct Writer<'s> {
    pub scene: &'s Scene,
    /// Names by which textures and materials are written: each is there once.
    pub textures: Names,
    pub materials: Names,
    pub media: Names,
    pub groups: Names,
    pub nodes: Names,
    pub files: SideFiles,
    /// Pictures that cannot be read are named, with the colours that stand for them.
    pub names_unreadable: bool,
}

impl Writer<'_> {
    /// A line that gives a key this colour or number, which may come from a texture.
    pub fn input(&self, key: &str, input: &ColorInput) -> String {
        line(key, &self.value_of(*input))
    }

    /// The value behind the key.
    pub fn value_of(&self, input: ColorInput) -> String {
        match input {
            ColorInput::Constant(value) => colour(value),
            ColorInput::Texture(id) | ColorInput::SquaredTexture(id) => table([("texture", self.textures.quoted(id))]),
            ColorInput::ScaledTexture(id, scale) => table([("texture", self.textures.quoted(id)), ("factor", colour(scale))]),
            ColorInput::Channel(ChannelInput { texture, channel, factor, .. }) => table([
                ("texture", self.textures.quoted(texture)),
                ("channel", text(channel_name(channel))),
                ("factor", colour(factor)),
            ]),
        }
    }

    /// A picture's file on disk, or one beside the scene file of what stands within another file.
    pub fn file(&mut self, ImageSource { path, embedded, .. }: &ImageSource) -> String {
        let Some(content) = embedded else { return self.files.name_of(path) };
        let ending = path.extension().unwrap_or_default().to_string_lossy().into_owned();
        self.files.add_picture(content.as_ptr() as usize, &ending, || content.to_vec())
    }

    /// The file that a light's profile came from, in quotes; None of one that came from no file on disk.
    pub fn profile_file(&mut self, profile: &Arc<LightProfile>) -> Option<String> {
        let path = self.scene.sources.profile(profile).filter(|path| is_on_disk(path))?;
        Some(self.files.name_of(path))
    }

    /// The line that names a shape's material.
    pub fn material_of(&self, shape: &Shape) -> String {
        line("material", &self.materials.quoted(shape.material))
    }

    /// The file that a picture came from, or else one beside the scene file, once for all that show the picture; the colour space that it is read in, and the factor of its values.
    pub fn image(&mut self, image: &Arc<ImageData>) -> (String, Option<ColorSpace>, f64) {
        let scene = self.scene;
        match scene.sources.image(image).filter(|source| source.embedded.is_some() || is_on_disk(&source.path)) {
            Some(source) => (self.file(source), source.color_space, source.scale),
            None => {
                let (ending, space) = picture_format(image);
                let name = self.files.add_picture(Arc::as_ptr(image) as usize, ending, || picture(image));
                (name, Some(space), 1.0)
            }
        }
    }
}

/// Name of a channel in scene files.
pub fn channel_name(channel: Channel) -> &'static str {
    match channel {
        Channel::R => "r",
        Channel::G => "g",
        Channel::B => "b",
        Channel::A => "a",
    }
}

/// The file that the scene file names for a mesh.
pub fn named_file<'s>(scene: &'s Scene, mesh: &Arc<Mesh>) -> Option<&'s MeshSource> {
    scene.sources.mesh(mesh).filter(|source| is_on_disk(&source.path))
}
