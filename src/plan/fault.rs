//! Faults that can be planted in the device's kernels: a check that never fails proves nothing.

use crate::choice::choices;
use crate::packed::PackedScene;
use crate::packed::light::PackedLight;
use crate::packed::material::NO_LOBE;
use crate::shader::Switches;

choices! {
    /// A mistake compiled into the device's kernels on request, and only there: the CPU reference stays right.
    pub enum Fault {
        /// The material of most primitives that scatter returns 1.01 times what it should.
        Brdf = "brdf",
        /// Multiple importance sampling's weights are all 1.
        Mis = "mis",
        /// The light chosen most often gives none when it is sampled.
        Light = "light",
    }
}

impl Fault {
    /// The switch that compiles it in.
    pub fn switch(self) -> &'static str {
        match self {
            Self::Brdf => "PLANT_BRDF",
            Self::Mis => "PLANT_MIS",
            Self::Light => "PLANT_LIGHT",
        }
    }

    /// Compiles the fault in where the scene has something for it to act on.
    pub(super) fn plant(self, packed: &PackedScene, switches: &mut Switches) {
        let samples_lights = switches.enabled.contains("LIGHTS");
        match self {
            Self::Brdf => {
                if let Some(material) = most_used_material(packed) {
                    switches.enable(self.switch(), true);
                    switches.constants.insert("PLANTED_MATERIAL", material);
                }
            }
            Self::Mis => {
                let shared = packed.lights.iter().any(found_both_ways) && switches.enabled.contains("ESTIMATOR_MIS");
                switches.enable(self.switch(), samples_lights && shared);
            }
            Self::Light => {
                let likeliest = packed.lights.iter().enumerate().max_by(|(_, a), (_, b)| a.pmf.total_cmp(&b.pmf));
                if let Some((light, _)) = likeliest.filter(|_| samples_lights) {
                    switches.enable(self.switch(), true);
                    switches.constants.insert("PLANTED_LIGHT", light as u32);
                }
            }
        }
    }
}

/// BSDF samples find the light too: more than one direction leads to it.
fn found_both_ways(light: &PackedLight) -> bool {
    !light.is_delta()
}

/// The scattering material that most primitives have.
fn most_used_material(packed: &PackedScene) -> Option<u32> {
    let mut uses = vec![0_u64; packed.materials.materials.len()];
    for primitive in packed.primitives.iter().filter(|primitive| primitive.instance().is_none()) {
        let material = primitive.material() as usize;
        if packed.materials.materials[material].kind() != NO_LOBE {
            uses[material] += 1;
        }
    }
    let most = uses.iter().enumerate().max_by_key(|(_, count)| **count);
    most.filter(|(_, count)| **count > 0).map(|(material, _)| material as u32)
}
