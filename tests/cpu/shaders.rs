//! Every shader combination is valid WGSL and its layouts are those of the Rust side. No device is needed.

use std::collections::BTreeSet;

use gpt::gpu::kernels::used_bindings;
use gpt::plan::chunks::{ATTRIBUTES, Chunks, NODES, PRIMITIVES, RecordArray};
use gpt::plan::switches::{ALL, DEBUG};
use gpt::shader::{ComposeError, Switches, compose};

const STAGES: [(&str, &str); 8] = [
    ("stages/fused.wgsl", "trace_paths"),
    ("stages/fused_lanes.wgsl", "trace_paths"),
    ("stages/generate.wgsl", "generate"),
    ("stages/extend.wgsl", "extend"),
    ("stages/shade.wgsl", "shade"),
    ("stages/prepare.wgsl", "prepare"),
    ("stages/connect.wgsl", "connect"),
    ("stages/accumulate.wgsl", "accumulate"),
];

/// A set of switches that some plan can make: implications of `plan::switches::choose` hold.
fn shippable(mut wanted: BTreeSet<&'static str>) -> Switches {
    let by_query = !wanted.contains("BVH");
    if wanted.contains("ONLY_TRIANGLES_IN_HIERARCHY") {
        wanted.insert("TRIANGLES_IN_HIERARCHY");
        for other in ["QUADS_IN_HIERARCHY", "SPHERES_IN_HIERARCHY", "DISKS_IN_HIERARCHY"] {
            wanted.remove(other);
        }
    }
    if wanted.contains("DISKS_IN_HIERARCHY") {
        wanted.insert("FLAT_ROUND");
    }
    if wanted.contains("SPHERES_IN_HIERARCHY") {
        wanted.insert("SPHERES");
    }
    if wanted.contains("SPHERE_LIGHTS") {
        wanted.insert("SPHERES");
    }
    if wanted.contains("TRACE") {
        wanted.remove("PIXEL_LIST");
    }
    // What fits a uniform buffer is not cut.
    for (chunks, uniform) in [("PRIMITIVE_CHUNKS", "UNIFORM_PRIMITIVES"), ("NODE_CHUNKS", "UNIFORM_NODES")] {
        if wanted.contains(chunks) {
            wanted.remove(uniform);
        }
    }
    for (name, needed) in [
        ("VARYING_LIGHTS", &["EMISSION", "LIGHTS"][..]),
        ("PACKETS", &["BVH"]),
        ("MOVING_LIGHTS", &["MOTION", "ATTRIBUTES", "BVH"]),
        ("MOTION", &["ATTRIBUTES", "BVH"]),
        ("NODE_CHUNKS", &["BVH"]),
        ("ATTRIBUTE_CHUNKS", &["ATTRIBUTES"]),
        ("NULL_SURFACES", &["BLENDS"]),
        ("PICK", &["BLENDS"]),
        ("CHECKERS", &["TEXTURES", "PROCEDURAL_TEXTURES"]),
        ("PERLIN", &["TEXTURES", "PROCEDURAL_TEXTURES"]),
        ("WORLEY", &["TEXTURES", "PROCEDURAL_TEXTURES"]),
        ("IMAGES", &["TEXTURES"]),
        ("NORMAL_MAPS", &["TEXTURES"]),
        ("CONDUCTOR", &["MICROFACETS", "SCALARS"]),
        ("GLOSSY", &["COSINE_POWER", "SCALARS"]),
        ("PHONG", &["COSINE_POWER", "SCALARS", "SECOND_COLORS"]),
        ("PHONG_GLASS", &["COSINE_POWER", "SCALARS", "SECOND_COLORS"]),
        ("ROUGH_GLASS", &["GLASS", "MICROFACETS", "SCALARS", "SECOND_COLORS"]),
    ] {
        if wanted.contains(name) {
            wanted.extend(needed);
        }
    }
    // Ray queries stand where no hierarchy of ours does, and see a scene at rest.
    if wanted.contains("RAY_QUERY") && by_query {
        for needing_nodes in ["BVH", "PACKETS", "MOTION", "MOVING_LIGHTS", "NODE_CHUNKS"] {
            wanted.remove(needing_nodes);
        }
    } else {
        wanted.remove("RAY_QUERY");
    }
    // A blend is a mixture unless a leaf of it is picked; only mixtures have lobes to tell apart.
    if wanted.contains("BLENDS") && !wanted.contains("PICK") {
        wanted.insert("MIXTURE");
    } else {
        wanted.remove("MIXTURE");
        wanted.remove("MORE_LOBES");
    }
    for (name, needed) in [
        ("ENVIRONMENT_LIGHT", &["ENVIRONMENT_SAMPLED"][..]),
        ("PORTALS", &["ENVIRONMENT_SAMPLED"]),
        ("ENVIRONMENT_SAMPLED", &["ENVIRONMENT", "LIGHTS"]),
        ("ENVIRONMENT_MAP", &["ENVIRONMENT", "TEXELS"]),
        ("IMAGES", &["TEXELS"]),
        ("SPHERE_LIGHTS_VISIBLE_HALF", &["SPHERE_LIGHTS_BY_POINT"]),
    ] {
        if wanted.contains(name) {
            wanted.extend(needed);
        }
    }
    let lights = ["DIRECTIONAL_LIGHTS", "FLAT_LIGHTS", "SPHERE_LIGHTS", "POINT_LIGHTS", "SPOT_LIGHTS", "ONE_LIGHT"];
    if !wanted.contains("LIGHTS") {
        for light in lights {
            wanted.remove(light);
        }
    }
    if wanted.contains("ESTIMATOR_NEE") {
        wanted.remove("ESTIMATOR_MIS");
    }
    let constants = [
        "BLADES",
        "ENVIRONMENT_FIRST_DENSITY",
        "ENVIRONMENT_FIRST_NODE",
        "ENVIRONMENT_FIRST_TEXEL",
        "ENVIRONMENT_GRID_HEIGHT",
        "ENVIRONMENT_GRID_WIDTH",
        "ENVIRONMENT_HEIGHT",
        "ENVIRONMENT_LIGHT_INDEX",
        "ENVIRONMENT_QUADTREE_LEVELS",
        "ENVIRONMENT_WIDTH",
        "FILM_WIDTH",
        "FIRST_HEURISTIC_WORD",
        "FIRST_LEAF_WORD",
        "FIRST_LIGHT_WORD",
        "FIRST_MOTION_WORD",
        "FIRST_PORTAL",
        "FIRST_TEXTURE_WORD",
        "LANES",
        "LIGHT_COUNT",
        "LIGHT_SAMPLES",
        "LIGHT_SAMPLES_DEPTH",
        "MAX_DEPTH",
        "MAX_SAMPLES_PER_PASS",
        "PATH_CAPACITY",
        "PLANTED_LIGHT",
        "PLANTED_MATERIAL",
        "PORTAL_COUNT",
        "PRIMITIVE_WORDS",
        "RAYS_PER_INVOCATION",
        "ROULETTE_DEPTH",
        "RUNS",
        "SEQUENCE_BLOCKS",
        "SEQUENCE_POINTS",
        "SEQUENCE_STRIDE",
        "STACK_SIZE",
        "TABLE_WORDS",
        "NODE_WORDS",
    ];
    let geometry = "#import core/math.wgsl\n#import geometry/primitives.wgsl\n\
                    fn closest_of_constants(ray: PreparedRay, hit: ptr<function, Hit>) {}\n\
                    fn any_of_constants(ray: PreparedRay, t_max: f32) -> bool { return false; }\n";
    // Three chunks, the last of half the size.
    let chunks =
        |array: RecordArray| (array.file, Chunks::new(array, 2500 * array.record_bytes(), 1000 * array.record_bytes()).wgsl());
    let cut = [PRIMITIVES, NODES, ATTRIBUTES].into_iter().map(chunks);
    Switches {
        enabled: wanted,
        constants: constants.into_iter().map(|name| (name, 7)).collect(),
        generated: cut.chain([("geometry/constants.wgsl", geometry.to_owned())]).collect(),
    }
}

