//! Directives, one after the other: they change the graphics state, and put what they describe into the world.

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use flate2::read::MultiGzDecoder;
use glam::{DAffine3, DVec3};

use super::color_space::RgbSpace;
use super::graphics_state::{GraphicsState, Maps, MaterialName, TARGETS, look_at, matrix, rotation};
use super::lexer::{Lexeme, Lexer, Token};
use super::parameter::{Entity, Parameter, number, read_parameters};
use super::text::{SourceText, Spot};
use super::world::{CameraRecord, InstanceRecord, LightRecord, ObjectRecord, PlacedEntity, ShapeRecord, World};
use crate::load::encoding;
use crate::load::error::{SceneError, show};
use crate::load::file::did_you_mean_name;
use crate::load::files::{Files, MOST_SCENE_BYTES};
use crate::load::import::{ImportReport, MOST_SHAPES};
use crate::load::memory;

/// Most files that include each other.
const DEEPEST_INCLUDE: usize = 32;
/// Most files in all.
const MOST_INCLUDES: usize = 10_000;
/// Most blocks within each other.
const DEEPEST_BLOCK: usize = 10_000;
/// Bytes that a directive takes, and how many of them there are before it is asked whether there is memory for them.
const DIRECTIVE_BYTES: u64 = 1 << 10;
const MANY_DIRECTIVES: u64 = 1 << 20;
/// Bytes of a packed file once it is unpacked: so many for each of its own, and beside.
const MOST_UNPACKED: (u64, u64) = (128, 1 << 24);

const DIRECTIVES: [&str; 39] = [
    "Accelerator",
    "ActiveTransform",
    "AreaLightSource",
    "Attribute",
    "AttributeBegin",
    "AttributeEnd",
    "Camera",
    "ColorSpace",
    "ConcatTransform",
    "CoordSysTransform",
    "CoordinateSystem",
    "Film",
    "Identity",
    "Import",
    "Include",
    "Integrator",
    "LightSource",
    "LookAt",
    "MakeNamedMaterial",
    "MakeNamedMedium",
    "Material",
    "MediumInterface",
    "NamedMaterial",
    "ObjectBegin",
    "ObjectEnd",
    "ObjectInstance",
    "Option",
    "PixelFilter",
    "ReverseOrientation",
    "Rotate",
    "Sampler",
    "Scale",
    "Shape",
    "Texture",
    "Transform",
    "TransformBegin",
    "TransformEnd",
    "TransformTimes",
    "Translate",
];

/// A block that is open: of attributes, with the state before it, or of an object.
enum Block {
    Attributes(Spot, Box<GraphicsState>),
    Object(Spot, Box<GraphicsState>),
}

/// Reads directives.
pub struct Reader<'a> {
    files: &'a Files,
    /// Paths are relative to the folder of the scene's first file.
    folder: PathBuf,
    pub world: World,
    pub report: ImportReport,
    state: GraphicsState,
    blocks: Vec<Block>,
    coordinate_systems: HashMap<String, Maps>,
    object: Option<ObjectRecord>,
    is_world: bool,
    /// Files that are read, the first one first.
    within: Vec<PathBuf>,
    included: usize,
    directives: u64,
    shapes: usize,
}

impl<'a> Reader<'a> {
    pub fn new(files: &'a Files, folder: PathBuf) -> Self {
        Self {
            files,
            folder,
            world: World::new(),
            report: ImportReport::default(),
            state: GraphicsState::default(),
            blocks: Vec::new(),
            coordinate_systems: HashMap::new(),
            object: None,
            is_world: false,
            within: Vec::new(),
            included: 0,
            directives: 0,
            shapes: 0,
        }
    }

    /// Reads a scene file and all that it includes.
    ///
    /// # Errors
    /// A directive that is not one, or that says what cannot be.
    pub fn scene(&mut self, path: &Path) -> Result<(), SceneError> {
        let source = self.source(path)?;
        self.world.materials.push(Rc::new(default_material(&source)));
        self.file(path, source)?;
        if !self.is_world {
            let error =
                SceneError::in_file(show(path), "there is no WorldBegin: it is a part of a scene, which another file includes");
            return Err(error.with_help("name the file that has the Camera and WorldBegin"));
        }
        Ok(())
    }

