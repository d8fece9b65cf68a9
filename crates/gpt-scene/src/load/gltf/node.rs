//! Nodes: what stands where.

use std::collections::{BTreeMap, BTreeSet};
use std::num::NonZeroU32;
use std::ops::RangeInclusive;
use std::sync::Arc;

use glam::{DAffine3, DMat3, DMat4, DQuat, DVec3, DVec4};

use super::clipping::Clipping;
use super::importer::Importer;
use super::json::{Instances, Node, extension};
use super::made::{Bending, MadePrimitive, MovingNodes};
use crate::load::file::shape::{ShapeEntry, TransformEntry, mesh};
use crate::load::file::syntax::ProjectionName;
use crate::load::file::value::{Checked, Exactly};
use crate::load::import::{MOST_SHAPES, camera_at, pays_as_instances, triangles_fit};
use crate::load::memory;
use crate::load::place::Place;
use crate::load::printable::short_list;
use crate::scene::Mesh;

/// Bytes that a copy of a mesh takes while it is read and in the scene.
const COPY_BYTES: u64 = 512;
/// Copies from which on it is asked whether there is memory for them.
const MANY_COPIES: u64 = 1 << 18;
/// Degrees that a scene's camera may have.
const FIELDS_OF_VIEW: RangeInclusive<f64> = 0.001..=179.0;
/// Widths of pictures over their heights.
const ASPECTS: RangeInclusive<f64> = 0.01..=100.0;
/// The longer side in pixels of a picture whose camera states how wide it is.
const LONGER_SIDE: f64 = 512.0;

/// A node and where it stands.
#[derive(Clone, Copy)]
pub struct Placed {
    pub node: usize,
    map: DAffine3,
    /// Neither it nor a node around it is hidden (KHR_node_visibility). Cameras and joints count all the same.
    is_visible: bool,
}

