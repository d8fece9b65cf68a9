//! Primitives, which all shapes are made of.

use std::sync::Arc;

use super::triangle::Triangle;
use crate::reference::intersect::element::Element;
use crate::reference::intersect::hierarchy::PreparedRay;
use crate::reference::intersect::ray::Local;

/// An element. The many triangles of meshes stand in place, so that they do not pay for the few others.
#[derive(Debug, Clone)]
pub enum Primitive {
    Triangle(Triangle),
    Other(Arc<dyn Element>),
}

impl Primitive {
    pub fn of(element: impl Element + 'static) -> Self {
        Self::Other(Arc::new(element))
    }

    pub fn element(&self) -> &dyn Element {
        match self {
            Self::Triangle(triangle) => triangle,
            Self::Other(element) => &**element,
        }
    }

    /// Distance and local coordinates of the closest crossing in (0, limit).
    #[inline]
    pub fn intersect(&self, ray: &PreparedRay, limit: f64) -> Option<(f64, Local)> {
        match self {
            Self::Triangle(triangle) => triangle.intersect(ray, limit),
            Self::Other(element) => element.intersect(ray, limit),
        }
    }

    pub fn area(&self) -> f64 {
        self.element().area()
    }
}
