//! EXT_lights_ies: points that shine as photometric files say. Their candela are taken for watts per steradian, as those of other lights are.

use glam::{DAffine3, DVec3};
use serde_json::Value;

use super::buffers::{file_of, read_uri};
use super::importer::Importer;
use super::json::Node;
use crate::load::file::colour::Rgb;
use crate::load::file::light::profile::ProfileEntry;
use crate::load::file::light::{LightEntry, point};
use crate::load::file::reference::FileOr;
use crate::load::file::value::Exactly;
use crate::load::image_file::EmbeddedFile;
use crate::load::import::world_direction;
use crate::spectrum::Spectrum;

const NAME: &str = "EXT_lights_ies";

impl Importer<'_> {
    /// The light at a node, which shines along its -Z; horizontal angle 0 lies on the side of its +X.
    pub fn light_with_profile(&mut self, node: &Node, map: DAffine3, index: usize) -> Result<(), String> {
        let Some(reference) = node.extensions.get(NAME) else { return Ok(()) };
        let number = reference.get("light").and_then(Value::as_u64).ok_or_else(|| format!("{NAME}: it names no light"))?;
        let file = self.profile(number as usize)?;
        let key = format!("nodes[{index}]");
        let of = |name: &str| reference.get(name).filter(|value| !value.is_null());
        let channels = |value: &Value| <[f64; 3] as serde::Deserialize>::deserialize(value).ok();
        let tint =
            of("color").map_or(Some([1.0; 3]), channels).ok_or_else(|| format!("{NAME}: its color is not three numbers"))?;
        let factor =
            of("multiplier").map_or(Some(1.0), Value::as_f64).ok_or_else(|| format!("{NAME}: its multiplier is not a number"))?;
        let stated = Spectrum::from_rgb(tint) * factor;
        if !stated.is_finite() {
            return Err(format!("{NAME}: its light is out of range"));
        }
        let intensity = Spectrum::from_rgb(tint.map(|channel| channel.clamp(0.0, 1.0))) * factor.max(0.0);
        if intensity != stated {
            self.approximate("light of a profile", &key, "its color is taken within 0 and 1, and its multiplier from 0 on");
        }
        if map.matrix3.determinant() < 0.0 {
            self.approximate("light of a profile that is mirrored", &key, "it is not mirrored");
        }
        let [direction, front] = [DVec3::NEG_Z, DVec3::X].map(|axis| world_direction(&map, axis));
        let (direction, front) = direction.zip(front).ok_or("its transform leaves no direction")?;
        let place = self.place(&key);
        let keys = point::Keys {
            position: Exactly::of(map.translation.to_array())?,
            intensity: Rgb::of(intensity)?,
            profile: Some(place.at(ProfileEntry::File(file))),
            direction: Some(place.at(Exactly::of(direction.to_array())?)),
            front: Some(place.at(Exactly::of(front.to_array())?)),
            keyframes: None,
            interpolation: None,
            node: None,
            light_group: None,
            lights_only: None,
            lights_all_but: None,
        };
        self.scene.file.light.push(place.at(LightEntry::Point(keys)));
        Ok(())
    }

    /// The file of a profile, once for all nodes that name it.
    fn profile(&mut self, number: usize) -> Result<FileOr<EmbeddedFile>, String> {
        if let Some(file) = self.profiles.get(&number) {
            return Ok(file.clone());
        }
        let lights = self.root.extensions.get(NAME).and_then(|lights| lights.get("lights"));
        let light = lights.and_then(|lights| lights.get(number)).ok_or_else(|| format!("there is no {NAME}.lights[{number}]"))?;
        let of_light = |message: String| format!("{NAME}.lights[{number}]: {message}");
        let embedded = |bytes: Vec<u8>| {
            let name = format!("{}: {NAME}.lights[{number}]", self.name);
            FileOr::InMemory(EmbeddedFile { name, bytes: bytes.into() }.into())
        };
        let file = match (light.get("uri").and_then(Value::as_str), light.get("bufferView").and_then(Value::as_u64)) {
            (Some(uri), _) if !uri.starts_with("data:") => {
                FileOr::OnDisk(file_of(self.files, &self.folder, uri).map_err(of_light)?)
            }
            (Some(uri), _) => embedded(read_uri(self.files, &self.folder, uri).map_err(of_light)?.1),
            (None, Some(view)) => embedded(self.buffers.view(view as usize).map_err(of_light)?.to_vec()),
            (None, None) => return Err(of_light("it names no file and no bufferView".to_owned())),
        };
        self.profiles.insert(number, file.clone());
        Ok(file)
    }
}