    fn source(&self, path: &Path) -> Result<Rc<SourceText>, SceneError> {
        let name = show(path);
        let refused = |error: std::io::Error| SceneError::in_file(&name, format!("cannot be read: {error}"));
        let mut bytes = self.files.read(path, MOST_SCENE_BYTES).map_err(refused)?;
        if bytes.starts_with(&[0x1f, 0x8b]) {
            let (factor, first) = MOST_UNPACKED;
            let most = (bytes.len() as u64).saturating_mul(factor).saturating_add(first).min(MOST_SCENE_BYTES);
            let mut unpacked = Vec::new();
            MultiGzDecoder::new(&*bytes).take(most + 1).read_to_end(&mut unpacked).map_err(refused)?;
            if unpacked.len() as u64 > most {
                let what = format!("unpacked, it is more than the {} MiB that are read of a file of its size", most >> 20);
                return Err(SceneError::in_file(&name, what));
            }
            bytes = unpacked.into();
        }
        let (text, _) = encoding::decode(&bytes);
        Ok(Rc::new(SourceText { text: text.into_owned(), name }))
    }

    /// Reads a file whose blocks end within it.
    fn file(&mut self, path: &Path, source: Rc<SourceText>) -> Result<(), SceneError> {
        self.within.push(path.to_owned());
        let outer = self.blocks.len();
        let mut lexer = Lexer::new(source);
        while let Some(lexeme) = lexer.next()? {
            if lexeme.token != Token::Word {
                let found = lexer.word(lexeme);
                return Err(lexer.spot(lexeme).error(format!("a directive is expected here, as Shape, and not {found}")));
            }
            self.directive(&mut lexer, lexeme)?;
        }
        self.within.pop();
        match self.blocks.get(outer) {
            None => Ok(()),
            Some(Block::Attributes(spot, _)) => Err(spot.error("this block has no AttributeEnd in its file")),
            Some(Block::Object(spot, _)) => Err(spot.error("this object has no ObjectEnd in its file")),
        }
    }

