//! Small scenes at random: one body, one lamp, and every feature that may stand between them in some of its forms.

/// A body under a lamp above a floor. Whatever the body lets through shows the floor, in pictures and in shadows alike.
#[derive(Debug, Clone, Copy)]
pub struct Features {
    pub body: &'static str,
    pub opacity: &'static str,
    pub relief: &'static str,
    pub sides: &'static str,
    pub glow: &'static str,
    pub shape: Shape,
    pub motion: &'static str,
    pub lamp: &'static str,
    pub lamp_shape: &'static str,
    pub settings: &'static str,
    pub links: Links,
}

/// Which lamps light what: keys of the lamp or the sky, of the glowing body, and the receivers of the body and of the floor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Links {
    pub lamp: &'static str,
    pub glow: &'static str,
    pub body: &'static str,
    pub floor: &'static str,
}

/// The shape of the body.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    Sheet,
    Box,
    Mesh,
    Instance,
    Ball,
    Tube,
    Disk,
    /// A sheet that the floor gets all of its light through.
    Cover,
}

impl Shape {
    /// A map can bend its normals.
    fn takes_relief(self) -> bool {
        matches!(self, Self::Sheet | Self::Box | Self::Mesh | Self::Instance | Self::Cover)
    }

    /// True where textures can lie on it.
    fn takes_textures(self) -> bool {
        self != Self::Disk
    }
}

const BODIES: &[&str] = &[
    "type = \"diffuse\", reflectance = [0.8, 0.6, 0.4]",
    "type = \"conductor\", preset = \"copper\", roughness = 0.6",
    "type = \"plastic\", reflectance = 0.5",
    "type = \"principled\", base_color = [0.7, 0.5, 0.3], metallic = 0.2, roughness = 0.6, clearcoat = 0.4, clearcoat_roughness = 0.4",
    "type = \"principled\", base_color = 0.9, metallic = 0, roughness = 0.6, transmission = 0.7, thin = true",
    "type = \"rough_glass\", ior = 1.3, alpha = 0.4",
    "type = \"mirror\"",
];

/// Bodies of real layers.
pub const STACKS: &[(&str, &str)] = &[
    (
        "paint below frosted glass",
        "type = \"layered\", interfaces = [\"frosted\", \"paint\"], slabs = [{ thickness = 0.2, medium = \"haze\" }]",
    ),
    (
        "a translucent sheet",
        "type = \"layered\", interfaces = [\"frosted\", \"frosted\"], slabs = [{ thickness = { texture = \"hills\" }, medium = \"haze\" }]",
    ),
    (
        "metal below varnish and haze",
        "type = \"layered\", interfaces = [\"varnish\", \"metal\"], slabs = [{ thickness = 0.5, medium = \"haze\" }], mirrored = true",
    ),
    ("metal below a film", "type = \"layered\", interfaces = [\"frosted\", \"varnish\", \"metal\"]"),
    (
        "two stacks and paint",
        "type = \"blend\", materials = [\"coated\", \"half coated\"], weight = { type = \"facing\", power = 1 }",
    ),
    ("Weidlich and Wilkie's", "type = \"layered\", interfaces = [\"frosted\", \"metal\"], model = \"weidlich-wilkie\""),
];
const WHOLE: &str = "";
const OPACITIES: &[&str] = &[
    WHOLE,
    ", opacity = 0.5",
    ", opacity = { texture = \"squares\", channel = \"g\", factor = 0.8 }",
    ", opacity = { texture = \"squares\", channel = \"g\", cutoff = 0.5 }",
];
const FLAT: &str = "";
const RELIEFS: &[&str] = &[
    FLAT,
    ", bump_map = \"hills\", bump_scale = 0.3",
    ", bump_map = \"hills\", bump_scale = 0.3, normal_shadowing = true",
    ", bump_map = \"hills\", bump_scale = 0.3, normal_shadowing = true, normal_mirroring = true",
];
const SIDES: &[&str] = &["", "", ", two_sided = false"];
const GLOWS: &[&str] = &["", "", ", emission = 0.6", ", emission = [0.4, 0.7, 0.5], emission_two_sided = true"];
const SHAPES: &[Shape] = &[Shape::Sheet, Shape::Box, Shape::Mesh, Shape::Instance, Shape::Ball, Shape::Tube, Shape::Disk];
const MOTIONS: &[&str] = &["", "", ", motion = [{ rotate = [0, 1, 0.2], degrees = 40 }, { translate = [0.3, 0.1, 0] }]"];
const LAMPS: &[&str] = &[
    "type = \"emissive\", radiance = 3, two_sided = true",
    "type = \"diffuse\", reflectance = 0.5, emission = 5, emission_two_sided = true, opacity = 0.6",
    "type = \"diffuse\", reflectance = 0.5, emission = 8, opacity = { texture = \"squares\", channel = \"g\" }",
];
/// Shapes of the lamp, and surroundings that light without one.
const LAMP_SHAPES: &[&str] = &[
    "type = \"rectangle\", corner = [-1.5, 2.6, -1.5], edge_u = [3, 0, 0], edge_v = [0, 0, 3]",
    "type = \"sphere\", center = [0.8, 2.8, 0.6], radius = 0.9",
    "type = \"cylinder\", from = [-1.5, 2.7, 0.4], to = [1.5, 2.7, -0.4], radius = 0.5",
    "type = \"box\", min = [-1, 2.3, -1], max = [1, 2.8, 1]",
    SKY,
];
const SKY: &str = "sky";
const SETTINGS: &[&str] = &[
    "light_choice = \"power\"",
    "light_choice = \"tree\", heuristic = \"balance\"",
    "light_choice = \"cells\"",
    "light_choice = \"power\", light_samples = 3, blend = \"pick\"",
    "light_choice = \"power\", light_sampling = \"area\"",
];

