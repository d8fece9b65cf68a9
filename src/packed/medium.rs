//! Media as the device reads them.

use std::collections::BTreeSet;

use super::error::PackError;
use super::volume::{PackedVolume, PackedVolumes};
use crate::scene::media;
use crate::scene::{Filling, LightGroups, MaterialId, Media, Phase, PhaseKind, PhaseLobe, ReceiverId};
use crate::shader::shared::shared_constants;

/// Media have numbers of 16 bits, from 1.
const MOST_MEDIA: usize = u16::MAX as usize;

shared_constants!(constants {
    /// Words of a medium in the tables.
    const MEDIUM_WORDS: u32 = (size_of::<PackedMedium>() / 16) as u32;
    /// Flags of a medium: it scatters light; light samples reach it.
    const MEDIUM_SCATTERS: u32 = 1;
    const MEDIUM_IS_LIGHT_SAMPLED: u32 = 2;
    /// Flags of a medium with grids: it has a density, and behind that a grid of albedos, and one by which emission is multiplied.
    const MEDIUM_VARIES: u32 = 4;
    const MEDIUM_HAS_ALBEDOS: u32 = 8;
    const MEDIUM_HAS_GLOW: u32 = 16;
    /// Flag of a medium that gives off light, seen or not.
    const MEDIUM_GIVES_LIGHT: u32 = 32;
    /// Most places at which a ray looks up the density of a medium, and the share of light below which it goes on by chance.
    const MOST_LOOKUPS: u32 = media::MOST_LOOKUPS;
    const FAINT: f32 = media::FAINT as f32;
    /// Flag beside the number of a medium's phase lobes: no light sample within it finds a light.
    const PHASE_IS_DARK: u32 = 1 << 31;
    /// Above the first of a medium's phase lobes stands how many there are.
    const PHASE_COUNT_SHIFT: u32 = 20;
    /// Kinds of phase lobes.
    const PHASE_HENYEY_GREENSTEIN: u32 = 0;
    const PHASE_RAYLEIGH: u32 = 1;
});

/// 48 bytes, three vec4 of the tables. All are per unit length.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct PackedMedium {
    pub extinction: [f32; 3],
    pub flags: u32,
    pub scattering: [f32; 3],
    /// The first of its phase lobes, and above `PHASE_COUNT_SHIFT` their number.
    pub phase: u32,
    pub emission: [f32; 3],
    /// The first of its volumes: the density, then those that its flags name.
    pub first_volume: u32,
}

impl PackedMedium {
    /// The medium gives off light, which a render in the light of another group does not see.
    fn gives_light(&self) -> bool {
        self.flags & MEDIUM_GIVES_LIGHT != 0
    }
}

/// A part of a phase function, 16 bytes.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct PackedPhaseLobe {
    pub weight: f32,
    pub g: f32,
    pub kind: u32,
    pub unused: u32,
}

/// The media of a scene; none where no surface encloses one that takes or gives light, and the camera is in none.
#[derive(Debug, Clone, Default)]
pub struct PackedMedia {
    /// That of number 1 is the first.
    pub media: Vec<PackedMedium>,
    pub phases: Vec<PackedPhaseLobe>,
    pub volumes: PackedVolumes,
    /// The number of the medium that the camera is within; 0: none.
    pub around_camera: u32,
    /// By medium, to which receivers its places belong.
    pub receivers: Vec<ReceiverId>,
}

impl PackedMedia {
    /// Packs the media of a scene whose surfaces are of these materials.
    ///
    /// # Errors
    /// [`PackError::TooManyMedia`] or [`PackError::TooManyPhases`] where their numbers do not fit.
    pub fn new(media: &Media, groups: &LightGroups, of_surfaces: &BTreeSet<MaterialId>) -> Result<Self, PackError> {
        let mut packed = Self::default();
        let counts = |number: usize| media.filling(number).is_some_and(|filling| !filling.is_clear());
        if !of_surfaces.iter().map(|&id| media.behind(id)).chain([media.around_camera]).any(counts) {
            return Ok(packed);
        }
        if media.fillings.len() > MOST_MEDIA {
            return Err(PackError::TooManyMedia { found: media.fillings.len(), limit: MOST_MEDIA });
        }
        for filling in &media.fillings {
            let medium = packed.medium(filling)?;
            packed.receivers.push(filling.receiver);
            let is_seen = groups.shows(filling.light_group);
            packed.media.push(if is_seen { medium } else { PackedMedium { emission: [0.0; 3], ..medium } });
        }
        packed.around_camera = media.around_camera as u32;
        Ok(packed)
    }

