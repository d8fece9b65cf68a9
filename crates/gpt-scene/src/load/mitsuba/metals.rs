//! Optical constants of materials that Mitsuba knows by name.

use glam::{DMat3, DVec3};

use super::colour::{Role, integrate};
use crate::load::file::material::conductor::MetalEntry;
use crate::spectrum::Spectrum;

/// Indices of refraction at 589 nm (CRC Handbook of Chemistry and Physics; Schott for BK7).
const DIELECTRICS: [(&str, f64); 24] = [
    ("vacuum", 1.0),
    ("helium", 1.000_036),
    ("hydrogen", 1.000_132),
    ("air", 1.000_277),
    ("carbon dioxide", 1.000_45),
    ("water", 1.3330),
    ("acetone", 1.36),
    ("ethanol", 1.361),
    ("carbon tetrachloride", 1.461),
    ("glycerol", 1.4729),
    ("benzene", 1.501),
    ("silicone oil", 1.520_45),
    ("bromine", 1.661),
    ("water ice", 1.31),
    ("fused quartz", 1.458),
    ("pyrex", 1.470),
    ("acrylic glass", 1.49),
    ("polypropylene", 1.49),
    ("bk7", 1.5046),
    ("sodium chloride", 1.544),
    ("amber", 1.55),
    ("pet", 1.5750),
    ("diamond", 2.419),
    ("silica", 1.458),
];

pub fn dielectric(name: &str) -> Option<f64> {
    let name = name.to_ascii_lowercase();
    DIELECTRICS.iter().find(|(known, _)| *known == name).map(|(_, ior)| *ior)
}

/// One oscillator of a Lorentz-Drude model: strength, width and place, the last two in eV.
type Oscillator = [f64; 3];

/// Plasma frequency in eV and oscillators, the first of free electrons (Rakić, Djurišić, Elazar and Majewski 1998, "Optical properties of
/// metallic films for vertical-cavity optoelectronic devices", table 2).
struct Model {
    name: &'static str,
    plasma: f64,
    oscillators: &'static [Oscillator],
}

#[allow(clippy::approx_constant, reason = "one of the fitted energies is near π by chance")]
const METALS: [Model; 4] = [
    Model {
        name: "be",
        plasma: 18.51,
        oscillators: &[
            [0.084, 0.035, 0.0],
            [0.031, 1.664, 0.100],
            [0.140, 3.395, 1.032],
            [0.530, 4.454, 3.183],
            [0.130, 1.802, 4.604],
        ],
    },
    Model {
        name: "pd",
        plasma: 9.72,
        oscillators: &[
            [0.330, 0.008, 0.0],
            [0.649, 2.950, 0.336],
            [0.121, 0.555, 0.501],
            [0.638, 4.621, 1.659],
            [0.453, 3.236, 5.715],
        ],
    },
    Model {
        name: "pt",
        plasma: 9.59,
        oscillators: &[
            [0.333, 0.080, 0.0],
            [0.191, 0.517, 0.780],
            [0.659, 1.838, 1.314],
            [0.547, 3.668, 3.141],
            [3.576, 8.517, 9.249],
        ],
    },
    Model {
        name: "ti",
        plasma: 7.29,
        oscillators: &[
            [0.148, 0.082, 0.0],
            [0.899, 2.276, 0.777],
            [0.393, 2.518, 1.545],
            [0.187, 1.663, 2.509],
            [0.001, 1.762, 19.43],
        ],
    },
];

/// Product of Planck's constant and the speed of light, in eV·nm.
const ENERGY: f64 = 1_239.841_984;

impl Model {
    /// n and k at a wavelength in nanometres: the root of the permittivity 1 + Σ fⱼ ωp² / (ωⱼ² − ω² − iωΓⱼ).
    fn index(&self, wavelength: f64) -> (f64, f64) {
        let omega = ENERGY / wavelength;
        let (mut real, mut imaginary) = (1.0, 0.0);
        for [strength, width, place] in self.oscillators {
            let (a, b) = (place * place - omega * omega, -omega * width);
            let factor = strength * self.plasma * self.plasma / (a * a + b * b);
            real += factor * a;
            imaginary -= factor * b;
        }
        let magnitude = real.hypot(imaginary);
        (((magnitude + real) / 2.0).sqrt(), ((magnitude - real) / 2.0).sqrt())
    }
}

/// n and k of linear Rec.709, integrated under daylight as every spectrum of a surface is, of what was measured and published. Where several
/// measurements exist, this is the one that Mitsuba's tables hold, or the nearest.
struct Measured {
    name: &'static str,
    n: [f64; 3],
    k: [f64; 3],
}

