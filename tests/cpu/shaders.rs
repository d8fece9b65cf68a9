//! Every shader combination is valid WGSL and its layouts are those of the Rust side. No device is needed.

use std::collections::BTreeSet;
use std::sync::LazyLock;

use crate::common::effort::in_full;
use gpt::gpu::kernels::used_bindings;
use gpt::packed::PackedScene;
use gpt::plan::bindings::Binding;
use gpt::plan::chunks::{ATTRIBUTES, Chunks, INSTANCES, NODES, PRIMITIVES, RecordArray, TEXELS};
use gpt::plan::stages::{STAGES, Stage, When};
use gpt::plan::{DeviceLimits, Plan, PlanOptions, generated, layout};
use gpt::shader::switches::{SWITCHES, close, contradiction};
use gpt::shader::{ComposeError, Switches, compose};

/// The constants that a plan declares in front of kernels, and those of planted faults.
static CONSTANTS: LazyLock<Vec<&'static str>> = LazyLock::new(|| {
    let scene = gpt::load::load(Some("cornell")).expect("it is built in");
    let packed = PackedScene::new(&scene).expect("it packs");
    let plan = Plan::new(&scene, &packed, &DeviceLimits::default(), &PlanOptions::default()).expect("it fits");
    plan.switches.constants.keys().copied().chain(["PLANTED_LIGHT", "PLANTED_MATERIAL"]).collect()
});

/// A set of switches that some plan can make, with what the plan adds to it.
fn shippable(wanted: &BTreeSet<&'static str>) -> Switches {
    let geometry = "#import core/math.wgsl\n#import geometry/prepared_ray.wgsl\n\
                    fn closest_of_constants(ray: PreparedRay, hit: ptr<function, Hit>) {}\n\
                    fn any_of_constants(ray: PreparedRay, t_max: f32) -> bool { return false; }\n\
                    fn next_of_transparent_constants(ray: PreparedRay, after: Hit, t_max: f32) -> Hit { return after; }\n";
    // Three chunks, the last of half the size.
    let chunks =
        |array: RecordArray| (array.file, Chunks::new(array, 2500 * array.record_bytes(), 1000 * array.record_bytes()).wgsl());
    let cut = [PRIMITIVES, NODES, ATTRIBUTES, INSTANCES, TEXELS].into_iter().map(chunks);
    Switches {
        enabled: close(wanted),
        constants: CONSTANTS.iter().map(|name| (*name, 7)).collect(),
        generated: cut.chain(generated::files()).chain([("geometry/constants.wgsl", geometry.to_owned())]).collect(),
    }
}

fn validate_all(switches: &Switches) -> Result<(), (String, ComposeError)> {
    // Lanes side by side are always a packet.
    let runs = |file: &str| file != "stages/fused_lanes.wgsl" || switches.enabled.contains("PACKETS");
    for Stage { file, entry, .. } in STAGES.iter().filter(|stage| runs(stage.file)) {
        let describe = |error| (format!("{entry} with {:?}", switches.enabled), error);
        let composed = compose(file, switches).map_err(describe)?;
        composed.validate().map_err(describe)?;
    }
    Ok(())
}

/// Names that the files of a folder declare at their top level.
fn declared_in(folder: &str) -> BTreeSet<String> {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders").join(folder);
    let files = std::fs::read_dir(root).expect("the folder is there").map(|entry| entry.expect("it can be read").path());
    let declares = |line: &str| {
        let rest = ["fn ", "struct ", "alias ", "const "].into_iter().find_map(|keyword| line.strip_prefix(keyword))?;
        rest.split(|c: char| !c.is_alphanumeric() && c != '_').next().map(str::to_owned)
    };
    let names = files.flat_map(|file| {
        let text = std::fs::read_to_string(file).expect("a file of WGSL");
        text.lines().filter_map(declares).collect::<Vec<_>>()
    });
    names.collect()
}

/// Every stage by a set of switches, without comments.
fn kernels(enabled: &BTreeSet<&'static str>) -> String {
    let switches = shippable(enabled);
    let runs = |file: &str| file != "stages/fused_lanes.wgsl" || switches.enabled.contains("PACKETS");
    let stages = STAGES.iter().filter(|stage| runs(stage.file));
    let texts = stages.map(|Stage { file, .. }| compose(file, &switches).expect("it composes").text);
    let lines = |text: String| text.lines().map(|line| line.split("//").next().unwrap_or("").to_owned()).collect::<Vec<_>>();
    texts.flat_map(lines).collect::<Vec<_>>().join("\n")
}

