//! Wavefront OBJ files and their MTL materials.
//!
//! Programs read what they know of a line and pass over the rest, and so does this reader: what a statement says wrongly is mended or left out, counted,
//! and reported with its line ([`Mends`]). A first walk over the text takes the vertices (`vertices`), a second the faces (`faces`), which may name
//! vertices that come later.

mod faces;
mod mtl;
mod statements;
mod texture_map;
mod vertices;

use std::path::Path;

use crate::load::encoding;
use crate::load::error::{SceneError, show};
use crate::load::files::{Files, MOST_MODEL_BYTES};
use crate::load::mends::Mends;
use crate::load::model::{ModelFile, Substitute};
use faces::Faces;
pub use texture_map::TextureMap;
use vertices::Vertices;

/// Reads an OBJ file. Its MTL files are read only where `with_materials` asks for them; what is missing of them is replaced.
pub fn load(files: &Files, path: &Path, with_materials: bool) -> Result<ModelFile, SceneError> {
    let name = show(path);
    let bytes =
        files.read(path, MOST_MODEL_BYTES).map_err(|error| SceneError::in_file(&name, format!("cannot be read: {error}")))?;
    let (text, encoding) = encoding::decode(&bytes);
    let mut mends = Mends::default();
    let vertices = Vertices::read(&text, &mut mends);
    let mut libraries = mtl::Libraries::default();
    if with_materials {
        libraries.read(files, path, &faces::libraries(&text))?;
    }
    let mut faces = Faces::new(vertices, &mut mends, with_materials.then_some((path, &mut libraries)));
    faces.read(&text);
    let (mut file, unknown, left_out) = faces.finish();
    if file.parts.is_empty() {
        return Err(nothing(&name, &left_out, mends));
    }
    file.warnings.extend(encoding.map(|encoding| format!("{name}: it is not in UTF-8, and read as {encoding}")));
    file.warnings.extend(left_out.warnings(&name));
    file.warnings.append(&mut libraries.warnings);
    let of_model = |substitute| (path.to_owned(), substitute);
    file.substitutes.extend(mends.into_substitutes().into_iter().map(of_model));
    file.substitutes.append(&mut libraries.substitutes);
    file.substitutes.extend(unknown.map(of_model));
    file.materials = libraries.materials;
    Ok(file)
}

/// Why a model has no face at all.
fn nothing(name: &str, left_out: &faces::LeftOut, mends: Mends) -> SceneError {
    let of_faces = mends.into_substitutes().into_iter().find(|mend| mend.what.starts_with("faces"));
    let mut why = match of_faces {
        _ if left_out.without_area > 0 => "none of its faces has an area".to_owned(),
        Some(Substitute { what, line }) => {
            let line = line.map_or_else(String::new, |line| format!("line {line}: "));
            format!("none of its faces can be read: {line}{what}")
        }
        None => "it has no faces".to_owned(),
    };
    if left_out.points_and_lines > 0 {
        why += ", but points or lines, which have no surface";
    }
    SceneError::in_file(name, format!("there is nothing to render in the model: {why}"))
}

#[cfg(test)]
mod tests;
