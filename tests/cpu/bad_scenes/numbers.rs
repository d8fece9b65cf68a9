//! Numbers out of their ranges.

use gpt::load;

use super::{GOOD, check, complaint};

#[test]
fn numbers_out_of_range_are_told_with_their_range() {
    check(&[
        ("spp = 1", "spp = 0", "test.toml:5:7: render.spp: invalid value: integer `0`, expected a whole number of at least 1"),
        ("spp = 1", "spp = -1", "test.toml:5:7: render.spp: invalid value: integer `-1`, expected a whole number of at least 1"),
        (
            "spp = 1",
            "spp = 4000000000",
            "test.toml:5:7: render.spp: invalid value: integer `4000000000`, expected a whole number of at most 2147483647",
        ),
        (
            "spp = 1",
            "max_depth = -1",
            "test.toml:5:13: render.max_depth: invalid value: integer `-1`, expected a whole number of at least 0",
        ),
        (
            "spp = 1",
            "light_samples = 17",
            "test.toml:5:17: render.light_samples: invalid value: integer `17`, expected a whole number from 1 to 16, or auto",
        ),
        (
            "spp = 1",
            "light_samples_depth = 4",
            "test.toml:5:23: render.light_samples_depth: invalid value: integer `4`, expected a whole number from 1 to 3",
        ),
        (
            "size = [4, 4]",
            "size = [0, 0]",
            "test.toml:3:9: film.size[0]: invalid value: integer `0`, expected a whole number of at least 1",
        ),
        (
            "size = [4, 4]",
            "size = [100000, 1]",
            "test.toml:3:8: film.size: a picture of 100000 x 1 pixels is too large [at most 32768 pixels on a side and 268435456 in all]",
        ),
        ("radius = 1", "radius = 0", "test.toml:17:10: shape[0].radius: expected a number above 0, found 0"),
        ("radius = 1", "radius = -1", "test.toml:17:10: shape[0].radius: expected a number above 0, found -1"),
        ("radius = 1", "radius = nan", "test.toml:17:10: shape[0].radius: expected a number above 0, found NaN"),
        ("radius = 1", "radius = inf", "test.toml:17:10: shape[0].radius: expected a number above 0, found inf"),
        ("radius = 1", "radius = 1e999", "test.toml:17:10: shape[0].radius: the number is too large"),
        (
            "center = [0, 0, 0]",
            "center = [0, nan, 0]",
            "test.toml:16:14: shape[0].center[1]: expected a number of magnitude at most 1e18, found NaN",
        ),
        (
            "reflectance = 0.5",
            "reflectance = 1.5",
            "test.toml:13:15: material[0].reflectance: expected a number from 0 to 1, found 1.5",
        ),
        (
            "reflectance = 0.5",
            "reflectance = [0.5, 0.5, -0.1]",
            "test.toml:13:26: material[0].reflectance[2]: expected a number from 0 to 1, found -0.1",
        ),
        ("radiance = 1", "radiance = -1", "test.toml:21:12: light[0].radiance: expected a number from 0 to 1e18, found -1"),
        ("vfov = 40", "vfov = 180", "test.toml:9:8: camera.vfov: expected an angle from 0.001 to 179 (degrees), found 180"),
        (
            "spp = 1",
            "max_depth = 0\nroulette_depth = 0",
            "test.toml:6:18: render.roulette_depth: with max_depth = 0 and roulette_depth = 0 paths would never end [bound max_depth, \
             or let Russian roulette end paths]",
        ),
    ]);
}

/// Numbers that are possible one by one, and lead out of the range of numbers together.
#[test]
fn what_ends_beyond_the_range_of_numbers_is_refused() {
    let far = "it reaches farther than 1e18 units from the origin";
    let transform = "transform = [{ scale = 1e10 }, { translate = [1e17, 0, 0] }, { scale = 1e3 }]";
    let moving = "transform = { scale = 5e17 }\nmotion = [{ translate = [6e17, 0, 0] }]";
    for (keys, column) in [(transform, 13), (moving, 10)] {
        let line = 18 + keys.matches('\n').count();
        let found = complaint("radius = 1", &format!("radius = 1\n{keys}"));
        assert!(found.contains(&format!("test.toml:{line}:{column}: ")) && found.contains(far), "{keys}: {found}");
    }
    let near = GOOD.replace("radius = 1", &format!("radius = 1\n{}", transform.replace("1e17", "1e14")));
    assert!(load::load_toml_str(&near, "test.toml", std::path::Path::new("")).is_ok());
}
