//! Wavefront OBJ files and their MTL materials, read by `tobj` after a check that names the line of every mistake.
//!
//! Polygons become triangles (`polygons`). Lines and points have no surface and are left out.

mod check;
mod mtl;
mod polygons;

use std::cell::RefCell;
use std::collections::{BTreeSet, HashSet};
use std::path::Path;

use glam::{Vec2, Vec3};
use tobj::LoadOptions;

use crate::load::encoding;
use crate::load::error::{SceneError, show};
use crate::load::files::{Files, MOST_MODEL_BYTES};
use crate::load::model::{ModelFile, MtlMaterial, Part};
use crate::load::printable::short_list;
use crate::scene::Mesh;
pub use mtl::TextureMap;

/// Reads an OBJ file. Its MTL files are read only where `with_materials` asks for them; what is missing of them is replaced.
pub fn load(files: &Files, path: &Path, with_materials: bool) -> Result<ModelFile, SceneError> {
    let name = show(path);
    let bytes =
        files.read(path, MOST_MODEL_BYTES).map_err(|error| SceneError::in_file(&name, format!("cannot be read: {error}")))?;
    let (text, encoding) = encoding::decode(&bytes);
    let checked = check::check(&name, &text)?;
    let mut libraries = mtl::Libraries::default();
    let mut unknown = None;
    if with_materials {
        libraries.read(files, path, &checked.libraries)?;
        unknown = unknown_materials(path, &checked.used_materials, &mut libraries);
    }
    let mut file = parse(&name, &checked.text, &libraries)?;
    file.warnings.extend(encoding.map(|encoding| format!("{name}: it is not in UTF-8, and read as {encoding}")));
    file.warnings.extend(checked.warnings);
    file.warnings.append(&mut libraries.warnings);
    file.substitutes.append(&mut libraries.substitutes);
    file.substitutes.extend(unknown);
    file.materials = libraries.materials;
    Ok(file)
}

fn parse(name: &str, text: &str, libraries: &mtl::Libraries) -> Result<ModelFile, SceneError> {
    let options = LoadOptions { triangulate: true, single_index: true, ignore_points: true, ignore_lines: true };
    // Every library of the file was read already: the first `mtllib` stands for them all.
    let given = RefCell::new(false);
    let materials = |_: &Path| match given.replace(true) {
        true => Ok(Default::default()),
        false => Ok(libraries.for_tobj()),
    };
    let loaded = tobj::load_obj_buf(&mut text.as_bytes(), &options, materials);
    let (models, _) = loaded.map_err(|error| SceneError::in_file(name, format!("is not a valid OBJ file: {error}")))?;
    let mut file = ModelFile::default();
    let mut degenerate = 0;
    let mut incomplete = false;
    for model in models {
        let mut part = Part { mesh: to_mesh(&model.mesh, &mut incomplete), material: model.mesh.material_id };
        degenerate += part.mesh.drop_degenerate_faces();
        if !part.mesh.faces.is_empty() {
            file.parts.push(part);
        }
    }
    if file.parts.is_empty() {
        let why = if degenerate > 0 { "none of its faces has an area" } else { "it has no faces" };
        return Err(SceneError::in_file(name, format!("there is nothing to render in the model: {why}")));
    }
    if degenerate > 0 {
        file.warnings.push(format!("{name}: {degenerate} triangles without area were left out"));
    }
    if incomplete {
        file.warnings.push(format!("{name}: normals or uv coordinates that only some corners of an object have were left out"));
    }
    Ok(file)
}

/// `incomplete` is set where some corners have a normal or uv and others have none: tobj's arrays then do not match the positions.
fn to_mesh(mesh: &tobj::Mesh, incomplete: &mut bool) -> Mesh {
    let triples = |values: &[f32]| values.chunks_exact(3).map(Vec3::from_slice).collect::<Vec<_>>();
    let positions = triples(&mesh.positions);
    let mut normals = triples(&mesh.normals);
    let mut uvs: Vec<Vec2> = mesh.texcoords.chunks_exact(2).map(Vec2::from_slice).collect();
    for (length, clear) in [(normals.len(), true), (uvs.len(), false)] {
        if length != 0 && length != positions.len() {
            *incomplete = true;
            if clear { normals.clear() } else { uvs.clear() }
        }
    }
    let faces = mesh.indices.chunks_exact(3).map(|corners| [corners[0], corners[1], corners[2]]).collect();
    Mesh { positions, normals, uvs, faces, ..Mesh::default() }
}

/// Adds materials that stand for those that no library has.
fn unknown_materials(model: &Path, used: &BTreeSet<String>, libraries: &mut mtl::Libraries) -> Option<String> {
    let known: HashSet<&str> = libraries.materials.iter().map(|entry| entry.material.name.as_str()).collect();
    let unknown: Vec<&String> = used.iter().filter(|name| !known.contains(name.as_str())).collect();
    if unknown.is_empty() {
        return None;
    }
    let list = short_list(&unknown);
    let stand_in = |name: &String| {
        let material = tobj::Material { name: name.clone(), ..Default::default() };
        MtlMaterial { file: model.to_owned(), material, is_missing: true }
    };
    libraries.materials.extend(unknown.into_iter().map(stand_in));
    Some(format!("no material library has {list}; their faces are magenta"))
}
