//! Materials as the device reads them. A blend becomes a run of parts, each with the weights along its branch: data, whatever the
//! depth of the tree.

use std::collections::hash_map::Entry;
use std::collections::{BTreeSet, HashMap};

use super::blend_parts::{BlendPart, BlendParts, MOST_WEIGHTS, lambert_of_the_mean, parts};
use super::blend_weight::{PackedBlendWeight, constant_weight};
use super::constants::NONE;
use super::error::PackError;
use super::layers::{LAYERS_STRAIGHT, LayerRun, PackedLayer, with_interfaces};
use super::medium::PackedMedia;
use super::texture::{color_and_texture, mention};
use crate::scene::material::{self, AlbedoTable};
use crate::scene::{
    BlendMode, Channel, ChannelInput, ColorInput, LayerStack, LobeKind, Masking, Material, MaterialId, MaterialKind, Media, Scene,
};
use crate::shader::shared::{Constant, Constants, shared_constants};
use crate::spectrum::Spectrum;

/// Above a packed material's kind stands its lobe's form.
pub(super) const FORM_SHIFT: u32 = 8;

shared_constants!(flags {
    /// A packed material's kind is its lobe's number; this where it has no lobe, and the next where it is a blend.
    pub const NO_LOBE: u32 = LobeKind::ALL.len() as u32;
    pub const BLEND: u32 = NO_LOBE + 1;
    /// A stack of layers.
    pub const LAYERED: u32 = NO_LOBE + 2;
    /// Words of a material in the tables.
    pub const MATERIAL_WORDS: u32 = (size_of::<PackedMaterial>() / 16) as u32;
    /// Flag beside the kind of a conductor: its colours are eta and k.
    pub(super) const COMPLEX_FRESNEL: u32 = material::COMPLEX_FRESNEL << FORM_SHIFT;
    /// Flags beside the kinds of other lobes.
    const BECKMANN_FACETS: u32 = material::BECKMANN << FORM_SHIFT;
    const SEPARABLE_MASKS: u32 = material::SEPARABLE_MASKING << FORM_SHIFT;
    const NONLINEAR_BASE: u32 = material::NONLINEAR << FORM_SHIFT;
    const ACROSS_IS_SQUARED: u32 = material::SQUARED_ACROSS << FORM_SHIFT;
    const ANISOTROPIC: u32 = material::ANISOTROPIC << FORM_SHIFT;
    const THIN_WALL: u32 = material::THIN_WALL << FORM_SHIFT;
    const COMPENSATED: u32 = material::COMPENSATED << FORM_SHIFT;
    const DIFFUSE_TRANSMITS: u32 = material::DIFFUSE_TRANSMITS << FORM_SHIFT;
    const UNTINTED: u32 = material::UNTINTED << FORM_SHIFT;
    const DISPERSED: u32 = material::DISPERSED << FORM_SHIFT;
    const THIN_FILM: u32 = material::THIN_FILM << FORM_SHIFT;
    /// Reflections within a thin film that are added up, and the smallest part of light that counts.
    const MOST_FILM_ORDERS: u32 = material::thin_film::MOST_ORDERS;
    const LEAST_FILM_ORDER: f32 = material::thin_film::LEAST_ORDER as f32;
    /// A base of a film that reflects more along the normal counts as one that reflects this.
    const MOST_REFLECTED_BY_BASE: f32 = material::thin_film::MOST_REFLECTED_BY_BASE as f32;
    const DIRECTED: u32 = material::DIRECTED << FORM_SHIFT;
    const COAT_NORMAL_MAP: u32 = material::COAT_NORMAL_MAP << FORM_SHIFT;
    /// Rows of a table of albedos, by roughness, and its columns, by cosine.
    const ALBEDO_ROWS: u32 = material::ALBEDO_ROWS as u32;
    const ALBEDO_COLUMNS: u32 = material::ALBEDO_COLUMNS as u32;
    const FACET_KNEE: f32 = material::FACET_KNEE as f32;
    const SHEEN_KNEE: f32 = material::SHEEN_KNEE as f32;
    const SMALLEST_SHEEN_ROUGHNESS: f32 = material::SMALLEST_SHEEN_ROUGHNESS as f32;
    /// The place of the texels of a coat's normals among the further parameters of its material.
    const COAT_TEXEL_PARAMETER: u32 = material::COAT_TEXEL_PARAMETER as u32;
    /// Nearer to 1 an index of refraction bends no light.
    const SMALLEST_BEND: f32 = material::SMALLEST_BEND as f32;
    /// Angles in the table of what a rough plastic's surface lets through.
    const TRANSMITTANCE_NODES: u32 = material::TRANSMITTANCE_NODES as u32;
    pub(super) const EMITS: u32 = 1;
    pub(super) const EMITS_TWO_SIDED: u32 = 2;
    /// Some part of the blend emits.
    pub(super) const PARTS_EMIT: u32 = 4;
    /// The material, or some part of the blend, is a null surface.
    pub(super) const LETS_THROUGH: u32 = 8;
    /// The back scatters nothing.
    pub(super) const FRONT_ONLY: u32 = 16;
    /// Some rays go straight on through the surface, into its medium or out of it.
    pub(super) const OPEN_BOUNDARY: u32 = 32;
    /// Above these flags stands the number of the medium that surfaces of the material enclose; 0: they bound none.
    pub(super) const MEDIUM_SHIFT: u32 = 16;
    /// Flag beside the number of a part's factors: its back scatters nothing.
    pub(super) const PART_FRONT_ONLY: u32 = 1 << 31;
    /// Above the first of a material's further parameters stands how many are looked up.
    pub(super) const FURTHER_SHIFT: u32 = 24;
    /// GGX narrower than this is a delta lobe: f32 no longer resolves it.
    const DELTA_ALPHA: f32 = material::DELTA_ALPHA as f32;
});

