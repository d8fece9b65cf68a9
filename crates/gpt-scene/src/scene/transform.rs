//! Affine transforms as written: a list of steps, applied in order.

use glam::{DAffine3, DMat3, DVec3};

/// Steps applied in this order. Empty: identity.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Transform {
    pub steps: Vec<TransformStep>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TransformStep {
    Scale(DVec3),
    Rotate { axis: DVec3, degrees: f64 },
    Translate(DVec3),
    Matrix(DAffine3),
}

impl TransformStep {
    pub fn to_affine(self) -> DAffine3 {
        match self {
            Self::Scale(factors) => DAffine3::from_scale(factors),
            Self::Rotate { axis, degrees } => DAffine3::from_axis_angle(axis.normalize(), degrees.to_radians()),
            Self::Translate(offset) => DAffine3::from_translation(offset),
            Self::Matrix(matrix) => matrix,
        }
    }
}

impl Transform {
    /// All steps as one map from the shape's own space to the world.
    pub fn to_affine(&self) -> DAffine3 {
        self.steps.iter().fold(DAffine3::IDENTITY, |so_far, step| step.to_affine() * so_far)
    }

    /// The one factor by which lengths grow, if the transform is a rotation, reflection, uniform scale and translation; None
    /// where it shears or scales unevenly (relative tolerance 1e-9).
    pub fn uniform_scale(&self) -> Option<f64> {
        let m: DMat3 = self.to_affine().matrix3;
        let gram = m.transpose() * m;
        let squared = gram.x_axis.x;
        let uneven = gram - DMat3::from_diagonal(DVec3::splat(squared));
        let largest = uneven.to_cols_array().into_iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        (squared > 0.0 && largest <= 1e-9 * squared).then(|| squared.sqrt())
    }
}
