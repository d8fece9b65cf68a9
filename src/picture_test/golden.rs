//! Golden pictures: what a scene rendered to, how its samples varied, and how many there were.

use std::path::Path;
use std::sync::Arc;

use super::error::PictureTestError;
use super::replications::Replications;
use crate::film::Band;
use crate::output::{
    Channels, ExrOptions, Image, LayerChannel, LayerPicture, LayerSource, OutputError, PictureFile, PictureFormat, PictureSpec,
    Provenance, ReadError, SAMPLE_COUNT, read_undamaged_picture,
};

/// Channels of the variance of a sample.
const VARIANCE: [&str; 3] = ["Variance.R", "Variance.G", "Variance.B"];
/// Key in the header: of how many renders with random numbers of their own the picture is the mean.
const REPLICATIONS_KEY: &str = "gpt:replications";
/// Key in the header: ꟻLIP that the noise of a single one of these renders makes.
const FLIP_KEY: &str = "gpt:flipOfNoise";

/// A picture that others are compared with.
#[derive(Debug, Clone)]
pub struct Golden {
    pub mean: Image,
    /// Variance of a sample, pixel by pixel: that of the pixel's mean times its number of samples.
    pub variances: Vec<[f32; 3]>,
    /// Samples per pixel; of pixels that differ, the fewest.
    pub samples: u32,
    /// Renders with random numbers of their own whose mean it is, and whose scatter the variances are. None of a picture that was made at
    /// once, whose variances are those of single samples.
    pub replications: Option<u32>,
    /// ꟻLIP of a single replication against the mean of all.
    pub flip_of_noise: Option<f64>,
    /// Digest of the scene that it shows; None where the file does not say.
    pub scene_hash: Option<String>,
    /// Properties that its header states and nothing uses, with the file's name.
    pub warnings: Vec<String>,
}

impl Golden {
    /// The mean of renders, and what they scatter by.
    pub fn of(renders: &Replications, flip_of_noise: f64, scene_hash: String) -> Self {
        Self {
            mean: renders.mean(),
            variances: renders.variances_of_a_sample(),
            samples: renders.count() * renders.samples,
            replications: Some(renders.count()),
            flip_of_noise: Some(flip_of_noise),
            scene_hash: Some(scene_hash),
            warnings: Vec::new(),
        }
    }

    /// Samples per pixel of each of the renders whose mean it is.
    pub fn samples_of_one(&self) -> Option<u32> {
        Some(self.samples / self.replications?.max(1))
    }

    /// Degrees of freedom of a pixel's variance.
    pub fn degrees_of_freedom(&self) -> f64 {
        f64::from(self.replications.unwrap_or(self.samples).max(2) - 1)
    }

    /// Variances of pixels' differences from a render of so many samples.
    pub fn variances_against(&self, samples: u32) -> Vec<[f32; 3]> {
        let factor = 1.0 / f64::from(samples) + 1.0 / f64::from(self.samples);
        self.scaled(factor)
    }

    /// Variances of its own pixels.
    pub fn own_variances(&self) -> Vec<[f32; 3]> {
        self.scaled(1.0 / f64::from(self.samples))
    }

    fn scaled(&self, factor: f64) -> Vec<[f32; 3]> {
        self.variances.iter().map(|pixel| pixel.map(|variance| (f64::from(variance) * factor) as f32)).collect()
    }

