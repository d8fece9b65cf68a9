//! Which of the [switches](crate::shader::switches) a scene turns on.

use glam::DVec2;

use super::choices::{FilmStorage, MAX_SAMPLES_PER_PASS};
use super::model::{Plan, SEQUENCE_BLOCKS};
use crate::packed::hierarchy::Traversal;
use crate::packed::layers::PackedLayer;
use crate::packed::light::{LightKind, PackedLight};
use crate::packed::material::{BLEND, LAYERED, NO_LOBE, PackedMaterial};
use crate::packed::primitive::Primitive;
use crate::packed::shape::{PrimitiveKind, SurfaceSampling};
use crate::packed::texture::{PackedTextureKind, TexelFormat};
use crate::packed::{NONE, PackedScene};
use crate::sampling::Decorrelation;
use crate::sampling::mis::Heuristic;
use crate::scene::material::{self, ANISOTROPIC, SEPARABLE_MASKING};
use crate::scene::{
    ApertureShape, Camera, DistanceSampling, Eyes, Filter, FilterKind, HemisphereSampling, LinkMask, MapRows, Projection,
};
use crate::scene::{
    BlendMode, Emitters, Estimator, LightSampling, LobeKind, LobeSupport, PhongCosine, PhongHorizon, PhongSampling, PixelSampler,
    RenderSettings, Scene,
};
use crate::shader::Switches;

/// Stacks of a lane have a multiple of so many entries.
const STACK_STEP: u32 = 8;

/// Switches that the scene needs on every device.
pub fn of_scene(scene: &Scene, packed: &PackedScene) -> Switches {
    let mut switches = Switches::default();
    let render = &scene.render;

    choose_shapes(packed, &mut switches);
    switches.enable("ATTRIBUTES", packed.has_attributes());
    switches.enable("TEXTURES", !packed.textures.textures.is_empty());
    let has_texture = |kind: PackedTextureKind| packed.textures.textures.iter().any(|texture| texture.kind() == kind as u32);
    switches.enable("IMAGES", has_texture(PackedTextureKind::Image));
    switches.enable("TEXELS", packed.textures.texel_words() > 0);
    for (switch, format) in [
        ("TEXELS_IN_BYTES", TexelFormat::Bytes),
        ("TEXELS_IN_SHORTS", TexelFormat::Shorts),
        ("TEXELS_IN_HALF_FLOATS", TexelFormat::Half),
        ("TEXELS_IN_FLOATS", TexelFormat::Float),
    ] {
        switches.enable(switch, packed.textures.has_format(format));
    }
    switches.enable("TEXTURE_CHANNELS", packed.textures.has_channels());
    switches.enable("TEXTURES_OF_TRIANGLES", packed.textures.has_triangles());
    switches.enable("SECOND_UVS", packed.second_uvs && packed.has_attributes() && packed.textures.uses_second_uvs());
    switches.enable("TEXTURE_PRODUCTS", packed.textures.has_products());
    switches.enable("TEXTURE_ROTATION", packed.textures.is_rotated());
    switches.enable("CHECKERS", has_texture(PackedTextureKind::Checker));
    switches.enable("PERLIN", has_texture(PackedTextureKind::Perlin));
    switches.enable("WORLEY", has_texture(PackedTextureKind::Worley));
    let procedural = [PackedTextureKind::Checker, PackedTextureKind::Perlin, PackedTextureKind::Worley];
    switches.enable("PROCEDURAL_TEXTURES", procedural.into_iter().any(has_texture));

    switches.enable("MOTION", packed.moves());
    switches.enable("GUIDE", !packed.guide.is_empty());
    switches.enable("INSTANCES", !packed.instances.is_empty());

    choose_materials(scene, packed, &mut switches);

    choose_lights(scene, packed, &mut switches);

    switches.enable("ESTIMATOR_MIS", matches!(render.estimator, Estimator::Mis | Estimator::Choose));
    switches.enable("ESTIMATOR_CHOOSE", render.estimator == Estimator::Choose);
    switches.enable("ESTIMATOR_NEE", render.estimator == Estimator::Nee);
    let heuristic = Heuristic::from(render);
    switches.enable("HEURISTIC_POWER", heuristic == Heuristic::Power(2.0));
    switches.enable("HEURISTIC_EXPONENT", matches!(heuristic, Heuristic::Power(beta) if beta != 1.0 && beta != 2.0));
    switches.enable("HEURISTIC_CUTOFF", matches!(heuristic, Heuristic::Cutoff(_)));
    switches.enable("ROULETTE", render.first_roulette(false).is_some());
    enable_sampler(&mut switches, render);
    let hides = render.emitters == Emitters::Hidden;
    switches.enable("HIDDEN_EMITTERS", hides);
    switches.enable("NULL_SURFACES", hides || switches.enabled.contains("NULL_SURFACES"));
    let scatter = packed.materials.media.scatter();
    switches.enable("BY_DISTANCE", scatter && render.distance_sampling == DistanceSampling::Distance);
    switches.enable("BY_ANGLE", scatter && render.distance_sampling == DistanceSampling::Equiangular);
    switches.enable("UNIFORM_HEMISPHERE", render.hemisphere == HemisphereSampling::Uniform);
    enable_phong(&mut switches, render, packed);
    let blades = enable_camera(&mut switches, scene);
    switches.constants.insert("BLADES", blades);
    switches
}

