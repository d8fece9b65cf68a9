// Faults that are planted to see whether checks notice them (src/plan/fault.rs). Where none is, these functions change nothing.

// Factor on the values of one material: 1 % too much.
fn planted_factor(material: u32) -> f32 {
    if HAS_PLANT_BRDF {
        return select(1.0, 1.01, material == PLANTED_MATERIAL);
    } else {
        return 1.0;
    }
}

// The ratio of densities that a sample's weight is made of: as if there were no other strategy, every sample counts in full.
fn planted_ratio(ratio: f32) -> f32 {
    if HAS_PLANT_MIS {
        return 0.0;
    } else {
        return ratio;
    }
}

// True of the light that contributes nothing when it is sampled.
fn is_forgotten(light: u32) -> bool {
    if HAS_PLANT_LIGHT {
        return light == PLANTED_LIGHT;
    } else {
        return false;
    }
}
