//! Which nodes of a binary tree a four-wide one keeps, and which become leaves: those with which a ray costs least, by the area heuristic. Dynamic
//! programming finds them from the leaves up (Ylitie, Karras and Laine 2017, there for eight places).

use obvhs::bvh2::Bvh2;

use crate::binary_tree::depth::top_down;

/// Places for children in a node.
const PLACES: usize = 4;
/// Cost of testing a primitive, where a visit to a node costs 1: about that of packets of rays on software
/// devices.
const PRIMITIVE_COST: f64 = 0.6;

/// The best layout below a node of the binary tree.
#[derive(Debug, Clone, Copy, Default)]
struct Plan {
    /// Least cost of rays below it, where it takes up to 1, 2, 3 or 4 places of the node above.
    costs: [f64; PLACES],
    primitives: u32,
    /// In one place, it is a leaf.
    is_leaf: bool,
}

/// The plans for all nodes of a binary tree.
pub struct Widening<'a> {
    binary: &'a Bvh2,
    plans: Vec<Plan>,
}

impl<'a> Widening<'a> {
    /// Leaves hold up to `most` primitives, and not fewer than the binary tree's own.
    pub fn new(binary: &'a Bvh2, most: u32) -> Self {
        let mut widening = Self { binary, plans: vec![Plan::default(); binary.nodes.len()] };
        for &(node, _) in top_down(&binary.nodes).iter().rev() {
            widening.plans[node] = widening.plan(node, most);
        }
        widening
    }

    fn plan(&self, node: usize, most: u32) -> Plan {
        let area = self.area(node);
        let Some([left, right]) = self.halves(node) else {
            let primitives = self.binary.nodes[node].prim_count;
            return Plan { costs: [area * PRIMITIVE_COST * f64::from(primitives); PLACES], primitives, is_leaf: true };
        };
        let primitives = self.plans[left].primitives + self.plans[right].primitives;
        let as_leaf = area * PRIMITIVE_COST * f64::from(primitives);
        let as_node = area + self.shares(node, PLACES).0;
        let is_leaf = primitives <= most && as_leaf <= as_node;
        let alone = if is_leaf { as_leaf } else { as_node };
        let costs = std::array::from_fn(|more| if more == 0 { alone } else { alone.min(self.shares(node, more + 1).0) });
        Plan { costs, primitives, is_leaf }
    }

    /// How the halves of an inner node share up to so many places, at least 2: the cost, and the places of each.
    fn shares(&self, node: usize, places: usize) -> (f64, [usize; 2]) {
        let first = self.binary.nodes[node].first_index as usize;
        let cost = |[left, right]: [usize; 2]| self.plans[first].costs[left - 1] + self.plans[first + 1].costs[right - 1];
        // A layout with fewer places is among the candidates for more.
        let ways = (1..places).map(|left| [left, places - left]).map(|shares| (cost(shares), shares));
        ways.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((f64::INFINITY, [1, 1]))
    }

    /// The nodes of the binary tree that stand in the places of an inner one.
    pub fn children(&self, node: usize) -> Vec<usize> {
        let mut children = Vec::with_capacity(PLACES);
        self.spread(node, PLACES, &mut children);
        children
    }

    /// Gives the halves of an inner node their places.
    fn spread(&self, node: usize, places: usize, children: &mut Vec<usize>) {
        let first = self.binary.nodes[node].first_index as usize;
        for (half, places) in [first, first + 1].into_iter().zip(self.shares(node, places).1) {
            let alone = self.plans[half].costs[0];
            if places == 1 || self.halves(half).is_none() || alone <= self.shares(half, places).0 {
                children.push(half);
            } else {
                self.spread(half, places, children);
            }
        }
    }

    /// The primitives of a node that is a leaf; None where it is none.
    pub fn leaf(&self, node: usize) -> Option<Vec<usize>> {
        self.plans[node].is_leaf.then(|| {
            let (mut found, mut pending) = (Vec::new(), vec![node]);
            while let Some(node) = pending.pop() {
                let Some([left, right]) = self.halves(node) else {
                    let (first, count) =
                        (self.binary.nodes[node].first_index as usize, self.binary.nodes[node].prim_count as usize);
                    found.extend(self.binary.primitive_indices[first..first + count].iter().map(|&index| index as usize));
                    continue;
                };
                pending.extend([right, left]);
            }
            found
        })
    }

