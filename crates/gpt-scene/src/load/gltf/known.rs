//! The keys of glTF 2.0 and of its extensions, object by object: the one table of what is read. Whatever else a file says is in the report.

use std::fmt;

use serde::de::{DeserializeSeed, Deserializer, IgnoredAny, MapAccess, SeqAccess, Visitor};

/// The report on a key that is passed over.
const NO_EFFECT: &str = "it has no effect";

/// A key of an object.
pub struct Key {
    pub name: &'static str,
    pub role: Role,
    holds: Holds,
}

/// The purpose of a key.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// The key changes the picture, or its reader reports it.
    Read,
    /// The key has no effect on the picture: names, authors, hints to graphics interfaces.
    Aside,
    /// The key is not read; in words, the replacement.
    Unread(&'static str),
}

/// The kind of value behind a key.
pub enum Holds {
    Value,
    Object(&'static Object),
    List(&'static Object),
    /// Accessors by the names of attributes.
    Attributes,
    /// A list of those, of morph targets.
    Targets,
}

/// An object: its keys, and the extensions that it may have.
pub struct Object {
    /// Its name in this table.
    #[cfg_attr(not(test), allow(dead_code, reason = "tests tell objects apart by it"))]
    name: &'static str,
    pub keys: &'static [Key],
    pub extensions: &'static [(&'static str, &'static Object)],
}

const fn key(name: &'static str, role: Role, holds: Holds) -> Key {
    Key { name, role, holds }
}

const fn read(name: &'static str) -> Key {
    key(name, Role::Read, Holds::Value)
}

const fn aside(name: &'static str) -> Key {
    key(name, Role::Aside, Holds::Value)
}

const fn unread(name: &'static str, instead: &'static str) -> Key {
    key(name, Role::Unread(instead), Holds::Value)
}

const fn object(name: &'static str, of: &'static Object) -> Key {
    key(name, Role::Read, Holds::Object(of))
}

const fn list(name: &'static str, of: &'static Object) -> Key {
    key(name, Role::Read, Holds::List(of))
}

macro_rules! objects {
    ($($name:ident [$($key:expr),* $(,)?] $(with $($extension:literal: $of:ident),* $(,)?)?;)*) => {$(
        static $name: Object = Object { name: stringify!($name), keys: &[$($key),*], extensions: &[$($(($extension, &$of)),*)?] };
    )*};
}

/// Extensions that are read, and whether they are about the picture; what of them is not exact is in the report.
pub const EXTENSIONS: [(&str, Role); 33] = [
    ("KHR_lights_punctual", Role::Read),
    ("EXT_lights_ies", Role::Read),
    ("EXT_lights_image_based", Role::Read),
    ("KHR_texture_transform", Role::Read),
    ("KHR_mesh_quantization", Role::Read),
    ("EXT_meshopt_compression", Role::Read),
    ("KHR_meshopt_compression", Role::Read),
    ("EXT_mesh_gpu_instancing", Role::Read),
    ("EXT_texture_webp", Role::Read),
    ("KHR_node_visibility", Role::Read),
    ("KHR_materials_emissive_strength", Role::Read),
    ("KHR_materials_ior", Role::Read),
    ("KHR_materials_specular", Role::Read),
    ("KHR_materials_transmission", Role::Read),
    ("KHR_materials_volume", Role::Read),
    ("KHR_materials_volume_scatter", Role::Read),
    ("KHR_materials_clearcoat", Role::Read),
    ("KHR_materials_sheen", Role::Read),
    ("KHR_materials_anisotropy", Role::Read),
    ("KHR_materials_iridescence", Role::Read),
    ("KHR_materials_dispersion", Role::Read),
    ("KHR_materials_diffuse_transmission", Role::Read),
    ("KHR_materials_pbrSpecularGlossiness", Role::Read),
    ("KHR_materials_unlit", Role::Read),
    ("KHR_materials_variants", Role::Read),
    ("KHR_animation_pointer", Role::Read),
    ("KHR_xmp", Role::Aside),
    ("KHR_xmp_json_ld", Role::Aside),
    ("KHR_node_selectability", Role::Aside),
    ("KHR_node_hoverability", Role::Aside),
    ("KHR_interactivity", Role::Aside),
    ("MSFT_packing_normalRoughnessMetallic", Role::Aside),
    ("MSFT_packing_occlusionRoughnessMetallic", Role::Aside),
];

/// Extensions whose place something else takes where they are not required.
pub const WITH_FALLBACK: [&str; 4] = ["KHR_draco_mesh_compression", "KHR_texture_basisu", "EXT_texture_avif", "MSFT_texture_dds"];

objects! {
    ROOT [
        object("asset", &ASSET),
        read("scene"),
        list("scenes", &SCENE),
        list("nodes", &NODE),
        list("meshes", &MESH),
        list("accessors", &ACCESSOR),
        list("bufferViews", &BUFFER_VIEW),
        list("buffers", &BUFFER),
        list("materials", &MATERIAL),
        list("textures", &TEXTURE),
        list("images", &IMAGE),
        list("samplers", &SAMPLER),
        list("cameras", &CAMERA),
        list("skins", &SKIN),
        list("animations", &ANIMATION),
        read("extensionsUsed"),
        read("extensionsRequired"),
    ] with "KHR_lights_punctual": LIGHTS, "EXT_lights_ies": PROFILES, "EXT_lights_image_based": IMAGE_LIGHTS,
        "KHR_materials_variants": VARIANTS;
    ASSET [read("version"), read("minVersion"), aside("generator"), aside("copyright")];
    SCENE [read("nodes")] with "EXT_lights_image_based": LIGHT_OF_SCENE;
    IMAGE_LIGHTS [list("lights", &IMAGE_LIGHT)];
    IMAGE_LIGHT [
        read("rotation"),
        read("intensity"),
        read("irradianceCoefficients"),
        read("specularImages"),
        aside("specularImageSize"),
    ];
    LIGHT_OF_SCENE [read("light")];
    NODE [
        read("camera"),
        read("children"),
        read("skin"),
        read("matrix"),
        read("mesh"),
        read("rotation"),
        read("scale"),
        read("translation"),
        read("weights"),
    ] with "KHR_lights_punctual": LIGHT_OF_NODE, "EXT_lights_ies": PROFILE_OF_NODE, "EXT_mesh_gpu_instancing": INSTANCES, "KHR_node_visibility": VISIBILITY;
    LIGHT_OF_NODE [read("light")];
    PROFILE_OF_NODE [read("light"), read("multiplier"), read("color")];
    INSTANCES [key("attributes", Role::Read, Holds::Object(&INSTANCE_ATTRIBUTES))];
    INSTANCE_ATTRIBUTES [read("TRANSLATION"), read("ROTATION"), read("SCALE")];
    VISIBILITY [read("visible")];
    MESH [list("primitives", &PRIMITIVE), read("weights")];
    PRIMITIVE [
        key("attributes", Role::Read, Holds::Attributes),
        read("indices"),
        read("material"),
        read("mode"),
        key("targets", Role::Read, Holds::Targets),
    ] with "KHR_draco_mesh_compression": DRACO, "KHR_materials_variants": MAPPINGS;
    DRACO [aside("bufferView"), aside("attributes")];
    MAPPINGS [list("mappings", &MAPPING)];
    MAPPING [read("variants"), read("material")];
    ACCESSOR [
        read("bufferView"),
        read("byteOffset"),
        read("componentType"),
        read("normalized"),
        read("count"),
        read("type"),
        aside("max"),
        aside("min"),
        object("sparse", &SPARSE),
    ];
    SPARSE [read("count"), object("indices", &SPARSE_INDICES), object("values", &SPARSE_VALUES)];
    SPARSE_INDICES [read("bufferView"), read("byteOffset"), read("componentType")];
    SPARSE_VALUES [read("bufferView"), read("byteOffset")];
    BUFFER_VIEW [read("buffer"), read("byteOffset"), read("byteLength"), read("byteStride"), aside("target")]
        with "EXT_meshopt_compression": PACKED, "KHR_meshopt_compression": PACKED;
    PACKED [
        read("buffer"),
        read("byteOffset"),
        read("byteLength"),
        read("byteStride"),
        read("count"),
        read("mode"),
        read("filter"),
    ];
    BUFFER [read("uri"), read("byteLength")]
        with "EXT_meshopt_compression": STAND_IN, "KHR_meshopt_compression": STAND_IN;
    STAND_IN [read("fallback")];
    MATERIAL [
        object("pbrMetallicRoughness", &METALLIC_ROUGHNESS),
        object("normalTexture", &NORMAL_TEXTURE),
        object("occlusionTexture", &OCCLUSION_TEXTURE),
        object("emissiveTexture", &TEXTURE_INFO),
        read("emissiveFactor"),
        read("alphaMode"),
        read("alphaCutoff"),
        read("doubleSided"),
    ] with
        "KHR_materials_emissive_strength": EMISSIVE_STRENGTH,
        "KHR_materials_ior": IOR,
        "KHR_materials_specular": SPECULAR,
        "KHR_materials_transmission": TRANSMISSION,
        "KHR_materials_volume": VOLUME,
        "KHR_materials_volume_scatter": VOLUME_SCATTER,
        "KHR_materials_clearcoat": CLEARCOAT,
        "KHR_materials_sheen": SHEEN,
        "KHR_materials_anisotropy": ANISOTROPY,
        "KHR_materials_iridescence": IRIDESCENCE,
        "KHR_materials_dispersion": DISPERSION,
        "KHR_materials_diffuse_transmission": DIFFUSE_TRANSMISSION,
        "KHR_materials_pbrSpecularGlossiness": SPECULAR_GLOSSINESS,
        "KHR_materials_unlit": UNLIT;
    METALLIC_ROUGHNESS [
        read("baseColorFactor"),
        object("baseColorTexture", &TEXTURE_INFO),
        read("metallicFactor"),
        read("roughnessFactor"),
        object("metallicRoughnessTexture", &TEXTURE_INFO),
    ];
    TEXTURE_INFO [read("index"), read("texCoord")] with "KHR_texture_transform": TRANSFORM;
    NORMAL_TEXTURE [read("index"), read("texCoord"), read("scale")] with "KHR_texture_transform": TRANSFORM;
    // The texture as a whole is reported.
    OCCLUSION_TEXTURE [aside("index"), aside("texCoord"), aside("strength")] with "KHR_texture_transform": UNUSED_TRANSFORM;
    TRANSFORM [read("offset"), read("rotation"), read("scale"), read("texCoord")];
    UNUSED_TRANSFORM [aside("offset"), aside("rotation"), aside("scale"), aside("texCoord")];
    EMISSIVE_STRENGTH [read("emissiveStrength")];
    IOR [read("ior")];
    SPECULAR [
        read("specularFactor"),
        object("specularTexture", &TEXTURE_INFO),
        read("specularColorFactor"),
        object("specularColorTexture", &TEXTURE_INFO),
    ];
    TRANSMISSION [read("transmissionFactor"), object("transmissionTexture", &TEXTURE_INFO)];
    VOLUME [
        read("thicknessFactor"),
        unread("thicknessTexture", "thickness is that of the shape"),
        read("attenuationDistance"),
        read("attenuationColor"),
    ];
    VOLUME_SCATTER [read("multiscatterColor"), read("scatterAnisotropy")];
    CLEARCOAT [
        read("clearcoatFactor"),
        object("clearcoatTexture", &TEXTURE_INFO),
        read("clearcoatRoughnessFactor"),
        object("clearcoatRoughnessTexture", &TEXTURE_INFO),
        object("clearcoatNormalTexture", &NORMAL_TEXTURE),
    ];
    SHEEN [
        read("sheenColorFactor"),
        object("sheenColorTexture", &TEXTURE_INFO),
        read("sheenRoughnessFactor"),
        object("sheenRoughnessTexture", &TEXTURE_INFO),
    ];
    ANISOTROPY [read("anisotropyStrength"), read("anisotropyRotation"), object("anisotropyTexture", &TEXTURE_INFO)];
    IRIDESCENCE [
        read("iridescenceFactor"),
        object("iridescenceTexture", &TEXTURE_INFO),
        read("iridescenceIor"),
        read("iridescenceThicknessMinimum"),
        read("iridescenceThicknessMaximum"),
        object("iridescenceThicknessTexture", &TEXTURE_INFO),
    ];
    DISPERSION [read("dispersion")];
    DIFFUSE_TRANSMISSION [
        read("diffuseTransmissionFactor"),
        object("diffuseTransmissionTexture", &TEXTURE_INFO),
        read("diffuseTransmissionColorFactor"),
        object("diffuseTransmissionColorTexture", &TEXTURE_INFO),
    ];
    SPECULAR_GLOSSINESS [
        read("diffuseFactor"),
        object("diffuseTexture", &TEXTURE_INFO),
        read("specularFactor"),
        read("glossinessFactor"),
        object("specularGlossinessTexture", &TEXTURE_INFO),
    ];
    UNLIT [];
    TEXTURE [read("sampler"), read("source")] with
        "EXT_texture_webp": PICTURE,
        "KHR_texture_basisu": UNREAD_PICTURE,
        "EXT_texture_avif": UNREAD_PICTURE,
        "MSFT_texture_dds": UNREAD_PICTURE;
    PICTURE [read("source")];
    // Its stand-in is reported where there is no other picture.
    UNREAD_PICTURE [aside("source")];
    IMAGE [read("uri"), aside("mimeType"), read("bufferView")];
    SAMPLER [read("magFilter"), read("minFilter"), read("wrapS"), read("wrapT")];
    CAMERA [aside("type"), object("perspective", &PERSPECTIVE), object("orthographic", &ORTHOGRAPHIC)];
    PERSPECTIVE [read("aspectRatio"), read("yfov"), read("zfar"), read("znear")];
    ORTHOGRAPHIC [read("xmag"), read("ymag"), read("zfar"), read("znear")];
    SKIN [read("inverseBindMatrices"), aside("skeleton"), read("joints")];
    ANIMATION [list("channels", &CHANNEL), list("samplers", &ANIMATION_SAMPLER)];
    CHANNEL [read("sampler"), object("target", &TARGET)];
    // A channel that moves something else than a node is reported.
    TARGET [read("node"), read("path")] with "KHR_animation_pointer": POINTER;
    POINTER [aside("pointer")];
    ANIMATION_SAMPLER [read("input"), read("interpolation"), read("output")];
    LIGHTS [list("lights", &LIGHT)];
    PROFILES [list("lights", &PROFILE)];
    PROFILE [read("uri"), read("bufferView"), aside("mimeType")];
    LIGHT [read("type"), read("color"), read("intensity"), read("range"), object("spot", &CONE)];
    CONE [read("innerConeAngle"), read("outerConeAngle")];
    VARIANTS [list("variants", &VARIANT)];
    VARIANT [];
}

/// Something that a file says and that is not read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Unread {
    pub what: String,
    /// The place in the file, such as `materials[3]`.
    pub place: String,
    pub instead: &'static str,
}

/// All that the JSON says and the table does not have, in its order. A text that is no JSON has nothing.
pub fn find_unread(json: &[u8]) -> Vec<Unread> {
    let mut found = Vec::new();
    let walk = Walk { at: At::Object(&ROOT), place: String::new(), found: &mut found };
    // Mistakes are reported where the objects are read.
    let _ = walk.deserialize(&mut serde_json::Deserializer::from_slice(json));
    found
}

/// Walks through what stands at a place.
struct Walk<'f> {
    at: At,
    place: String,
    found: &'f mut Vec<Unread>,
}

