//! Spectra that pbrt knows by name.

use crate::load::file::material::conductor::MetalEntry;
use crate::math::xyz_to_rec709;
use crate::spectrum::Spectrum;
use glam::DVec3;

/// The metal of a spectrum `metal-NAME-eta` or `metal-NAME-k`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum NamedMetal {
    Preset(MetalEntry),
    Constants { eta: Spectrum, k: Spectrum },
}

/// Metals without a preset: n and k by the CIE's observer of 1931 under D65. Brass is that of Querry 1985, "Optical constants", CRDC-CR-85034 (70 % copper,
/// 30 % zinc); magnesium oxide and titanium dioxide are those of Palik 1998, "Handbook of Optical Constants of Solids".
const METALS: [(&str, [f64; 3], [f64; 3]); 3] = [
    ("CuZn", [0.4182, 0.5207, 1.1228], [3.6672, 2.6802, 1.7723]),
    ("MgO", [1.7337, 1.7410, 1.7535], [0.0; 3]),
    ("TiO2", [2.8603, 2.9567, 3.1854], [0.0001, 0.0, 0.0006]),
];

/// The metal whose spectrum has this name, where `part` is `eta` or `k`.
pub fn metal(spectrum: &str, part: &str) -> Option<NamedMetal> {
    let name = spectrum.strip_prefix("metal-")?.strip_suffix(part)?.strip_suffix('-')?;
    let preset = |preset| Some(NamedMetal::Preset(preset));
    match name {
        "Ag" => return preset(MetalEntry::Silver),
        "Al" => return preset(MetalEntry::Aluminium),
        "Au" => return preset(MetalEntry::Gold),
        "Cu" => return preset(MetalEntry::Copper),
        _ => {}
    }
    let (_, eta, k) = METALS.iter().find(|(known, ..)| *known == name)?;
    Some(NamedMetal::Constants { eta: Spectrum::from_rgb(*eta), k: Spectrum::from_rgb(*k) })
}

/// Coefficients of Sellmeier's formula, b and c, c in square micrometres (Schott, "Optical glass data sheets"): `glass-BK7` and its like. They are
/// within 0.0005 of pbrt's tables from 380 to 800 nm.
const GLASSES: [(&str, [f64; 3], [f64; 3]); 7] = [
    ("glass-BK7", [1.039_612_12, 0.231_792_344, 1.010_469_45], [0.006_000_698_67, 0.020_017_914_4, 103.560_653]),
    ("glass-BAF10", [1.585_149_5, 0.143_559_385, 1.085_212_69], [0.009_266_812_82, 0.042_448_980_5, 105.613_573]),
    ("glass-FK51A", [0.971_247_817, 0.216_901_417, 0.904_651_666], [0.004_723_019_95, 0.015_357_561_2, 168.681_33]),
    ("glass-LASF9", [2.000_295_47, 0.298_926_886, 1.806_918_43], [0.012_142_601_7, 0.053_873_623_6, 156.530_829]),
    ("glass-F5", [1.524_818_89, 0.187_085_527, 1.427_290_15], [0.011_254_756, 0.058_899_539_2, 129.141_675]),
    ("glass-F10", [1.621_539_02, 0.256_287_842, 1.644_475_52], [0.012_224_145_7, 0.059_573_677_5, 147.468_793]),
    ("glass-F11", [1.737_596_95, 0.313_747_346, 1.898_781_01], [0.013_188_707, 0.062_306_814_2, 155.236_29]),
];

/// Sellmeier's coefficients b and c of a glass by the name of its spectrum.
pub fn glass(spectrum: &str) -> Option<[[f64; 3]; 2]> {
    GLASSES.iter().find(|(known, ..)| *known == spectrum).map(|(_, b, c)| [*b, *c])
}

/// The index of refraction at a wavelength in nanometres, by Sellmeier's formula n² = 1 + Σ bᵢ·λ²/(λ² − cᵢ).
pub fn index([b, c]: [[f64; 3]; 2], nanometres: f64) -> f64 {
    let squared = (nanometres / 1000.0).powi(2);
    let terms: f64 = b.iter().zip(c).map(|(b, c)| b * squared / (squared - c)).sum();
    (1.0 + terms).sqrt()
}

