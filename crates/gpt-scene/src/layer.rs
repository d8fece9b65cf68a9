//! Layers that a render can give beside the picture.

use crate::choice::{Choice, choices};

choices! {
    /// A layer, as people ask for it: one channel or more of an EXR file.
    pub enum Layer {
        /// Share of light that the surface reflects, seen in mirrors and through glass; 0 where nothing is met: Albedo.R, .G, .B.
        Albedo = "albedo",
        /// Shading normal in the world, towards the viewer, seen in mirrors and through glass: N.X, .Y, .Z.
        Normal = "normal",
        /// The place of the first surface in the world: P.X, .Y, .Z.
        Position = "position",
        /// Texture coordinates of the first surface, the first set of a mesh that has two, before any texture scales or turns them: UV.U, .V.
        Uv = "uv",
        /// The place of the first surface in its object's own space: before the transform of the shape, or of the instance, and before its motion, at the
        /// time of the ray: ObjectPosition.X, .Y, .Z.
        ObjectPosition = "object_position",
        /// How far the point of the first surface goes across the picture from the shutter's opening to its closing, by its own motion and the camera's, in
        /// pixels: Motion.X to the right, Motion.Y upward; 0 where nothing is met. The point is the one that the ray meets at its own time.
        Motion = "motion",
        /// Distance of the first surface along the viewing direction: Z. Of a camera that sees around, from the camera's position.
        Depth = "depth",
        /// Share of the pixel in which a surface is met, by which R, G and B are multiplied already: A.
        Alpha = "alpha",
        /// Variance of a sample of R, G and B; the pixel's is smaller by the number of samples: Variance.R, .G, .B.
        Variance = "variance",
        /// Samples of the pixel: SampleCount.
        Samples = "samples",
        /// The low end of the interval of R, G and B: Low.R, .G, .B. All pixels' intervals together hold the truth at the confidence of
        /// --confidence, however often one looks.
        Low = "low",
        /// The high end: High.R, .G, .B.
        High = "high",
        /// Light that the first surface sends on: Direct.R, .G, .B.
        Direct = "direct",
        /// Light of more edges: Indirect.R, .G, .B.
        Indirect = "indirect",
        /// Light that emitters and surroundings send to the camera: Emission.R, .G, .B. Direct, indirect
        /// and emission add up to the picture.
        Emission = "emission",
        /// Light of each group that emitters of the scene name (`light_group`), and of the rest: key.R, .G, .B for the group "key". They add up to the
        /// picture, and `gpt regroup` weighs them anew.
        Groups = "groups",
        /// Number of the shape and of the material at the pixel's centre, from 1; 0 where nothing is met: ObjectId, MaterialId.
        Ids = "ids",
        /// Objects and materials with the share of the pixel that each covers, for compositing programs, after the Cryptomatte specification:
        /// CryptoObject00 to 02, CryptoMaterial00 to 02.
        Cryptomatte = "cryptomatte",
    }

    /// A quantity that kernels sum in place of radiance.
    pub enum KernelLayer {
        /// Reflectance of surfaces.
        Albedo = "albedo",
        /// Shading normals.
        Normal = "normal",
        /// Points of surfaces.
        Position = "position",
        /// Texture coordinates of surfaces.
        Uv = "uv",
        /// Points of surfaces in the space of their object.
        ObjectPosition = "object_position",
        /// Ways across the picture while the shutter is open.
        Motion = "motion",
        /// Distances along the viewing direction, or from the camera's position.
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

/// A layer that is a render of its own.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum RenderedLayer {
    /// By kernels that make it in place of radiance.
    Kernel(KernelLayer),
    /// By the kernels of the picture, in the light of the group of this name alone.
    LightGroup(String),
}

/// Channels of a part of a picture in which a rendered layer stands, so that parts can be joined.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PartChannels {
    /// Means, and what rounding to them lost; one to three of each.
    pub values: Vec<String>,
    pub remainders: Vec<String>,
    /// How many samples the means are over.
    pub count: String,
}

impl PartChannels {
    fn new(layer: &str, values: &[String]) -> Self {
        let remainders = values.iter().map(|value| format!("Remainder.{value}")).collect();
        Self { values: values.to_vec(), remainders, count: format!("SampleCount.{layer}") }
    }
}

impl RenderedLayer {
    /// Its name among states of renders.
    pub fn name(&self) -> String {
        match self {
            Self::Kernel(kernel) => kernel.name().to_owned(),
            Self::LightGroup(group) => format!("{}-{group}", Layer::Groups.name()),
        }
    }

    /// The layer of kernels that it is, if it is one.
    pub fn kernel(&self) -> Option<KernelLayer> {
        match self {
            Self::Kernel(kernel) => Some(*kernel),
            Self::LightGroup(_) => None,
        }
    }

