//! Cameras, tables and screens that scenes of the suite share.

use std::fmt::Write;

use super::super::formulas::normalized;

/// Vertical field of view of the frontal camera, by which it sees [−1, 1]² at z = 0 from a distance of 4: 2·atan(1/4).
const FRONTAL_VFOV: f64 = 28.072_486_935_852_957;
/// Height of the camera that looks along a plane, and its distance from the point it looks at.
const GRAZING: [f64; 2] = [1.0, 3.0];

/// A scene of 64 × 64 pixels with this camera table and these other tables.
pub fn scene(camera: &str, tables: &str) -> String {
    sized([64, 64], camera, tables)
}

/// A scene with a film of this size.
pub fn sized([width, height]: [u32; 2], camera: &str, tables: &str) -> String {
    format!("[film]\nsize = [{width}, {height}]\n\n[render]\nspp = 256\nmax_depth = 64\n\n[camera]\n{camera}\n{tables}")
}

/// A scene seen from (0, 0, 4), whose film is the square [−1, 1]² of the plane z = 0; y is up.
pub fn frontal(tables: &str) -> String {
    scene(&frontal_camera(), tables)
}

/// The camera of [`frontal`].
pub fn frontal_camera() -> String {
    format!("position = [0, 0, 4]\nlook_at = [0, 0, 0]\nvfov = {FRONTAL_VFOV}\n")
}

/// x and y at z = 0 of a point of the frontal film.
pub fn on_plane(s: f64, t: f64) -> [f64; 2] {
    [2.0 * s - 1.0, 1.0 - 2.0 * t]
}

/// A rectangle that fills the frontal film, its front towards the camera, (u, v) from the lower left corner; of the material `m`.
pub const SCREEN: &str = r#"
[[shape]]
type = "rectangle"
corner = [-1, -1, 0]
edge_u = [2, 0, 0]
edge_v = [0, 2, 0]
material = "m"
"#;

/// A scene of a wide plane z = 0 of the material `m` that is seen at grazing angles.
pub fn grazing(tables: &str) -> String {
    let plane = shape("rectangle", "m", "corner = [-80, -80, 0]\nedge_u = [160, 0, 0]\nedge_v = [0, 160, 0]");
    grazing_camera_scene(&format!("{tables}{plane}"))
}

/// A scene seen from (0, −3, 1), whose camera looks at the origin; z is up.
pub fn grazing_camera_scene(tables: &str) -> String {
    let [height, distance] = GRAZING;
    let camera = format!("position = [0, {}, {height}]\nlook_at = [0, 0, 0]\nup = [0, 0, 1]\nvfov = {FRONTAL_VFOV}\n", -distance);
    scene(&camera, tables)
}

/// x and y at z = 0 of a point of the grazing camera's film.
pub fn on_grazed_plane(s: f64, t: f64) -> [f64; 2] {
    let direction = grazing_direction(s, t);
    let [height, distance] = GRAZING;
    let way = -height / direction[2];
    [way * direction[0], way * direction[1] - distance]
}

/// The direction in which a ray of the grazing camera leaves it.
pub fn grazing_direction(s: f64, t: f64) -> [f64; 3] {
    let [height, distance] = GRAZING;
    let forward = normalized([0.0, distance, -height]);
    // The picture's upward direction is across the axis: right is x.
    let up = [0.0, -forward[2], forward[1]];
    let half = 0.25;
    let (right, above) = (half * (2.0 * s - 1.0), half * (1.0 - 2.0 * t));
    normalized(std::array::from_fn(|axis| forward[axis] + right * [1.0, 0.0, 0.0][axis] + above * up[axis]))
}

/// A material table with this name and these keys.
pub fn material(name: &str, keys: &str) -> String {
    format!("[[material]]\nname = \"{name}\"\n{keys}\n")
}

/// The material `m`, diffuse.
pub fn diffuse(reflectance: f64) -> String {
    material("m", &format!("type = \"diffuse\"\nreflectance = {reflectance}"))
}

/// A light table.
pub fn light(kind: &str, keys: &str) -> String {
    format!("[[light]]\ntype = \"{kind}\"\n{keys}\n")
}

/// A material of this name that gives off light and reflects none.
pub fn emissive(name: &str, [r, g, b]: [f64; 3]) -> String {
    material(name, &format!("type = \"emissive\"\nradiance = [{r}, {g}, {b}]"))
}

/// A shape table.
pub fn shape(kind: &str, material: &str, keys: &str) -> String {
    format!("[[shape]]\ntype = \"{kind}\"\nmaterial = \"{material}\"\n{keys}\n")
}

/// A mesh of triangles that fan out from the first corner.
pub fn fan(material: &str, corners: &[[f64; 3]], keys: &str) -> String {
    let mut faces = String::new();
    for last in 2..corners.len() {
        let comma = if last > 2 { ", " } else { "" };
        let _ = write!(faces, "{comma}[0, {}, {last}]", last - 1);
    }
    shape("mesh", material, &format!("positions = {corners:?}\nfaces = [{faces}]\n{keys}"))
}

/// A rectangle across z that gives off light towards the camera, from its lower left to its upper right corner.
pub fn bright_rectangle([x0, y0]: [f64; 2], [x1, y1]: [f64; 2], z: f64, keys: &str) -> String {
    shape(
        "rectangle",
        "bright",
        &format!("corner = [{x0}, {y0}, {z}]\nedge_u = [{}, 0, 0]\nedge_v = [0, {}, 0]\n{keys}", x1 - x0, y1 - y0),
    )
}

/// Each channel times a factor.
pub fn scaled(color: [f64; 3], factor: f64) -> [f64; 3] {
    color.map(|channel| channel * factor)
}
