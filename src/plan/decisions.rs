//! Decisions of the plan with their reasons, as `gpt check` and `--stats` print them.

use super::choices::{FilmStorage, GeometryPlacement, StageMode};
use super::chunks::Chunks;
use super::error::PlanError;
use super::limits::{DeviceLimits, RayQueryDefault};
use super::memory::{PRIMITIVES, TABLES};
use super::model::Plan;
use super::options::{PlanOptions, TraversalChoice};
use crate::packed::PackedScene;
use crate::packed::hierarchy::Traversal;
use crate::renderer::Decision;
use crate::sampling::light_cells::table as light_cells;
use crate::sampling::light_strategy::MANY_LIGHTS;
use crate::sampling::light_tree;
use crate::scene::{FEW_PRIMITIVES, LightChoice, RenderSettings, Scene};

const ASKED_FOR: &str = "asked for";
/// Edges by which paths end, or Russian roulette may end them, where one kernel traces whole paths.
const LONGEST_FUSED_PATH: u32 = 1024;

/// The placement of geometry, and its reason.
pub(super) fn geometry(packed: &PackedScene, options: &PlanOptions) -> (GeometryPlacement, String) {
    let count = packed.primitives.len();
    match options.traversal {
        // Moving geometry is not constant.
        _ if packed.moves() => (GeometryPlacement::Hierarchy, "something moves, and is no constant".into()),
        _ if !packed.instances.is_empty() => (GeometryPlacement::Hierarchy, "instances are no constants".into()),
        _ if packed.hierarchy.primitive_count == 0 => (GeometryPlacement::Unrolled, "a hierarchy would hold nothing".into()),
        TraversalChoice::Bvh | TraversalChoice::RayQuery => (GeometryPlacement::Hierarchy, ASKED_FOR.into()),
        TraversalChoice::Auto if count <= FEW_PRIMITIVES => {
            (GeometryPlacement::Unrolled, format!("{count} primitives, at most {FEW_PRIMITIVES}"))
        }
        TraversalChoice::Auto => (GeometryPlacement::Hierarchy, format!("{count} primitives, more than {FEW_PRIMITIVES}")),
    }
}

/// Features of a scene up to which the kernel that traces whole paths is the faster one on hardware. Larger kernels hold more registers, and their
/// lanes are further apart. Of 16 scenes on one card, those with fewer took 0.3 to 1.04 of the wavefront's time, but for two with four light samples,
/// and those with more 1.25 to 3.7 times (docs/notes/2026-11-26-first-graphics-card.md).
const MOST_FUSED_FEATURES: usize = 34;
/// Light samples at a surface from which on queues of shadow rays are the faster way through a hierarchy on hardware, and the paths in flight that this
/// takes: with fewer, queues run dry.
const QUEUED_LIGHT_SAMPLES: u32 = 4;
const QUEUED_PATHS: u32 = 1 << 20;

/// Properties of a scene that decide how its stages run on hardware.
#[derive(Debug, Clone, Copy)]
pub(super) struct Needs {
    /// Switches that it turns on.
    pub features: usize,
    pub light_samples: u32,
    /// Paths in flight of the wavefront.
    pub path_capacity: u32,
}

/// How stages run, and why.
pub(super) fn stages(
    geometry: GeometryPlacement,
    needs: Needs,
    render: &RenderSettings,
    limits: &DeviceLimits,
    options: &PlanOptions,
) -> (StageMode, String) {
    let Needs { features, light_samples, path_capacity } = needs;
    let fills_queues = light_samples >= QUEUED_LIGHT_SAMPLES && path_capacity >= QUEUED_PATHS;
    let (stages, because) = match options.stages {
        _ if options.trace => (StageMode::Fused, "one path is followed from its start to its end".into()),
        Some(stages) => (stages, ASKED_FOR.into()),
        None if paths_may_not_end(render) => {
            (StageMode::Wavefront, "paths may be so long that the host has to look in between".into())
        }
        // Software devices move every word on its own: there, paths kept in registers beat queues whatever the geometry
        // (docs/performance.md).
        None if limits.software => (StageMode::Fused, "a software device moves each word of a queue on its own".into()),
        None if features > MOST_FUSED_FEATURES => {
            (StageMode::Wavefront, format!("one kernel would hold {features} features, more than {MOST_FUSED_FEATURES}"))
        }
        None if geometry == GeometryPlacement::Hierarchy && fills_queues => {
            (StageMode::Wavefront, format!("queues keep the shadow rays of {light_samples} light samples together"))
        }
        None => (
            StageMode::Fused,
            format!("a kernel of {features} features, at most {MOST_FUSED_FEATURES}, keeps paths in registers"),
        ),
    };
    (stages, because)
}

