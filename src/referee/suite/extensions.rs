//! glTF's extensions of materials, each on a sphere before a bright plate. Their truths are long renders: the extensions' texts leave no closed form.

use super::super::test::Test;
use super::stage::{emissive, light, material, shape, sized};

/// A sphere of these keys of `principled` between a lamp, a bright plate and a dim sky.
fn scene(keys: &str) -> String {
    let tables = [
        material("m", &format!("type = \"principled\"\n{keys}")),
        emissive("lamp", [10.0, 9.0, 8.0]),
        emissive("plate", [0.2, 0.9, 0.4]),
        shape("sphere", "m", "center = [0, 0, 0]\nradius = 0.8"),
        shape("rectangle", "lamp", "corner = [-1.5, 1.2, 1.5]\nedge_u = [1, 0, 0]\nedge_v = [0, 0.5, -0.8]\n"),
        shape("rectangle", "plate", "corner = [0, -1, -1.5]\nedge_u = [1, 0, 0]\nedge_v = [0, 2, 0]"),
        light("environment", "radiance = 0.3"),
    ];
    sized([32, 32], "position = [0, 0, 4]\nlook_at = [0, 0, 0]\nvfov = 28\n", &tables.concat())
}

/// A sphere of these keys before a white strip, whose edges show how far each colour is bent.
fn before_a_strip(keys: &str) -> String {
    let tables = [
        material("m", &format!("type = \"principled\"\n{keys}")),
        emissive("strip", [6.0; 3]),
        shape("sphere", "m", "center = [0, 0, 0]\nradius = 0.8"),
        shape("rectangle", "strip", "corner = [0.1, -1, -1.5]\nedge_u = [0.15, 0, 0]\nedge_v = [0, 2, 0]"),
        light("environment", "radiance = 0.3"),
    ];
    sized([32, 32], "position = [0, 0, 4]\nlook_at = [0, 0, 0]\nvfov = 28\n", &tables.concat())
}

pub fn tests() -> Vec<Test> {
    let of = |texts, keys: &str, words: &str, others: &str, cause| {
        Test::estimated(texts, scene(keys)).mistake_in_scene(cause, words, others)
    };
    vec![
        of(
            ["extensions/clearcoat", "A smooth coat on a rough red metal.", "KHR_materials_clearcoat"],
            "base_color = [0.8, 0.2, 0.1]\nmetallic = 1\nroughness = 0.7\nclearcoat = 1\nclearcoat_roughness = 0.1",
            "clearcoat = 1",
            "clearcoat = 0",
            "a coat that is left out",
        )
        .mistake_in_scene("a coat of the base's roughness", "clearcoat_roughness = 0.1", "clearcoat_roughness = 0.7"),
        of(
            ["extensions/sheen", "White fibres on a dark cloth.", "KHR_materials_sheen"],
            "base_color = [0.1, 0.1, 0.3]\nmetallic = 0\nroughness = 0.9\nsheen_color = 0.9\nsheen_roughness = 0.4",
            "sheen_color = 0.9",
            "sheen_color = 0",
            "a sheen that is left out",
        )
        .mistake_in_scene(
            "a roughness of the sheen that is squared once more",
            "sheen_roughness = 0.4",
            "sheen_roughness = 0.16",
        ),
        of(
            ["extensions/transmission", "A rough body of glass without thickness.", "KHR_materials_transmission"],
            "metallic = 0\nroughness = 0.4\ntransmission = 1\nthin = true\nbase_color = [0.9, 0.7, 0.9]",
            "transmission = 1",
            "transmission = 0",
            "transmission that is left out",
        ),
        of(
            ["extensions/volume", "A smooth body of glass that absorbs.", "KHR_materials_volume"],
            "metallic = 0\nroughness = 0\ntransmission = 1\nattenuation_color = [0.9, 0.4, 0.2]\nattenuation_distance = 0.8",
            "attenuation_distance = 0.8",
            "attenuation_distance = 80",
            "a volume that absorbs nothing",
        )
        .mistake_in_scene(
            "a body that is taken for a thin one",
            "transmission = 1\nattenuation_color = [0.9, 0.4, 0.2]\nattenuation_distance = 0.8",
            "transmission = 1\nthin = true",
        ),
        of(
            ["extensions/ior", "A smooth dielectric of index 2.", "KHR_materials_ior"],
            "base_color = [0.2, 0.3, 0.6]\nmetallic = 0\nroughness = 0.2\nior = 2",
            "ior = 2",
            "ior = 1.5",
            "an index of refraction that is left out",
        ),
        of(
            ["extensions/specular", "A dielectric whose reflection is coloured.", "KHR_materials_specular"],
            "base_color = [0.2, 0.3, 0.6]\nmetallic = 0\nroughness = 0.3\nspecular = 0.8\nspecular_color = [1, 0.5, 0.1]",
            "specular = 0.8",
            "specular = 0",
            "no specular reflection",
        )
        .mistake_in_scene(
            "a colour of the reflection that is left out",
            "specular_color = [1, 0.5, 0.1]",
            "specular_color = 1",
        ),
        of(
            ["extensions/iridescence", "A film of 420 nm on a metal.", "KHR_materials_iridescence"],
            "base_color = [0.7, 0.7, 0.7]\nmetallic = 1\nroughness = 0.3\nthin_film = 1\nthin_film_thickness = 420\nthin_film_ior = 1.4",
            "thin_film = 1\n",
            "thin_film = 0\n",
            "a film that is left out",
        ),
        of(
            ["extensions/anisotropy", "A brushed metal.", "KHR_materials_anisotropy"],
            "base_color = [0.9, 0.8, 0.6]\nmetallic = 1\nroughness = 0.4\nanisotropy = 0.8",
            "anisotropy = 0.8",
            "anisotropy = 0",
            "an anisotropy that is left out",
        )
        .mistake_in_scene(
            "a direction that is turned by a quarter",
            "anisotropy = 0.8",
            "anisotropy = 0.8\nanisotropy_rotation = 90",
        ),
        Test::estimated(
            [
                "extensions/dispersion",
                "A white strip behind a smooth body of glass whose index depends on the colour.",
                "KHR_materials_dispersion",
            ],
            before_a_strip("metallic = 0\nroughness = 0\ntransmission = 1\nior = 1.7\nabbe_number = 15"),
        )
        .mistake_in_scene("a dispersion that is left out", "abbe_number = 15", "abbe_number = 1500"),
        of(
            ["extensions/diffuse-transmission", "A sheet that scatters light through.", "KHR_materials_diffuse_transmission"],
            "base_color = [0.8, 0.7, 0.5]\nmetallic = 0\nroughness = 0.8\ndiffuse_transmission = 0.6\ndiffuse_transmission_color = [0.3, 0.8, 0.4]",
            "diffuse_transmission = 0.6",
            "diffuse_transmission = 0",
            "transmission that is left out",
        ),
        of(
            ["extensions/emissive-strength", "A surface that gives off more than 1.", "KHR_materials_emissive_strength"],
            "base_color = [0.2, 0.2, 0.2]\nmetallic = 0\nroughness = 0.5\nemission = [4, 2, 1]",
            "emission = [4, 2, 1]",
            "emission = [1, 0.5, 0.25]",
            "a strength that is left out",
        ),
    ]
}
