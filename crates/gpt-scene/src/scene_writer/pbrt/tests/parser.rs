//! A strict reader of pbrt's text: directives, the parameters that each may have, and names that stand for something.

use std::collections::BTreeSet;

/// A parameter as it is written.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    pub kind: String,
    pub name: String,
    pub values: Vec<String>,
}

/// A directive with its texts or numbers, and its parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct Statement {
    pub name: String,
    pub texts: Vec<String>,
    pub numbers: Vec<f64>,
    pub parameters: Vec<Parameter>,
}

impl Statement {
    pub fn parameter(&self, name: &str) -> Option<&Parameter> {
        self.parameters.iter().find(|parameter| parameter.name == name)
    }

    /// The numbers of a parameter; none where it is not written.
    pub fn numbers_of(&self, name: &str) -> Vec<f64> {
        let values = self.parameter(name).map(|parameter| parameter.values.clone()).unwrap_or_default();
        values.iter().map(|value| value.parse().unwrap_or_else(|_| panic!("{value} is no number"))).collect()
    }

    pub fn text_of(&self, name: &str) -> Option<&str> {
        self.parameter(name).and_then(|parameter| parameter.values.first()).map(String::as_str)
    }
}

#[derive(Debug, Clone, PartialEq)]
enum Token {
    Text(String),
    Word(String),
    Open,
    Close,
}

fn tokens(text: &str) -> Result<Vec<Token>, String> {
    let mut tokens = Vec::new();
    let mut rest = text.chars().peekable();
    while let Some(character) = rest.next() {
        match character {
            '#' => while rest.next_if(|next| *next != '\n').is_some() {},
            '[' => tokens.push(Token::Open),
            ']' => tokens.push(Token::Close),
            '"' => {
                let mut inside = String::new();
                loop {
                    match rest.next().ok_or("a text without an end")? {
                        '"' => break,
                        '\\' => inside.push(rest.next().ok_or("a text without an end")?),
                        '\n' => return Err("a text over two lines".to_owned()),
                        other => inside.push(other),
                    }
                }
                tokens.push(Token::Text(inside));
            }
            space if space.is_whitespace() => {}
            first => {
                let mut word = String::from(first);
                while let Some(next) = rest.next_if(|next| !next.is_whitespace() && !"[]\"#".contains(*next)) {
                    word.push(next);
                }
                tokens.push(Token::Word(word));
            }
        }
    }
    Ok(tokens)
}

/// Directives with the texts and numbers behind their names, and whether parameters follow.
const DIRECTIVES: [(&str, usize, usize, bool); 26] = [
    ("Identity", 0, 0, false),
    ("Integrator", 1, 0, true),
    ("Sampler", 1, 0, true),
    ("PixelFilter", 1, 0, true),
    ("Film", 1, 0, true),
    ("Camera", 1, 0, true),
    ("Scale", 0, 3, false),
    ("LookAt", 0, 9, false),
    ("Rotate", 0, 4, false),
    ("Transform", 0, 16, false),
    ("WorldBegin", 0, 0, false),
    ("AttributeBegin", 0, 0, false),
    ("AttributeEnd", 0, 0, false),
    ("ReverseOrientation", 0, 0, false),
    ("MakeNamedMedium", 1, 0, true),
    ("MediumInterface", 2, 0, false),
    ("MakeNamedMaterial", 1, 0, true),
    ("NamedMaterial", 1, 0, false),
    ("Material", 1, 0, true),
    ("Texture", 3, 0, true),
    ("LightSource", 1, 0, true),
    ("AreaLightSource", 1, 0, true),
    ("Shape", 1, 0, true),
    ("ObjectBegin", 1, 0, false),
    ("ObjectEnd", 0, 0, false),
    ("ObjectInstance", 1, 0, false),
];

const ROUGH: [(&str, &str); 3] = [("roughness", "f"), ("uroughness", "f"), ("vroughness", "f")];
const LAYERS: [(&str, &str); 4] =
    [("thickness", "f"), ("maxdepth", "integer"), ("nsamples", "integer"), ("remaproughness", "bool")];
const BENT: [(&str, &str); 3] = [("type", "string"), ("displacement", "f"), ("normalmap", "string")];
const MAPPED: [(&str, &str); 4] = [("uscale", "float"), ("vscale", "float"), ("udelta", "float"), ("vdelta", "float")];
const PICTURE: [(&str, &str); 5] =
    [("filename", "string"), ("encoding", "string"), ("wrap", "string"), ("filter", "string"), ("scale", "float")];