const MEASURED: [Measured; 11] = [
    // Amorphous carbon: Arakawa, Dolfini, Ashley and Williams 1985, Phys. Rev. B 31, 8097.
    Measured { name: "a-c", n: [2.4532, 2.3467, 2.1706], k: [0.7287, 0.8434, 0.8950] },
    // Inagaki, Arakawa and Williams 1981, Phys. Rev. B 23, 5246.
    Measured { name: "hg", n: [2.0279, 1.5151, 1.0163], k: [5.3032, 4.6034, 3.7909] },
    // Smith 1969, Phys. Rev. 183, 634.
    Measured { name: "k", n: [0.0538, 0.0489, 0.0418], k: [1.7692, 1.4220, 1.0181] },
    Measured { name: "na", n: [0.0489, 0.0590, 0.0682], k: [2.6676, 2.2273, 1.7516] },
    // Rasigni and Rasigni 1977, J. Opt. Soc. Am. 67, 54.
    Measured { name: "li", n: [0.2207, 0.2059, 0.2420], k: [2.9781, 2.4330, 1.8542] },
    // Weaver, Lynch and Olson 1973, Phys. Rev. B 7, 4311; Weaver, Olson and Lynch 1975, Phys. Rev. B 12, 1293, and 1977, Phys. Rev. B 15, 4115.
    Measured { name: "rh", n: [2.1595, 1.9600, 1.7220], k: [5.6800, 4.9553, 4.3900] },
    Measured { name: "w", n: [3.6349, 3.4933, 3.3129], k: [2.9225, 2.7468, 2.5046] },
    // Pflüger, Fink, Weber, Bohnen and Crecelius 1984, Phys. Rev. B 30, 1155.
    Measured { name: "tic", n: [3.0766, 2.9917, 2.8458], k: [2.7280, 2.4790, 2.3908] },
    Measured { name: "tin", n: [1.3772, 1.2153, 1.5033], k: [2.8562, 2.0430, 1.2375] },
    Measured { name: "vc", n: [3.0456, 2.9022, 2.7890], k: [2.5645, 2.3173, 2.1630] },
    Measured { name: "vn", n: [2.3890, 2.2342, 2.1363], k: [2.5452, 2.1652, 1.7895] },
];

/// n and k of linear Rec.709 under a light of equal energy, as Mitsuba 3.9.1 prints them of its materials in its RGB variants.
struct MitsubaMetal {
    name: &'static str,
    n: [f64; 3],
    k: [f64; 3],
}

/// By Palik 1998, Handbook of Optical Constants of Solids, but for diamond (Phillip and Taft 1964), vanadium (Johnson and Christy 1974) and niobium
/// (Weaver, Lynch and Olson 1973, Phys. Rev. B 7, 4311).
const MITSUBA_METALS: [MitsubaMetal; 21] = [
    MitsubaMetal { name: "alas", n: [3.6053, 3.2329, 2.2163], k: [0.0007, 0.0, 0.0075] },
    MitsubaMetal { name: "alsb", n: [0.0, 4.1394, 4.6693], k: [0.0, 0.0940, 1.3006] },
    MitsubaMetal { name: "cr", n: [4.3697, 2.9165, 1.6549], k: [5.2065, 4.2313, 3.7547] },
    MitsubaMetal { name: "csi", n: [2.1449, 1.7023, 1.6624], k: [0.0; 3] },
    MitsubaMetal { name: "cu2o", n: [3.5518, 2.9499, 2.7519], k: [0.1142, 0.1939, 0.6061] },
    MitsubaMetal { name: "cuo", n: [3.2475, 2.4478, 2.2102], k: [0.5211, 0.5700, 0.7222] },
    MitsubaMetal { name: "d-c", n: [2.7087, 2.3188, 2.2289], k: [0.0; 3] },
    MitsubaMetal { name: "hgte", n: [4.7790, 3.2312, 2.6599], k: [1.6316, 1.5808, 1.7293] },
    MitsubaMetal { name: "ir", n: [3.0863, 2.0822, 1.6179], k: [5.5922, 4.0671, 3.2673] },
    MitsubaMetal { name: "mgo", n: [2.0896, 1.6507, 1.5949], k: [0.0; 3] },
    MitsubaMetal { name: "mo", n: [4.4840, 3.5251, 2.7763], k: [4.1114, 3.4208, 3.1506] },
    MitsubaMetal { name: "nb", n: [3.4201, 2.7901, 2.3956], k: [3.4414, 2.7377, 2.5798] },
    MitsubaMetal { name: "ni", n: [2.3673, 1.6634, 1.4671], k: [4.4988, 3.0502, 2.3454] },
    MitsubaMetal { name: "se", n: [4.0583, 2.8429, 2.8209], k: [0.7540, 0.6384, 0.5218] },
    MitsubaMetal { name: "sic", n: [3.1723, 2.5260, 2.4794], k: [0.0; 3] },
    MitsubaMetal { name: "snte", n: [4.5242, 1.9816, 1.2816], k: [0.0; 3] },
    MitsubaMetal { name: "ta", n: [2.0627, 2.3929, 2.6279], k: [2.4084, 1.7415, 1.9470] },
    MitsubaMetal { name: "te", n: [7.3902, 4.4821, 2.6371], k: [3.2560, 3.5271, 3.2921] },
    MitsubaMetal { name: "thf4", n: [1.8307, 1.4422, 1.3876], k: [0.0; 3] },
    MitsubaMetal { name: "tio2", n: [3.4566, 2.8017, 2.9052], k: [0.0001, 0.0, 0.0007] },
    MitsubaMetal { name: "v", n: [4.2776, 3.5129, 2.7611], k: [3.4913, 2.8895, 3.1115] },
];

