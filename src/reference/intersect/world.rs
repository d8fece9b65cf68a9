//! The scene's surfaces in world space.

use glam::{DVec2, DVec3};

use super::element::Element;
use super::hierarchy::{Hierarchy, PreparedRay};
use super::instances::{Instances, PlacedTriangle};
use super::mesh_data::MeshData;
use super::normal_map::{NormalMaps, Tangents, UvSet};
use super::owner::{Owner, SurfaceId};
use super::pose::{self, PathTime, Pose};
use super::ray::{Local, Ray, SurfacePoint};
use super::shape::{self, Placement, Primitive};
use crate::emission_map::EmitterPart;
use crate::reference::work;
use crate::renderer::RenderError;
use crate::scene::{MaterialId, Scene, Shape};
use crate::spectrum::Spectrum;
use crate::texture::Coordinates;

/// A ray's closest crossing.
#[derive(Debug, Clone, Copy)]
pub struct Hit {
    pub surface: SurfaceId,
    pub distance: f64,
    local: Local,
}

/// A point of a surface, where it is while the surface rests: in the world, or, of an instance, in the space of its group.
#[derive(Debug, Clone, Copy)]
pub struct PointAtRest {
    pub surface: SurfaceId,
    pub position: DVec3,
}

/// All there is to know of a surface at a point, whichever way it is looked at.
#[derive(Debug, Clone, Copy)]
pub struct Surface {
    pub id: SurfaceId,
    pub owner: Owner,
    pub point: SurfacePoint,
    /// Interpolated over the faces of smooth meshes, else the geometric normal; then perturbed by the material's normal map.
    pub shading_normal: DVec3,
    /// The normal before that, where it shadows the perturbed one.
    pub unperturbed_normal: Option<DVec3>,
    /// The shading normal where a coat lies about it, or about what the coat's own map makes of it.
    pub coat_normal: Option<DVec3>,
    /// A normal that is perturbed away from the viewer is mirrored about the normal before that.
    pub is_mirrored: bool,
    pub uv: DVec2,
    /// The second texture coordinates, of a mesh that has them.
    pub second_uv: Option<DVec2>,
    /// The directions in which texture coordinates grow, where the material depends on them and there are some.
    pub tangents: Option<Tangents>,
    /// The directions of the second texture coordinates, of a mesh that has them.
    pub second_tangents: Option<Tangents>,
    /// A ray of the camera met it that nothing has scattered.
    pub by_camera: bool,
    /// The throughput of the path up to it.
    pub carried: Spectrum,
}

impl Surface {
    /// The directions of the set that a texture lies by, which is the only one of what has no second.
    pub fn tangents_of(&self, set: UvSet) -> Option<Tangents> {
        if set == UvSet::Second && self.second_uv.is_some() { self.second_tangents } else { self.tangents }
    }

    pub fn coordinates(&self) -> Coordinates {
        Coordinates { first: self.uv, second: self.second_uv.unwrap_or(self.uv) }
    }
}

/// Surfaces that exist for rays. Those of a `pass` material do not, and are left out.
#[derive(Debug, Clone)]
pub struct World {
    hierarchy: Hierarchy,
    primitives: Vec<Primitive>,
    owners: Vec<Owner>,
    /// Leaf-order indices of the primitives, in the order of the scene file.
    scene_order: Vec<usize>,
    /// Primitives without bounds.
    infinite: Vec<(Primitive, Owner)>,
    instances: Instances,
    shapes: Vec<MeshData>,
    normal_maps: NormalMaps,
    /// By material: it or a part of it depends on the directions of texture coordinates.
    uses_tangents: Vec<bool>,
    /// By material: its coat, or that of a part of it, lies about another normal than the rest.
    coat_normals_differ: Vec<bool>,
    /// Windows that directions to the environment are sampled through; rays do not meet them.
    portals: Vec<Primitive>,
}

