//! Shapes.

use std::rc::Rc;
use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec3};

use super::converter::{Converter, StoredGroup};
use super::emitter;
use super::limits::{MOST_SHAPES, too_many_shapes};
use super::met_media::MetMedia;
use super::plugin::Plugin;
use crate::load::error::SceneError;
use crate::load::file::shape::{self as shapes, ShapeEntry};
use crate::load::file::value::Located;
use crate::load::import::{
    Input, cylinder, disk, grid_sphere, is_uniform, pays_as_instances, square, triangles_fit, turn_inside_out, unit_cube,
};
use crate::scene::Mesh;

/// Most groups within each other.
const DEEPEST_GROUP: usize = 8;

impl Converter<'_> {
    pub fn shape(&mut self, plugin: &Rc<Plugin>) -> Result<(), SceneError> {
        self.placed_shape(plugin, DAffine3::IDENTITY, 0)
    }

    /// A shape within what stands around it.
    fn placed_shape(&mut self, plugin: &Rc<Plugin>, around: DAffine3, depth: usize) -> Result<(), SceneError> {
        plugin.visited.set(true);
        plugin.without_effect(&["id", "silhouette_sampling_weight", "kd_tree", "silhouette_discontinuity"]);
        if depth > DEEPEST_GROUP {
            return Err(plugin.error(format!("groups of shapes lie more than {DEEPEST_GROUP} deep within each other")));
        }
        let own = plugin.transform("to_world")?;
        let map = around * own;
        let well = map.is_finite() && map.matrix3.determinant().abs() > 0.0;
        if !well {
            return Err(plugin.error("`to_world` flattens the shape or leaves the range of numbers"));
        }
        match plugin.name.as_str() {
            // Seen where instances name it.
            "shapegroup" if depth == 0 => Ok(()),
            "shapegroup" | "merge" => {
                plugin.children_of("shape").into_iter().try_for_each(|shape| self.placed_shape(shape, around, depth + 1))
            }
            "instance" => {
                let groups: Vec<Rc<Plugin>> = plugin.children_of("shape").into_iter().cloned().collect();
                if groups.is_empty() {
                    return Err(plugin.error("an instance names a shapegroup by <ref>"));
                }
                if depth == 0
                    && let [group] = &groups[..]
                    && self.is_stored_once(group)?
                {
                    let places = self.groups.get_mut(&Rc::as_ptr(group)).map(|group| &mut group.places);
                    places.into_iter().for_each(|places| places.push(map));
                    return Ok(());
                }
                groups.iter().into_iter().try_for_each(|group| self.placed_shape(group, map, depth + 1))
            }
            _ => self.surface(plugin, around, own),
        }
    }

    /// Makes shapes of a group's meshes, once. Whether it is stored once: not where it is small, holds more than meshes, or gives light.
    fn is_stored_once(&mut self, group: &Rc<Plugin>) -> Result<bool, SceneError> {
        if let Some(known) = self.groups.get(&Rc::as_ptr(group)) {
            return Ok(known.is_stored_once);
        }
        let copies = self.copies.get(&Rc::as_ptr(group)).copied().unwrap_or(1);
        let (before, triangles) = (self.scene.file.shape.len(), self.triangles);
        self.media.in_group = true;
        self.placed_shape(group, DAffine3::IDENTITY, 1)?;
        self.media.in_group = false;
        let shapes = self.scene.file.shape.split_off(before);
        let gives_light = |shape: &ShapeEntry| shape.common().material.is_some_and(|name| self.scene.gives_light(&name.value));
        let is_plain = |shape: &Located<ShapeEntry>| matches!(shape.value, ShapeEntry::Mesh(_)) && !gives_light(&shape.value);
        let only_meshes = shapes.iter().all(is_plain);
        let is_stored_once = only_meshes && !shapes.is_empty() && pays_as_instances(copies, self.triangles - triangles);
        if !is_stored_once {
            self.triangles = triangles;
        }
        let (plugin, places) = (group.clone(), Vec::new());
        self.groups.insert(Rc::as_ptr(group), StoredGroup { plugin, shapes, places, is_stored_once });
        self.group_order.push(Rc::as_ptr(group));
        Ok(is_stored_once)
    }

    /// Adds the groups that are stored once, in the order in which they were met.
    pub fn finish_groups(&mut self) -> Result<(), SceneError> {
        for key in std::mem::take(&mut self.group_order) {
            let Some(group) = self.groups.remove(&key).filter(|group| group.is_stored_once) else { continue };
            let StoredGroup { plugin, shapes, places, .. } = group;
            let name = if plugin.id.is_empty() { "group" } else { &plugin.id };
            plugin.possible(self.scene.add_instances(name, &plugin.at(), shapes, &places))?;
        }
        Ok(())
    }

    /// How often instances at the top name each group.
    pub fn count_copies(&mut self, root: &Rc<Plugin>) {
        for instance in root.children_of("shape").into_iter().filter(|shape| shape.name == "instance") {
            for group in instance.children.iter().filter(|child| child.plugin.kind == "shape") {
                *self.copies.entry(Rc::as_ptr(&group.plugin)).or_default() += 1;
            }
        }
    }

    /// A shape by its own `to_world` and what stands around it.
    fn surface(&mut self, plugin: &Rc<Plugin>, around: DAffine3, own: DAffine3) -> Result<(), SceneError> {
        let bsdf = plugin.first_of("bsdf").cloned();
        let light = plugin.first_of("emitter").cloned();
        let light = light.map(|light| emitter::area_radiance(self, &light)).transpose()?.flatten();
        let within = bsdf.as_ref().map(|bsdf| bsdf.within).unwrap_or_default();
        let textured = within.uses_texture || matches!(light, Some(Input::Texture(..)));
        let flip = plugin.flag("flip_normals", false)?;
        if within.has_bump_map && own.matrix3.determinant() < 0.0 {
            let instead = "it is seen as in a mirror; version 3.9.1 shows the back of what keeps its normals";
            self.approximate(plugin, "bump map on a mirrored shape", instead);
        }
        if within.uses_attribute && within.uses_bitmap {
            self.drop(plugin, "texture beside an attribute of a mesh", "its texture coordinates are those of the attribute");
        }
        let Some((mut shape, map)) = self.geometry(
            plugin,
            (around, own),
            Looks { textured, flip, attributes: within.uses_attribute, bumped: within.has_relief },
        )?
        else {
            return Ok(());
        };
        let material = self.surface_material(plugin, bsdf.as_ref(), light);
        self.attributes = None;
        let sides = self.boundary(plugin, bsdf.is_some())?;
        let mut material = material?;
        let MetMedia { enclosures, in_group, .. } = &mut self.media;
        if *in_group {
            material = plugin.possible(enclosures.of_group(&mut self.scene, material, &sides, &plugin.at()))?;
        }
        let common = shape.common_mut();
        *common.material = Some(plugin.at().at(material));
        *common.transform = self.transform(&map, plugin)?;
        if !self.media.in_group {
            self.media.enclosures.note(&self.scene, &shape, sides, &plugin.at());
        }
        if self.scene.file.shape.len() >= MOST_SHAPES {
            return Err(too_many_shapes(&plugin.place));
        }
        self.scene.file.shape.push(plugin.at().at(shape));
        self.meters_on(plugin, around * own)
    }

    /// The geometry and the transform that is left; None where there is nothing to render.
    fn geometry(
        &mut self,
        plugin: &Rc<Plugin>,
        (around, own): (DAffine3, DAffine3),
        looks: Looks,
    ) -> Result<Option<(ShapeEntry, DAffine3)>, SceneError> {
        let map = around * own;
        let Looks { textured, flip, .. } = looks;
        let key = |name: &str| format!("({name}) {flip}");
        let place = plugin.at();
        Ok(Some(match plugin.name.as_str() {
            "sphere" => self.sphere(plugin, map, looks)?,
            "rectangle" => {
                let (u, v) = (DVec3::new(2.0, 0.0, 0.0), DVec3::new(0.0, 2.0, 0.0));
                // The sides of a mesh with a map of normals are known.
                let mirrors = map.matrix3.determinant() < 0.0;
                if (flip && textured) || (mirrors && looks.bumped) {
                    self.made_mesh(plugin, key("rectangle"), flip, map, square)?
                } else if flip {
                    // The front follows edge_u × edge_v.
                    (rectangle(plugin, v, u)?, map)
                } else {
                    (rectangle(plugin, u, v)?, map)
                }
            }
            "cube" => {
                if textured || flip {
                    self.made_mesh(plugin, key("cube"), flip, map, unit_cube)?
                } else {
                    let keys = plugin.possible(shapes::cuboid::Keys::of(DVec3::NEG_ONE, DVec3::ONE, &place))?;
                    self.counted(plugin, 12)?;
                    (ShapeEntry::Box(keys), map)
                }
            }
            "disk" => {
                if !textured && is_uniform(&map) {
                    let normal = if flip { DVec3::NEG_Z } else { DVec3::Z };
                    let keys = plugin.possible(shapes::disk::Keys::of(DVec3::ZERO, normal, 1.0, &place))?;
                    (ShapeEntry::Disk(keys), map)
                } else {
                    self.approximate(plugin, "shape `disk` with a texture or scaled unevenly", "128 triangles");
                    self.made_mesh(plugin, key("disk"), flip, map, disk)?
                }
            }
            "cylinder" => {
                let (p0, p1) = (plugin.vector("p0")?.unwrap_or(DVec3::ZERO), plugin.vector("p1")?.unwrap_or(DVec3::Z));
                let radius = plugin.number_or("radius", 1.0)?;
                let axis = p1 - p0;
                let Some(along) = axis.try_normalize().filter(|_| radius > 0.0) else {
                    return Err(plugin.error("the cylinder has no length or no radius"));
                };
                let (x, y) = along.any_orthonormal_pair();
                if is_uniform(&map) && !flip && !looks.bumped {
                    let tube = |from: DVec3, to: DVec3| {
                        plugin.possible(shapes::cylinder::Keys::of(from, to, radius, &place)).map(ShapeEntry::Cylinder)
                    };
                    if !textured {
                        return Ok(Some((tube(p0, p1)?, map)));
                    }
                    // Texture coordinates go round from x towards y there, and from x away from y here.
                    let own = DAffine3 { matrix3: DMat3::from_cols(x, -y, along), translation: p0 };
                    return Ok(Some((tube(DVec3::ZERO, DVec3::Z * axis.length())?, map * own)));
                }
                self.approximate(
                    plugin,
                    "shape `cylinder` scaled unevenly, turned inside out or with a map of normals or heights",
                    "256 triangles with interpolated normals",
                );
                let own = DAffine3 { matrix3: DMat3::from_cols(x * radius, y * radius, axis), translation: p0 };
                self.made_mesh(plugin, key("cylinder"), flip, map * own, cylinder)?
            }
            "obj" | "ply" | "serialized" => return self.mesh_shape(plugin, (around, own), looks),
            "hair" | "linecurve" | "bsplinecurve" | "heightfield" | "sdfgrid" | "ellipsoids" | "ellipsoidsmesh"
            | "deformable" => {
                for property in &plugin.properties {
                    property.used.set(true);
                }
                let what = format!("shape `{}`", plugin.name);
                self.drop(plugin, &what, "it is left out");
                return Ok(None);
            }
            other => {
                let what = format!("shape `{other}`");
                self.drop(plugin, &what, "it is left out");
                return Ok(None);
            }
        }))
    }

    fn sphere(&mut self, plugin: &Rc<Plugin>, map: DAffine3, looks: Looks) -> Result<(ShapeEntry, DAffine3), SceneError> {
        let Looks { textured, bumped, .. } = looks;
        let center = plugin.vector("center")?.unwrap_or(DVec3::ZERO);
        let radius = plugin.number_or("radius", 1.0)?;
        if radius.is_nan() || radius <= 0.0 {
            return Err(plugin.error(format!("the radius of a sphere is above 0, not {radius}")));
        }
        // A mirror turns spheres inside out there, unlike other shapes.
        let flip = looks.flip != (map.matrix3.determinant() < 0.0);
        let map = if is_uniform(&map) {
            map
        } else {
            self.approximate(plugin, "shape `sphere` scaled unevenly", "a sphere as wide as it is along x, as version 3 has it");
            evened(&map)
        };
        if !flip && !bumped {
            let ball = |center: DVec3| plugin.possible(shapes::sphere::Keys::of(center, radius)).map(ShapeEntry::Sphere);
            if !textured {
                return Ok((ball(center)?, map));
            }
            // Texture coordinates turn about +Z there and about +Y here.
            let turn = DMat3::from_cols(DVec3::Y, DVec3::NEG_Z, DVec3::NEG_X);
            let own = DAffine3::from_translation(center) * DAffine3::from_mat3(turn);
            return Ok((ball(DVec3::ZERO)?, map * own));
        }
        self.approximate(
            plugin,
            "shape `sphere` turned inside out or with a map of normals or heights",
            "16,000 triangles with interpolated normals",
        );
        let own = DAffine3::from_translation(center) * DAffine3::from_scale(DVec3::splat(radius));
        self.made_mesh(plugin, format!("(sphere) {flip}"), flip, map * own, grid_sphere)
    }

    /// A shape of triangles that is made once.
    fn made_mesh(
        &mut self,
        plugin: &Plugin,
        key: String,
        flip: bool,
        map: DAffine3,
        make: impl FnOnce() -> Mesh,
    ) -> Result<(ShapeEntry, DAffine3), SceneError> {
        let mesh = match self.meshes.get(&key) {
            Some(mesh) => mesh.clone(),
            None => {
                let mut mesh = make();
                if flip {
                    turn_inside_out(&mut mesh);
                }
                self.meshes.entry(key).or_insert(Arc::new(mesh)).clone()
            }
        };
        self.mesh_entry(plugin, mesh, map)
    }

    /// A shape of this mesh, whose triangles are counted.
    pub fn mesh_entry(&mut self, plugin: &Plugin, mesh: Arc<Mesh>, map: DAffine3) -> Result<(ShapeEntry, DAffine3), SceneError> {
        self.counted(plugin, mesh.faces.len() as u64)?;
        Ok((ShapeEntry::Mesh(shapes::mesh::Keys::of(mesh, &plugin.at())), map))
    }

    /// Instances are copies: what they take must be there.
    fn counted(&mut self, plugin: &Plugin, faces: u64) -> Result<(), SceneError> {
        self.triangles += faces;
        triangles_fit(self.triangles).map_err(|message| plugin.error(message))
    }
}

