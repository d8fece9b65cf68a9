//! The nodes of a tree of lights, as both devices read them.

use glam::DVec3;

use super::cone::Cone;
use crate::math::octahedron;

/// Flags of a link; the rest of it is the number of a node, or of a light.
pub const LEAF: u32 = 1 << 31;
pub const TWO_SIDED: u32 = 1 << 30;
pub const NUMBER_MASK: u32 = TWO_SIDED - 1;

/// Cosines and coordinates are kept in 16 bits as multiples of this, a power of two: 1 comes back as 1.
pub const STEP: f64 = 1.0 / 16384.0;
/// Least probability of a cluster that sends light to a point while the other one does as well: what is known of them is rough.
pub const LEAST_SHARE: f64 = 1.0 / 4096.0;
/// Least cosine at the lights that is reckoned with, for the same reason.
pub const LEAST_COSINE: f64 = 0.01;

/// Two clusters of lights.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct LightNode {
    pub clusters: [LightCluster; 2],
}

/// Some lights: 32 bytes.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct LightCluster {
    /// Centre of a sphere around the lights.
    pub center: [f32; 3],
    pub radius: f32,
    /// Power of the lights, as a share of that of all lights in the tree.
    pub power: f32,
    /// The axis of their cone on an octahedron unfolded to a square: two numbers of 16 bits, the first in the lower half.
    pub axis: u32,
    /// Cosines of their cone's spread and reach: two numbers of 16 bits.
    pub cosines: u32,
    /// [`LEAF`] and the number of a light, or the number of a node; and [`TWO_SIDED`].
    pub link: u32,
}

/// Least distance that is reckoned with where points and lights lie among each other, as a share of the radius of both.
const NEAREST: f64 = 0.25;

/// Light that a cluster can send to a point.
#[derive(Debug, Clone, Copy)]
struct Seen {
    /// Power times the largest cosine there can be; 0 where nothing arrives.
    power: f64,
    /// To the sphere's center, or to its surface from there where the point lies within.
    squared_distance: f64,
}

impl LightCluster {
    pub fn new(center: DVec3, radius: f64, power: f64, cone: Cone, link: u32) -> Self {
        let flags = if cone.two_sided { TWO_SIDED } else { 0 };
        // Rounded down, cosines are those of wider cones.
        let lower = |angle: f64| (angle.cos() / STEP).floor();
        Self {
            center: center.as_vec3().to_array(),
            radius: radius as f32,
            power: power.max(f64::from(f32::MIN_POSITIVE)) as f32,
            axis: halves(octahedron::place_of(cone.axis).map(|x| (x / STEP).round())),
            cosines: halves([lower(cone.spread), lower(cone.reach)]),
            link: link | flags,
        }
    }

    /// Light that the cluster can send to a point, as `cluster_seen` in `shaders/shading/light/choice/tree.wgsl` finds it.
    fn seen(&self, point: DVec3) -> Seen {
        let away = point - DVec3::from(self.center.map(f64::from));
        let (power, radius) = (f64::from(self.power), f64::from(self.radius));
        let (squared, squared_radius) = (away.length_squared(), radius * radius);
        if squared <= squared_radius {
            return Seen { power, squared_distance: squared_radius };
        }
        let distance = squared.sqrt();
        let axis = octahedron::direction_at(numbers(self.axis));
        let [spread, reach] = numbers(self.cosines);
        let along = axis.dot(away) / distance;
        let aside = axis.cross(away).length() / distance;
        let along = if self.link & TWO_SIDED != 0 { along.abs() } else { along };
        // The angle to the nearest direction that is within the spread.
        let (mut cosine, mut sine) = (1.0, 0.0);
        if along < spread {
            let sine_of_spread = (1.0 - spread * spread).max(0.0).sqrt();
            cosine = along * spread + aside * sine_of_spread;
            sine = aside * spread - along * sine_of_spread;
        }
        // The cosine as seen from the point of the sphere where the angle is least.
        let sine_of_sphere = radius / distance;
        let cosine_of_sphere = (1.0 - sine_of_sphere * sine_of_sphere).max(0.0).sqrt();
        cosine = if cosine < cosine_of_sphere { cosine * cosine_of_sphere + sine * sine_of_sphere } else { 1.0 };
        let power = if cosine <= reach { 0.0 } else { power * cosine.max(LEAST_COSINE) };
        Seen { power, squared_distance: squared }
    }
}

impl LightCluster {
    /// Most light that the cluster can send to a point within `radius` of `center`.
    pub fn most(&self, center: DVec3, radius: f64) -> f64 {
        let around = Self { radius: self.radius + radius as f32, ..*self };
        let seen = around.seen(center);
        let nearest = (seen.squared_distance.sqrt() - f64::from(around.radius)).max(NEAREST * f64::from(around.radius));
        seen.power / (nearest * nearest)
    }
}

impl LightNode {
    /// How much of a range of random bits is the first cluster's, for a point: in proportion to power times cosine over squared distance.
    pub fn first_part(&self, point: DVec3, range: u32) -> u32 {
        let [first, second] = self.clusters.map(|cluster| cluster.seen(point));
        if second.power == 0.0 && first.power > 0.0 {
            return range;
        }
        if first.power == 0.0 && second.power > 0.0 {
            return 0;
        }
        let [a, b] = [first.power * second.squared_distance, second.power * first.squared_distance];
        let share = if a + b > 0.0 { (a / (a + b)).clamp(LEAST_SHARE, 1.0 - LEAST_SHARE) } else { 0.5 };
        ((u64::from(range) * (share * 4_294_967_296.0) as u64) >> 32) as u32
    }
}

/// Two whole numbers of 16 bits, the first in the lower half.
fn halves([low, high]: [f64; 2]) -> u32 {
    u32::from(low as i16 as u16) | u32::from(high as i16 as u16) << 16
}

fn numbers(halves: u32) -> [f64; 2] {
    [halves as u16, (halves >> 16) as u16].map(|half| f64::from(half as i16) * STEP)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_and_angles_come_back() {
        for (x, y, z) in
            [(1.0, 0.0, 0.0), (0.0, 0.0, -1.0), (-0.3, 0.5, -0.8), (0.7, -0.1, 0.2), (0.0, 1.0, 0.0), (-1.0, -1.0, -1.0)]
        {
            let axis = DVec3::new(x, y, z).normalize();
            let cone = Cone { axis, spread: 0.0, reach: 1.6, two_sided: true };
            let cluster = LightCluster::new(DVec3::ONE, 2.0, 0.5, cone, 7);
            assert!(octahedron::direction_at(numbers(cluster.axis)).distance(axis) < 2e-4, "{axis}");
            let [spread, reach] = numbers(cluster.cosines);
            assert!(spread == 1.0 && reach <= 1.6_f64.cos() && reach > 1.6_f64.cos() - 1e-4);
            assert_eq!(cluster.link, 7 | TWO_SIDED);
        }
    }
}
