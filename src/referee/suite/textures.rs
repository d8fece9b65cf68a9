//! Textures: codes, texels, edges of pictures, and where (u, v) points. A diffuse plane under a sky of radiance 1 shows its reflectance.

use super::super::picture::{SceneFile, exr, hdr, linear_to_srgb, png, srgb_to_linear, srgb_value_to_linear};
use super::super::test::Test;
use super::stage::{SCREEN, frontal, grazing_camera_scene, light, material, on_grazed_plane, shape};

/// Texels along a side.
const SIDE: u32 = 4;

/// Codes that no symmetry of the square maps onto themselves.
fn code(x: u32, y: u32) -> [u8; 4] {
    let level = |factor_x: u32, factor_y: u32| 20 + ((x * factor_x + y * factor_y) % 9 * 25) as u8;
    [level(2, 5), level(4, 1), level(1, 3), 255]
}

fn file() -> SceneFile {
    png("codes.png", [SIDE, SIDE], code)
}

fn texture(keys: &str) -> String {
    format!("[[texture]]\nname = \"codes\"\ntype = \"image\"\nfile = \"codes.png\"\n{keys}\n")
}

fn textured(keys: &str) -> String {
    let sky = light("environment", "radiance = 1");
    let plane = material("m", "type = \"diffuse\"\nreflectance = { texture = \"codes\" }");
    frontal(&format!("{}{plane}{SCREEN}{sky}", texture(keys)))
}

/// How an index beyond the picture is brought back.
#[derive(Clone, Copy)]
enum Wrap {
    Repeat,
    Clamp,
    Mirror,
}

impl Wrap {
    fn index(self, index: i64) -> u32 {
        let side = i64::from(SIDE);
        let within = match self {
            Self::Repeat => index.rem_euclid(side),
            Self::Clamp => index.clamp(0, side - 1),
            Self::Mirror => {
                let twice = index.rem_euclid(2 * side);
                if twice < side { twice } else { 2 * side - 1 - twice }
            }
        };
        within as u32
    }
}

fn decoded(x: i64, y: i64, wrap: Wrap, is_srgb: bool) -> [f64; 3] {
    let [r, g, b, _] = code(wrap.index(x), wrap.index(y));
    [r, g, b].map(|code| if is_srgb { srgb_to_linear(code) } else { f64::from(code) / 255.0 })
}

/// The texel that holds (u, v), whose v points up while rows run down.
fn nearest([u, v]: [f64; 2], wrap: Wrap, is_srgb: bool) -> [f64; 3] {
    let side = f64::from(SIDE);
    decoded((u * side).floor() as i64, ((1.0 - v) * side).floor() as i64, wrap, is_srgb)
}

/// Interpolation between the middles of four texels, which lie `middle` texels from their corners.
fn bilinear([u, v]: [f64; 2], middle: f64, wrap: Wrap) -> [f64; 3] {
    let side = f64::from(SIDE);
    let (x, y) = (u * side - middle, (1.0 - v) * side - middle);
    let (left, top) = (x.floor(), y.floor());
    let (fx, fy) = (x - left, y - top);
    let at = |dx: i64, dy: i64| decoded(left as i64 + dx, top as i64 + dy, wrap, false);
    let [a, b, c, d] = [at(0, 0), at(1, 0), at(0, 1), at(1, 1)];
    std::array::from_fn(|i| (1.0 - fy) * ((1.0 - fx) * a[i] + fx * b[i]) + fy * ((1.0 - fx) * c[i] + fx * d[i]))
}

/// (u, v) of a point of the frontal film.
fn uv(s: f64, t: f64) -> [f64; 2] {
    [s, 1.0 - t]
}

pub fn tests() -> Vec<Test> {
    [codes(), places(), wraps(), vec![of_corners(), of_high_range(), of_floats()]].into_iter().flatten().collect()
}

