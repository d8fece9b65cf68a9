//! Media, and where they are.
//!
//! A shape of ours says what it holds, and is within whatever is around it; there it says both. So what is around a shape is found by the boxes around
//! all of them.

use glam::{DAffine3, DVec3};
use toml::Table;

use super::Writer;
use super::keys::{entries, table, text};
use super::xml::{Element, matrix};
use crate::load::volume::write_mitsuba;
use crate::math::is_upright;
use crate::scene::{
    MaterialId, Medium, MediumGrids, MediumId, Outside, Phase, PhaseKind, PhaseLobe, Shape, Volume, VolumeFilter, VoxelGrid,
};
use crate::scene_writer::surroundings::{Content, Sides, absorbs};
use crate::spectrum::Spectrum;

impl Writer<'_> {
    /// Writes all media, those of bodies that absorb too.
    pub fn media(&mut self) {
        let tables = entries(self.scene, "medium");
        for (medium, keys) in self.original.media.iter().zip(tables) {
            let name = text(keys, "name").unwrap_or_default();
            let place = format!("medium `{name}`");
            if !medium.emission.is_black() {
                self.drop("emission of a medium", &place, "it gives off no light");
            }
            let element = match &medium.grids {
                Some(grids) => self.heterogeneous(medium, grids, keys, &place),
                None => homogeneous(medium.absorption, medium.scattering),
            };
            self.xml.push(element.id(&medium_id(name)).with(phase(&medium.phase)));
        }
        for (id, material) in self.original.materials.iter().enumerate() {
            if let Some(absorption) = absorbs(&material.kind) {
                self.xml.push(homogeneous(absorption, Spectrum::BLACK).id(&body_id(id)));
            }
        }
    }

    /// A colour that is lost at different rates is in the voxels.
    fn heterogeneous(&mut self, medium: &Medium, grids: &MediumGrids, keys: &Table, place: &str) -> Element {
        let (density, extinction) = (grids.density(), medium.extinction());
        let of_key = |key: &str| table(keys, key).cloned().unwrap_or_default();
        let strongest = extinction.max_component();
        let goes_on = match density.outside {
            Outside::Border => true,
            Outside::Constant(value) => !value.is_black(),
        };
        if goes_on {
            self.drop("density of a medium outside of its grid", place, "it ends with the grid");
        }
        if !is_upright(&density.to_index) {
            let instead = "what its border has goes on to the corners of an upright box around it";
            self.approximate("density of a medium whose grid is turned", place, instead);
        }
        let is_grey = extinction.min_component() == strongest;
        let tint = (!is_grey).then(|| extinction / strongest);
        let element = Element::new("medium", "heterogeneous").float("scale", strongest * density.scale);
        let element = element.with(self.grid("sigma_t", (density, &of_key("density")), tint));
        match grids.albedo() {
            Some(albedo) => {
                if matches!(albedo.outside, Outside::Constant(_)) {
                    self.approximate("albedo of a medium outside of its grid", place, "it goes on as it is at the border");
                }
                element.with(self.grid(
                    "albedo",
                    (albedo, &of_key("albedo_grid")),
                    Some(Spectrum::grey(albedo.scale)).filter(|scale| *scale != Spectrum::WHITE),
                ))
            }
            None => element.rgb("albedo", share_scattered(medium.scattering, extinction)),
        }
    }

    /// A grid as a volume, whose values are multiplied by a colour; its file lies beside the scene.
    fn grid(&mut self, name: &str, (volume, keys): (&Volume, &Table), tint: Option<Spectrum>) -> Element {
        let written = text(keys, "file").filter(|file| tint.is_none() && file.to_ascii_lowercase().ends_with(".vol"));
        let file = match written {
            // The box that the file states does not count there.
            Some(file) => self.file(file),
            None => {
                let content = tint.map_or_else(|| (*volume.grid).clone(), |tint| tinted(&volume.grid, tint));
                let content = write_mitsuba(&content, DVec3::ZERO, DVec3::ONE);
                self.files.add_file(&format!("{name}-{}.vol", self.files.len() + 1), content)
            }
        };
        let size = DVec3::from_array(volume.grid.resolution().map(f64::from));
        let to_world = volume.to_index.inverse() * DAffine3::from_scale(size);
        let filter = if volume.filter == VolumeFilter::Nearest { "nearest" } else { "trilinear" };
        Element::new("volume", "gridvolume")
            .named(name)
            .string("filename", &file)
            .string("filter_type", filter)
            .transform("to_world", &matrix(&to_world))
    }

    /// The id of the medium around the camera.
    pub fn medium_around_camera(&self) -> Option<String> {
        self.original.camera_medium.map(|id| self.medium_named(id))
    }

    fn medium_named(&self, id: MediumId) -> String {
        let tables = entries(self.scene, "medium");
        medium_id(tables.get(id).and_then(|table| text(*table, "name")).unwrap_or_default())
    }

    fn id_of(&self, content: Content) -> String {
        match content {
            Content::Medium(id) => self.medium_named(id),
            Content::Absorption(material) => body_id(material),
        }
    }

    /// The shape with what it holds and what is around it; around shapes of groups it is the camera's medium.
    pub fn with_media(&self, element: Element, shape: Option<&Shape>, is_of_group: bool) -> Element {
        let sides = shape.and_then(|shape| self.surroundings.sides(shape.material, shape.bounds().filter(|_| !is_of_group)));
        let Some(Sides { inside, outside }) = sides else { return element };
        let element = match inside {
            Some(content) => element.named_reference("interior", &self.id_of(content)),
            None => element,
        };
        match outside {
            Some(content) => element.named_reference("exterior", &self.id_of(content)),
            None => element,
        }
    }
}