fn validate_all(switches: &Switches) -> Result<(), (String, ComposeError)> {
    // Lanes side by side are always a packet.
    let runs = |file: &str| file != "stages/fused_lanes.wgsl" || switches.enabled.contains("PACKETS");
    for (file, entry) in STAGES.into_iter().filter(|(file, _)| runs(file)) {
        let describe = |error| (format!("{entry} with {:?}", switches.enabled), error);
        let composed = compose(file, switches).map_err(describe)?;
        composed.validate().map_err(describe)?;
    }
    Ok(())
}

/// All, none, each alone, each missing, and 64 halves at random, among which every two switches stand in all four ways: a switch that
/// needs another, or excludes one, shows here.
#[test]
fn every_pair_of_switches_composes_to_valid_shaders() {
    let everything: BTreeSet<&'static str> = ALL.iter().copied().collect();
    let mut sets: BTreeSet<BTreeSet<&'static str>> = [everything.clone(), BTreeSet::new()].into();
    for first in ALL {
        let mut missing = everything.clone();
        missing.remove(first);
        sets.extend([missing, BTreeSet::from([*first])]);
    }
    let halves: Vec<BTreeSet<&'static str>> = (0..64).map(random_half).collect();
    for (index, first) in ALL.iter().enumerate() {
        for second in &ALL[index + 1..] {
            let ways: BTreeSet<_> = halves.iter().map(|half| (half.contains(first), half.contains(second))).collect();
            assert_eq!(ways.len(), 4, "{first} and {second} are not tried in every way");
        }
    }
    sets.extend(halves);
    let shipped: BTreeSet<BTreeSet<&'static str>> = sets.into_iter().map(|set| shippable(set).enabled).collect();
    assert!(shipped.len() > 100, "{} combinations", shipped.len());
    for set in shipped {
        if let Err((what, error)) = validate_all(&shippable(set)) {
            panic!("{what}: {error}");
        }
    }
}

