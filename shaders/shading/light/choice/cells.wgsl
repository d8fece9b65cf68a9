// The choice of a light by what reaches the place. src/sampling/light_cells does the same, and says how.
#import core/layout.wgsl
#import shading/cell_grid.wgsl
#import shading/light/choice/by_power.wgsl
#import shading/light/record.wgsl

@group(0) @binding(BINDING_LIGHT_CELLS) var<storage, read> light_cells: array<u32>;

// The first word of the slots of a point's cell; 0 where nothing is known, and the power chooses.
alias LightContext = u32;

fn light_context(point: vec3<f32>, facing: u32) -> LightContext {
    let begins = vec4<u32>(light_cells[0], light_cells[1], light_cells[2], light_cells[3]);
    let counts = vec3<u32>(light_cells[4], light_cells[5], light_cells[6]);
    let word = grid_word(begins, counts, facing, point);
    if word == 0u {
        return 0u;
    }
    let number = light_cells[word];
    return select(light_cells[7] + (number - 1u) * LIGHT_CELL_SLOTS, 0u, number == 0u);
}

// How many slots of a cell name a light.
fn light_slots(cell: u32, light: u32) -> u32 {
    var first = 0u;
    for (var stride = LIGHT_SLOT_STRIDE; stride > 0u; stride >>= 1u) {
        let last = first + stride - 1u;
        if last < LIGHT_CELL_SLOTS && (light_cells[cell + last] & LIGHT_SLOT_MASK) < light {
            first = last + 1u;
        }
    }
    if first == LIGHT_CELL_SLOTS {
        return 0u;
    }
    let slot = light_cells[cell + first];
    return select(0u, slot >> LIGHT_SLOT_COUNT_SHIFT, (slot & LIGHT_SLOT_MASK) == light);
}

// The probability of a light that so many slots of a point's cell name; by power, it has the probability `by_power`.
fn light_pmf_of_slots(slots: u32, by_power: f32) -> f32 {
    return (f32(slots) + f32(LIGHT_UNITS_BY_POWER) * by_power) * LIGHT_UNIT;
}

fn choose_light(cell: LightContext, bits: u32) -> LightChoice {
    if cell == 0u {
        let light = light_by_power(bits);
        return LightChoice(light, pmf_by_power(light));
    }
    let unit = bits >> (32u - LIGHT_UNIT_BITS);
    if unit >= LIGHT_UNITS_BY_POWER {
        let slot = light_cells[cell + unit - LIGHT_UNITS_BY_POWER];
        let light = slot & LIGHT_SLOT_MASK;
        return LightChoice(light, light_pmf_of_slots(slot >> LIGHT_SLOT_COUNT_SHIFT, pmf_by_power(light)));
    }
    let light = light_by_power(bits << (LIGHT_UNIT_BITS - LIGHT_UNITS_BY_POWER_BITS));
    return LightChoice(light, light_pmf_of_slots(light_slots(cell, light), pmf_by_power(light)));
}

fn light_pmf(cell: LightContext, light: u32) -> f32 {
    let by_power = pmf_by_power(light);
    if cell == 0u {
        return by_power;
    }
    return light_pmf_of_slots(light_slots(cell, light), by_power);
}

fn distant_light_pmf(cell: LightContext, light: u32) -> f32 {
    return light_pmf(cell, light);
}