/// No material and no group has this name.
pub fn medium_id(name: &str) -> String {
    format!("medium {name}")
}

/// The medium within a body that absorbs.
fn body_id(material: MaterialId) -> String {
    format!("medium of material {material}")
}

/// A colour above 1 has to be a volume's there.
fn homogeneous(absorption: Spectrum, scattering: Spectrum) -> Element {
    let extinction = absorption + scattering;
    let element = Element::new("medium", "homogeneous").rgb("albedo", share_scattered(scattering, extinction));
    if extinction.min_component() == extinction.max_component() {
        return element.float("sigma_t", extinction.r());
    }
    element.with(Element::new("volume", "constvolume").named("sigma_t").rgb("value", extinction))
}

/// The albedo; 0 where nothing is lost.
fn share_scattered(scattering: Spectrum, extinction: Spectrum) -> Spectrum {
    let share = |scattered: f64, lost: f64| if lost > 0.0 { scattered / lost } else { 0.0 };
    let ([red, green, blue], lost) = (scattering.to_rgb(), extinction.to_rgb());
    Spectrum::new(share(red, lost[0]), share(green, lost[1]), share(blue, lost[2]))
}

/// The grid with all values multiplied by a colour.
fn tinted(grid: &VoxelGrid, tint: Spectrum) -> VoxelGrid {
    let channels = grid.channels();
    let factors = tint.to_rgb();
    let is_grey = channels == 1 && tint.min_component() == tint.max_component();
    let count = if is_grey { 1 } else { 3 };
    let of_voxel = |voxel: &[f32]| -> Vec<f32> {
        (0..count).map(|channel| (f64::from(voxel[channel.min(channels - 1)]) * factors[channel]) as f32).collect()
    };
    let values = grid.values().chunks_exact(channels).flat_map(of_voxel).collect();
    // Factors of an albedo are at most 1, and those of a density too: its values stay possible.
    VoxelGrid::new(grid.resolution(), count, values).unwrap_or_else(|_| grid.clone())
}

/// Two at a time, each blend of what is before and of the next.
fn phase(Phase(lobes): &Phase) -> Element {
    let of_kind = |kind: PhaseKind| match kind {
        PhaseKind::HenyeyGreenstein { g: 0.0 } => Element::new("phase", "isotropic"),
        PhaseKind::HenyeyGreenstein { g } => Element::new("phase", "hg").float("g", g),
        PhaseKind::Rayleigh => Element::new("phase", "rayleigh"),
    };
    let mut so_far = 0.0;
    let mut made: Option<Element> = None;
    for PhaseLobe { weight, kind } in lobes {
        so_far += weight;
        let own = of_kind(*kind);
        made = Some(match made {
            Some(before) => Element::new("phase", "blendphase").float("weight", weight / so_far).with(before).with(own),
            None => own,
        });
    }
    made.unwrap_or_else(|| Element::new("phase", "isotropic"))
}

#[cfg(test)]
mod tests;
