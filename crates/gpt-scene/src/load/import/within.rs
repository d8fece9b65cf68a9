//! A description as part of another scene.

use glam::{DAffine3, DMat3, DVec3};

use super::description::{Description, map_of};
use super::maps::is_uniform;
use crate::load::file::light::{LightEntry, environment};
use crate::load::file::node::NodeEntry;
use crate::load::file::shape::{ShapeEntry, TransformEntry};
use crate::load::file::value::{Exactly, Located, Number, Vector, vector};
use crate::load::place::Place;
use crate::scene::light::is_rotation;
use crate::spectrum::Spectrum;

impl Description {
    /// Moves all of it; `place` says where the map is stated.
    ///
    /// # Errors
    /// A sentence about a number that is out of range.
    pub fn transform_by(&mut self, map: &DAffine3, place: &Place) -> Result<(), String> {
        let shapes = self.file.shape.iter_mut().map(|shape| shape.value.common_mut().transform);
        for transform in shapes.chain(self.file.instance.iter_mut().map(|instance| &mut instance.value.transform)) {
            *transform = TransformEntry::of_map(&(*map * map_of(transform.as_ref())), place)?;
        }
        self.transform_nodes(map, place)?;
        self.scale_media(map.matrix3.determinant().abs().cbrt())?;
        self.move_grids(map, place)?;
        if !self.file.medium.is_empty() && !is_uniform(map) {
            let instead = "they are as dense as under an even scale of the same volume";
            self.report.approximate(
                "media of an import that is scaled unevenly",
                self.file.medium[0].name.place.to_string(),
                instead,
            );
        }
        if let Some(camera) = &mut self.file.camera {
            move_point(map, &mut camera.position)?;
            move_point(map, &mut camera.look_at.value)?;
            camera.up.as_mut().map_or(Ok(()), |up| turn(map, &mut up.value))?;
        }
        self.file.meter.iter_mut().try_for_each(|meter| meter.value.transform_by(map))?;
        let rotation = rotation_of(map);
        for light in &mut self.file.light {
            match &mut light.value {
                LightEntry::Point(keys) => move_point(map, &mut keys.position)?,
                LightEntry::Directional(keys) => turn(map, &mut keys.direction.value)?,
                LightEntry::Spot(keys) => {
                    move_point(map, &mut keys.position)?;
                    turn(map, &mut keys.direction.value)?;
                    keys.up.as_mut().map_or(Ok(()), |up| turn(map, &mut up.value))?;
                }
                LightEntry::Projector(keys) => {
                    move_point(map, &mut keys.position)?;
                    turn(map, &mut keys.direction.value)?;
                    keys.up.as_mut().map_or(Ok(()), |up| turn(map, &mut up.value))?;
                }
                LightEntry::Environment(keys) => {
                    if let Some(rotation) = rotation {
                        turn_map(&rotation, keys, place)?;
                    }
                }
                LightEntry::Sky(_) => {}
            }
        }
        let is_map = |light: &&Located<LightEntry>| matches!(&light.value, LightEntry::Environment(keys) if keys.file.is_some());
        if let (None, Some(light)) = (rotation, self.file.light.iter().find(is_map)) {
            let instead = "it stands as before";
            self.report.approximate(
                "environment map of a scene that is mirrored or scaled unevenly",
                light.place.to_string(),
                instead,
            );
        }
        Ok(())
    }

    /// Keeps what light loses on its way through bodies that are this many times as large.
    fn scale_media(&mut self, factor: f64) -> Result<(), String> {
        let scaled = |spectrum: &mut Spectrum, by: f64| {
            *spectrum *= by;
            let well = spectrum.max_component().is_finite();
            well.then_some(()).ok_or_else(|| "the map makes media denser than numbers can say".to_owned())
        };
        for medium in &mut self.file.medium {
            for value in [&mut medium.absorption, &mut medium.scattering].into_iter().flatten() {
                scaled(&mut value.value.0, 1.0 / factor)?;
            }
            medium.emission.as_mut().map_or(Ok(()), |value| scaled(&mut value.0, 1.0 / factor))?;
            medium.mean_free_path.as_mut().map_or(Ok(()), |value| scaled(&mut value.value.0, factor))?;
        }
        Ok(())
    }

