//! Watching a path: what happened at each surface, and why.

use glam::DVec3;

use super::bsdf::{BsdfSample, View};
use super::intersect::{Hit, Owner, PathTime, Ray, Surface, SurfacePoint, World};
use super::lights::{LightSample, Lights};
use super::scatterer::Scatterer;
use crate::scene::{MaterialId, ReceiverId};
use crate::spectrum::Spectrum;

/// Next event estimation at one surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LightConnection {
    pub light: LightSample,
    /// Density of BSDF sampling for the same direction, per steradian.
    pub bsdf_pdf: f64,
    /// Weight by multiple importance sampling.
    pub weight: f64,
    pub visible: bool,
    /// The contribution to the path's radiance.
    pub contribution: Spectrum,
}

/// Is told what happens along a path, in this order. Those that do not care leave the methods as they are, at
/// no cost.
pub trait PathVisitor {
    /// Light is sampled for the path.
    const LIGHTS: bool = true;
    /// A path or shadow ray is traced.
    fn ray(&mut self, _ray: &Ray) {}
    /// The path met a surface; `throughput` is that of the path up to it, `depth` is that of the ray that met
    /// it.
    fn surface(&mut self, _depth: u32, _surface: &Surface, _wo: DVec3, _throughput: Spectrum) {}
    /// A medium scatters the path at this place.
    fn medium(&mut self, _depth: u32, _position: DVec3, _wo: DVec3, _throughput: Spectrum) {}
    /// The medium on the way of the path gave off light.
    fn given_off(&mut self, _contribution: Spectrum) {}
    /// The surface emits towards the path.
    fn emission(&mut self, _radiance: Spectrum, _weight: f64, _contribution: Spectrum) {}
    /// The method below is called.
    const COMPARES: bool = false;
    /// The direction of the light sample or of the path that is told of next would have so many times its
    /// density without a guide.
    fn unguided(&mut self, _times: f64) {}
    /// Light is about to be sampled at the place that was told of last, which belongs to this receiver.
    fn receiver(&mut self, _receiver: ReceiverId) {}
    /// The surface scatters, seen like this.
    fn view(&mut self, _view: &View) {}
    /// A light was sampled and could contribute.
    fn light(&mut self, _connection: &LightConnection) {}
    fn scattered(&mut self, _sample: &BsdfSample) {}
    fn roulette(&mut self, _survival: f64, _survived: bool) {}
    /// Says that a path with so many vertices is not to be followed any further.
    fn gives_up(&mut self, _vertices: u32) -> bool {
        false
    }
    /// The path left the scene.
    fn escaped(&mut self, _radiance: Spectrum, _weight: f64, _contribution: Spectrum) {}

    // The methods below may change what they are given, by as much as rounding does.

    /// The first surface that a path's ray meets; where others are as close but for rounding, one of them.
    fn first_hit(&mut self, world: &World, ray: &Ray, time: &PathTime) -> Option<Hit> {
        world.closest(*ray, time)
    }
    /// A ray about to be traced, and the point of a surface that it leaves; none for the camera's.
    fn round_ray(&mut self, _ray: &mut Ray, _left: Option<&SurfacePoint>) {}
    /// A surface that was met.
    fn round_surface(&mut self, _surface: &mut Surface) {}
    /// A point of a surface, of numbers of this magnitude, that light is sampled from.
    fn round_point(&mut self, _point: &mut DVec3, _magnitude: f64) {}
    /// A direction of unit length.
    fn round_direction(&mut self, _direction: &mut DVec3) {}
    /// A random number that a choice is made by: where it is close to the border, rounding decides.
    fn round_number(&mut self, number: f64) -> f64 {
        number
    }
    /// The bits of the random numbers by which a direction to a light is drawn; `magnified` says how many
    /// times their rounding errors are magnified.
    fn round_light_numbers(&mut self, bits: [u32; 2], _magnified: impl FnOnce() -> f64) -> [u32; 2] {
        bits
    }
    /// A sample of one of the lights.
    fn round_light(&mut self, _light: &mut LightSample, _lights: &Lights) {}
    /// A sampled direction, with the density that belongs to it.
    fn round_sample(&mut self, _sample: &mut BsdfSample, _scatterer: &Scatterer<'_>) {}
}

/// Counts rays.
#[derive(Debug, Clone, Copy, Default)]
pub struct RayCounter(pub u64);

impl PathVisitor for RayCounter {
    fn ray(&mut self, _ray: &Ray) {
        self.0 += 1;
    }
}

/// Emission or environment radiance that a path found by itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FoundLight {
    pub radiance: Spectrum,
    /// Weight by multiple importance sampling.
    pub weight: f64,
    pub contribution: Spectrum,
}

