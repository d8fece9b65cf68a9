//! Lights: their units, and what they send where. A frontal plane of reflectance 1/2 shows ρ·E/π.

use std::f64::consts::{FRAC_1_PI, PI};

use super::super::formulas;
use super::super::picture::png;
use super::super::test::Test;
use super::stage::{SCREEN, diffuse, emissive, fan, frontal, light, on_plane, scaled, shape};

const UP: [f64; 3] = [0.0, 0.0, 1.0];
const REFLECTANCE: f64 = 0.5;
const COLOR: [f64; 3] = [3.0, 2.0, 1.0];

fn lit(tables: &str) -> String {
    frontal(&format!("{}{SCREEN}{tables}", diffuse(REFLECTANCE)))
}

/// A point of the frontal plane.
fn place(s: f64, t: f64) -> [f64; 3] {
    let [x, y] = on_plane(s, t);
    [x, y, 0.0]
}

/// The radiance of the plane under this irradiance of white light.
fn grey(irradiance: f64) -> [f64; 3] {
    [REFLECTANCE * FRAC_1_PI * irradiance; 3]
}

/// The radiance of the plane under this irradiance of the light's colour.
fn seen(irradiance: f64) -> [f64; 3] {
    scaled(COLOR, REFLECTANCE * FRAC_1_PI * irradiance)
}