    /// The two nodes below an inner one.
    fn halves(&self, node: usize) -> Option<[usize; 2]> {
        let node = &self.binary.nodes[node];
        let first = node.first_index as usize;
        (!node.is_leaf()).then_some([first, first + 1])
    }

    /// Half of the surface of the node's box: in proportion to how many rays meet it.
    fn area(&self, node: usize) -> f64 {
        let bounds = self.binary.nodes[node].aabb();
        let [x, y, z] = (bounds.max.as_dvec3() - bounds.min.as_dvec3()).to_array();
        x * y + y * z + z * x
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3A;
    use obvhs::BvhBuildParams;
    use obvhs::aabb::Aabb;

    use super::*;
    use crate::binary_tree;

    fn tree(count: u32) -> Bvh2 {
        let fraction = |index: u32, factor: u32| (index.wrapping_mul(factor) % 10_007) as f32 / 100.0;
        let place = |index: u32| Vec3A::new(fraction(index, 7919), fraction(index, 104_729), fraction(index, 1_299_709));
        let boxes: Vec<Aabb> = (0..count).map(|index| Aabb::new(place(index) - 0.4, place(index) + 0.4)).collect();
        binary_tree::build(&boxes, &BvhBuildParams { max_prims_per_leaf: 1, ..BvhBuildParams::medium_build() })
    }

    /// Cost of rays below a node that takes so many places, by trying every layout.
    fn least(widening: &Widening<'_>, node: usize, places: usize, most: u32) -> f64 {
        let area = widening.area(node);
        let primitives = f64::from(widening.plans[node].primitives);
        let as_leaf = if primitives <= f64::from(most) { area * PRIMITIVE_COST * primitives } else { f64::INFINITY };
        let Some([left, right]) = widening.halves(node) else { return as_leaf };
        let shared = |places: usize| {
            let ways = (1..places).map(|share| least(widening, left, share, most) + least(widening, right, places - share, most));
            ways.fold(f64::INFINITY, f64::min)
        };
        let alone = as_leaf.min(area + shared(PLACES));
        (2..=places).map(shared).fold(alone, f64::min)
    }

    /// Cost of rays below a node in its layout, and the number of primitives in its leaves.
    fn laid_out(widening: &Widening<'_>, node: usize) -> (f64, usize) {
        if let Some(leaf) = widening.leaf(node) {
            return (widening.area(node) * PRIMITIVE_COST * leaf.len() as f64, leaf.len());
        }
        let children = widening.children(node);
        assert!((2..=PLACES).contains(&children.len()));
        let below = children.into_iter().map(|child| laid_out(widening, child));
        below.fold((widening.area(node), 0), |sum, child| (sum.0 + child.0, sum.1 + child.1))
    }

    #[test]
    fn no_other_way_costs_less() {
        for (count, most) in [(2, 1), (5, 1), (9, 4), (14, 2), (14, 4)] {
            let binary = tree(count);
            let widening = Widening::new(&binary, most);
            let (cost, primitives) = laid_out(&widening, 0);
            assert_eq!(primitives, count as usize);
            let least = least(&widening, 0, 1, most);
            assert!((cost - least).abs() <= 1e-12 * least, "{count} boxes, {most} a leaf: {cost} instead of {least}");
        }
    }

    /// The control: a way that is not the best, to open the largest child again and again.
    #[test]
    fn opening_the_largest_costs_more() {
        let binary = tree(4000);
        let widening = Widening::new(&binary, 1);
        let mut cost = 0.0;
        let mut pending = vec![0];
        while let Some(node) = pending.pop() {
            cost += widening.area(node) * if widening.halves(node).is_some() { 1.0 } else { PRIMITIVE_COST };
            let mut children = Vec::from_iter(widening.halves(node).into_iter().flatten());
            while (1..PLACES).contains(&children.len()) {
                let openable = (0..children.len()).filter(|&child| widening.halves(children[child]).is_some());
                let Some(largest) = openable.max_by(|&a, &b| widening.area(children[a]).total_cmp(&widening.area(children[b])))
                else {
                    break;
                };
                let opened = children.swap_remove(largest);
                children.extend(widening.halves(opened).into_iter().flatten());
            }
            pending.extend(children);
        }
        let ours = laid_out(&widening, 0).0;
        assert!(ours < cost, "{ours} beside {cost}");
    }
}