/// Adds to what the scene needs how the plan goes about it.
pub fn choose(mut switches: Switches, scene: &Scene, packed: &PackedScene, plan: &Plan) -> Switches {
    let render = &scene.render;
    switches.enable("BVH", plan.has_nodes());
    switches.enable("RAY_QUERY", plan.traversal_in_use() == Some(Traversal::RayQuery));
    switches.enable("PACKETS", plan.lanes.is_some());
    switches.enable("UNIFORM_NODES", plan.has_nodes() && plan.uniform_nodes);
    switches.enable("UNIFORM_PRIMITIVES", plan.uniform_primitives);
    switches.enable("UNIFORM_TABLES", plan.uniform_tables);
    switches.enable("FILM_TEXTURE", plan.film == FilmStorage::Texture);
    switches.enable("TAKEN_PIXELS", plan.pixel_takers.is_some());
    switches.enable("SUBGROUP_QUEUES", plan.subgroup_queues);

    let tables = packed.tables();
    let links = packed.links.places();
    let albedos = packed.materials.albedos;
    let albedo_word = |place: Option<usize>| tables.first_further + place.unwrap_or(0) as u32;
    let map = packed.environment.map.unwrap_or_default();
    let [tile_width, tile_height] = scene.camera.view_size(scene.film.size);
    let first_light = |kind: LightKind| packed.lights.iter().position(|light| light.is(kind)).unwrap_or(0) as u32;
    switches.constants.extend([
        ("CORRELATED_ALBEDO_WORD", albedo_word(albedos.height_correlated)),
        ("SEPARABLE_ALBEDO_WORD", albedo_word(albedos.separable)),
        ("SHEEN_ALBEDO_WORD", albedo_word(albedos.sheen)),
        ("CLAMP_BITS", (render.clamp as f32).to_bits()),
        (
            "HEURISTIC_CUTOFF_BITS",
            if let Heuristic::Cutoff(alpha) = Heuristic::from(render) { (alpha as f32).to_bits() } else { 0 },
        ),
        ("HEURISTIC_EXPONENT_BITS", (render.heuristic_exponent as f32).to_bits()),
        ("ENVIRONMENT_FIRST_DENSITY", map.first_density),
        ("ENVIRONMENT_FIRST_NODE", map.first_node),
        ("ENVIRONMENT_FIRST_TEXEL", map.first_texel),
        ("ENVIRONMENT_GRID_HEIGHT", map.grid_height),
        ("ENVIRONMENT_GRID_WIDTH", map.grid_width),
        ("ENVIRONMENT_HEIGHT", map.height),
        ("ENVIRONMENT_LIGHT_INDEX", first_light(LightKind::Environment)),
        ("ENVIRONMENT_QUADTREE_LEVELS", map.levels),
        ("ENVIRONMENT_ROWS_TO_POLES", u32::from(map.rows == MapRows::ToPoles)),
        ("ENVIRONMENT_WIDTH", map.width),
        ("FILM_WIDTH", scene.film.size[0]),
        ("FISHEYE_MAPPING", if let Projection::Fisheye(model) = scene.camera.projection { model.mapping.number() } else { 0 }),
        ("FIRST_BLEND_WEIGHT_WORD", tables.first_blend_weight),
        ("FIRST_FURTHER_WORD", tables.first_further),
        ("FIRST_LAYER_WORD", tables.first_layer),
        ("FIRST_PART_WORD", tables.first_part),
        ("FIRST_LIGHT_NODE_WORD", tables.first_light_node),
        ("FIRST_LIGHT_PROFILE_WORD", tables.first_light_profile),
        ("FIRST_LIGHT_WORD", tables.first_light),
        ("FIRST_LINK_WORD", tables.first_link),
        ("CAMERA_MEDIUM", packed.materials.media.around_camera),
        ("FIRST_MEDIUM_WORD", tables.first_medium),
        ("FIRST_PHASE_WORD", tables.first_phase),
        ("FIRST_VOLUME_WORD", tables.first_volume),
        ("FIRST_MOTION_WORD", tables.first_motion),
        ("FIRST_OBJECT_WORD", tables.first_object),
        ("FIRST_PORTAL", first_light(LightKind::Portal)),
        ("FIRST_TEXTURE_WORD", tables.first_texture),
        ("LANES", plan.lanes.unwrap_or(1)),
        ("TILE_COLUMNS", scene.camera.tiles()[0]),
        ("TILE_HEIGHT", tile_height),
        ("TILE_WIDTH", tile_width),
        ("LIGHT_COUNT", packed.lights.len() as u32),
        ("LIGHTS_AT_INFINITY", (packed.lights.len() - packed.local_lights) as u32),
        ("LIGHT_SAMPLES", plan.light_samples),
        ("LIGHT_SAMPLES_DEPTH", plan.light_samples_depth),
        // Depth 0 means no limit: an edge that is never reached.
        ("MAX_DEPTH", if render.max_depth == 0 { u32::MAX } else { render.max_depth }),
        ("LINK_INSTANCES", links.instances),
        ("LINK_LIGHTS", links.lights),
        ("LINK_MEDIA", links.media),
        ("LINK_RECEIVERS", links.receivers),
        ("LOCAL_LIGHTS", packed.local_lights as u32),
        ("MAX_SAMPLES_PER_PASS", MAX_SAMPLES_PER_PASS),
        ("MOST_FURTHER", packed.materials.materials.iter().map(PackedMaterial::looked_up).max().unwrap_or(0).max(1)),
        ("OUTSIDE_LINK", packed.links.outside.unwrap_or(LinkMask::ALL).0),
        ("PATH_CAPACITY", plan.path_capacity),
        ("PORTAL_COUNT", packed.lights.iter().filter(|light| light.is(LightKind::Portal)).count() as u32),
        ("PRIMITIVE_WORDS", (3 * packed.primitives.len() as u32).max(1)),
        ("RAYS_PER_INVOCATION", plan.rays_per_invocation),
        ("ROULETTE_DEPTH", render.first_roulette(!packed.guide.is_empty()).unwrap_or(0)),
        ("SEQUENCE_BLOCKS", SEQUENCE_BLOCKS),
        ("SEQUENCE_POINTS", plan.sequence_stride() * MAX_SAMPLES_PER_PASS),
        ("SEQUENCE_STRIDE", plan.sequence_stride()),
        // Both are rounded up, so that frames whose hierarchies differ a little have the same kernels. Packets keep an entry a lane.
        ("STACK_SIZE", packed.hierarchy.stack_size.next_multiple_of(plan.lanes.unwrap_or(STACK_STEP))),
        ("NODE_WORDS", if plan.uniform_nodes { (packed.hierarchy.uniform_node_bytes() / 16) as u32 } else { 0 }),
        ("TABLE_WORDS", (tables.words.len() as u32).max(1)),
    ]);
    switches
}

