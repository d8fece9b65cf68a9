//! Shapes, objects and where those stand.

use std::collections::{BTreeSet, HashMap};

use glam::{DAffine3, DMat3, DVec3};

use super::Writer;
use super::directive::{Directive, Number};
use super::made::Made;
use crate::load::file::writer::ply;
use crate::scene::shape::tessellation::{PLANE, part_of};
use crate::scene::texture::mean_of_texture;
use crate::scene::{Emission, Geometry, MaterialId, Mesh, Scene, Shape};
use crate::scene_writer::emission::emission_of;
use crate::scene_writer::inputs::{Colour, ColourMap};
use crate::spectrum::Spectrum;

/// Faces up to which a mesh stands in the text.
const FEW_FACES: usize = 64;

impl Writer<'_> {
    pub fn shapes(&mut self) {
        let scene = self.scene;
        for (index, shape) in scene.shapes.iter().enumerate() {
            self.shape(shape, &format!("shape[{index}]"), None, false);
        }
    }

    /// A shape, with a material in place of its own ones if one is given.
    fn shape(&mut self, shape: &Shape, place: &str, replaced: Option<MaterialId>, is_of_group: bool) {
        if shape.motion.is_some() {
            self.drop("motion", place, "the shape rests where the shutter opens");
        }
        let own: BTreeSet<MaterialId> = shape.materials().collect();
        for &id in &own {
            let scene = self.scene;
            // Openings stay openings.
            let shown = replaced.filter(|_| !scene.materials[id].is_nothing()).unwrap_or(id);
            if scene.materials[shown].is_nothing() {
                continue;
            }
            let made = self.material(shown, None);
            // Groups hold no emitters.
            let emission = if is_of_group { None } else { emission_of(scene, shown, &self.place_of(shown), &mut self.losses) };
            let sides = self.surroundings.sides(shown, shape.bounds().filter(|_| !is_of_group));
            let interface = sides.and_then(|sides| self.interface(sides));
            let is_part = own.len() > 1;
            let look = Look { shows_texture: self.is_textured[shown], emits: emission.is_some(), part: is_part.then_some(id) };
            let Some(Placed { map, is_reversed, directive }) = self.geometry(shape, place, look) else { continue };
            self.report_bent(shape, shown, place);
            let directive = match &made.alpha {
                Number::Constant(1.0) => directive,
                alpha => directive.number("alpha", alpha),
            };
            let light = emission.and_then(|emission| self.area_light(emission, &made, &self.place_of(shown)));
            self.attributes(|writer| {
                if let Some(interface) = interface {
                    writer.push(interface);
                }
                writer.push(match &made.name {
                    Some(name) => Directive::new("NamedMaterial", &[name]),
                    None => Directive::new("Material", &["interface"]),
                });
                light.into_iter().for_each(|light| writer.push(light));
                if is_reversed {
                    writer.line("ReverseOrientation".to_owned());
                }
                writer.placed(&map);
                writer.push(directive);
            });
        }
    }

    fn area_light(&mut self, emission: Emission, made: &Made, place: &str) -> Option<Directive> {
        if made.name.is_none() {
            self.drop("light of a surface that is not there", place, "it gives no light");
            return None;
        }
        // A surface that is there by a share gives off its light by that share too.
        let radiance = match made.alpha {
            Number::Constant(alpha) if alpha > 0.0 => emission.radiance.scaled(Spectrum::grey(1.0 / alpha)),
            Number::Constant(_) => return None,
            Number::Texture(_) => {
                self.approximate("light of a surface that is not everywhere", place, "it is given off where the surface is");
                emission.radiance
            }
        };
        let light = Directive::new("AreaLightSource", &["diffuse"]);
        let light = match Colour::of(radiance) {
            Colour::Constant(radiance) => light.rgb("L", radiance),
            Colour::Map(map) => match self.emitted_picture(map, place) {
                Some(file) => light.string("filename", &file),
                None => {
                    self.approximate("texture of emission", place, "its mean is given off everywhere");
                    light.rgb("L", mean(self.scene, map))
                }
            },
        };
        Some(if emission.two_sided { light.flag("twosided", true) } else { light })
    }

    /// A shape as pbrt has it.
    fn geometry(&mut self, shape: &Shape, place: &str, look: Look) -> Option<Placed> {
        let map = shape.transform.to_affine();
        // Round shapes are scaled alike along all axes.
        let scale = map.matrix3.x_axis.length();
        let (axes, center, directive) = match &shape.geometry {
            Geometry::Sphere(sphere) => {
                // Texture coordinates turn about +Y here, from −Z over +X, and about +Z there, from +X over +Y.
                let axes = map.matrix3 * (1.0 / scale) * DMat3::from_cols(DVec3::NEG_Z, DVec3::X, DVec3::Y);
                let sphere_there = Directive::new("Shape", &["sphere"]).float("radius", sphere.radius * scale);
                (axes, map.transform_point3(sphere.center), sphere_there)
            }
            Geometry::Cylinder(tube) => {
                let [from, to] = [tube.from, tube.to].map(|end| map.transform_point3(end));
                let along = (to - from).normalize_or(DVec3::Z);
                let first = (map.matrix3 * tube.first_direction()).normalize_or(DVec3::X);
                let second = if shape.is_mirrored() { along.cross(first) } else { first.cross(along) };
                let cylinder = Directive::new("Shape", &["cylinder"]).float("radius", tube.radius * scale);
                let cylinder = cylinder.float("zmin", 0.0).float("zmax", (to - from).length());
                (DMat3::from_cols(first, second, along), from, cylinder)
            }
            Geometry::Disk(disk) => {
                let along = (map.matrix3 * disk.normal).normalize_or(DVec3::Z);
                let (across, beside) = along.any_orthonormal_pair();
                let disk_there = Directive::new("Shape", &["disk"]).float("radius", disk.radius * scale);
                (DMat3::from_cols(across, beside, along), map.transform_point3(disk.center), disk_there)
            }
            other => {
                let deviation = scale * other.tessellated().deviation;
                let instead = match other.is_infinite() {
                    true => Some(format!("a square of {} units is taken", 2.0 * PLANE)),
                    false => (deviation > 0.0).then(|| format!("it is made of triangles, {deviation:.2e} off at most")),
                };
                if let Some(instead) = instead {
                    self.approximate(format!("shape `{}`", other.kind_name()), place, instead);
                }
                return self.mesh(shape, place, look.part).map(Placed::in_world);
            }
        };
        let is_mirrored = axes.determinant() < 0.0;
        if is_mirrored && look.shows_texture && look.emits {
            // Places on a light are drawn there without regard to a mirror.
            let deviation = scale * shape.geometry.tessellated().deviation;
            let what = format!("{} with a texture that gives light", shape.geometry.kind_name());
            self.approximate(what, place, format!("it is made of triangles, {deviation:.2e} off at most"));
            return self.mesh(shape, place, look.part).map(Placed::in_world);
        }
        // Without a texture nobody sees the mirror.
        let axes =
            if is_mirrored && !look.shows_texture { DMat3::from_cols(axes.x_axis, -axes.y_axis, axes.z_axis) } else { axes };
        let map = DAffine3 { matrix3: axes, translation: center };
        Some(Placed { map, is_reversed: axes.determinant() < 0.0, directive })
    }

    /// Reports what a normal map there is not as it is here.
    fn report_bent(&mut self, shape: &Shape, material: MaterialId, place: &str) {
        if self.is_bent[material] && has_mirrored_uvs(shape) {
            let instead = "its green bends the other way";
            self.approximate("normal map where texture coordinates are mirrored", place, instead);
        }
    }

    /// Triangles where they stand in the world.
    fn mesh(&mut self, shape: &Shape, place: &str, part: Option<MaterialId>) -> Option<Directive> {
        let mesh = shape.geometry.tessellated().mesh;
        let shape = Shape { geometry: Geometry::Mesh(mesh.clone()), ..shape.clone() };
        let normals = if mesh.smooth { shape.world_normals() } else { Vec::new() };
        let placed = Mesh {
            positions: shape.world_positions(),
            normals,
            uvs: mesh.uvs.clone(),
            faces: shape.world_faces(),
            smooth: mesh.smooth,
            ..Mesh::default()
        };
        let placed = match part {
            Some(material) => part_of(&placed, |face| shape.face_material(face) == material),
            None => placed,
        };
        if placed.faces.is_empty() {
            return None;
        }
        if placed.faces.len() > FEW_FACES {
            let suffix = part.map_or_else(String::new, |material| format!("-material-{material}"));
            let file = format!("{}{suffix}.ply", place.replace(['[', '.'], "-").replace(']', ""));
            let name = self.files.add_file(&file, ply(&placed, None));
            return Some(Directive::new("Shape", &["plymesh"]).string("filename", &name));
        }
        let triangles =
            Directive::new("Shape", &["trianglemesh"]).integers("indices", placed.faces.as_flattened().iter().copied());
        let triangles = triangles.coordinates("point3", "P", placed.positions.iter().flat_map(|at| at.to_array()));
        let triangles = if placed.normals.is_empty() {
            triangles
        } else {
            triangles.coordinates("normal", "N", placed.normals.iter().flat_map(|normal| normal.to_array()))
        };
        Some(if placed.uvs.is_empty() {
            triangles
        } else {
            triangles.coordinates("point2", "uv", placed.uvs.iter().flat_map(|uv| uv.to_array()))
        })
    }

    /// Groups as objects, once for each material in place of their own, and the places where they stand.
    pub fn instances(&mut self) {
        let scene = self.scene;
        let mut objects: HashMap<(usize, Option<MaterialId>), String> = HashMap::new();
        for (index, instances) in scene.instances.iter().enumerate() {
            let place = format!("instance[{index}]");
            if instances.motion.is_some() {
                self.drop("motion", &place, "instances rest where the shutter opens");
            }
            let key = (instances.group, instances.material);
            let name = match objects.get(&key) {
                Some(name) => name.clone(),
                None => {
                    let name = format!("group {} of {}", objects.len(), scene.groups[instances.group].name);
                    self.object(&name, instances.group, instances.material);
                    objects.insert(key, name.clone());
                    name
                }
            };
            for map in instances.maps() {
                self.attributes(|writer| {
                    writer.placed(&map);
                    writer.push(Directive::new("ObjectInstance", &[&name]));
                });
            }
        }
    }

    fn object(&mut self, name: &str, group: usize, material: Option<MaterialId>) {
        let scene = self.scene;
        let shapes = &scene.groups[group].shapes;
        // Materials stand before objects: they hold shapes alone.
        for id in shapes.iter().flat_map(Shape::materials).collect::<BTreeSet<_>>() {
            let _ = self.material(material.unwrap_or(id), None);
        }
        self.push(Directive::new("ObjectBegin", &[name]));
        for (index, shape) in shapes.iter().enumerate() {
            self.shape(shape, &format!("group[{group}].shape[{index}]{}", suffix(material)), material, true);
        }
        self.line("ObjectEnd".to_owned());
    }
}