const BODY: &str = ", receiver = \"body\"";
const FLOOR: &str = ", receiver = \"floor\"";
const LINKS: &[Links] = &[
    Links { lamp: "", glow: "", body: "", floor: "" },
    Links { lamp: ", lights_only = [\"body\"]", glow: "", body: BODY, floor: "" },
    Links { lamp: ", lights_all_but = [\"body\"]", glow: ", lights_only = [\"rest\"]", body: BODY, floor: "" },
    Links { lamp: ", lights_all_but = [\"floor\"]", glow: ", lights_only = [\"floor\"]", body: "", floor: FLOOR },
];

/// Every way of linking lamps, on bodies that let light through, that send it on as mirrors, that stand in the scene as instances, and that glow.
pub fn linked() -> impl Iterator<Item = (String, Features)> {
    let plain = Features {
        body: BODIES[0],
        opacity: WHOLE,
        relief: FLAT,
        sides: SIDES[0],
        glow: GLOWS[0],
        shape: Shape::Ball,
        motion: MOTIONS[0],
        lamp: LAMPS[0],
        lamp_shape: LAMP_SHAPES[0],
        settings: SETTINGS[0],
        links: LINKS[0],
    };
    let bodies = [
        ("translucent", Features { opacity: OPACITIES[1], lamp: LAMPS[1], ..plain }),
        ("a mirror, lamps by cells", Features { body: BODIES[6], settings: SETTINGS[2], ..plain }),
        ("an instance of glass under the sky", Features { body: BODIES[5], shape: Shape::Instance, lamp_shape: SKY, ..plain }),
        ("glowing, lamps by a tree", Features { glow: GLOWS[3], shape: Shape::Box, settings: SETTINGS[1], ..plain }),
        ("three light samples under a ball", Features { settings: SETTINGS[3], lamp_shape: LAMP_SHAPES[1], ..plain }),
    ];
    let linked = LINKS.iter().enumerate().skip(1);
    linked.flat_map(move |(number, &links)| {
        bodies.map(|(name, features)| (format!("{name}, links {number}"), Features { links, ..features }))
    })
}

/// Each of the stacks on a body, in turn under a lamp and under the sky.
pub fn stacks() -> impl Iterator<Item = (&'static str, Features)> {
    let plain = Features {
        body: BODIES[0],
        opacity: WHOLE,
        relief: FLAT,
        sides: SIDES[0],
        glow: GLOWS[0],
        shape: Shape::Box,
        motion: MOTIONS[0],
        lamp: LAMPS[0],
        lamp_shape: LAMP_SHAPES[1],
        settings: SETTINGS[0],
        links: LINKS[0],
    };
    STACKS.iter().enumerate().map(move |(place, &(name, body))| {
        let lamp_shape = if place % 2 == 0 { plain.lamp_shape } else { SKY };
        let settings = SETTINGS[if place == 3 { 3 } else { 0 }];
        (name, Features { body, lamp_shape, settings, ..plain })
    })
}