fn codes() -> Vec<Test> {
    let encoded = |s, t| nearest(uv(s, t), Wrap::Repeat, true).map(linear_to_srgb);
    vec![
        Test::of_formula(
            [
                "textures/srgb",
                "Codes of an sRGB picture become linear reflectances.",
                "IEC 61966-2-1; glTF: base colour textures are sRGB",
            ],
            textured("color_space = \"srgb\"\nfilter = \"nearest\""),
            |s, t| nearest(uv(s, t), Wrap::Repeat, true),
        )
        .file(file())
        .with_edges()
        .mistake("an sRGB texture that is read as linear", encoded)
        .mistake("an sRGB texture that is decoded twice", |s, t| {
            nearest(uv(s, t), Wrap::Repeat, true).map(|value| srgb_to_linear((value * 255.0).round() as u8))
        })
        .mistake("a power of 2.2 in place of sRGB's curve", |s, t| {
            nearest(uv(s, t), Wrap::Repeat, false).map(|value| value.powf(2.2))
        })
        .mistake("a texture whose red and blue are exchanged", |s, t| {
            let [r, g, b] = nearest(uv(s, t), Wrap::Repeat, true);
            [b, g, r]
        }),
        Test::of_formula(
            ["textures/linear", "Codes of a linear picture are reflectances.", "code/255"],
            textured("color_space = \"linear\"\nfilter = \"nearest\""),
            |s, t| nearest(uv(s, t), Wrap::Repeat, false),
        )
        .file(file())
        .with_edges()
        .mistake("a linear texture that is read as sRGB", |s, t| nearest(uv(s, t), Wrap::Repeat, true))
        .mistake("code/256", |s, t| nearest(uv(s, t), Wrap::Repeat, false).map(|value| value * 255.0 / 256.0)),
        Test::of_formula(
            [
                "textures/bilinear",
                "Between the middles of texels colours are interpolated.",
                "Texel middles at half-integers: OpenGL 4.6, 8.14; glTF samplers",
            ],
            textured("color_space = \"linear\"\nfilter = \"bilinear\"\nwrap = \"clamp\""),
            |s, t| bilinear(uv(s, t), 0.5, Wrap::Clamp),
        )
        .file(file())
        .with_kinks()
        .mistake("texels whose middles lie half a texel off", |s, t| bilinear(uv(s, t), 0.0, Wrap::Clamp))
        .mistake("a nearest texel in place of an interpolation", |s, t| nearest(uv(s, t), Wrap::Clamp, false))
        .mistake("a picture that is repeated at its edge", |s, t| bilinear(uv(s, t), 0.5, Wrap::Repeat)),
    ]
}

fn places() -> Vec<Test> {
    let of = |texts, keys: &str, map: fn([f64; 2]) -> [f64; 2], cause, wrong: fn([f64; 2]) -> [f64; 2]| {
        Test::of_formula(texts, textured(&format!("color_space = \"linear\"\nfilter = \"nearest\"\n{keys}")), move |s, t| {
            nearest(map(uv(s, t)), Wrap::Repeat, false)
        })
        .file(file())
        .with_edges()
        .mistake(cause, move |s, t| nearest(wrong(uv(s, t)), Wrap::Repeat, false))
        .mistake("a texture that stands upside down", move |s, t| {
            let [u, v] = map(uv(s, t));
            nearest([u, 1.0 - v], Wrap::Repeat, false)
        })
        .mistake("a texture whose left is its right", move |s, t| {
            let [u, v] = map(uv(s, t));
            nearest([1.0 - u, v], Wrap::Repeat, false)
        })
    };
    vec![
        of(
            [
                "textures/upright",
                "The first row of a picture is at v = 1, its first column at u = 0.",
                "(u, v) of the scene file; glTF counts v from the top",
            ],
            "",
            |uv| uv,
            "a texture that is transposed",
            |[u, v]| [1.0 - v, 1.0 - u],
        ),
        of(
            [
                "textures/scaled",
                "`scale` multiplies (u, v): the picture is smaller.",
                "`scale` of the scene file; KHR_texture_transform",
            ],
            "scale = [2, 3]",
            |[u, v]| [2.0 * u, 3.0 * v],
            "a scale that makes the picture larger",
            |[u, v]| [u / 2.0, v / 3.0],
        ),
        of(
            ["textures/offset", "`offset` is added to (u, v).", "`offset` of the scene file; KHR_texture_transform"],
            "offset = [0.25, 0.5]",
            |[u, v]| [u + 0.25, v + 0.5],
            "an offset that moves the picture the other way",
            |[u, v]| [u - 0.25, v + 0.5],
        ),
        of(
            [
                "textures/rotated",
                "`rotation` turns (u, v) from u towards v about (0, 0).",
                "`rotation` of the scene file; KHR_texture_transform",
            ],
            "rotation = 30",
            |[u, v]| {
                let (sine, cosine) = 30f64.to_radians().sin_cos();
                [cosine * u - sine * v, sine * u + cosine * v]
            },
            "a rotation the other way",
            |[u, v]| {
                let (sine, cosine) = 30f64.to_radians().sin_cos();
                [cosine * u + sine * v, -sine * u + cosine * v]
            },
        ),
        in_perspective(),
        checks(),
    ]
}