/// Kinds, flags and sizes, for WGSL.
pub fn constants() -> Constants {
    let lobes = LobeKind::ALL.iter().map(|&lobe| (lobe.switch(), Constant::U32(lobe as u32)));
    lobes.chain(flags()).collect()
}

/// 80 bytes, five vec4 of the tables.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct PackedMaterial {
    /// [`LobeParameters::color0`](crate::scene::LobeParameters).
    pub color0: [f32; 3],
    /// The kind in eight bits, above them the lobe's form.
    pub kind_and_form: u32,
    /// [`LobeParameters::color1`](crate::scene::LobeParameters). Of a blend, as bits: its first part, their number, and the number of inner
    /// blends behind them that emit by themselves. Of a stack: its first layer, and their number with its flags.
    pub color1: [f32; 3],
    /// A stack has its largest breadth here.
    pub ior: f32,
    pub emission: [f32; 3],
    /// Flags of the two sides: which emit, and which scatter nothing.
    pub emission_flags: u32,
    pub color0_texture: u32,
    pub emission_texture: u32,
    pub color1_texture: u32,
    pub roughness_texture: u32,
    /// GGX width or cosine exponent.
    pub roughness: f32,
    pub normal_map: u32,
    /// 1 where the roughness comes from a texture and the square of both together is the GGX width.
    pub roughness_is_squared: u32,
    /// The first of its further parameters, and in the upper eight bits how many of them are looked up at a hit; 0: it has none.
    pub further: u32,
}

/// A further parameter of a lobe, 16 bytes.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct PackedParameter {
    /// A scalar is the first.
    pub color: [f32; 3],
    /// Index of the texture that it is multiplied by, or NONE.
    pub texture: u32,
}

/// One part of a blend, 16 bytes.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct PackedBlendPart {
    pub material: u32,
    /// Its weight is the constant factor times the blend weights `first_factor..first_factor + factor_count`.
    pub first_factor: u32,
    /// And `PART_FRONT_ONLY`.
    pub factor_count: u32,
    pub constant_factor: f32,
}

/// Entries that a table of albedos takes.
const ALBEDO_ENTRIES: usize = (material::ALBEDO_ROWS * material::ALBEDO_COLUMNS).div_ceil(3);

/// The first entries of tables of albedos among further parameters; None: no material looks it up.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct AlbedoPlaces {
    /// Microfacets with separable masking.
    pub separable: Option<usize>,
    /// Microfacets with height-correlated masking.
    pub height_correlated: Option<usize>,
    pub sheen: Option<usize>,
}

