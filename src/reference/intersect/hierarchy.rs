//! A bounding volume hierarchy, built over boxes rounded outward to f32 and traversed in f64.

use glam::{DVec3, Vec3, Vec3A};
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;

use super::ray::Ray;
use crate::binary_tree;
use crate::reference::work;

/// A ray with what intersection tests need of it over and over.
#[derive(Debug, Clone, Copy)]
pub struct PreparedRay {
    pub ray: Ray,
    inverse_direction: DVec3,
    /// Axes in an order that makes the direction's largest component the last one and keeps the handedness.
    axes: [usize; 3],
    /// Shear that takes the direction to the last axis.
    shear: [f64; 2],
}

impl PreparedRay {
    pub fn new(ray: Ray) -> Self {
        let d = ray.direction;
        let last = d.abs().max_position();
        let (mut first, mut second) = ((last + 1) % 3, (last + 2) % 3);
        if d[last] < 0.0 {
            std::mem::swap(&mut first, &mut second);
        }
        // A component of zero becomes a huge finite number, so that 0 times it is 0 and not NaN: an origin on a box's face is inside.
        let inverse_direction = d.map(|component| (1.0 / component).clamp(-1e300, 1e300));
        Self { ray, inverse_direction, axes: [first, second, last], shear: [d[first] / d[last], d[second] / d[last]] }
    }

    /// A point in the coordinates in which the ray starts at the origin and runs along the last axis.
    #[inline]
    pub fn shear(&self, point: DVec3) -> DVec3 {
        let p = point - self.ray.origin;
        let [first, second, last] = self.axes;
        DVec3::new(p[first] - self.shear[0] * p[last], p[second] - self.shear[1] * p[last], p[last])
    }

    /// The distance at which the ray enters the box, if it meets it in [0, limit]. Errs on the side of a hit: a rounding bound for the three
    /// operations of each slab (Ize 2013) widens the exit.
    #[inline]
    fn enter(&self, node: &Node, limit: f64) -> Option<f64> {
        let low = (node.min.as_dvec3() - self.ray.origin) * self.inverse_direction;
        let high = (node.max.as_dvec3() - self.ray.origin) * self.inverse_direction;
        let (near, far) = (low.min(high), low.max(high));
        let enter = near.max_element().max(0.0);
        let exit = far.min_element() * (1.0 + 8.0 * f64::EPSILON);
        (enter <= exit && enter <= limit).then_some(enter)
    }
}

/// A box and either two neighbouring children or a run of primitives.
#[derive(Debug, Clone, Copy)]
struct Node {
    min: Vec3,
    /// First child, or first primitive.
    first: u32,
    max: Vec3,
    /// Number of primitives; 0: an inner node.
    count: u32,
}

/// The tree. Primitives are numbered in leaf order, see [`Hierarchy::build`].
#[derive(Debug, Clone)]
pub struct Hierarchy {
    nodes: Vec<Node>,
}

impl Hierarchy {
    /// Builds the tree over finite boxes `[min, max]`, and says which box stands at each place of the leaf order.
    pub fn build(boxes: &[[DVec3; 2]]) -> (Self, Vec<u32>) {
        if boxes.is_empty() {
            return (Self { nodes: Vec::new() }, Vec::new());
        }
        let rounded: Vec<Aabb> = boxes
            .iter()
            .map(|[min, max]| {
                Aabb::new(Vec3A::from(min.as_vec3().map(f32::next_down)), Vec3A::from(max.as_vec3().map(f32::next_up)))
            })
            .collect();
        let tree = binary_tree::build(&rounded, &BvhBuildParams::medium_build());
        let nodes = tree
            .nodes
            .iter()
            .map(|node| Node {
                min: node.aabb().min.into(),
                first: node.first_index,
                max: node.aabb().max.into(),
                count: node.prim_count,
            })
            .collect();
        (Self { nodes }, tree.primitive_indices)
    }

    /// Calls `visit` for every primitive, by its place in leaf order, whose box the ray may meet in [0, limit], nearer boxes first.
    /// `visit` gives back the limit from there on; a negative one ends the search.
    pub fn traverse(&self, ray: &PreparedRay, mut limit: f64, mut visit: impl FnMut(usize, f64) -> f64) {
        let Some(root) = self.nodes.first().filter(|root| ray.enter(root, limit).is_some()) else {
            work::add(1);
            return;
        };
        let mut tests = 1;
        let mut waiting = Stack::default();
        let mut node = root;
        loop {
            if node.count > 0 {
                tests += u64::from(node.count);
                for place in node.first..node.first + node.count {
                    limit = visit(place as usize, limit);
                }
            } else {
                tests += 2;
                if let Some(near) = self.descend(node, ray, limit, &mut waiting) {
                    node = near;
                    continue;
                }
            }
            node = loop {
                match waiting.pop() {
                    None => {
                        work::add(tests);
                        return;
                    }
                    Some((next, entry)) if f64::from(entry) <= limit => break &self.nodes[next as usize],
                    Some(_) => {}
                }
            };
        }
    }

    /// The child the ray enters first; the other one, if it is entered too, has to wait.
    #[inline]
    fn descend(&self, node: &Node, ray: &PreparedRay, limit: f64, waiting: &mut Stack) -> Option<&Node> {
        let (left, right) = (&self.nodes[node.first as usize], &self.nodes[node.first as usize + 1]);
        match (ray.enter(left, limit), ray.enter(right, limit)) {
            (Some(to_left), Some(to_right)) if to_left <= to_right => {
                waiting.push(node.first + 1, to_right);
                Some(left)
            }
            (Some(to_left), Some(_)) => {
                waiting.push(node.first, to_left);
                Some(right)
            }
            (Some(_), None) => Some(left),
            (None, Some(_)) => Some(right),
            (None, None) => None,
        }
    }
}

/// Nodes to visit later and where the ray enters them, rounded down. Trees deeper than any seen in practice go on the heap.
#[derive(Default)]
struct Stack {
    fixed: [(u32, f32); 32],
    length: usize,
    overflow: Vec<(u32, f32)>,
}

impl Stack {
    #[inline]
    fn push(&mut self, node: u32, entry: f64) {
        let item = (node, (entry as f32).next_down());
        match self.fixed.get_mut(self.length) {
            Some(slot) => {
                *slot = item;
                self.length += 1;
            }
            None => self.overflow.push(item),
        }
    }

    #[inline]
    fn pop(&mut self) -> Option<(u32, f32)> {
        if let Some(item) = self.overflow.pop() {
            return Some(item);
        }
        self.length = self.length.checked_sub(1)?;
        Some(self.fixed[self.length])
    }
}