    /// Reads what [`Golden::write`] wrote, or a picture of `gpt render --aov variance,samples`.
    ///
    /// # Errors
    /// A file that cannot be read, or lacks what a test needs.
    pub fn read(path: &Path) -> Result<Self, PictureTestError> {
        let file = Channels::read(path)?;
        let lacking = |what: &str| {
            let help = "`gpt test --bless` makes one that has it, and so does `gpt render --aov variance,samples`";
            PictureTestError::Unsuitable(format!("{}: a golden picture has {what}; {help}", path.display()))
        };
        if file.colours(["R", "G", "B"]).is_none() {
            return Err(lacking("the channels R, G and B"));
        }
        let picture = read_undamaged_picture(path)?;
        if picture.covered != [0, 0, file.width, file.height] {
            return Err(lacking("every pixel of its picture, and not a part of them"));
        }
        let variances = file.colours(VARIANCE).ok_or_else(|| lacking("the channels Variance.R, Variance.G and Variance.B"))?;
        let counts = file.channel(SAMPLE_COUNT).ok_or_else(|| lacking("the channel SampleCount"))?;
        for name in ["R", "G", "B", SAMPLE_COUNT].into_iter().chain(VARIANCE) {
            let mut numbers = file.channel(name).unwrap_or_default().iter();
            if let Some(place) = numbers.position(|number| !number.is_finite()) {
                let [column, row] = [place as u32 % file.width, place as u32 / file.width];
                let what = format!("finite numbers, and its channel {name} holds another at {column}, {row}");
                return Err(lacking(&what));
            }
        }
        let fewest = counts.iter().copied().fold(f32::INFINITY, f32::min);
        if fewest < 2.0 {
            return Err(lacking("two samples of each pixel at least"));
        }
        let number = |key: &str| file.attribute(key).and_then(|text| text.parse::<u32>().ok()).filter(|number| *number >= 2);
        Ok(Self {
            warnings: picture.warnings(path),
            mean: picture.image,
            variances,
            samples: fewest as u32,
            replications: number(REPLICATIONS_KEY),
            flip_of_noise: file.attribute(FLIP_KEY).and_then(|text| text.parse().ok()),
            scene_hash: file.attribute("gpt:sceneHash").map(str::to_owned),
        })
    }

    /// Writes the picture as an EXR file.
    ///
    /// # Errors
    /// Errors of the file system.
    pub fn write(&self, path: &Path, provenance: Provenance) -> Result<(), PictureTestError> {
        let failure = |source| OutputError::Write { path: path.to_owned(), source };
        let Image { width, height, ref pixels } = self.mean;
        let variances = LayerPicture::new([width, height]).map_err(failure)?;
        variances.write_rows(0, &self.variances).map_err(failure)?;
        let variances = Arc::new(variances);
        let layers = VARIANCE.iter().enumerate().map(|(place, name)| {
            let source = LayerSource::Component(variances.clone(), place);
            LayerChannel::new(*name, source)
        });
        let count = LayerChannel::new(SAMPLE_COUNT, LayerSource::Count);
        let replications = self.replications.map(|count| (REPLICATIONS_KEY.to_owned(), count.to_string()));
        let flip = self.flip_of_noise.map(|flip| (FLIP_KEY.to_owned(), format!("{flip:.5}")));
        let mut provenance = provenance;
        provenance.settings.spp = self.samples;
        let spec = PictureSpec {
            width,
            height,
            exr: ExrOptions::default(),
            layers: layers.chain([count]).collect(),
            notes: replications.into_iter().chain(flip).collect(),
            provenance: Some(provenance),
            ..PictureSpec::default()
        };
        let mut file = PictureFile::create(path, PictureFormat::Exr, &spec)?;
        let band = Band { width, rows: height, samples: self.samples, mean: pixels.clone(), ..Band::default() };
        file.write_band(&Arc::new(band)).map_err(failure)?;
        Ok(file.finish()?)
    }
}

/// A picture of another program, with what it says of its noise.
#[derive(Debug, Clone)]
pub struct Candidate {
    pub mean: Image,
    /// Variance of each pixel's mean, where the file says it.
    pub variances: Option<Vec<[f32; 3]>>,
    pub samples: Option<u32>,
    /// Properties that its header states and nothing uses, with the file's name.
    pub warnings: Vec<String>,
}

impl Candidate {
    /// Reads a picture of any format. Of an EXR file with variances of samples and their numbers, these count too.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub fn read(path: &Path) -> Result<Self, ReadError> {
        let picture = read_undamaged_picture(path)?;
        let (warnings, mean) = (picture.warnings(path), picture.image);
        let noise = Channels::read(path).ok().and_then(|file| {
            let counts = file.channel(SAMPLE_COUNT)?;
            let of_mean = |variance: f32, count: f32| variance / count.max(1.0);
            let pixels = file.colours(VARIANCE)?.into_iter().zip(counts);
            let variances: Vec<[f32; 3]> = pixels.map(|(pixel, count)| pixel.map(|variance| of_mean(variance, *count))).collect();
            let fewest = counts.iter().copied().fold(f32::INFINITY, f32::min);
            (variances.len() == mean.pixels.len() && fewest >= 2.0).then_some((variances, fewest as u32))
        });
        let (variances, samples) = noise.unzip();
        Ok(Self { mean, variances, samples, warnings })
    }
}
