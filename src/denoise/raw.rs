//! What is denoised.

use crate::output::{Channels, Image};

/// A picture to be denoised, with what helps to tell its noise from its detail.
pub struct Raw {
    pub picture: Image,
    /// Reflectance and normals at the first surface that is neither mirror nor glass.
    pub albedo: Option<Vec<[f32; 3]>>,
    pub normal: Option<Vec<[f32; 3]>>,
    /// Variance of each pixel's mean, where the file has it.
    pub variances: Option<Vec<[f32; 3]>>,
}

impl Raw {
    /// Takes the picture and its layers, as `gpt render --aov albedo,normal,variance,samples` names them, from a file.
    pub fn of(picture: Image, file: &Channels) -> Self {
        let counts = file.channel("SampleCount");
        let variances = file.colours(["Variance.R", "Variance.G", "Variance.B"]).zip(counts).map(|(variances, counts)| {
            let of_mean = |(pixel, count): ([f32; 3], &f32)| pixel.map(|variance| variance / count.max(1.0));
            variances.into_iter().zip(counts).map(of_mean).collect()
        });
        Self {
            picture,
            albedo: file.colours(["Albedo.R", "Albedo.G", "Albedo.B"]),
            normal: file.colours(["N.X", "N.Y", "N.Z"]),
            variances,
        }
    }

    /// The layers that it has, in words.
    pub fn layers(&self) -> &'static str {
        match (&self.albedo, &self.normal) {
            (Some(_), Some(_)) => "albedo and normals, denoised first",
            (Some(_), None) => "albedo, denoised first",
            // Normals help only beside an albedo.
            (None, _) => "none",
        }
    }
}