    fn directive(&mut self, lexer: &mut Lexer, lexeme: Lexeme) -> Result<(), SceneError> {
        let written = lexer.word(lexeme).to_owned();
        let spot = lexer.spot(lexeme);
        self.count(&spot)?;
        match written.as_str() {
            "Identity" => self.state.each_map(|_| DAffine3::IDENTITY),
            "Translate" => {
                let [x, y, z] = numbers(lexer, &spot)?;
                self.concatenate(&spot, Some(DAffine3::from_translation(DVec3::new(x, y, z))))?;
            }
            "Scale" => {
                let [x, y, z] = numbers(lexer, &spot)?;
                if x * y * z == 0.0 {
                    return Err(spot.error("a scale by 0 leaves nothing"));
                }
                self.concatenate(&spot, Some(DAffine3::from_scale(DVec3::new(x, y, z))))?;
            }
            "Rotate" => {
                let [degrees, x, y, z] = numbers(lexer, &spot)?;
                let map = rotation(degrees, DVec3::new(x, y, z));
                let map = map.ok_or_else(|| spot.error("the axis of a rotation has no length"))?;
                self.concatenate(&spot, Some(map))?;
            }
            "LookAt" => {
                let numbers: [f64; 9] = numbers(lexer, &spot)?;
                let [eye, target, up] = [0, 3, 6].map(|at| DVec3::from_slice(&numbers[at..at + 3]));
                let map = look_at(eye, target, up).ok_or_else(|| {
                    spot.error(
                        "what is up lies along the viewing direction, or the target is the eye, so which way is up is not known",
                    )
                })?;
                self.concatenate(&spot, Some(map))?;
            }
            "Transform" | "ConcatTransform" => {
                let map = matrix(&numbers(lexer, &spot)?);
                let map =
                    map.ok_or_else(|| spot.error("the last row of the matrix is not 0, 0, 0, 1 (numbers are column by column)"))?;
                if written == "Transform" {
                    self.state.each_map(|_| DAffine3::IDENTITY);
                }
                self.concatenate(&spot, Some(map))?;
            }
            "CoordinateSystem" => {
                let name = quoted(lexer, &spot)?;
                self.coordinate_systems.insert(name, self.state.maps);
            }
            "CoordSysTransform" => {
                let name = quoted(lexer, &spot)?;
                match self.coordinate_systems.get(&name) {
                    Some(maps) => self.state.maps = *maps,
                    None => return Err(unknown("coordinate system", &name, &spot, self.coordinate_systems.keys())),
                }
            }
            "ActiveTransform" => {
                let which = lexer.next()?.map(|lexeme| lexer.word(lexeme).to_owned()).unwrap_or_default();
                self.state.active = match which.as_str() {
                    "StartTime" => [true, false],
                    "EndTime" => [false, true],
                    "All" => [true, true],
                    _ => return Err(spot.error(format!("ActiveTransform is StartTime, EndTime or All, and not `{which}`"))),
                };
            }
            "TransformTimes" => {
                self.world.transform_times = numbers(lexer, &spot)?;
                self.only_before_world(&written, &spot)?;
            }
            "AttributeBegin" | "TransformBegin" => {
                self.only_in_world(&written, &spot)?;
                self.open(Block::Attributes(spot, Box::new(self.state.clone())))?;
            }
            "AttributeEnd" | "TransformEnd" => match self.blocks.pop() {
                Some(Block::Attributes(_, state)) => self.state = *state,
                Some(Block::Object(begin, _)) => {
                    return Err(spot.error(format!("{written} within the object that begins at {begin}")));
                }
                None => return Err(spot.error(format!("{written} without a begin"))),
            },
            "Attribute" => self.attribute(lexer, &spot)?,
            "ReverseOrientation" => {
                self.only_in_world(&written, &spot)?;
                self.state.reverses = !self.state.reverses;
            }
            "ColorSpace" => {
                let name = quoted(lexer, &spot)?;
                let space = RgbSpace::named(&name);
                self.state.space = space.ok_or_else(|| {
                    spot.error(format!("there is no colour space `{name}`"))
                        .with_help(format!("there are {}", RgbSpace::NAMES.join(", ")))
                })?;
            }
            "Option" => {
                let name = quoted(lexer, &spot)?;
                lexer.next()?.ok_or_else(|| spot.error(format!("the option `{name}` has no value")))?;
                self.option(&name, &spot);
            }
            "Include" | "Import" => self.include(lexer, &written, &spot)?,
            "WorldBegin" => {
                self.only_before_world(&written, &spot)?;
                self.is_world = true;
                self.state.maps = [DAffine3::IDENTITY; 2];
                self.state.active = [true; 2];
                self.coordinate_systems.insert("world".to_owned(), self.state.maps);
            }
            // Versions before 4 had it.
            "WorldEnd" => {}
            "MediumInterface" => {
                let inside = quoted(lexer, &spot)?;
                let second = lexer.peek()?.filter(|lexeme| lexeme.token == Token::Quoted);
                let outside = if second.is_some() { quoted(lexer, &spot)? } else { inside.clone() };
                (self.state.inside, self.state.outside) = (inside.into(), outside.into());
            }
            "NamedMaterial" => {
                self.only_in_world(&written, &spot)?;
                self.state.material = MaterialName::Named(quoted(lexer, &spot)?);
            }
            "ObjectBegin" => self.begin_object(lexer, spot)?,
            "ObjectEnd" => self.end_object(&spot)?,
            "ObjectInstance" => {
                self.only_in_world(&written, &spot)?;
                let name = quoted(lexer, &spot)?;
                if self.object.is_some() {
                    return Err(spot.error("an instance within an object: objects hold shapes alone"));
                }
                self.counted_shape(&spot)?;
                self.world.instances.push(InstanceRecord { name, spot, maps: self.state.maps });
            }
            _ => self.entity_directive(lexer, &written, spot)?,
        }
        Ok(())
    }