/// The parameters of a directive of a type, with their types: `f` is a number or a texture of numbers, `s` a spectrum or a texture of colours.
fn known(name: &str, kind: &str) -> Option<Vec<(&'static str, &'static str)>> {
    let list: &[&[(&str, &str)]] = match (name, kind) {
        ("Integrator", "path" | "volpath") => &[&[("maxdepth", "integer"), ("regularize", "bool")]],
        ("Sampler", "halton" | "independent") => &[&[("pixelsamples", "integer")]],
        ("PixelFilter", "box" | "triangle") => &[&[("xradius", "float"), ("yradius", "float")]],
        ("PixelFilter", "gaussian") => &[&[("xradius", "float"), ("yradius", "float"), ("sigma", "float")]],
        ("Film", "rgb") => {
            &[&[("filename", "string"), ("xresolution", "integer"), ("yresolution", "integer"), ("savefp16", "bool")]]
        }
        ("Camera", "perspective") => {
            &[&[("fov", "float"), ("screenwindow", "float"), ("lensradius", "float"), ("focaldistance", "float")]]
        }
        ("Camera", "orthographic") => &[&[("screenwindow", "float"), ("lensradius", "float"), ("focaldistance", "float")]],
        ("Camera", "spherical") => &[&[("mapping", "string")]],
        ("MakeNamedMedium", "homogeneous") => {
            &[&[("type", "string"), ("sigma_a", "rgb"), ("sigma_s", "rgb"), ("Le", "rgb"), ("g", "float")]]
        }
        ("MakeNamedMedium", "uniformgrid") => &[
            &[("type", "string"), ("sigma_a", "rgb"), ("sigma_s", "rgb"), ("Le", "rgb"), ("g", "float"), ("scale", "float")],
            &[("p0", "point3"), ("p1", "point3"), ("nx", "integer"), ("ny", "integer"), ("nz", "integer"), ("density", "float")],
        ],
        ("Material", "interface") => &[&[]],
        ("MakeNamedMaterial", "diffuse") => &[&BENT, &[("reflectance", "s")]],
        ("MakeNamedMaterial", "conductor") => {
            &[&BENT, &ROUGH, &[("reflectance", "s"), ("eta", "s"), ("k", "s"), ("remaproughness", "bool")]]
        }
        ("MakeNamedMaterial", "dielectric") => &[&BENT, &ROUGH, &[("eta", "n"), ("remaproughness", "bool")]],
        ("MakeNamedMaterial", "thindielectric") => &[&BENT, &[("eta", "n")]],
        ("MakeNamedMaterial", "coateddiffuse") => &[&BENT, &ROUGH, &LAYERS, &[("reflectance", "s"), ("eta", "n")]],
        ("MakeNamedMaterial", "coatedconductor") => &[
            &BENT,
            &LAYERS,
            &[
                ("interface.roughness", "f"),
                ("interface.uroughness", "f"),
                ("interface.vroughness", "f"),
                ("interface.eta", "n"),
                ("conductor.roughness", "f"),
                ("conductor.uroughness", "f"),
                ("conductor.vroughness", "f"),
                ("conductor.eta", "s"),
                ("conductor.k", "s"),
                ("reflectance", "s"),
            ],
        ],
        ("MakeNamedMaterial", "diffusetransmission") => &[&BENT, &[("reflectance", "s"), ("transmittance", "s")]],
        ("MakeNamedMaterial", "mix") => &[&[("type", "string"), ("materials", "string"), ("amount", "f")]],
        ("Texture", "spectrum imagemap" | "float imagemap") => &[&PICTURE, &MAPPED],
        ("Texture", "spectrum checkerboard") => &[&MAPPED, &[("tex1", "rgb"), ("tex2", "rgb")]],
        ("Texture", "float checkerboard") => &[&MAPPED, &[("tex1", "float"), ("tex2", "float")]],
        ("LightSource", "point") => &[&[("I", "rgb"), ("from", "point3")]],
        ("LightSource", "spot") => {
            &[&[("I", "rgb"), ("from", "point3"), ("to", "point3"), ("coneangle", "float"), ("conedeltaangle", "float")]]
        }
        ("LightSource", "goniometric") => &[&[("I", "rgb"), ("filename", "string")]],
        ("LightSource", "distant") => &[&[("L", "rgb"), ("from", "point3"), ("to", "point3")]],
        ("LightSource", "infinite") => &[&[("L", "rgb"), ("filename", "string")]],
        ("AreaLightSource", "diffuse") => &[&[("L", "rgb"), ("filename", "string"), ("twosided", "bool")]],
        ("Shape", "sphere") => &[&[("radius", "float"), ("alpha", "f")]],
        ("Shape", "disk") => &[&[("radius", "float"), ("alpha", "f")]],
        ("Shape", "cylinder") => &[&[("radius", "float"), ("zmin", "float"), ("zmax", "float"), ("alpha", "f")]],
        ("Shape", "trianglemesh") => {
            &[&[("indices", "integer"), ("P", "point3"), ("N", "normal"), ("uv", "point2"), ("alpha", "f")]]
        }
        ("Shape", "plymesh") => &[&[("filename", "string"), ("alpha", "f")]],
        _ => return None,
    };
    Some(list.concat())
}

