// Light links: which receivers a lamp lights, as bits of a mask, and which receiver a surface or a place within a medium is. src/packed/links.rs
// packs them, four numbers in a vec4 of the tables.
#import core/layout.wgsl
#import geometry/scene.wgsl

// A lamp with this mask lights this receiver. The camera sees all lamps.
fn mask_lights(mask: u32, receiver: u32) -> bool {
    return receiver == SEES_ALL_LAMPS || ((mask >> receiver) & 1u) != 0u;
}

fn link_number(index: u32) -> u32 {
    return bitcast<vec4<u32>>(tables[FIRST_LINK_WORD + (index >> 2u)])[index & 3u];
}

// The mask of surfaces of a packed material.
fn link_of_material(material: u32) -> u32 {
    return link_number(material);
}

fn receiver_of_material(material: u32) -> u32 {
    return link_number(LINK_RECEIVERS + material);
}

fn link_of_light(light: u32) -> u32 {
    return link_number(LINK_LIGHTS + light);
}

fn receiver_of_instance(instance: u32) -> u32 {
    return link_number(LINK_INSTANCES + instance);
}

// The receiver of places within the medium of a number, which is not 0.
fn receiver_of_medium(medium: u32) -> u32 {
    return link_number(LINK_MEDIA + medium - 1u);
}