    /// Directives with a type and parameters.
    fn entity_directive(&mut self, lexer: &mut Lexer, written: &str, spot: Spot) -> Result<(), SceneError> {
        match written {
            "Shape" => self.shape(lexer, spot),
            "Texture" => self.texture(lexer, spot),
            "Camera" => {
                let entity = self.before_world("Camera", lexer, spot)?;
                let inverses = self.state.maps.map(|map| map.inverse());
                if !inverses.iter().all(DAffine3::is_finite) {
                    return Err(entity.error("the transform before the camera flattens the world"));
                }
                self.coordinate_systems.insert("camera".to_owned(), inverses);
                self.world.camera = Some(CameraRecord { entity, maps: self.state.maps, medium: self.state.outside.clone() });
                Ok(())
            }
            "Film" => {
                self.world.film = Some(self.before_world("Film", lexer, spot)?);
                Ok(())
            }
            "Sampler" => {
                self.world.sampler = Some(self.before_world("Sampler", lexer, spot)?);
                Ok(())
            }
            "PixelFilter" => {
                self.world.filter = Some(self.before_world("PixelFilter", lexer, spot)?);
                Ok(())
            }
            "Integrator" => {
                self.world.integrator = Some(self.before_world("Integrator", lexer, spot)?);
                Ok(())
            }
            // How rays find surfaces changes nothing of the picture.
            "Accelerator" => self.before_world("Accelerator", lexer, spot).map(|_| ()),
            "LightSource" => {
                let entity = self.entity("LightSource", "light", lexer, spot)?;
                self.counted_shape(&entity.spot)?;
                self.world.lights.push(LightRecord { entity, maps: self.state.maps });
                Ok(())
            }
            "AreaLightSource" => {
                self.state.light = Some(Rc::new(self.entity("AreaLightSource", "light", lexer, spot)?));
                Ok(())
            }
            "Material" => {
                let entity = self.entity("Material", "material", lexer, spot)?;
                self.state.material = MaterialName::Written(self.world.materials.len());
                self.world.materials.push(Rc::new(entity));
                Ok(())
            }
            "MakeNamedMaterial" => {
                let entity = self.typed(self.entity("MakeNamedMaterial", "material", lexer, spot)?)?;
                let (name, entity) = entity;
                insert(&mut self.world.named_materials, "material", name, entity.into(), |entity: &Rc<Entity>| {
                    entity.spot.clone()
                })
            }
            "MakeNamedMedium" => {
                let around = self.state.around("medium");
                let entity = self.named_entity("MakeNamedMedium", around, lexer, spot)?;
                let (name, entity) = self.typed(entity)?;
                let placed = Rc::new(PlacedEntity { entity, maps: self.state.maps });
                insert(&mut self.world.media, "medium", name, placed, |placed: &Rc<PlacedEntity>| placed.entity.spot.clone())
            }
            "SurfaceIntegrator" | "VolumeIntegrator" | "Renderer" | "Volume" => {
                let error = spot.error(format!("{written} is a directive of versions before 4"));
                Err(error.with_help("`pbrt --upgrade` of version 4 writes scenes of version 3 anew"))
            }
            other => {
                let error = spot.error(format!("there is no directive `{other}`"));
                Err(match did_you_mean_name(other, &DIRECTIVES) {
                    Some(help) => error.with_help(help),
                    None => error,
                })
            }
        }
    }

    /// Refuses a scene of more directives than there is memory for.
    fn count(&mut self, spot: &Spot) -> Result<(), SceneError> {
        self.directives += 1;
        let needed = self.directives * DIRECTIVE_BYTES;
        if self.directives.is_multiple_of(MANY_DIRECTIVES) && needed > memory::available() {
            let (directives, needed) = (self.directives, needed >> 20);
            return Err(spot.error(format!(
                "the scene does not fit: up to here it has {directives} directives, which take about {needed} MiB"
            )));
        }
        Ok(())
    }

    fn counted_shape(&mut self, spot: &Spot) -> Result<(), SceneError> {
        self.shapes += 1;
        if self.shapes > MOST_SHAPES {
            return Err(spot.error(format!("the scene has more than {MOST_SHAPES} shapes, instances counted")));
        }
        Ok(())
    }

    /// Puts a map before those that are in force.
    fn concatenate(&mut self, spot: &Spot, map: Option<DAffine3>) -> Result<(), SceneError> {
        let Some(map) = map else { return Ok(()) };
        self.state.each_map(|before| before * map);
        if self.state.maps.iter().all(DAffine3::is_finite) {
            Ok(())
        } else {
            Err(spot.error("the transform leaves the range of numbers"))
        }
    }

    fn open(&mut self, block: Block) -> Result<(), SceneError> {
        if self.blocks.len() >= DEEPEST_BLOCK {
            let (Block::Attributes(spot, _) | Block::Object(spot, _)) = &block;
            return Err(spot.error(format!("blocks lie more than {DEEPEST_BLOCK} deep within each other")));
        }
        self.blocks.push(block);
        Ok(())
    }

    fn only_in_world(&self, directive: &str, spot: &Spot) -> Result<(), SceneError> {
        if self.is_world { Ok(()) } else { Err(spot.error(format!("{directive} belongs behind WorldBegin"))) }
    }

    fn only_before_world(&self, directive: &str, spot: &Spot) -> Result<(), SceneError> {
        if self.is_world { Err(spot.error(format!("{directive} belongs before WorldBegin"))) } else { Ok(()) }
    }

    /// A directive with its type and its parameters, and those of the attributes around it.
    fn named_entity(
        &self,
        directive: &'static str,
        around: Vec<Rc<Parameter>>,
        lexer: &mut Lexer,
        spot: Spot,
    ) -> Result<Entity, SceneError> {
        let name = quoted(lexer, &spot)?;
        let own = read_parameters(lexer, self.state.space)?;
        Ok(Entity::new(directive, name, spot, own, around, self.state.space))
    }