/// The value that is meant to stand at a place.
#[derive(Clone, Copy)]
enum At {
    Object(&'static Object),
    List(&'static Object),
    /// The extensions of an object.
    Extensions(&'static Object),
    Attributes {
        of_target: bool,
    },
    Targets,
    /// Something without keys of its own.
    Value,
}

impl Walk<'_> {
    fn note(&mut self, what: &str, instead: &'static str) {
        self.found.push(Unread { what: what.to_owned(), place: self.place.clone(), instead });
    }

    fn within(&mut self, at: At, step: &str) -> Walk<'_> {
        let dot = if self.place.is_empty() || step.starts_with('[') { "" } else { "." };
        Walk { at, place: format!("{}{dot}{step}", self.place), found: self.found }
    }

    /// The value behind a key, which is noted where nothing reads it.
    fn behind(&mut self, name: &str) -> At {
        match self.at {
            At::Object(object) => match object.keys.iter().find(|key| key.name == name) {
                _ if name == "extensions" => At::Extensions(object),
                _ if ["extras", "name"].contains(&name) => At::Value,
                Some(Key { role: Role::Unread(instead), .. }) => {
                    self.note(&format!("`{name}`"), instead);
                    At::Value
                }
                Some(Key { holds, .. }) => match holds {
                    Holds::Value => At::Value,
                    Holds::Object(object) => At::Object(object),
                    Holds::List(object) => At::List(object),
                    Holds::Attributes => At::Attributes { of_target: false },
                    Holds::Targets => At::Targets,
                },
                None => {
                    self.note(&format!("`{name}`"), NO_EFFECT);
                    At::Value
                }
            },
            At::Extensions(object) => match object.extensions.iter().find(|(known, _)| *known == name) {
                Some((_, object)) => At::Object(object),
                None => {
                    if !EXTENSIONS.contains(&(name, Role::Aside)) {
                        self.note(name, NO_EFFECT);
                    }
                    At::Value
                }
            },
            At::Attributes { of_target } => {
                if let Role::Unread(instead) = role_of_attribute(name, of_target) {
                    self.note(name, instead);
                }
                At::Value
            }
            At::List(_) | At::Targets | At::Value => At::Value,
        }
    }
}

impl<'de> DeserializeSeed<'de> for Walk<'_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        match self.at {
            At::Value => deserializer.deserialize_ignored_any(IgnoredAny).map(drop),
            _ => deserializer.deserialize_any(self),
        }
    }
}