impl AlbedoPlaces {
    /// True where the tables that a material looks up are there, within so many entries.
    pub(super) fn serve(&self, material: &PackedMaterial, length: usize) -> bool {
        let is_there = |place: Option<usize>| place.is_some_and(|first| first + ALBEDO_ENTRIES <= length);
        let facets = if material.has_form(material::SEPARABLE_MASKING) { self.separable } else { self.height_correlated };
        let serves = |form: u32, place: Option<usize>| !material.has_form(form) || is_there(place);
        serves(material::COMPENSATED, facets) && serves(material::SHEEN, self.sheen)
    }
}

/// The materials that a scene's surfaces are made of. Others that the scene names are left out: kernels have the code of what stands here.
#[derive(Debug, Clone, Default)]
pub struct PackedMaterials {
    pub materials: Vec<PackedMaterial>,
    /// Which of the scene's materials each one is.
    pub scene_ids: Vec<MaterialId>,
    /// Parameters of lobes beyond those that most lobes have, in runs.
    pub further: Vec<PackedParameter>,
    /// Indices of the albedo tables among the further parameters.
    pub albedos: AlbedoPlaces,
    /// The media that surfaces enclose, and the one around the camera.
    pub media: PackedMedia,
    pub parts: Vec<PackedBlendPart>,
    /// The layers of all stacks.
    pub layers: Vec<PackedLayer>,
    pub weights: Vec<PackedBlendWeight>,
}

/// A scalar as a constant factor, a texture index or NONE, and 1 where what they give together is squared.
fn scalar_and_texture(input: &ColorInput) -> (f32, u32, u32) {
    let ([factor, ..], texture) = color_and_texture(input);
    match input {
        ColorInput::SquaredTexture(_) => (factor, texture, 1),
        // A scalar is the first channel of a colour anyway.
        ColorInput::Channel(input @ ChannelInput { channel: Channel::R, .. }) => {
            (factor, mention(input.texture, None), u32::from(input.is_squared))
        }
        ColorInput::Channel(input) => (factor, texture, u32::from(input.is_squared)),
        _ => (factor, texture, 0),
    }
}

/// A table among further parameters, three numbers an entry.
fn table_entries(table: &[f32]) -> impl Iterator<Item = PackedParameter> {
    table.chunks(3).map(|numbers| {
        let at = |place: usize| numbers.get(place).copied().unwrap_or(0.0);
        PackedParameter { color: [at(0), at(1), at(2)], texture: NONE }
    })
}

impl PackedMaterials {
    /// Packs the materials that surfaces have, in the scene's order, and behind them those that only their blends are made of. Textures
    /// keep the scene's numbers until they are packed.
    ///
    /// # Errors
    /// [`PackError::TooManyWeights`] where the branches of nested blends have more weights than can be kept.
    pub fn new(scene: &Scene, of_surfaces: &BTreeSet<MaterialId>) -> Result<Self, PackError> {
        let mut packed = Self::default();
        let media = Media::of(scene);
        packed.media = PackedMedia::new(&media, &scene.light_groups, of_surfaces)?;
        let has_media = !packed.media.is_empty();
        for id in with_interfaces(scene, of_surfaces.iter().copied()) {
            let mut material = match &scene.materials[id].kind {
                MaterialKind::Blend { .. } => packed.blend(scene, id)?,
                MaterialKind::Layered(layers) => packed.layered(scene, (id, layers))?,
                _ => packed.plain(scene, id),
            };
            material.emission_flags |= if has_media { (media.behind(id) as u32) << MEDIUM_SHIFT } else { 0 };
            material.emission_flags |= if has_media && media.is_open(id) { OPEN_BOUNDARY } else { 0 };
            packed.materials.push(material);
            packed.scene_ids.push(id);
        }
        packed.add_parts(scene);
        packed.add_albedos();
        Ok(packed)
    }

