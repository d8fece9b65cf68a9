//! Plans: what fits a device, and what is refused with sizes named. No device is needed.

use glam::DVec3;
use gpt::load;
use gpt::packed::PackedScene;
use gpt::packed::bvh4::Child;
use gpt::packed::hierarchy::Traversal;
use gpt::plan::{
    DeviceLimits, FilmStorage, GeometryPlacement, Plan, PlanError, PlanOptions, RayQueryDefault, RayQueryLimits, StageMode,
    TraversalChoice,
};
use gpt::scene::{
    Estimator, LightChoice, MisHeuristic, PhongCosine, PhongHorizon, PhongSampling, PixelSampler, RenderSettings, SamplerKind,
    Scene, TransformStep,
};
use gpt::shader::compose;
use std::collections::BTreeSet;
use std::path::Path;

fn plan(scene: &Scene, limits: &DeviceLimits) -> Result<Plan, PlanError> {
    let packed = PackedScene::new(scene).expect("the scene packs");
    Plan::new(scene, &packed, limits, &PlanOptions::default())
}

fn packed(scene: &Scene) -> PackedScene {
    PackedScene::new(scene).expect("the scene packs")
}

/// A grid of triangles, `side` quads along each side, under an environment.
fn grid(side: usize) -> Scene {
    let positions: Vec<String> =
        (0..=side).flat_map(|y| (0..=side).map(move |x| format!("[{x}, {}, {y}]", (x * 7 + y * 3) % 5))).collect();
    let at = |x: usize, y: usize| y * (side + 1) + x;
    let faces: Vec<String> = (0..side)
        .flat_map(|y| (0..side).map(move |x| (x, y)))
        .map(|(x, y)| {
            let [a, b, c, d] = [at(x, y), at(x + 1, y), at(x, y + 1), at(x + 1, y + 1)];
            format!("[{a}, {c}, {b}], [{b}, {c}, {d}]")
        })
        .collect();
    let text = format!(
        "[camera]\nposition = [0, 9, 20]\nlook_at = [5, 0, 5]\nvfov = 40\n\
         [[material]]\nname = \"grey\"\ntype = \"diffuse\"\nreflectance = 0.5\n\
         [[shape]]\ntype = \"mesh\"\nmaterial = \"grey\"\npositions = [{}]\nfaces = [{}]\n\
         [[light]]\ntype = \"environment\"\nradiance = 1.0\n",
        positions.join(", "),
        faces.join(", ")
    );
    load::load_toml_str(&text, "grid", Path::new(".")).expect("the scene is valid")
}

#[test]
fn small_scenes_are_constants_and_large_ones_a_hierarchy() {
    let limits = DeviceLimits::default();
    let cornell = plan(&load::load(Some("cornell")).expect("it is built in"), &limits).expect("it fits");
    assert_eq!(cornell.geometry, GeometryPlacement::Unrolled);
    let grid = plan(&grid(20), &limits).expect("it fits");
    assert_eq!(grid.geometry, GeometryPlacement::Hierarchy);
}

/// On hardware, one kernel traces whole paths where it is small, and queues take over where it holds many features or where several shadow rays leave
/// a surface for a hierarchy.
#[test]
fn stages_on_hardware_follow_what_the_scene_needs() {
    let hardware = DeviceLimits { max_storage_binding: 1 << 30, max_buffer: 1 << 30, ..DeviceLimits::default() };
    let software = DeviceLimits { software: true, subgroup_size: Some(8), ..hardware.clone() };
    let builtin = |name| load::load(Some(name)).expect("it is built in");
    let with_light_samples = |mut scene: Scene, count: u32| {
        scene.render.light_samples = count.into();
        scene
    };
    for (name, scene, expected) in [
        ("few features", builtin("cornell"), StageMode::Fused),
        ("few features in a hierarchy", grid(20), StageMode::Fused),
        ("many features", builtin("gallery"), StageMode::Wavefront),
        ("two shadow rays in a hierarchy", with_light_samples(builtin("motion-blur"), 2), StageMode::Fused),
        ("four shadow rays in a hierarchy", with_light_samples(builtin("motion-blur"), 4), StageMode::Wavefront),
        ("so many that few paths fit", with_light_samples(builtin("motion-blur"), 8), StageMode::Fused),
        ("four shadow rays without one", with_light_samples(builtin("cornell"), 4), StageMode::Fused),
    ] {
        assert_eq!(plan(&scene, &hardware).expect("it fits").stages, expected, "{name}");
        assert_eq!(plan(&scene, &software).expect("it fits").stages, StageMode::Fused, "{name}, in software");
    }
}

