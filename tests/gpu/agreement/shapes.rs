//! Every shape as what rays meet, as a light, as a portal and in motion: the device's paths against the reference's.

use gpt::load::{self, SceneError};
use gpt::plan::{PlanOptions, StageMode, TraversalChoice};
use gpt::scene::{Estimator, Scene};

use super::materials::BUMPS;
use super::test_grid::{Change, TestGrid};
use super::{DEVICE, assert_agrees};
use crate::common::effort::in_full;

/// A floor under a shape of the material `m`.
const STAGE: &str = r#"
[film]
size = [32, 32]
[render]
spp = 8
max_depth = 4
[camera]
position = [1.2, 1.4, 4]
look_at = [0, -0.2, 0]
vfov = 45
shutter = [0, 1]
[[texture]]
name = "checks"
type = "checker"
a = [0.9, 0.2, 0.1]
b = [0.1, 0.3, 0.8]
scale = [6, 4]
[[texture]]
name = "bumps"
type = "image"
file = "bumps.png"
color_space = "linear"
[[material]]
name = "floor"
type = "diffuse"
reflectance = 0.6
[[shape]]
type = "rectangle"
corner = [-4, -1.3, 4]
edge_u = [8, 0, 0]
edge_v = [0, 0, -8]
material = "floor"
[[light]]
type = "sky"
zenith = [0.2, 0.4, 0.9]
horizon = [0.8, 0.8, 0.7]
ground = [0.2, 0.15, 0.1]
"#;

const TURNED: &str = "transform = [{ rotate = [1, 2, 0.5], degrees = 40 }, { scale = 1.1 }, { translate = [0.1, 0.05, -0.1] }]\n";
const MIRRORED: &str = "transform = [{ scale = -0.9 }, { rotate = [1, 2, 0.5], degrees = 40 }]\n";
const MOVING: &str = "motion = [{ rotate = [0.2, 1, 0.3], degrees = 70 }, { scale = 1.2 }, { translate = [0.3, 0.2, -0.1] }]\n";

fn stage(shape: &str, placed: &str, material: &str) -> Result<Scene, SceneError> {
    let text = format!("{STAGE}[[material]]\nname = \"m\"\n{material}\n{shape}material = \"m\"\n{placed}");
    load::load_toml_str(&text, "stage.toml", BUMPS.path())
}

const TEXTURED: &str =
    "type = \"phong\"\ndiffuse = { texture = \"checks\" }\nspecular = 0.3\nexponent = 20\nnormal_map = \"bumps\"";
const PLAIN: &str = "type = \"phong\"\ndiffuse = [0.6, 0.5, 0.3]\nspecular = 0.3\nexponent = 20";
const GLOWING: &str = "type = \"emissive\"\nradiance = [2, 1, 0.5]\ntwo_sided = true";
const ONE_SIDED: &str = "type = \"emissive\"\nradiance = [1, 2, 3]";
const PATTERNED: &str = "type = \"emissive\"\nradiance = { texture = \"checks\" }\ntwo_sided = true";

/// A shape in a part.
struct ShapeCase {
    name: String,
    shape: String,
    placed: String,
    material: &'static str,
    is_infinite: bool,
}

impl ShapeCase {
    fn scene(&self) -> Scene {
        stage(&self.shape, &self.placed, self.material).unwrap_or_else(|error| panic!("{}: {error}", self.name))
    }

    /// Small, in a cell of a grid.
    fn in_cell(&self, index: usize, [x, y]: [f64; 2]) -> String {
        let placed = self.placed.trim_end().trim_end_matches(']');
        format!(
            "[[material]]\nname = \"m{index}\"\n{}\n{}material = \"m{index}\"\n{placed}, {{ scale = 0.3 }}, {{ translate = [{x}, {y}, 0] }}]\n",
            self.material, self.shape
        )
    }
}

/// Every shape in all its parts; those that cannot be in one are told from the rest by what they are.
fn parts() -> Vec<ShapeCase> {
    let mut parts = Vec::new();
    for (name, shape) in load::file::shape_examples() {
        let plain = stage(&shape, TURNED, PLAIN).unwrap_or_else(|error| panic!("{error}"));
        let geometry = plain.shapes[1].geometry.clone();
        let mut add = |part: &str, placed: &str, material: &'static str| {
            let (shape, placed, is_infinite) = (shape.clone(), placed.to_owned(), geometry.is_infinite());
            parts.push(ShapeCase { name: format!("{name}, {part}"), shape, placed, material, is_infinite });
        };
        add("turned", TURNED, PLAIN);
        add("glowing", TURNED, GLOWING);
        add("mirrored and glowing on one side", MIRRORED, ONE_SIDED);
        if geometry.lacks_uv().is_none() {
            add("textured", TURNED, TEXTURED);
            add("mirrored and textured", MIRRORED, TEXTURED);
            add("patterned light", MIRRORED, PATTERNED);
        }
        if !geometry.is_infinite() {
            add("portal", &format!("portal = true\n{TURNED}"), "type = \"pass\"");
            add("moving", &format!("{MOVING}{TURNED}"), PLAIN);
            add("moving light", &format!("{MOVING}{TURNED}"), GLOWING);
        }
    }
    parts
}