    /// Adds the tables of albedos that some material looks up.
    fn add_albedos(&mut self) {
        let has = |form: u32, masks: u32| {
            let wanted = |material: &&PackedMaterial| material.has_form(form);
            let masked = |material: &PackedMaterial| material.has_form(material::SEPARABLE_MASKING) == (masks != 0);
            self.materials.iter().filter(wanted).any(masked)
        };
        let compensated = |masks: u32| has(material::COMPENSATED, masks);
        let separable = compensated(material::SEPARABLE_MASKING).then(|| AlbedoTable::of_facets(Masking::Separable));
        let height_correlated = compensated(0).then(|| AlbedoTable::of_facets(Masking::HeightCorrelated));
        let sheen = self.materials.iter().any(|material| material.has_form(material::SHEEN)).then(AlbedoTable::of_sheen);
        let [separable, height_correlated, sheen] = [separable, height_correlated, sheen].map(|table| {
            let first = self.further.len();
            let shares: Vec<f32> = table?.shares().collect();
            self.further.extend(table_entries(&shares));
            Some(first)
        });
        self.albedos = AlbedoPlaces { separable, height_correlated, sheen };
    }

    /// Adds the parts of blends that no surface is made of alone; blends then name their places instead of the scene's numbers.
    fn add_parts(&mut self, scene: &Scene) {
        let mut places: HashMap<MaterialId, usize> = self.scene_ids.iter().enumerate().map(|(place, id)| (*id, place)).collect();
        let mut parts = std::mem::take(&mut self.parts);
        for part in &mut parts {
            let id = part.material as MaterialId;
            let place = match places.entry(id) {
                Entry::Occupied(place) => *place.get(),
                Entry::Vacant(vacant) => {
                    let material = self.plain(scene, id);
                    self.materials.push(material);
                    self.scene_ids.push(id);
                    *vacant.insert(self.materials.len() - 1)
                }
            };
            part.material = place as u32;
        }
        self.parts = parts;
        for layer in &mut self.layers {
            // Interfaces are packed with what surfaces are made of.
            layer.interface = places.get(&(layer.interface as MaterialId)).map_or(NONE, |&place| place as u32);
        }
    }

    fn layered(&mut self, scene: &Scene, stack: (MaterialId, &LayerStack)) -> Result<PackedMaterial, PackError> {
        let mut packed = PackedMaterial::of(scene, stack.0);
        let run = LayerRun::new(scene, stack, &mut self.layers, &mut self.media)?;
        packed.kind_and_form = LAYERED;
        packed.color1 = [run.first, run.count_and_flags, 0].map(f32::from_bits);
        packed.ior = run.most_breadth;
        Ok(packed)
    }

    /// Packs a material that is no blend, or what a blend is besides its parts.
    fn plain(&mut self, scene: &Scene, id: MaterialId) -> PackedMaterial {
        let material = &scene.materials[id];
        let mut packed = PackedMaterial::of(scene, id);
        if let Some(lobe) = material.kind.lobe().filter(|lobe| !lobe.further.is_empty()) {
            packed.further = self.further.len() as u32 | (lobe.further.len() as u32) << FURTHER_SHIFT;
            self.further.extend(lobe.further.iter().map(|input| {
                let (color, texture) = color_and_texture(input);
                PackedParameter { color, texture }
            }));
            self.further.extend(table_entries(&lobe.table));
        }
        packed
    }

    /// Some null surface bounds a medium.
    pub fn has_open_boundaries(&self) -> bool {
        self.materials.iter().any(|material| material.emission_flags & OPEN_BOUNDARY != 0)
    }

    /// Index of each of the scene's materials; [`NONE`] where it is left out.
    pub fn places(&self, scene: &Scene) -> Vec<u32> {
        let mut places = vec![NONE; scene.materials.len()];
        for (place, &id) in self.scene_ids.iter().enumerate() {
            places[id] = place as u32;
        }
        places
    }

    /// Every mention of a texture, to be renumbered.
    pub(super) fn textures_mut(&mut self) -> impl Iterator<Item = &mut u32> {
        let of_weights = self.weights.iter_mut().filter(|weight| weight.looks_up()).map(|weight| &mut weight.texture);
        let of_further = self.further.iter_mut().map(|parameter| &mut parameter.texture);
        let of_layers = self.layers.iter_mut().map(PackedLayer::texture_mut);
        self.materials
            .iter_mut()
            .flat_map(PackedMaterial::textures_mut)
            .chain(of_weights)
            .chain(of_further)
            .chain(of_layers)
            .filter(|texture| **texture != NONE)
    }

