//! The scene that tests of files and of the program begin with.

/// A grey sphere before the camera, with these tables before and after it: film and settings, lights.
pub fn grey_sphere(settings: &str, light: &str) -> String {
    format!(
        r#"
{settings}
[camera]
position = [0, 0, 4]
look_at = [0, 0, 0]
vfov = 40
[[material]]
name = "grey"
type = "diffuse"
reflectance = 0.5
[[shape]]
type = "sphere"
center = [0, 0, 0]
radius = 1
material = "grey"
[[light]]
{light}
"#
    )
}