/// A scene without media compiles nothing of them, and one whose media are homogeneous nothing of grids.
#[test]
fn kernels_hold_nothing_of_media_that_are_not_there() {
    let of_media = ["MEDIA", "MEDIUM_EMISSION", "MEDIUM_GRIDS", "SCATTERING", "OPEN_BOUNDARIES", "BY_ANGLE", "BY_DISTANCE"];
    let names = declared_in("shading/medium");
    let with = |switches: &[&'static str]| {
        let text = kernels(&switches.iter().copied().chain(["LIGHTS", "BLENDS", "NULL_SURFACES"]).collect());
        let words: BTreeSet<&str> = text.split(|c: char| !c.is_alphanumeric() && c != '_').collect();
        names.iter().filter(|name| words.contains(name.as_str())).cloned().collect::<Vec<_>>()
    };
    assert_eq!(with(&[]), [""; 0]);
    assert!(with(&["MEDIA"]).contains(&"medium_transmittance".to_owned()));
    let homogeneous = with(&["MEDIA", "SCATTERING", "OPEN_BOUNDARIES"]);
    let of_grids = declared_in("shading/medium").into_iter().filter(|name| name.contains("olume") || name.contains("voxel"));
    let of_grids: Vec<_> = of_grids.collect();
    assert!(of_grids.len() > 6 && of_grids.iter().all(|name| !homogeneous.contains(name)), "{homogeneous:?}");
    assert!(of_grids.iter().any(|name| with(&of_media[..5]).contains(name)));
}

fn all_names() -> BTreeSet<&'static str> {
    SWITCHES.iter().map(|row| row.name).collect()
}

/// All, none and each alone, and so many others that every two switches stand in all four ways, each with what the table requires: a
/// switch that needs another, or excludes one, and does not say so in the table shows here. The long form has each missing too.
#[test]
#[ignore = "slow"]
fn every_pair_of_switches_composes_to_valid_shaders() {
    let everything = all_names();
    let mut sets: BTreeSet<BTreeSet<&'static str>> = by_bits();
    for (index, first) in SWITCHES.iter().enumerate() {
        for second in &SWITCHES[index + 1..] {
            let ways: BTreeSet<_> = sets.iter().map(|set| (set.contains(first.name), set.contains(second.name))).collect();
            assert_eq!(ways.len(), 4, "{} and {} are not tried in every way", first.name, second.name);
        }
    }
    sets.extend(SWITCHES.iter().map(|row| BTreeSet::from([row.name])));
    if in_full("shaders with each switch missing, and 64 halves of them at random") {
        sets.extend((0..64).map(random_half));
        sets.extend(SWITCHES.iter().map(|row| everything.iter().copied().filter(|name| *name != row.name).collect()));
    }
    let shipped: BTreeSet<BTreeSet<&'static str>> = sets.iter().map(close).collect();
    assert!(shipped.len() > 50, "{} combinations", shipped.len());
    for row in SWITCHES.iter() {
        let on = shipped.iter().filter(|set| set.contains(row.name)).count();
        assert!(on > 0 && on < shipped.len(), "{} is on in {on} of {} combinations", row.name, shipped.len());
    }
    for set in &shipped {
        assert_eq!(contradiction(set), None);
        if let Err((what, error)) = validate_all(&shippable(set)) {
            panic!("{what}: {error}");
        }
    }
}

/// The sets of switches whose index has a certain bit set, and of those that have it clear, for every bit,
/// all and none: indices differ in a bit, so every two switches are apart both ways.
fn by_bits() -> BTreeSet<BTreeSet<&'static str>> {
    let bits = usize::BITS - SWITCHES.len().leading_zeros();
    let of_bit = |bit: u32, is_set: bool| {
        let chosen = move |index: usize| (index >> bit & 1 == 1) == is_set;
        SWITCHES.iter().enumerate().filter(|(index, _)| chosen(*index)).map(|(_, row)| row.name).collect()
    };
    (0..bits).flat_map(|bit| [of_bit(bit, false), of_bit(bit, true)]).chain([all_names(), BTreeSet::new()]).collect()
}

/// About half of the switches; which, `seed` says.
fn random_half(seed: u32) -> BTreeSet<&'static str> {
    let key = gpt::sampling::hash::mix(seed + 1);
    let chosen = |index: usize| gpt::sampling::hash::dimension_bits(key, index as u32) & 1 == 1;
    SWITCHES.iter().enumerate().filter(|(index, _)| chosen(*index)).map(|(_, row)| row.name).collect()
}

