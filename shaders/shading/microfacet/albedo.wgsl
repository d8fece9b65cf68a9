// Tables of the albedo of microfacets and fibres by the angle of the light; crates/gpt-scene/src/scene/material/albedo.rs
// makes them.
#import core/layout.wgsl
#import geometry/scene.wgsl

// An entry of the table whose first word is `table`. Three stand in a word.
fn albedo_node(table: u32, row: u32, column: u32) -> f32 {
    let node = row * ALBEDO_COLUMNS + column;
    let word = tables[table + node / 3u];
    let place = node % 3u;
    return select(select(word.x, word.y, place == 1u), word.z, place == 2u);
}

// The albedo, linear between the entries. These stand at even steps of roughness, and of a place that changes
// most about the cosine `knee`, and as the cosine's root near a right angle.
fn tabulated_albedo(table: u32, cosine: f32, roughness: f32, knee: f32) -> f32 {
    let place = sqrt(clamp(cosine * (1.0 + knee) / max(cosine + knee, 1.0e-6), 0.0, 1.0)) * f32(ALBEDO_COLUMNS - 1u);
    let height = clamp(roughness, 0.0, 1.0) * f32(ALBEDO_ROWS - 1u);
    let column = min(u32(place), ALBEDO_COLUMNS - 2u);
    let row = min(u32(height), ALBEDO_ROWS - 2u);
    let right = place - f32(column);
    let above = mix(albedo_node(table, row, column), albedo_node(table, row, column + 1u), right);
    let below = mix(albedo_node(table, row + 1u, column), albedo_node(table, row + 1u, column + 1u), right);
    return mix(above, below, height - f32(row));
}
