//! Which samples of which pixels parts have: none twice, and what is missing.

use std::fmt;
use std::ops::Range;

use super::part::{MergeError, PartHeader};

/// Samples and regions that the parts lack.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Missing {
    /// Absolute indices of samples that no pixel, or not every pixel has, in order.
    pub samples: Vec<Range<u32>>,
    /// Pixels that lack samples.
    pub pixels: u64,
    pub pixels_in_all: u64,
}

impl fmt::Display for Missing {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let range = |range: &Range<u32>| match range.len() {
            1 => format!("{}", range.start),
            _ => format!("{} to {}", range.start, range.end - 1),
        };
        let list: Vec<String> = self.samples.iter().map(range).collect();
        write!(out, "samples {} are missing", list.join(", "))?;
        if self.pixels < self.pixels_in_all {
            write!(out, " of {} of its {} pixels", self.pixels, self.pixels_in_all)?;
        }
        Ok(())
    }
}

/// Refuses samples that come twice.
///
/// # Errors
/// The first two parts that have one sample of one pixel in common.
pub fn check_overlap(parts: &[PartHeader]) -> Result<(), MergeError> {
    // Sorted by their first samples, a part meets those that begin before it ends.
    let mut sorted: Vec<&PartHeader> = parts.iter().collect();
    sorted.sort_by_key(|part| (part.samples.start, part.samples.end, part.region));
    for (index, a) in sorted.iter().enumerate() {
        for b in sorted[index + 1..].iter().take_while(|b| b.samples.start < a.samples.end) {
            if let Some([x, y, ..]) = common(a.region, b.region) {
                let end = a.samples.end.min(b.samples.end);
                let what = format!("samples {} to {} of pixel {x},{y}", b.samples.start, end - 1);
                return Err(MergeError::Overlap { a: a.path.clone(), b: b.path.clone(), what });
            }
        }
    }
    Ok(())
}

/// The intersection of two regions.
fn common(a: [u32; 4], b: [u32; 4]) -> Option<[u32; 4]> {
    let [x, y] = [a[0].max(b[0]), a[1].max(b[1])];
    let [right, bottom] = [(a[0] + a[2]).min(b[0] + b[2]), (a[1] + a[3]).min(b[1] + b[3])];
    (x < right && y < bottom).then(|| [x, y, right - x, bottom - y])
}

/// The missing part of samples `wanted` of all pixels; None where nothing is missing. No two parts overlap.
pub fn missing(parts: &[PartHeader], [width, height]: [u32; 2], wanted: &Range<u32>) -> Option<Missing> {
    // Within a cell between the regions' edges, all pixels have the same samples.
    let edges = |axis: usize, end: u32| {
        let of_part = |part: &PartHeader| [part.region[axis], part.region[axis] + part.region[axis + 2]];
        let mut edges: Vec<u32> = parts.iter().flat_map(of_part).chain([0, end]).collect();
        edges.sort_unstable();
        edges.dedup();
        edges
    };
    let (columns, rows) = (edges(0, width), edges(1, height));
    let (mut samples, mut pixels) = (Vec::new(), 0);
    for row in rows.windows(2) {
        let in_row: Vec<&PartHeader> =
            parts.iter().filter(|part| part.region[1] <= row[0] && row[1] <= part.region[1] + part.region[3]).collect();
        for column in columns.windows(2) {
            let here = in_row.iter().filter(|part| part.region[0] <= column[0] && column[1] <= part.region[0] + part.region[2]);
            let holes = holes(here.map(|part| part.samples.clone()), wanted);
            if !holes.is_empty() {
                pixels += u64::from(column[1] - column[0]) * u64::from(row[1] - row[0]);
                samples.extend(holes);
            }
        }
    }
    let pixels_in_all = u64::from(width) * u64::from(height);
    (pixels > 0).then(|| Missing { samples: union(samples), pixels, pixels_in_all })
}

/// The samples of `wanted` that none of the ranges has.
fn holes(ranges: impl Iterator<Item = Range<u32>>, wanted: &Range<u32>) -> Vec<Range<u32>> {
    let mut holes = Vec::new();
    let mut next = wanted.start;
    for range in union(ranges.collect()) {
        if range.start.min(wanted.end) > next {
            holes.push(next..range.start.min(wanted.end));
        }
        next = next.max(range.end);
    }
    if next < wanted.end {
        holes.push(next..wanted.end);
    }
    holes
}

/// The ranges in order, those that touch joined.
fn union(mut ranges: Vec<Range<u32>>) -> Vec<Range<u32>> {
    ranges.sort_unstable_by_key(|range| (range.start, range.end));
    let mut joined: Vec<Range<u32>> = Vec::new();
    for range in ranges {
        match joined.last_mut() {
            Some(last) if range.start <= last.end => last.end = last.end.max(range.end),
            _ => joined.push(range),
        }
    }
    joined
}

#[cfg(test)]
mod tests {
    use super::*;

    fn part(region: [u32; 4], samples: Range<u32>) -> PartHeader {
        PartHeader::for_tests([10, 8], region, samples)
    }

    const ALL: [u32; 4] = [0, 0, 10, 8];

    #[test]
    fn samples_that_come_twice_are_found() {
        let apart = [part(ALL, 0..4), part([0, 0, 5, 8], 4..9), part([5, 0, 5, 8], 4..9), part(ALL, 9..10)];
        assert!(check_overlap(&apart).is_ok());
        for other in [part(ALL, 3..4), part([4, 7, 1, 1], 8..9), part([9, 0, 1, 1], 0..1), part(ALL, 0..10)] {
            let parts: Vec<PartHeader> = apart.iter().cloned().chain([other]).collect();
            assert!(matches!(check_overlap(&parts), Err(MergeError::Overlap { .. })));
        }
    }

    #[test]
    fn what_is_missing_is_reported() {
        let reported = |parts: &[PartHeader], wanted| missing(parts, [10, 8], &wanted).map(|missing| missing.to_string());
        let whole = [part(ALL, 0..4), part([0, 0, 5, 8], 4..9), part([5, 0, 5, 8], 4..9)];
        assert_eq!(reported(&whole, 0..9), None);
        assert_eq!(reported(&whole, 0..10).as_deref(), Some("samples 9 are missing"));
        assert_eq!(reported(&whole[..2], 0..9).as_deref(), Some("samples 4 to 8 are missing of 40 of its 80 pixels"));
        assert_eq!(
            reported(&[part(ALL, 2..4), part(ALL, 6..7)], 0..9).as_deref(),
            Some("samples 0 to 1, 4 to 5, 7 to 8 are missing")
        );
        assert_eq!(reported(&[], 0..9).as_deref(), Some("samples 0 to 8 are missing"));
    }
}
