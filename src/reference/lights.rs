//! What light is sampled from: emitting primitives, then point lights and environments, chosen by power.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use super::emission::{emitted, mean_exitance};
use super::frame::Frame;
use super::intersect::{Primitive, Ray, Sphere, Surface, SurfaceId, SurfacePoint, World};
use super::warp;
use crate::sampling::AliasTable;
use crate::scene::{EnvironmentRadiance, Estimator, Light, Scene};

/// Relative amount by which a shadow segment stops short of the light's point, so that what the light lies upon does not block it.
const SHADOW_MARGIN: f64 = 1e-12;

/// Something that can be chosen for light sampling.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Source {
    /// An emitting primitive, by its place in the hierarchy's leaf order.
    Area(usize),
    Point {
        position: DVec3,
        intensity: DVec3,
    },
    Environment(DVec3),
}

/// All lights of a scene, with the table they are chosen from.
#[derive(Debug, Clone)]
pub struct Lights {
    sources: Vec<Source>,
    table: AliasTable,
    /// Index into `sources` by leaf-order place of the primitive.
    of_primitive: Vec<Option<u32>>,
    /// Sum of all constant environments' radiance.
    environment: DVec3,
    environment_is_sampled: bool,
}

/// Light arriving at a reference point from one sampled direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LightSample {
    /// Index of the light among those that can be chosen.
    pub light: usize,
    pub wi: DVec3,
    /// Length of the segment that must be free.
    pub distance: f64,
    /// Radiance; for a point light, intensity over squared distance.
    pub radiance: DVec3,
    /// Probability of the light times density of the direction per steradian; for a point light, the probability alone.
    pub pdf: f64,
    /// The direction was the only one the light has.
    pub delta: bool,
    /// The primitive the segment ends on. It is convex seen from outside and hollow from inside, so it cannot block itself.
    pub target: Option<usize>,
}

/// A direction to an emitting primitive, before its emission is looked up.
struct Direction {
    wi: DVec3,
    distance: f64,
    pdf_solid_angle: f64,
    point: SurfacePoint,
    local: DVec2,
}

/// Rec.709 luminance.
pub fn luminance(color: DVec3) -> f64 {
    color.dot(DVec3::new(0.2126, 0.7152, 0.0722))
}

impl Lights {
    pub fn new(scene: &Scene, world: &World) -> Self {
        let (mut sources, mut weights) = (Vec::new(), Vec::new());
        let mut of_primitive = vec![None; world.places_in_scene_order().len()];
        for &place in world.places_in_scene_order() {
            let material = world.owner(SurfaceId::Primitive(place)).material;
            let power = world.primitive(place).area() * mean_exitance(scene, material);
            if power > 0.0 {
                of_primitive[place] = Some(sources.len() as u32);
                sources.push(Source::Area(place));
                weights.push(power);
            }
        }
        let (mut environment, mut environment_is_sampled) = (DVec3::ZERO, false);
        for light in &scene.lights {
            match light {
                Light::Point { position, intensity } if luminance(*intensity) > 0.0 => {
                    sources.push(Source::Point { position: *position, intensity: *intensity });
                    weights.push(4.0 * PI * luminance(*intensity));
                }
                Light::Environment(light) => {
                    let EnvironmentRadiance::Constant(radiance) = light.radiance else { continue };
                    environment += radiance;
                    // Where BSDF sampling takes part, it finds a constant environment better than light sampling does.
                    if scene.render.estimator == Estimator::Nee && luminance(radiance) > 0.0 {
                        environment_is_sampled = true;
                        sources.push(Source::Environment(radiance));
                        weights.push(0.0);
                    }
                }
                // The others are refused before rendering.
                _ => {}
            }
        }
        // An environment's power depends on how large the scene is taken to be; it is chosen as often as all other lights together.
        let others: f64 = weights.iter().sum();
        for (source, weight) in sources.iter().zip(&mut weights) {
            if matches!(source, Source::Environment(_)) {
                *weight = if others > 0.0 { others } else { 1.0 };
            }
        }
        Self { sources, table: AliasTable::new(&weights), of_primitive, environment, environment_is_sampled }
    }

    pub fn is_empty(&self) -> bool {
        self.sources.is_empty()
    }

    /// Radiance of the environment, the same in every direction.
    pub fn environment(&self) -> DVec3 {
        self.environment
    }

    /// Whether light sampling can choose the environment.
    pub fn environment_is_sampled(&self) -> bool {
        self.environment_is_sampled
    }