/// A plane in perspective: texture coordinates are interpolated in space, not on the film.
fn in_perspective() -> Test {
    let tables = format!(
        "{}{}{}",
        texture("color_space = \"linear\"\nfilter = \"nearest\""),
        material("m", "type = \"diffuse\"\nreflectance = { texture = \"codes\" }"),
        light("environment", "radiance = 1")
    );
    let quad = "[[shape]]\ntype = \"mesh\"\nmaterial = \"m\"\npositions = [[-2, -1.5, 0], [2, -1.5, 0], [2, 4.5, 0], [-2, 4.5, 0]]\n\
                uvs = [[0, 0], [1, 0], [1, 1], [0, 1]]\nfaces = [[0, 1, 2], [0, 2, 3]]\n";
    let value = |s: f64, t: f64| {
        let [x, y] = on_grazed_plane(s, t);
        let (u, v) = ((x + 2.0) / 4.0, (y + 1.5) / 6.0);
        if (0.0..1.0).contains(&u) && (0.0..1.0).contains(&v) { nearest([u, v], Wrap::Repeat, false) } else { [1.0; 3] }
    };
    Test::of_formula(
        ["textures/perspective", "Texture coordinates are interpolated in space, not on the film.", "Projective geometry"],
        grazing_camera_scene(&format!("{tables}{quad}")),
        value,
    )
    .file(file())
    .with_edges()
    .mistake("a texture that stands upside down", |s, t| {
        let [x, y] = on_grazed_plane(s, t);
        let (u, v) = ((x + 2.0) / 4.0, (y + 1.5) / 6.0);
        if (0.0..1.0).contains(&u) && (0.0..1.0).contains(&v) { nearest([u, 1.0 - v], Wrap::Repeat, false) } else { [1.0; 3] }
    })
}

fn checks() -> Test {
    const A: [f64; 3] = [0.9, 0.2, 0.1];
    const B: [f64; 3] = [0.1, 0.3, 0.8];
    let checker = format!("[[texture]]\nname = \"checks\"\ntype = \"checker\"\na = {A:?}\nb = {B:?}\nscale = [4, 2]\n");
    let plane = material("m", "type = \"diffuse\"\nreflectance = { texture = \"checks\" }");
    let value = |s: f64, t: f64, first: [f64; 3], second: [f64; 3]| {
        let [u, v] = uv(s, t);
        if ((4.0 * u).floor() + (2.0 * v).floor()) as i64 % 2 == 0 { first } else { second }
    };
    Test::of_formula(
        [
            "textures/checker",
            "Squares of two colours, the first where both numbers of the square are even.",
            "`checker` of the scene file",
        ],
        frontal(&format!("{checker}{plane}{SCREEN}{}", light("environment", "radiance = 1"))),
        move |s, t| value(s, t, A, B),
    )
    .with_edges()
    .mistake("exchanged colours", move |s, t| value(s, t, B, A))
}

