//! Emission maps of textured area lights: how bright each part of a light is, and the warp by which points of
//! whole shapes are drawn.

mod function;
mod image;
mod level;
mod unrolled;

use std::cell::OnceCell;
use std::sync::Arc;

use glam::DVec2;

use crate::sampling::HierarchicalWarp;
use crate::scene::{MaterialId, MaterialKind, Scene};
use crate::texture::Coordinates;
use function::Function;
use image::EmissionImage;
pub use unrolled::Unrolled;

/// The mean of the squared luminance over the squared mean from which on points are drawn by luminance. Shapes that emit more evenly are
/// drawn by solid angle, which counts for more where they are near.
const LEAST_CONTRAST: f64 = 1.5;

/// The emission maps of a scene, by material.
#[derive(Debug, Clone, Default)]
pub struct EmissionMaps<'a> {
    maps: Vec<Option<EmissionMap<'a>>>,
}

#[derive(Debug, Clone)]
struct EmissionMap<'a> {
    shown: EmissionSource<'a>,
    evenly: OnceCell<Whole>,
    sphere: OnceCell<Whole>,
}

#[derive(Debug, Clone)]
enum EmissionSource<'a> {
    Image(EmissionImage),
    Function(Function<'a>),
}

/// The map of a whole shape.
#[derive(Debug, Clone)]
struct Whole {
    /// Its mean; None: more than is looked at.
    luminance: Option<f64>,
    /// The warp by which points are drawn; None means evenly.
    warp: Option<Arc<HierarchicalWarp>>,
}

/// A piece of an area light's surface.
#[derive(Debug, Clone, Copy)]
pub enum EmitterPart {
    /// A triangle, with the texture coordinates at its corners.
    Triangle([Coordinates; 3]),
    Whole(Unrolled),
}

impl<'a> EmissionMaps<'a> {
    /// The maps of all materials that emit by textures, or in shares that textures give.
    pub fn new(scene: &'a Scene) -> Self {
        let emits = scene.materials_that(|material| material.emission.is_some());
        let varies = scene.materials_that(|material| {
            let weight_varies = matches!(&material.kind, MaterialKind::Blend { weight, .. } if weight.uses_texture());
            weight_varies || material.emission.is_some_and(|emission| emission.radiance.is_texture())
        });
        let shows = |id: MaterialId| emits[id] && varies[id];
        if !(0..emits.len()).any(shows) {
            return Self::default();
        }
        let emitters = scene.shapes.iter().filter(|shape| shape.materials().any(shows));
        let parts: usize = emitters.map(|shape| shape.geometry.faces().max(1)).sum();
        let of = |id: MaterialId| {
            let picture = EmissionImage::of(scene, &scene.materials[id], parts).map(EmissionSource::Image);
            let shown = picture.or_else(|| Function::of(scene, id, parts).map(EmissionSource::Function))?;
            Some(EmissionMap { shown, evenly: OnceCell::new(), sphere: OnceCell::new() })
        };
        Self { maps: (0..emits.len()).map(|id| if shows(id) { of(id) } else { None }).collect() }
    }

    /// The mean luminance that a material sends out from a part of an area light, positive where anything of it shines. None: that of the whole material
    /// is all that is known.
    pub fn luminance(&self, material: MaterialId, part: &EmitterPart) -> Option<f64> {
        let map = self.map(material)?;
        match part {
            EmitterPart::Triangle(corners) => map.shown.mean_over_triangle(corners),
            EmitterPart::Whole(unrolled) => map.whole(*unrolled).luminance,
        }
    }

    /// The density over the unit square by which points of such shapes of this material are drawn. None: evenly.
    pub fn warp(&self, material: MaterialId, unrolled: Unrolled) -> Option<&Arc<HierarchicalWarp>> {
        self.map(material)?.whole(unrolled).warp.as_ref()
    }

    fn map(&self, material: MaterialId) -> Option<&EmissionMap<'a>> {
        self.maps.get(material)?.as_ref()
    }
}

impl EmissionMap<'_> {
    fn whole(&self, unrolled: Unrolled) -> &Whole {
        let cell = match unrolled {
            Unrolled::Evenly => &self.evenly,
            Unrolled::Sphere => &self.sphere,
        };
        cell.get_or_init(|| Whole::of(&self.shown, unrolled))
    }
}

impl EmissionSource<'_> {
    fn mean_over_triangle(&self, corners: &[Coordinates; 3]) -> Option<f64> {
        match self {
            Self::Image(picture) => picture.mean_over_triangle(corners),
            Self::Function(function) => Some(function.floor() + function.mean_over_triangle(corners)),
        }
    }

    /// The mean over the cell of the unit square from its lower to its upper corner, in one of so many rows.
    fn mean_over_cell(&self, [low, high]: [DVec2; 2], rows: u32, unrolled: Unrolled) -> Option<f64> {
        match self {
            Self::Image(picture) => picture.mean_over(&[low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)]),
            Self::Function(function) => Some(function.mean_over_cell([low, high], rows, unrolled)),
        }
    }

    fn cells(&self) -> [u32; 2] {
        match self {
            Self::Image(picture) => picture.cells(),
            Self::Function(function) => function.cells(),
        }
    }

    /// The share of a part's luminance that is assumed everywhere. A cell of a picture has no weight where
    /// nothing of it shines: an even share would be noise that even sequences do not have.
    fn floor(&self) -> f64 {
        match self {
            Self::Image(_) => 0.0,
            Self::Function(function) => function.floor(),
        }
    }
}

impl Whole {
    fn of(shown: &EmissionSource, unrolled: Unrolled) -> Self {
        let [columns, rows] = shown.cells();
        let size = DVec2::new(columns.into(), rows.into());
        let of_cell = |(row, column): (u32, u32)| {
            let low = DVec2::new(column.into(), row.into());
            let (_, area) = unrolled.area_below((low.y + 0.5) / size.y, rows);
            Some((shown.mean_over_cell([low / size, (low + 1.0) / size], rows, unrolled)?, area))
        };
        let all = (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column)));
        let Some(cells) = all.map(of_cell).collect::<Option<Vec<(f64, f64)>>>() else {
            return Self { luminance: None, warp: None };
        };
        let count = size.x * size.y;
        let mean = cells.iter().map(|(luminance, area)| luminance * area).sum::<f64>() / count;
        let squares = cells.iter().map(|(luminance, area)| luminance * luminance * area).sum::<f64>() / count;
        let luminance = Some(mean + shown.floor());
        if mean.is_nan() || mean <= 0.0 || squares < LEAST_CONTRAST * mean * mean {
            return Self { luminance, warp: None };
        }
        let weights: Vec<f64> = cells.iter().map(|(luminance, area)| (luminance + shown.floor()) * area).collect();
        Self { luminance, warp: HierarchicalWarp::new(columns, rows, &weights).map(Arc::new) }
    }
}

#[cfg(test)]
mod tests;
