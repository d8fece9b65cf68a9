//! The changes that comparisons make to the cosine-power lobes of `glossy` and `phong`.

use crate::scene::{PhongCosine, PhongHorizon, PhongSampling, RenderSettings};

/// The settings by which such lobes are compared with others of the literature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PhongStudy {
    pub cosine: PhongCosine,
    pub sampling: PhongSampling,
    pub horizon: PhongHorizon,
}

impl From<&RenderSettings> for PhongStudy {
    fn from(settings: &RenderSettings) -> Self {
        Self { cosine: settings.phong_cosine, sampling: settings.phong_sampling, horizon: settings.phong_horizon }
    }
}

/// Lobes as they are where nothing is compared.
impl Default for PhongStudy {
    fn default() -> Self {
        Self { cosine: PhongCosine::Kept, sampling: PhongSampling::Lobe, horizon: PhongHorizon::Lost }
    }
}
