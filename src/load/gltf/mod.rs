//! glTF 2.0 in its two forms: JSON (`.gltf`) and binary (`.glb`).
//!
//! `json` is the file as it is written, `buffers` the numbers that it names. Meshes become meshes of their own for each primitive, with
//! the texture coordinates that the primitive's material wants. Texture coordinates run downward there and upward here.

mod animation;
mod bending;
mod buffers;
mod importer;
mod json;
mod light;
mod lookup;
mod made;
mod material;
mod meshopt;
mod node;
mod picture;
mod primitive;
mod variant;

use std::collections::HashMap;
use std::path::Path;

use self::buffers::Buffers;
use self::importer::{Importer, KNOWN};
use self::json::{Asset, Head, Root};
use super::error::{SceneError, show};
use super::files::{Files, MOST_MODEL_BYTES};
use super::import::Description;

/// What turns pictures of KTX2 into PNG.
const BASIS_COMMAND: &str = "npx @gltf-transform/cli ktxdecompress IN.glb OUT.glb";
/// What undoes Draco's compression.
const DRACO_COMMAND: &str = "npx @gltf-transform/cli copy IN.glb OUT.glb";

/// Reads a file. `camera` is the name of a camera or of its node, the first one where none is named; `variant` that of a variant of materials.
pub fn load(files: &Files, path: &Path, camera: Option<&str>, variant: Option<&str>) -> Result<Description, SceneError> {
    let name = show(path);
    let refuse = |message: String| SceneError::in_file(&name, message);
    let bytes = files.read(path, MOST_MODEL_BYTES).map_err(|error| refuse(format!("cannot be read: {error}")))?;
    let (json, binary) = split(&bytes).map_err(refuse)?;
    let json = json.strip_prefix(&[0xef, 0xbb, 0xbf]).unwrap_or(json);
    let root: Root = serde_json::from_slice(json).map_err(|error| {
        // Other versions have other types where this one has lists.
        if let Some(reason) = serde_json::from_slice(json).ok().and_then(|head: Head| check_old_version(head.asset).err()) {
            return refuse(reason);
        }
        let message = error.to_string();
        let what = message.rsplit_once(" at line").map_or(message.as_str(), |(what, _)| what).to_owned();
        SceneError::in_line(&name, error.line(), format!("is not valid glTF: {what}"))
    })?;
    check_version(&root.asset).map_err(refuse)?;
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
        scene: Description::with_glow(1.0),
        materials: HashMap::new(),
        textures: HashMap::new(),
        pictures: HashMap::new(),
        meshes: HashMap::new(),
        triangles: 0,
        weight_tracks: HashMap::new(),
        variant: variant::chosen(&root, variant).map_err(refuse)?,
    };
    importer.report_extensions();
    importer.scene(camera).map_err(refuse)?;
    let scene = importer.scene;
    if !root.meshes.is_empty() && scene.shapes.is_empty() && scene.instances.is_empty() {
        return Err(refuse("there is nothing to render in the scene: it shows none of its meshes' faces".to_owned()));
    }
    Ok(scene)
}

/// The JSON, and the data that a binary file brings.
fn split(bytes: &[u8]) -> Result<(&[u8], Option<Vec<u8>>), String> {
    if !bytes.starts_with(b"glTF") {
        return Ok((bytes, None));
    }
    let number = |at: usize| -> Result<usize, String> {
        let word = bytes.get(at..at + 4).ok_or("the file ends early")?;
        Ok(u32::from_le_bytes([word[0], word[1], word[2], word[3]]) as usize)
    };
    let version = number(4)?;
    if version != 2 {
        return Err(format!("is binary glTF of version {version}; version 2 is read"));
    }
    let chunk = |at: usize| -> Result<(&[u8], usize), String> {
        let length = number(at)?;
        let end = at.checked_add(8).and_then(|start| start.checked_add(length)).filter(|end| *end <= bytes.len());
        let end = end.ok_or_else(|| format!("the file ends early: a chunk of {length} bytes begins at byte {at}"))?;
        Ok((&bytes[at + 8..end], end))
    };
    let (json, mut at) = chunk(12)?;
    if bytes.get(16..20) != Some(b"JSON") {
        return Err("its first chunk is not JSON".to_owned());
    }
    while at + 8 <= bytes.len() {
        let is_binary = bytes.get(at + 4..at + 8) == Some(b"BIN\0");
        let (content, end) = chunk(at)?;
        if is_binary {
            return Ok((json, Some(content.to_vec())));
        }
        at = end;
    }
    Ok((json, None))
}

/// The first version's drafts wrote a number.
fn check_old_version(asset: serde_json::Value) -> Result<(), String> {
    if let Some(version) = asset.get("version").and_then(serde_json::Value::as_f64).filter(|version| *version < 2.0) {
        return Err(format!("is glTF of version {version}; version 2.0 is read"));
    }
    serde_json::from_value(asset).map_or(Ok(()), |asset| check_version(&asset))
}

fn check_version(asset: &Asset) -> Result<(), String> {
    let version = asset.min_version.as_deref().unwrap_or(&asset.version);
    if asset.version.is_empty() {
        return Err("is not glTF: it states no asset.version".to_owned());
    }
    if version.split('.').next() != Some("2") || asset.min_version.as_deref().is_some_and(|least| least != "2.0") {
        return Err(format!("is glTF of version {version}; version 2.0 is read"));
    }
    Ok(())
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
            known if KNOWN.contains(&known) => {}
            other => return Err(refused(format!("needs the extension {other}, which is not read"))),
        }
    }
    Ok(())
}