/// Converts a spectrum under daylight to one under a light of equal energy. Mitsuba integrates the constants
/// of named metals so, though not those that a scene writes: a spectrum that is constant over wavelength
/// becomes 1.20, 0.95 and 0.91 of it. The spectrum is taken for the parabola over the wavelength that has
/// these values, which is right to half a per cent for all of the table.
fn under_equal_energy(daylight: [f64; 3]) -> Spectrum {
    let of_basis = |role: Role| {
        DMat3::from_cols_array_2d(
            &[0, 1, 2].map(|power| integrate(role, |wavelength| ((wavelength - 560.0) / 200.0).powi(power)).to_rgb()),
        )
    };
    Spectrum::from_rgb((of_basis(Role::Light) * of_basis(Role::Surface).inverse() * DVec3::from(daylight)).to_array())
}

/// The metal of a conductor.
pub enum Metal {
    Preset(MetalEntry),
    Constants { eta: Spectrum, k: Spectrum },
}

/// The metal of this name. None of a metal that is not known.
pub fn conductor(name: &str) -> Option<Metal> {
    let preset = |preset| Some(Metal::Preset(preset));
    let name = name.to_ascii_lowercase();
    let plain = name.strip_suffix("_palik").unwrap_or(&name);
    match plain {
        "au" | "gold" => return preset(MetalEntry::Gold),
        "cu" | "copper" => return preset(MetalEntry::Copper),
        "ag" | "silver" => return preset(MetalEntry::Silver),
        "al" | "aluminium" | "aluminum" => return preset(MetalEntry::Aluminium),
        _ => {}
    }
    if let Some(MitsubaMetal { n, k, .. }) = MITSUBA_METALS.iter().find(|one| one.name == plain) {
        // An index of 0 is a perfect mirror, which a small one is as well.
        return Some(Metal::Constants { eta: Spectrum::from_rgb(*n).max(Spectrum::grey(1e-4)), k: Spectrum::from_rgb(*k) });
    }
    if let Some(Measured { n, k, .. }) = MEASURED.iter().find(|one| one.name == plain) {
        return Some(Metal::Constants { eta: under_equal_energy(*n), k: under_equal_energy(*k) });
    }
    let metal = METALS.iter().find(|metal| metal.name == plain)?;
    let eta = integrate(Role::Light, |wavelength| metal.index(wavelength).0);
    let k = integrate(Role::Light, |wavelength| metal.index(wavelength).1);
    Some(Metal::Constants { eta: eta.max(Spectrum::grey(1e-3)), k: k.max(Spectrum::BLACK) })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mitsuba 3.9.1 prints 4.19, 3.19, 2.78 and 3.84, 3.01, 2.87 of its beryllium.
    #[test]
    fn models_are_near_what_was_measured() {
        let metal = METALS.iter().find(|metal| metal.name == "be").expect("it is in the table");
        for (part, printed) in [(0, [4.1850, 3.1850, 2.7841]), (1, [3.8355, 3.0101, 2.8690])] {
            let found = integrate(Role::Light, |wavelength| [metal.index(wavelength).0, metal.index(wavelength).1][part]);
            assert!((found / Spectrum::from_rgb(printed) - Spectrum::WHITE).map(f64::abs).max_component() < 0.1, "{found}");
        }
    }

    /// Constants that Mitsuba 3.9.1 prints of its materials in its RGB variants.
    #[test]
    fn constants_of_metals_are_mitsubas() {
        for (name, eta, k) in [
            ("a-c", [2.9440, 2.2271, 1.9682], [0.8875, 0.7993, 0.8153]),
            ("w", [4.3708, 3.3002, 2.9984], [3.5006, 2.6049, 2.2732]),
            ("tin", [1.6484, 1.1505, 1.3798], [3.3683, 1.9435, 1.1021]),
        ] {
            let metal = MEASURED.iter().find(|metal| metal.name == name).expect("it is in the table");
            for (daylight, theirs) in [(metal.n, eta), (metal.k, k)] {
                let is_near =
                    |ours: Spectrum| (ours / Spectrum::from_rgb(theirs) - Spectrum::WHITE).map(f64::abs).max_component() < 6e-3;
                assert!(is_near(under_equal_energy(daylight)), "{name}: {}", under_equal_energy(daylight));
                assert!(!is_near(Spectrum::from_rgb(daylight)), "{name}: daylight would do as well");
            }
        }
    }

    #[test]
    fn names_are_known_in_any_case() {
        assert_eq!(dielectric("BK7"), Some(1.5046));
        assert_eq!(dielectric("unobtainium"), None);
        assert!(matches!(conductor("Au"), Some(Metal::Preset(MetalEntry::Gold))));
        assert!(matches!(conductor("W"), Some(Metal::Constants { .. })) && conductor("Zz").is_none());
    }
}
