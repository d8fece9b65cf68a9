//! `[[material]]`

use glam::DVec3;

use crate::load::SceneError;
use crate::load::file::resolver::Resolver;
use crate::load::file::syntax::{
    AlphaKeys, Blend, BlendWeightEntry, CommonMaterial, ConductorMaterial, MaterialEntry, MetalEntry, MicrofacetEntry,
    RoughGlassMaterial,
};
use crate::load::file::value::{Colour, Located, Scalar};
use crate::scene::{
    BlendWeight, ColorInput, ConductorFresnel, Emission, Material, MaterialKind, MicrofacetDistribution, TextureId, TextureKind,
    check_blends,
};

/// Index of refraction where none is written: common glass.
const DEFAULT_IOR: f64 = 1.5;

impl Resolver<'_> {
    pub(super) fn materials(&mut self, written: &[MaterialEntry]) -> Result<(), SceneError> {
        self.material_names = self.register("material", written.iter().map(|entry| entry.common().name))?;
        for entry in written {
            let common = entry.common();
            let material = Material {
                name: common.name.value.clone(),
                kind: self.kind(entry)?,
                normal_map: common.normal_map.map(|name| self.normal_map(name)).transpose()?,
                emission: self.emission(entry, &common)?,
            };
            self.scene.materials.push(material);
        }
        for entry in written {
            if let MaterialEntry::Blend(blend) = entry {
                self.check_normal_maps(blend)?;
            }
        }
        // Materials stand in the order of their entries.
        check_blends(&self.scene.materials).map_err(|(id, message)| self.error(&written[id].common().name.span, message))
    }

    fn kind(&self, entry: &MaterialEntry) -> Result<MaterialKind, SceneError> {
        Ok(match entry {
            MaterialEntry::Diffuse(diffuse) => MaterialKind::Diffuse { reflectance: self.colour(&diffuse.reflectance)? },
            MaterialEntry::Mirror(mirror) => MaterialKind::Mirror { reflectance: self.colour_or_white(&mirror.reflectance)? },
            MaterialEntry::Glossy(glossy) => {
                MaterialKind::Glossy { reflectance: self.colour(&glossy.reflectance)?, exponent: self.scalar(&glossy.exponent)? }
            }
            MaterialEntry::Phong(phong) => {
                self.check_sum(&phong.diffuse, &phong.specular)?;
                MaterialKind::Phong {
                    diffuse: self.colour(&phong.diffuse)?,
                    specular: self.colour(&phong.specular.value)?,
                    exponent: self.scalar(&phong.exponent)?,
                }
            }
            MaterialEntry::Glass(glass) => MaterialKind::Glass {
                ior: glass.ior.map_or(DEFAULT_IOR, |ior| ior.0),
                reflectance: self.colour_or_white(&glass.reflectance)?,
                transmittance: self.colour_or_white(&glass.transmittance)?,
            },
            MaterialEntry::RoughGlass(glass) => self.rough_glass(glass)?,
            MaterialEntry::Conductor(conductor) => self.conductor(conductor)?,
            MaterialEntry::Emissive(_) => MaterialKind::Emissive,
            MaterialEntry::Blend(blend) => MaterialKind::Blend {
                materials: [self.material_id(&blend.materials[0])?, self.material_id(&blend.materials[1])?],
                weight: self.blend_weight(&blend.weight.value)?,
            },
            MaterialEntry::Pass(_) => MaterialKind::Pass,
        })
    }

    /// Diffuse plus specular above 1 would make energy.
    fn check_sum<R>(&self, diffuse: &Colour<R>, specular: &Located<Colour<R>>) -> Result<(), SceneError> {
        if let (Colour::Constant(diffuse), Colour::Constant(specular_colour)) = (diffuse, &specular.value) {
            let sum = diffuse.0 + specular_colour.0;
            if sum.max_element() > 1.0 + 1e-9 {
                let message = format!("diffuse + specular is at most 1 per channel, found {}", sum.max_element());
                return Err(self.error(&specular.span, message));
            }
        }
        Ok(())
    }

    fn rough_glass(&self, glass: &RoughGlassMaterial) -> Result<MaterialKind, SceneError> {
        let written = glass.distribution.as_ref().map(|name| name.value);
        let name_span = glass.distribution.as_ref().map(|name| &name.span);
        let (alpha, distribution) = match (&glass.exponent, written) {
            (Some(exponent), None | Some(MicrofacetEntry::Phong)) => {
                if let Some(other) = glass.alpha.as_ref().or(glass.roughness.as_ref()) {
                    return Err(self.error(&other.span, "either `exponent` or one of `alpha` and `roughness`"));
                }
                (self.scalar(&exponent.value)?, MicrofacetDistribution::Phong)
            }
            (Some(exponent), Some(MicrofacetEntry::Ggx)) => {
                return Err(self.error(&exponent.span, "`exponent` belongs to distribution = \"phong\""));
            }
            (None, Some(MicrofacetEntry::Phong)) => {
                let span = name_span.unwrap_or(&glass.name.span);
                return Err(self.error(span, "distribution = \"phong\" needs the key `exponent`"));
            }
            (None, None | Some(MicrofacetEntry::Ggx)) => {
                let keys = AlphaKeys { alpha: glass.alpha.as_ref(), roughness: glass.roughness.as_ref() };
                let Some(alpha) = self.alpha(keys)? else {
                    return Err(self.error(&glass.name.span, "rough_glass needs one of `alpha`, `roughness` and `exponent`"));
                };
                (alpha, MicrofacetDistribution::Ggx)
            }
        };
        Ok(MaterialKind::RoughGlass {
            ior: glass.ior.map_or(DEFAULT_IOR, |ior| ior.0),
            alpha,
            distribution,
            reflectance: self.colour_or_white(&glass.reflectance)?,
            transmittance: self.colour_or_white(&glass.transmittance)?,
        })
    }

    fn conductor(&self, written: &ConductorMaterial) -> Result<MaterialKind, SceneError> {
        let fresnel = match (&written.eta, &written.k, &written.preset, &written.reflectance) {
            (Some(eta), Some(k), None, None) => ConductorFresnel::Complex { eta: eta.value.0, k: k.value.0 },
            (None, None, Some(metal), None) => metal_fresnel(metal.value),
            (None, None, None, Some(reflectance)) => ConductorFresnel::Reflectance(self.colour(&reflectance.value)?),
            _ => {
                let message = "a conductor needs both `eta` and `k`, or `preset` alone, or `reflectance` alone";
                return Err(self.error(&written.name.span, message));
            }
        };
        let keys = AlphaKeys { alpha: written.alpha.as_ref(), roughness: written.roughness.as_ref() };
        let alpha = self.alpha(keys)?.unwrap_or(ColorInput::grey(0.0));
        Ok(MaterialKind::Conductor { fresnel, alpha })
    }

    /// The GGX width from whichever of the two keys is written.
    fn alpha(&self, keys: AlphaKeys<'_>) -> Result<Option<ColorInput>, SceneError> {
        match (keys.alpha, keys.roughness) {
            (Some(_), Some(roughness)) => Err(self.error(&roughness.span, "either `alpha` or `roughness`")),
            (Some(alpha), None) => self.scalar(&alpha.value).map(Some),
            (None, Some(roughness)) => match &roughness.value {
                Scalar::Constant(value) => Ok(Some(ColorInput::grey(value.0 * value.0))),
                Scalar::Texture(_) => Ok(Some(match self.scalar(&roughness.value)? {
                    ColorInput::Texture(texture) => ColorInput::SquaredTexture(texture),
                    other => other,
                })),
            },
            (None, None) => Ok(None),
        }
    }

    fn normal_map(&self, name: &Located<String>) -> Result<TextureId, SceneError> {
        let id = self.texture_id(name)?;
        if self.linear_textures[id] {
            return Ok(id);
        }
        let message = format!("a normal map holds directions, not colours: `{}` needs color_space = \"linear\"", name.value);
        Err(self.error(&name.span, message))
    }

    fn emission(&self, entry: &MaterialEntry, common: &CommonMaterial<'_>) -> Result<Option<Emission>, SceneError> {
        let (radiance, two_sided) = match (entry, common.emission) {
            (MaterialEntry::Emissive(_) | MaterialEntry::Pass(_), Some(emission)) => {
                let message = "`emission` is for materials that reflect; an emissive one has `radiance`, and pass emits nothing";
                return Err(self.error(&emission.span, message));
            }
            (MaterialEntry::Emissive(emissive), None) => (self.colour(&emissive.radiance)?, emissive.two_sided.unwrap_or(false)),
            (_, Some(emission)) => {
                (self.colour(&emission.value)?, common.emission_two_sided.is_some_and(|two_sided| two_sided.value))
            }
            (_, None) => {
                return match common.emission_two_sided {
                    Some(written) => Err(self.error(&written.span, "`emission_two_sided` needs the key `emission`")),
                    None => Ok(None),
                };
            }
        };
        let dark = matches!(radiance, ColorInput::Constant(radiance) if radiance.max_element() == 0.0);
        Ok((!dark).then_some(Emission { radiance, two_sided }))
    }

    fn blend_weight(&self, written: &BlendWeightEntry) -> Result<BlendWeight, SceneError> {
        Ok(match written {
            BlendWeightEntry::Constant(constant) => BlendWeight::Constant { value: constant.value.0 },
            BlendWeightEntry::Facing(facing) => BlendWeight::Facing { power: facing.power.map_or(1.0, |power| power.0) },
            BlendWeightEntry::Fresnel(fresnel) => {
                BlendWeight::Fresnel { ior: fresnel.ior.map_or(DEFAULT_IOR, |ior| ior.0), exact: fresnel.exact }
            }
            BlendWeightEntry::Texture(texture) => BlendWeight::Texture { texture: self.weight_texture(&texture.texture)? },
            BlendWeightEntry::Reverse(reverse) => BlendWeight::Reverse { of: Box::new(self.blend_weight(&reverse.of)?) },
            BlendWeightEntry::Threshold(threshold) => {
                BlendWeight::Threshold { tau: threshold.tau.0, of: Box::new(self.blend_weight(&threshold.of)?) }
            }
        })
    }

    /// A weight is the luminance of a texture's colours: an alpha channel beside them would have no effect.
    fn weight_texture(&self, name: &Located<String>) -> Result<TextureId, SceneError> {
        let id = self.texture_id(name)?;
        if let TextureKind::Image(image) = &self.scene.textures[id].kind
            && image.image.has_alpha
        {
            let message = format!("the weight is the luminance of `{}`, whose alpha channel would have no effect", name.value);
            return Err(self.error(&name.span, message).with_help("save the image without alpha, as the mask itself"));
        }
        Ok(id)
    }

    /// The parts of a blend lie on one surface: its normals are the blend's own.
    fn check_normal_maps(&self, blend: &Blend) -> Result<(), SceneError> {
        for part in &blend.materials {
            if self.scene.materials[self.material_id(part)?].normal_map.is_some() {
                let message = format!("`{}` has a normal map and is part of a blend", part.value);
                return Err(self.error(&part.span, message).with_help("give the normal map to the blend"));
            }
        }
        Ok(())
    }
}

/// Complex indices of refraction in linear Rec.709, averages of the measured spectra that renderers commonly share.
fn metal_fresnel(metal: MetalEntry) -> ConductorFresnel {
    let (eta, k) = match metal {
        MetalEntry::Gold => ([0.143119, 0.374957, 1.44248], [3.98316, 2.38572, 1.60322]),
        MetalEntry::Copper => ([0.200438, 0.924033, 1.10221], [3.91295, 2.45285, 2.14219]),
        MetalEntry::Silver => ([0.155265, 0.116723, 0.138344], [4.82835, 3.12225, 2.14696]),
        MetalEntry::Aluminium => ([1.65746, 0.880369, 0.521229], [9.22387, 6.26952, 4.837]),
    };
    ConductorFresnel::Complex { eta: DVec3::from_array(eta), k: DVec3::from_array(k) }
}