    fn before_world(&self, directive: &'static str, lexer: &mut Lexer, spot: Spot) -> Result<Entity, SceneError> {
        self.only_before_world(directive, &spot)?;
        self.named_entity(directive, Vec::new(), lexer, spot)
    }

    fn entity(&self, directive: &'static str, target: &str, lexer: &mut Lexer, spot: Spot) -> Result<Entity, SceneError> {
        self.only_in_world(directive, &spot)?;
        self.named_entity(directive, self.state.around(target), lexer, spot)
    }

    /// A directive whose text is a name, and whose type is a parameter.
    fn typed(&self, entity: Entity) -> Result<(String, Entity), SceneError> {
        let kind = entity
            .text("type")?
            .ok_or_else(|| entity.error(format!("{} needs the parameter \"string type\"", entity.title())))?;
        let kind = kind.to_owned();
        let name = entity.name.clone();
        Ok((name, entity.of_type(kind)))
    }

    fn shape(&mut self, lexer: &mut Lexer, spot: Spot) -> Result<(), SceneError> {
        let entity = self.entity("Shape", "shape", lexer, spot)?;
        self.counted_shape(&entity.spot)?;
        let state = &self.state;
        let shape = ShapeRecord {
            entity,
            maps: state.maps,
            reverses: state.reverses,
            material: state.material.clone(),
            light: state.light.clone(),
            inside: state.inside.clone(),
            outside: state.outside.clone(),
        };
        match &mut self.object {
            Some(object) => object.shapes.push(shape),
            None => self.world.shapes.push(shape),
        }
        Ok(())
    }

    fn texture(&mut self, lexer: &mut Lexer, spot: Spot) -> Result<(), SceneError> {
        let name = quoted(lexer, &spot)?;
        let kind = quoted(lexer, &spot)?;
        let entity = self.entity("Texture", "texture", lexer, spot)?;
        let textures = match kind.as_str() {
            "float" => &mut self.world.float_textures,
            "spectrum" | "color" => &mut self.world.spectrum_textures,
            _ => return Err(entity.error(format!("a texture is of float or of spectrum, and not of `{kind}`"))),
        };
        let placed = Rc::new(PlacedEntity { entity, maps: self.state.maps });
        insert(textures, "texture", name, placed, |placed: &Rc<PlacedEntity>| placed.entity.spot.clone())
    }

    fn attribute(&mut self, lexer: &mut Lexer, spot: &Spot) -> Result<(), SceneError> {
        let target = quoted(lexer, spot)?;
        let parameters = read_parameters(lexer, self.state.space)?;
        let Some(index) = TARGETS.iter().position(|known| *known == target) else {
            return Err(spot.error(format!("Attribute is of {}, and not of `{target}`", TARGETS.join(", "))));
        };
        self.state.attributes[index].extend(parameters);
        Ok(())
    }

    fn option(&mut self, name: &str, spot: &Spot) {
        let plain: String = name.chars().filter(char::is_ascii_alphanumeric).collect::<String>().to_ascii_lowercase();
        let what = format!("Option `{name}`");
        match plain.as_str() {
            // They say how it is rendered, and not what.
            "seed"
            | "rendercoordsys"
            | "wavefront"
            | "pixelstats"
            | "msereferenceimage"
            | "msereferenceout"
            | "disablewavelengthjitter"
            | "disabletexturefiltering" => {}
            _ => self.report.drop(what, spot.to_string(), "it has no effect"),
        }
    }

    fn include(&mut self, lexer: &mut Lexer, directive: &str, spot: &Spot) -> Result<(), SceneError> {
        let written = quoted(lexer, spot)?;
        if directive == "Import" {
            self.only_in_world(directive, spot)?;
        }
        let found = self.files.find(&self.folder, &written);
        let path = found.ok_or_else(|| spot.error(format!("there is no file {written}")))?.path;
        if self.within.contains(&path) {
            return Err(spot.error(format!("{} includes itself", show(&path))));
        }
        if self.within.len() >= DEEPEST_INCLUDE {
            return Err(spot.error(format!("files include each other more than {DEEPEST_INCLUDE} deep")));
        }
        self.included += 1;
        if self.included > MOST_INCLUDES {
            return Err(spot.error(format!("the scene includes more than {MOST_INCLUDES} files")));
        }
        let source = self.source(&path).map_err(|error| error.with_help(format!("{spot} names it")))?;
        // The state that an imported file sets ends with it.
        let state = (directive == "Import").then(|| self.state.clone());
        self.file(&path, source)?;
        self.state = state.unwrap_or_else(|| std::mem::take(&mut self.state));
        Ok(())
    }