    /// Moves grids, which stand in the space of the scene.
    fn move_grids(&mut self, map: &DAffine3, place: &Place) -> Result<(), String> {
        for medium in &mut self.file.medium {
            let grids = [&mut medium.density, &mut medium.albedo_grid, &mut medium.emission_grid, &mut medium.temperature];
            for grid in grids.into_iter().flatten() {
                let transform = &mut grid.value.transform;
                *transform = TransformEntry::of_map(&(*map * map_of(transform.as_ref())), place)?;
            }
        }
        Ok(())
    }

    /// Puts the nodes into one that stands where all is moved to: what they take along is moved already.
    fn transform_nodes(&mut self, map: &DAffine3, place: &Place) -> Result<(), String> {
        if self.file.node.is_empty() {
            return Ok(());
        }
        let Some(transform) = TransformEntry::of_map(map, place)? else { return Ok(()) };
        let name = place.at(self.free_node_name("(placed)"));
        for node in self.file.node.iter_mut().filter(|node| node.value.parent.is_none()) {
            node.value.parent = Some(name.clone());
        }
        let node = NodeEntry { name, parent: None, transform: Some(transform), keyframes: None, interpolation: None };
        self.file.node.push(place.at(node));
        Ok(())
    }

    /// A scene has one environment: keeps its own only where that is `open`, and says whether it still is.
    pub fn keep_environment(&mut self, open: bool) -> bool {
        let mut is_open = open;
        let mut left_out = Vec::new();
        self.file.light.retain(|light| {
            let keeps = !light.value.is_environment() || std::mem::replace(&mut is_open, false);
            if !keeps {
                left_out.push(light.place.to_string());
            }
            keeps
        });
        for place in left_out {
            self.report.drop("environment of an imported file", place, "the scene has another one");
        }
        is_open
    }

    /// Lets shapes and blends have a material of the scene around in place of one of its own. Whether it has that one.
    pub fn replace_material(&mut self, theirs: &str, ours: &Located<String>) -> bool {
        let before = self.file.material.len();
        self.file.material.retain(|entry| entry.name() != theirs);
        let variants = &self.material_variants;
        let replace = |name: &mut Located<String>| {
            if name.value == theirs || variants.get(&name.value).is_some_and(|of| of == theirs) {
                *name = ours.clone();
            }
        };
        let of_groups = self.file.group.iter_mut().flat_map(|group| &mut group.shape);
        let shapes = self.file.shape.iter_mut().chain(of_groups);
        shapes.filter_map(|shape| shape.value.common_mut().material.as_mut()).for_each(replace);
        self.file.material.iter_mut().flat_map(|entry| entry.parts_mut()).for_each(replace);
        self.file.material.len() < before
    }

    /// Puts `prefix` before all names, so that they are not those of the scene around.
    pub fn prefix_names(&mut self, prefix: &str) {
        let add = |name: &mut String| name.insert_str(0, prefix);
        let add_to = |name: &mut Option<Located<String>>| name.iter_mut().for_each(|name| add(&mut name.value));
        for texture in &mut self.file.texture {
            let common = texture.common_mut();
            add(&mut common.name.value);
            common.times.iter_mut().for_each(|times| add(&mut times.value.0));
        }
        for material in &mut self.file.material {
            add(&mut material.common_mut().name.value);
            material.each_texture(&mut |name| add(name));
            material.parts_mut().iter_mut().for_each(|part| add(&mut part.value));
            add_to(material.common_mut().interior);
        }
        self.file.medium.iter_mut().for_each(|medium| add(&mut medium.name.value));
        let of_groups = self.file.group.iter_mut().flat_map(|group| &mut group.shape);
        for shape in self.file.shape.iter_mut().chain(of_groups) {
            let common = shape.value.common_mut();
            add_to(common.material);
            add_to(common.node);
            if let ShapeEntry::Mesh(keys) = &mut shape.value {
                let joints = keys.deformation.iter_mut().flat_map(|deformation| &mut deformation.value.joints);
                joints.flat_map(|joints| &mut joints.value).for_each(|joint| add_to(&mut joint.node));
            }
        }
        self.file.group.iter_mut().for_each(|group| add(&mut group.name.value));
        for instance in &mut self.file.instance {
            add(&mut instance.value.group.value);
            add_to(&mut instance.value.material);
        }
        for node in &mut self.file.node {
            add(&mut node.value.name.value);
            add_to(&mut node.value.parent);
        }
        if let Some(camera) = &mut self.file.camera {
            add_to(&mut camera.node);
            add_to(&mut camera.medium);
        }
        for meter in &mut self.file.meter {
            add(&mut meter.value.name_mut().value);
            meter.value.medium_mut().into_iter().for_each(add_to);
        }
        for light in &mut self.file.light {
            light.value.node_mut().into_iter().for_each(add_to);
            light.value.texture_mut().into_iter().for_each(|texture| add(&mut texture.value.0));
        }
        let variants = std::mem::take(&mut self.material_variants);
        self.material_variants =
            variants.into_iter().map(|(of, is)| (format!("{prefix}{of}"), format!("{prefix}{is}"))).collect();
    }
}