impl Importer<'_> {
    pub fn scene(&mut self, camera: Option<&str>) -> Result<(), String> {
        let placed = self.placed_nodes()?;
        let moving = self.animate(&placed)?;
        self.choose_camera(&placed, camera, &moving)?;
        for placed in &placed {
            if let Some(mesh) = self.root.nodes[placed.node].mesh {
                self.places.entry(mesh).or_default().push(placed.map);
            }
        }
        for &Placed { node, .. } in &placed {
            let is_nothing = |rotation: [f64; 4]| DVec4::from_array(rotation).try_normalize().is_none();
            if self.root.nodes[node].rotation.is_some_and(is_nothing) {
                self.approximate("rotation of length 0", &format!("nodes[{node}]"), "the node is not turned");
            }
        }
        let mut world = vec![None; self.root.nodes.len()];
        placed.iter().for_each(|placed| world[placed.node] = Some(placed.map));
        // The nodes that show each undeformed mesh, and their transforms.
        let mut copies: BTreeMap<usize, Vec<Placed>> = BTreeMap::new();
        let mut count = 0;
        for &Placed { node: index, map, .. } in placed.iter().filter(|placed| placed.is_visible) {
            let node = &self.root.nodes[index];
            // Meshes that move or are deformed by themselves become shapes of their own.
            let Some(mesh) = node.mesh.filter(|_| self.has_mesh_of_others(index, &moving)) else { continue };
            let maps = self.instances(node).map_err(|message| format!("nodes[{index}]: {message}"))?;
            count += maps.len() as u64;
            if count > MANY_COPIES && count * COPY_BYTES > memory::available() / 2 {
                let (needed, available) = ((count * COPY_BYTES) >> 20, memory::available() >> 20);
                return Err(format!(
                    "the scene does not fit: up to nodes[{index}] meshes stand in {count} places, which take about {needed} MiB; {available} MiB \
                     are free"
                ));
            }
            copies.entry(mesh).or_default().extend(maps.into_iter().map(|own| Placed {
                node: index,
                map: map * own,
                is_visible: true,
            }));
        }
        let mut stored_once = BTreeSet::new();
        for (mesh, copies) in &copies {
            if self.mesh_of_instances(*mesh, copies)? {
                stored_once.insert(*mesh);
            }
        }
        for Placed { node: index, map, .. } in placed.into_iter().filter(|placed| placed.is_visible) {
            let of_node = |message: String| format!("nodes[{index}]: {message}");
            let node = &self.root.nodes[index];
            let name = moving.get(&index);
            let is_instanced =
                self.has_mesh_of_others(index, &moving) && node.mesh.is_some_and(|mesh| stored_once.contains(&mesh));
            if let Some(mesh) = node.mesh.filter(|_| !is_instanced) {
                for instance in self.instances(node).map_err(of_node)? {
                    let first = self.scene.file.shape.len();
                    self.mesh_node(index, mesh, map * instance, &world, &moving).map_err(of_node)?;
                    if let Some(name) = name.filter(|_| node.skin.is_none()) {
                        let shapes = self.scene.file.shape[first..].iter_mut();
                        shapes.for_each(|shape| *shape.value.common_mut().node = Some(shape.place.at(name.clone())));
                    }
                }
            }
            let first = self.scene.file.light.len();
            self.light(node, map, index).map_err(of_node)?;
            self.light_with_profile(node, map, index).map_err(of_node)?;
            if let Some(name) = name {
                for light in &mut self.scene.file.light[first..] {
                    let place = light.place.clone();
                    light.value.node_mut().into_iter().for_each(|node| *node = Some(place.at(name.clone())));
                }
            }
        }
        Ok(())
    }

    /// Stores a mesh once that stands in many places, unless it is small or gives light. Whether it did.
    fn mesh_of_instances(&mut self, mesh: usize, copies: &[Placed]) -> Result<bool, String> {
        let is_whole = |placed: &&Placed| {
            let volume = placed.map.matrix3.determinant();
            volume.is_normal() && !is_flat(placed.map.matrix3)
        };
        let first_node = copies.first().map_or(0, |placed| placed.node);
        let place = self.place(&format!("nodes[{first_node}]"));
        let Some(found) = self.root.meshes.get(mesh).filter(|_| copies.len() > 1) else { return Ok(false) };
        let name = found.name.clone().unwrap_or_else(|| format!("mesh {mesh}"));
        let (mut shapes, mut triangles) = (Vec::new(), 0);
        for primitive in 0..found.primitives.len() {
            let of_primitive =
                |message: String| format!("nodes[{first_node}]: meshes[{mesh}].primitives[{primitive}]: {message}");
            let Some(made) = self.primitive(mesh, primitive, Bending::default()).map_err(of_primitive)? else { continue };
            if self.scene.gives_light(&made.material) {
                return Ok(false);
            }
            triangles += made.triangles;
            shapes.push(place.at(mesh_entry(made, &place)));
        }
        if !pays_as_instances(copies.len(), triangles) {
            return Ok(false);
        }
        for flat in copies.iter().filter(|placed| !is_whole(placed)) {
            self.flat_mesh(flat.node, mesh, flat.map)?;
        }
        let places: Vec<DAffine3> = copies.iter().filter(is_whole).map(|placed| placed.map).collect();
        if !places.is_empty() {
            self.triangles += triangles;
            self.scene.add_instances(&name, &place, shapes, &places)?;
        }
        Ok(true)
    }

    /// The nodes of the scene from the roots on.
    fn placed_nodes(&self) -> Result<Vec<Placed>, String> {
        let roots: Vec<usize> = match self.root.scenes.get(self.root.scene.unwrap_or(0)) {
            Some(scene) => scene.nodes.clone(),
            None if self.root.scenes.is_empty() => {
                let mut is_child = vec![false; self.root.nodes.len()];
                let children = self.root.nodes.iter().flat_map(|node| &node.children);
                children.for_each(|&child| is_child.get_mut(child).into_iter().for_each(|is| *is = true));
                (0..is_child.len()).filter(|&node| !is_child[node]).collect()
            }
            None => return Err(format!("there is no scenes[{}]", self.root.scene.unwrap_or(0))),
        };
        let mut seen = vec![false; self.root.nodes.len()];
        let mut placed = Vec::new();
        let mut to_visit: Vec<Placed> =
            roots.into_iter().rev().map(|node| Placed { node, map: DAffine3::IDENTITY, is_visible: true }).collect();
        while let Some(Placed { node: index, map: around, is_visible }) = to_visit.pop() {
            let node = self.root.nodes.get(index).ok_or_else(|| format!("there is no nodes[{index}]"))?;
            if std::mem::replace(&mut seen[index], true) {
                return Err(format!("nodes[{index}] has several parents, or is its own ancestor"));
            }
            let map = around * local(node).map_err(|message| format!("nodes[{index}]: {message}"))?;
            if !map.is_finite() {
                return Err(format!("nodes[{index}]: its transform leaves the range of numbers"));
            }
            let is_visible = is_visible && !is_hidden(node);
            placed.push(Placed { node: index, map, is_visible });
            to_visit.extend(node.children.iter().rev().map(|&child| Placed { node: child, map, is_visible }));
        }
        Ok(placed)
    }

    /// Nothing moves or bends the node's mesh at frames.
    fn has_mesh_of_others(&self, index: usize, moving: &MovingNodes) -> bool {
        let node = &self.root.nodes[index];
        let is_deformed = node.skin.is_some() || node.weights.is_some() || self.weight_tracks.contains_key(&index);
        !is_deformed && !moving.contains_key(&index)
    }

    fn choose_camera(&mut self, placed: &[Placed], wanted: Option<&str>, moving: &MovingNodes) -> Result<(), String> {
        let name = |index: usize| -> Vec<String> {
            let node = &self.root.nodes[index];
            let camera = node.camera.and_then(|camera| self.root.cameras.get(camera));
            [node.name.clone(), camera.and_then(|camera| camera.name.clone())].into_iter().flatten().collect()
        };
        let with_camera = || placed.iter().filter(|placed| self.root.nodes[placed.node].camera.is_some());
        let chosen = match wanted {
            None => with_camera().next(),
            Some(wanted) => {
                let found = with_camera().find(|placed| name(placed.node).iter().any(|name| name == wanted));
                let names: Vec<String> = with_camera().flat_map(|placed| name(placed.node)).collect();
                Some(found.ok_or_else(|| match names.is_empty() {
                    true => format!("there is no camera named `{wanted}`: the scene has none with a name"),
                    false => format!("there is no camera named `{wanted}`, but {}", short_list(&names)),
                })?)
            }
        };
        let Some(placed) = chosen.copied() else { return Ok(()) };
        self.camera(placed).map_err(|message| format!("nodes[{}]: {message}", placed.node))?;
        if let (Some(camera), Some(name)) = (&mut self.scene.file.camera, moving.get(&placed.node)) {
            camera.node = Some(camera.look_at.place.at(name.clone()));
        }
        Ok(())
    }

    fn camera(&mut self, Placed { node, map, .. }: Placed) -> Result<(), String> {
        let index = self.root.nodes[node].camera.unwrap_or_default();
        let camera = self.root.cameras.get(index).cloned().ok_or_else(|| format!("there is no cameras[{index}]"))?;
        let axis = |axis: DVec3| axis.try_normalize().ok_or("the transform of the camera leaves no direction to look along");
        let (forward, up) = (axis(-map.matrix3.z_axis)?, axis(map.matrix3.y_axis)?);
        if map.matrix3.determinant() < 0.0 {
            self.drop("mirroring transform of a camera", &format!("nodes[{node}]"), "the picture is not mirrored");
        }
        let place = self.place(&format!("cameras[{index}]"));
        let mut keys = camera_at(map.translation, map.translation + forward * 1.0, up, &place)?;
        let aspect = match (&camera.perspective, &camera.orthographic) {
            (Some(perspective), _) => {
                let degrees = perspective.yfov.to_degrees();
                if !(degrees > 0.0 && degrees < 180.0) {
                    return Err(format!("cameras[{index}]: `yfov` is {} radians", perspective.yfov));
                }
                if !FIELDS_OF_VIEW.contains(&degrees) {
                    self.approximate(
                        "field of view of a camera",
                        &format!("cameras[{index}]"),
                        "the nearest possible one is taken",
                    );
                }
                let possible = degrees.clamp(*FIELDS_OF_VIEW.start(), *FIELDS_OF_VIEW.end());
                keys.vfov = Some(place.at(Checked::of(possible)?));
                perspective.aspect_ratio
            }
            (None, Some(window)) => {
                if !(window.ymag.is_finite() && window.ymag != 0.0 && window.xmag.is_finite() && window.xmag != 0.0) {
                    return Err(format!("cameras[{index}]: its window has no size"));
                }
                keys.projection = Some(place.at(ProjectionName::Orthographic));
                keys.height = Some(place.at(Checked::of(2.0 * window.ymag.abs())?));
                if window.ymag < 0.0 || window.xmag < 0.0 {
                    self.approximate("window of a camera below 0", &format!("cameras[{index}]"), "the picture is not mirrored");
                }
                Some((window.xmag / window.ymag).abs())
            }
            (None, None) => return Err(format!("cameras[{index}] is neither perspective nor orthographic")),
        };
        let possible = aspect.filter(|aspect| ASPECTS.contains(aspect));
        if possible.is_none() && aspect.is_some() {
            self.approximate("aspect of a camera", &format!("cameras[{index}]"), "the picture is as large as without it");
        }
        if let Some(aspect) = possible {
            let size = [LONGER_SIDE * aspect.min(1.0), LONGER_SIDE / aspect.max(1.0)];
            let size = size.map(|side| NonZeroU32::new(side.round() as u32).unwrap_or(NonZeroU32::MIN));
            self.scene.file.film.size = Some(Exactly(size));
        }
        self.clipping = Some(Clipping::of(&camera, index, (map.translation, forward, up)));
        self.scene.file.camera = Some(keys);
        Ok(())
    }

    /// Transforms of the copies of the node's mesh, relative to the node.
    fn instances(&self, node: &Node) -> Result<Vec<DAffine3>, String> {
        const NAME: &str = "EXT_mesh_gpu_instancing";
        let Some(instances) = extension::<Instances>(&node.extensions, NAME)? else { return Ok(vec![DAffine3::IDENTITY]) };
        let column = |name: &str, kind: &str| -> Result<Option<Vec<f32>>, String> {
            let Some(accessor) = instances.attributes.get(name) else { return Ok(None) };
            let accessor = accessor.as_u64().ok_or_else(|| format!("{NAME}: {name} names no accessor"))?;
            self.buffers.numbers(accessor as usize, &[kind]).map(|(numbers, _)| Some(numbers))
        };
        let (translations, rotations, scales) =
            (column("TRANSLATION", "VEC3")?, column("ROTATION", "VEC4")?, column("SCALE", "VEC3")?);
        let lengths = [(&translations, 3), (&rotations, 4), (&scales, 3)];
        let mut counts = lengths.iter().filter_map(|(numbers, width)| numbers.as_ref().map(|numbers| numbers.len() / width));
        let count = counts.next().unwrap_or(1);
        if counts.any(|other| other != count) || count > MOST_SHAPES {
            return Err(format!("{NAME}: its attributes are not equally many, or more than {MOST_SHAPES}"));
        }
        let triple = |numbers: &Option<Vec<f32>>, index: usize, default: DVec3| {
            let three = numbers.as_ref().and_then(|numbers| numbers.get(3 * index..3 * index + 3));
            three.map_or(default, |three| DVec3::new(three[0].into(), three[1].into(), three[2].into()))
        };
        let rotation = |index: usize| {
            let four = rotations.as_ref().and_then(|numbers| numbers.get(4 * index..4 * index + 4));
            four.map_or(DQuat::IDENTITY, |q| unit(DVec4::new(q[0].into(), q[1].into(), q[2].into(), q[3].into())))
        };
        Ok((0..count)
            .map(|index| {
                let scale = triple(&scales, index, DVec3::ONE);
                DAffine3::from_scale_rotation_translation(scale, rotation(index), triple(&translations, index, DVec3::ZERO))
            })
            .collect())
    }

    fn mesh_node(
        &mut self,
        index: usize,
        mesh: usize,
        map: DAffine3,
        world: &[Option<DAffine3>],
        moving: &MovingNodes,
    ) -> Result<(), String> {
        let node = &self.root.nodes[index];
        let count = self.root.meshes.get(mesh).ok_or_else(|| format!("there is no meshes[{mesh}]"))?.primitives.len();
        let skinning = node.skin.map(|skin| self.skinning(skin, world, moving)).transpose()?;
        // Joints say where the vertices of a skinned mesh are in the world.
        let map = if skinning.is_some() { DAffine3::IDENTITY } else { map };
        let volume = map.matrix3.determinant();
        if volume == 0.0 || !volume.is_finite() || is_flat(map.matrix3) {
            return self.flat_mesh(index, mesh, map);
        }
        let track = self.weight_tracks.get(&index).cloned();
        let bending = Bending { skinning: skinning.as_ref(), weights: node.weights.as_deref(), track: track.as_ref() };
        for primitive in 0..count {
            let of_primitive = |message: String| format!("meshes[{mesh}].primitives[{primitive}]: {message}");
            let made = self.primitive(mesh, primitive, bending).map_err(of_primitive)?;
            let Some(made) = made else { continue };
            self.triangles += made.triangles;
            triangles_fit(self.triangles)?;
            if self.scene.file.shape.len() >= MOST_SHAPES {
                return Err(format!("the scene has more than {MOST_SHAPES} shapes, instances counted"));
            }
            let place = self.place(&format!("nodes[{index}]"));
            let mut shape = mesh_entry(made, &place);
            *shape.common_mut().transform = TransformEntry::of_map(&map, &place)?;
            self.scene.file.shape.push(place.at(shape));
        }
        Ok(())
    }
}