/// True where neither the depth nor roulette ends paths within some thousand edges. A kernel that traces
/// whole paths could then run for minutes.
fn paths_may_not_end(render: &RenderSettings) -> bool {
    let ends = |edge: u32| (1..=LONGEST_FUSED_PATH).contains(&edge);
    !ends(render.max_depth) && !render.first_roulette(false).is_some_and(ends)
}

/// The storage of the film of a picture of this size, and its reason.
///
/// # Errors
/// [`PlanError::DoesNotFit`] where textures are asked for that the device does not have.
pub(super) fn film(
    size: [u32; 2],
    limits: &DeviceLimits,
    options: &PlanOptions,
) -> Result<(FilmStorage, &'static str), PlanError> {
    match options.film {
        Some(FilmStorage::Texture) if !limits.film_fits_textures(size) => Err(PlanError::DoesNotFit(format!(
            "the device cannot read and write textures of four floats that are {} pixels wide; without `--film textures` it renders all the same",
            size[0]
        ))),
        Some(film) => Ok((film, ASKED_FOR)),
        None => Ok(match limits.film_storage(size, options.pixel_list) {
            FilmStorage::Texture => (FilmStorage::Texture, "the device reads and writes them"),
            FilmStorage::Buffer => {
                (FilmStorage::Buffer, "the device cannot read and write textures of four floats, or none so large")
            }
        }),
    }
}

/// Why those choices are what they are.
pub(super) struct Reasons {
    pub geometry: String,
    pub stages: String,
    pub film: &'static str,
}

/// All decisions of a plan whose memory is counted, in words, in the order of the data's way.
pub(super) fn explain(
    plan: &Plan,
    scene: &Scene,
    packed: &PackedScene,
    limits: &DeviceLimits,
    reasons: Reasons,
) -> Vec<Decision> {
    let mut decisions = materials(scene, packed).into_iter().collect::<Vec<_>>();
    let mut add = |about, choice: String, because: String| decisions.push(Decision { about, choice, because });
    let placement = match plan.geometry {
        GeometryPlacement::Unrolled => "written into the kernels as constants",
        GeometryPlacement::Hierarchy => "triangles in a hierarchy; few other shapes as constants",
    };
    add("geometry", placement.into(), reasons.geometry);
    match plan.traversal_in_use() {
        Some(Traversal::Bvh) => {
            let mut because = "of the forms measured, the one that loads the fewest words".to_owned();
            if limits.ray_query_default == RayQueryDefault::Unverified {
                because +=
                    "; the device has ray queries, which become the default once `gpt verify --traversal ray-query` has passed";
            }
            add("hierarchy", format!("four-wide with 8-bit boxes (BVH4), {}", buffer_name(plan.uniform_nodes)), because);
        }
        Some(Traversal::RayQuery) => {
            let verified = limits.ray_query_default == RayQueryDefault::Verified;
            let because = if verified { "verified on this device with this driver" } else { ASKED_FOR };
            add("hierarchy", "the device's own, by ray queries".into(), because.into());
        }
        None => {}
    }
    for (name, uniform) in [(PRIMITIVES, plan.uniform_primitives), (TABLES, plan.uniform_tables)] {
        let bytes = plan.memory.bytes(name);
        let because = if uniform || bytes > u64::from(limits.max_uniform_binding) {
            size_in_uniform(bytes, limits)
        } else {
            "hardware reads uniform buffers lane by lane where lanes differ".to_owned()
        };
        add(name, buffer_name(uniform).into(), because);
    }
    if !packed.instances.is_empty() {
        let (count, groups) = (packed.instances.len(), packed.hierarchy.roots.len());
        add("instances", format!("{count} of {groups} groups, in a hierarchy of two levels"), "each group is stored once".into());
    }
    let cut: Vec<String> = plan.chunks.iter().filter(|array| !array.is_whole()).map(Chunks::to_string).collect();
    if !cut.is_empty() {
        add("in chunks", cut.join(", "), format!("one binding holds {} KiB", limits.max_array >> 10));
    }
    let entries: Vec<&str> = plan.pipeline().map(|stage| stage.entry).collect();
    add("stages", entries.join(", "), reasons.stages);
    if plan.samples_lights() && (packed.local_lights > 1 || packed.light_choice.is_some()) {
        let (choice, because) = light_choice(scene.render.light_choice, packed);
        add("light choice", choice, packed.light_choice.clone().unwrap_or(because));
    }
    if plan.samples_lights() && (plan.light_samples > 1 || packed.light_samples.is_some()) {
        let because = packed.light_samples.as_deref().unwrap_or(ASKED_FOR);
        decisions.push(Decision::about_light_samples([plan.light_samples, plan.light_samples_depth], because));
    }
    decisions.extend(packed.directions.as_ref().map(|because| Decision::about_directions(!packed.guide.is_empty(), because)));
    let mut add = |about, choice: String, because: String| decisions.push(Decision { about, choice, because });
    if let Some(lanes) = plan.lanes {
        let because =
            "this software driver loads lane by lane, and packets load once; lavapipe from Mesa 25.1 on needs none".into();
        add("lanes", format!("{lanes} samples of one pixel side by side, their rays in packets"), because);
    }
    if plan.stages == StageMode::Wavefront {
        let (taker, because) =
            if plan.subgroup_queues { ("subgroup", "the device has subgroups") } else { ("path", "the device has no subgroups") };
        add("queues", format!("one atomic a {taker}"), because.into());
    }
    let film = match plan.film {
        FilmStorage::Texture => "rgba32float storage textures",
        FilmStorage::Buffer => "storage buffers",
    };
    let because = reasons.film;
    let height = scene.film.size[1];
    if plan.band_rows < height {
        add(
            "film",
            format!("{film}, bands of {} rows, one after the other", plan.band_rows),
            format!("{because}; all {height} rows are too many"),
        );
    } else {
        add("film", format!("{film}, all {height} rows together"), because.into());
    }
    decisions
}

