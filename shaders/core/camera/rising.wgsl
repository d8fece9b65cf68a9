// The inverse of functions that rise, by Newton's method between two places that enclose the one that is looked for.
// crates/gpt-scene/src/scene/camera/rising.rs is the same in f64.

struct Search {
    low: f32,
    high: f32,
    at: f32,
    // The last step changed no digit that counts.
    found: bool,
}

fn search_up_to(high: f32, first: f32) -> Search {
    return Search(0.0, high, min(first, high), false);
}

// A step, by how far the function's value at the place is above the one that is looked for, and its slope there. The enclosing places are halved
// where Newton's step leads out of them.
fn search_step(search: Search, above: f32, slope: f32) -> Search {
    let low = select(search.at, search.low, above > 0.0);
    let high = select(search.high, search.at, above > 0.0);
    var next = 0.5 * (low + high);
    if slope > 0.0 {
        let newton = search.at - above / slope;
        next = select(next, newton, newton >= low && newton <= high);
    }
    return Search(low, high, next, abs(next - search.at) <= 1.2e-7 * next);
}
