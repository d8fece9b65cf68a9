//! The picture that is denoised, with its layers.

use crate::output::{Channels, Image, PartSpec, ReadPicture, SAMPLE_COUNT, cut};

/// A picture to be denoised, with what helps to tell its noise from its detail.
pub struct Raw {
    pub picture: Image,
    /// Reflectance and normals at the first surface that is neither mirror nor glass.
    pub albedo: Option<Vec<[f32; 3]>>,
    pub normal: Option<Vec<[f32; 3]>>,
    /// Variance of each pixel's mean, where the file has it.
    pub variances: Option<Vec<[f32; 3]>>,
    /// The place in the whole picture, where it is a part of one: black pixels around it would bleed into it.
    pub placed: Option<PartSpec>,
}

impl Raw {
    /// Takes the picture and its layers, as `gpt render --aov albedo,normal,variance,samples` names them, from a file.
    pub fn of(ReadPicture { image, covered, .. }: ReadPicture, file: &Channels) -> Self {
        let film = [image.width, image.height];
        let [column, row, width, height] = covered;
        let of_part = |pixels: Vec<[f32; 3]>| cut(&pixels, film[0], covered);
        let colours = |names: [&str; 3]| file.colours(names).map(of_part);
        let counts = file.channel(SAMPLE_COUNT).map(|counts| cut(counts, film[0], covered));
        let variances = colours(["Variance.R", "Variance.G", "Variance.B"]).zip(counts).map(|(variances, counts)| {
            let of_mean = |(pixel, count): ([f32; 3], f32)| pixel.map(|variance| variance / count.max(1.0));
            variances.into_iter().zip(counts).map(of_mean).collect()
        });
        let is_whole = covered == [0, 0, film[0], film[1]];
        Self {
            picture: if is_whole { image } else { Image { width, height, pixels: of_part(image.pixels) } },
            albedo: colours(["Albedo.R", "Albedo.G", "Albedo.B"]),
            normal: colours(["N.X", "N.Y", "N.Z"]),
            variances,
            placed: (!is_whole).then_some(PartSpec { film, origin: [column, row] }),
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