    fn blend(&mut self, scene: &Scene, id: MaterialId) -> Result<PackedMaterial, PackError> {
        let BlendParts { plain, emitting_blends } = parts(scene, id)?;
        let mut packed = PackedMaterial::of(scene, id);
        // A blend that always is one of its materials is that material.
        if let [BlendPart { material, constant: 1.0, factors, front_only }] = plain.as_slice()
            && factors.is_empty()
            && *front_only != scene.materials[*material].two_sided
            && emitting_blends.is_empty()
            && packed.emission_flags == 0
            && packed.normal_map == NONE
        {
            return Ok(self.plain(scene, *material));
        }
        if scene.render.blend == BlendMode::Mixture
            && emitting_blends.is_empty()
            && let Some(reflectance) = lambert_of_the_mean(scene, &plain)
        {
            packed.kind_and_form = LobeKind::Diffuse as u32;
            packed.color0 = reflectance.to_f32();
            return Ok(packed);
        }
        if !emitting_blends.is_empty() || plain.iter().any(|part| scene.materials[part.material].emission.is_some()) {
            packed.emission_flags |= PARTS_EMIT;
        }
        if plain.iter().any(|part| matches!(scene.materials[part.material].kind, MaterialKind::Pass)) {
            packed.emission_flags |= LETS_THROUGH;
        }
        packed.color1 = [self.parts.len(), plain.len(), emitting_blends.len()].map(|number| f32::from_bits(number as u32));
        for part in plain.into_iter().chain(emitting_blends) {
            self.parts.push(PackedBlendPart {
                material: part.material as u32,
                first_factor: self.weights.len() as u32,
                factor_count: part.factors.len() as u32 | if part.front_only { PART_FRONT_ONLY } else { 0 },
                constant_factor: part.constant as f32,
            });
            self.weights.extend(part.factors);
        }
        if self.weights.len() > MOST_WEIGHTS {
            return Err(PackError::TooManyWeights { material: scene.materials[id].name.clone(), limit: MOST_WEIGHTS });
        }
        Ok(packed)
    }

    /// Some weight of a blend depends on the angle from which a surface is seen.
    pub fn has_weights_by_angle(&self) -> bool {
        self.weights.iter().any(PackedBlendWeight::is_by_angle)
    }

    /// Some weight of a blend depends on the side from which a surface is seen.
    pub fn has_weights_by_side(&self) -> bool {
        self.weights.iter().any(PackedBlendWeight::is_by_side)
    }

    /// Some weight of a blend is another for the camera.
    pub fn has_weights_by_viewer(&self) -> bool {
        self.weights.iter().any(PackedBlendWeight::is_by_viewer)
    }

    /// Some weight of a blend depends on the direction of the surface's normal.
    pub fn has_weights_by_direction(&self) -> bool {
        self.weights.iter().any(PackedBlendWeight::is_by_direction)
    }

    /// Some part of a blend is black from behind.
    pub fn has_front_only_parts(&self) -> bool {
        self.parts.iter().any(|part| part.factor_count & PART_FRONT_ONLY != 0)
    }

    /// Some material is of this kind.
    pub fn has(&self, kind: u32) -> bool {
        self.materials.iter().any(|material| material.kind() == kind)
    }
}

impl PackedMaterial {
    /// Packs a material; of a blend, what it is besides its parts. Emission that is not to be seen is black, and an emission all the same: paths and
    /// weights are those of the picture.
    fn of(scene: &Scene, id: MaterialId) -> Self {
        let packed = Self::new(&scene.materials[id]);
        let is_seen = scene.light_groups.shows(scene.light_groups.of_material(id));
        if is_seen { packed } else { Self { emission: [0.0; 3], ..packed } }
    }