fn suffix(material: Option<MaterialId>) -> String {
    material.map_or_else(String::new, |material| format!(".as[{material}]"))
}

/// The look of a shape.
#[derive(Clone, Copy)]
struct Look {
    shows_texture: bool,
    emits: bool,
    /// The material of the faces that are wanted; None: of all.
    part: Option<MaterialId>,
}

/// A shape with the map from its space to the world.
struct Placed {
    map: DAffine3,
    /// The map mirrors, and fronts stay fronts.
    is_reversed: bool,
    directive: Directive,
}

impl Placed {
    fn in_world(directive: Directive) -> Self {
        Self { map: DAffine3::IDENTITY, is_reversed: false, directive }
    }
}

/// Texture coordinates somewhere run clockwise as seen from the front.
fn has_mirrored_uvs(shape: &Shape) -> bool {
    let mirrored = shape.is_mirrored();
    let mesh = shape.geometry.tessellated().mesh;
    mesh.faces.iter().any(|face| {
        let [Some(a), Some(b), Some(c)] = face.map(|vertex| mesh.uvs.get(vertex as usize)) else { return false };
        let area = (*b - *a).perp_dot(*c - *a);
        if mirrored { area > 0.0 } else { area < 0.0 }
    })
}

fn mean(scene: &Scene, map: ColourMap) -> Spectrum {
    let mean = mean_of_texture(&scene.textures, map.texture);
    map.of_texel([mean.r(), mean.g(), mean.b(), 1.0])
}
