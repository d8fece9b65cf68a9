//! glTF 2.0 in its two forms: JSON (`.gltf`) and binary (`.glb`).
//!
//! `container` is what the file is packed in, `json` the file as it is written, `known` the table of the specification's keys, `buffers` the
//! numbers that it names. Meshes become meshes of their own for each primitive, with
//! the texture coordinates that the primitive's material wants. Texture coordinates run downward there and upward here.

mod animation;
mod bending;
mod buffers;
mod clipping;
mod container;
mod image_based;
mod importer;
mod json;
mod known;
mod light;
mod light_profile;
mod lookup;
mod made;
mod material;
mod meshopt;
mod node;
mod outline;
mod picture;
mod primitive;
mod tangents;
mod texture_role;
mod variant;

use std::collections::HashMap;
use std::path::Path;

use serde::Deserialize;

use self::buffers::Buffers;
use self::container::{Container, UPGRADE_COMMAND, check_version};
use self::importer::Importer;
use self::json::{Asset, Root};
use self::known::EXTENSIONS;
pub use self::material::scattering::single_scattering_albedo;
use super::error::{SceneError, show};
use super::files::{Files, MOST_MODEL_BYTES};
use super::import::Description;

/// Command that converts KTX2 pictures to PNG.
const BASIS_COMMAND: &str = "npx @gltf-transform/cli ktxdecompress IN.glb OUT.glb";
/// Command that undoes Draco's compression.
const DRACO_COMMAND: &str = "npx @gltf-transform/cli copy IN.glb OUT.glb";

/// Reads a file. `camera` is the name of a camera or of its node, the first one where none is named; `variant` that of a variant of materials.
pub fn load(files: &Files, path: &Path, camera: Option<&str>, variant: Option<&str>) -> Result<Description, SceneError> {
    let name = show(path);
    let refuse = |message: String| SceneError::in_file(&name, message);
    let bytes = files.read(path, MOST_MODEL_BYTES).map_err(|error| refuse(format!("cannot be read: {error}")))?;
    let Container { json, binary, oddity } = container::split(&bytes).map_err(|message| {
        let is_old = message.contains("glTF 1.0");
        let error = refuse(message);
        if is_old { error.with_help(format!("`{UPGRADE_COMMAND}` makes glTF 2.0 of it")) } else { error }
    })?;
    let root = read(json, &name)?;
    check_extensions(&root, &name)?;
    let folder = path.parent().unwrap_or(Path::new("")).to_owned();
    let buffers = Buffers::load(files, &folder, &root, binary).map_err(refuse)?;
    let mut importer = Importer {
        files,
        folder,
        name: name.clone(),
        root: &root,
        buffers,
        // Up to 1, emission is what shows in the dark; viewers light such models all the same.
        scene: Description::with_least_radiance(1.0),
        materials: HashMap::new(),
        textures: HashMap::new(),
        pictures: HashMap::new(),
        profiles: HashMap::new(),
        meshes: HashMap::new(),
        triangles: 0,
        weight_tracks: HashMap::new(),
        places: HashMap::new(),
        clipping: None,
        variant: variant::chosen(&root, variant).map_err(refuse)?,
    };
    if let Some(oddity) = oddity {
        importer.approximate("container", "", &format!("{oddity}; what is there is read"));
    }
    if root.asset.version.is_none() {
        importer.approximate("file without asset.version", "asset", "it is taken for glTF 2.0");
    }
    importer.report_unread(json);
    importer.scene(camera).map_err(refuse)?;
    importer.image_based_light().map_err(refuse)?;
    importer.report_clipping();
    let scene = importer.scene;
    if !root.meshes.is_empty() && scene.file.shape.is_empty() && scene.file.instance.is_empty() {
        return Err(refuse("there is nothing to render in the scene: it shows none of its meshes' faces".to_owned()));
    }
    Ok(scene)
}

/// The objects of the JSON. Other versions are named plainly, and what writers of loose JSON leave (`1.0` for an index, `null` for what is not there) is
/// taken as it is meant.
fn read(json: &[u8], name: &str) -> Result<Root, SceneError> {
    let refuse = |message: String| SceneError::in_file(name, message);
    let old = |message: String| refuse(message).with_help(format!("`{UPGRADE_COMMAND}` makes glTF 2.0 of it"));
    let root: Root = match serde_json::from_slice(json) {
        Ok(root) => root,
        Err(error) => {
            let value = serde_json::from_slice::<serde_json::Value>(json).ok();
            if let Some(value) = &value {
                let asset: Asset = value.get("asset").and_then(|asset| Asset::deserialize(asset).ok()).unwrap_or_default();
                let is_table = |key: &&str| value.get(*key).is_some_and(serde_json::Value::is_object);
                let has_tables = ["accessors", "buffers", "materials", "meshes", "nodes", "scenes"].iter().any(is_table);
                check_version(&asset, has_tables).map_err(old)?;
            }
            let meant = value.and_then(|value| Root::deserialize(json::tightened(value)).ok());
            meant.ok_or_else(|| {
                let message = error.to_string();
                let what = message.rsplit_once(" at line").map_or(message.as_str(), |(what, _)| what).to_owned();
                SceneError::in_line(name, error.line(), format!("is not valid glTF: {what}"))
            })?
        }
    };
    check_version(&root.asset, false).map_err(old)?;
    if root.asset.version.is_none() && root.meshes.is_empty() && root.nodes.is_empty() {
        return Err(refuse("is not glTF: it states no asset.version, and has neither meshes nor nodes".to_owned()));
    }
    Ok(root)
}

fn check_extensions(root: &Root, name: &str) -> Result<(), SceneError> {
    for extension in &root.extensions_required {
        let refused = |message: String| SceneError::in_file(name, message);
        match extension.as_str() {
            "KHR_draco_mesh_compression" => {
                return Err(refused("needs the extension KHR_draco_mesh_compression, which is not read".to_owned())
                    .with_help(format!("`{DRACO_COMMAND}` undoes the compression")));
            }
            "KHR_texture_basisu" => {
                return Err(refused("needs the extension KHR_texture_basisu, which is not read".to_owned())
                    .with_help(format!("`{BASIS_COMMAND}` makes PNG of its pictures")));
            }
            known if EXTENSIONS.iter().any(|(name, _)| *name == known) => {}
            other => return Err(refused(format!("needs the extension {other}, which is not read"))),
        }
    }
    Ok(())
}
