//! Packed scenes that use every array.

use std::sync::Arc;

use glam::{DAffine3, DMat3, DQuat, DVec3, Vec2, Vec3};

use gpt_scene::light_examples::delta_light_examples;

use crate::packed::PackedScene;
use crate::packed::hierarchy::Traversal;
use crate::packed::light::LightKind;
use crate::sampling::light_cells::table;
use crate::scene::{
    BlendWeight, Channel, ChannelInput, ColorInput, ColorSpace, ConductorFresnel, Cuboid, Disk, Emission, Environment,
    EnvironmentRadiance, Geometry, Group, ImageData, ImageTexture, Instances, LayerModel, LayerStack, Light, LightChoice,
    Masking, Material, MaterialKind, Medium, Mesh, MicrofacetDistribution, Microfacets, Motion, MotionStep, Phase, Plane,
    PlasticInterface, ProjectedTexture, Rectangle, Scene, Shape, Slab, Sphere, Texels, Texture, TextureFilter, TextureKind,
    TextureWrap, Transform,
};
use crate::spectrum::Spectrum;

/// By name: walked by kernels, and left to the device. Lights are chosen by a tree in the first, by cells in the second.
pub fn all() -> Vec<(&'static str, PackedScene)> {
    let pack = |mut scene: Scene, traversal, light_choice| {
        scene.render.light_choice = light_choice;
        PackedScene::for_traversal(&scene, traversal).expect("it is valid")
    };
    let mut with = everything();
    add_instances(&mut with);
    let nodes = pack(with, Traversal::Bvh, LightChoice::Tree);
    let mut boxes = pack(everything(), Traversal::RayQuery, LightChoice::Cells);
    boxes.light_cells = light_cells(boxes.lights.len() as u32);
    vec![("nodes", nodes), ("boxes", boxes)]
}

/// Two boxes for each facing, and two cells that name all of so many lights.
fn light_cells(lights: u32) -> Vec<u32> {
    let mut words = [0.0_f32, 0.0, 0.0, 1.0].map(f32::to_bits).to_vec();
    words.extend([2, 1, 1, 8 + 12]);
    words.extend((0..12).map(|number| number % 3));
    words.extend((0..2 * table::LIGHT_CELL_SLOTS).map(|slot| (slot % lights) | (1 << table::LIGHT_SLOT_COUNT_SHIFT)));
    words
}

/// `side` × `side` squares, each of two triangles.
pub fn grid(side: u32) -> PackedScene {
    let mut scene = Scene::default();
    scene.materials.push(plain("grey", MaterialKind::Diffuse { reflectance: ColorInput::grey(0.5) }));
    scene.shapes.push(shape(Geometry::Mesh(Arc::new(mesh(side, &[]))), 0));
    PackedScene::new(&scene).expect("it is valid")
}

fn plain(name: &str, kind: MaterialKind) -> Material {
    Material { name: name.into(), kind, normal_map: None, emission: None, two_sided: true, interior: None }
}

fn shape(geometry: Geometry, material: usize) -> Shape {
    Shape { label: "shape".into(), geometry, material, transform: Transform::default(), motion: None, portal: false, receiver: 0 }
}

fn mesh(side: u32, face_materials: &[usize]) -> Mesh {
    let mut mesh = Mesh { smooth: true, ..Mesh::default() };
    for y in 0..=side {
        for x in 0..=side {
            mesh.positions.push(Vec3::new(x as f32, y as f32, 0.0));
            mesh.normals.push(Vec3::Z);
            mesh.uvs.push(Vec2::new(x as f32, y as f32) / side as f32);
        }
    }
    for y in 0..side {
        for x in 0..side {
            let [a, b] = [y * (side + 1) + x, (y + 1) * (side + 1) + x];
            mesh.faces.extend([[a, a + 1, b], [b, a + 1, b + 1]]);
        }
    }
    mesh.face_materials.extend((0..mesh.faces.len()).filter_map(|face| face_materials.get(face % face_materials.len().max(1))));
    mesh
}

fn image(width: u32, height: u32) -> Arc<ImageData> {
    let count = (width * height) as usize;
    // One of each way in which texels are kept.
    let texels = match width {
        1 => Texels::Bytes { codes: vec![[1, 2, 3, 4]; count], space: ColorSpace::Srgb },
        2 => Texels::Shorts { codes: vec![[1, 2, 3, 4]; count], space: ColorSpace::Linear },
        3 => Texels::Half(vec![[0x3800; 4]; count]),
        4 => Texels::FloatAlpha(vec![[0.1, 0.5, 0.2, 0.7]; count]),
        // An area light that emits it is sampled by it.
        6 => Texels::Float((0..count).map(|index| [if index == 7 { 50.0 } else { 0.1 }; 3]).collect()),
        _ => Texels::Float((0..count).map(|index| [0.1 * index as f32, 0.5, 0.2]).collect()),
    };
    Arc::new(ImageData { width, height, texels, has_alpha: false })
}

