//! The way rays find what they meet: the one that is asked for, that the device has, and that was verified.

use super::limits::{DeviceLimits, RayQueryDefault};
use super::options::{PlanOptions, TraversalChoice};
use crate::packed::hierarchy::Traversal;
use crate::scene::Scene;

impl DeviceLimits {
    /// The limits with ray queries only where they may be used. What is not enabled is not there.
    pub fn with_ray_queries(self, traversal: TraversalChoice, is_verified: bool) -> Self {
        let ray_query_default = match (traversal, self.ray_queries) {
            (TraversalChoice::Auto, Some(_)) if self.software => RayQueryDefault::No,
            (TraversalChoice::Auto, Some(_)) if is_verified => RayQueryDefault::Verified,
            (TraversalChoice::Auto, Some(_)) => RayQueryDefault::Unverified,
            _ => RayQueryDefault::No,
        };
        let are_used = traversal == TraversalChoice::RayQuery || ray_query_default == RayQueryDefault::Verified;
        Self { ray_queries: self.ray_queries.filter(|_| are_used), ray_query_default, ..self }
    }
}

impl PlanOptions {
    /// The traversal for which a scene is packed on a device with these limits; None: the device is not known
    /// yet, which [`PlanOptions::waits_for_device`] rules out where it matters.
    pub fn packed_traversal(&self, scene: &Scene, limits: Option<&DeviceLimits>) -> Traversal {
        match self.traversal {
            TraversalChoice::RayQuery => Traversal::RayQuery,
            TraversalChoice::Auto if limits.is_some_and(|limits| limits.ray_query_default == RayQueryDefault::Verified) => {
                // Other reasons against ray queries are found once the scene is packed.
                let is_seen = scene.instances.is_empty() && scene.shapes.iter().all(|shape| shape.motion.is_none());
                if is_seen { Traversal::RayQuery } else { Traversal::Bvh }
            }
            TraversalChoice::Auto | TraversalChoice::Bvh => Traversal::Bvh,
        }
    }

    /// The options with which a scene is packed again where this traversal does not fit: ray queries have
    /// limits of their own, and are given up where nobody has asked for them. None where there is nothing to
    /// give up.
    pub fn by_nodes_instead_of(&self, traversal: Traversal) -> Option<Self> {
        let unasked = traversal == Traversal::RayQuery && !self.asks_for_ray_queries();
        unasked.then(|| Self { traversal: TraversalChoice::Bvh, ..self.clone() })
    }

    /// True where a scene packed for this traversal may be planned for a device with these limits.
    pub(super) fn allows(&self, traversal: Traversal, limits: &DeviceLimits) -> bool {
        match self.traversal {
            TraversalChoice::RayQuery => traversal == Traversal::RayQuery,
            TraversalChoice::Bvh => traversal == Traversal::Bvh,
            TraversalChoice::Auto => traversal == Traversal::Bvh || limits.ray_query_default == RayQueryDefault::Verified,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::RayQueryLimits;

    #[test]
    fn ray_queries_are_there_where_they_may_be_used() {
        let ray_queries = Some(RayQueryLimits { max_primitives: 1 << 24 });
        let hardware = DeviceLimits { ray_queries, ..DeviceLimits::default() };
        let software = DeviceLimits { software: true, ..hardware.clone() };
        let none = DeviceLimits::default();
        for (limits, traversal, is_verified, are_there, default) in [
            (&hardware, TraversalChoice::Auto, true, true, RayQueryDefault::Verified),
            (&hardware, TraversalChoice::Auto, false, false, RayQueryDefault::Unverified),
            (&hardware, TraversalChoice::Bvh, true, false, RayQueryDefault::No),
            (&hardware, TraversalChoice::RayQuery, false, true, RayQueryDefault::No),
            (&software, TraversalChoice::Auto, true, false, RayQueryDefault::No),
            (&software, TraversalChoice::RayQuery, false, true, RayQueryDefault::No),
            (&none, TraversalChoice::Auto, true, false, RayQueryDefault::No),
        ] {
            let opened = limits.clone().with_ray_queries(traversal, is_verified);
            let found = (opened.ray_queries.is_some(), opened.ray_query_default);
            assert_eq!(found, (are_there, default), "{traversal:?}, verified {is_verified}, software {}", limits.software);
        }
    }
}
