//! Scenes of other programs, by the endings of their names.

use std::path::Path;

use glam::DVec3;

use super::access::LoadOptions;
use super::error::{SceneError, show};
use super::file::colour::{Colour, Rgb};
use super::file::light::{LightEntry, environment};
use super::file::material::{MaterialEntry, diffuse, emissive};
use super::file::shape::{ShapeEntry, plane, rectangle};
use super::file::syntax::CameraTable;
use super::file::value::{Checked, Located};
use super::files::Files;
use super::framing::{FIELD_OF_VIEW, GROUND, LIGHT, ModelStage, SKY};
use super::import::{Description, camera_at};
use super::place::{Origin, Place};
use super::{gltf, mitsuba, pbrt};
use crate::scene::{Plane, Rectangle};
use crate::spectrum::Spectrum;

/// How a scene of another program is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ImportFormat {
    Mitsuba,
    Gltf,
    Pbrt,
}

impl ImportFormat {
    /// By the ending of the file's name; None where it is no scene's.
    pub fn of(path: &Path) -> Option<Self> {
        let name = path.file_name()?.to_string_lossy().to_ascii_lowercase();
        match name.rsplit_once('.')?.1 {
            "xml" => Some(Self::Mitsuba),
            "gltf" | "glb" => Some(Self::Gltf),
            "pbrt" => Some(Self::Pbrt),
            "gz" if name.ends_with(".pbrt.gz") => Some(Self::Pbrt),
            _ => None,
        }
    }
}

/// Reads a scene of another program. What has no camera or no light is framed and lit as a bare model is.
pub fn load(files: &Files, path: &Path, options: &LoadOptions) -> Result<Description, SceneError> {
    let mut description = read(files, path, options)?;
    frame(&mut description, &show(path))?;
    Ok(description)
}

/// Reads a scene of another program as it stands in its file.
pub fn read(files: &Files, path: &Path, options: &LoadOptions) -> Result<Description, SceneError> {
    let name = show(path);
    let description = match ImportFormat::of(path) {
        Some(ImportFormat::Mitsuba) => {
            if let Some(variant) = &options.variant {
                let message = format!("there is no variant `{variant}`: a scene of Mitsuba has no variants of materials");
                return Err(SceneError::in_file(name, message));
            }
            let options = mitsuba::Options { definitions: options.definitions.clone(), camera: options.camera.clone() };
            mitsuba::load(files, path, &options)?
        }
        Some(ImportFormat::Gltf) => gltf::load(files, path, options.camera.as_deref(), options.variant.as_deref())?,
        Some(ImportFormat::Pbrt) => {
            refuse_choices(&name, options)?;
            pbrt::load(files, path)?
        }
        None => {
            return Err(SceneError::in_file(
                name,
                "cannot be imported: it is neither glTF (.gltf, .glb) nor a scene of Mitsuba (.xml) or pbrt (.pbrt)",
            ));
        }
    };
    let is_bare = description.file.shape.is_empty() && description.file.instance.is_empty();
    // A camera and surroundings make a picture without surfaces.
    if is_bare && description.file.light.is_empty() && description.file.camera.is_none() {
        return Err(SceneError::in_file(
            name,
            "there is nothing to render in the scene: it has no surfaces, no lights and no camera",
        ));
    }
    Ok(description)
}

/// A scene of pbrt has one camera, and neither parameters nor variants of materials.
fn refuse_choices(name: &str, options: &LoadOptions) -> Result<(), SceneError> {
    let refused = |what: String| Err(SceneError::in_file(name, what));
    match (&options.camera, options.definitions.first(), &options.variant) {
        (Some(camera), ..) => {
            refused(format!("there is no camera `{camera}` to choose: a scene of pbrt has one, without a name"))
        }
        (_, Some((key, _)), _) => refused(format!("nothing in the scene is called ${key}: a scene of pbrt has no parameters")),
        (.., Some(variant)) => refused(format!("there is no variant `{variant}`: a scene of pbrt has no variants of materials")),
        (None, None, None) => Ok(()),
    }
}

/// Adds what a scene lacks: a camera, and light.
fn frame(description: &mut Description, name: &str) -> Result<(), SceneError> {
    let place = Place::from(Origin { file: name.to_owned(), ..Origin::default() });
    add_stage(description, name, &place)?.map_err(|message| SceneError::in_file(name, message))
}

/// The inner error is a sentence about a number that is out of range.
fn add_stage(description: &mut Description, name: &str, place: &Place) -> Result<Result<(), String>, SceneError> {
    let has_light = description.has_light();
    if description.file.camera.is_some() {
        // The camera may stand anywhere, even where a ground or an emitter would hide what it looks at.
        return Ok(if has_light { Ok(()) } else { add_sky(description, place) });
    }
    let points = description.points();
    if points.is_empty() && has_light {
        return Ok(add_camera(description, DVec3::ZERO, DVec3::NEG_Z, place));
    }
    let ModelStage { ground, light, camera } = ModelStage::around(&points, name)?;
    let mut made = add_camera(description, camera.position, camera.look_at, place);
    if !has_light {
        made = made.and_then(|()| add_sky(description, place)).and_then(|()| add_surfaces(description, ground, light, place));
    }
    Ok(made)
}

fn add_camera(description: &mut Description, position: DVec3, look_at: DVec3, place: &Place) -> Result<(), String> {
    let vfov = Some(place.at(Checked::of(FIELD_OF_VIEW)?));
    description.file.camera = Some(CameraTable { vfov, ..camera_at(position, look_at, DVec3::Y, place)? });
    Ok(())
}

fn add_sky(description: &mut Description, place: &Place) -> Result<(), String> {
    let radiance = Rgb::of(Spectrum::grey(SKY))?;
    description.file.light.push(place.at(LightEntry::Environment(environment::Keys::constant(place.at(radiance)))));
    Ok(())
}

/// Adds the ground and the light of a stage, each with a material of its own.
fn add_surfaces(description: &mut Description, ground: Plane, light: Rectangle, place: &Place) -> Result<(), String> {
    let material = Some(place.at(description.free_material_name("(ground)")));
    let keys = diffuse::Keys { reflectance: Colour::constant(Spectrum::grey(GROUND))?, ..Default::default() };
    add_material(description, MaterialEntry::from(keys), &material);
    let plane = ShapeEntry::Plane(plane::Keys::of(ground.point, DVec3::Y, place)?);
    add_shape(description, plane, material, place);
    let material = Some(place.at(description.free_material_name("(light)")));
    let keys = emissive::Keys { radiance: Colour::constant(Spectrum::grey(LIGHT))?, ..Default::default() };
    add_material(description, MaterialEntry::from(keys), &material);
    let rectangle = ShapeEntry::Rectangle(rectangle::Keys::of([light.corner, light.edge_u, light.edge_v], place)?);
    add_shape(description, rectangle, material, place);
    Ok(())
}

fn add_material(description: &mut Description, mut material: MaterialEntry, name: &Option<Located<String>>) {
    *material.common_mut().name = name.clone().unwrap_or_default();
    description.file.material.push(material);
}

fn add_shape(description: &mut Description, mut shape: ShapeEntry, material: Option<Located<String>>, place: &Place) {
    *shape.common_mut().material = material;
    description.file.shape.push(place.at(shape));
}