impl Importer<'_> {
    /// The mesh of a node that leaves no volume of it: what lies in a plane then, by the normals of its faces.
    fn flat_mesh(&mut self, index: usize, mesh: usize, map: DAffine3) -> Result<(), String> {
        let count = self.root.meshes.get(mesh).map_or(0, |mesh| mesh.primitives.len());
        for primitive in 0..count {
            let of_primitive = |message: String| format!("meshes[{mesh}].primitives[{primitive}]: {message}");
            let Some(made) = self.primitive(mesh, primitive, Bending::default()).map_err(of_primitive)? else { continue };
            let place = self.place(&format!("nodes[{index}]"));
            let mut flat = Mesh::clone(&made.mesh);
            flat.positions.iter_mut().for_each(|at| *at = map.transform_point3(at.as_dvec3()).as_vec3());
            flat.normals.clear();
            flat.smooth = false;
            flat.drop_degenerate_faces();
            if flat.faces.is_empty() || !map.is_finite() {
                self.drop("mesh without extent", &format!("nodes[{index}]"), "it is left out: its node scales it by 0");
                continue;
            }
            self.triangles += flat.faces.len() as u64;
            let shape = mesh_entry(MadePrimitive { mesh: Arc::new(flat), deformation: None, ..made }, &place);
            self.scene.file.shape.push(place.at(shape));
        }
        Ok(())
    }
}

