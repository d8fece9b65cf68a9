//! Which texture coordinates the textures of a material are looked up by (`KHR_texture_transform`).
//!
//! A mesh has two sets at most: the first is that of the normal map, or of the first texture, and the second that of the first texture which has
//! another. Where all textures of the first set lie alike, their transform is applied to it. Else textures have placements of their own, and
//! the mesh's coordinates are as they are written, unless the normal map is turned or mirrored: directions of a normal map follow the mesh's, so
//! they are those of the normal map then.

use glam::{DAffine2, DMat2, DVec2};

use super::json::{Material, SpecularGlossiness, TextureInfo, TextureTransform, extension};
use super::made::Coordinates;

/// Textures of extensions that materials are made of.
const OF_EXTENSIONS: [(&str, &[&str]); 7] = [
    ("KHR_materials_specular", &["specularTexture", "specularColorTexture"]),
    ("KHR_materials_transmission", &["transmissionTexture"]),
    ("KHR_materials_diffuse_transmission", &["diffuseTransmissionTexture", "diffuseTransmissionColorTexture"]),
    ("KHR_materials_iridescence", &["iridescenceTexture", "iridescenceThicknessTexture"]),
    ("KHR_materials_clearcoat", &["clearcoatTexture", "clearcoatRoughnessTexture", "clearcoatNormalTexture"]),
    ("KHR_materials_anisotropy", &["anisotropyTexture"]),
    ("KHR_materials_sheen", &["sheenColorTexture", "sheenRoughnessTexture"]),
];

/// How one texture is looked up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lookup {
    pub set: u64,
    scale: DVec2,
    /// Radians, counter-clockwise where v runs upward.
    rotation: f64,
    /// Offset for v that runs downward.
    offset: DVec2,
}

/// Properties that the lookups of a material share.
#[derive(Debug, Clone, Copy)]
pub struct Lookups {
    /// Texture coordinates of the mesh.
    pub coordinates: Coordinates,
}

/// How a texture lies on the mesh's coordinates, as scene files have it: v runs upward.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placement {
    pub scale: [f64; 2],
    pub rotation_degrees: f64,
    pub offset: [f64; 2],
}

impl Lookup {
    pub fn of(info: &TextureInfo) -> Result<Self, String> {
        let transform = extension::<TextureTransform>(&info.extensions, "KHR_texture_transform")?.unwrap_or_default();
        Ok(Self {
            set: transform.tex_coord.unwrap_or(info.tex_coord),
            scale: DVec2::from(transform.scale.unwrap_or([1.0; 2])),
            rotation: transform.rotation,
            offset: DVec2::from(transform.offset),
        })
    }

    /// From the written coordinates to those of the texture, where v runs downward.
    fn map(&self) -> DAffine2 {
        // The specification turns counter-clockwise in a space whose v runs downward.
        let turn = DMat2::from_angle(-self.rotation);
        DAffine2 { matrix2: turn * DMat2::from_diagonal(self.scale), translation: self.offset }
    }

    /// The placement on coordinates that `map` has changed; the inner None where it lies as they do, the outer where no placement says it.
    pub fn about(&self, map: &DAffine2) -> Option<Option<Placement>> {
        let own = self.map();
        if own == *map {
            return Some(None);
        }
        let (relative, scale, rotation) = if *map == DAffine2::IDENTITY {
            (own, self.scale, self.rotation)
        } else {
            let relative = own * map.inverse();
            let (along_u, along_v) = (relative.matrix2.x_axis, relative.matrix2.y_axis);
            if !relative.is_finite() || along_u.dot(along_v).abs() > 1e-9 * along_u.length() * along_v.length() {
                return None;
            }
            let turn = if along_u == DVec2::ZERO { along_v.perp().to_angle() + std::f64::consts::PI } else { along_u.to_angle() };
            (relative, DVec2::new(along_u.length(), along_v.dot(DVec2::from_angle(turn).perp())), -turn)
        };
        // v runs upward here: (u, 1 - v) is looked up.
        let (sheared, stretched) = (relative.matrix2.y_axis.x, relative.matrix2.y_axis.y);
        let offset = [sheared + relative.translation.x, 1.0 - stretched - relative.translation.y];
        Some(Some(Placement { scale: scale.to_array(), rotation_degrees: rotation.to_degrees(), offset }))
    }
}

