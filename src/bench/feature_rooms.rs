//! The features whose cost is measured, and the room that each is used in.

use std::collections::BTreeSet;

use super::scenes::Room;
use crate::plan::{PlanOptions, TraversalChoice};

/// A feature, and where it is used.
pub struct Feature {
    pub name: &'static str,
    pub(super) room: Room,
    /// Its switches can stand in a kernel of the plain room without changing that room's picture.
    can_stand_unused: bool,
    /// True if the feature needs the hierarchy: the plain room is then measured with one as well. Shapes that
    /// do not move may still stand outside of it, where few shapes are faster, so that the two differ by more
    /// than the feature.
    hierarchy: bool,
}

impl Feature {
    fn new(name: &'static str, room: Room) -> Self {
        Self { name, room, can_stand_unused: true, hierarchy: false }
    }

    /// A feature that replaces another way, such as a random number: its switches without it make another
    /// picture.
    fn another_way(name: &'static str, room: Room) -> Self {
        Self { can_stand_unused: false, ..Self::new(name, room) }
    }

    /// How a room is rendered, with these switches compiled in.
    pub(super) fn plan(&self, switches: &[&'static str]) -> PlanOptions {
        PlanOptions {
            traversal: if self.hierarchy { TraversalChoice::Bvh } else { TraversalChoice::Auto },
            compile_in: switches.to_vec(),
            ..PlanOptions::default()
        }
    }

    /// The switches that the feature brings in: those of its room that are not among those of the plain one.
    pub(super) fn switches(&self, plain: &BTreeSet<&'static str>, used: &BTreeSet<&'static str>) -> Vec<&'static str> {
        if self.can_stand_unused { used.difference(plain).copied().collect() } else { Vec::new() }
    }
}

/// All that are measured.
pub fn features() -> Vec<Feature> {
    [materials(), patterns(), others()].into_iter().flatten().collect()
}

fn materials() -> Vec<Feature> {
    let of = |(name, material)| Feature::new(name, Room { material, ..Room::default() });
    let mut all: Vec<Feature> = [
        ("mirror", "type = \"mirror\"\nreflectance = 0.9"),
        ("glass", "type = \"glass\"\nior = 1.5"),
        ("thin glass", "type = \"glass\"\nior = 1.5\nthin = true"),
        ("glossy", "type = \"glossy\"\nreflectance = 0.7\nexponent = 50"),
        ("phong", "type = \"phong\"\ndiffuse = 0.4\nspecular = 0.4\nexponent = 50"),
        ("conductor", "type = \"conductor\"\nreflectance = 0.9\nroughness = 0.4"),
        ("Beckmann conductor", "type = \"conductor\"\nreflectance = 0.9\nroughness = 0.4\ndistribution = \"beckmann\""),
        ("separable masking", "type = \"conductor\"\nreflectance = 0.9\nroughness = 0.4\nmasking = \"separable\""),
        ("anisotropic conductor", "type = \"conductor\"\nreflectance = 0.9\nroughness_u = 0.6\nroughness_v = 0.3"),
        ("rough glass", "type = \"rough_glass\"\nior = 1.5\nroughness = 0.4"),
        ("thin rough glass", "type = \"rough_glass\"\nior = 1.5\nroughness = 0.4\nthin = true"),
        ("plastic", "type = \"plastic\"\nreflectance = 0.6"),
        ("rough plastic", "type = \"plastic\"\nreflectance = 0.6\nroughness = 0.4"),
        ("principled, metal", "type = \"principled\"\nbase_color = 0.8\nroughness = 0.4"),
        ("principled, dielectric", "type = \"principled\"\nbase_color = 0.6\nmetallic = 0\nroughness = 0.4"),
        (
            "principled, coat and sheen",
            "type = \"principled\"\nbase_color = 0.6\nmetallic = 0\nroughness = 0.4\nclearcoat = 1\nsheen_color = 0.5",
        ),
        ("principled, transmission", "type = \"principled\"\nbase_color = 0.9\nmetallic = 0\nroughness = 0.4\ntransmission = 1"),
        ("opacity", "type = \"diffuse\"\nreflectance = 0.6\nopacity = 0.5"),
        ("one-sided", "type = \"diffuse\"\nreflectance = 0.6\ntwo_sided = false"),
    ]
    .map(of)
    .into();
    all.push(Feature::new(
        "blend of two lobes",
        Room {
            material: "type = \"blend\"\nmaterials = [\"white\", \"shine\"]\nweight = { type = \"fresnel\", ior = 1.5 }",
            more: "[[material]]\nname = \"shine\"\ntype = \"mirror\"\nreflectance = 1",
            ..Room::default()
        },
    ));
    all
}