    /// Its channels in parts.
    pub fn part_channels(&self) -> PartChannels {
        match self {
            Self::Kernel(kernel) => kernel.part_channels(),
            Self::LightGroup(group) => PartChannels::new(group, &group_channels(group)),
        }
    }
}

/// The channels of the light of a group.
pub fn group_channels(group: &str) -> [String; 3] {
    ["R", "G", "B"].map(|colour| format!("{group}.{colour}"))
}

impl Layer {
    /// The layer that kernels render for it. None where it needs nothing beside the picture, or no samples.
    pub fn kernel(self) -> Option<KernelLayer> {
        match self {
            Self::Albedo => Some(KernelLayer::Albedo),
            Self::Normal => Some(KernelLayer::Normal),
            Self::Position => Some(KernelLayer::Position),
            Self::Uv => Some(KernelLayer::Uv),
            Self::ObjectPosition => Some(KernelLayer::ObjectPosition),
            Self::Motion => Some(KernelLayer::Motion),
            Self::Depth | Self::Alpha => Some(KernelLayer::Depth),
            Self::Variance => Some(KernelLayer::Squares),
            Self::Direct => Some(KernelLayer::Direct),
            Self::Indirect => Some(KernelLayer::Indirect),
            Self::Emission => Some(KernelLayer::Emission),
            Self::Samples | Self::Low | Self::High | Self::Groups | Self::Ids | Self::Cryptomatte => None,
        }
    }

    /// Layers as headers of files have them: each once, in the order of their table.
    pub fn list(layers: &[Self]) -> String {
        let names: Vec<&str> = Self::ALL.into_iter().filter(|layer| layers.contains(layer)).map(Choice::name).collect();
        names.join(",")
    }

    /// The layers of such a list; None where it names something else.
    pub fn from_list(list: &str) -> Option<Vec<Self>> {
        list.split(',').filter(|name| !name.is_empty()).map(Self::from_name).collect()
    }
}

impl KernelLayer {
    /// Its channels in parts.
    pub fn part_channels(self) -> PartChannels {
        let (layer, components): (&str, &[&str]) = match self {
            Self::Albedo => ("Albedo", &["R", "G", "B"]),
            Self::Normal => ("N", &["X", "Y", "Z"]),
            Self::Position => ("P", &["X", "Y", "Z"]),
            Self::Uv => ("UV", &["U", "V"]),
            Self::ObjectPosition => ("ObjectPosition", &["X", "Y", "Z"]),
            Self::Motion => ("Motion", &["X", "Y"]),
            Self::Depth => ("Z", &[]),
            Self::Squares => ("Square", &["R", "G", "B"]),
            Self::Direct => ("Direct", &["R", "G", "B"]),
            Self::Indirect => ("Indirect", &["R", "G", "B"]),
            Self::Emission => ("Emission", &["R", "G", "B"]),
        };
        let alone = components.is_empty().then(|| layer.to_owned());
        let values: Vec<String> = components.iter().map(|component| format!("{layer}.{component}")).chain(alone).collect();
        PartChannels::new(layer, &values)
    }

    /// True for layers of the surfaces that paths meet, not of light. Their means are over the samples that
    /// met something.
    pub fn is_of_surfaces(self) -> bool {
        matches!(self, Self::Albedo | Self::Normal) || self.is_of_first_surface()
    }

    /// True for layers of the first surface, not of what is seen in it.
    pub fn is_of_first_surface(self) -> bool {
        matches!(self, Self::Position | Self::Uv | Self::ObjectPosition | Self::Motion | Self::Depth)
    }

    /// True if light that reaches the camera over so many edges belongs to it.
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
            Self::Uv => &["LAYER_OF_FIRST_SURFACE", "LAYER_OF_SURFACES", "LAYER_UV"],
            Self::ObjectPosition => &["LAYER_OBJECT_POSITION", "LAYER_OF_FIRST_SURFACE", "LAYER_OF_SURFACES"],
            Self::Motion => &["LAYER_MOTION", "LAYER_OF_FIRST_SURFACE", "LAYER_OF_SURFACES"],
            Self::Depth => &["LAYER_DEPTH", "LAYER_OF_FIRST_SURFACE", "LAYER_OF_SURFACES"],
            Self::Squares => &["LAYER_SQUARES"],
            Self::Direct => &["LAYER_DIRECT"],
            Self::Indirect => &["LAYER_INDIRECT"],
            Self::Emission => &["LAYER_EMISSION"],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_of_layers_come_back() {
        let layers = [Layer::Depth, Layer::Albedo, Layer::Depth];
        assert_eq!(Layer::list(&layers), "albedo,depth");
        assert_eq!(Layer::from_list("albedo,depth"), Some(vec![Layer::Albedo, Layer::Depth]));
        assert_eq!(Layer::from_list(""), Some(Vec::new()));
        assert_eq!(Layer::from_list("albedo,gloss"), None);
    }
}
