//! Area lights that emit by whatever textures give: patterns, products, colours of vertices, and blends. It is looked at in points alone.

use glam::DVec2;

use super::unrolled::Unrolled;
use crate::scene::texture::{mean_of_channel, mean_of_texture};
use crate::scene::{BlendWeight, MaterialId, MaterialKind, Scene};
use crate::texture::{self, Coordinates};

/// Cells along either side of a square, and points in each along either side.
const CELLS: [f64; 2] = [8.0, 256.0];
const POINTS: u32 = 2;
/// Points that all cells of an area light, or all triangles of a scene's area lights, are looked at in, as often as materials are.
const MOST_POINTS: f64 = 1_048_576.0;
/// Rows of pieces in a triangle.
const MOST_ROWS: f64 = 32.0;
/// Materials that a blend is made of, each as often as it is in it. What is made of more is taken to be the same everywhere.
const MOST_PARTS: usize = 32;
/// Added everywhere, as a share of the mean luminance: something may shine between the points.
const FLOOR: f64 = 0.005;

/// The luminance of a material as a function of texture coordinates. Weights that change with the view count as one half.
#[derive(Debug, Clone)]
pub struct Function<'a> {
    scene: &'a Scene,
    material: MaterialId,
    /// The emission that is assumed everywhere.
    floor: f64,
    cells: u32,
    rows: u32,
}

impl<'a> Function<'a> {
    /// The map of a scene whose textured area lights have so many parts. None where the material emits
    /// nothing, or is too complex.
    pub fn of(scene: &'a Scene, material: MaterialId, parts: usize) -> Option<Self> {
        let looked_up = count(scene, material, MOST_PARTS)?;
        let mean = mean_luminance(scene, material);
        let points = MOST_POINTS / looked_up as f64;
        let cells = (points / f64::from(POINTS * POINTS)).sqrt().clamp(CELLS[0], CELLS[1]) as u32;
        let rows = (points / parts.max(1) as f64).sqrt().clamp(1.0, MOST_ROWS) as u32;
        (mean > 0.0 && mean.is_finite()).then_some(Self { scene, material, floor: FLOOR * mean, cells, rows })
    }

    pub fn floor(&self) -> f64 {
        self.floor
    }

    pub fn cells(&self) -> [u32; 2] {
        [self.cells; 2]
    }

    /// In the middles of as many alike triangles: exactly where it is linear.
    pub fn mean_over_triangle(&self, [a, b, c]: &[Coordinates; 3]) -> f64 {
        let rows = self.rows;
        let at = |x: f64, y: f64| {
            let between = |a: DVec2, b: DVec2, c: DVec2| a + (b - a) * (x / f64::from(rows)) + (c - a) * (y / f64::from(rows));
            self.at(Coordinates { first: between(a.first, b.first, c.first), second: between(a.second, b.second, c.second) })
        };
        let (third, two_thirds) = (1.0 / 3.0, 2.0 / 3.0);
        let mut sum = 0.0;
        for (row, column) in (0..rows).flat_map(|row| (0..rows - row).map(move |column| (f64::from(row), f64::from(column)))) {
            sum += at(column + third, row + third);
            if row + column + 1.5 < f64::from(rows) {
                sum += at(column + two_thirds, row + two_thirds);
            }
        }
        sum / f64::from(rows * rows)
    }

    /// Over the cell of the unit square from its lower to its upper corner, in one of so many rows: by points that are even over the area.
    pub fn mean_over_cell(&self, [low, high]: [DVec2; 2], rows: u32, unrolled: Unrolled) -> f64 {
        let middle = |index: u32| (f64::from(index) + 0.5) / f64::from(POINTS);
        let points = (0..POINTS).flat_map(|row| (0..POINTS).map(move |column| DVec2::new(middle(column), middle(row))));
        let at = |point: DVec2| {
            let place = low + point * (high - low);
            unrolled.uv(DVec2::new(place.x, unrolled.area_below(place.y, rows).0))
        };
        points.map(|point| self.at(at(point).into())).sum::<f64>() / f64::from(POINTS * POINTS)
    }