    fn begin_object(&mut self, lexer: &mut Lexer, spot: Spot) -> Result<(), SceneError> {
        self.only_in_world("ObjectBegin", &spot)?;
        let name = quoted(lexer, &spot)?;
        if let Some(object) = &self.object {
            return Err(spot.error(format!("an object within the object that begins at {}", object.spot)));
        }
        if let Some(known) = self.world.object_numbers.get(&name) {
            let before = &self.world.objects[*known].spot;
            return Err(spot.error(format!("there is an object `{name}` already, at {before}")));
        }
        self.object = Some(ObjectRecord { name, spot: spot.clone(), shapes: Vec::new() });
        self.open(Block::Object(spot, Box::new(self.state.clone())))
    }

    fn end_object(&mut self, spot: &Spot) -> Result<(), SceneError> {
        match self.blocks.pop() {
            Some(Block::Object(_, state)) => self.state = *state,
            Some(Block::Attributes(begin, _)) => {
                return Err(spot.error(format!("ObjectEnd within the block that begins at {begin}")));
            }
            None => return Err(spot.error("ObjectEnd without a begin")),
        }
        if let Some(object) = self.object.take() {
            self.world.object_numbers.insert(object.name.clone(), self.world.objects.len());
            self.world.objects.push(object);
        }
        Ok(())
    }
}

/// A diffuse grey of 0.5.
fn default_material(source: &Rc<SourceText>) -> Entity {
    let spot = Spot { source: source.clone(), start: 0, end: 0, line: 1 };
    Entity::new("Material", "diffuse".to_owned(), spot, Vec::new(), Vec::new(), RgbSpace::Srgb)
}

/// Notes a thing by its name.
fn insert<T>(
    known: &mut HashMap<String, T>,
    what: &str,
    name: String,
    thing: T,
    place: impl Fn(&T) -> Spot,
) -> Result<(), SceneError> {
    match known.entry(name) {
        Entry::Vacant(free) => {
            free.insert(thing);
            Ok(())
        }
        Entry::Occupied(taken) => {
            let before = place(taken.get());
            Err(place(&thing).error(format!("there is a {what} `{}` already, at {before}", taken.key())))
        }
    }
}

/// The error about a name that stands for nothing.
pub fn unknown<'n>(what: &str, name: &str, spot: &Spot, known: impl Iterator<Item = &'n String>) -> SceneError {
    let error = spot.error(format!("there is no {what} `{name}`"));
    let mut known: Vec<&str> = known.map(String::as_str).collect();
    known.sort_unstable();
    match did_you_mean_name(name, &known) {
        Some(help) => error.with_help(help),
        None => error,
    }
}

/// A text in quotes behind a directive.
fn quoted(lexer: &mut Lexer, spot: &Spot) -> Result<String, SceneError> {
    match lexer.next()? {
        Some(lexeme) if lexeme.token == Token::Quoted => lexer.text(lexeme),
        Some(other) => Err(lexer.spot(other).error(format!("a text in quotes is expected here, and not {}", lexer.word(other)))),
        None => Err(spot.error("the file ends behind this")),
    }
}

/// So many numbers behind a directive, in brackets or not.
fn numbers<const N: usize>(lexer: &mut Lexer, spot: &Spot) -> Result<[f64; N], SceneError> {
    let is_list = lexer.peek()?.is_some_and(|lexeme| lexeme.token == Token::Open);
    if is_list {
        lexer.next()?;
    }
    let mut numbers = [0.0; N];
    for place in &mut numbers {
        let lexeme = lexer.next()?.ok_or_else(|| spot.error(format!("the file ends where {N} numbers should be")))?;
        let found = (lexeme.token == Token::Word).then(|| number(lexer.word(lexeme))).flatten();
        *place = found.ok_or_else(|| {
            lexer.spot(lexeme).error(format!("{N} numbers are expected here, and this is {}", lexer.word(lexeme)))
        })?;
    }
    if is_list {
        match lexer.next()? {
            Some(lexeme) if lexeme.token == Token::Close => {}
            Some(other) => return Err(lexer.spot(other).error(format!("a ] is expected behind {N} numbers"))),
            None => return Err(spot.error("the file ends before a ]")),
        }
    }
    Ok(numbers)
}