/// The use of a shape's geometry.
#[derive(Debug, Clone, Copy)]
pub struct Looks {
    /// A texture is looked up on it.
    pub textured: bool,
    pub flip: bool,
    /// Numbers of its vertices or faces are.
    pub attributes: bool,
    /// Normals or heights are: what has no edges becomes triangles.
    pub bumped: bool,
}

/// The square from −1 to 1 by the order of its edges.
fn rectangle(plugin: &Plugin, edge_u: DVec3, edge_v: DVec3) -> Result<ShapeEntry, SceneError> {
    let corner = DVec3::new(-1.0, -1.0, 0.0);
    plugin.possible(shapes::rectangle::Keys::of([corner, edge_u, edge_v], &plugin.at())).map(ShapeEntry::Rectangle)
}

/// The map that turns as this one does and scales as it scales x.
fn evened(map: &DAffine3) -> DAffine3 {
    let scale = map.matrix3.x_axis.length();
    let x = map.matrix3.x_axis / scale;
    // Nothing is flat: that was refused.
    let y = map.matrix3.y_axis.reject_from_normalized(x).normalize();
    let z = x.cross(y) * map.matrix3.determinant().signum();
    DAffine3 { matrix3: DMat3::from_cols(x, y, z) * scale, translation: map.translation }
}