fn wraps() -> Vec<Test> {
    let of = |texts, keys: &str, wrap: Wrap, cause, wrong: Wrap| {
        let map = |s: f64, t: f64| {
            let [u, v] = uv(s, t);
            [3.0 * u - 1.0, 3.0 * v - 1.0]
        };
        let keys = format!("color_space = \"linear\"\nfilter = \"nearest\"\nscale = [3, 3]\noffset = [-1, -1]\n{keys}");
        Test::of_formula(texts, textured(&keys), move |s, t| nearest(map(s, t), wrap, false))
            .file(file())
            .with_edges()
            .mistake(cause, move |s, t| nearest(map(s, t), wrong, false))
            .mistake("a texture that is black beyond its picture", move |s, t| {
                let [u, v] = map(s, t);
                let is_within = (0.0..1.0).contains(&u) && (0.0..1.0).contains(&v);
                if is_within { nearest([u, v], wrap, false) } else { [0.0; 3] }
            })
    };
    vec![
        of(
            ["textures/repeat", "A picture that goes on as it began.", "glTF samplers: REPEAT"],
            "wrap = \"repeat\"",
            Wrap::Repeat,
            "a picture whose edge goes on",
            Wrap::Clamp,
        ),
        of(
            ["textures/clamp", "A picture whose edge goes on.", "glTF samplers: CLAMP_TO_EDGE"],
            "wrap = \"clamp\"",
            Wrap::Clamp,
            "a picture that is repeated",
            Wrap::Repeat,
        ),
        of(
            ["textures/mirror", "A picture that goes on as its mirror image.", "glTF samplers: MIRRORED_REPEAT"],
            "wrap = \"mirror\"",
            Wrap::Mirror,
            "a picture that is repeated",
            Wrap::Repeat,
        ),
    ]
}

/// Colours of a square's corners, over its two triangles.
fn of_corners() -> Test {
    // Codes of the corners: lower left, lower right, upper right, upper left.
    const CODES: [[u8; 3]; 4] = [[230, 30, 60], [40, 200, 90], [110, 60, 240], [250, 220, 20]];
    // Two triangles, each with its first corner at the lower left.
    const TRIANGLES: [[usize; 3]; 2] = [[0, 1, 2], [0, 2, 3]];
    let texel = |x: u32, y: u32| {
        let corner = match (x % 2, y) {
            (0, 0) => Some(0),
            (1, 0) => Some(1),
            (0, 1) => Some(2),
            _ => None,
        };
        let [r, g, b] = corner.map_or([0; 3], |corner: usize| CODES[TRIANGLES[(x / 2) as usize][corner]]);
        [r, g, b, 255]
    };
    let texture = "[[texture]]\nname = \"corners\"\ntype = \"image\"\nfile = \"corners.png\"\ncolor_space = \"linear\"\n\
                   filter = \"triangle\"\n";
    let keys = "positions = [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, -1, 0], [1, 1, 0], [-1, 1, 0]]\nfaces = [[0, 1, 2], [3, 4, 5]]\n\
                uvs = [[0.125, 0.75], [0.375, 0.75], [0.125, 0.25], [0.625, 0.75], [0.875, 0.75], [0.625, 0.25]]";
    let scene = frontal(&format!(
        "{texture}{}{}{}",
        material("m", "type = \"diffuse\"\nreflectance = { texture = \"corners\" }"),
        shape("mesh", "m", keys),
        light("environment", "radiance = 1")
    ));
    let between = |decode: fn(u8) -> f64| {
        move |s: f64, t: f64| -> [f64; 3] {
            let [x, y] = uv(s, t);
            let weights = if x > y { [1.0 - x, x - y, y, 0.0] } else { [1.0 - y, 0.0, x, y - x] };
            std::array::from_fn(|channel| (0..4).map(|corner| weights[corner] * decode(CODES[corner][channel])).sum())
        }
    };
    let by_code = |code: u8| f64::from(code) / 255.0;
    let flat = CODES[0].map(by_code);
    Test::of_formula(
        [
            "textures/vertex-colours",
            "Colours of a mesh's corners are linear, and are interpolated over each of its triangles.",
            "glTF: COLOR_0, linear; interpolation by barycentric coordinates",
        ],
        scene,
        between(by_code),
    )
    .file(png("corners.png", [4, 2], texel))
    .with_kinks()
    .mistake("colours of corners that are read as sRGB", between(srgb_to_linear))
    .mistake("one colour for a face, that of its first corner", move |_, _| flat)
    .mistake("colours of corners that are left out", |_, _| [1.0; 3])
}

