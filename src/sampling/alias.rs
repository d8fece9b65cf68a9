//! Constant-time choice among weighted things (Walker 1974, built as by Vose 1991).

/// An alias table over n entries. The choice is made in integers, so every device makes the same one.
#[derive(Debug, Clone, PartialEq)]
pub struct AliasTable {
    /// Chosen instead of entry i when the remainder is at or above `threshold[i]`.
    pub alias: Vec<u32>,
    /// 32-bit fraction below which entry i itself is chosen; `u32::MAX` means always.
    pub threshold: Vec<u32>,
    /// Probability mass of each entry; sums to 1.
    pub pmf: Vec<f64>,
}

impl AliasTable {
    /// Weights are finite and not negative; where all are zero, every entry is as likely as the others. An empty slice gives an
    /// empty table, from which nothing may be drawn.
    pub fn new(weights: &[f64]) -> Self {
        let n = weights.len();
        let total: f64 = weights.iter().sum();
        let pmf: Vec<f64> =
            if total > 0.0 { weights.iter().map(|w| w / total).collect() } else { vec![1.0 / n.max(1) as f64; n] };
        let mut scaled: Vec<f64> = pmf.iter().map(|p| p * n as f64).collect();
        let (mut small, mut large): (Vec<usize>, Vec<usize>) = (0..n).partition(|&i| scaled[i] < 1.0);
        let mut table = Self { alias: (0..n as u32).collect(), threshold: vec![u32::MAX; n], pmf };
        while let (Some(&poor), Some(&rich)) = (small.last(), large.last()) {
            small.pop();
            table.alias[poor] = rich as u32;
            table.threshold[poor] = (scaled[poor] * 4_294_967_296.0) as u32;
            scaled[rich] -= 1.0 - scaled[poor];
            if scaled[rich] < 1.0 {
                large.pop();
                small.push(rich);
            }
        }
        // An entry that is left over differs from 1 by rounding alone, and is its own alias. An entry of no
        // weight cannot be left here
        // unless all are, because some entry then has at least the mean.
        table
    }

    /// The entry that 32 uniform bits choose.
    pub fn choose(&self, bits: u32) -> usize {
        let product = u64::from(bits) * self.alias.len() as u64;
        let (entry, remainder) = ((product >> 32) as usize, product as u32);
        if remainder < self.threshold[entry] { entry } else { self.alias[entry] as usize }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frequencies_follow_the_weights() {
        let weights = [0.0, 1.0, 5.0, 0.25, 0.0, 3.75];
        let table = AliasTable::new(&weights);
        let mut counts = [0_u32; 6];
        let draws = 1 << 20;
        // Evenly spread bits: the frequencies are those of the table up to one draw per interval border.
        for i in 0..draws {
            counts[table.choose(i << 12 | 0x7ff)] += 1;
        }
        for (count, weight) in counts.into_iter().zip(weights) {
            assert!((f64::from(count) / f64::from(draws) - weight / 10.0).abs() < 2e-5, "{counts:?}");
        }
    }

    #[test]
    fn no_weight_at_all_means_uniform() {
        assert_eq!(AliasTable::new(&[0.0, 0.0]).pmf, [0.5, 0.5]);
    }
}
