//! `type = "mesh"`: triangles from a model file or written in the scene file.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::{DVec3, Vec2};

use super::deformation::DeformationEntry;
use super::keys::{ShapeKeys, Written, shape_keys};
use super::mesh_file::{Replaced, choose_normals};
use super::mesh_writer;
use crate::load::error::SceneError;
use crate::load::error::show;
use crate::load::file::reference::FileOr;
use crate::load::file::resolver::{LoadedMesh, Resolver};
use crate::load::file::value::{Exactly, Located, Number, Vector, vector};
use crate::load::file::writer::Writer;
use crate::load::formats;
use crate::load::model::ModelFormat;
use crate::load::place::Place;
use crate::scene::{Mesh, Shape};

shape_keys! {
    /// Triangles, from a file or written here.
    #[derive(Default)]
    #[schemars(extend("allOf" = [{ "oneOf": [
        { "required": ["file"], "not": { "anyOf": [
            { "required": ["positions"] }, { "required": ["faces"] }, { "required": ["uvs"] }, { "required": ["second_uvs"] }, { "required": ["normals"] },
            { "required": ["material", "materials"] },
        ] } },
        { "required": ["positions", "faces", "material"], "not": { "anyOf": [
            { "required": ["file"] }, { "required": ["materials"] },
        ] } },
    ] }]))]
    "MeshShape" {
        /// Path of an OBJ or a PLY file (`.obj`, `.ply`, `.ply.gz`), relative to the scene file.
        #[schemars(extend("pattern" = "\\.([oO][bB][jJ]|[pP][lL][yY](\\.[gG][zZ])?)$"))]
        file: Option<Located<FileOr<Mesh>>>,
        positions: Option<Vec<Located<Vector>>>,
        /// Three indices into `positions` each, counted from 0, counter-clockwise seen from the front.
        faces: Option<Vec<Located<Exactly<u32, 3>>>>,
        /// One per position.
        uvs: Option<Located<Vec<Exactly<Number, 2>>>>,
        /// One per position, for textures that have `second_uvs`.
        second_uvs: Option<Located<Vec<Exactly<Number, 2>>>>,
        /// One per position.
        normals: Option<Located<Vec<Located<Vector>>>>,
        /// Materials of this scene that replace the file's own, by their names in the file: `{ Wood = "oak"
        /// }`. In a PLY file the names are the numbers `material_index` of its faces.
        materials: Option<Located<BTreeMap<String, Located<String>>>>,
        /// Morph targets and joints that bend the mesh.
        deformation: Option<Box<Located<DeformationEntry>>>,
        /// Interpolate normals over the faces; when left out, true if there are normals.
        smooth: Option<bool>,
    }
}

impl ShapeKeys for Keys {
    type Shape = Arc<Mesh>;

    const EXAMPLES: &'static [&'static str] = &[
        "positions = [[-0.8, -0.9, 0.7], [0.9, -0.8, 0.6], [0, -0.9, -0.9], [0.1, 1, 0]]\nnormals = [[-0.6, -0.5, 0.6], [0.6, -0.5, 0.6], [0, -0.5, -0.8], [0, 1, 0]]\nuvs = [[0, 0], [1, 0], [0.5, 1], [0.4, 0.6]]\nfaces = [[0, 1, 3], [1, 2, 3], [2, 0, 3], [0, 2, 1]]",
    ];

    /// A mesh file may bring materials of its own.
    fn resolve(&self, resolver: &mut Resolver<'_>, entry: &mut Written<'_>) -> Result<Arc<Mesh>, SceneError> {
        let Some(file) = &self.file else {
            if let Some(materials) = &self.materials {
                return Err(resolver.error(&materials.place, "`materials` is for meshes with `file`"));
            }
            if entry.material.is_none() {
                return Err(resolver.error(entry.place, "the key `material` is missing: only a mesh file can have its own"));
            }
            let mesh = Arc::new(self.inline_mesh(resolver, entry)?);
            return resolver.deformed(mesh, self.deformation.as_deref());
        };
        let given = [
            ("positions", self.positions.is_some()),
            ("faces", self.faces.is_some()),
            ("uvs", self.uvs.is_some()),
            ("second_uvs", self.second_uvs.is_some()),
            ("normals", self.normals.is_some()),
        ];
        if let Some((key, _)) = given.iter().find(|(_, given)| *given) {
            return Err(resolver.error(&file.place, format!("a mesh has either `file` or `{key}`")));
        }
        let Some(path) = file.value.path(resolver.folder) else { return self.mesh_in_memory(resolver, entry, file) };
        if ModelFormat::of(&path).is_none() {
            let message = format!("a mesh file is an OBJ or a PLY file: its name ends in {}", formats::MODEL_ENDINGS);
            let error = resolver.error(&file.place, message);
            return Err(match formats::advice(&path) {
                Some((_, advice)) => error.with_help(advice),
                None => error,
            });
        }
        if matches!(file.value, FileOr::Written(_)) && !resolver.files().exists(&path) {
            return Err(resolver.error(&file.place, format!("there is no file {}", show(&path))));
        }
        let replaced = self.replaced(resolver, entry)?;
        let LoadedMesh { mesh, material } = resolver.mesh_file(&path, self.smooth, entry.material, &replaced)?;
        entry.material = Some(material);
        resolver.deformed(mesh, self.deformation.as_deref())
    }

    fn outline(&self) -> Vec<DVec3> {
        Vec::new()
    }

    fn write(mesh: &Arc<Mesh>, shape: &Shape, writer: &mut Writer<'_>) -> String {
        mesh_writer::write(mesh, shape, writer)
    }
}