fn choose_shapes(packed: &PackedScene, switches: &mut Switches) {
    let has = |primitives: &[Primitive], kind: PrimitiveKind| primitives.iter().any(|primitive| primitive.is(kind));
    let (in_hierarchy, _) = packed.primitives.split_at(packed.hierarchy.primitive_count as usize);
    let is_sampled = |kind: PrimitiveKind| packed.lights.iter().any(|light| light.shape() == Some(kind));
    for &kind in PrimitiveKind::ALL {
        switches.enable(kind.switch(), has(&packed.primitives, kind) || is_sampled(kind));
        if !kind.is_infinite() {
            switches.enable(kind.switch_in_hierarchy(), has(in_hierarchy, kind));
            switches.enable(kind.switch_of_lights(), is_sampled(kind));
        }
    }
    let mut tested = in_hierarchy.iter().filter(|primitive| primitive.instance().is_none());
    let only_triangles = tested.all(|primitive| primitive.is(PrimitiveKind::Triangle));
    switches.enable("ONLY_TRIANGLES_IN_HIERARCHY", !in_hierarchy.is_empty() && only_triangles);
}

/// True where any surface samples light. Paths of one edge have no vertex to sample it from.
pub fn samples_lights(scene: &Scene, packed: &PackedScene) -> bool {
    !packed.lights.is_empty() && scene.render.max_depth != 1
}