/// Lanes of hardware that differ read storage faster; with few bindings, uniform buffers leave them to what needs them.
#[test]
fn hardware_with_bindings_to_spare_reads_small_arrays_from_storage() {
    let scene = load::load(Some("cornell")).expect("it is built in");
    for (limits, uniform) in [
        (DeviceLimits { max_storage_buffers: 64, ..DeviceLimits::default() }, false),
        (DeviceLimits::default(), true),
        (DeviceLimits { max_storage_buffers: 64, software: true, ..DeviceLimits::default() }, true),
    ] {
        let plan = plan(&scene, &limits).expect("it fits");
        assert_eq!([plan.uniform_primitives, plan.uniform_tables], [uniform; 2], "{limits:?}");
    }
}

/// A device with less memory has fewer paths in flight, and large films go band by band.
#[test]
fn less_memory_means_fewer_paths_and_a_smaller_film() {
    let limits = DeviceLimits::default();
    let less = limits.with_less_memory([64, 64]).expect("there can be fewer paths");
    assert!(less.path_capacity < limits.path_capacity);
    assert!(less.with_less_memory([4096, 4096]).is_none(), "there is nothing left to save");
    let software = DeviceLimits { software: true, path_capacity: less.path_capacity, ..limits };
    assert!(software.with_less_memory([64, 64]).is_none());
    assert!(software.with_less_memory([4096, 4096]).is_some_and(|less| less.film_pixels < software.film_pixels));
}

#[test]
fn every_decision_has_its_reason() {
    let because = |plan: &Plan, about: &str| {
        let decision = plan.decisions.iter().find(|decision| decision.about == about).expect("it is decided");
        assert!(plan.to_string().contains(&format!("{} ({})", decision.choice, decision.because)), "{plan}");
        decision.because.clone()
    };
    let hardware = DeviceLimits::default();
    let software = DeviceLimits { software: true, subgroup_size: Some(8), ..hardware.clone() };
    let grid = grid(20);
    let plan_for_hardware = plan(&grid, &hardware).expect("it fits");
    assert_eq!(because(&plan_for_hardware, "geometry"), "800 primitives, more than 64");
    assert_eq!(because(&plan_for_hardware, "primitives"), "38 KiB, at most 64");
    assert!(because(&plan_for_hardware, "stages").contains("registers"));
    assert!(plan_for_hardware.decisions.iter().all(|decision| decision.about != "lanes"));
    let plan_for_software = plan(&grid, &software).expect("it fits");
    assert!(because(&plan_for_software, "stages").contains("software"));
    assert!(because(&plan_for_software, "lanes").contains("software"));

    let options = PlanOptions { stages: Some(StageMode::Wavefront), traversal: TraversalChoice::Bvh, ..PlanOptions::default() };
    let packed = PackedScene::new(&grid).expect("the scene packs");
    let forced = Plan::new(&grid, &packed, &software, &options).expect("it fits");
    assert_eq!([because(&forced, "stages"), because(&forced, "geometry")], ["asked for", "asked for"]);
}

#[test]
fn an_array_beyond_the_largest_binding_is_refused_with_both_sizes() {
    let mut scene = grid(60);
    scene.film.size = [64, 64];
    let limits = DeviceLimits { max_array: 100 << 10, ..DeviceLimits::default() };
    match plan(&scene, &limits) {
        Err(PlanError::DoesNotFit(message)) => {
            let expected = "its primitives need 0.3 MiB, and the device can bind 0.1 MiB at once; in chunks of that size a stage would \
                            need up to 9 buffers, and can have 8";
            assert_eq!(message, expected);
        }
        other => panic!("{other:?}"),
    }
    assert!(plan(&scene, &DeviceLimits::default()).is_ok());
    // A device that binds more buffers takes it in chunks.
    let more = DeviceLimits { max_storage_buffers: 9, ..limits };
    assert_eq!(plan(&scene, &more).expect("it fits").chunks.iter().map(|array| array.count).collect::<Vec<_>>(), [4, 1]);
}

