use super::*;

const MASKINGS: [Masking; 2] = [Masking::Separable, Masking::HeightCorrelated];

/// 1 − ln 2 at normal incidence where the width is 1 and heights are correlated.
#[test]
fn facets_reflect_what_is_known_in_closed_form() {
    let table = AlbedoTable::of_facets(Masking::HeightCorrelated);
    assert!((table.at(1.0, 1.0) - (1.0 - std::f64::consts::LN_2)).abs() < 1e-4, "{}", table.at(1.0, 1.0));
    // Smooth microfacets reflect everything.
    assert!((table.at(0.5, 0.0) - 1.0).abs() < 1e-6);
}

/// Values between the entries are as they would be if they were computed there, from 0.06° above the surface
/// on.
#[test]
fn tables_are_dense_enough() {
    type Share = fn(f64, f64) -> f64;
    let separable: Share = |cosine, roughness| facet_albedo(cosine, roughness, Masking::Separable);
    let height_correlated: Share = |cosine, roughness| facet_albedo(cosine, roughness, Masking::HeightCorrelated);
    for (table, share, most, most_grazing) in [
        (AlbedoTable::of_facets(Masking::Separable), separable, 1.2e-3, 1.2e-3),
        (AlbedoTable::of_facets(Masking::HeightCorrelated), height_correlated, 1.2e-3, 2e-3),
        // Fibres shine suddenly within a degree of the horizon.
        (AlbedoTable::of_sheen(), sheen_albedo, 4e-3, 1.2e-2),
    ] {
        let [mut worst, mut worst_grazing] = [0.0_f64; 2];
        for (index, roughness) in midpoints(24).enumerate() {
            let roughness = if (table.layout.knee)(0.0) > 0.0 { roughness.max(SMALLEST_SHEEN_ROUGHNESS) } else { roughness };
            let off = |cosine: f64| {
                let [table, exact] = [table.at(cosine, roughness), share(cosine, roughness)];
                (table - exact).abs() / exact.max(1.0)
            };
            worst = midpoints(23 + index % 3).map(off).fold(worst, f64::max);
            worst_grazing = midpoints(23 + index % 3).map(|part| off(0.001 * 50.0_f64.powf(part))).fold(worst_grazing, f64::max);
        }
        println!("off by {worst:.1e}, near the horizon by {worst_grazing:.1e}");
        assert!(worst < most && worst_grazing < most_grazing, "{worst} {worst_grazing}");
    }
}

/// Points and weights of an integral over [0, 1] that crowd at both ends (Takahasi and Mori 1974): each with its distance from 0 and from 1.
fn double_exponential(count: usize) -> Vec<[f64; 3]> {
    let step = 6.0 / (count - 1) as f64;
    let point = |index: usize| {
        let t = step * index as f64 - 3.0;
        let s = PI * t.sinh();
        let [below, above] = [1.0 / (1.0 + (-s).exp()), 1.0 / (1.0 + s.exp())];
        [below, above, step * PI * t.cosh() * below * above]
    };
    (0..count).map(point).collect()
}