/// `visible = false` of KHR_node_visibility.
fn is_hidden(node: &Node) -> bool {
    let visibility = node.extensions.get("KHR_node_visibility").and_then(|visibility| visibility.get("visible"));
    visibility.and_then(serde_json::Value::as_bool) == Some(false)
}

fn mesh_entry(MadePrimitive { mesh, material, deformation, .. }: MadePrimitive, place: &Place) -> ShapeEntry {
    ShapeEntry::Mesh(mesh::Keys { material: Some(place.at(material)), deformation, ..mesh::Keys::of(mesh, place) })
}

/// The map of a node about its parent.
pub fn local(node: &Node) -> Result<DAffine3, String> {
    if let Some(matrix) = node.matrix {
        let matrix = DMat4::from_cols_array(&matrix);
        if (matrix.row(3) - DVec4::W).abs().max_element() > 1e-6 {
            return Err("the last row of its matrix is not 0, 0, 0, 1".to_owned());
        }
        return Ok(DAffine3::from_mat4(matrix));
    }
    let rotation = node.rotation.map_or(DQuat::IDENTITY, |rotation| unit(DVec4::from_array(rotation)));
    let scale = node.scale.map_or(DVec3::ONE, DVec3::from_array);
    Ok(DAffine3::from_scale_rotation_translation(scale, rotation, node.translation.map_or(DVec3::ZERO, DVec3::from_array)))
}

/// A rotation of length 1; none where nothing is left of it. One without rotation stays exact.
pub fn unit(rotation: DVec4) -> DQuat {
    if rotation == DVec4::W { DQuat::IDENTITY } else { rotation.try_normalize().map_or(DQuat::IDENTITY, DQuat::from_vec4) }
}

/// Nothing of the volume is left.
fn is_flat(matrix: DMat3) -> bool {
    let lengths = matrix.x_axis.length() * matrix.y_axis.length() * matrix.z_axis.length();
    matrix.determinant().abs() <= 1e-12 * lengths
}
