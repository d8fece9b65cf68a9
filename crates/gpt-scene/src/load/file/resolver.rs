//! A scene in the making: what is known of a scene file while its tables are read one after the other.

use std::cell::RefCell;
use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::DVec3;

use super::colour::{Colour, Scalar, TextureReference};
use super::document::Document;
use super::reference::{FileOr, TextureName};
use super::suggestion::did_you_mean_name;
use super::value::{Located, Rule, Vector, vector};
use crate::load::access::Access;
use crate::load::error::{MOST_ERRORS, SceneError, show};
use crate::load::files::Files;
use crate::load::image_file::{DecodedImage, EmbeddedFile, PictureSource, Pictures};
use crate::load::model::Substitute;
use crate::load::place::Place;
use crate::load::volume::PlacedGrid;
use crate::picture_file::Hints;
use crate::scene::animation::Deformation;
use crate::scene::light::LightProfile;
use crate::scene::texture::{KnownRanges, range_of_texture};
use crate::scene::{
    Channel, ChannelInput, ColorInput, ColorSpace, ImageData, Material, MaterialId, MediumId, Mesh, Scene, TextureId,
};
use crate::spectrum::Spectrum;

/// Images by file and by how their values are read, so that each is decoded once.
pub type ImageCache = HashMap<(PictureSource, Option<ColorSpace>), CachedImage>;

/// An image that was read.
pub struct CachedImage {
    pub image: Arc<ImageData>,
    pub integer_bits: Option<u16>,
    /// Repairs of the picture, until they are reported.
    pub change: Option<String>,
    /// Properties that its header states and nothing uses, until they were reported.
    pub notes: Vec<String>,
    pub hints: Hints,
    /// Other programs see the same in the file.
    pub is_plain: bool,
}

impl From<DecodedImage> for CachedImage {
    fn from(DecodedImage { image, integer_bits, change, notes, hints, is_plain }: DecodedImage) -> Self {
        Self { image: Arc::new(image), integer_bits, change, notes, hints, is_plain }
    }
}

/// Key of a mesh file that has been read: the file, `smooth`, and, where it keeps its own materials, the ones
/// that are replaced.
pub type MeshFileKey = (PathBuf, Option<bool>, Option<Vec<(String, MaterialId)>>);

/// Key of a grid that has been read: its file, and the name that was asked for.
pub type GridKey = (PathBuf, Option<String>);

/// A mesh and its material, or that of its first face where faces have their own.
#[derive(Clone)]
pub struct LoadedMesh {
    pub mesh: Arc<Mesh>,
    pub material: MaterialId,
}

/// A scene in the making.
pub struct Resolver<'a> {
    pub(super) document: Document<'a>,
    /// Folder to which paths in the file are relative.
    pub(super) folder: &'a Path,
    pub(super) pictures: Pictures,
    pub(super) strict: bool,
    /// Mistakes so far; reading goes on to find more.
    pub(super) errors: Vec<SceneError>,
    pub(super) scene: Scene,
    pub(super) texture_names: HashMap<String, TextureId>,
    pub(super) material_names: HashMap<String, MaterialId>,
    pub(super) medium_names: HashMap<String, MediumId>,
    pub(super) node_names: HashMap<String, usize>,
    pub(super) images: ImageCache,
    /// Per texture: an image whose colour space is written to be linear.
    pub(super) linear_textures: Vec<bool>,
    pub(super) mesh_files: HashMap<MeshFileKey, LoadedMesh>,
    pub(super) grids: HashMap<GridKey, PlacedGrid>,
    pub(super) profiles: HashMap<PictureSource, Arc<LightProfile>>,
    /// True, for each material asked for so far, where it or a part of it looks up a texture.
    textured: Vec<bool>,
    ranges: RefCell<KnownRanges>,
    /// Deformation of the mesh that was read last.
    pub(super) deformation: Option<Deformation>,
    /// The material of faces that name none.
    pub(super) unnamed_material: Option<MaterialId>,
    /// Names of receivers that lamps list.
    pub(super) linked_receivers: Vec<Located<String>>,
}