#[test]
fn the_film_goes_into_buffers_where_textures_cannot_be_read_and_written() {
    let scene = load::load(Some("spheres")).expect("it is built in");
    let with = DeviceLimits { read_write_rgba32float: true, ..DeviceLimits::default() };
    assert_eq!(plan(&scene, &with).expect("it fits").film, FilmStorage::Texture);
    assert_eq!(plan(&scene, &DeviceLimits::default()).expect("it fits").film, FilmStorage::Buffer);
    let narrow = DeviceLimits { max_texture_side: 256, ..with.clone() };
    assert_eq!(plan(&scene, &narrow).expect("it fits").film, FilmStorage::Buffer);
    // A storage that is asked for is taken or refused.
    let asked = |film, limits: &DeviceLimits| {
        Plan::new(&scene, &packed(&scene), limits, &PlanOptions { film: Some(film), ..PlanOptions::default() })
    };
    let in_buffers = asked(FilmStorage::Buffer, &with).expect("it fits");
    assert_eq!(in_buffers.film, FilmStorage::Buffer);
    assert!(in_buffers.to_string().contains("storage buffers, all 360 rows together (asked for)"), "{in_buffers}");
    assert_eq!(asked(FilmStorage::Texture, &with).expect("it fits").film, FilmStorage::Texture);
    for limits in [DeviceLimits::default(), narrow] {
        let refused = asked(FilmStorage::Texture, &limits);
        assert!(refused.is_err_and(|error| error.to_string().contains("640 pixels wide; without `--film textures`")));
    }
}

/// A film has all its rows on the device, so that samples go over all of it first, up to what the device can hold; from there on device memory
/// does not grow with the picture.
#[test]
fn a_films_device_memory_is_bounded() {
    let mut scene = load::load(Some("cornell")).expect("it is built in");
    let mut of_size = |size: [u32; 2]| {
        scene.film.size = size;
        let plan = plan(&scene, &DeviceLimits::default()).expect("it fits");
        (plan.memory.total(), plan.band_rows)
    };
    let (small, full) = (of_size([512, 512]), of_size([3840, 2160]));
    assert_eq!([small.1, full.1], [512, 2160]);
    let huge = of_size([32_768, 32_768]);
    assert!(huge.1 < 32_768 && huge.0 <= 1 << 30 && full.0 < huge.0, "{small:?}, {full:?}, {huge:?}");
}

/// The plan says who takes places in queues, where there are queues, and kernels exchange values only on devices that can.
#[test]
fn subgroups_take_places_in_queues_on_devices_that_have_them() {
    let scene = grid(20);
    let said = |subgroups: bool, software: bool| {
        let stages = Some(StageMode::Wavefront).filter(|_| !software);
        let options = PlanOptions { stages, ..PlanOptions::default() };
        let limits = DeviceLimits { subgroups, software, ..DeviceLimits::default() };
        let plan = Plan::new(&scene, &packed(&scene), &limits, &options).expect("it fits");
        assert_eq!(plan.switches.enabled.contains("SUBGROUP_QUEUES"), plan.subgroup_queues);
        plan.to_string().lines().find(|line| line.starts_with("queues")).map(str::to_owned)
    };
    assert_eq!(said(true, false).as_deref(), Some("queues         one atomic a subgroup (the device has subgroups)"));
    assert_eq!(said(false, false).as_deref(), Some("queues         one atomic a path (the device has no subgroups)"));
    assert_eq!(said(true, true), None, "paths stay in one kernel");
}

/// A plan for another traversal than the scene was packed for would read arrays that are not there.
#[test]
fn a_scene_packed_for_another_traversal_is_refused() {
    let scene = grid(20);
    let limits = DeviceLimits { ray_queries: Some(RayQueryLimits { max_primitives: 1 << 24 }), ..DeviceLimits::default() };
    for traversal in [TraversalChoice::Auto, TraversalChoice::Bvh, TraversalChoice::RayQuery] {
        for packed_for in [Traversal::Bvh, Traversal::RayQuery] {
            let packed = PackedScene::for_traversal(&scene, packed_for).expect("the scene packs");
            let options = PlanOptions { traversal, ..PlanOptions::default() };
            match Plan::new(&scene, &packed, &limits, &options) {
                Ok(plan) => {
                    assert_eq!(
                        (options.packed_traversal(&scene, Some(&limits)), plan.traversal_in_use()),
                        (packed_for, Some(packed_for))
                    );
                    assert_eq!(plan.switches.enabled.contains("BVH"), packed_for == Traversal::Bvh);
                    assert_eq!(plan.switches.enabled.contains("RAY_QUERY"), packed_for == Traversal::RayQuery);
                }
                Err(PlanError::Internal(_)) => assert_ne!(options.packed_traversal(&scene, Some(&limits)), packed_for),
                Err(error) => panic!("{error}"),
            }
        }
    }
}