impl World {
    /// The scene has been checked by [`Scene::validate`].
    pub fn new(scene: &Scene) -> Result<Self, RenderError> {
        let mut collected = Collected::default();
        for (index, shape) in scene.shapes.iter().enumerate() {
            collected.add(scene, index, shape);
        }
        let swept = |(primitive, owner): &(Primitive, Owner)| {
            let bounds = primitive.element().bounds().unwrap_or_default();
            pose::swept(&scene.shapes[owner.shape], bounds, scene.camera.shutter)
        };
        let boxes: Vec<[DVec3; 2]> = collected.primitives.iter().map(swept).collect();
        let (instances, boxes_of_instances) = Instances::new(scene);
        let all_boxes = || boxes.iter().chain(&boxes_of_instances).flatten();
        let reach = all_boxes().fold(0.0, |reach: f64, corner| reach.max(corner.abs().max_element()));
        // The hierarchy's builder squares lengths in f32. A checked scene reaches to 1e18, is moved by as much to its camera, and its boxes are a
        // little larger.
        if !all_boxes().all(|corner| corner.is_finite()) || reach > 3e18 {
            return Err(RenderError::Internal("a shape lies farther than 3e18 from the camera".into()));
        }
        let (hierarchy, leaf_order) = Hierarchy::build(&boxes);
        let mut scene_order = vec![0; leaf_order.len()];
        for (index, &original) in leaf_order.iter().enumerate() {
            scene_order[original as usize] = index;
        }
        let in_leaf_order = |original: &u32| collected.primitives[*original as usize].clone();
        let (primitives, owners) = leaf_order.iter().map(in_leaf_order).unzip();
        let Collected { infinite, shapes, portals, .. } = collected;
        let normal_maps = NormalMaps::new(scene);
        let uses_tangents = scene.materials_that(|material| material.is_anisotropic() || material.has_coat_normal_map());
        let uses_tangents: Vec<bool> =
            uses_tangents.into_iter().zip(scene.layers_are_bent()).map(|(uses, bent)| uses || bent).collect();
        let coat_normals_differ = scene.coat_normals_differ();
        Ok(Self {
            hierarchy,
            primitives,
            owners,
            scene_order,
            infinite,
            instances,
            shapes,
            normal_maps,
            uses_tangents,
            coat_normals_differ,
            portals,
        })
    }

    /// Leaf-order indices of all primitives, in the order of the scene file; planes are not among them.
    pub fn indices_in_scene_order(&self) -> &[usize] {
        &self.scene_order
    }

    #[inline]
    pub fn primitive(&self, index: usize) -> &Primitive {
        &self.primitives[index]
    }

    /// The part of an area light that a primitive is; None of what has no texture coordinates.
    pub fn emitter_part(&self, index: usize) -> Option<EmitterPart> {
        let owner = self.owners[index];
        match &self.primitives[index] {
            Primitive::Triangle(_) => self.shapes[owner.shape].coordinates_of_corners(owner.part).map(EmitterPart::Triangle),
            Primitive::Other(element) => element.unrolled().map(EmitterPart::Whole),
        }
    }

    /// Portals, in the order of the scene file.
    pub fn portals(&self) -> &[Primitive] {
        &self.portals
    }

    #[inline]
    pub fn owner(&self, id: SurfaceId) -> Owner {
        match id {
            SurfaceId::Primitive(index) => self.owners[index],
            SurfaceId::Instanced { instance, triangle } => self.instances.owner(instance, triangle),
            SurfaceId::Infinite(index) => self.infinite[index].1,
        }
    }

