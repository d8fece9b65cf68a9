//! Stacks of layers, apart from other materials: the device's paths against the reference's. Drivers that copy a function to each of its calls compile
//! kernels of stacks beside blends for long, and those of both with every other lobe for minutes.

use gpt::load;
use gpt::plan::PlanOptions;
use gpt::scene::{ColorInput, LayerModel, LayerStack, MaterialKind, Scene};

use super::materials::{grid, of_cell, owned};

/// Besides the examples of `layered`.
const STACKS: &[(&str, &str)] = &[
    (
        "a coat over glTF's material",
        "type = \"layered\"\ninterfaces = [\"varnish\", \"worn\"]\n\
         [[material]]\nname = \"worn\"\ntype = \"principled\"\nmetallic = 0.4\nroughness = { texture = \"clouds\" }\nclearcoat = 0.5\nnormal_map = \"bumps\"",
    ),
    (
        "layers with a map of their own",
        "type = \"layered\"\ninterfaces = [\"bent frost\", \"red\"]\nslabs = [{ thickness = 0.2, medium = \"pigment\" }]\n\
         [[material]]\nname = \"bent frost\"\ntype = \"rough_glass\"\nalpha = 0.2\nnormal_map = \"bumps\"",
    ),
    (
        "layers of layers",
        "type = \"layered\"\ninterfaces = [\"varnish\", \"inner\"]\n\
         [[material]]\nname = \"inner\"\ntype = \"layered\"\ninterfaces = [\"frost\", \"red\"]\nslabs = [{ thickness = { texture = \"clouds\" }, medium = \"pigment\" }]",
    ),
];

const BLENDS: &[(&str, &str)] = &[
    (
        "layers in a blend",
        "type = \"blend\"\nmaterials = [\"stacked\", \"red\"]\nweight = { type = \"facing\", power = 1 }\n\
         [[material]]\nname = \"stacked\"\ntype = \"layered\"\ninterfaces = [\"frost\", \"mirror\"]\nslabs = [{ thickness = 0.1, medium = \"pigment\" }]",
    ),
    (
        "a blend below a coat",
        "type = \"layered\"\ninterfaces = [\"varnish\", \"half mirror\"]\n\
         [[material]]\nname = \"half mirror\"\ntype = \"blend\"\nmaterials = [\"red\", \"mirror\"]\nweight = { type = \"fresnel\", ior = 1.4 }",
    ),
];

fn stacks() -> Vec<(String, String)> {
    let examples = load::file::material_examples().filter(|(name, _)| *name == "layered");
    examples.enumerate().map(|(index, (name, keys))| (format!("{name} {index}"), keys)).chain(owned(STACKS)).collect()
}

fn stack_of<'a>(scene: &'a mut Scene, cells: &[(String, String)], name: &str) -> &'a mut LayerStack {
    let index = of_cell(scene, cells, name);
    let MaterialKind::Layered(stack) = &mut scene.materials[index].kind else { panic!("{name} is a stack") };
    stack
}

#[test]
fn every_stack_agrees() {
    grid(3, &stacks()).assert_agrees("stacks", &PlanOptions::default(), |_| {});
}

#[test]
fn stacks_in_blends_and_blends_in_stacks_agree() {
    grid(2, &owned(BLENDS)).assert_agrees("stacks and blends", &PlanOptions::default(), |_| {});
}

/// The control: one of the stacks is a little different.
#[test]
#[ignore = "slow"]
fn another_stack_on_the_wall_is_noticed() {
    let cells = stacks();
    let slab = |scene: &mut Scene| {
        stack_of(scene, &cells, "layers with a map of their own").slabs[0].thickness = ColorInput::grey(0.24);
    };
    let side = |scene: &mut Scene| {
        let stack = stack_of(scene, &cells, "layered 2");
        assert!(std::mem::take(&mut stack.mirrored), "it lies on both sides");
    };
    let model = |scene: &mut Scene| {
        let stack = stack_of(scene, &cells, "layered 3");
        assert!(std::mem::replace(&mut stack.model, LayerModel::Walk) == LayerModel::Straight, "it is approximate");
    };
    let coat = |scene: &mut Scene| {
        let coated = of_cell(scene, &cells, "a coat over glTF's material");
        let MaterialKind::Layered(stack) = &scene.materials[coated].kind else { panic!("it is a stack") };
        let worn = *stack.interfaces.last().expect("it has interfaces");
        let MaterialKind::Principled(worn) = &mut scene.materials[worn].kind else { panic!("it is principled") };
        worn.metallic = ColorInput::grey(0.2);
    };
    grid(3, &cells).assert_notices(&[
        ("a slab a fifth thicker", &slab),
        ("layers on one side", &side),
        ("walks for Weidlich and Wilkie", &model),
        ("half the metal below a coat", &coat),
    ]);
}