impl<'de> Visitor<'de> for Walk<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("an object or a list")
    }

    fn visit_map<A: MapAccess<'de>>(mut self, mut entries: A) -> Result<(), A::Error> {
        while let Some(name) = entries.next_key::<String>()? {
            let behind = self.behind(&name);
            entries.next_value_seed(self.within(behind, &name))?;
        }
        Ok(())
    }

    fn visit_seq<A: SeqAccess<'de>>(mut self, mut values: A) -> Result<(), A::Error> {
        let item = match self.at {
            At::List(object) => At::Object(object),
            At::Targets => At::Attributes { of_target: true },
            _ => At::Value,
        };
        let mut index = 0;
        while values.next_element_seed(self.within(item, &format!("[{index}]")))?.is_some() {
            index += 1;
        }
        Ok(())
    }
}

/// The purpose of an attribute of a primitive, or of a morph target.
pub fn role_of_attribute(name: &str, of_target: bool) -> Role {
    let set_of =
        |prefix: &str| name.strip_prefix(prefix).is_some_and(|set| !set.is_empty() && set.bytes().all(|b| b.is_ascii_digit()));
    let is_set = ["TEXCOORD_", "JOINTS_", "WEIGHTS_"].into_iter().any(set_of);
    match name {
        "POSITION" | "NORMAL" | "TANGENT" => Role::Read,
        "COLOR_0" if !of_target => Role::Read,
        _ if is_set && !of_target => Role::Read,
        _ if set_of("COLOR_") && !of_target => Role::Unread("COLOR_0 alone multiplies the base colour"),
        // Attributes of applications have no meaning of their own.
        _ if name.starts_with('_') => Role::Aside,
        _ if of_target => Role::Unread("it stays as it is without the target"),
        _ => Role::Unread(NO_EFFECT),
    }
}

#[cfg(test)]
mod tests;