fn is_of_kind(wanted: &str, found: &str) -> bool {
    match wanted {
        "f" => ["float", "texture"].contains(&found),
        "s" => ["rgb", "spectrum", "texture"].contains(&found),
        "n" => ["float", "spectrum"].contains(&found),
        exactly => exactly == found,
    }
}

/// The statements of a text.
pub fn parse(text: &str) -> Result<Vec<Statement>, String> {
    let tokens = tokens(text)?;
    let mut at = 0;
    let mut statements = Vec::new();
    while at < tokens.len() {
        let Token::Word(name) = &tokens[at] else { return Err(format!("{:?} begins no directive", tokens[at])) };
        let (_, texts, numbers, has_parameters) =
            *DIRECTIVES.iter().find(|(known, ..)| known == name).ok_or_else(|| format!("no directive {name}"))?;
        at += 1;
        let mut statement = Statement { name: name.clone(), texts: Vec::new(), numbers: Vec::new(), parameters: Vec::new() };
        for _ in 0..texts {
            let Some(Token::Text(text)) = tokens.get(at) else { return Err(format!("{name} has too few texts")) };
            statement.texts.push(text.clone());
            at += 1;
        }
        let is_list = numbers > 0 && tokens.get(at) == Some(&Token::Open);
        at += usize::from(is_list);
        for _ in 0..numbers {
            let Some(Token::Word(number)) = tokens.get(at) else { return Err(format!("{name} has too few numbers")) };
            statement.numbers.push(finite(number)?);
            at += 1;
        }
        if is_list {
            (tokens.get(at) == Some(&Token::Close)).then_some(()).ok_or_else(|| format!("{name} has too many numbers"))?;
            at += 1;
        }
        while has_parameters && let Some(Token::Text(declaration)) = tokens.get(at) {
            let (kind, name) = declaration.split_once(' ').ok_or_else(|| format!("no type in {declaration}"))?;
            (tokens.get(at + 1) == Some(&Token::Open)).then_some(()).ok_or_else(|| format!("no values of {name}"))?;
            at += 2;
            let mut values = Vec::new();
            loop {
                match tokens.get(at).ok_or("the text ends within a list")? {
                    Token::Close => break,
                    Token::Text(text) if ["string", "texture", "spectrum"].contains(&kind) => values.push(text.clone()),
                    Token::Word(word) if kind == "bool" && ["true", "false"].contains(&word.as_str()) => {
                        values.push(word.clone());
                    }
                    Token::Word(word) if !["string", "texture", "bool"].contains(&kind) => {
                        finite(word)?;
                        values.push(word.clone());
                    }
                    other => return Err(format!("{other:?} is no {kind}")),
                }
                at += 1;
            }
            at += 1;
            statement.parameters.push(Parameter { kind: kind.to_owned(), name: name.to_owned(), values });
        }
        check(&statement)?;
        statements.push(statement);
    }
    Ok(statements)
}

fn finite(word: &str) -> Result<f64, String> {
    word.parse().ok().filter(|number: &f64| number.is_finite()).ok_or_else(|| format!("{word} is no number"))
}

/// Parameters are known, of the type that they should have, and as many as they should be.
fn check(statement: &Statement) -> Result<(), String> {
    let Statement { name, texts, parameters, .. } = statement;
    if parameters.is_empty() {
        return Ok(());
    }
    let kind = match name.as_str() {
        "MakeNamedMaterial" | "MakeNamedMedium" => statement.text_of("type").ok_or("no type")?.to_owned(),
        "Texture" => format!("{} {}", texts[1], texts[2]),
        _ => texts[0].clone(),
    };
    let known = known(name, &kind).ok_or_else(|| format!("no {name} of type {kind}"))?;
    for (index, Parameter { kind: found, name: parameter, values }) in parameters.iter().enumerate() {
        if parameters[..index].iter().any(|before| before.name == *parameter) {
            return Err(format!("{parameter} stands twice"));
        }
        let (_, wanted) =
            known.iter().find(|(name, _)| name == parameter).ok_or_else(|| format!("{name} {kind} has no {parameter}"))?;
        if !is_of_kind(wanted, found) {
            return Err(format!("{parameter} of {name} {kind} is no {found}"));
        }
        let multiple = match (parameter.as_str(), found.as_str()) {
            ("materials", _) => 2,
            ("screenwindow", _) => 4,
            ("indices" | "P" | "N", _) | (_, "rgb" | "point3") => 3,
            ("uv", _) => 2,
            (_, "spectrum") if values.len() > 1 => 2,
            _ => 1,
        };
        let is_list = ["indices", "P", "N", "uv", "density"].contains(&parameter.as_str()) || found == "spectrum";
        let fits = if is_list { values.len().is_multiple_of(multiple) && !values.is_empty() } else { values.len() == multiple };
        fits.then_some(()).ok_or_else(|| format!("{parameter} of {name} has {} values", values.len()))?;
        let is_albedo = ["reflectance", "transmittance", "tex1", "tex2"].contains(&parameter.as_str());
        if is_albedo && found == "rgb" && values.iter().any(|value| !(0.0..=1.0).contains(&value.parse().unwrap_or(-1.0))) {
            return Err(format!("{parameter} is beyond 0 to 1"));
        }
    }
    Ok(())
}