impl Lookups {
    pub fn of(material: &Material) -> Result<Self, String> {
        let pbr = &material.pbr_metallic_roughness;
        let glossy = extension::<SpecularGlossiness>(&material.extensions, "KHR_materials_pbrSpecularGlossiness")?;
        let [base, second] = match &glossy {
            Some(glossy) => [&glossy.diffuse_texture, &glossy.specular_glossiness_texture],
            None => [&pbr.base_color_texture, &pbr.metallic_roughness_texture],
        };
        let plain = [base, second, &material.normal_texture, &material.emissive_texture];
        let mut lookups = plain.into_iter().flatten().map(Lookup::of).collect::<Result<Vec<_>, _>>()?;
        for (name, keys) in OF_EXTENSIONS {
            let Some(object) = material.extensions.get(name).and_then(serde_json::Value::as_object) else { continue };
            for key in keys {
                lookups.extend(extension::<TextureInfo>(object, key)?.map(|info| Lookup::of(&info)).transpose()?);
            }
        }
        let Some(first) = lookups.first() else {
            return Ok(Self { coordinates: Coordinates { set: 0, map: DAffine2::IDENTITY, second: None } });
        };
        let normal = material.normal_texture.as_ref().map(Lookup::of).transpose()?;
        let first = normal.as_ref().unwrap_or(first);
        let second = lookups.iter().map(|lookup| lookup.set).find(|set| *set != first.set);
        let are_alike = lookups.iter().filter(|lookup| lookup.set == first.set).all(|lookup| lookup.map() == first.map());
        let turned =
            normal.filter(|normal| normal.rotation != 0.0 || normal.scale.min_element() < 0.0).map(|normal| normal.map());
        let map = match turned.filter(|map| map.matrix2.determinant() != 0.0) {
            _ if are_alike => first.map(),
            turned => turned.unwrap_or(DAffine2::IDENTITY),
        };
        Ok(Self { coordinates: Coordinates { set: first.set, map, second } })
    }
}

impl Placement {
    /// Equal for equal placements.
    pub fn bits(self) -> [u64; 5] {
        let ([scale_u, scale_v], [offset_u, offset_v]) = (self.scale, self.offset);
        [scale_u, scale_v, self.rotation_degrees, offset_u, offset_v].map(f64::to_bits)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Looked up through the mesh's coordinates and the placement, a texture is where its own transform puts it.
    #[test]
    fn placements_make_up_for_the_meshes_coordinates() {
        let lookup = |scale: [f64; 2], rotation: f64, offset: [f64; 2]| Lookup {
            set: 0,
            scale: scale.into(),
            rotation,
            offset: offset.into(),
        };
        let own = lookup([2.0, 0.5], 0.7, [0.25, -0.5]);
        let bases = [DAffine2::IDENTITY, lookup([4.0, 1.0], 0.0, [0.1, 0.2]).map(), lookup([-4.0, 1.0], 1.1, [0.4, 0.0]).map()];
        for base in bases {
            let Some(Some(placement)) = own.about(&base) else { panic!("{base:?}") };
            for at in [DVec2::ZERO, DVec2::X, DVec2::new(0.3, 0.8)] {
                let expected = own.map().transform_point2(at);
                let meshes = base.transform_point2(at);
                let scaled = DVec2::new(meshes.x, 1.0 - meshes.y) * DVec2::from(placement.scale);
                let found = DMat2::from_angle(placement.rotation_degrees.to_radians()) * scaled + DVec2::from(placement.offset);
                let found = DVec2::new(found.x, 1.0 - found.y);
                assert!((found - expected).length() < 1e-12, "{found} {expected}");
            }
        }
        assert_eq!(own.about(&own.map()), Some(None));
        // Turned by another angle and stretched: a shear.
        assert_eq!(own.about(&lookup([1.0, 3.0], 0.2, [0.0; 2]).map()), None);
    }
}
