//! Meshes from files of models.

use std::collections::{BTreeSet, HashMap};
use std::path::Path;
use std::sync::Arc;

use glam::{Vec2, Vec3};

use crate::load::error::{SceneError, show};
use crate::load::file::resolver::{LoadedMesh, Resolver};
use crate::load::file::suggestion::did_you_mean_name;
use crate::load::model::{ModelFile, ModelFormat, ModelPart, Substitute};
use crate::load::place::Place;
use crate::load::{obj, ply};
use crate::scene::{ColorInput, Material, MaterialId, MaterialKind, Mesh, MeshSource};

/// Reflectance of faces without a material.
const DEFAULT_REFLECTANCE: f64 = 0.8;

/// The materials of a model's file for which others of the scene stand.
#[derive(Default)]
pub struct Replaced<'a> {
    /// Name in the file, and what stands for it.
    pub names: Vec<(String, MaterialId)>,
    /// Place where the materials are written.
    pub place: Option<&'a Place>,
}

impl Resolver<'_> {
    /// Reads a model file, once for all shapes that use it alike. Its faces have the given material, or their own ones but for those that are
    /// `replaced`, by their names.
    pub fn mesh_file(
        &mut self,
        path: &Path,
        smooth: Option<bool>,
        material: Option<MaterialId>,
        replaced: &Replaced<'_>,
    ) -> Result<LoadedMesh, SceneError> {
        let Replaced { names: replaced, place: span } = replaced;
        let key = (path.to_owned(), smooth, material.is_none().then(|| replaced.to_vec()));
        if let Some(loaded) = self.mesh_files.get(&key) {
            return Ok(LoadedMesh { mesh: loaded.mesh.clone(), material: material.unwrap_or(loaded.material) });
        }
        let mut file = match ModelFormat::of(path) {
            Some(ModelFormat::Ply) => ply::load(self.files(), path)?,
            Some(ModelFormat::Obj) | None => obj::load(self.files(), path, material.is_none())?,
        };
        if let Some(span) = span {
            self.check_replaced(&file, replaced, span)?;
        }
        self.scene.warnings.append(&mut file.warnings);
        for (file, substitute) in std::mem::take(&mut file.substitutes) {
            self.substitute(&file, substitute)?;
        }
        let loaded = match material {
            Some(material) => {
                let lacks_uvs = |part: &ModelPart| part.mesh.uvs.is_empty();
                if file.parts.iter().any(lacks_uvs) && !file.parts.iter().all(lacks_uvs) && self.uses_texture(material) {
                    self.substitute(path, without_uvs(&self.scene.materials[material].name))?;
                }
                LoadedMesh { mesh: Arc::new(merge(file, smooth)), material }
            }
            None => self.with_own_materials(path, file, smooth, replaced)?,
        };
        let name = |(of_file, id): &(String, MaterialId)| (of_file.clone(), self.scene.materials[*id].name.clone());
        let (own_materials, replaced) = (material.is_none(), replaced.iter().map(name).collect());
        self.scene.sources.add_mesh(&loaded.mesh, MeshSource { path: path.to_owned(), smooth, own_materials, replaced });
        self.mesh_files.insert(key, loaded.clone());
        Ok(loaded)
    }

    /// Checks that the replaced materials exist in the file.
    fn check_replaced(&self, file: &ModelFile, replaced: &[(String, MaterialId)], span: &Place) -> Result<(), SceneError> {
        let numbers: BTreeSet<String> = file.face_groups.iter().flatten().map(u32::to_string).collect();
        let named = file.materials.iter().map(|entry| entry.name.as_str());
        let known: Vec<&str> = named.chain(numbers.iter().map(String::as_str)).collect();
        let Some((unknown, _)) = replaced.iter().find(|(name, _)| !known.contains(&name.as_str())) else { return Ok(()) };
        let help = did_you_mean_name(unknown, &known);
        let help = help.unwrap_or_else(|| "its faces have no materials; `material` gives all of them one".to_owned());
        Err(self.error(span, format!("the mesh's file has no material named `{unknown}`")).with_help(help))
    }

    fn with_own_materials(
        &mut self,
        path: &Path,
        mut file: ModelFile,
        smooth: Option<bool>,
        replaced: &[(String, MaterialId)],
    ) -> Result<LoadedMesh, SceneError> {
        if let Some(groups) = file.face_groups.take() {
            return self.with_grouped_faces(path, file, smooth, (&groups, replaced));
        }
        let replacement = |name: &str| replaced.iter().find(|(known, _)| known == name).map(|(_, id)| *id);
        let mut used: Vec<Option<MaterialId>> = vec![None; file.materials.len()];
        for ModelPart { mesh, material } in &mut file.parts {
            let id = match *material {
                Some(index) => match used[index] {
                    Some(id) => id,
                    None => *used[index].insert(match replacement(&file.materials[index].name) {
                        Some(id) => id,
                        None => self.mtl_material(&file.materials[index])?,
                    }),
                },
                None => self.material_of_unnamed_faces(),
            };
            if mesh.uvs.is_empty() && self.uses_texture(id) {
                self.substitute(path, without_uvs(&self.scene.materials[id].name))?;
                mesh.uvs = vec![Vec2::ZERO; mesh.positions.len()];
            }
            mesh.face_materials = vec![id; mesh.faces.len()];
        }
        Ok(with_fewest_materials(merge(file, smooth)))
    }

    /// Reads a file whose faces have numbers in place of materials: `replaced` gives their materials, and
    /// grey stands for those that it leaves out.
    fn with_grouped_faces(
        &mut self,
        path: &Path,
        file: ModelFile,
        smooth: Option<bool>,
        (groups, replaced): (&[u32], &[(String, MaterialId)]),
    ) -> Result<LoadedMesh, SceneError> {
        let named: HashMap<u32, MaterialId> = replaced.iter().filter_map(|(name, id)| Some((name.parse().ok()?, *id))).collect();
        if named.is_empty() {
            let name = show(path);
            self.scene
                .warnings
                .push(format!("{name}: without effect: face material_index, which the key `materials` gives a meaning"));
        }
        let mut mesh = merge(file, smooth);
        let unnamed = groups.iter().any(|group| !named.contains_key(group)).then(|| self.material_of_unnamed_faces());
        let materials = groups.iter().map(|group| named.get(group).copied().or(unnamed));
        mesh.face_materials = materials.collect::<Option<_>>().unwrap_or_default();
        if mesh.uvs.is_empty()
            && let Some(&id) = named.values().find(|&&id| self.uses_texture(id))
        {
            self.substitute(path, without_uvs(&self.scene.materials[id].name))?;
            mesh.uvs = vec![Vec2::ZERO; mesh.positions.len()];
        }
        Ok(with_fewest_materials(mesh))
    }

    /// A grey that every mesh file's faces without a material share.
    pub fn material_of_unnamed_faces(&mut self) -> MaterialId {
        if let Some(id) = self.unnamed_material {
            return id;
        }
        let id = self.scene.materials.len();
        self.scene.materials.push(Material {
            name: "(faces without a material)".to_owned(),
            kind: MaterialKind::Diffuse { reflectance: ColorInput::grey(DEFAULT_REFLECTANCE) },
            normal_map: None,
            emission: None,
            two_sided: true,
            interior: None,
        });
        *self.unnamed_material.insert(id)
    }
}

