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

#[test]
fn cameras_whose_picture_is_not_flat_are_checked() {
    check(&[
        (
            "vfov = 40",
            "projection = \"equirectangular\"\nazimuth = [20, -20]",
            "test.toml:10:11: camera.azimuth: its azimuths must rise, by 360 degrees at most, and lie from -360 to 360; they are 20 and -20",
        ),
        (
            "vfov = 40",
            "projection = \"equirectangular\"\nazimuth = [-360, 90]",
            "test.toml:10:11: camera.azimuth: its azimuths must rise, by 360 degrees at most, and lie from -360 to 360; they are -360 and 90",
        ),
        (
            "vfov = 40",
            "projection = \"equirectangular\"\nazimuth = [-400, 90]",
            "test.toml:10:12: camera.azimuth[0]: expected an angle from -360 to 360 (degrees), found -400",
        ),
        (
            "vfov = 40",
            "projection = \"equirectangular\"\nelevation = [20, 20]",
            "test.toml:10:13: camera.elevation: its elevations must rise, and lie from -90 to 90 degrees; they are 20 and 20",
        ),
        (
            "vfov = 40",
            "projection = \"cylindrical\"\nelevation = [-90, 0]",
            "test.toml:10:13: camera.elevation: its elevations must rise, and lie from -89.9 to 89.9 degrees; they are -90 and 0",
        ),
        (
            "vfov = 40",
            "projection = \"cylindrical\"\nelevation = [-91, 0]",
            "test.toml:10:14: camera.elevation[0]: expected an angle from -90 to 90 (degrees), found -91",
        ),
        (
            "vfov = 40",
            "vfov = 40\nazimuth = [0, 20]",
            "test.toml:10:11: camera.azimuth: `azimuth` belongs to projection = \"equirectangular\" or \"cylindrical\"",
        ),
        ("vfov = 40", "projection = \"fisheye\"", "test.toml:8:11: camera.look_at: the camera needs the key `fov`"),
        (
            "vfov = 40",
            "projection = \"fisheye\"\nfov = 361",
            "test.toml:10:7: camera.fov: expected an angle above 0, at most 360 (degrees), found 361",
        ),
        (
            "vfov = 40",
            "projection = \"fisheye\"\nfov = 190\nmapping = \"orthographic\"",
            "test.toml:10:7: camera.fov: the field of view of a fisheye that is orthographic must be above 0 and at most 180 degrees, and is 190",
        ),
        (
            "vfov = 40",
            "projection = \"fisheye\"\nfov = 190\nmapping = \"equidistent\"",
            "test.toml:11:11: camera.mapping: `equidistent` is not a valid choice [did you mean `equidistant`? valid choices: equidistant, equisolid, stereographic, orthographic]",
        ),
        (
            "vfov = 40",
            "projection = \"fisheye\"\nfov = 190\nfit = \"wide\"",
            "test.toml:11:7: camera.fit: `wide` is not a valid choice [valid choices: inside, width, height, diagonal]",
        ),
        ("vfov = 40", "vfov = 40\nfit = \"width\"", "test.toml:10:7: camera.fit: `fit` belongs to projection = \"fisheye\""),
        (
            "vfov = 40",
            "vfov = 40\nmapping = \"equisolid\"",
            "test.toml:10:11: camera.mapping: `mapping` belongs to projection = \"fisheye\"",
        ),
        (
            "vfov = 40",
            "vfov = 40\nlayout = \"row\"",
            "test.toml:10:10: camera.layout: `layout` belongs to projection = \"cube_map\"",
        ),
        (
            "vfov = 40",
            "projection = \"cube_map\"",
            "test.toml:9:14: camera.projection: its picture has 6 × 1 views, into which 4 × 4 pixels cannot be divided evenly [a right size = [6, 1] in [film]]",
        ),
        ("vfov = 40", "projection = \"brown_conrady\"", "test.toml:8:11: camera.look_at: the camera needs the key `focal`"),
        (
            "vfov = 40",
            "projection = \"brown_conrady\"\nfocal = [4, 0]",
            "test.toml:10:13: camera.focal[1]: expected a number above 0, found 0",
        ),
        (
            "vfov = 40",
            "projection = \"brown_conrady\"\nfocal = [4, 4]\nimage_size = [0, 4]",
            "test.toml:11:15: camera.image_size[0]: invalid value: integer `0`, expected a whole number of at least 1",
        ),
        (
            "vfov = 40",
            "projection = \"kannala_brandt\"\nfocal = [4, 4]\nradial = [1, 2, 3, 4, 5]",
            "test.toml:11:10: camera.radial: kannala_brandt has 4 radial coefficients, and these are 5",
        ),
        (
            "vfov = 40",
            "projection = \"brown_conrady\"\nfocal = [4, 4]\nradial = [1, 2, 3, 4, 5, 6, 7]",
            "test.toml:11:10: camera.radial: brown_conrady has 6 radial coefficients, and these are 7",
        ),
        (
            "vfov = 40",
            "projection = \"kannala_brandt\"\nfocal = [4, 4]\ntangential = [0, 1]",
            "test.toml:11:14: camera.tangential: `tangential` belongs to projection = \"brown_conrady\"",
        ),
        (
            "vfov = 40",
            "projection = \"brown_conrady\"\nfocal = [0.1, 0.1]\nprincipal_point = [-90, 2]\nradial = [-0.5]",
            "test.toml:9:14: camera.projection: no place of its picture sees anything: all lie beyond where its lens shows the farthest from the axis",
        ),
        (
            "vfov = 40",
            "vfov = 40\nprincipal_point = [1, 2]",
            "test.toml:10:19: camera.principal_point: `principal_point` belongs to projection = \"brown_conrady\" or \"kannala_brandt\"",
        ),
        (
            "vfov = 40",
            "vfov = 40\ncalibration_id = 3",
            "test.toml:10:18: camera.calibration_id: `calibration_id` belongs to `calibration`",
        ),
        (
            "vfov = 40",
            "vfov = 40\nstereo = { layout = \"side_by_side\", eye_distance = 0 }",
            "test.toml:10:52: camera.stereo.eye_distance: expected a number above 0, found 0",
        ),
        (
            "vfov = 40",
            "vfov = 40\nstereo = { layout = \"beside\", eye_distance = 1 }",
            "test.toml:10:21: camera.stereo.layout: `beside` is not a valid choice [valid choices: side_by_side, top_bottom]",
        ),
        (
            "vfov = 40",
            "projection = \"cube_map\"\nstereo = { layout = \"top_bottom\", eye_distance = 1 }",
            "test.toml:10:10: camera.stereo: `stereo` belongs to projection = \"perspective\" or \"orthographic\" or \"equirectangular\" or \"cylindrical\" or \"fisheye\" or \"brown_conrady\" or \"kannala_brandt\"",
        ),
        (
            "vfov = 40",
            "projection = \"fisheye\"\nfov = 90\nfocus_distance = 1\naperture = { shape = \"disk\", radius = 1 }",
            "test.toml:12:12: camera.aperture: `aperture` belongs to projection = \"perspective\" or \"orthographic\" or \"brown_conrady\"",
        ),
        (
            "vfov = 40",
            "projection = \"fisheye\"\nfov = 90\nshift = [0.1, 0]",
            "test.toml:11:9: camera.shift: `shift` belongs to projection = \"perspective\" or \"orthographic\"",
        ),
        (
            "vfov = 40",
            "projection = \"fisheye\"\nfov = 90\nstretch = 2",
            "test.toml:11:11: camera.stretch: `stretch` belongs to projection = \"perspective\" or \"orthographic\"",
        ),
        (
            "vfov = 40",
            "projection = \"panorama\"",
            "test.toml:9:14: camera.projection: `panorama` is not a valid choice [valid choices: perspective, orthographic, equirectangular, cylindrical, fisheye, cube_map, brown_conrady, kannala_brandt]",
        ),
    ]);
}

/// Views of two eyes have as many pixels each.
#[test]
fn pictures_of_two_eyes_divide_evenly() {
    let found = super::complaint(
        "size = [4, 4]\n[render]\nspp = 1\n[camera]\nposition = [0, 0, 4]\nlook_at = [0, 0, 0]\nvfov = 40",
        "size = [5, 4]\n[render]\nspp = 1\n[camera]\nposition = [0, 0, 4]\nlook_at = [0, 0, 0]\nvfov = 40\nstereo = { layout = \"side_by_side\", eye_distance = 1 }",
    );
    let expected = "test.toml:10:10: camera.stereo: its picture has 2 × 1 views, into which 5 × 4 pixels cannot be divided evenly [a right size = [4, 4] in [film]]";
    assert_eq!(found, expected);
}
