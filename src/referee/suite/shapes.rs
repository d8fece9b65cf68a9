//! Shapes, transforms and instances, by their outlines and their normals.

use std::f64::consts::FRAC_1_PI;

use super::super::formulas::{dot, normalized};
use super::super::test::Test;
use super::stage::{diffuse, emissive, fan, frontal, light, on_plane, scaled, scene, shape};

const COLOR: [f64; 3] = [1.0, 0.5, 0.25];
const PARALLEL: &str = "position = [0, 0, 4]\nlook_at = [0, 0, 0]\nprojection = \"orthographic\"\nheight = 2\n";

fn bright_if(is_bright: bool) -> [f64; 3] {
    if is_bright { COLOR } else { [0.0; 3] }
}

/// A scene of bright shapes seen by parallel rays.
fn outlines(shapes: &str) -> String {
    scene(PARALLEL, &format!("{}{shapes}", emissive("bright", COLOR)))
}

pub fn tests() -> Vec<Test> {
    [flat(), round(), placed()].into_iter().flatten().collect()
}

fn flat() -> Vec<Test> {
    let disk = |radius: f64| {
        move |s: f64, t: f64| {
            let [x, y] = on_plane(s, t);
            bright_if((x - 0.1).hypot(y + 0.05) < radius)
        }
    };
    let corners = [[-0.7, -0.5, 0.0], [0.8, -0.3, 0.0], [-0.1, 0.75, 0.0]];
    let inside = move |point: [f64; 2]| {
        (0..3).all(|index| {
            let (a, b) = (corners[index], corners[(index + 1) % 3]);
            (b[0] - a[0]) * (point[1] - a[1]) - (b[1] - a[1]) * (point[0] - a[0]) > 0.0
        })
    };
    vec![
        Test::of_formula(
            ["shapes/disk", "The outline of a disk.", "Geometry"],
            outlines(&shape("disk", "bright", "center = [0.1, -0.05, 0]\nnormal = [0, 0, 1]\nradius = 0.7")),
            disk(0.7),
        )
        .with_edges()
        .mistake("a polygon of few corners in place of a disk, smaller by 3 %", disk(0.68)),
        Test::of_formula(
            ["shapes/triangle", "The outline of one triangle.", "Geometry"],
            outlines(&fan("bright", &corners, "")),
            move |s, t| bright_if(inside(on_plane(s, t))),
        )
        .with_edges()
        .mistake("a triangle that is seen from its front alone, from its back", |_, _| [0.0; 3]),
    ]
}