impl<'a> Resolver<'a> {
    pub(super) fn new(document: Document<'a>, folder: &'a Path, access: Access) -> Self {
        Self {
            document,
            folder,
            pictures: Pictures::new(access.files),
            strict: access.strict,
            errors: Vec::new(),
            scene: Scene::default(),
            texture_names: HashMap::new(),
            material_names: HashMap::new(),
            medium_names: HashMap::new(),
            node_names: HashMap::new(),
            images: Default::default(),
            linear_textures: Vec::new(),
            mesh_files: HashMap::new(),
            grids: HashMap::new(),
            profiles: HashMap::new(),
            textured: Vec::new(),
            ranges: RefCell::default(),
            deformation: None,
            unnamed_material: None,
            linked_receivers: Vec::new(),
        }
    }

    /// The scene, each of its warnings once.
    ///
    /// # Errors
    /// All that was noted on the way.
    pub(super) fn finish(mut self) -> Result<Scene, SceneError> {
        if let Some(error) = SceneError::of_all(self.errors) {
            return Err(error);
        }
        let mut seen = HashSet::new();
        self.scene.warnings.retain(|warning| seen.insert(warning.clone()));
        Ok(self.scene)
    }

    /// The value, or a note of what is wrong with it. More mistakes than are reported are not noted.
    pub(super) fn note<T>(&mut self, result: Result<T, SceneError>) -> Option<T> {
        let is_full = self.has_enough_errors();
        result
            .map_err(|error| {
                if !is_full {
                    self.errors.push(error)
                }
            })
            .ok()
    }

    fn has_enough_errors(&self) -> bool {
        self.errors.len() >= MOST_ERRORS
    }

    pub(super) fn files(&self) -> &Files {
        self.pictures.files()
    }

    /// Notes that something missing or wrong in a file was replaced.
    ///
    /// # Errors
    /// The substitution itself, where it is not allowed.
    pub(super) fn substitute(&mut self, file: &Path, Substitute { line, what }: Substitute) -> Result<(), SceneError> {
        let error = match line {
            Some(line) => SceneError::in_line(show(file), line, what),
            None => SceneError::in_file(show(file), what),
        };
        if self.strict {
            return Err(error.with_help("without --strict, this is a warning"));
        }
        self.scene.warnings.push(error.to_string());
        Ok(())
    }

    /// Properties of a picture that was read which matter for some uses alone.
    pub(super) fn hints(&self, file: &PictureSource, space: Option<ColorSpace>) -> Hints {
        self.images.get(&(file.clone(), space)).map_or_else(Hints::default, |cached| cached.hints.clone())
    }

    /// Notes what a picture's header says that is not used.
    ///
    /// # Errors
    /// The note itself, where it is not allowed.
    pub(super) fn name_unused(&mut self, file: &PictureSource, note: &str) -> Result<(), String> {
        if self.strict {
            return Err(format!("{note}; without --strict, this is a warning"));
        }
        self.scene.warnings.push(format!("{file}: {note}"));
        Ok(())
    }

    /// An error about what is stated at `place`; without its place where it will not be reported, since to find that takes as long as the file is.
    pub(super) fn error(&self, place: &Place, message: impl Into<String>) -> SceneError {
        if self.has_enough_errors() {
            return SceneError::in_file(self.document.name, message);
        }
        self.document.error(place, message)
    }

    /// The picture that an entry names.
    pub(super) fn picture_source(&self, file: &FileOr<EmbeddedFile>) -> PictureSource {
        match file {
            FileOr::InMemory(content) => PictureSource::Embedded(content.clone()),
            FileOr::Written(path) => PictureSource::File(self.folder.join(path)),
            FileOr::OnDisk(path) => PictureSource::File(path.clone()),
        }
    }

    pub(super) fn texture_id(&self, name: &Located<TextureName>) -> Result<TextureId, SceneError> {
        self.look_up(&self.texture_names, name, "texture")
    }

    pub(super) fn material_id(&self, name: &Located<String>) -> Result<MaterialId, SceneError> {
        self.look_up(&self.material_names, name, "material")
    }

    pub(super) fn medium_id(&self, name: &Located<String>) -> Result<MediumId, SceneError> {
        self.look_up(&self.medium_names, name, "medium")
    }

    /// The material or a part of it looks up a texture. Asked only once all materials of the scene file are there.
    pub(super) fn uses_texture(&mut self, id: MaterialId) -> bool {
        if self.textured.is_empty() {
            self.textured = self.scene.materials_that(Material::uses_texture);
        }
        // Materials that model files add consist of earlier ones.
        while let Some(material) = self.scene.materials.get(self.textured.len()) {
            let of_part = material.components().iter().any(|&part| self.textured[part]);
            self.textured.push(of_part || material.uses_texture());
        }
        self.textured[id]
    }

