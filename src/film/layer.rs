//! What a render can give beside the picture.

use crate::choice::choices;

choices! {
    /// A layer, as people ask for it: one channel or more of an EXR file.
    pub enum Layer {
        /// Share of light that the surface reflects, seen in mirrors and through glass; 0 where nothing is met: Albedo.R, .G, .B.
        Albedo = "albedo",
        /// Shading normal in the world, towards the viewer, seen in mirrors and through glass: N.X, .Y, .Z.
        Normal = "normal",
        /// Where the first surface is, in the world: P.X, .Y, .Z.
        Position = "position",
        /// Distance of the first surface along the viewing direction: Z.
        Depth = "depth",
        /// Share of the pixel in which a surface is met, by which R, G and B are multiplied already: A.
        Alpha = "alpha",
        /// Variance of a sample of R, G and B; the pixel's is smaller by the number of samples: Variance.R, .G, .B.
        Variance = "variance",
        /// Samples of the pixel: SampleCount.
        Samples = "samples",
        /// Light that the first surface sends on: Direct.R, .G, .B.
        Direct = "direct",
        /// Light of more edges: Indirect.R, .G, .B.
        Indirect = "indirect",
        /// What lights and surroundings send to the camera: Emission.R, .G, .B. Direct, indirect and emission add up to the picture.
        Emission = "emission",
        /// Number of the shape and of the material at the pixel's centre, from 1; 0 where nothing is met: ObjectId, MaterialId.
        Ids = "ids",
        /// Objects and materials with the share of the pixel that each covers, for compositing programs, after the Cryptomatte specification:
        /// CryptoObject00 to 02, CryptoMaterial00 to 02.
        Cryptomatte = "cryptomatte",
    }

    /// What kernels make in place of radiance.
    pub enum KernelLayer {
        /// Reflectance of surfaces.
        Albedo = "albedo",
        /// Shading normals.
        Normal = "normal",
        /// Points of surfaces.
        Position = "position",
        /// Distances along the viewing direction.
        Depth = "depth",
        /// Squares of radiance.
        Squares = "squares",
        /// Light of two edges.
        Direct = "direct",
        /// Light of more than two edges.
        Indirect = "indirect",
        /// Light of one edge.
        Emission = "emission",
    }
}

impl KernelLayer {
    /// Of what paths meet, not of the light that they find. Its means are over the samples that met something.
    pub fn is_of_surfaces(self) -> bool {
        matches!(self, Self::Albedo | Self::Normal | Self::Position | Self::Depth)
    }

    /// Of the first surface, not of what is seen in it.
    pub fn is_of_first_surface(self) -> bool {
        matches!(self, Self::Position | Self::Depth)
    }

    /// Whether light that reaches the camera over so many edges belongs to it.
    pub fn holds_light(self, edges: u32) -> bool {
        match self {
            Self::Emission => edges == 1,
            Self::Direct => edges == 2,
            Self::Indirect => edges > 2,
            _ => true,
        }
    }

    /// The switches of its kernels.
    pub fn switches(self) -> &'static [&'static str] {
        match self {
            Self::Albedo => &["LAYER_ALBEDO", "LAYER_OF_SURFACES"],
            Self::Normal => &["LAYER_NORMAL", "LAYER_OF_SURFACES"],
            Self::Position => &["LAYER_OF_FIRST_SURFACE", "LAYER_OF_SURFACES", "LAYER_POSITION"],
            Self::Depth => &["LAYER_DEPTH", "LAYER_OF_FIRST_SURFACE", "LAYER_OF_SURFACES"],
            Self::Squares => &["LAYER_SQUARES"],
            Self::Direct => &["LAYER_DIRECT", "LAYER_OF_LIGHT"],
            Self::Indirect => &["LAYER_INDIRECT", "LAYER_OF_LIGHT"],
            Self::Emission => &["LAYER_EMISSION", "LAYER_OF_LIGHT"],
        }
    }
}