/// Checks the order of a scene's statements, its blocks, and that every name stands for something before it is used.
pub fn check_scene(statements: &[Statement]) -> Result<(), String> {
    let mut defined: BTreeSet<(String, String)> = BTreeSet::new();
    let (mut depth, mut is_world, mut in_object, mut has_camera) = (0_i32, false, false, false);
    let sizes = |statement: &Statement, name: &str, each: usize| statement.numbers_of(name).len() / each;
    for statement in statements {
        let Statement { name, texts, parameters, .. } = statement;
        let of_world = ["Shape", "LightSource", "AreaLightSource", "ObjectBegin", "ObjectInstance", "NamedMaterial"];
        if of_world.contains(&name.as_str()) && !is_world {
            return Err(format!("{name} before the world"));
        }
        let mut define = |space: &str, name: &str| -> Result<(), String> {
            defined
                .insert((space.to_owned(), name.to_owned()))
                .then_some(())
                .ok_or_else(|| format!("{space} {name} is defined twice"))
        };
        match name.as_str() {
            "WorldBegin" => is_world = true,
            "Camera" => has_camera = true,
            "AttributeBegin" => depth += 1,
            "AttributeEnd" => depth -= 1,
            "ObjectBegin" => {
                define("object", &texts[0])?;
                (!in_object).then_some(()).ok_or("an object within an object")?;
                in_object = true;
            }
            "ObjectEnd" => in_object = false,
            "MakeNamedMaterial" => define("material", &texts[0])?,
            "MakeNamedMedium" => define("medium", &texts[0])?,
            "Texture" => define(&format!("{} texture", texts[1]), &texts[0])?,
            _ => {}
        }
        let mut uses: Vec<(&str, String)> = match name.as_str() {
            "NamedMaterial" => vec![("material", texts[0].clone())],
            "ObjectInstance" => vec![("object", texts[0].clone())],
            "MediumInterface" => texts.iter().filter(|text| !text.is_empty()).map(|text| ("medium", text.clone())).collect(),
            _ => Vec::new(),
        };
        for Parameter { kind, name, values } in parameters {
            if name == "materials" {
                uses.extend(values.iter().map(|value| ("material", value.clone())));
            }
            if kind == "texture" {
                let is_colour = ["reflectance", "transmittance", "eta", "k"].contains(&name.as_str());
                uses.push((if is_colour { "spectrum texture" } else { "float texture" }, values[0].clone()));
            }
        }
        for (space, used) in uses {
            if !defined.contains(&(space.to_owned(), used.clone())) {
                return Err(format!("{name}: there is no {space} {used}"));
            }
        }
        if depth < 0 || in_object && name == "AreaLightSource" {
            return Err(format!("{name} where it cannot be"));
        }
        let voxels: f64 = ["nx", "ny", "nz"].into_iter().flat_map(|side| statement.numbers_of(side)).product();
        if statement.parameter("density").is_some() && voxels != sizes(statement, "density", 1) as f64 {
            return Err(format!("a grid of {voxels} voxels with another number of values"));
        }
        if name == "Shape" && texts[0] == "trianglemesh" {
            let vertices = sizes(statement, "P", 3);
            let fits = |count: usize| count == 0 || count == vertices;
            let is_there = statement.numbers_of("indices").iter().all(|index| (*index as usize) < vertices);
            let is_whole = fits(sizes(statement, "N", 3)) && fits(sizes(statement, "uv", 2)) && is_there;
            is_whole.then_some(()).ok_or("a mesh whose lists do not fit")?;
        }
    }
    (depth == 0 && is_world && has_camera && !in_object).then_some(()).ok_or_else(|| "blocks without an end".to_owned())
}