/// True where lights are chosen by the cell of the reference point.
pub fn chooses_lights_by_cells(scene: &Scene, packed: &PackedScene) -> bool {
    samples_lights(scene, packed) && !packed.light_cells.is_empty()
}

/// True where shadow rays may meet null surfaces, and go on through them.
pub fn shadows_are_transparent(scene: &Scene, packed: &PackedScene) -> bool {
    samples_lights(scene, packed) && packed.materials.has(LobeKind::Null as u32)
}

fn choose_lights(scene: &Scene, packed: &PackedScene, switches: &mut Switches) {
    let render = &scene.render;
    let has = |kind: LightKind| packed.lights.iter().any(|light| light.is(kind));
    let sampled = samples_lights(scene, packed);
    switches.enable("LIGHTS", sampled);
    switches.enable("TRANSPARENT_SHADOWS", shadows_are_transparent(scene, packed));
    switches.enable("ONE_LIGHT", packed.lights.len() == 1);
    switches.enable("LIGHT_TREE", sampled && !packed.light_nodes.is_empty());
    switches.enable("LIGHT_CELLS", chooses_lights_by_cells(scene, packed));
    let has_surface = |sampling: SurfaceSampling| {
        let is_it = |light: &PackedLight| light.is_surface() && light.shape().is_some_and(|kind| kind.sampling() == sampling);
        packed.lights.iter().any(is_it)
    };
    switches.enable("AREA_LIGHTS", has_surface(SurfaceSampling::Area));
    let by_solid_angle = |kind| sampled && packed.lights.iter().any(|light| light.is_drawn_by_solid_angle(kind));
    let [rectangles, triangles] = [PrimitiveKind::Quad, PrimitiveKind::Triangle].map(by_solid_angle);
    switches.enable("FLAT_LIGHTS_BY_SOLID_ANGLE", rectangles || triangles);
    switches.enable("RECTANGLES_BY_SOLID_ANGLE", rectangles);
    switches.enable("TRIANGLES_BY_SOLID_ANGLE", triangles);
    let is_sphere = |light: &PackedLight| light.is_surface() && light.shape() == Some(PrimitiveKind::Sphere);
    let spheres = packed.lights.iter().any(is_sphere);
    let (spheres_shown, areas_shown): (Vec<&PackedLight>, Vec<&PackedLight>) =
        packed.lights.iter().filter(|light| sampled && light.is_warped()).partition(|light| is_sphere(light));
    switches.enable("LIGHTS_BY_PICTURE", !spheres_shown.is_empty() || !areas_shown.is_empty());
    switches.enable("AREA_LIGHTS_BY_PICTURE", !areas_shown.is_empty());
    switches.enable("SPHERE_LIGHTS_BY_PICTURE", !spheres_shown.is_empty());
    let by_point = spheres && matches!(render.light_sampling, LightSampling::Visible | LightSampling::Area);
    switches.enable("SPHERE_POINTS", !spheres_shown.is_empty() || by_point);
    switches.enable("SPHERE_LIGHTS_BY_POINT", by_point);
    switches.enable("SPHERE_LIGHTS_VISIBLE_HALF", spheres && render.light_sampling == LightSampling::Visible);
    switches.enable("DELTA_LIGHTS", packed.lights.iter().any(PackedLight::is_delta));
    for &kind in LightKind::DELTA {
        switches.enable(kind.number_name(), has(kind));
    }
    switches.enable("LIGHT_LINKS", !packed.links.is_empty());
    switches.enable("LIGHT_TEXTURES", packed.lights.iter().any(PackedLight::projects_texture));
    switches.enable("LIGHT_PROFILES", packed.lights.iter().any(PackedLight::has_profile));
    switches.enable("SPOT_FALLOFFS", packed.lights.iter().any(|light| light.is(LightKind::Spot) && light.form() != 0));
    let environment = !packed.environment.is_black();
    switches.enable("ENVIRONMENT", environment);
    if let Some(switch) = packed.environment.switch.filter(|_| environment) {
        switches.enable(switch, true);
    }
    switches.enable("OUTSIDE_UNSEEN", environment && !scene.shows_outside());
    switches.enable("ENVIRONMENT_TURNED", environment && packed.environment.is_turned());
    switches.enable("ENVIRONMENT_LIGHT", sampled && has(LightKind::Environment));
    switches.enable("MOVING_LIGHTS", packed.lights.iter().any(PackedLight::moves));
    switches.enable("PORTALS", sampled && has(LightKind::Portal));
    switches.enable("ENVIRONMENT_SAMPLED", sampled && (has(LightKind::Environment) || has(LightKind::Portal)));
}