/// Textures, and what is read from them.
fn patterns() -> Vec<Feature> {
    const COLOR: &str = "type = \"diffuse\"\nreflectance = { texture = \"pattern\" }";
    const CHECKER: &str = "[[texture]]\nname = \"pattern\"\ntype = \"checker\"\na = 0.2\nb = 0.8\nscale = [4, 4]";
    const MASK: &str = "[[texture]]\nname = \"pattern\"\ntype = \"checker\"\na = 0\nb = 1\nscale = [4, 4]";
    const PERLIN: &str = "[[texture]]\nname = \"pattern\"\ntype = \"perlin\"\na = 0.2\nb = 0.8\nscale = 4\noctaves = 4";
    const WORLEY: &str = "[[texture]]\nname = \"pattern\"\ntype = \"worley\"\na = 0.2\nb = 0.8\nscale = 4";
    [
        ("checker texture", COLOR, CHECKER),
        ("perlin texture", COLOR, PERLIN),
        ("worley texture", COLOR, WORLEY),
        ("cut-out", "type = \"diffuse\"\nreflectance = 0.6\nopacity = { texture = \"pattern\" }", MASK),
        ("bump map", "type = \"diffuse\"\nreflectance = 0.6\nbump_map = \"pattern\"\nbump_scale = 0.05", PERLIN),
    ]
    .map(|(name, material, more)| Feature::new(name, Room { material, more, ..Room::default() }))
    .into()
}

/// Shapes, lights, camera, film and random numbers.
fn others() -> Vec<Feature> {
    let plain = Room::default;
    vec![
        Feature::new(
            "sphere",
            Room { object: "type = \"sphere\"\ncenter = [-0.5, 0.7, -0.4]\nradius = 0.6\nmaterial = \"subject\"", ..plain() },
        ),
        Feature::new(
            "cylinder",
            Room {
                object: "type = \"cylinder\"\nfrom = [-0.5, 0, -0.4]\nto = [-0.5, 1.3, -0.4]\nradius = 0.4\nmaterial = \"subject\"",
                ..plain()
            },
        ),
        Feature::new(
            "point light",
            Room { more: "[[light]]\ntype = \"point\"\nposition = [0, 1.8, 1]\nintensity = 1", ..plain() },
        ),
        Feature::new(
            "spot light",
            Room {
                more: "[[light]]\ntype = \"spot\"\nposition = [0, 1.8, 1]\ndirection = [0, -1, -0.5]\nintensity = 1\nangle = 40",
                ..plain()
            },
        ),
        Feature::new(
            "sky",
            Room {
                more: "[[light]]\ntype = \"sky\"\nzenith = [0.4, 0.7, 1.6]\nhorizon = [1.5, 1.4, 1.2]\nground = [0.2, 0.2, 0.15]",
                ..plain()
            },
        ),
        Feature::new("lens", Room { camera: "aperture = { shape = \"disk\", radius = 0.05 }\nfocus_distance = 4.4", ..plain() }),
        Feature::another_way("gaussian filter", Room { film: "filter = { type = \"gaussian\", radius = 1.5 }", ..plain() }),
        Feature::another_way("halton sampler", Room { render: "sampler = \"halton\"", ..plain() }),
        Feature::another_way("independent sampler", Room { render: "sampler = \"independent\"", ..plain() }),
        Feature {
            hierarchy: true,
            ..Feature::new(
                "motion",
                Room {
                    camera: "shutter = [0, 1]",
                    object: "type = \"box\"\nmin = [-0.9, 0, -0.8]\nmax = [-0.1, 1.3, 0]\nmaterial = \"subject\"\n\
                             motion = [{ translate = [0.1, 0.1, 0] }]",
                    ..plain()
                },
            )
        },
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::packed::PackedScene;
    use crate::plan::{DeviceLimits, Plan};

    fn enabled(room: &Room, options: &PlanOptions) -> BTreeSet<&'static str> {
        let scene = room.scene().expect("it is sound");
        let packed = PackedScene::new(&scene).expect("it is small");
        Plan::new(&scene, &packed, &DeviceLimits::default(), options).expect("its switches go together").switches.enabled
    }

    /// Every room brings something in that the plain room does not have, and that kernels of the plain room can hold.
    #[test]
    fn rooms_use_what_they_are_named_for() {
        for feature in features() {
            let [off, used] = [&Room::default(), &feature.room].map(|room| enabled(room, &feature.plan(&[])));
            let switches = feature.switches(&off, &used);
            assert_eq!(switches.is_empty(), !feature.can_stand_unused, "{}: {switches:?}", feature.name);
            let compiled = enabled(&Room::default(), &feature.plan(&switches));
            assert!(switches.iter().all(|switch| compiled.contains(switch)), "{}", feature.name);
        }
    }
}