/// Ray queries are what `auto` means where verification passed, and nowhere else; and only for scenes that
/// they can see.
#[test]
fn verified_ray_queries_are_used_unasked() {
    let verified = DeviceLimits {
        ray_queries: Some(RayQueryLimits { max_primitives: 1 << 24 }),
        ray_query_default: RayQueryDefault::Verified,
        ..DeviceLimits::default()
    };
    let plan = |scene: &Scene, limits: &DeviceLimits, traversal| {
        let options = PlanOptions { traversal, ..PlanOptions::default() };
        let packed = PackedScene::for_traversal(scene, options.packed_traversal(scene, Some(limits))).expect("the scene packs");
        Plan::new(scene, &packed, limits, &options).expect("it fits")
    };
    let because = |plan: &Plan| plan.decisions.iter().find(|decision| decision.about == "hierarchy").map(|d| d.because.clone());
    let still = grid(20);
    let by_queries = plan(&still, &verified, TraversalChoice::Auto);
    assert_eq!(by_queries.traversal_in_use(), Some(Traversal::RayQuery));
    assert_eq!(because(&by_queries).as_deref(), Some("verified on this device with this driver"));
    assert_eq!(plan(&still, &verified, TraversalChoice::Bvh).traversal_in_use(), Some(Traversal::Bvh));
    let shipped = |name| load::load(Some(name)).expect("a shipped scene");
    let few = shipped("cornell");
    assert_eq!(plan(&few, &verified, TraversalChoice::Auto).traversal_in_use(), None, "constants stay constants");
    let moving = shipped("motion-blur");
    assert_eq!(plan(&moving, &verified, TraversalChoice::Auto).traversal_in_use(), Some(Traversal::Bvh));
    let unverified = DeviceLimits { ray_queries: None, ray_query_default: RayQueryDefault::Unverified, ..verified };
    let by_nodes = plan(&still, &unverified, TraversalChoice::Auto);
    assert_eq!(by_nodes.traversal_in_use(), Some(Traversal::Bvh));
    assert!(because(&by_nodes).is_some_and(|because| because.contains("gpt verify --traversal ray-query")));
}

/// The stack a traversal needs is found from the tree; every tree of these grids fits what is compiled in.
#[test]
fn the_stack_covers_the_deepest_way() {
    for side in [1, 6, 30, 90] {
        let hierarchy = packed(&grid(side)).hierarchy;
        // Walk every path with the pushes of the kernel: all children on, one off.
        let mut deepest = 0;
        let mut pending = vec![(0_usize, 0_u32)];
        while let Some((node, waiting)) = pending.pop() {
            let children = hierarchy.nodes[node].children();
            let pushed = children.len() as u32;
            deepest = deepest.max(waiting + pushed);
            let others = (waiting + pushed).saturating_sub(1);
            pending.extend(children.iter().filter_map(|child| match child {
                Child::Inner(inner) => Some((*inner, others)),
                Child::Leaf { .. } => None,
            }));
        }
        assert_eq!(deepest, hierarchy.stack_size, "{side}");
    }
}

/// Frames whose hierarchies differ a little have the same kernels, so that nothing is compiled between them.
#[test]
fn hierarchies_of_about_one_size_have_the_same_kernels() {
    let kernels = |scene: &Scene, limits: &DeviceLimits| -> Vec<String> {
        let plan = plan(scene, limits).expect("it fits");
        plan.pipeline().map(|stage| compose(stage.file, &plan.switches).expect("it composes").text).collect()
    };
    let software = DeviceLimits { software: true, ..DeviceLimits::default() };
    for limits in [DeviceLimits::default(), software] {
        let (mut trees, mut texts) = (BTreeSet::new(), BTreeSet::new());
        for height in [0.1, 1.0, 3.0, 9.0, 30.0] {
            let mut scene = grid(20);
            scene.shapes[0].transform.steps.push(TransformStep::Scale(DVec3::new(1.0, height, 1.0)));
            let hierarchy = packed(&scene).hierarchy;
            trees.insert((hierarchy.nodes.len(), hierarchy.stack_size));
            texts.insert(kernels(&scene, &limits));
        }
        assert!(trees.len() > 1 && texts.len() == 1, "{} kernels of {trees:?}", texts.len());
        // The control: more triangles are other kernels.
        assert!(!texts.contains(&kernels(&grid(21), &limits)));
    }
}

