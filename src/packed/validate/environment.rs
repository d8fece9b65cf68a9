//! The environment's map among the texels.

use super::Check;
use crate::packed::environment::PackedMap;
use crate::packed::scene::PackedScene;

/// Most texels or cells along a side: kernels compute with them in signed numbers.
const LONGEST_SIDE: u32 = 1 << 30;
/// Points along a side of the square that directions are drawn from.
const SIDE: u32 = 1 << 31;

/// Points of one axis: from the first number to before the second.
type Interval = [u32; 2];

impl PackedScene {
    pub(super) fn check_environment(&self) -> Check {
        self.environment.map.map_or(Ok(()), |map| self.check_map(&map).map_err(|message| format!("the map {message}")))
    }

    fn check_map(&self, map: &PackedMap) -> Check {
        let &PackedMap { first_texel, width, height, rows: _, first_node, first_density, grid_width, grid_height, levels } = map;
        if [width, height, grid_width, grid_height].into_iter().any(|side| !(1..=LONGEST_SIDE).contains(&side)) {
            return Err(format!("has {width} × {height} texels and {grid_width} × {grid_height} cells"));
        }
        if levels != grid_width.max(grid_height).next_power_of_two().trailing_zeros() {
            return Err(format!("has {levels} levels above {grid_width} × {grid_height} cells"));
        }
        let beginning = self.textures.first_word() as u64;
        let length = self.textures.texel_words() as u64;
        let area = |[columns, rows]: [u32; 2]| u64::from(columns) * u64::from(rows);
        let nodes: u64 = (1..=levels).map(|level| area(level_size(map, level))).sum();
        for (name, first, count) in [
            ("texels", first_texel, 3 * area([width, height])),
            ("nodes", first_node, 3 * nodes),
            ("cells", first_density, area([grid_width, grid_height])),
        ] {
            if u64::from(first) < beginning || u64::from(first) + count > length {
                return Err(format!("has {name} from {first} to {}", u64::from(first) + count));
            }
        }
        self.check_quadtree(map)
    }

    /// No point of the square leads to a child beyond the grid's border: where a node has no second column or row, its split is at the
    /// end of its rectangle.
    fn check_quadtree(&self, map: &PackedMap) -> Check {
        let mut first = map.first_node as usize - self.textures.first_word();
        let mut rectangles: Vec<[Interval; 2]> = vec![[[0, SIDE]; 2]];
        for level in (1..=map.levels).rev() {
            let [columns, rows] = level_size(map, level).map(|side| side as usize);
            let finer = level_size(map, level - 1).map(|side| side as usize);
            let mut children = vec![[[0; 2]; 2]; finer[0] * finer[1]];
            for row in 0..rows {
                for column in 0..columns {
                    let number = row * columns + column;
                    let [u, v] = rectangles[number];
                    let words = &self.textures.words[first + 3 * number..][..3];
                    let [split, left, right] = [0, 1, 2].map(|word| words[word]);
                    let has_right = 2 * column + 1 < finer[0];
                    let has_lower = 2 * row + 1 < finer[1];
                    let possible =
                        divides(split, u, has_right) && divides(left, v, has_lower) && divides(right, v, has_right && has_lower);
                    if !possible {
                        return Err(format!("has a node at ({column}, {row}) of level {level} that leads out of its grid"));
                    }
                    for (to_right, part_u) in [(0, [u[0], split]), (1, [split, u[1]])] {
                        let middle = if to_right == 0 { left } else { right };
                        for (below, part_v) in [(0, [v[0], middle]), (1, [middle, v[1]])] {
                            let place = [2 * column + to_right, 2 * row + below];
                            if place[0] < finer[0] && place[1] < finer[1] {
                                children[place[1] * finer[0] + place[0]] = [part_u, part_v];
                            }
                        }
                    }
                }
            }
            first += 3 * columns * rows;
            rectangles = children;
        }
        Ok(())
    }
}

/// Columns and rows of nodes, `level` levels above the cells.
fn level_size(map: &PackedMap, level: u32) -> [u32; 2] {
    [map.grid_width, map.grid_height].map(|cells| cells.div_ceil(1 << level))
}

/// True where a split lies in the interval; at its end where nothing is behind it.
fn divides(split: u32, [low, high]: Interval, has_second: bool) -> bool {
    if has_second { (low..=high).contains(&split) } else { split == high }
}