/// The surface at a vertex of a traced path.
#[derive(Debug, Clone, PartialEq)]
pub struct VertexSurface {
    /// Front side.
    pub geometric_normal: DVec3,
    /// Indices into the scene.
    pub shape: usize,
    /// Face of a mesh or box.
    pub part: usize,
    pub material: MaterialId,
}

/// One vertex of a traced path.
#[derive(Debug, Clone, PartialEq)]
pub struct PathVertex {
    /// Path edges up to here; the first vertex has 1.
    pub depth: u32,
    pub position: DVec3,
    /// The surface; none within a medium.
    pub surface: Option<VertexSurface>,
    /// On wo's side; none where the path ended before scattering, and within a medium.
    pub shading_normal: Option<DVec3>,
    pub wo: DVec3,
    /// The path's throughput up to here.
    pub throughput: Spectrum,
    pub emission: Option<FoundLight>,
    pub light: Option<LightConnection>,
    pub scattered: Option<BsdfSample>,
    /// Probability of surviving Russian roulette, and whether the path did.
    pub roulette: Option<(f64, bool)>,
}

impl PathVertex {
    /// A vertex at which nothing has happened yet.
    fn new(depth: u32, position: DVec3, surface: Option<VertexSurface>, wo: DVec3, throughput: Spectrum) -> Self {
        let (emission, light, scattered, roulette) = (None, None, None, None);
        Self { depth, position, surface, shading_normal: None, wo, throughput, emission, light, scattered, roulette }
    }
}

/// Everything that happened along one path.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PathTrace {
    /// Path and shadow rays as traced.
    pub rays: Vec<Ray>,
    pub vertices: Vec<PathVertex>,
    pub escaped: Option<FoundLight>,
    pub radiance: Spectrum,
}

impl PathTrace {
    fn at_last_vertex(&mut self, note: impl FnOnce(&mut PathVertex)) {
        if let Some(vertex) = self.vertices.last_mut() {
            note(vertex);
        }
    }
}

impl PathVisitor for PathTrace {
    fn ray(&mut self, ray: &Ray) {
        self.rays.push(*ray);
    }

    fn surface(&mut self, depth: u32, surface: &Surface, wo: DVec3, throughput: Spectrum) {
        let Owner { shape, part, material } = surface.owner;
        let of_vertex = VertexSurface { geometric_normal: surface.point.normal, shape, part, material };
        self.vertices.push(PathVertex::new(depth, surface.point.position, Some(of_vertex), wo, throughput));
    }

    fn medium(&mut self, depth: u32, position: DVec3, wo: DVec3, throughput: Spectrum) {
        self.vertices.push(PathVertex::new(depth, position, None, wo, throughput));
    }

    fn emission(&mut self, radiance: Spectrum, weight: f64, contribution: Spectrum) {
        self.at_last_vertex(|vertex| vertex.emission = Some(FoundLight { radiance, weight, contribution }));
    }

    fn view(&mut self, view: &View) {
        self.at_last_vertex(|vertex| vertex.shading_normal = Some(view.normal()));
    }

    fn light(&mut self, connection: &LightConnection) {
        self.at_last_vertex(|vertex| vertex.light = Some(*connection));
    }

    fn scattered(&mut self, sample: &BsdfSample) {
        self.at_last_vertex(|vertex| vertex.scattered = Some(*sample));
    }

    fn roulette(&mut self, survival: f64, survived: bool) {
        self.at_last_vertex(|vertex| vertex.roulette = Some((survival, survived)));
    }

    fn escaped(&mut self, radiance: Spectrum, weight: f64, contribution: Spectrum) {
        self.escaped = Some(FoundLight { radiance, weight, contribution });
    }
}