/// The hierarchy is built on as many cores as there are, and is the same on any number: pictures are.
#[test]
fn the_number_of_cores_does_not_show() {
    let scene = grid(60);
    let on = |cores: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(cores).build().expect("threads");
        pool.install(|| packed(&scene))
    };
    let alone = on(1);
    for cores in [2, 5] {
        let together = on(cores);
        assert_eq!(alone.hierarchy.nodes, together.hierarchy.nodes);
        assert!(alone.primitives == together.primitives);
    }
}

/// Settings that are there to compare strategies leave no word in kernels of scenes that have nothing for them to change, and each does where it is
/// something.
#[test]
#[ignore = "slow"]
fn what_is_studied_is_compiled_only_where_it_is() {
    let texts = |name: &str, change: &dyn Fn(&mut RenderSettings)| -> Vec<String> {
        let mut scene = load::load(Some(name)).expect("built-in scenes load");
        change(&mut scene.render);
        let plan = plan(&scene, &DeviceLimits::default()).expect("it fits");
        plan.pipeline().map(|stage| compose(stage.file, &plan.switches).expect("it composes").text).collect()
    };
    let phong: [&dyn Fn(&mut RenderSettings); 3] = [
        &|render| render.phong_cosine = PhongCosine::Dropped,
        &|render| render.phong_sampling = PhongSampling::Hemisphere,
        &|render| render.phong_horizon = PhongHorizon::Flipped,
    ];
    let others: [&dyn Fn(&mut RenderSettings); 5] = [
        &|render| render.estimator = Estimator::Choose,
        &|render| render.heuristic = MisHeuristic::Maximum,
        &|render| render.heuristic_exponent = 3.0,
        &|render| render.sampler = SamplerKind::Congruential,
        &|render| render.pixel_sampler = PixelSampler::Other(SamplerKind::Congruential),
    ];
    let [without_lobes, with_lobes] = ["cornell", "stage"].map(|name| texts(name, &|_| ()));
    for change in phong {
        assert_eq!(texts("cornell", change), without_lobes);
        assert_ne!(texts("stage", change), with_lobes);
    }
    for change in others {
        assert_ne!(texts("cornell", change), without_lobes);
    }
    // Points are made on the host, whatever the sampler.
    let by_halton = texts("cornell", &|render| render.sampler = SamplerKind::Halton);
    assert_eq!(texts("cornell", &|render| render.sampler = SamplerKind::Hammersley), by_halton);
    // None has a word of what is studied.
    let words = ["lcg_bits4", "HEURISTIC_CUTOFF_BITS", "HEURISTIC_EXPONENT_BITS", "roulette_bits << 1u"];
    for text in without_lobes.iter().chain(&with_lobes) {
        assert!(words.iter().all(|word| !text.contains(word)), "{text}");
    }
}