/// Renders pay nothing for what only debugging needs: without its switches, the functions that write a path down are empty, and no fault is
/// looked for.
#[test]
fn ordinary_kernels_hold_nothing_for_debugging() {
    let without = SWITCHES.iter().filter(|row| !row.debug).map(|row| row.name).collect();
    let mut with = all_names();
    with.retain(|name| !["PACKETS", "PIXEL_LIST", "TAKEN_PIXELS"].contains(name));
    // How many statements write a path down, whether there is a place to write to, and how many lines know of a fault.
    let left = |switches: &Switches| {
        let composed = compose("stages/fused.wgsl", switches).expect("it composes");
        let (module, _) = composed.validate().expect("it is valid");
        let hooks = module.functions.iter().filter(|(_, function)| {
            function.name.as_deref().is_some_and(|name| {
                name == "store_trace"
                    || name.starts_with("trace_") && !["trace_note", "trace_shadow_ray", "trace_vertex"].contains(&name)
            })
        });
        let mut count = 0;
        let does_something = |statement: &&naga::Statement| !matches!(statement, naga::Statement::Return { value: None });
        let statements: usize =
            hooks.inspect(|_| count += 1).map(|(_, function)| function.body.iter().filter(does_something).count()).sum();
        assert_eq!(count, 9, "the hooks are where they were");
        let has_target = module.global_variables.iter().any(|(_, variable)| variable.name.as_deref() == Some("path_trace"));
        let faults = composed.text.lines().filter(|line| !line.starts_with("const ") && line.contains("PLANTED_")).count();
        (statements, has_target, faults)
    };
    assert_eq!(left(&shippable(&without)), (0, false, 0));
    let (statements, has_target, faults) = left(&shippable(&with));
    assert!(statements > 10 && has_target && faults == 2, "{statements} {has_target} {faults}");
}

/// Nor for pixels with different numbers of samples, which would cost a load a pixel.
#[test]
fn ordinary_kernels_look_up_no_pixels() {
    let mut without = all_names();
    without.retain(|name| !["PIXEL_LIST", "TRACE"].contains(name));
    let mut with = all_names();
    with.remove("TRACE");
    for Stage { file, entry, .. } in STAGES.iter().filter(|stage| stage.when != When::EachVertex) {
        let looks_up = |wanted: &BTreeSet<&'static str>| {
            compose(file, &shippable(wanted)).expect("it composes").text.contains("listed_pixel")
        };
        assert!(!looks_up(&without) && looks_up(&with), "{entry}");
    }
}

/// Nor for lights in cells, where they are chosen otherwise.
#[test]
fn kernels_hold_nothing_of_cells_of_lights_where_these_are_not_used() {
    let mut with = all_names();
    with.remove("LIGHT_TREE");
    let mut without = with.clone();
    without.remove("LIGHT_CELLS");
    for Stage { file, entry, .. } in STAGES.iter().filter(|stage| ["shade", "trace_paths"].contains(&stage.entry)) {
        let lines = |wanted: &BTreeSet<&'static str>| {
            let text = compose(file, &shippable(wanted)).expect("it composes").text;
            text.lines().filter(|line| line.contains("light_cell")).count()
        };
        assert!(lines(&without) == 0 && lines(&with) > 5, "{entry}");
    }
}

#[test]
fn a_planted_mistake_is_found() {
    let mut switches = shippable(&all_names());
    switches.constants.remove("STACK_SIZE");
    assert!(validate_all(&switches).is_err());
}

/// Sizes and offsets of the structs that both sides have, by naga, against Rust's.
#[test]
fn layouts_match_between_wgsl_and_rust() {
    use gpt::packed::View;
    use gpt::plan::parameters::{PassParameters, VertexParameters};
    use gpt::shader::shared::SharedStruct;

    let module = naga::front::wgsl::parse_str(&layout::wgsl()).expect("the file stands alone");
    let members = |name: &str| {
        let (_, found) = module.types.iter().find(|(_, ty)| ty.name.as_deref() == Some(name)).expect("the struct exists");
        let naga::TypeInner::Struct { members, span } = &found.inner else { panic!("{name} is no struct") };
        let members: Vec<(String, usize)> =
            members.iter().map(|member| (member.name.clone().unwrap_or_default(), member.offset as usize)).collect();
        (members, *span as usize)
    };
    fn expected<T: SharedStruct>() -> (Vec<(String, usize)>, usize) {
        (T::fields().into_iter().map(|(name, offset)| (name.to_owned(), offset)).collect(), size_of::<T>())
    }
    assert_eq!(members("PassParameters"), expected::<PassParameters>());
    assert_eq!(members("VertexParameters"), expected::<VertexParameters>());
    assert_eq!(members("View"), expected::<View>());
    assert_ne!(members("View"), expected::<PassParameters>());
}

