//! The JSON of a glTF file, as far as it is read. Names are those of the specification.

use serde::Deserialize;
use serde_json::{Map, Value};

/// Extensions of an object.
pub type Extensions = Map<String, Value>;

macro_rules! objects {
    ($($(#[$doc:meta])* $name:ident { $($field:ident: $type:ty,)* })*) => {$(
        $(#[$doc])*
        #[derive(Debug, Clone, Default, Deserialize)]
        #[serde(default, rename_all = "camelCase")]
        pub struct $name { $(pub $field: $type,)* }
    )*};
}

objects! {
    Root {
        asset: Asset,
        scene: Option<usize>,
        scenes: Vec<Scene>,
        nodes: Vec<Node>,
        meshes: Vec<Mesh>,
        accessors: Vec<Accessor>,
        buffer_views: Vec<BufferView>,
        buffers: Vec<Buffer>,
        materials: Vec<Material>,
        textures: Vec<Texture>,
        images: Vec<Image>,
        samplers: Vec<Sampler>,
        cameras: Vec<Camera>,
        skins: Vec<Skin>,
        animations: Vec<Value>,
        extensions_used: Vec<String>,
        extensions_required: Vec<String>,
        extensions: Extensions,
    }
    /// Versions are text, and were numbers in drafts.
    Asset { version: Option<Value>, min_version: Option<Value>, }
    Scene { nodes: Vec<usize>, extensions: Extensions, }
    Node {
        name: Option<String>,
        children: Vec<usize>,
        mesh: Option<usize>,
        skin: Option<usize>,
        camera: Option<usize>,
        matrix: Option<[f64; 16]>,
        translation: Option<[f64; 3]>,
        rotation: Option<[f64; 4]>,
        scale: Option<[f64; 3]>,
        weights: Option<Vec<f64>>,
        extensions: Extensions,
    }
    Mesh { name: Option<String>, primitives: Vec<Primitive>, weights: Vec<f64>, }
    Primitive {
        attributes: Map<String, Value>,
        indices: Option<usize>,
        material: Option<usize>,
        mode: Option<u64>,
        targets: Vec<Map<String, Value>>,
        extensions: Extensions,
    }
    Accessor {
        buffer_view: Option<usize>,
        byte_offset: u64,
        component_type: u64,
        normalized: bool,
        count: u64,
        r#type: String,
        sparse: Option<Sparse>,
    }
    Sparse { count: u64, indices: SparseIndices, values: SparseValues, }
    SparseIndices { buffer_view: usize, byte_offset: u64, component_type: u64, }
    SparseValues { buffer_view: usize, byte_offset: u64, }
    BufferView { buffer: usize, byte_offset: u64, byte_length: u64, byte_stride: Option<u64>, extensions: Extensions, }
    Buffer { uri: Option<String>, byte_length: u64, extensions: Extensions, }
    Material {
        name: Option<String>,
        pbr_metallic_roughness: Pbr,
        normal_texture: Option<TextureInfo>,
        occlusion_texture: Option<TextureInfo>,
        emissive_texture: Option<TextureInfo>,
        emissive_factor: [f64; 3],
        alpha_mode: Option<String>,
        alpha_cutoff: Option<f64>,
        double_sided: bool,
        extensions: Extensions,
    }
    Pbr {
        base_color_factor: Option<[f64; 4]>,
        base_color_texture: Option<TextureInfo>,
        metallic_factor: Option<f64>,
        roughness_factor: Option<f64>,
        metallic_roughness_texture: Option<TextureInfo>,
    }
    TextureInfo { index: usize, tex_coord: u64, scale: Option<f64>, strength: Option<f64>, extensions: Extensions, }
    Texture { sampler: Option<usize>, source: Option<usize>, extensions: Extensions, }
    Image { name: Option<String>, uri: Option<String>, mime_type: Option<String>, buffer_view: Option<usize>, }
    Sampler { mag_filter: Option<u64>, min_filter: Option<u64>, wrap_s: Option<u64>, wrap_t: Option<u64>, }
    Camera { name: Option<String>, perspective: Option<Perspective>, orthographic: Option<Orthographic>, }
    Perspective { yfov: f64, aspect_ratio: Option<f64>, znear: Option<f64>, zfar: Option<f64>, }
    Orthographic { xmag: f64, ymag: f64, znear: Option<f64>, zfar: Option<f64>, }
    Animation { channels: Vec<Channel>, samplers: Vec<AnimationSampler>, }
    Channel { sampler: usize, target: Target, }
    Target { node: Option<usize>, path: String, }
    AnimationSampler { input: usize, output: usize, interpolation: Option<String>, }
    Skin { joints: Vec<usize>, inverse_bind_matrices: Option<usize>, }
    /// KHR_lights_punctual
    Light {
        name: Option<String>,
        r#type: String,
        color: Option<[f64; 3]>,
        intensity: Option<f64>,
        range: Option<f64>,
        spot: Option<Cone>,
    }
    Cone { inner_cone_angle: Option<f64>, outer_cone_angle: Option<f64>, }
    /// KHR_texture_transform
    TextureTransform { offset: [f64; 2], rotation: f64, scale: Option<[f64; 2]>, tex_coord: Option<u64>, }
    /// EXT_meshopt_compression
    Packed {
        buffer: usize,
        byte_offset: u64,
        byte_length: u64,
        byte_stride: u64,
        count: u64,
        mode: String,
        filter: Option<String>,
    }
    /// KHR_materials_pbrSpecularGlossiness
    SpecularGlossiness {
        diffuse_factor: Option<[f64; 4]>,
        diffuse_texture: Option<TextureInfo>,
        specular_factor: Option<[f64; 3]>,
        glossiness_factor: Option<f64>,
        specular_glossiness_texture: Option<TextureInfo>,
    }
    /// EXT_mesh_gpu_instancing
    Instances { attributes: Map<String, Value>, }
}

/// An extension's object; None where it is not there.
pub fn extension<T: Default + for<'de> Deserialize<'de>>(extensions: &Extensions, name: &str) -> Result<Option<T>, String> {
    let Some(value) = extensions.get(name) else { return Ok(None) };
    T::deserialize(value).map(Some).map_err(|error| format!("{name}: {error}"))
}

/// Whole numbers as such where they are written as fractions, and nothing where `null` is written.
pub fn tightened(value: Value) -> Value {
    match value {
        Value::Number(number) => {
            let whole = number.as_f64().filter(|number| !number.is_sign_negative() && number.fract() == 0.0 && *number < 9e15);
            whole.filter(|_| number.is_f64()).map_or(Value::Number(number), |whole| Value::from(whole as u64))
        }
        Value::Array(values) => values.into_iter().map(tightened).collect(),
        Value::Object(entries) => {
            let written = entries.into_iter().filter(|(_, value)| !value.is_null());
            Value::Object(written.map(|(key, value)| (key, tightened(value))).collect())
        }
        other => other,
    }
}
