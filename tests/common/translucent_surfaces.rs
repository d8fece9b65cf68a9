//! A scene whose rays go on through null surfaces.

use std::path::Path;

use gpt::load;
use gpt::scene::Scene;

/// A sphere behind and among translucent surfaces that let three in four rays pass, under a lamp and an environment: paths whose vertices are two or three
/// more than their edges, and others at the same vertex that met no translucent surface.
pub fn translucent_surfaces() -> Scene {
    let sheet = |corner: &str| {
        format!(
            "[[shape]]\ntype = \"rectangle\"\nmaterial = \"veil\"\ncorner = {corner}\nedge_u = [2.4, 0, 0.3]\nedge_v = [0, 2.4, 0]\n"
        )
    };
    let text = format!(
        r#"
[film]
size = [40, 30]
[render]
max_depth = 5
[camera]
position = [0, 1.5, 6]
look_at = [0, 0.9, 0]
vfov = 40
[[material]]
name = "grey"
type = "diffuse"
reflectance = 0.6
[[material]]
name = "gone"
type = "pass"
[[material]]
name = "veil"
type = "blend"
materials = ["gone", "grey"]
weight = {{ type = "constant", value = 0.25 }}
[[material]]
name = "lamp"
type = "emissive"
radiance = [12, 11, 9]
two_sided = true
[[shape]]
type = "rectangle"
corner = [-5, 0, 5]
edge_u = [10, 0, 0]
edge_v = [0, 0, -10]
material = "grey"
[[shape]]
type = "sphere"
center = [0, 0.9, 0]
radius = 0.8
material = "grey"
[[shape]]
type = "disk"
center = [1, 3.5, 1]
normal = [0, -1, 0]
radius = 0.6
material = "lamp"
[[light]]
type = "environment"
radiance = [0.3, 0.4, 0.6]
{}{}{}"#,
        sheet("[-0.4, 0.1, 1.6]"),
        sheet("[-0.2, 0.2, 1.2]"),
        sheet("[-2.2, 0.1, -1.1]")
    );
    load::load_toml_str(&text, "translucent surfaces", Path::new(".")).unwrap_or_else(|error| panic!("{error}"))
}