/// A picture that fills the film, by its value at a column and a row, each channel changed.
fn filling(
    value: impl Fn(u32, u32) -> [f64; 3] + Send + Sync + 'static,
    change: fn(f64) -> f64,
) -> impl Fn(f64, f64) -> [f64; 3] + Send + Sync + 'static {
    move |s, t| {
        let [x, y] = [s, t].map(|place| ((place * f64::from(SIDE)) as u32).min(SIDE - 1));
        value(x, y).map(change)
    }
}

/// A glowing plane by a Radiance picture whose values go up to 128.
fn of_high_range() -> Test {
    let exponent = |x: u32, y: u32| ((x * 2 + y * 3) % 7) as i32;
    let mantissa = |x: u32, y: u32| -> [f64; 3] {
        let level = |a: u32, b: u32| f64::from(2 + (x * a + y * b) % 11 * 3) / 16.0;
        [level(3, 4), level(5, 2), level(1, 7)]
    };
    let value = move |x: u32, y: u32| mantissa(x, y).map(|channel| channel * 2f64.powi(exponent(x, y)));
    let shown = move |change: fn(f64) -> f64| filling(value, change);
    let texture = "[[texture]]\nname = \"glow\"\ntype = \"image\"\nfile = \"glow.hdr\"\nfilter = \"nearest\"\n";
    let plane = material("m", "type = \"emissive\"\nradiance = { texture = \"glow\" }");
    Test::of_formula(
        [
            "textures/high-range",
            "A surface glows by a Radiance picture, whose values go up to 128.",
            "Ward 1991, Real pixels: a channel is its mantissa times two to the shared exponent; values are linear",
        ],
        frontal(&format!("{texture}{plane}{SCREEN}")),
        shown(|channel| channel),
    )
    .file(hdr("glow.hdr", [SIDE; 2], move |x, y| value(x, y).map(|channel| channel as f32)))
    .with_edges()
    .mistake("values that end at 1", shown(|channel| channel.min(1.0)))
    .mistake("values that are decoded as sRGB", shown(srgb_value_to_linear))
    .mistake("mantissas without their exponents", filling(mantissa, |channel| channel))
    .mistake("a texture that stands upside down", filling(move |x, y| value(x, SIDE - 1 - y), |channel| channel))
}

/// A dark plane by a picture of floating-point numbers.
fn of_floats() -> Test {
    let value = |x: u32, y: u32| -> [f64; 3] {
        let level = |a: u32, b: u32| 0.0013 * 2f64.powi(((x * a + y * b) % 9) as i32);
        [level(2, 5), level(4, 1), level(1, 3)]
    };
    let shown = move |change: fn(f64) -> f64| filling(value, change);
    let texture = "[[texture]]\nname = \"dark\"\ntype = \"image\"\nfile = \"dark.exr\"\nfilter = \"nearest\"\n";
    let plane = material("m", "type = \"diffuse\"\nreflectance = { texture = \"dark\" }");
    Test::of_formula(
        [
            "textures/floats",
            "Reflectances from 0.0013 to 0.33 by an OpenEXR picture of floating-point numbers.",
            "OpenEXR: values are linear",
        ],
        frontal(&format!("{texture}{plane}{SCREEN}{}", light("environment", "radiance = 1"))),
        shown(|channel| channel),
    )
    .file(exr("dark.exr", [SIDE; 2], move |x, y| value(x, y).map(|channel| channel as f32)))
    .with_edges()
    .mistake("floating-point numbers that are rounded to codes of 8 bits", shown(|channel| (channel * 255.0).round() / 255.0))
    .mistake("floating-point numbers that are decoded as sRGB", shown(srgb_value_to_linear))
    .mistake("a texture that stands upside down", filling(move |x, y| value(x, SIDE - 1 - y), |channel| channel))
}