/// Studies of cosine-power lobes, where there are such.
fn enable_phong(switches: &mut Switches, render: &RenderSettings, packed: &PackedScene) {
    let has_lobes = [LobeKind::Glossy, LobeKind::Phong].into_iter().any(|lobe| packed.materials.has(lobe as u32));
    switches.enable("PHONG_WITHOUT_COSINE", has_lobes && render.phong_cosine == PhongCosine::Dropped);
    switches.enable("PHONG_BY_HEMISPHERE", has_lobes && render.phong_sampling == PhongSampling::Hemisphere);
    switches.enable("PHONG_FLIPPED", has_lobes && render.phong_horizon == PhongHorizon::Flipped);
}

fn enable_sampler(switches: &mut Switches, render: &RenderSettings) {
    let path = Decorrelation::of(render.sampler);
    switches.enable("SEQUENCE", path.has_sequence());
    switches.enable("LCG", path == Decorrelation::Stream);
    switches.enable("DIGITAL_SHIFT", path == Decorrelation::DigitalShift);
    // The pixel's own, where it differs from the path's.
    let pixel = match render.pixel_sampler {
        PixelSampler::Other(kind) if kind != render.sampler => Some(Decorrelation::of(kind)),
        _ => None,
    };
    switches.enable("PIXEL_CENTRE", render.pixel_sampler == PixelSampler::Centre);
    switches.enable("PIXEL_HASHED", pixel == Some(Decorrelation::Hashed));
    switches.enable("PIXEL_LCG", pixel == Some(Decorrelation::Stream));
    switches.enable("PIXEL_ROTATION", pixel == Some(Decorrelation::Rotation));
    switches.enable("PIXEL_DIGITAL_SHIFT", pixel == Some(Decorrelation::DigitalShift));
}