impl Keys {
    /// A mesh that an importer has made.
    pub fn of(mesh: Arc<Mesh>, place: &Place) -> Self {
        Self { smooth: Some(mesh.smooth), file: Some(place.at(FileOr::InMemory(mesh))), ..Self::default() }
    }

    /// The mesh that an importer has made, as it is.
    fn mesh_in_memory(
        &self,
        resolver: &mut Resolver<'_>,
        entry: &mut Written<'_>,
        file: &Located<FileOr<Mesh>>,
    ) -> Result<Arc<Mesh>, SceneError> {
        let FileOr::InMemory(mesh) = &file.value else { return Err(resolver.error(&file.place, "it is no mesh")) };
        entry.material.get_or_insert_with(|| resolver.material_of_unnamed_faces());
        resolver.deformed(mesh.clone(), self.deformation.as_deref())
    }

    /// The file's materials for which others stand, and those.
    fn replaced(&self, resolver: &Resolver<'_>, entry: &Written<'_>) -> Result<Replaced<'_>, SceneError> {
        let Some(materials) = &self.materials else { return Ok(Replaced::default()) };
        if entry.material.is_some() {
            let message = "a mesh has either `material`, for all of its faces, or `materials`, for some";
            return Err(resolver.error(&materials.place, message));
        }
        let id = |(of_file, name): (&String, &Located<String>)| Ok((of_file.clone(), resolver.material_id(name)?));
        Ok(Replaced { names: materials.value.iter().map(id).collect::<Result<_, _>>()?, place: Some(&materials.place) })
    }

    fn inline_mesh(
        &self,
        resolver: &mut Resolver<'_>,
        &Written { place: span, index, .. }: &Written<'_>,
    ) -> Result<Mesh, SceneError> {
        let (Some(positions), Some(faces)) = (&self.positions, &self.faces) else {
            return Err(resolver.error(span, "a mesh needs the key `file`, or both `positions` and `faces`"));
        };
        let count = positions.len();
        for face in faces {
            if let Some(index) = face.value.iter().find(|&&index| index as usize >= count) {
                let message = format!("the face uses position {index}, but there are only {count} (counted from 0)");
                return Err(resolver.error(&face.place, message));
            }
        }
        let lengths = [
            ("uvs", self.uvs.as_ref().map(|uvs| (uvs.value.len(), &uvs.place))),
            ("second_uvs", self.second_uvs.as_ref().map(|uvs| (uvs.value.len(), &uvs.place))),
            ("normals", self.normals.as_ref().map(|normals| (normals.value.len(), &normals.place))),
        ];
        for (key, given) in lengths {
            if let Some((length, span)) = given
                && length != count
            {
                return Err(resolver.error(span, format!("there are {length} `{key}` for {count} positions")));
            }
        }
        let mut mesh = Mesh {
            positions: positions.iter().map(|position| vector(position.value).as_vec3()).collect(),
            faces: faces.iter().map(|face| face.value.0).collect(),
            ..Mesh::default()
        };
        for (uvs, written) in [(&mut mesh.uvs, &self.uvs), (&mut mesh.second_uvs, &self.second_uvs)] {
            let written = written.iter().flat_map(|written| &written.value);
            uvs.extend(written.map(|uv| Vec2::new(uv[0].0 as f32, uv[1].0 as f32)));
        }
        if let Some(normals) = &self.normals {
            let unit = |normal| resolver.direction(normal).map(|normal| normal.as_vec3());
            mesh.normals = normals.value.iter().map(unit).collect::<Result<_, _>>()?;
        }
        let dropped = mesh.drop_degenerate_faces();
        if mesh.faces.is_empty() {
            return Err(resolver.error(span, "the mesh has no faces with an area"));
        }
        if dropped > 0 {
            let warning = format!("{}: shape[{index}]: {dropped} triangles without area were left out", resolver.document.name);
            resolver.scene.warnings.push(warning);
        }
        choose_normals(&mut mesh, self.smooth);
        Ok(mesh)
    }
}