/// Bodies and lamps that once were wrong, each in its own way.
pub fn remembered() -> [(&'static str, Features); 5] {
    let plain = Features {
        body: BODIES[0],
        opacity: OPACITIES[1],
        relief: FLAT,
        sides: SIDES[0],
        glow: GLOWS[0],
        shape: Shape::Tube,
        motion: MOTIONS[0],
        lamp: LAMPS[0],
        lamp_shape: LAMP_SHAPES[0],
        settings: SETTINGS[0],
        links: LINKS[0],
    };
    let perturbed_sheet = Features {
        body: "type = \"diffuse\", reflectance = 0.05",
        relief: ", bump_map = \"hills\", bump_scale = 30, normal_shadowing = true",
        shape: Shape::Cover,
        lamp_shape: SKY,
        ..plain
    };
    let translucent_lamp = Features { lamp: LAMPS[1], shape: Shape::Sheet, ..plain };
    [
        ("a translucent tube has two walls in the way of a shadow ray", plain),
        ("a moving one as well", Features { motion: MOTIONS[2], ..plain }),
        ("normals perturbed on a translucent surface do not dim light that comes through it", perturbed_sheet),
        (
            "a translucent ball shows its far side, which light samples do not reach",
            Features { lamp_shape: LAMP_SHAPES[1], ..translucent_lamp },
        ),
        ("a translucent tube lights through its own wall", Features { lamp_shape: LAMP_SHAPES[2], ..translucent_lamp }),
    ]
}

impl Features {
    /// One of each feature's forms, by a number; forms that do not go together are left out.
    pub fn at_random(number: u64) -> Self {
        let mut state = number;
        let mut one_of = |count: usize| {
            // SplitMix64 (Steele, Lea and Flood 2014).
            state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let mixed = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            ((mixed ^ (mixed >> 31)) % count as u64) as usize
        };
        let shape = SHAPES[one_of(SHAPES.len())];
        let mut features = Self {
            body: BODIES[one_of(BODIES.len())],
            opacity: OPACITIES[one_of(OPACITIES.len())],
            relief: RELIEFS[one_of(RELIEFS.len())],
            sides: SIDES[one_of(SIDES.len())],
            glow: GLOWS[one_of(GLOWS.len())],
            shape,
            motion: MOTIONS[one_of(MOTIONS.len())],
            lamp: LAMPS[one_of(LAMPS.len())],
            lamp_shape: LAMP_SHAPES[one_of(LAMP_SHAPES.len())],
            settings: SETTINGS[one_of(SETTINGS.len())],
            links: LINKS[one_of(LINKS.len())],
        };
        if !shape.takes_relief() {
            features.relief = FLAT;
        }
        if !shape.takes_textures() && features.opacity.contains("texture") {
            features.opacity = OPACITIES[1];
        }
        if shape == Shape::Instance {
            // Groups of instances hold no lights.
            features.glow = GLOWS[0];
        }
        features
    }

    /// The scene file.
    pub fn scene(&self) -> String {
        let Self { body, opacity, relief, sides, glow, shape, motion, lamp, lamp_shape, settings, links } = self;
        // No lamp of the surroundings is left.
        let link_of_lamp = if *lamp_shape == SKY { "" } else { links.lamp };
        let link_of_glow = if glow.is_empty() { "" } else { links.glow };
        let (receiver, floor) = (links.body, links.floor);
        let rotated = "transform = [{ rotate = [1, 0.3, 0], degrees = 35 }, { translate = [0, 1.1, 0] }]";
        let mesh = "type = \"mesh\", positions = [[-0.9, -0.1, 0.8], [0.9, 0.2, 0.8], [0.9, -0.2, -0.8], [-0.9, 0.2, -0.8]], \
                    uvs = [[0, 0], [1, 0], [1, 1], [0, 1]], faces = [[0, 1, 2], [0, 2, 3]]";
        let place = match shape {
            Shape::Sheet => {
                format!("type = \"rectangle\", corner = [-0.8, 0, 0.8], edge_u = [1.6, 0, 0], edge_v = [0, 0, -1.6], {rotated}")
            }
            Shape::Cover => "type = \"rectangle\", corner = [-30, 3, 30], edge_u = [60, 0, 0], edge_v = [0, 0, -60]".to_owned(),
            Shape::Box => format!("type = \"box\", min = [-0.6, -0.4, -0.5], max = [0.6, 0.4, 0.5], {rotated}"),
            Shape::Mesh | Shape::Instance => format!("{mesh}, {rotated}"),
            Shape::Ball => format!("type = \"sphere\", center = [0, 0, 0], radius = 0.7, {rotated}"),
            Shape::Tube => format!("type = \"cylinder\", from = [-0.9, 0, 0], to = [0.9, 0, 0], radius = 0.5, {rotated}"),
            Shape::Disk => format!("type = \"disk\", center = [0, 0, 0], normal = [0, 1, 0], radius = 0.8, {rotated}"),
        };
        let instanced = *shape == Shape::Instance;
        let (motion_of_shape, receiver_of_shape) = if instanced { ("", "") } else { (*motion, receiver) };
        let body_shape = format!("{{ {place}, material = \"body\"{motion_of_shape}{receiver_of_shape} }}");
        let group =
            if instanced { format!("group = [{{ name = \"bodies\", shape = [{body_shape}] }}]\n") } else { String::new() };
        let instance =
            if instanced { format!("instance = [{{ group = \"bodies\"{motion}{receiver} }}]\n") } else { String::new() };
        let body_shape = if instanced { String::new() } else { format!("  {body_shape},\n") };
        let (light, lamp_shape) = if *lamp_shape == SKY {
            let link = links.lamp;
            (
                format!("light = [{{ type = \"sky\", zenith = [0.3, 0.5, 0.9], horizon = 0.8, ground = 0.3{link} }}]\n"),
                String::new(),
            )
        } else {
            (String::new(), format!("  {{ {lamp_shape}, material = \"lamp\" }},\n"))
        };
        format!(
            r#"
film.size = [16, 12]
render = {{ spp = 32, max_depth = 5, sampler = "independent", roulette_depth = 4, {settings} }}
camera = {{ position = [0.3, 2.2, 4.5], look_at = [0, 0.7, 0], vfov = 36, shutter = [0, 1] }}
texture = [
  {{ name = "squares", type = "checker", a = [1, 0.9, 0], b = [0, 0.3, 0.5], scale = [4, 3] }},
  {{ name = "hills", type = "perlin", scale = 5, a = 0, b = 1 }},
]
medium = [{{ name = "haze", scattering = [3, 2, 1], absorption = [0.2, 0.5, 1], phase = {{ type = "henyey_greenstein", g = 0.4 }} }}]
material = [
  {{ name = "floor", type = "diffuse", reflectance = 0.6 }},
  {{ name = "lamp", {lamp}{link_of_lamp} }},
  {{ name = "frosted", type = "rough_glass", ior = 1.4, alpha = 0.3 }},
  {{ name = "varnish", type = "glass", ior = 1.5 }},
  {{ name = "metal", type = "conductor", preset = "copper", alpha = 0.35 }},
  {{ name = "paint", type = "diffuse", reflectance = [0.7, 0.3, 0.2] }},
  {{ name = "coated", type = "layered", interfaces = ["frosted", "paint"] }},
  {{ name = "half coated", type = "blend", materials = ["paint", "also coated"], weight = {{ type = "constant", value = 0.4 }} }},
  {{ name = "also coated", type = "layered", interfaces = ["varnish", "metal"] }},
  {{ name = "body", {body}{opacity}{relief}{sides}{glow}{link_of_glow} }},
]
shape = [
  {{ type = "rectangle", corner = [-3, 0, 3], edge_u = [6, 0, 0], edge_v = [0, 0, -6], material = "floor"{floor} }},
{body_shape}{lamp_shape}]
{group}{instance}{light}"#
        )
    }
}