/// Every constant has one value and a name of its own, and records are whole numbers of vec4: kernels index them in words of 16 bytes.
#[test]
fn shared_constants_have_names_of_their_own() {
    use gpt::packed::attributes::TriangleAttributes;
    use gpt::packed::blend_weight::PackedBlendWeight;
    use gpt::packed::light::PackedLight;
    use gpt::packed::material::{PackedBlendPart, PackedMaterial};
    use gpt::packed::primitive::Primitive;
    use gpt::packed::{bvh4, texture::PackedTexture};
    let constants = layout::constants();
    let names: BTreeSet<&str> = constants.iter().map(|(name, _)| *name).collect();
    assert_eq!(names.len(), constants.len());
    let sizes = [
        size_of::<Primitive>(),
        size_of::<TriangleAttributes>(),
        size_of::<bvh4::Node>(),
        size_of::<PackedMaterial>(),
        size_of::<PackedLight>(),
        size_of::<PackedBlendPart>(),
        size_of::<PackedBlendWeight>(),
        size_of::<PackedTexture>(),
    ];
    assert!(sizes.iter().all(|size| size % 16 == 0), "{sizes:?}");
}

/// The table of stages says what each of them touches: no more and no less than naga finds in its code.
#[test]
fn stages_read_and_write_what_their_table_says() {
    let state: BTreeSet<u32> =
        STAGES.iter().flat_map(|stage| stage.reads.iter().chain(stage.writes)).map(|binding| *binding as u32).collect();
    for stage in STAGES {
        let mut wanted = all_names();
        wanted.retain(|name| !["ONLY_TRIANGLES_IN_HIERARCHY", "TRACE", "PIXEL_LIST"].contains(name));
        let (module, info) = compose(stage.file, &shippable(&wanted)).unwrap().validate().unwrap();
        let entry = module.entry_points.iter().position(|point| point.name == stage.entry).expect("the entry point exists");
        let (mut read, mut written) = (BTreeSet::new(), BTreeSet::new());
        for (handle, variable) in module.global_variables.iter() {
            let Some(number) = variable.binding.as_ref().map(|binding| binding.binding).filter(|number| state.contains(number))
            else {
                continue;
            };
            let used = info.get_entry_point(entry)[handle];
            if used.contains(naga::valid::GlobalUse::READ) {
                read.insert(number);
            }
            if used.contains(naga::valid::GlobalUse::WRITE) {
                written.insert(number);
            }
        }
        let numbers = |bindings: &[Binding]| bindings.iter().map(|binding| *binding as u32).collect::<BTreeSet<u32>>();
        let (reads, writes) = (numbers(stage.reads), numbers(stage.writes));
        assert_eq!(written, writes, "{} writes", stage.entry);
        assert!(read.union(&written).eq(reads.union(&writes)), "{} reads {read:?}, and the table says {reads:?}", stage.entry);
    }
}

/// WebGPU promises eight storage buffers a stage; no stage may need more.
#[test]
fn no_stage_needs_more_storage_buffers_than_webgpu_promises() {
    let mut wanted = all_names();
    for absent in ["ONLY_TRIANGLES_IN_HIERARCHY", "UNIFORM_PRIMITIVES", "UNIFORM_TABLES", "FILM_TEXTURE"] {
        wanted.remove(absent);
    }
    // Scenes too large for that, and instances, a guide or cells of lights beside everything else, are refused where a device has no more.
    for absent in [
        "PRIMITIVE_CHUNKS",
        "NODE_CHUNKS",
        "ATTRIBUTE_CHUNKS",
        "TEXEL_CHUNKS",
        "INSTANCES",
        "INSTANCE_CHUNKS",
        "GUIDE",
        "LIGHT_CELLS",
    ] {
        wanted.remove(absent);
    }
    for Stage { file, entry, .. } in STAGES {
        let (module, info) = compose(file, &shippable(&wanted)).unwrap().validate().unwrap();
        let storage = used_bindings(&module, &info, entry)
            .iter()
            .filter(|used| matches!(used.kind, wgpu::BindingType::Buffer { ty: wgpu::BufferBindingType::Storage { .. }, .. }))
            .count();
        assert!(storage <= 8, "{entry} uses {storage} storage buffers");
    }
}