/// Two groups, of which one moves and has a material of its own.
fn add_instances(scene: &mut Scene) {
    for side in [1, 2] {
        let shape = shape(Geometry::Mesh(Arc::new(mesh(side, &[]))), 1);
        scene.groups.push(Group { name: "group".into(), shapes: vec![shape] });
    }
    let sink = Motion::new(vec![MotionStep::Translate(DVec3::NEG_Y)]);
    for (group, material, motion) in [(0, None, None), (1, Some(0), Some(sink))] {
        let places =
            [1.0, -2.0].map(|x| DAffine3::from_scale_rotation_translation(DVec3::new(x, 1.0, 1.0), DQuat::IDENTITY, DVec3::Y));
        let transform = Transform::default();
        let places = Arc::new(places.to_vec());
        scene.instances.push(Instances {
            label: "instance".into(),
            group,
            places,
            transform,
            material,
            motion,
            pivot: None,
            receiver: 0,
        });
    }
}

/// Every kind of primitive, material, texture and light; shapes that move, a blend of blends of which one emits, a map and portals.
fn everything() -> Scene {
    let mut scene = Scene::default();
    let [a, b] = [Spectrum::grey(0.1), Spectrum::grey(0.9)];
    let picture = |width, wrap, filter| {
        TextureKind::Image(ImageTexture { image: image(width, 2), wrap: [wrap, TextureWrap::Mirror], filter, scale: [2.0, 1.0] })
    };
    for kind in [
        picture(2, TextureWrap::Repeat, TextureFilter::Bilinear),
        picture(3, TextureWrap::Mirror, TextureFilter::Nearest),
        picture(1, TextureWrap::Clamp, TextureFilter::Bilinear),
        TextureKind::Checker { a, b, scale: [4.0; 2] },
        TextureKind::Perlin { scale: 3.0, octaves: 4, a, b, seed: 1 },
        TextureKind::Worley { scale: 3.0, a, b, seed: 2 },
        picture(4, TextureWrap::Repeat, TextureFilter::Bilinear),
        picture(5, TextureWrap::Repeat, TextureFilter::Nearest),
        picture(6, TextureWrap::Clamp, TextureFilter::Bilinear),
    ] {
        scene.textures.push(Texture::new("texture", kind));
    }
    (scene.textures[0].times, scene.textures[3].times) = (Some(5), Some(1));
    let channel =
        |texture, channel| ColorInput::Channel(ChannelInput { texture, channel, factor: Spectrum::grey(0.5), is_squared: false });
    let (grey, of) = (ColorInput::grey(0.5), ColorInput::Texture);
    let rough = |facets| MaterialKind::RoughGlass {
        ior: 1.5,
        facets,
        reflectance: grey,
        transmittance: grey,
        thin: false,
        film: None,
        dispersion: None,
    };
    let plastic =
        |interface| MaterialKind::Plastic { interface, reflectance: of(0), specular_reflectance: grey, nonlinear: true };
    let brushed = MaterialKind::Conductor {
        fresnel: ConductorFresnel::Reflectance(grey),
        facets: Microfacets { alpha_v: Some(ColorInput::SquaredTexture(1)), ..Microfacets::ggx(of(2)) },
        specular_reflectance: of(3),
        film: None,
    };
    let rough_interface = PlasticInterface::rough(1.5, 0.3, MicrofacetDistribution::Beckmann, Masking::Separable);
    scene.media.push(Medium {
        name: "milk".into(),
        absorption: Spectrum::BLACK,
        scattering: Spectrum::WHITE,
        emission: Spectrum::BLACK,
        phase: Phase::isotropic(),
        grids: None,
    });
    let slab = Slab { thickness: of(1), medium: Some(0) };
    let layers = LayerStack { interfaces: vec![4, 12], slabs: vec![slab], model: LayerModel::Walk, mirrored: false };
    let blend = |materials, weight| MaterialKind::Blend { materials, weight };
    let threshold = BlendWeight::Threshold { tau: 0.5, of: Box::new(BlendWeight::Texture { texture: 4 }) };
    for (kind, emission) in [
        (MaterialKind::Diffuse { reflectance: of(0) }, None),
        (MaterialKind::Mirror { reflectance: of(3) }, None),
        (MaterialKind::Glossy { reflectance: grey, exponent: of(1) }, None),
        (MaterialKind::Phong { diffuse: channel(6, Channel::A), specular: of(5), exponent: channel(7, Channel::G) }, None),
        (rough(Microfacets::ggx(ColorInput::SquaredTexture(2))), None),
        (rough(Microfacets::phong(ColorInput::grey(50.0))), None),
        (MaterialKind::Emissive, Some(of(4))),
        (blend([0, 1], BlendWeight::Facing { power: 2.0 }), Some(grey)),
        (blend([7, 2], BlendWeight::Fresnel { ior: 1.5, exact: true }), None),
        (blend([3, 8], threshold), None),
        (MaterialKind::Pass, None),
        (plastic(PlasticInterface::smooth(1.5)), None),
        (brushed, None),
        (plastic(rough_interface), None),
        (MaterialKind::Layered(Box::new(layers)), None),
    ] {
        let emission = emission.map(|radiance| Emission { radiance, two_sided: true });
        scene.materials.push(Material { emission, ..plain("material", kind) });
    }
    scene.materials[5].normal_map = Some(2);
    scene.materials[3].two_sided = false;
    scene.materials[12].two_sided = false;
    let turning = Motion::new(vec![
        MotionStep::Rotate { axis: DVec3::Y, degrees: 40.0 },
        MotionStep::Translate(DVec3::X),
        MotionStep::Scale(DVec3::splat(0.9)),
    ]);
    let ball = |x: f64| Geometry::Sphere(Sphere { center: DVec3::new(x, 4.0, 0.0), radius: 1.0 });
    let sheet = |z: f64| Geometry::Rectangle(Rectangle { corner: DVec3::new(0.0, 0.0, z), edge_u: DVec3::X, edge_v: DVec3::Y });
    let disk = Geometry::Disk(Disk { center: DVec3::new(0.0, 8.0, 0.0), normal: DVec3::Y, radius: 1.0 });
    for (geometry, material, moves) in [
        (Geometry::Mesh(Arc::new(mesh(3, &[0, 1, 2, 4, 9, 11, 12, 13, 14]))), 0, false),
        (Geometry::Mesh(Arc::new(mesh(2, &[]))), 5, true),
        (ball(0.0), 6, false),
        (ball(3.0), 8, true),
        (ball(6.0), 9, false),
        (sheet(2.0), 6, true),
        (sheet(3.0), 3, false),
        (disk, 5, false),
        (Geometry::Plane(Plane { point: DVec3::NEG_Y, normal: DVec3::Y }), 5, false),
        (Geometry::Box(Cuboid { min: DVec3::ZERO, max: DVec3::ONE }), 0, false),
    ] {
        scene.shapes.push(Shape { motion: moves.then(|| turning.clone()), ..shape(geometry, material) });
    }
    scene.shapes.push(Shape { portal: true, ..shape(sheet(5.0), 10) });
    scene.shapes.push(Shape { portal: true, ..shape(ball(9.0), 10) });
    // Geometry without texture coordinates has no texture either.
    scene.materials.push(plain("grey", MaterialKind::Diffuse { reflectance: grey }));
    let last = scene.materials.len() - 1;
    scene.shapes[7].material = last;
    scene.shapes[8].material = last;
    let emission = Some(Emission { radiance: of(8), two_sided: false });
    scene.materials.push(Material { emission, ..plain("screen", MaterialKind::Emissive) });
    scene.shapes.push(shape(sheet(7.0), last + 1));
    scene.lights = delta_light_examples().into_iter().map(|(_, light)| light).collect();
    assert!(scene.lights.len() >= LightKind::DELTA.len(), "every kind has an example: {:?}", scene.lights);
    for light in &mut scene.lights {
        match light {
            Light::Spot(spot) => spot.picture = Some(ProjectedTexture { texture: 1, up: DVec3::X }),
            Light::Projector(projector) => projector.texture = Some(4),
            _ => {}
        }
    }
    let radiance = EnvironmentRadiance::Map(image(5, 3));
    scene.lights.push(Light::Environment(Environment {
        radiance,
        rotation_degrees: 30.0,
        turn: Some(DMat3::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 0.7)),
        rows: Default::default(),
        mirrored: false,
    }));
    scene
}