/// How next event estimation chooses among lights.
fn light_choice(asked_for: LightChoice, packed: &PackedScene) -> (String, String) {
    let count = packed.local_lights;
    let [by_tree, by_cells] = [!packed.light_nodes.is_empty(), !packed.light_cells.is_empty()];
    let choice = match [by_tree, by_cells] {
        [true, _] => format!("by a tree over {count} lights"),
        [_, true] => {
            let cells = light_cells::count(&packed.light_cells);
            format!("by what reaches the place, {cells} cells over {} lights", packed.lights.len())
        }
        _ => "by power, in constant time".to_owned(),
    };
    let because = match asked_for {
        LightChoice::Power => ASKED_FOR.to_owned(),
        LightChoice::Tree | LightChoice::Cells if by_tree || by_cells => ASKED_FOR.to_owned(),
        LightChoice::Auto if by_tree => format!("{count} lights inside the scene, at least {MANY_LIGHTS}"),
        LightChoice::Auto if count < MANY_LIGHTS => format!("{count} lights inside the scene, fewer than {MANY_LIGHTS}"),
        LightChoice::Auto | LightChoice::Tree | LightChoice::Cells => {
            format!("{count} lights are too many for a tree, which takes {}", light_tree::MOST_LIGHTS)
        }
    };
    (choice, because)
}

/// Which materials are packed, where some are not.
fn materials(scene: &Scene, packed: &PackedScene) -> Option<Decision> {
    let (packed, all) = (packed.materials.scene_ids.len(), scene.materials.len());
    (packed < all).then(|| Decision {
        about: "materials",
        choice: format!("{packed} of {all}"),
        because: "no surface is made of the others".into(),
    })
}

fn buffer_name(uniform: bool) -> &'static str {
    if uniform { "uniform buffer" } else { "storage buffer" }
}

fn size_in_uniform(bytes: u64, limits: &DeviceLimits) -> String {
    let most = u64::from(limits.max_uniform_binding);
    let compared = if bytes <= most { "at most" } else { "more than" };
    format!("{} KiB, {compared} {}", bytes.div_ceil(1 << 10), most >> 10)
}
