//! The tables of a scene file, in their order.

use std::path::Path;

use super::needed::Needed;
use super::{animation, material, settings, shape, texture};
use crate::load::file::writer::{Names, SideFiles, Writer, line, text as quoted};
use crate::load::file::{FORMAT_VERSION, write_light, write_light_group, write_link, write_medium, write_meter, write_receiver};
use crate::scene::Scene;

/// The text of the scene file that would lie at `path`. Pictures that cannot be read are named, unless colours are to be written in their place.
pub fn scene_text(scene: &Scene, path: &Path, names_unreadable: bool) -> (String, SideFiles) {
    let needed = Needed::of(scene);
    let animation = &scene.animation;
    let mut writer = Writer {
        scene,
        textures: Names::unique(scene.textures.iter().map(|texture| texture.name.as_str()), "texture"),
        materials: Names::unique(scene.materials.iter().map(|material| material.name.as_str()), "material"),
        media: Names::unique(scene.media.iter().map(|medium| medium.name.as_str()), "medium"),
        groups: Names::unique(scene.groups.iter().map(|group| group.name.as_str()), "group"),
        nodes: Names::unique(animation.nodes.iter().map(|node| node.name.as_str()), "node"),
        files: SideFiles::beside(path),
        names_unreadable,
    };
    let mut text = line("version", &FORMAT_VERSION.to_string()) + "\n" + &settings::settings(&writer);
    // The camera's table is the last.
    let of_camera = animation.camera.as_ref();
    text += &of_camera.map_or_else(String::new, |track| animation::camera(track, scene.camera.projection, &writer.nodes));
    text += &animation::animation(animation, &writer.nodes);
    for id in needed.textures() {
        text.push_str(&texture::texture(id, &mut writer));
    }
    for (id, medium) in scene.media.iter().enumerate() {
        let keys = write_medium(medium, &mut writer)
            + &write_light_group(scene.light_groups.of_medium(id), &writer)
            + &write_receiver(scene.light_links.of_medium(id), &writer);
        text.push_str(&format!("\n[[medium]]\n{}{keys}", line("name", &writer.media.quoted(id))));
    }
    for id in needed.materials() {
        text.push_str(&material::material(id, &writer));
    }
    for (index, shape) in scene.shapes.iter().enumerate() {
        text.push_str(&shape::shape("[[shape]]", shape, &mut writer));
        let tracks = animation.shapes.iter().filter(|track| track.shape == index);
        tracks.for_each(|track| text.push_str(&animation::shape(track, &writer.nodes)));
    }
    for (index, group) in scene.groups.iter().enumerate() {
        text.push_str(&shape::group(index, group, &mut writer));
    }
    for instances in &scene.instances {
        text.push_str(&shape::instances(instances, &mut writer));
    }
    for (index, light) in scene.lights.iter().enumerate() {
        let keys = write_light(light, &mut writer)
            + &write_light_group(scene.light_groups.of_light(index), &writer)
            + &write_link(scene.light_links.of_light(index), &writer);
        text.push_str(&format!("\n[[light]]\n{}{keys}", line("type", &quoted(light.kind_name()))));
        let tracks = animation.lights.iter().filter(|track| track.light == index);
        tracks.for_each(|track| text.push_str(&animation::light(track, light, &writer.nodes)));
    }
    for meter in &scene.meters {
        text.push_str(&write_meter(meter, &writer));
    }
    (text, writer.files)
}