/// Materials and textures without a surface cost nothing: not a word of the kernels, of the tables or of the
/// texels.
#[test]
fn materials_and_textures_that_nothing_uses_leave_no_trace() {
    let room = include_str!("../../scenes/cornell.toml");
    let unused = "
        [[texture]]
        name = \"marble\"
        type = \"perlin\"
        a = 0.2
        b = 0.8
        scale = 4
        octaves = 4
        [[material]]
        name = \"frosted\"
        type = \"rough_glass\"
        ior = 1.5
        roughness = 0.2
        [[material]]
        name = \"veined\"
        type = \"mirror\"
        reflectance = { texture = \"marble\" }
        [[material]]
        name = \"mixed\"
        type = \"blend\"
        materials = [\"frosted\", \"veined\"]
        weight = { type = \"facing\" }
        emission = 3
        ";
    let on_a_surface = "
        [[shape]]
        type = \"sphere\"
        center = [100, 100, 100]
        radius = 50
        material = \"mixed\"
        ";
    let packed = |more: &[&str]| {
        let text = format!("{room}{}", more.concat());
        let scene = load::load_toml_str(&text, "room", Path::new(".")).expect("the scene is valid");
        let packed = PackedScene::new(&scene).expect("the scene packs");
        let plan = Plan::new(&scene, &packed, &DeviceLimits::default(), &PlanOptions::default()).expect("it fits");
        // Words are compared as bits: "no index" is a NaN.
        let tables: Vec<_> = packed.tables().words.iter().map(|word| word.map(f32::to_bits)).collect();
        (tables, packed.materials.scene_ids, plan)
    };
    let (tables, materials, plan) = packed(&[]);
    assert_eq!(materials, [0, 1, 2, 3]);
    let (tables_beside, materials_beside, plan_beside) = packed(&[unused]);
    assert_eq!((tables_beside, materials_beside), (tables, materials));
    assert_eq!(plan_beside.switches, plan.switches);

    let (_, materials_used, plan_used) = packed(&[unused, on_a_surface]);
    // The surface's own, and behind it what it blends.
    assert_eq!(materials_used, [0, 1, 2, 3, 6, 4, 5]);
    for switch in ["BLENDS", "MIRROR", "PERLIN", "ROUGH_GLASS", "VARYING_LIGHTS"] {
        assert!(plan_used.switches.enabled.contains(switch), "{switch}");
        assert!(!plan_beside.switches.enabled.contains(switch), "{switch}");
    }
}

/// Several light samples are asked of no stage in particular. The queue of shadow rays grows with them, is counted, and fits one binding; what is
/// left fewer are paths.
#[test]
fn several_light_samples_take_room_for_their_shadow_rays() {
    let mut scene = load::load(Some("motion-blur")).expect("it is built in");
    let mut before = u32::MAX;
    for count in [1, 2, 4, 16] {
        scene.render.light_samples = count.into();
        let packed = PackedScene::new(&scene).expect("the scene packs");
        let by_wavefront = |limits: &DeviceLimits| {
            let options = PlanOptions { stages: Some(StageMode::Wavefront), ..PlanOptions::default() };
            Plan::new(&scene, &packed, limits, &options).expect("it fits")
        };
        for limits in [
            DeviceLimits::default(),
            DeviceLimits { max_storage_binding: 1 << 30, max_buffer: 1 << 30, ..DeviceLimits::default() },
        ] {
            let plan = by_wavefront(&limits);
            assert_eq!((plan.stages, plan.light_samples), (StageMode::Wavefront, count));
            let bytes = plan.memory.bytes("shadow rays");
            assert_eq!(bytes, u64::from(plan.path_capacity) * u64::from(count) * 48);
            assert!(bytes <= limits.max_storage_binding.min(256 << 20), "{count}: {bytes}");
        }
        let capacity = by_wavefront(&DeviceLimits::default()).path_capacity;
        assert!(capacity <= before && (count > 2) == (capacity < 1 << 20), "{count}: {capacity}");
        before = capacity;
    }
}

/// The stages that are asked for are those that run, or are refused.
#[test]
fn stages_are_what_was_asked_for() {
    let mut scene = grid(20);
    let packed = PackedScene::new(&scene).expect("the scene packs");
    let plan = |scene: &Scene, stages, trace| {
        let options = PlanOptions { stages: Some(stages), trace, ..PlanOptions::default() };
        Plan::new(scene, &packed, &DeviceLimits::default(), &options)
    };
    for count in [1, 4] {
        scene.render.light_samples = count.into();
        for stages in [StageMode::Fused, StageMode::Wavefront] {
            assert_eq!(plan(&scene, stages, false).expect("it fits").stages, stages);
        }
    }
    assert_eq!(plan(&scene, StageMode::Fused, true).expect("it fits").stages, StageMode::Fused);
    let refused = plan(&scene, StageMode::Wavefront, true);
    assert!(refused.is_err_and(|error| error.to_string().contains("not by the wavefront")));
}

/// A tree of lights is made where there are many, or where it is asked for, and cells where these are; other kernels hold nothing of them.
#[test]
fn many_lights_are_chosen_by_a_tree() {
    for (name, choice, tree, reason) in [
        ("bazaar", LightChoice::Auto, true, "at least 24"),
        ("bazaar", LightChoice::Power, false, "asked for"),
        ("stage", LightChoice::Auto, false, "fewer than 24"),
        ("stage", LightChoice::Tree, true, "asked for"),
        ("stage", LightChoice::Cells, false, "asked for"),
    ] {
        let mut scene = load::load(Some(name)).expect("it is built in");
        scene.render.light_choice = choice;
        let plan = plan(&scene, &DeviceLimits::default()).expect("it fits");
        assert_eq!(plan.switches.enabled.contains("LIGHT_TREE"), tree, "{name}, {choice:?}");
        assert_eq!(plan.switches.enabled.contains("LIGHT_CELLS"), choice == LightChoice::Cells, "{name}, {choice:?}");
        assert_eq!(plan.memory.bytes("light cells") > 0, choice == LightChoice::Cells, "{name}, {choice:?}");
        let decision = plan.decisions.iter().find(|decision| decision.about == "light choice").expect("it is decided");
        assert!(decision.because.contains(reason), "{name}, {choice:?}: {decision:?}");
    }
}