    fn at(&self, uv: Coordinates) -> f64 {
        luminance_at(self.scene, self.material, uv).max(0.0)
    }
}

/// How many materials a blend is made of, each as often as it is in it, itself included; None: more than `most`.
fn count(scene: &Scene, material: MaterialId, most: usize) -> Option<usize> {
    let MaterialKind::Blend { materials, .. } = &scene.materials[material].kind else { return (most > 0).then_some(1) };
    let mut counted = 1;
    for &part in materials {
        counted += count(scene, part, most.checked_sub(counted)?)?;
    }
    (counted <= most).then_some(counted)
}

fn luminance_at(scene: &Scene, material: MaterialId, uv: Coordinates) -> f64 {
    let here = &scene.materials[material];
    let own = here.emission.as_ref().map_or(0.0, |emission| texture::evaluate(scene, &emission.radiance, uv).luminance());
    let MaterialKind::Blend { materials: [first, second], weight } = &here.kind else { return own };
    let weight = weight_at(scene, weight, Some(uv)).unwrap_or(0.5);
    let part = |id: MaterialId, share: f64| if share > 0.0 { share * luminance_at(scene, id, uv) } else { 0.0 };
    own + part(*first, weight) + part(*second, 1.0 - weight)
}

/// Positive where anything of the material can shine: a texture whose mean is at an end of what a weight can be counts as one half.
fn mean_luminance(scene: &Scene, material: MaterialId) -> f64 {
    let here = &scene.materials[material];
    let own = here.emission.as_ref().map_or(0.0, |emission| texture::mean(scene, &emission.radiance).luminance());
    let MaterialKind::Blend { materials: [first, second], weight } = &here.kind else { return own };
    let of_textures = mean_of_weight(scene, weight).filter(|mean| (1e-9..=1.0 - 1e-9).contains(mean));
    let weight = weight_at(scene, weight, None).or(of_textures).unwrap_or(0.5);
    let part = |id: MaterialId, share: f64| if share > 0.0 { share * mean_luminance(scene, id) } else { 0.0 };
    own + part(*first, weight) + part(*second, 1.0 - weight)
}

/// The weight of a blend's first material at texture coordinates, or where it is the same everywhere; else None.
fn weight_at(scene: &Scene, weight: &BlendWeight, uv: Option<Coordinates>) -> Option<f64> {
    match *weight {
        BlendWeight::Constant { value } => Some(value),
        BlendWeight::Facing { .. } | BlendWeight::Fresnel { .. } | BlendWeight::Front | BlendWeight::Camera => None,
        BlendWeight::Up { .. } | BlendWeight::Open { .. } => None,
        BlendWeight::Texture { texture } => Some(texture::look_up(&scene.textures, texture, uv?).luminance().clamp(0.0, 1.0)),
        BlendWeight::Channel { texture, channel, factor } => {
            Some((factor * texture::look_up_channel(&scene.textures, texture, channel, uv?)).clamp(0.0, 1.0))
        }
        BlendWeight::Reverse { ref of } => weight_at(scene, of, uv).map(|weight| 1.0 - weight),
        BlendWeight::Threshold { tau, ref of } => weight_at(scene, of, uv).map(|weight| f64::from(u8::from(weight >= tau))),
    }
}

/// The mean of what a weight looks up, where it is that or one minus it.
fn mean_of_weight(scene: &Scene, weight: &BlendWeight) -> Option<f64> {
    match *weight {
        BlendWeight::Texture { texture } => Some(mean_of_texture(&scene.textures, texture).luminance()),
        BlendWeight::Channel { texture, channel, factor } => Some(factor * mean_of_channel(&scene.textures, texture, channel)),
        BlendWeight::Reverse { ref of } => mean_of_weight(scene, of).map(|mean| 1.0 - mean),
        _ => None,
    }
}