    pub(super) fn look_up<N: AsRef<str>>(
        &self,
        names: &HashMap<String, usize>,
        name: &Located<N>,
        what: &str,
    ) -> Result<usize, SceneError> {
        let wanted = name.value.as_ref();
        if let Some(&id) = names.get(wanted) {
            return Ok(id);
        }
        let error = self.error(&name.place, format!("there is no {what} named `{wanted}`"));
        if self.has_enough_errors() {
            return Err(error); // likenesses are looked for among all names
        }
        let mut choices: Vec<&str> = names.keys().map(String::as_str).collect();
        choices.sort_unstable();
        let help = did_you_mean_name(wanted, &choices).unwrap_or_else(|| format!("the file has no [[{what}]]"));
        Err(error.with_help(help))
    }

    /// Gives every entry its place by its name; a name may be used once.
    pub(super) fn register<'n>(
        &self,
        what: &str,
        names: impl Iterator<Item = &'n Located<String>>,
    ) -> Result<HashMap<String, usize>, SceneError> {
        let mut places = HashMap::new();
        for (place, name) in names.enumerate() {
            if name.value.is_empty() {
                return Err(self.error(&name.place, "a name cannot be empty"));
            }
            if places.insert(name.value.clone(), place).is_some() {
                return Err(self.error(&name.place, format!("a second {what} is named `{}`", name.value)));
            }
        }
        Ok(places)
    }

    /// A vector of length 1.
    pub(super) fn direction(&self, written: &Located<Vector>) -> Result<DVec3, SceneError> {
        let direction = vector(written.value).try_normalize();
        direction.ok_or_else(|| self.error(&written.place, "a direction cannot have length 0"))
    }

    pub(super) fn colour<R: Rule>(&self, written: &Colour<R>) -> Result<ColorInput, SceneError> {
        match written {
            Colour::Constant(colour) => Ok(ColorInput::Constant(colour.0)),
            Colour::Texture(TextureReference { texture, channel, factor }) => {
                let factor = factor.as_ref().map_or(Spectrum::WHITE, |factor| factor.0);
                self.texture_in_range::<R>(texture, *channel, factor)
            }
        }
    }

    /// A texture whose every value is possible where it is used: a reflectance above 1 would make energy. Without a channel its colours count.
    pub(super) fn texture_in_range<R: Rule>(
        &self,
        name: &Located<TextureName>,
        channel: Option<Channel>,
        factor: Spectrum,
    ) -> Result<ColorInput, SceneError> {
        let texture = self.texture_id(name)?;
        let (low, high) = range_of_texture(&self.scene.textures, texture, channel, &mut self.ranges.borrow_mut());
        let input = match channel {
            Some(channel) => ColorInput::Channel(ChannelInput { texture, channel, factor, is_squared: false }),
            None if factor == Spectrum::WHITE => ColorInput::Texture(texture),
            None => ColorInput::ScaledTexture(texture, factor),
        };
        let ends = [
            low * factor.min_component(),
            low * factor.max_component(),
            high * factor.min_component(),
            high * factor.max_component(),
        ];
        match ends.into_iter().find(|&value| !R::accepts(value)) {
            None => Ok(input),
            Some(found) => {
                let times = if factor == Spectrum::WHITE { "" } else { " times its factor" };
                let message = format!("expected {}, found {found} in the texture `{}`{times}", R::WORDS, name.value.0);
                Err(self.error(&name.place, message))
            }
        }
    }

    pub(super) fn colour_or_white<R: Rule>(&self, written: &Option<Colour<R>>) -> Result<ColorInput, SceneError> {
        written.as_ref().map_or(Ok(ColorInput::grey(1.0)), |colour| self.colour(colour))
    }

    pub(super) fn scalar<R: Rule>(&self, written: &Scalar<R>) -> Result<ColorInput, SceneError> {
        match written {
            Scalar::Constant(value) => Ok(ColorInput::grey(value.0)),
            Scalar::Texture(TextureReference { texture, channel, factor }) => {
                let factor = Spectrum::grey(factor.map_or(1.0, |factor| factor.0));
                self.texture_in_range::<R>(texture, Some(channel.unwrap_or(Channel::R)), factor)
            }
        }
    }
}