    /// None: the primitive rests.
    #[inline]
    pub fn pose<'a>(&self, index: usize, time: &'a PathTime) -> Option<&'a Pose> {
        time.pose(self.owners[index].shape)
    }

    #[inline]
    fn intersect(&self, index: usize, ray: &PreparedRay, limit: f64, time: &PathTime) -> Option<(f64, Local)> {
        match self.pose(index, time) {
            None => self.primitives[index].intersect(ray, limit),
            Some(pose) => self.primitives[index].intersect(&PreparedRay::new(pose.ray_to_rest(&ray.ray)), limit),
        }
    }

    fn intersect_again(&self, index: usize, ray: &PreparedRay, limit: f64, time: &PathTime) -> Option<(f64, Local)> {
        let element = self.primitives[index].element();
        match self.pose(index, time) {
            None => element.intersect_again(ray, limit),
            Some(pose) => element.intersect_again(&PreparedRay::new(pose.ray_to_rest(&ray.ray)), limit),
        }
    }

    /// The first surface the ray meets.
    pub fn closest(&self, ray: Ray, time: &PathTime) -> Option<Hit> {
        work::add(self.infinite.len() as u64);
        let prepared = PreparedRay::new(ray);
        let mut closest = None;
        let mut limit = f64::INFINITY;
        for (index, (primitive, _)) in self.infinite.iter().enumerate() {
            if let Some((distance, local)) = primitive.intersect(&prepared, limit) {
                limit = distance;
                closest = Some(Hit { surface: SurfaceId::Infinite(index), distance, local });
            }
        }
        self.hierarchy.traverse(&prepared, limit, |index, before| match self.intersect(index, &prepared, before, time) {
            Some((distance, local)) => {
                closest = Some(Hit { surface: SurfaceId::Primitive(index), distance, local });
                limit = distance;
                distance
            }
            None => before,
        });
        self.instances.traverse(&prepared, limit, time, |surface, distance, local, _| {
            closest = Some(Hit { surface, distance, local });
            distance
        });
        closest
    }

    /// All hits before `limit`, each primitive once.
    pub fn hits_before(&self, ray: Ray, limit: f64, time: &PathTime) -> Vec<Hit> {
        let prepared = PreparedRay::new(ray);
        let mut hits = Vec::new();
        let mut add = |surface, met: Option<(f64, Local)>| {
            hits.extend(met.map(|(distance, local)| Hit { surface, distance, local }));
        };
        for (index, (primitive, _)) in self.infinite.iter().enumerate() {
            add(SurfaceId::Infinite(index), primitive.intersect(&prepared, limit));
        }
        self.hierarchy.traverse(&prepared, limit, |index, limit| {
            add(SurfaceId::Primitive(index), self.intersect(index, &prepared, limit, time));
            limit
        });
        self.instances.traverse(&prepared, limit, time, |surface, distance, local, limit| {
            add(surface, Some((distance, local)));
            limit
        });
        hits
    }

    /// The share of light that comes through all that the ray meets before `limit`: the product of what each surface lets through,
    /// `share`, of those whose materials let any through. `target` is the index of the primitive the ray ends on, which is not in its own way
    /// where it is opaque: no direction is drawn to what it hides.
    pub fn transmittance(
        &self,
        ray: Ray,
        limit: f64,
        target: Option<usize>,
        time: &PathTime,
        lets_through: impl Fn(MaterialId) -> bool,
        share: impl Fn(&Surface) -> f64,
    ) -> f64 {
        work::add(self.infinite.len() as u64);
        let prepared = PreparedRay::new(ray);
        let mut product = 1.0;
        let mut meet = |surface: SurfaceId, distance: f64, local: Local| {
            if !lets_through(self.owner(surface).material) {
                product = 0.0;
                return false;
            }
            work::add(work::TRANSLUCENT_SURFACE);
            let near = self.surface(&ray, &Hit { surface, distance, local }, time);
            product *= share(&near);
            // The far side of what is curved; instances are of triangles.
            if let SurfaceId::Primitive(index) = surface
                && let Some((distance, local)) = self.intersect_again(index, &prepared, limit, time)
            {
                product *= share(&self.surface(&ray, &Hit { surface, distance, local }, time));
            }
            product > 0.0
        };
        for (index, (primitive, _)) in self.infinite.iter().enumerate() {
            if let Some((distance, local)) = primitive.intersect(&prepared, limit)
                && !meet(SurfaceId::Infinite(index), distance, local)
            {
                return 0.0;
            }
        }
        let mut blocked = false;
        self.hierarchy.traverse(&prepared, limit, |index, limit| {
            if (Some(index) != target || lets_through(self.owner(SurfaceId::Primitive(index)).material))
                && let Some((distance, local)) = self.intersect(index, &prepared, limit, time)
                && !meet(SurfaceId::Primitive(index), distance, local)
            {
                blocked = true;
                return -1.0;
            }
            limit
        });
        if !blocked {
            self.instances.traverse(
                &prepared,
                limit,
                time,
                |surface, distance, local, limit| {
                    if meet(surface, distance, local) { limit } else { -1.0 }
                },
            );
        }
        product
    }

    /// The surface at a hit of `ray`.
    pub fn surface(&self, ray: &Ray, hit: &Hit, time: &PathTime) -> Surface {
        let owner = self.owner(hit.surface);
        match hit.surface {
            SurfaceId::Primitive(index) => {
                let primitive = self.primitives[index].element();
                let point = match self.pose(index, time) {
                    None => primitive.point(ray, hit.distance, hit.local),
                    Some(pose) => pose.point(&primitive.point(&pose.ray_to_rest(ray), hit.distance, hit.local)),
                };
                self.surface_at(index, point, hit.local, time)
            }
            SurfaceId::Instanced { instance, triangle } => {
                let PlacedTriangle { triangle, mesh, face, pose } = self.instances.triangle(instance, triangle, time);
                let at_rest = triangle.point(&pose.ray_to_rest(ray), hit.distance, hit.local);
                let point = pose.point(&at_rest);
                let looks = mesh.interpolate(face, hit.local, point.normal, Some(&pose));
                let tangents = |set| mesh.tangents(face, triangle, set).map(|tangents| pose.tangents(tangents));
                self.shaded((hit.surface, owner), point, looks, mesh.second_uv(face, hit.local), tangents)
            }
            SurfaceId::Infinite(index) => {
                let point = self.infinite[index].0.element().point(ray, hit.distance, hit.local);
                Surface {
                    id: hit.surface,
                    owner,
                    point,
                    shading_normal: point.normal,
                    unperturbed_normal: None,
                    coat_normal: None,
                    is_mirrored: false,
                    uv: DVec2::ZERO,
                    second_uv: None,
                    tangents: None,
                    second_tangents: None,
                    by_camera: false,
                    carried: Spectrum::WHITE,
                }
            }
        }
    }

    /// The point of a hit of `ray`, where it is at rest.
    pub fn at_rest(&self, ray: &Ray, hit: &Hit, time: &PathTime) -> PointAtRest {
        let position = match hit.surface {
            SurfaceId::Primitive(index) => {
                let ray = self.pose(index, time).map_or(*ray, |pose| pose.ray_to_rest(ray));
                self.primitives[index].element().point(&ray, hit.distance, hit.local).position
            }
            SurfaceId::Instanced { instance, triangle } => {
                let PlacedTriangle { triangle, pose, .. } = self.instances.triangle(instance, triangle, time);
                triangle.point(&pose.ray_to_rest(ray), hit.distance, hit.local).position
            }
            SurfaceId::Infinite(index) => self.infinite[index].0.element().point(ray, hit.distance, hit.local).position,
        };
        PointAtRest { surface: hit.surface, position }
    }

    /// The place of such a point in the world at a time.
    pub fn place_of(&self, point: &PointAtRest, time: &PathTime) -> DVec3 {
        match point.surface {
            SurfaceId::Primitive(index) => self.pose(index, time).map_or(point.position, |pose| pose.place(point.position)),
            SurfaceId::Instanced { instance, triangle } => {
                self.instances.triangle(instance, triangle, time).pose.place(point.position)
            }
            SurfaceId::Infinite(_) => point.position,
        }
    }

    /// The surface at a point of a primitive that is already known.
    pub fn surface_at(&self, index: usize, point: SurfacePoint, local: Local, time: &PathTime) -> Surface {
        let owner = self.owners[index];
        let shape = &self.shapes[owner.shape];
        let pose = self.pose(index, time);
        let at_rest = pose.map_or(point.normal, |pose| pose.normal_to_rest(point.normal));
        let (normal, uv) = match &self.primitives[index] {
            Primitive::Triangle(_) => shape.interpolate(owner.part, local, point.normal, pose),
            Primitive::Other(element) => (point.normal, element.uv(local, at_rest)),
        };
        let tangents = |set| {
            let at_rest = match &self.primitives[index] {
                Primitive::Triangle(triangle) => shape.tangents(owner.part, triangle, set),
                Primitive::Other(element) => element.tangents(local, at_rest),
            };
            at_rest.map(|tangents| pose.map_or(tangents, |pose| pose.tangents(tangents)))
        };
        let second_uv = shape.second_uv(owner.part, local);
        self.shaded((SurfaceId::Primitive(index), owner), point, (normal, uv), second_uv, tangents)
    }

    /// A surface with its own normal and texture coordinates, as its material bends it.
    fn shaded(
        &self,
        (id, owner): (SurfaceId, Owner),
        point: SurfacePoint,
        (normal, uv): (DVec3, DVec2),
        second_uv: Option<DVec2>,
        tangents: impl Fn(UvSet) -> Option<Tangents>,
    ) -> Surface {
        let coordinates = Coordinates { first: uv, second: second_uv.unwrap_or(uv) };
        let shading_normal = self.normal_maps.bend(owner.material, [normal, point.normal], coordinates, &tangents);
        let uses_tangents = self.uses_tangents[owner.material];
        let second_tangents = if uses_tangents && second_uv.is_some() { tangents(UvSet::Second) } else { None };
        let tangents = if uses_tangents { tangents(UvSet::First) } else { None };
        let coat_normal = self.coat_normals_differ[owner.material].then_some(normal);
        let unperturbed_normal = self.normal_maps.shadows(owner.material).then_some(normal);
        let is_mirrored = self.normal_maps.mirrors(owner.material);
        Surface {
            id,
            owner,
            point,
            shading_normal,
            unperturbed_normal,
            coat_normal,
            is_mirrored,
            uv,
            second_uv,
            tangents,
            second_tangents,
            by_camera: false,
            carried: Spectrum::WHITE,
        }
    }
}

/// The primitives found so far, in the order of the scene file.
#[derive(Default)]
struct Collected {
    primitives: Vec<(Primitive, Owner)>,
    infinite: Vec<(Primitive, Owner)>,
    shapes: Vec<MeshData>,
    portals: Vec<Primitive>,
}

impl Collected {
    fn add(&mut self, scene: &Scene, index: usize, shape: &Shape) {
        let placement = Placement::new(shape);
        for (part, primitive) in shape::primitives(&placement) {
            let material = shape.face_material(part);
            let owner = Owner { shape: index, part, material };
            let is_infinite = primitive.element().bounds().is_none();
            if !scene.materials[material].is_nothing() {
                let list = if is_infinite { &mut self.infinite } else { &mut self.primitives };
                list.push((primitive, owner));
            } else if shape.portal && !is_infinite && primitive.area() > 0.0 {
                self.portals.push(primitive);
            }
        }
        self.shapes.push(MeshData::new(shape));
    }
}
