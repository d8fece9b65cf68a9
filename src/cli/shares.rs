//! Shares as people read them.

/// A share in percent, with four digits that say something.
pub fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    // Digits before the point stay.
    let decimals = (3 - percent.abs().max(1e-9).log10().floor() as i32).clamp(1, 9) as usize;
    let digits = format!("{percent:.decimals$}");
    format!("{} %", digits.trim_end_matches('0').trim_end_matches('.'))
}

/// A probability, of which all digits count.
pub fn whole_percent(share: f64) -> String {
    let digits = format!("{:.8}", 100.0 * share);
    format!("{} %", digits.trim_end_matches('0').trim_end_matches('.'))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_shown_without_needless_digits() {
        assert_eq!([0.01, 0.99, 0.123_456_789, 1.0].map(percent), ["1 %", "99 %", "12.35 %", "100 %"]);
        assert_eq!([0.99, 0.95, 0.999_99].map(whole_percent), ["99 %", "95 %", "99.999 %"]);
    }
}
