//! The named dimensions of a path.
//!
//! Dimensions come in blocks of four so that the device loads a block at once: blocks 0 and 1 are the camera's, every vertex has two.

/// Uses of the camera's random numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub enum CameraDimension {
    PixelX = 0,
    PixelY = 1,
    LensU = 2,
    LensV = 3,
    /// When, while the shutter is open, the path sees the scene. Alone in its block, which is drawn only where something moves.
    Time = 4,
}

/// Uses of random numbers at a surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub enum VertexDimension {
    LightChoice = 0,
    LightU = 1,
    LightV = 2,
    /// Which lobe of the material: reflection or transmission, a leaf of a blend.
    Lobe = 3,
    BsdfU = 4,
    BsdfV = 5,
    Roulette = 6,
    /// Which material of a blend (`pick`).
    Blend = 7,
}

/// Uses of random numbers along a ray through a medium, before the vertex at its end. No sequence covers them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub enum MediumDimension {
    /// Light is scattered on the way, and how the place is drawn.
    Event = 0,
    /// The distance to the place.
    Distance = 1,
    /// Key of the numbers by which flights through media with grids are tracked.
    Track = 2,
    /// Key of those by which such media are passed, and what they give off is found.
    Pass = 3,
}

/// The first block of these numbers, behind those of all vertices that a path can have.
pub const FIRST_MEDIUM_BLOCK: u32 = 1 << 27;

/// One coordinate of the path's point in primary sample space.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Dimension(pub u32);

/// Dimensions before the first vertex's.
pub const CAMERA_DIMENSIONS: u32 = 8;
/// Dimensions of each vertex.
pub const VERTEX_DIMENSIONS: u32 = 8;
/// Vertices whose dimensions are drawn from the sampler's sequence; beyond them every sampler is the hashed generator. That many
/// dimensions together need more samples than people take before they are evener than random numbers.
pub const SEQUENCE_VERTICES: u32 = 4;
/// Dimensions that a sequence covers, unused ones included.
pub const SEQUENCE_DIMENSIONS: u32 = CAMERA_DIMENSIONS + SEQUENCE_VERTICES * VERTEX_DIMENSIONS;

/// How a dimension is stratified: alone, or with another as the two coordinates of a point in the square.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Strata {
    /// Alone, under the key of this dimension.
    Line(u32),
    /// With its neighbour, under the key of the pair's first dimension; which of the two it is.
    Square { first: u32, axis: usize },
}

impl Dimension {
    pub const fn camera(dimension: CameraDimension) -> Self {
        Self(dimension as u32)
    }

    /// `vertex` counts surfaces from 0, the first one that the camera sees.
    pub const fn vertex(vertex: u32, dimension: VertexDimension) -> Self {
        Self(CAMERA_DIMENSIONS + vertex * VERTEX_DIMENSIONS + dimension as u32)
    }

    /// `vertex` is the number of the vertex at the ray's end.
    pub const fn medium(vertex: u32, dimension: MediumDimension) -> Self {
        Self(4 * (FIRST_MEDIUM_BLOCK + vertex) + dimension as u32)
    }

    /// Says that this is a coordinate of the position inside the pixel.
    pub const fn is_pixel(self) -> bool {
        self.0 <= CameraDimension::PixelY as u32
    }

    /// The vertex to whose light sample this belongs, if it does to one.
    pub const fn light_vertex(self) -> Option<u32> {
        if self.0 < CAMERA_DIMENSIONS || (self.0 - CAMERA_DIMENSIONS) % VERTEX_DIMENSIONS > VertexDimension::LightV as u32 {
            return None;
        }
        Some((self.0 - CAMERA_DIMENSIONS) / VERTEX_DIMENSIONS)
    }

    /// The vertex of a direction that a material samples and which of the two coordinates it is.
    pub const fn of_direction(self) -> Option<(u32, usize)> {
        let Some(beyond) = self.0.checked_sub(CAMERA_DIMENSIONS) else { return None };
        match beyond % VERTEX_DIMENSIONS {
            4 => Some((beyond / VERTEX_DIMENSIONS, 0)),
            5 => Some((beyond / VERTEX_DIMENSIONS, 1)),
            _ => None,
        }
    }

    /// The pairs are the positions in the pixel, on the lens and on a light, and the direction that a material samples.
    pub const fn strata(self) -> Strata {
        let Self(d) = self;
        let first = if d < CAMERA_DIMENSIONS {
            if d < 4 { d & !1 } else { return Strata::Line(d) }
        } else {
            match (d - CAMERA_DIMENSIONS) % VERTEX_DIMENSIONS {
                1 | 4 => d,
                2 | 5 => d - 1,
                _ => return Strata::Line(d),
            }
        };
        Strata::Square { first, axis: (d - first) as usize }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_are_those_of_the_names() {
        let pair = |first: Dimension, second: Dimension| {
            assert_eq!(first.strata(), Strata::Square { first: first.0, axis: 0 });
            assert_eq!(second.strata(), Strata::Square { first: first.0, axis: 1 });
        };
        use CameraDimension::*;
        use VertexDimension::*;
        pair(Dimension::camera(PixelX), Dimension::camera(PixelY));
        pair(Dimension::camera(LensU), Dimension::camera(LensV));
        assert_eq!(Dimension::camera(Time).strata(), Strata::Line(4));
        for vertex in 0..5 {
            pair(Dimension::vertex(vertex, LightU), Dimension::vertex(vertex, LightV));
            pair(Dimension::vertex(vertex, BsdfU), Dimension::vertex(vertex, BsdfV));
            for alone in [LightChoice, Lobe, Roulette, Blend].map(|name| Dimension::vertex(vertex, name)) {
                assert_eq!(alone.strata(), Strata::Line(alone.0));
            }
        }
    }
}