fn round() -> Vec<Test> {
    let lit = |shapes: &str| {
        let sun = light("directional", "direction = [-0.6, 0, -0.8]\nirradiance = [3, 2, 1]");
        scene(PARALLEL, &format!("{}{shapes}{sun}", diffuse(0.5)))
    };
    let sun = [0.6, 0.0, 0.8];
    let lambert = move |normal: [f64; 3]| scaled([3.0, 2.0, 1.0], 0.5 * FRAC_1_PI * dot(normal, sun).max(0.0));
    let of_ball = move |s: f64, t: f64| {
        let [x, y] = on_plane(s, t).map(|axis| axis / 0.8);
        let z2 = 1.0 - x * x - y * y;
        if z2 > 0.0 { lambert([x, y, z2.sqrt()]) } else { [0.0; 3] }
    };
    let of_tube = move |s: f64, t: f64| {
        let [x, y] = on_plane(s, t);
        let across = x / 0.6;
        if across.abs() < 1.0 && y.abs() < 0.7 { lambert([across, 0.0, (1.0 - across * across).sqrt()]) } else { [0.0; 3] }
    };
    // Four corners whose normals lean outward; the middle of each edge has the normal between.
    let [lean, flat] = [0.6, 0.8];
    let quad = [[-0.8, -0.8, 0.0], [0.8, -0.8, 0.0], [0.8, 0.8, 0.0], [-0.8, 0.8, 0.0]];
    let normals = format!("normals = [[{0}, 0, {flat}], [{lean}, 0, {flat}], [{lean}, 0, {flat}], [{0}, 0, {flat}]]", -lean);
    let of_quad = move |s: f64, t: f64| {
        let [x, y] = on_plane(s, t);
        if x.abs() < 0.8 && y.abs() < 0.8 { lambert(normalized([lean * x / 0.8, 0.0, flat])) } else { [0.0; 3] }
    };
    // Twice as wide before it is scaled; normals are scaled by the inverse.
    let wide = quad.map(|[x, y, z]| [2.0 * x, y, z]);
    let squeezed = move |factor: f64| {
        move |s: f64, t: f64| {
            let [x, y] = on_plane(s, t);
            if x.abs() < 0.8 && y.abs() < 0.8 { lambert(normalized([factor * lean * x / 0.8, 0.0, flat])) } else { [0.0; 3] }
        }
    };
    let of_faces = move |s: f64, t: f64| {
        let [x, y] = on_plane(s, t);
        if x.abs() < 0.8 && y.abs() < 0.8 { lambert([0.0, 0.0, 1.0]) } else { [0.0; 3] }
    };
    vec![
        Test::of_formula(
            ["shapes/sphere", "A sphere in parallel light: its outline, and a cosine at each point.", "Cosine law"],
            lit(&shape("sphere", "m", "center = [0, 0, 0]\nradius = 0.8")),
            of_ball,
        )
        .with_edges()
        .mistake("light that wraps around the sphere", move |s, t| {
            let value = of_ball(s, t);
            let [x, y] = on_plane(s, t);
            if x.hypot(y) < 0.8 { value.map(|channel| channel + 0.02) } else { value }
        }),
        Test::of_formula(
            ["shapes/cylinder", "The wall of a tube in parallel light.", "Cosine law"],
            lit(&shape("cylinder", "m", "from = [0, -0.7, 0]\nto = [0, 0.7, 0]\nradius = 0.6")),
            of_tube,
        )
        .with_edges()
        .mistake("a tube of flat normals", move |s, t| {
            let [x, y] = on_plane(s, t);
            if x.abs() < 0.6 && y.abs() < 0.7 { lambert([0.0, 0.0, 1.0]) } else { [0.0; 3] }
        }),
        Test::of_formula(
            [
                "shapes/flattened",
                "Normals of a mesh that is scaled along one axis are scaled by the inverse.",
                "Normals are covectors",
            ],
            lit(&fan("m", &wide, &format!("{normals}\ntransform = [{{ scale = [0.5, 1, 1] }}]"))),
            squeezed(2.0),
        )
        .with_edges()
        .mistake("normals that are scaled as points are", squeezed(0.5))
        .mistake("normals that are not scaled", squeezed(1.0)),
        Test::of_formula(
            ["shapes/smooth-normals", "Normals of corners are interpolated and have length 1 again.", "glTF: NORMAL; Phong 1975"],
            lit(&fan("m", &quad, &normals)),
            of_quad,
        )
        .with_edges()
        .mistake("the face's normal in place of the corners'", of_faces),
    ]
}