/// The CIE's illuminants in xy (CIE 15:2004), and that of ACES.
const ILLUMINANTS: [(&str, [f64; 2]); 16] = [
    ("stdillum-A", [0.447_57, 0.407_45]),
    ("stdillum-D50", [0.345_67, 0.358_50]),
    ("stdillum-D65", [0.312_72, 0.329_03]),
    ("stdillum-F1", [0.313_1, 0.337_1]),
    ("stdillum-F2", [0.372_1, 0.375_1]),
    ("stdillum-F3", [0.409_1, 0.394_1]),
    ("stdillum-F4", [0.440_2, 0.403_1]),
    ("stdillum-F5", [0.313_8, 0.345_2]),
    ("stdillum-F6", [0.377_9, 0.388_2]),
    ("stdillum-F7", [0.312_9, 0.329_2]),
    ("stdillum-F8", [0.345_8, 0.358_6]),
    ("stdillum-F9", [0.374_1, 0.372_7]),
    ("stdillum-F10", [0.345_8, 0.358_8]),
    ("stdillum-F11", [0.380_5, 0.376_9]),
    ("stdillum-F12", [0.437_0, 0.404_2]),
    ("illum-acesD60", [0.321_68, 0.337_67]),
];

/// The colour of a light of this name, of luminance 1. D65 is white to the last digit.
pub fn illuminant(spectrum: &str) -> Option<Spectrum> {
    let (_, [x, y]) = *ILLUMINANTS.iter().find(|(known, _)| *known == spectrum)?;
    if spectrum == "stdillum-D65" {
        return Some(Spectrum::WHITE);
    }
    Some(xyz_to_rec709(DVec3::new(x / y, 1.0, (1.0 - x - y) / y)))
}

/// True of the names that are no files, known here or not.
pub fn is_name(spectrum: &str) -> bool {
    ["metal-", "glass-", "stdillum-", "illum-"].iter().any(|kind| spectrum.starts_with(kind))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The indices of Schott's data sheets at the wavelength of the line d.
    #[test]
    fn glasses_bend_light_as_schott_says() {
        for (name, expected) in
            [("glass-BK7", 1.5168), ("glass-BAF10", 1.670_03), ("glass-F11", 1.784_72), ("glass-LASF9", 1.850_25)]
        {
            let found = index(glass(name).expect("it is known"), 587.56);
            assert!((found - expected).abs() < 1e-5, "{name}: {found}");
        }
        assert!(glass("glass-X").is_none());
        let [red, blue] = [656.3, 486.1].map(|line| index(glass("glass-BK7").expect("it is known"), line));
        assert!(((1.5168 - 1.0) / (blue - red) - 64.17).abs() < 0.1, "Abbe's number");
    }

    #[test]
    fn illuminants_have_luminance_1_and_their_colours() {
        for (name, _) in ILLUMINANTS {
            let colour = illuminant(name).expect("it is known");
            assert!((colour.luminance() - 1.0).abs() < 1e-3, "{name}: {}", colour.luminance());
        }
        let [tungsten, day] = ["stdillum-A", "stdillum-D65"].map(|name| illuminant(name).expect("it is known"));
        assert!(tungsten.r() > 4.0 * tungsten.b() && day == Spectrum::WHITE);
        assert_eq!(illuminant("stdillum-F13"), None);
    }

    #[test]
    fn metals_are_told_by_their_names() {
        assert_eq!(metal("metal-Au-eta", "eta"), Some(NamedMetal::Preset(MetalEntry::Gold)));
        assert_eq!(metal("metal-Au-eta", "k"), None);
        assert!(matches!(metal("metal-CuZn-k", "k"), Some(NamedMetal::Constants { .. })));
        assert_eq!(metal("metal-Zz-k", "k"), None);
    }
}