fn move_point(map: &DAffine3, point: &mut Vector) -> Result<(), String> {
    *point = Exactly::of(map.transform_point3(vector(*point)).to_array())?;
    Ok(())
}

fn turn(map: &DAffine3, direction: &mut Vector) -> Result<(), String> {
    let before = vector(*direction);
    *direction = Exactly::of((map.matrix3 * before).normalize_or(before).to_array())?;
    Ok(())
}

/// The rotation that is in a map; None of a map that mirrors or shears.
fn rotation_of(map: &DAffine3) -> Option<DMat3> {
    let DMat3 { x_axis, y_axis, z_axis } = map.matrix3;
    let [x, y, z] = [x_axis, y_axis, z_axis].map(|axis| axis.normalize_or_zero());
    Some(DMat3::from_cols(x, y, z)).filter(is_rotation)
}

/// Turns the map of an environment: about +Y by its angle there, about another axis by its transform.
fn turn_map(rotation: &DMat3, keys: &mut environment::Keys, place: &Place) -> Result<(), String> {
    if keys.file.is_none() || *rotation == DMat3::IDENTITY {
        return Ok(());
    }
    if keys.transform.is_none() && (rotation.y_axis - DVec3::Y).length() < 1e-9 {
        let degrees = (-rotation.x_axis.z).atan2(rotation.x_axis.x).to_degrees();
        keys.rotate = Some(Number::of(keys.rotate.map_or(0.0, |rotate| rotate.0) + degrees)?);
        return Ok(());
    }
    let turned = DAffine3::from_mat3(*rotation) * map_of(keys.transform.as_ref());
    keys.transform = TransformEntry::of_map(&turned, place)?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::load::file::Document;

    #[test]
    fn media_keep_their_optical_depth_and_get_the_prefix() {
        let text = "[camera]\nposition = [0, 0, 1]\nlook_at = [0, 0, 0]\nvfov = 40\nmedium = \"fog\"\n\
            [[medium]]\nname = \"fog\"\nabsorption = 1\nscattering = 2\nemission = 3\n\
            [[medium]]\nname = \"milk\"\nalbedo = 0.5\nmean_free_path = 4\n\
            [[material]]\nname = \"skin\"\ntype = \"pass\"\ninterior = \"milk\"\n";
        let file = Document::new("a.toml", text).read_whole().expect("a scene");
        let mut description = Description::default();
        description.file = file;
        description.transform_by(&DAffine3::from_scale(DVec3::splat(2.0)), &(0..1).into()).expect("it is in range");
        description.prefix_names("a/");
        let file = &mut description.file;
        let red = |spectrum: Spectrum| spectrum.max_component();
        let [fog, milk] = &file.medium[..] else { panic!("two media") };
        let of = |value: &Option<Located<_>>| {
            value.as_ref().map(|value: &Located<crate::load::file::colour::Rgb<_>>| red(value.value.0))
        };
        assert_eq!([of(&fog.absorption), of(&fog.scattering)], [Some(0.5), Some(1.0)]);
        assert_eq!(fog.emission.as_ref().map(|value| red(value.0)), Some(1.5));
        assert_eq!(milk.mean_free_path.as_ref().map(|value| red(value.value.0)), Some(8.0));
        assert_eq!(milk.albedo.as_ref().map(|value| red(value.value.0)), Some(0.5));
        assert_eq!([&*fog.name.value, &*milk.name.value], ["a/fog", "a/milk"]);
        let named = |name: &Option<Located<String>>| name.as_ref().map(|name| name.value.clone());
        assert_eq!(named(file.material[0].common_mut().interior).as_deref(), Some("a/milk"));
        assert_eq!(named(&file.camera.as_ref().expect("a camera").medium).as_deref(), Some("a/fog"));
    }
}
