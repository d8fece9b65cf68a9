//! How a render is cut into parts.

use std::ops::Range;

/// Samples in so many runs whose lengths differ by one at most.
pub fn chunks(samples: u32, count: u32) -> impl Iterator<Item = Range<u32>> {
    let end = move |index: u32| (u64::from(samples) * u64::from(index) / u64::from(count)) as u32;
    (0..count).map(move |index| end(index)..end(index + 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chunks_cover_all_samples_once() {
        for (samples, count) in [(1, 1), (7, 3), (1000, 7), (u32::MAX / 2, 1000)] {
            let ranges: Vec<_> = chunks(samples, count).collect();
            assert_eq!((ranges[0].start, ranges[ranges.len() - 1].end), (0, samples));
            assert!(ranges.windows(2).all(|pair| pair[0].end == pair[1].start));
            let lengths = ranges.iter().map(ExactSizeIterator::len);
            assert!(lengths.clone().max() <= lengths.min().map(|least| least + 1));
        }
    }
}