    fn new(material: &Material) -> Self {
        let without_lobe = if material.is_blend() { BLEND } else { NO_LOBE };
        let lobe = material.kind.lobe();
        let lobe = lobe.as_ref();
        let kind = lobe.map_or(without_lobe, |parameters| parameters.lobe as u32);
        let black = ColorInput::grey(0.0);
        let (color0, color0_texture) = color_and_texture(&lobe.map_or(black, |lobe| lobe.color0));
        let (color1, color1_texture) = color_and_texture(&lobe.and_then(|lobe| lobe.color1).unwrap_or(black));
        let roughness = lobe.and_then(|lobe| lobe.roughness).unwrap_or(black);
        let (roughness, roughness_texture, roughness_is_squared) = scalar_and_texture(&roughness);
        let radiance = material.emission.map_or(black, |emission| emission.radiance);
        let two_sided = material.emission.is_some_and(|emission| emission.two_sided);
        let (emission, emission_texture) = color_and_texture(&radiance);
        Self {
            color0,
            kind_and_form: kind | lobe.map_or(0, |lobe| lobe.form) << FORM_SHIFT,
            color1,
            ior: lobe.and_then(|lobe| lobe.ior).unwrap_or(1.0) as f32,
            emission,
            emission_flags: if radiance == black { 0 } else { EMITS }
                | if two_sided { EMITS_TWO_SIDED } else { 0 }
                | if kind == LobeKind::Null as u32 { LETS_THROUGH } else { 0 }
                | if material.two_sided { 0 } else { FRONT_ONLY },
            color0_texture,
            emission_texture,
            color1_texture,
            roughness_texture,
            roughness,
            normal_map: material.normal_map.map_or(NONE, |texture| texture as u32),
            roughness_is_squared,
            further: 0,
        }
    }

    fn textures_mut(&mut self) -> [&mut u32; 5] {
        let Self { color0_texture, emission_texture, color1_texture, roughness_texture, normal_map, .. } = self;
        [color0_texture, emission_texture, color1_texture, roughness_texture, normal_map]
    }

    pub fn kind(&self) -> u32 {
        self.kind_and_form & ((1 << FORM_SHIFT) - 1)
    }

    /// Some light may go straight through it.
    pub fn lets_through(&self) -> bool {
        self.emission_flags & LETS_THROUGH != 0
    }

    /// True where the material, or some part of it, emits.
    pub fn emits(&self) -> bool {
        self.emission_flags & (EMITS | PARTS_EMIT) != 0
    }

    /// Its lobe reads other numbers than those it has where none are loaded.
    pub fn uses_color1(&self) -> bool {
        ![BLEND, LAYERED].contains(&self.kind()) && (self.color1 != [0.0; 3] || self.color1_texture != NONE || self.ior != 1.0)
    }

    /// How many of its further parameters a hit looks up.
    pub fn looked_up(&self) -> u32 {
        self.further >> FURTHER_SHIFT
    }

    /// The number of the medium that its surfaces enclose; 0: they bound none.
    pub fn medium(&self) -> u32 {
        self.emission_flags >> MEDIUM_SHIFT
    }

    /// One of the forms of its lobe, by its bit in [`LobeParameters::form`](crate::scene::LobeParameters).
    pub fn has_form(&self, form: u32) -> bool {
        self.kind_and_form >> FORM_SHIFT & form != 0
    }

    /// Says of a stack that light goes straight down and up in it, or not.
    pub fn is_straight_stack(&self) -> Option<bool> {
        (self.kind() == LAYERED).then(|| self.color1[1].to_bits() & LAYERS_STRAIGHT != 0)
    }

    /// Its back scatters nothing.
    pub fn is_front_only(&self) -> bool {
        self.emission_flags & FRONT_ONLY != 0
    }

    /// True where the roughness is used.
    pub fn uses_roughness(&self) -> bool {
        self.roughness != 0.0 || self.roughness_texture != NONE
    }
}

/// Emission of a material on its own, each part with the share of it that a light's power counts: the weight
/// of a constant weight, one half of any other's.
pub fn mean_emission(scene: &Scene, id: MaterialId, mean: &dyn Fn(&ColorInput) -> Spectrum) -> Spectrum {
    let mut sum = Spectrum::BLACK;
    let mut to_visit = vec![(id, 1.0)];
    while let Some((id, share)) = to_visit.pop() {
        let material = &scene.materials[id];
        if let Some(emission) = material.emission {
            sum += share * mean(&emission.radiance);
        }
        if let MaterialKind::Blend { materials: [first, second], weight } = &material.kind {
            let w0 = constant_weight(weight).unwrap_or(0.5);
            to_visit.extend([(*second, share * (1.0 - w0)), (*first, share * w0)].into_iter().filter(|(_, share)| *share > 0.0));
        }
    }
    sum
}