/// The substitute for texture coordinates that a file does not have.
fn without_uvs(material: &str) -> Substitute {
    let what =
        format!("faces of the material `{material}` have a texture and no uv coordinates: the texture at (0, 0) is everywhere");
    Substitute { line: None, what }
}

/// A mesh whose faces all have a material, which is the shape's where it is the same for all.
fn with_fewest_materials(mut mesh: Mesh) -> LoadedMesh {
    let material = mesh.face_materials[0];
    if mesh.face_materials.iter().all(|&other| other == material) {
        mesh.face_materials.clear();
    }
    LoadedMesh { mesh: Arc::new(mesh), material }
}

/// All parts as one mesh. Normals are kept, made or left out as `smooth` asks; without a wish, a file with normals is smooth.
fn merge(mut file: ModelFile, smooth: Option<bool>) -> Mesh {
    let has_normals = |part: &ModelPart| !part.mesh.normals.is_empty();
    let some = file.parts.iter().any(has_normals);
    let all = file.parts.iter().all(has_normals);
    if some && !all {
        for part in file.parts.iter_mut().filter(|part| part.mesh.normals.is_empty()) {
            if smooth == Some(true) { part.mesh.compute_smooth_normals() } else { part.mesh.compute_flat_normals() }
        }
    }
    let mut mesh = Mesh::default();
    for part in file.parts {
        mesh.append(part.mesh);
    }
    choose_normals(&mut mesh, smooth);
    mesh
}

/// Keeps, makes or leaves out normals as `smooth` asks; without a wish, a mesh with normals is smooth.
pub fn choose_normals(mesh: &mut Mesh, smooth: Option<bool>) {
    mesh.smooth = smooth.unwrap_or(!mesh.normals.is_empty());
    if !mesh.smooth {
        mesh.normals.clear();
        return;
    }
    let has_length = |normal: &Vec3| normal.length_squared() > 1e-20;
    if mesh.normals.iter().all(has_length) && !mesh.normals.is_empty() {
        return;
    }
    // Normals of length 0 say nothing; the computed ones stand in for them.
    let written = std::mem::take(&mut mesh.normals);
    mesh.compute_smooth_normals();
    for (normal, written) in mesh.normals.iter_mut().zip(written) {
        if has_length(&written) {
            *normal = written;
        }
    }
}