/// Returns the corners of a polygonal aperture.
fn enable_camera(switches: &mut Switches, scene: &Scene) -> u32 {
    let filter = scene.film.filter;
    // The default needs no map: a uniform number is a position in the pixel.
    switches.enable("FILTER", filter != Filter::default());
    switches.enable("FILTER_BOX", filter != Filter::default() && filter.kind == FilterKind::Box);
    switches.enable("FILTER_CURVE", matches!(filter.kind, FilterKind::Gaussian | FilterKind::BlackmanHarris));
    let (camera, size) = (&scene.camera, DVec2::from(scene.film.size.map(f64::from)));
    let window = camera.window(size);
    switches.enable("ORTHOGRAPHIC", window.is_some_and(|window| window.is_parallel));
    enable_camera_model(switches, camera, window.is_none());
    switches.enable("CAMERA_MOTION", !scene.exposure.is_empty());
    let moves = switches.enabled.contains("MOTION") || !scene.exposure.is_empty();
    switches.enable("ROLLING_SHUTTER", camera.rolling_shutter < 1.0 && moves);
    switches.enable("LENS", scene.camera.aperture.is_some());
    let shape = scene.camera.aperture.map(|aperture| aperture.shape);
    switches.enable("APERTURE_SQUARE", shape == Some(ApertureShape::Square));
    match shape {
        Some(ApertureShape::Polygon { blades, .. }) => {
            switches.enable("APERTURE_POLYGON", true);
            blades
        }
        _ => 0,
    }
}

/// The map from places of the picture to directions, where that is not flat, and the views that the picture consists of.
fn enable_camera_model(switches: &mut Switches, camera: &Camera, is_bent: bool) {
    switches.enable("CAMERA_MODEL", is_bent);
    for &switch in camera.projection.switches() {
        switches.enable(switch, is_bent);
    }
    switches.enable("CAMERA_INWARD", camera.inward_from > 0.0);
    switches.enable("CAMERA_TILES", camera.tiles() != [1, 1]);
    switches.enable("STEREO", camera.stereo.is_some());
    let eyes = camera.projection.model().map(|model| model.eyes());
    switches.enable("TURNING_EYES", camera.stereo.is_some() && eyes == Some(Eyes::Turning));
    switches.enable("DEPTH_BY_DISTANCE", !camera.measures_depth_along_axis());
}

