//! How much a run of the tests takes upon itself.

use std::io::Write as _;

/// True where `GPT_TEST=all` asks for the long form of a test that has a short one too (`scripts/test --full`). Otherwise a line names the
/// difference. Tests that are long as a whole are `#[ignore]`d.
pub fn in_full(left_out: &str) -> bool {
    let full = std::env::var("GPT_TEST").as_deref() == Ok("all");
    if !full {
        announce(&format!("left out without --full: {left_out}"));
    }
    full
}

/// Writes a line past the test harness, which shows no output of tests that pass.
pub fn announce(line: &str) {
    // One call, so that lines of tests side by side stay whole. Nothing is lost where nobody reads it.
    let _ = std::io::stderr().write_all(format!("{line}\n").as_bytes());
}