/// All that a grid can hold: what is infinite would fill it, and portals would be what all its light comes through.
fn grid() -> (Vec<ShapeCase>, TestGrid) {
    let parts: Vec<ShapeCase> = parts().into_iter().filter(|part| !part.is_infinite && !part.name.ends_with("portal")).collect();
    let shared = STAGE.find("[[texture]]").expect("there are textures")..STAGE.rfind("[[shape]]").expect("there is a floor");
    let tables = format!(
        "{}{}[[material]]\nname = \"lamp\"\ntype = \"emissive\"\nradiance = [8, 7, 6]\n",
        &STAGE[shared],
        &STAGE[STAGE.find("[[light]]").expect("there is a sky")..]
    );
    let names = parts.iter().map(|part| part.name.clone()).collect();
    let grid = TestGrid::new(8, &tables, names, |index, place| parts[index].in_cell(index, place));
    (parts, grid)
}

#[test]
fn every_shape_agrees_in_every_part() {
    let by_wavefront =
        PlanOptions { traversal: TraversalChoice::Bvh, stages: Some(StageMode::Wavefront), ..PlanOptions::default() };
    let (_, grid) = grid();
    grid.assert_agrees("shapes", &PlanOptions::default(), |_| {});
    grid.assert_agrees("shapes, wavefront", &by_wavefront, |scene| scene.render.estimator = Estimator::Nee);
    let everywhere = in_full("each part of each shape alone");
    let alone = |part: &ShapeCase| part.is_infinite && (part.name.ends_with("turned") || part.name.ends_with("glowing"));
    for (index, part) in parts().into_iter().filter(|part| everywhere || alone(part)).enumerate() {
        let (name, mut scene) = (&part.name, part.scene());
        if index % 2 == 0 {
            assert_agrees(name, &scene, &PlanOptions::default());
        } else {
            scene.render.estimator = Estimator::Nee;
            assert_agrees(&format!("{name}, wavefront"), &scene, &by_wavefront);
        }
    }
}

/// The comparison notices a shape that is a hundredth larger: each of those on the grid, and infinite ones by
/// themselves.
#[test]
#[ignore = "slow"]
fn a_shape_off_by_a_hundredth_is_noticed() {
    let step = || gpt::scene::TransformStep::Scale(glam::DVec3::splat(1.01));
    let (parts, grid) = grid();
    // The first two shapes are the floor behind the grid and its lamp.
    let shape_of = |index: usize| index + 2;
    assert_eq!(grid.scene.shapes.len(), shape_of(parts.len()));
    let turned: Vec<usize> = (0..parts.len()).filter(|index| parts[*index].name.ends_with("turned")).collect();
    assert!(turned.len() > 5);
    let larger: Vec<_> = turned
        .iter()
        .map(|&index| move |scene: &mut Scene| scene.shapes[shape_of(index)].transform.steps.insert(0, step()))
        .collect();
    let changes: Vec<Change<'_>> =
        turned.iter().zip(&larger).map(|(&index, larger)| (parts[index].name.as_str(), larger as &dyn Fn(&mut Scene))).collect();
    grid.assert_notices(&changes);
    let everywhere = in_full("each shape alone that is a hundredth larger");
    let Some(device) = DEVICE.as_ref() else { return };
    for part in self::parts().into_iter().filter(|part| part.name.ends_with("turned") && (everywhere || part.is_infinite)) {
        let (name, scene) = (&part.name, part.scene());
        let mut larger = scene.clone();
        larger.shapes[1].transform.steps.insert(0, step());
        let mut gpu = gpt::gpu::GpuRenderer::on(device, &scene, &PlanOptions::default()).expect("the scene fits");
        let mut compare_with = |scene: &Scene| {
            let mut cpu = gpt::cpu::ReferenceRenderer::new(scene).expect("the scene is supported");
            gpt::verify::compare(scene, &mut gpu, &mut cpu, None).expect("both render")
        };
        let verdict = compare_with(&larger);
        assert!(!verdict.agrees || part.is_infinite && verdict.matching_share() < 1.0, "{name}: {verdict:#?}");
        assert!(compare_with(&scene).agrees, "{name}");
    }
}