/// A flat light of these corners, counter-clockwise as the plane sees them, whose front is towards the plane.
fn polygon_light(texts: [&'static str; 3], corners: Vec<[f64; 3]>) -> Test {
    // Seen from its front, which is below it, a polygon runs counter-clockwise.
    let scene = lit(&format!("{}{}", emissive("light", COLOR), fan("light", &corners, "")));
    let irradiance = move |s: f64, t: f64| formulas::polygon(place(s, t), UP, &corners).abs();
    let of_sides = irradiance.clone();
    let twice = irradiance.clone();
    Test::of_formula(texts, scene, move |s, t| seen(irradiance(s, t)))
        .mistake("a light that sends its radiance, π times over, as radiosity", move |s, t| seen(FRAC_1_PI * of_sides(s, t)))
        .mistake("light from both sides of a flat light, added up", move |s, t| seen(2.0 * twice(s, t)))
}

pub fn tests() -> Vec<Test> {
    [points(), directions(), areas(), films(), vec![projector()]].into_iter().flatten().collect()
}

fn points() -> Vec<Test> {
    const LIGHT: [f64; 3] = [0.4, 0.3, 1.0];
    let keys = format!("position = {LIGHT:?}\nintensity = {COLOR:?}");
    let distance = |s, t| formulas::vector_length(formulas::sub(LIGHT, place(s, t)));
    let irradiance = |s, t| formulas::point(place(s, t), UP, LIGHT);
    let point = Test::of_formula(
        [
            "lights/point",
            "A point light of intensity I lights a plane by I·cos θ/r².",
            "Inverse square and cosine laws; glTF KHR_lights_punctual: candela",
        ],
        lit(&light("point", &keys)),
        move |s, t| seen(irradiance(s, t)),
    )
    .mistake("an intensity that is taken for a power", move |s, t| seen(irradiance(s, t) / (4.0 * PI)))
    .mistake("a light that falls with the distance, not with its square", move |s, t| seen(irradiance(s, t) * distance(s, t)))
    .mistake("a missing cosine", move |s, t| seen(1.0 / distance(s, t).powi(2)));
    let many = {
        let places: Vec<[f64; 3]> =
            (0..100).map(|index| [f64::from(index % 10) * 0.3 - 1.35, f64::from(index / 10) * 0.3 - 1.35, 0.5]).collect();
        let tables: String =
            places.iter().map(|place| light("point", &format!("position = {place:?}\nintensity = [0.06, 0.04, 0.02]"))).collect();
        Test::of_formula(
            ["lights/hundred-points", "A hundred point lights add up.", "Light is linear"],
            lit(&tables),
            move |s, t| seen(places.iter().map(|&light| 0.02 * formulas::point(place(s, t), UP, light)).sum()),
        )
        .mistake("the nearest ten lights alone", {
            move |s, t| {
                let mut each: Vec<f64> = (0..100)
                    .map(|index| [f64::from(index % 10) * 0.3 - 1.35, f64::from(index / 10) * 0.3 - 1.35, 0.5])
                    .map(|light| 0.02 * formulas::point(place(s, t), UP, light))
                    .collect();
                each.sort_by(|a, b| b.total_cmp(a));
                seen(each[..10].iter().sum())
            }
        })
    };
    [point, many].into_iter().chain([spot("smooth"), spot("sharp")]).chain([scales(1e-3), scales(1e4)]).collect()
}

/// A spot light above the plane.
fn spot(kind: &str) -> Test {
    const LIGHT: [f64; 3] = [0.1, -0.2, 2.0];
    const OUTER: f64 = 25.0;
    let cosine =
        |s: f64, t: f64| -> f64 { -formulas::dot([0.0, 0.0, -1.0], formulas::normalized(formulas::sub(LIGHT, place(s, t)))) };
    let full = |s: f64, t: f64| formulas::point(place(s, t), UP, LIGHT);
    let common = format!("position = {LIGHT:?}\ndirection = [0, 0, -1]\nintensity = {COLOR:?}\nangle = {OUTER}\n");
    let outer = OUTER.to_radians().cos();
    if kind == "sharp" {
        return Test::of_formula(
            [
                "lights/spot-sharp",
                "A spot light whose inner angle is its outer one has one intensity within the cone and none outside.",
                "Geometry of a cone; angles are measured from the axis",
            ],
            lit(&light("spot", &common)),
            move |s, t| seen(if cosine(s, t) >= outer { full(s, t) } else { 0.0 }),
        )
        .with_edges()
        .mistake("a cone of half the angle", move |s, t| {
            seen(if cosine(s, t) >= (0.5 * OUTER).to_radians().cos() { full(s, t) } else { 0.0 })
        });
    }
    let inner = 10f64.to_radians().cos();
    let share = move |s: f64, t: f64| ((cosine(s, t) - outer) / (inner - outer)).clamp(0.0, 1.0);
    Test::of_formula(
        [
            "lights/spot-gltf",
            "Between its inner and its outer angle a spot light falls as the square of a line in the cosine.",
            "glTF KHR_lights_punctual, inner and outer cone angles",
        ],
        lit(&light("spot", &format!("{common}falloff = 10\ncurve = \"square\""))),
        move |s, t| seen(share(s, t).powi(2) * full(s, t)),
    )
    .mistake("a falloff by a line in the cosine", move |s, t| seen(share(s, t) * full(s, t)))
    .mistake("a falloff by a smooth step", move |s, t| {
        let x = share(s, t);
        seen(x * x * (3.0 - 2.0 * x) * full(s, t))
    })
}

/// A point light in a scene of another size: the picture stays.
fn scales(scale: f64) -> Test {
    let texts = if scale < 1.0 {
        [
            "lights/tiny-scene",
            "A scene a thousandth as large with lights of a millionth of the intensity is the same picture.",
            "Similarity",
        ]
    } else {
        [
            "lights/huge-scene",
            "A scene ten thousand times as large with lights of 10⁸ times the intensity is the same picture.",
            "Similarity",
        ]
    };
    let light_at = [0.4 * scale, 0.3 * scale, scale];
    let intensity = scaled(COLOR, scale * scale);
    let side = 2.0 * scale;
    let scene = super::stage::scene(
        &format!("position = [0, 0, {}]\nlook_at = [0, 0, 0]\nvfov = 28.072486935852957\n", 4.0 * scale),
        &format!(
            "{}{}{}",
            diffuse(REFLECTANCE),
            shape("rectangle", "m", &format!("corner = [{0}, {0}, 0]\nedge_u = [{side}, 0, 0]\nedge_v = [0, {side}, 0]", -scale)),
            light("point", &format!("position = {light_at:?}\nintensity = {intensity:?}"))
        ),
    );
    let irradiance = |s, t| formulas::point(place(s, t), UP, [0.4, 0.3, 1.0]);
    Test::of_formula(texts, scene, move |s, t| seen(irradiance(s, t)))
        .mistake("a shadow that the surface throws on itself, at half of the picture", move |s, t| seen(0.5 * irradiance(s, t)))
}

fn directions() -> Vec<Test> {
    let parallel = |texts, direction: [f64; 3]| {
        let cosine = formulas::directional(UP, direction);
        let keys = format!("direction = {direction:?}\nirradiance = {COLOR:?}");
        Test::of_constant(texts, lit(&light("directional", &keys)), seen(cosine))
            .mistake("an irradiance that is taken for radiance, π times as bright", move |_, _| seen(PI * cosine))
            .mistake("a missing cosine", |_, _| seen(1.0))
    };
    let (sine, cosine) = (85f64.to_radians().sin(), 85f64.to_radians().cos());
    vec![
        parallel(
            [
                "lights/directional",
                "Parallel light lights a plane by its irradiance times the cosine, everywhere alike.",
                "Cosine law; glTF KHR_lights_punctual: lux",
            ],
            [0.6, 0.0, -0.8],
        ),
        parallel(
            ["lights/directional-grazing", "Parallel light at 85 degrees from the normal.", "Cosine law"],
            [sine, 0.0, -cosine],
        ),
        Test::of_constant(
            ["lights/directional-behind", "Light on the far side of an opaque plane is not seen on the near one.", "Opacity"],
            lit(&light("directional", &format!("direction = [0, 0.6, 0.8]\nirradiance = {COLOR:?}"))),
            [0.0; 3],
        )
        .mistake("light that goes through an opaque plane", |_, _| seen(0.8)),
    ]
}

fn areas() -> Vec<Test> {
    // Counter-clockwise seen from below, and beside the frontal camera's view.
    let rectangle = vec![[1.0, -0.5, 1.0], [1.0, 0.5, 1.0], [2.2, 0.5, 1.0], [2.2, -0.5, 1.0]];
    let tilted = vec![[1.0, -0.5, 0.6], [1.0, 0.5, 1.2], [2.2, 0.5, 1.2], [2.2, -0.5, 0.6]];
    let triangle = vec![[2.4, -0.8, 0.8], [1.0, -0.2, 0.7], [2.2, 0.9, 1.3]];
    let disk = {
        let irradiance = |s: f64, t: f64| {
            let [x, y, _] = place(s, t);
            formulas::disk(1.0, (x - 1.5).hypot(y + 0.1), 0.5)
        };
        let keys = "center = [1.5, -0.1, 1]\nnormal = [0, 0, -1]\nradius = 0.5";
        Test::of_formula(
            [
                "lights/disk",
                "The irradiance of a disk that is parallel to the plane.",
                "Foote 1915; configuration factor of a disk",
            ],
            lit(&format!("{}{}", emissive("light", COLOR), shape("disk", "light", keys))),
            move |s, t| seen(irradiance(s, t)),
        )
        .mistake("a square in place of a disk", move |s, t| seen(irradiance(s, t) * 4.0 / PI))
    };
    let ball = |texts, center: [f64; 3], radius: f64, factor: f64| {
        let keys = format!("center = {center:?}\nradius = {radius}");
        let irradiance = move |s, t| factor * formulas::sphere(place(s, t), UP, center, radius);
        Test::of_formula(
            texts,
            lit(&format!("{}{}", emissive("light", scaled(COLOR, factor)), shape("sphere", "light", &keys))),
            move |s, t| seen(irradiance(s, t)),
        )
        .mistake("a sphere that sends its radiance by its surface, not by its outline", move |s, t| seen(4.0 * irradiance(s, t)))
    };
    vec![
        polygon_light(
            [
                "lights/rectangle",
                "The irradiance of a rectangle that faces the plane.",
                "Lambert 1760; configuration factor of a polygon",
            ],
            rectangle.clone(),
        ),
        polygon_light(
            [
                "lights/rectangle-tilted",
                "The irradiance of a rectangle that is tilted.",
                "Lambert 1760; configuration factor of a polygon",
            ],
            tilted,
        ),
        polygon_light(
            ["lights/triangle", "The irradiance of one triangle.", "Lambert 1760; configuration factor of a polygon"],
            triangle,
        ),
        disk,
        ball(
            ["lights/sphere", "The irradiance of a sphere: that of the disk of its outline.", "Configuration factor of a sphere"],
            [1.4, -0.3, 1.0],
            0.4,
            1.0,
        ),
        ball(
            [
                "lights/sphere-small",
                "A sphere of radius 0.005 and ten thousand times the radiance.",
                "Configuration factor of a sphere",
            ],
            [1.4, -0.3, 1.0],
            0.005,
            1e4,
        ),
        one_sided(rectangle.clone(), false),
        one_sided(rectangle, true),
        textured(),
    ]
}

/// A rectangle whose back is towards the plane.
fn one_sided(mut corners: Vec<[f64; 3]>, two_sided: bool) -> Test {
    corners.reverse();
    let table = emissive("light", COLOR) + if two_sided { "two_sided = true\n" } else { "" };
    let scene = lit(&format!("{table}{}", fan("light", &corners, "")));
    let irradiance = move |s: f64, t: f64| formulas::polygon(place(s, t), UP, &corners).abs();
    let of_mistake = irradiance.clone();
    if two_sided {
        Test::of_formula(
            [
                "lights/two-sided",
                "A light that shines on both sides lights what is behind it as well.",
                "glTF: doubleSided; radiance on either side",
            ],
            scene,
            move |s, t| seen(irradiance(s, t)),
        )
        .mistake("half of the light on either side", move |s, t| seen(0.5 * of_mistake(s, t)))
    } else {
        Test::of_constant(
            [
                "lights/one-sided",
                "A light that shines from its front does not light what is behind it.",
                "Radiance leaves the front, to which the normal points",
            ],
            scene,
            [0.0; 3],
        )
        .mistake("a one-sided light that shines on both sides", move |s, t| seen(of_mistake(s, t)))
    }
}

/// A rectangle whose radiance is a picture of 4 × 4 texels.
fn textured() -> Test {
    let level = |x: u32, y: u32| f64::from((x * 5 + y * 3) % 7) / 6.0;
    let file = png("lamp.png", [4, 4], move |x, y| {
        let code = (level(x, y) * 255.0).round() as u8;
        [code, code, code, 255]
    });
    let tables = format!(
        "[[texture]]\nname = \"lamp\"\ntype = \"image\"\nfile = \"lamp.png\"\ncolor_space = \"linear\"\nfilter = \"nearest\"\n\
         [[material]]\nname = \"light\"\ntype = \"emissive\"\nradiance = {{ texture = \"lamp\" }}\n{}",
        // u grows along −x, v along y: the front is towards the plane.
        shape("rectangle", "light", "corner = [2.6, -0.8, 0.7]\nedge_u = [-1.6, 0, 0]\nedge_v = [0, 1.6, 0]")
    );
    let irradiance = move |turned: bool| {
        move |s: f64, t: f64| -> f64 {
            let mut sum = 0.0;
            for row in 0..4 {
                for column in 0..4 {
                    let side = 1.6 / 4.0;
                    let (right, top) = (2.6 - side * f64::from(column), 0.8 - side * f64::from(row));
                    let corners =
                        [[right - side, top - side, 0.7], [right - side, top, 0.7], [right, top, 0.7], [right, top - side, 0.7]];
                    let value = if turned { level(column, 3 - row) } else { level(column, row) };
                    let code = (value * 255.0).round() / 255.0;
                    sum += code * formulas::polygon(place(s, t), UP, &corners).abs();
                }
            }
            sum
        }
    };
    let (right_way, upside_down) = (irradiance(false), irradiance(true));
    Test::of_formula(
        [
            "lights/textured",
            "A rectangle whose radiance is a picture of 4 × 4 texels lights a plane by the sum of its texels.",
            "Lambert 1760, texel by texel; the first row is at v = 1",
        ],
        lit(&tables),
        move |s, t| grey(right_way(s, t)),
    )
    .file(file)
    .mistake("a picture that stands upside down", move |s, t| grey(upside_down(s, t)))
}

fn films() -> Vec<Test> {
    let shown = |texts, radiance: [f64; 3]| {
        let scene = frontal(&format!("{}{SCREEN}", emissive("m", radiance)));
        Test::of_constant(texts, scene, radiance)
    };
    vec![
        shown(
            ["lights/seen", "The pixel of a light is its radiance, without exposure or tone curve.", "A linear film"],
            [0.25, 0.5, 1.0],
        ),
        shown(
            ["lights/seen-bright", "A radiance of ten thousand is neither cut off nor compressed.", "A linear film"],
            [1e4, 5e3, 2.5e3],
        ),
        shown(["lights/seen-dark", "A radiance of a ten-thousandth is kept.", "A linear film"], [1e-4, 5e-5, 2.5e-5]),
        Test::of_constant(
            ["lights/environment", "A plane of reflectance 1/2 under a sky of radiance 1 shows 1/2.", "Conservation of energy"],
            lit(&light("environment", "radiance = [3, 2, 1]")),
            scaled(COLOR, REFLECTANCE),
        )
        .mistake("a missing cosine", |_, _| scaled(COLOR, 2.0 * REFLECTANCE))
        .mistake("a reflectance that is not divided by π", |_, _| scaled(COLOR, PI * REFLECTANCE)),
    ]
}

/// A picture of 4 × 4 texels that a light projects onto the plane.
fn projector() -> Test {
    const LIGHT: [f64; 3] = [0.1, -0.05, 2.0];
    const VFOV: f64 = 40.0;
    let code = |x: u32, y: u32| (f64::from((x * 5 + y * 3) % 7) / 6.0 * 255.0).round() as u8;
    let file = png("slide.png", [4, 4], move |x, y| {
        let code = code(x, y);
        [code, code, code, 255]
    });
    let tables = format!(
        "[[texture]]\nname = \"slide\"\ntype = \"image\"\nfile = \"slide.png\"\ncolor_space = \"linear\"\nfilter = \"nearest\"\n{}",
        light(
            "projector",
            &format!(
                "position = {LIGHT:?}\ndirection = [0, 0, -1]\nup = [0, 1, 0]\nirradiance = {COLOR:?}\nvfov = {VFOV}\ntexture = \"slide\""
            )
        )
    );
    // The picture by its texel's column from the left and row from the top, and by the cosine between axis and ray.
    let shown = move |factor: fn(f64) -> f64, turn: fn([f64; 2]) -> [f64; 2]| {
        move |s: f64, t: f64| {
            let half = LIGHT[2] * (0.5 * VFOV).to_radians().tan();
            let [x, y, _] = formulas::sub(place(s, t), LIGHT);
            let [right, down] = turn([0.5 * (1.0 + x / half), 0.5 * (1.0 - y / half)]);
            if !(0.0..1.0).contains(&right) || !(0.0..1.0).contains(&down) {
                return [0.0; 3];
            }
            let level = f64::from(code((4.0 * right) as u32, (4.0 * down) as u32)) / 255.0;
            let cosine = LIGHT[2] / x.hypot(y).hypot(LIGHT[2]);
            seen(level * factor(cosine) / (LIGHT[2] * LIGHT[2]))
        }
    };
    Test::of_formula(
        [
            "lights/projector",
            "A light projects a picture: a plane across its axis at distance d has the stated irradiance over d² wherever the picture is white.",
            "`projector` of the scene file; inverse square law",
        ],
        lit(&tables),
        shown(|_| 1.0, |at| at),
    )
    .file(file)
    .with_edges()
    .mistake("an intensity that is the same in all directions, and falls on the plane by its cosine cubed", shown(|cosine| cosine.powi(3), |at| at))
    .mistake("a projected picture whose left is its right", shown(|_| 1.0, |[right, down]| [1.0 - right, down]))
    .mistake("a projected picture that stands upside down", shown(|_| 1.0, |[right, down]| [right, 1.0 - down]))
}