/// About half of the switches; which, `seed` says.
fn random_half(seed: u32) -> BTreeSet<&'static str> {
    let key = gpt::sampling::hash::mix(seed + 1);
    let chosen = |index: usize| gpt::sampling::hash::dimension_bits(key, index as u32) & 1 == 1;
    ALL.iter().enumerate().filter(|(index, _)| chosen(*index)).map(|(_, name)| *name).collect()
}

/// Renders pay nothing for what only debugging needs: without its switches, the functions that write a path down are empty, and no fault is
/// looked for.
#[test]
fn ordinary_kernels_hold_nothing_for_debugging() {
    let without: BTreeSet<&'static str> = ALL.iter().copied().filter(|name| !DEBUG.contains(name)).collect();
    let with = ALL.iter().copied().collect();
    // How many statements write a path down, whether there is a place to write to, and how many lines know of a fault.
    let left = |switches: &Switches| {
        let composed = compose("stages/fused.wgsl", switches).expect("it composes");
        let (module, _) = composed.validate().expect("it is valid");
        let hooks = module.functions.iter().filter(|(_, function)| {
            function.name.as_deref().is_some_and(|name| {
                name == "store_trace" || name.starts_with("trace_") && !["trace_note", "trace_vertex"].contains(&name)
            })
        });
        let mut count = 0;
        let does_something = |statement: &&naga::Statement| !matches!(statement, naga::Statement::Return { value: None });
        let statements: usize =
            hooks.inspect(|_| count += 1).map(|(_, function)| function.body.iter().filter(does_something).count()).sum();
        assert_eq!(count, 8, "the hooks are where they were");
        let has_target = module.global_variables.iter().any(|(_, variable)| variable.name.as_deref() == Some("path_trace"));
        let faults = composed.text.lines().filter(|line| !line.starts_with("const ") && line.contains("PLANTED_")).count();
        (statements, has_target, faults)
    };
    assert_eq!(left(&shippable(without)), (0, false, 0));
    let (statements, has_target, faults) = left(&shippable(with));
    assert!(statements > 10 && has_target && faults == 2, "{statements} {has_target} {faults}");
}

/// Nor for pixels with different numbers of samples, which would cost a load a pixel.
#[test]
fn ordinary_kernels_look_up_no_pixels() {
    let without: BTreeSet<&'static str> = ALL.iter().copied().filter(|name| !["PIXEL_LIST", "TRACE"].contains(name)).collect();
    let with: BTreeSet<&'static str> = ALL.iter().copied().filter(|name| *name != "TRACE").collect();
    for (file, entry) in [STAGES[0], STAGES[1], STAGES[2], STAGES[7]] {
        let looks_up = |wanted: &BTreeSet<&'static str>| {
            compose(file, &shippable(wanted.clone())).expect("it composes").text.contains("listed_pixel")
        };
        assert!(!looks_up(&without) && looks_up(&with), "{entry}");
    }
}

