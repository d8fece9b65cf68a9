//! The place of a part's pixels in its display window.

use exr::meta::header::Header;

/// The data window, seen from the first pixel of the display window.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Windows {
    /// Width and height of the display window.
    display: [i64; 2],
    /// Its first column and row.
    origin: [i64; 2],
    /// Width and height of the data window.
    data: [i64; 2],
}

impl Windows {
    pub fn of(header: &Header) -> Self {
        let window = header.shared_attributes.display_window;
        let start = header.own_attributes.layer_position;
        let side = |side: usize| i64::try_from(side).unwrap_or(i64::MAX);
        let from = |start: i32, window: i32| i64::from(start) - i64::from(window);
        Self {
            display: [side(window.size.width()), side(window.size.height())],
            origin: [from(start.x(), window.position.x()), from(start.y(), window.position.y())],
            data: [side(header.layer_size.width()), side(header.layer_size.height())],
        }
    }

    /// Width and height of the display window.
    pub fn size(&self) -> [u32; 2] {
        self.display.map(|side| u32::try_from(side).unwrap_or(u32::MAX))
    }

    /// Width and height of the data window.
    pub fn data_size(&self) -> [u32; 2] {
        self.data.map(|side| u32::try_from(side).unwrap_or(u32::MAX))
    }

    /// The columns and rows of the data window that the display window shows, as [first, end) of either.
    pub fn shown(&self) -> [[usize; 2]; 2] {
        [0, 1].map(|axis| {
            let first = (-self.origin[axis]).clamp(0, self.data[axis]);
            let end = (self.display[axis] - self.origin[axis]).clamp(first, self.data[axis]);
            [first as usize, end as usize]
        })
    }

    /// The part of the display window that has pixels: first column and row, width and height.
    pub fn covered(&self) -> [u32; 4] {
        let shown = self.shown();
        let sides = shown.map(|[first, end]| (end - first) as u32);
        let start = [0, 1].map(|axis| u32::try_from(shown[axis][0] as i64 + self.origin[axis]).unwrap_or(0));
        [start[0], start[1], sides[0], sides[1]]
    }

    /// True where the display window shows any pixel of so many columns and rows of the data window, from these on.
    pub fn show(&self, [column, row]: [usize; 2], [width, height]: [usize; 2]) -> bool {
        let [columns, rows] = self.shown();
        column < columns[1] && column + width > columns[0] && row < rows[1] && row + height > rows[0]
    }

    /// The pixels of a run in a row of the data window that are shown, and the place of the first one in the display window.
    pub fn place<'p, T>(&self, [column, row]: [usize; 2], pixels: &'p [T]) -> Option<([usize; 2], &'p [T])> {
        let [columns, rows] = self.shown();
        let (first, end) = (column.max(columns[0]), (column + pixels.len()).min(columns[1]));
        let is_shown = first < end && (rows[0]..rows[1]).contains(&row);
        let at = |place: usize, axis: usize| (place as i64 + self.origin[axis]) as usize;
        is_shown.then(|| ([at(first, 0), at(row, 1)], &pixels[first - column..end - column]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_cut_to_the_display_window() {
        let windows = Windows { display: [4, 3], origin: [-1, 2], data: [6, 5] };
        assert_eq!((windows.shown(), windows.covered()), ([[1, 5], [0, 1]], [0, 2, 4, 1]));
        let pixels = [10, 11, 12, 13, 14, 15];
        assert_eq!(windows.place([0, 0], &pixels), Some(([0, 2], &pixels[1..5])));
        assert_eq!(windows.place([4, 0], &pixels[4..]), Some(([3, 2], &pixels[4..5])));
        assert_eq!((windows.place([0, 1], &pixels), windows.place([5, 0], &pixels[5..])), (None, None));
        assert!(windows.show([4, 0], [2, 2]) && !windows.show([5, 0], [1, 5]) && !windows.show([0, 1], [6, 4]));
        let apart = Windows { display: [4, 3], origin: [9, 0], data: [6, 5] };
        assert_eq!(apart.covered()[2..], [0, 3]);
        assert_eq!(apart.place([0, 0], &pixels), None);
    }
}