    /// Chooses a light by 32 random bits and draws a direction to it. None where no light comes from there.
    pub fn sample(&self, scene: &Scene, world: &World, reference: DVec3, bits: u32, u1: f64, u2: f64) -> Option<LightSample> {
        let light = self.table.choose(bits);
        let probability = self.table.pmf[light];
        let infinity = f64::INFINITY;
        let sample = |wi, distance, radiance, pdf: f64, target| {
            let delta = matches!(self.sources[light], Source::Point { .. });
            LightSample { light, wi, distance, radiance, pdf: probability * pdf, delta, target }
        };
        match self.sources[light] {
            Source::Area(place) => {
                let direction = sample_primitive(world.primitive(place), reference, u1, u2)?;
                let surface = world.surface_at(place, direction.point, direction.local);
                let radiance = emitted(scene, &surface, -direction.wi);
                let distance = direction.distance * (1.0 - SHADOW_MARGIN);
                let usable = radiance != DVec3::ZERO && direction.pdf_solid_angle > 0.0 && direction.pdf_solid_angle.is_finite();
                usable.then(|| sample(direction.wi, distance, radiance, direction.pdf_solid_angle, Some(place)))
            }
            Source::Point { position, intensity } => {
                let to_light = position - reference;
                let squared = to_light.length_squared();
                let distance = squared.sqrt();
                (squared > 0.0).then(|| sample(to_light / distance, distance, intensity / squared, 1.0, None))
            }
            Source::Environment(radiance) => {
                Some(sample(warp::uniform_sphere(u1, u2), infinity, radiance, warp::UNIFORM_SPHERE_PDF, None))
            }
        }
    }

    /// Density, per steradian, with which [`Lights::sample`] finds the point `surface` from `reference`; 0 where it cannot.
    pub fn pdf(&self, world: &World, reference: DVec3, surface: &Surface) -> f64 {
        let SurfaceId::Primitive(place) = surface.id else { return 0.0 };
        let Some(light) = self.of_primitive[place] else { return 0.0 };
        self.table.pmf[light as usize] * pdf_solid_angle(world.primitive(place), reference, &surface.point)
    }
}

fn sample_primitive(primitive: &Primitive, reference: DVec3, u1: f64, u2: f64) -> Option<Direction> {
    let (point, local) = match primitive {
        Primitive::Sphere(sphere) => return sample_sphere(sphere, reference, u1, u2),
        Primitive::Triangle(triangle) => {
            let local = warp::triangle(u1, u2);
            (triangle.point(local), local)
        }
        Primitive::Parallelogram(parallelogram) => {
            let local = DVec2::new(u1, u2);
            (parallelogram.point(local), local)
        }
        Primitive::Disk(disk) => {
            let p = warp::disk(disk.radius, u1, u2);
            (disk.point(disk.center + disk.frame.to_world(DVec3::new(p.x, p.y, 0.0))), DVec2::ZERO)
        }
    };
    let to_point = point.position - reference;
    let distance = to_point.length();
    let wi = to_point / distance;
    let pdf_solid_angle = pdf_solid_angle(primitive, reference, &point);
    (distance > 0.0).then_some(Direction { wi, distance, pdf_solid_angle, point, local })
}

/// From outside, uniform over the cone of directions that meet the sphere; from inside, uniform over all directions.
fn sample_sphere(sphere: &Sphere, reference: DVec3, u1: f64, u2: f64) -> Option<Direction> {
    let to_center = sphere.center - reference;
    let squared = to_center.length_squared();
    let center_distance = squared.sqrt();
    let radius_squared = sphere.radius * sphere.radius;
    let (wi, distance) = if center_distance > sphere.radius {
        let local = warp::cone(one_minus_cos_max(radius_squared / squared), u1, u2);
        let sin_squared = local.x * local.x + local.y * local.y;
        let half_chord = (radius_squared - squared * sin_squared).max(0.0).sqrt();
        (Frame::around(to_center / center_distance).to_world(local), center_distance * local.z - half_chord)
    } else {
        let wi = warp::uniform_sphere(u1, u2);
        (wi, sphere.intersect(&Ray { origin: reference, direction: wi }, f64::INFINITY)?)
    };
    let point = sphere.point(reference + wi * distance);
    let pdf_solid_angle = sphere_pdf(sphere, reference);
    (distance > 0.0).then_some(Direction { wi, distance, pdf_solid_angle, point, local: DVec2::ZERO })
}

/// Density per steradian with which a point of a primitive is drawn, seen from `reference`.
fn pdf_solid_angle(primitive: &Primitive, reference: DVec3, point: &SurfacePoint) -> f64 {
    if let Primitive::Sphere(sphere) = primitive {
        return sphere_pdf(sphere, reference);
    }
    // Uniform over the area: dA·cosθ / d² is the solid angle of dA.
    let to_point = point.position - reference;
    let squared = to_point.length_squared();
    squared * squared.sqrt() / (to_point.dot(point.normal).abs() * primitive.area())
}

fn sphere_pdf(sphere: &Sphere, reference: DVec3) -> f64 {
    let squared = (sphere.center - reference).length_squared();
    if squared.sqrt() > sphere.radius {
        warp::cone_pdf(one_minus_cos_max(sphere.radius * sphere.radius / squared))
    } else {
        warp::UNIFORM_SPHERE_PDF
    }
}

/// 1 − cosθ from sin²θ, without cancellation.
fn one_minus_cos_max(sin_squared: f64) -> f64 {
    sin_squared / (1.0 + (1.0 - sin_squared).max(0.0).sqrt())
}

#[cfg(test)]
mod tests;
