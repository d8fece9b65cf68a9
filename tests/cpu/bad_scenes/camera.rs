//! Films and cameras that are wrong.

use super::check;

#[test]
fn films_and_cameras_that_cannot_be_are_refused() {
    check(&[
        (
            "size = [4, 4]",
            "filter = { type = \"tent\", radius = 0 }",
            "test.toml:3:36: film.filter.radius: expected a number from 0.5 to 16 (pixels), found 0",
        ),
        (
            "size = [4, 4]",
            "filter = { type = \"gaussian\", radius = -1 }",
            "test.toml:3:40: film.filter.radius: expected a number from 0.5 to 16 (pixels), found -1",
        ),
        (
            "spp = 1",
            "pixel_sampler = \"nothing\"",
            "test.toml:5:17: render.pixel_sampler: `nothing` is not a valid choice [valid choices: independent, stratified, quadrant, halton, sobol, shared_strata, hammersley, lcg, none, same]",
        ),
        (
            "spp = 1",
            "blend = \"mixtur\"",
            "test.toml:5:9: render.blend: `mixtur` is not a valid choice [did you mean `mixture`? valid choices: mixture, pick]",
        ),
        ("vfov = 40", "vfov = 40\nshutter = [1, 0.5]", "test.toml:10:11: camera.shutter: the shutter closes before it opens"),
        (
            "vfov = 40",
            "vfov = 40\nfocus_distance = 0",
            "test.toml:10:18: camera.focus_distance: expected a number above 0, found 0",
        ),
        (
            "vfov = 40",
            "vfov = 40\nfocus_distance = -2",
            "test.toml:10:18: camera.focus_distance: expected a number above 0, found -2",
        ),
        (
            "vfov = 40",
            "vfov = 40\naperture = { shape = \"disk\", radius = 0.1 }",
            "test.toml:10:12: camera.aperture: an aperture needs the key `focus_distance`",
        ),
        (
            "vfov = 40",
            "vfov = 40\nfocus_distance = 1\naperture = { shape = \"disk\", radius = -0.1 }",
            "test.toml:11:39: camera.aperture.radius: expected a number from 0 to 1e18, found -0.1",
        ),
        (
            "vfov = 40",
            "vfov = 40\nfocus_distance = 1\naperture = { shape = \"polygon\", radius = 0.1, blades = 2 }",
            "test.toml:11:56: camera.aperture.blades: an aperture has 3 to 64 blades",
        ),
        (
            "vfov = 40",
            "vfov = 40\nfocus_distance = 1\naperture = { shape = \"star\", radius = 0.1 }",
            "test.toml:11:22: camera.aperture.shape: `star` is not a valid choice [valid choices: disk, square, polygon]",
        ),
        (
            "vfov = 40",
            "vfov = 40\nprojection = \"orthographic\"",
            "test.toml:9:8: camera.vfov: `vfov` belongs to projection = \"perspective\"",
        ),
        ("vfov = 40", "projection = \"orthographic\"", "test.toml:8:11: camera.look_at: the camera needs the key `height`"),
        (
            "vfov = 40",
            "projection = \"orthographic\"\nheight = 0",
            "test.toml:10:10: camera.height: expected a number above 0, found 0",
        ),
    ]);
}