fn placed() -> Vec<Test> {
    let square = |point: [f64; 2], middle: [f64; 2], half: f64| (0..2).all(|axis| (point[axis] - middle[axis]).abs() < half);
    let order = move |middle: [f64; 2], half: f64| move |s: f64, t: f64| bright_if(square(on_plane(s, t), middle, half));
    let place = |x: f64, y: f64, scale: f64| format!("[{scale}, 0, 0, {x}, 0, {scale}, 0, {y}, 0, 0, 1, 0]");
    let instances = format!(
        "[[group]]\nname = \"square\"\n[[group.shape]]\ntype = \"mesh\"\nmaterial = \"m\"\n\
         positions = [[-0.1, -0.1, 0], [0.1, -0.1, 0], [0.1, 0.1, 0], [-0.1, 0.1, 0]]\nfaces = [[0, 1, 2], [0, 2, 3]]\n\
         [[instance]]\ngroup = \"square\"\nplaces = [{}, {}, {}]\n",
        place(-0.6, 0.5, 1.0),
        place(0.3, 0.4, 2.0),
        place(-0.2, -0.5, 3.0)
    );
    let of_instances = move |sizes: [f64; 3]| {
        move |s: f64, t: f64| {
            let point = on_plane(s, t);
            let middles = [[-0.6, 0.5], [0.3, 0.4], [-0.2, -0.5]];
            let is_square = (0..3).any(|index| square(point, middles[index], sizes[index]));
            scaled([0.2, 0.6, 1.0], if is_square { 0.5 } else { 1.0 })
        }
    };
    let mirrored = {
        let sun = light("directional", "direction = [-0.6, 0, -0.8]\nirradiance = [3, 2, 1]");
        let keys =
            "normals = [[-0.6, 0, 0.8], [0.6, 0, 0.8], [0.6, 0, 0.8], [-0.6, 0, 0.8]]\ntransform = [{ scale = [-1, 1, 1] }]";
        // Normals differ from left to right as the corners do, so the mirror image lies as the original does.
        let skew = [[-0.8, -0.8, 0.0], [0.4, -0.8, 0.0], [0.4, 0.8, 0.0], [-0.8, 0.8, 0.0]];
        let value = |turned: bool| {
            move |s: f64, t: f64| {
                let [x, y] = on_plane(s, t);
                let own = -x;
                if !(-0.8..0.4).contains(&own) || y.abs() > 0.8 {
                    return [0.0; 3];
                }
                let across = 2.0 * (own + 0.8) / 1.2 - 1.0;
                let normal = normalized([if turned { 0.6 } else { -0.6 } * across, 0.0, 0.8]);
                scaled([3.0, 2.0, 1.0], 0.5 * FRAC_1_PI * dot(normal, [0.6, 0.0, 0.8]).max(0.0))
            }
        };
        Test::of_formula(
            [
                "shapes/mirrored",
                "A mesh with normals that is mirrored by its transform.",
                "glTF: a transform of negative determinant turns the winding, not the normal",
            ],
            scene(PARALLEL, &format!("{}{}{sun}", diffuse(0.5), fan("m", &skew, keys))),
            value(false),
        )
        .with_edges()
        .mistake("normals that are not mirrored with the corners", value(true))
        .mistake("a mirrored mesh that is black, as if seen from behind", |_, _| [0.0; 3])
    };
    vec![
        Test::of_formula(
            ["shapes/order-of-steps", "What is scaled first and moved then is not what is moved first.", "`transform` of the scene file; glTF: T·R·S"],
            outlines(&shape(
                "rectangle",
                "bright",
                "corner = [-0.5, -0.5, 0]\nedge_u = [1, 0, 0]\nedge_v = [0, 1, 0]\ntransform = [{ scale = 0.5 }, { translate = [0.6, 0.4, 0] }]",
            )),
            order([0.6, 0.4], 0.25),
        )
        .with_edges()
        .mistake("what is moved before it is scaled", order([0.3, 0.2], 0.25)),
        Test::of_formula(
            ["shapes/rotation", "A rotation by 30 degrees about the axis towards the viewer goes counter-clockwise.", "Right-handed coordinates"],
            outlines(&shape(
                "rectangle",
                "bright",
                "corner = [-0.7, -0.2, 0]\nedge_u = [1.4, 0, 0]\nedge_v = [0, 0.4, 0]\ntransform = [{ rotate = [0, 0, 1], degrees = 30 }]",
            )),
            turned(-30.0),
        )
        .with_edges()
        .mistake("a rotation that goes clockwise", turned(30.0)),
        Test::of_formula(
            ["shapes/instances", "One square in three places, each with a size of its own.", "Instances are copies"],
            scene(PARALLEL, &format!("{}{instances}{}", diffuse(0.5), light("environment", "radiance = [0.2, 0.6, 1]"))),
            of_instances([0.1, 0.2, 0.3]),
        )
        .with_edges()
        .mistake("instances without their own scale", of_instances([0.1, 0.1, 0.1])),
        mirrored,
        Test::of_formula(
            ["shapes/nearest", "Of two surfaces the nearer one is seen, in whatever order they are written.", "Opacity"],
            frontal(&format!(
                "{}{}{}{}",
                emissive("bright", COLOR),
                emissive("far", [0.0, 1.0, 0.0]),
                shape("rectangle", "bright", "corner = [-0.4, -0.4, 0]\nedge_u = [0.8, 0, 0]\nedge_v = [0, 0.8, 0]"),
                shape("rectangle", "far", "corner = [-4, -4, -0.001]\nedge_u = [8, 0, 0]\nedge_v = [0, 8, 0]")
            )),
            |s, t| {
                let point = on_plane(s, t);
                if point.iter().all(|axis| axis.abs() < 0.4) { COLOR } else { [0.0, 1.0, 0.0] }
            },
        )
        .with_edges()
        .mistake("the farther surface in front", |_, _| [0.0, 1.0, 0.0]),
    ]
}

/// The rectangle of `shapes/rotation`, after its points are turned back by so many degrees.
fn turned(degrees: f64) -> impl Fn(f64, f64) -> [f64; 3] {
    let (sine, cosine) = degrees.to_radians().sin_cos();
    move |s, t| {
        let [x, y] = on_plane(s, t);
        bright_if((cosine * x - sine * y).abs() < 0.7 && (sine * x + cosine * y).abs() < 0.2)
    }
}