    /// Adds a phase function: the first of its lobes, and above `PHASE_COUNT_SHIFT` their number.
    ///
    /// # Errors
    /// [`PackError::TooManyPhases`]
    pub fn phase(&mut self, phase: &Phase) -> Result<u32, PackError> {
        let (first, count) = (self.phases.len(), phase.0.len());
        if first >= 1 << PHASE_COUNT_SHIFT || count >= 1 << (31 - PHASE_COUNT_SHIFT) {
            return Err(PackError::TooManyPhases);
        }
        self.phases.extend(phase.0.iter().map(packed_lobe));
        Ok(first as u32 | (count as u32) << PHASE_COUNT_SHIFT)
    }

    /// Such a run of lobes stands within a table of so many, and is not empty.
    pub fn has_phase(phase: u32, length: usize) -> bool {
        let (first, count) = (phase & ((1 << PHASE_COUNT_SHIFT) - 1), (phase & !PHASE_IS_DARK) >> PHASE_COUNT_SHIFT);
        count != 0 && (first + count) as usize <= length
    }

    fn medium(&mut self, filling: &Filling) -> Result<PackedMedium, PackError> {
        let phase = self.phase(&filling.phase)?;
        let first_volume = self.volumes.volumes.len() as u32;
        let grids = filling.grids.as_deref();
        if let Some(grids) = grids {
            let density = PackedVolume::of_density(grids.density(), grids.majorants(), filling.tracking_rate());
            self.volumes.push(density, grids.density(), Some(grids.majorants()));
            for volume in [grids.albedo(), grids.emission()].into_iter().flatten() {
                self.volumes.push(PackedVolume::new(volume), volume, None);
            }
        }
        let flag = |is_set: bool, flag: u32| if is_set { flag } else { 0 };
        Ok(PackedMedium {
            extinction: filling.extinction.to_f32(),
            flags: flag(filling.scatters(), MEDIUM_SCATTERS)
                | flag(filling.is_light_sampled, MEDIUM_IS_LIGHT_SAMPLED)
                | flag(grids.is_some(), MEDIUM_VARIES)
                | flag(grids.is_some_and(|grids| grids.albedo().is_some()), MEDIUM_HAS_ALBEDOS)
                | flag(grids.is_some_and(|grids| grids.emission().is_some()), MEDIUM_HAS_GLOW)
                | flag(!filling.emission.is_black(), MEDIUM_GIVES_LIGHT),
            scattering: filling.scattering.to_f32(),
            phase: phase | flag(filling.is_dark, PHASE_IS_DARK),
            emission: filling.emission.to_f32(),
            first_volume,
        })
    }

    pub fn is_empty(&self) -> bool {
        self.media.is_empty()
    }

    /// A sentence about a number that leads outside of the tables.
    pub(super) fn check(&self, texel_words: usize) -> Result<(), String> {
        if self.around_camera as usize > self.media.len() {
            return Err(format!("the camera is within medium {} of {}", self.around_camera, self.media.len()));
        }
        for (index, medium) in self.media.iter().enumerate() {
            if !Self::has_phase(medium.phase, self.phases.len()) {
                return Err(format!("medium {index} has the phase lobes {:#x}", medium.phase));
            }
            let volumes = (medium.flags & (MEDIUM_VARIES | MEDIUM_HAS_ALBEDOS | MEDIUM_HAS_GLOW)).count_ones();
            let end = medium.first_volume as usize + volumes as usize;
            let is_density = |volume: &PackedVolume| volume.side > 0;
            if volumes > 0
                && (end > self.volumes.volumes.len() || !is_density(&self.volumes.volumes[medium.first_volume as usize]))
            {
                return Err(format!("medium {index} has {volumes} volumes from {} on", medium.first_volume));
            }
        }
        for (index, volume) in self.volumes.volumes.iter().enumerate() {
            volume.check(texel_words).map_err(|reason| format!("the grid {index} of media {reason}"))?;
        }
        Ok(())
    }

    /// Some medium scatters light.
    pub fn scatter(&self) -> bool {
        self.media.iter().any(|medium| medium.flags & MEDIUM_SCATTERS != 0)
    }

    /// Some medium differs from place to place.
    pub fn vary(&self) -> bool {
        !self.volumes.volumes.is_empty()
    }

    /// Some medium that differs from place to place is passed by paths, which it does not scatter or to which it gives light.
    pub fn pass_paths(&self) -> bool {
        let passes = |medium: &PackedMedium| medium.flags & MEDIUM_SCATTERS == 0 || medium.gives_light();
        self.media.iter().any(|medium| medium.flags & MEDIUM_VARIES != 0 && passes(medium))
    }

    /// Some medium gives off light.
    pub fn emit(&self) -> bool {
        self.media.iter().any(PackedMedium::gives_light)
    }
}

fn packed_lobe(lobe: &PhaseLobe) -> PackedPhaseLobe {
    let (kind, g) = match lobe.kind {
        PhaseKind::HenyeyGreenstein { g } => (PHASE_HENYEY_GREENSTEIN, g as f32),
        PhaseKind::Rayleigh => (PHASE_RAYLEIGH, 0.0),
    };
    PackedPhaseLobe { weight: lobe.weight as f32, g, kind, unused: 0 }
}
