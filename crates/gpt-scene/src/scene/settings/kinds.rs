//! The settings that are chosen by name.

use crate::choice::{Choice, Named, choices};

choices! {
    /// The source of random numbers.
    pub enum SamplerKind {
        /// Every number on its own.
        Independent = "independent",
        /// One sample in each of as many strata as there are samples per pixel.
        Stratified = "stratified",
        /// Recursive quadrants: strata that get finer as samples come.
        Quadrant = "quadrant",
        /// Scrambled Halton sequence.
        Halton = "halton",
        /// Owen-scrambled Sobol' sequence.
        Sobol = "sobol",
        /// Study: strata for directions alone, in one random order for all surfaces of a path, entered one further at each.
        SharedStrata = "shared_strata",
        /// Study: scrambled Hammersley set of as many points as there are samples per pixel.
        Hammersley = "hammersley",
        /// Study: linear congruential generator, from a start of its own for each path.
        Congruential = "lcg",
    }

    /// How light sampling and BSDF sampling are used.
    pub enum Estimator {
        /// Next event estimation and BSDF sampling combined by multiple importance sampling.
        Mis = "mis",
        /// Next event estimation alone; emitters met by a BSDF sample count only where light sampling cannot produce them.
        Nee = "nee",
        /// BSDF sampling alone.
        Bsdf = "bsdf",
        /// Study: at each place one of the two, chosen at random and weighed as by `mis`; a path that chooses next event estimation ends with it.
        Choose = "choose",
    }

    /// How multiple importance sampling weighs the two strategies (Veach 1997, section 9.2).
    pub enum MisHeuristic {
        /// Power heuristic: in proportion to the densities to the power of `heuristic_exponent`.
        Power = "power",
        /// Balance heuristic: in proportion to the densities.
        Balance = "balance",
        /// Maximum heuristic: the larger density takes all.
        Maximum = "maximum",
        /// Cutoff heuristic: in proportion to the densities, but nothing for one that is less than `heuristic_cutoff` of the other.
        Cutoff = "cutoff",
    }

    /// How the place is drawn where a medium scatters light.
    pub enum DistanceSampling {
        /// By distance and by angle, combined by multiple importance sampling.
        Mis = "mis",
        /// In proportion to the light that is lost along the ray.
        Distance = "distance",
        /// In proportion to the light that arrives along the ray from one point of a light; by distance where there is no such point.
        Equiangular = "equiangular",
    }

    /// How directions over a diffuse surface are drawn.
    pub enum HemisphereSampling {
        /// In proportion to the cosine with the normal.
        Cosine = "cosine",
        /// One density in every direction.
        Uniform = "uniform",
    }

    /// The cosine of the rendering equation in the cosine-power lobes of `glossy` and `phong` (Honsdorf 2013, section 5.3).
    pub enum PhongCosine {
        /// The lobe's value times the cosine with the normal.
        Kept = "kept",
        /// The lobe's value alone: rims are brighter, and more light may leave than arrives.
        Dropped = "dropped",
    }

    /// How directions of the cosine-power lobes of `glossy` and `phong` are drawn.
    pub enum PhongSampling {
        /// In proportion to the lobe.
        Lobe = "lobe",
        /// Without regard to the lobe, as over a diffuse surface: by `hemisphere`.
        Hemisphere = "hemisphere",
    }

    /// The fate of directions that the cosine-power lobes of `glossy` and `phong` have below the surface.
    pub enum PhongHorizon {
        /// They are lost, and with them their light.
        Lost = "lost",
        /// They are turned to their opposite, which is above (Honsdorf 2013, appendix A, listing 7).
        Flipped = "flipped",
    }

    /// How a point on a sphere, a rectangle or a triangle that is a light is drawn.
    pub enum LightSampling {
        /// `cone` for spheres; for rectangles and triangles `cone` or `area`, whichever a trial run of some thousand paths finds better.
        Auto = "auto",
        /// Uniform in the cone of directions that meet the sphere, and in those that meet a rectangle or a triangle which is seen under a large angle.
        Cone = "cone",
        /// Uniform over the half of a sphere that faces the point, and over rectangles and triangles.
        Visible = "visible",
        /// Uniform over the whole surface.
        Area = "area",
    }

    /// How next event estimation chooses among lights.
    pub enum LightChoice {
        /// Many lights: by cells if lists of lights hold most of the light, else by a tree. Few lights: by power or by cells, whichever a trial run of some thousand paths finds better.
        Auto = "auto",
        /// In constant time, by power wherever the light goes, and evenly over groups in three of ten choices.
        Power = "power",
        /// By a tree: near lights that face the point more often than others.
        Tree = "tree",
        /// By what was found to reach the place before the first sample, the environment included and hidden lights left out, and by power in one of eight choices.
        Cells = "cells",
    }

    /// When paths are guided to where light was found to come from.
    pub enum Guiding {
        /// Never.
        Off = "off",
        /// On surfaces that scatter diffusely.
        On = "on",
        /// The way of "on" if a trial run finds, after it has learned, that this has clearly less error × cost; else never.
        Auto = "auto",
    }

    /// The presence of light sources in the picture.
    pub enum Emitters {
        /// They are seen like anything else.
        Seen = "seen",
        /// The camera looks through surfaces that give light, and sees nothing where it would see the surroundings. Mirrors, glass and shadows show both.
        Hidden = "hidden",
    }

    /// How a path continues at a blend of materials.
    pub enum BlendMode {
        /// Every lobe of a blend is evaluated, one is sampled.
        Mixture = "mixture",
        /// One material is chosen per hit, as in the thesis.
        Pick = "pick",
    }
}

/// Which sampler draws the position inside the pixel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PixelSampler {
    /// The path's own sampler.
    SameAsPath,
    /// A sampler of its own.
    Other(SamplerKind),
    /// Always the pixel's centre: aliased, for comparison.
    Centre,
}

/// Every sampler's name, `none` and `same`.
impl Choice for PixelSampler {
    const VALUES: &'static [Self] = &{
        let mut values = [Self::SameAsPath; PIXEL_SAMPLERS];
        let mut index = 0;
        while index < SamplerKind::ALL.len() {
            values[index] = Self::Other(SamplerKind::ALL[index]);
            index += 1;
        }
        values[index] = Self::Centre;
        values
    };

    const WORDS: &'static [&'static str] = &{
        let mut words = [""; PIXEL_SAMPLERS];
        let mut index = 0;
        while index < words.len() {
            words[index] = Self::NAMES[index].name;
            index += 1;
        }
        words
    };

    const NAMES: &'static [Named] = &{
        let mut names = [Named { name: "same", doc: "The sampler of the path's other numbers." }; PIXEL_SAMPLERS];
        let mut index = 0;
        while index < SamplerKind::ALL.len() {
            names[index] = SamplerKind::NAMES[index];
            index += 1;
        }
        names[index] = Named { name: "none", doc: "Always the pixel's centre: aliased, for comparison." };
        names
    };

    fn name(self) -> &'static str {
        match self {
            Self::SameAsPath => "same",
            Self::Other(kind) => kind.name(),
            Self::Centre => "none",
        }
    }
}

/// The samplers, `none` and `same`.
const PIXEL_SAMPLERS: usize = SamplerKind::ALL.len() + 2;