#[test]
fn a_planted_mistake_is_found() {
    let mut switches = shippable(ALL.iter().copied().collect());
    switches.constants.remove("STACK_SIZE");
    assert!(validate_all(&switches).is_err());
}

/// Sizes and offsets of structs and array strides in WGSL, by naga, against Rust's.
#[test]
fn layouts_match_between_wgsl_and_rust() {
    use gpt::gpu::parameters::{PassParameters, VertexParameters};
    use gpt::packed::View;
    use std::mem::offset_of;

    let mut wanted: BTreeSet<&'static str> = ALL.iter().copied().collect();
    wanted.remove("ONLY_TRIANGLES_IN_HIERARCHY");
    let composed = compose("stages/shade.wgsl", &shippable(wanted)).unwrap();
    let (module, _) = composed.validate().unwrap();
    let members = |name: &str| {
        let (_, found) = module.types.iter().find(|(_, ty)| ty.name.as_deref() == Some(name)).expect("the struct exists");
        let naga::TypeInner::Struct { members, span } = &found.inner else { panic!("{name} is no struct") };
        let members: Vec<(String, u32)> =
            members.iter().map(|member| (member.name.clone().unwrap_or_default(), member.offset)).collect();
        (members, *span as usize)
    };
    macro_rules! check {
        ($rust:ty, $wgsl:literal, $($field:ident),*) => {
            let expected = vec![$((stringify!($field).to_owned(), offset_of!($rust, $field) as u32)),*];
            assert_eq!(members($wgsl), (expected, size_of::<$rust>()), $wgsl);
        };
    }
    check!(
        PassParameters,
        "PassParameters",
        first_pixel,
        first_pixel_in_band,
        pixel_count,
        first_sample,
        sample_count,
        film_is_empty,
        opaque_zero,
        seed,
        run_length,
        padding_0,
        padding_1,
        padding_2
    );
    check!(VertexParameters, "VertexParameters", vertex, queue, padding);
    check!(
        View,
        "View",
        position,
        corner,
        step_x,
        step_y,
        forward,
        lens_u,
        lens_v,
        environment,
        sky_zenith,
        sky_ground,
        filter_curve
    );
}

/// Packed records are whole numbers of vec4: the shaders index them in words of 16 bytes.
#[test]
fn packed_records_are_the_words_that_shaders_count() {
    use gpt::packed::{blend_weight::PackedBlendWeight, bvh4, light::PackedLight, material::*, primitive::*, texture::*};
    assert_eq!(size_of::<Primitive>(), 3 * 16);
    assert_eq!(size_of::<TriangleAttributes>(), 4 * 16);
    assert_eq!(size_of::<bvh4::Node>(), 3 * 16);
    assert_eq!(size_of::<PackedMaterial>(), 5 * 16);
    assert_eq!(size_of::<PackedLight>(), 5 * 16);
    assert_eq!(size_of::<PackedLeaf>(), 16);
    assert_eq!(size_of::<PackedBlendWeight>(), 16);
    assert_eq!(size_of::<PackedTexture>(), 4 * 16);
}

/// WebGPU promises eight storage buffers a stage; no stage may need more.
#[test]
fn no_stage_needs_more_storage_buffers_than_webgpu_promises() {
    let mut wanted: BTreeSet<&'static str> = ALL.iter().copied().collect();
    for absent in ["ONLY_TRIANGLES_IN_HIERARCHY", "UNIFORM_PRIMITIVES", "UNIFORM_TABLES", "FILM_TEXTURE"] {
        wanted.remove(absent);
    }
    // Scenes too large for that are refused where a device has no more.
    for absent in ["PRIMITIVE_CHUNKS", "NODE_CHUNKS", "ATTRIBUTE_CHUNKS"] {
        wanted.remove(absent);
    }
    for (file, entry) in STAGES {
        let (module, info) = compose(file, &shippable(wanted.clone())).unwrap().validate().unwrap();
        let storage = used_bindings(&module, &info, entry)
            .iter()
            .filter(|used| matches!(used.kind, wgpu::BindingType::Buffer { ty: wgpu::BufferBindingType::Storage { .. }, .. }))
            .count();
        assert!(storage <= 8, "{entry} uses {storage} storage buffers");
    }
}