/// The value of [`facet_albedo`], to eight digits, in another way: by spherical coordinates of the microfacets' normals where all are stretched to width 1, φ from the plane of incidence and ψ from the surface's normal within it, between the ψ from which nothing is reflected down.
fn converged_albedo(cosine: f64, roughness: f64, masking: Masking, across: &[[f64; 3]], along: &[[f64; 3]]) -> f64 {
    let (c, alpha) = (cosine, roughness * roughness);
    let sine = (1.0 - c * c).max(0.0).sqrt();
    let lambda = |cosine: f64| {
        let tan_squared = (1.0 - cosine * cosine).max(0.0) / (cosine * cosine);
        MicrofacetDistribution::Ggx.lambda(alpha * alpha * tan_squared)
    };
    let (lambda_o, seen) = (lambda(c), (alpha * sine).atan2(c));
    // A reflected ray leaves upward where 2·(wo·m)·mz > c, in T = tan ψ: c·α²·(1 + q)·T² − 2·sin θ·α·T +
    // c·(α²·q − 1) < 0, q = tan² φ. No T does beyond this q.
    let (a, b) = (alpha * alpha, alpha * alpha - 1.0);
    let most = ((b * b + 4.0 * a * (1.0 + (sine / c).powi(2))).sqrt() - b) / (2.0 * a);
    let most_phi = most.sqrt().atan();
    let mut sum = 0.0;
    for [part, _, phi_weight] in across {
        let (sin_phi, cos_phi) = (most_phi * part).sin_cos();
        let q = (sin_phi / cos_phi).powi(2).min(most);
        let (a, b, constant) = (c * alpha * alpha * (1.0 + q), sine * alpha, c * (alpha * alpha * q - 1.0));
        let upper = b + (b * b - a * constant).max(0.0).sqrt();
        let least_psi = if upper > 0.0 { (constant / upper).atan().max(seen - FRAC_PI_2) } else { 0.0 };
        let width = (upper / a).atan() - least_psi;
        for [below, above, psi_weight] in along {
            let psi = if *below < 0.5 { least_psi + width * below } else { least_psi + width * (1.0 - above) };
            let normal = DVec3::new(alpha * cos_phi * psi.sin(), alpha * sin_phi, cos_phi * psi.cos());
            let leaving = 2.0 * (sine * normal.x + c * normal.z) * normal.z / normal.length_squared() - c;
            if leaving > 0.0 {
                let weight = most_phi * phi_weight * width * psi_weight * cos_phi * cos_phi * (seen - psi).cos();
                sum += weight * masking.shadowing(lambda_o, lambda(leaving.min(1.0))) * (1.0 + lambda_o);
            }
        }
    }
    4.0 * sum / (PI * (1.0 + seen.cos()))
}

/// The largest deviation from 1 of what a white metal returns of a uniform light if this table makes up for what is lost, and where.
fn worst_return(table: &AlbedoTable, masking: Masking, cosines: [f64; 2]) -> (f64, [f64; 2]) {
    let (across, along) = (double_exponential(31), double_exponential(41));
    let mut worst = (0.0_f64, [0.0; 2]);
    // Narrower facets are a mirror. Between the rows, and on them.
    let roughnesses = (0..10).map(|step| 0.01 * 1.3_f64.powi(step)).chain((5..=42).map(|step| f64::from(step) / 42.0));
    for roughness in roughnesses {
        for step in 0..=36 {
            let cosine = cosines[0] * (cosines[1] / cosines[0]).powf(f64::from(step) / 36.0);
            let returned = converged_albedo(cosine, roughness, masking, &across, &along) / table.at(cosine, roughness);
            if (returned - 1.0).abs() > worst.0 {
                worst = ((returned - 1.0).abs(), [cosine, roughness]);
            }
        }
    }
    worst
}

/// 1 ± 0.002 for any roughness, from the normal to 0.0006° above the surface.
#[test]
fn compensated_metal_returns_all_light() {
    let (across, along) = (double_exponential(31), double_exponential(41));
    let closed = converged_albedo(1.0, 1.0, Masking::Separable, &across, &along);
    assert!((closed - (1.0 - std::f64::consts::LN_2)).abs() < 1e-7, "{closed}");
    for masking in MASKINGS {
        let table = AlbedoTable::of_facets(masking);
        for cosines in [[1e-5, 1e-2], [1e-2, 1.0]] {
            let (off, [cosine, roughness]) = worst_return(table, masking, cosines);
            println!("{masking:?} of {cosines:?}: off by {off:.1e} at cosine {cosine:.1e}, roughness {roughness:.3}");
            assert!(off < 2e-3, "{masking:?}: {off} at cosine {cosine}, roughness {roughness}");
        }
        // The controls: where entries crowd elsewhere, as many are too few.
        let too_small = Layout { knee: |roughness| 0.5 * roughness * roughness, ..OF_FACETS };
        let of_roughness = Layout { knee: |roughness| roughness, ..OF_FACETS };
        for (name, layout) in [("a quarter of it", too_small), ("the roughness", of_roughness)] {
            let table = AlbedoTable::new(layout, |cosine, roughness| facet_albedo(cosine, roughness, masking));
            let (off, _) = worst_return(&table, masking, [1e-5, 1.0]);
            println!("{masking:?}, the knee {name}: off by {off:.1e}");
            assert!(off > 2e-3, "the knee {name} would pass: {off}");
        }
    }
}