/// Materials, lobe by lobe, and blends of them.
fn choose_materials(scene: &Scene, packed: &PackedScene, switches: &mut Switches) {
    let materials = &packed.materials.materials;
    let has = |lobe: LobeKind| packed.materials.has(lobe as u32);
    for &lobe in LobeKind::ALL {
        switches.enable(lobe.switch(), has(lobe));
    }
    let has_layers = !packed.materials.layers.is_empty();
    switches.enable("LAYERED", has_layers);
    switches.enable("SLABS", packed.materials.layers.iter().any(PackedLayer::is_filled));
    switches.enable("SLABS_SCATTER", packed.materials.layers.iter().any(PackedLayer::scatters));
    let is_straight = |straight: bool| materials.iter().any(|material| material.is_straight_stack() == Some(straight));
    switches.enable("LAYERS_BY_WALK", is_straight(false));
    switches.enable("LAYERS_STRAIGHT_THROUGH", is_straight(true));
    let bent = scene.layers_are_bent();
    let layers_are_bent = has_layers && packed.materials.scene_ids.iter().any(|&id| bent[id]);
    switches.enable("BENT_LAYERS", layers_are_bent);
    let on_both_sides = |lobe: &LobeKind| lobe.support() == LobeSupport::Sphere;
    switches.enable("NON_DELTA_TRANSMISSION", LobeKind::ALL.iter().copied().filter(on_both_sides).any(has) || has_layers);
    switches.enable("COLOR1", materials.iter().any(PackedMaterial::uses_color1));
    switches.enable("ROUGHNESS", materials.iter().any(PackedMaterial::uses_roughness));
    let blends = packed.materials.has(BLEND);
    switches.enable("BLENDS", blends);
    let one_lobe = [LobeKind::Diffuse as u32, NO_LOBE, BLEND, LAYERED];
    let more_lobes = materials.iter().any(|material| !one_lobe.contains(&material.kind()));
    let mixture = scene.render.blend == BlendMode::Mixture;
    switches.enable("MIXTURE", blends && mixture);
    switches.enable("MORE_LOBES", blends && mixture && more_lobes);
    switches.enable("PICK", blends && !mixture);
    switches.enable("WEIGHTS_BY_ANGLE", blends && packed.materials.has_weights_by_angle());
    switches.enable("WEIGHTS_BY_DIRECTION", blends && packed.materials.has_weights_by_direction());
    switches.enable("WEIGHTS_BY_SIDE", blends && packed.materials.has_weights_by_side());
    switches.enable("WEIGHTS_BY_VIEWER", blends && packed.materials.has_weights_by_viewer());
    let has_maps = packed.materials.materials.iter().any(|material| material.normal_map != NONE);
    switches.enable("BUMP_MAPS", has_maps && packed.textures.has_heights());
    switches.enable("NORMAL_SHADOWING", has_maps && packed.textures.has_shadowed_normals());
    let is_mirrored = packed.textures.has_shadowed_normals() && packed.textures.has_mirrored_normals();
    switches.enable("NORMAL_MIRRORING", has_maps && is_mirrored);
    switches.enable("NORMAL_SCALES", has_maps && packed.textures.has_scaled_normals());
    switches.enable("NORMAL_MAPS", packed.materials.materials.iter().any(|material| material.normal_map != NONE));
    switches.enable("EMISSION", materials.iter().any(PackedMaterial::emits));
    switches.enable("FURTHER_PARAMETERS", materials.iter().any(|material| material.looked_up() > 0));
    switches.enable("BECKMANN", materials.iter().any(|material| material.has_form(material::BECKMANN)));
    switches.enable("SEPARABLE_MASKING", materials.iter().any(|material| material.has_form(SEPARABLE_MASKING)));
    let transmits = |material: &PackedMaterial| material.has_form(material::TRANSMITS);
    switches.enable("PRINCIPLED_TRANSMISSION", materials.iter().any(transmits));
    switches.enable(
        "PRINCIPLED_DIFFUSE_TRANSMISSION",
        materials.iter().any(|material| material.has_form(material::DIFFUSE_TRANSMITS)),
    );
    let has_form = |form: u32| materials.iter().any(|material| material.has_form(form));
    switches.enable("THIN_FILM", has_form(material::THIN_FILM));
    let is_dispersed = has_form(material::DISPERSED);
    switches.enable("PRINCIPLED_DISPERSION", is_dispersed);
    switches
        .enable("CARRIED_LIGHT", is_dispersed || [LobeKind::SpectralGlass, LobeKind::RoughSpectralGlass].into_iter().any(has));
    switches.enable("COMPENSATION", has_form(material::COMPENSATED));
    switches.enable("SHEEN", has_form(material::SHEEN));
    let media = &packed.materials.media;
    switches.enable("MEDIA", !media.is_empty());
    switches.enable("MEDIUM_EMISSION", media.emit());
    switches.enable("SCATTERING", media.scatter());
    let open_boundaries = packed.materials.has_open_boundaries();
    switches.enable("OPEN_BOUNDARIES", (open_boundaries || media.vary()) && !media.is_empty());
    switches.enable("MEDIUM_GRIDS", media.vary());
    switches.enable("MEDIUM_PASSAGE", media.pass_paths());
    switches.enable("ANISOTROPY", has_form(ANISOTROPIC));
    switches.enable("ANISOTROPY_DIRECTIONS", has_form(material::DIRECTED));
    let coat_normals_differ = scene.coat_normals_differ();
    let coat_normals = packed.materials.scene_ids.iter().any(|&id| coat_normals_differ[id]);
    switches.enable("COAT_NORMALS", coat_normals);
    switches.enable("TANGENTS", coat_normals || layers_are_bent || has_form(ANISOTROPIC));
    switches.enable("ONE_SIDED", materials.iter().any(PackedMaterial::is_front_only) || packed.materials.has_front_only_parts());
    switches.enable("VARYING_LIGHTS", samples_lights(scene, packed) && packed.lights.iter().any(PackedLight::varies));
}
