//! Optical constants of materials that Mitsuba knows by name.

use glam::DVec3;

use super::colour::{Role, integrate};
use crate::load::import::Keys;

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
struct Metal {
    name: &'static str,
    plasma: f64,
    oscillators: &'static [Oscillator],
}

#[allow(clippy::approx_constant, reason = "one of the fitted energies is near π by chance")]
const METALS: [Metal; 7] = [
    Metal {
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
    Metal {
        name: "cr",
        plasma: 10.75,
        oscillators: &[
            [0.168, 0.047, 0.0],
            [0.151, 3.175, 0.121],
            [0.150, 1.305, 0.543],
            [1.149, 2.676, 1.970],
            [0.825, 1.335, 8.775],
        ],
    },
    Metal {
        name: "ni",
        plasma: 15.92,
        oscillators: &[
            [0.096, 0.048, 0.0],
            [0.100, 4.511, 0.174],
            [0.135, 1.334, 0.582],
            [0.106, 2.178, 1.597],
            [0.729, 6.292, 6.089],
        ],
    },
    Metal {
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
    Metal {
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
    Metal {
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
    Metal {
        name: "w",
        plasma: 13.22,
        oscillators: &[
            [0.206, 0.064, 0.0],
            [0.054, 0.530, 1.004],
            [0.166, 1.281, 1.917],
            [0.706, 3.332, 3.580],
            [2.590, 5.836, 7.498],
        ],
    },
];

/// Product of Planck's constant and the speed of light, in eV·nm.
const ENERGY: f64 = 1_239.841_984;

impl Metal {
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

/// The keys of a conductor that say this metal: `preset`, or `eta` and `k`. None of a metal that is not known.
pub fn conductor(name: &str) -> Option<Keys> {
    let preset = |preset: &str| Some(Keys::new().with("preset", preset));
    let name = name.to_ascii_lowercase();
    let plain = name.strip_suffix("_palik").unwrap_or(&name);
    match plain {
        "au" | "gold" => return preset("gold"),
        "cu" | "copper" => return preset("copper"),
        "ag" | "silver" => return preset("silver"),
        "al" | "aluminium" | "aluminum" => return preset("aluminium"),
        _ => {}
    }
    let metal = METALS.iter().find(|metal| metal.name == plain)?;
    let eta = integrate(Role::Surface, |wavelength| metal.index(wavelength).0);
    let k = integrate(Role::Surface, |wavelength| metal.index(wavelength).1);
    Some(Keys::new().with("eta", eta.max(DVec3::splat(1e-3))).with("k", k.max(DVec3::ZERO)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Published at 589 nm: tungsten 3.54 + 2.84i, nickel 1.86 + 3.41i, chromium 3.18 (Johnson and Christy 1974; Palik 1985). Measurements of
    /// chromium's k differ by a third among each other.
    #[test]
    fn models_are_near_what_was_measured() {
        for (name, n, k) in [("w", 3.54, Some(2.84)), ("ni", 1.86, Some(3.41)), ("cr", 3.18, None)] {
            let metal = METALS.iter().find(|metal| metal.name == name).expect("it is in the table");
            let (found_n, found_k) = metal.index(589.0);
            let is_near = |found: f64, published: f64| (found / published - 1.0).abs() < 0.15;
            assert!(is_near(found_n, n) && k.is_none_or(|k| is_near(found_k, k)), "{name}: {found_n} + {found_k}i");
        }
    }

    #[test]
    fn names_are_known_in_any_case() {
        assert_eq!(dielectric("BK7"), Some(1.5046));
        assert_eq!(dielectric("unobtainium"), None);
        assert!(conductor("Au").is_some_and(|keys| keys.text("preset") == Some("gold")));
        assert!(conductor("W").is_some_and(|keys| keys.get("eta").is_some()) && conductor("Zz").is_none());
    }
}
