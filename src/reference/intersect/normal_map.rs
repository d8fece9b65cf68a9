//! Normals read from textures.
//!
//! A texel's colour, red and green and blue times 2 minus 1, is a direction in the frame of the surface on its front side: red along
//! the tangent, in which u grows; green along the bitangent, on the side where v grows; blue along the shading normal.

use glam::{DVec2, DVec3};

use crate::scene::{MaterialId, Relief, Scene, Texture, TextureId};
use crate::texture::{self, Coordinates};

/// The directions in which u and v grow, not of unit length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tangents {
    pub along_u: DVec3,
    pub along_v: DVec3,
    /// Divisor of both: divided by it, they are how far points move with u and v.
    pub uv_area: f64,
}

impl Tangents {
    /// Tangents of the linear map from a triangle's uvs to its corners. None where the uvs span no area.
    pub fn of_triangle([a, b, c]: [DVec3; 3], [uv_a, uv_b, uv_c]: [DVec2; 3]) -> Option<Self> {
        let ((edge_b, edge_c), (uv_b, uv_c)) = ((b - a, c - a), (uv_b - uv_a, uv_c - uv_a));
        let determinant = uv_b.perp_dot(uv_c);
        // Only directions matter, so the determinant's sign is enough.
        let sign = determinant.signum();
        (determinant != 0.0).then(|| Self {
            along_u: (edge_b * uv_c.y - edge_c * uv_b.y) * sign,
            along_v: (edge_c * uv_b.x - edge_b * uv_c.x) * sign,
            uv_area: determinant.abs(),
        })
    }

    /// Tangents that are directions alone.
    pub fn along(along_u: DVec3, along_v: DVec3) -> Self {
        Self { along_u, along_v, uv_area: 1.0 }
    }

    /// The normal of the surface that is lifted along `normal` by a height that changes so with u and v (Blinn 1978, "Simulation of wrinkled
    /// surfaces").
    fn lifted(&self, normal: DVec3, geometric_normal: DVec3, slope: DVec2) -> Option<DVec3> {
        let lift = |along: DVec3, slope: f64| along + normal * (slope - normal.dot(along));
        let [along_u, along_v] = [self.along_u, self.along_v].map(|along| along / self.uv_area);
        let bumped = lift(along_u, slope.x).cross(lift(along_v, slope.y)).try_normalize()?;
        Some(if bumped.dot(geometric_normal) < 0.0 { -bumped } else { bumped })
    }

    /// The direction that a texel stands for about `normal`, the shading normal on the front side. The tangent is made perpendicular
    /// to the normal, the bitangent to both.
    pub fn direction(&self, normal: DVec3, texel: DVec3, scale: f64) -> Option<DVec3> {
        let tangent = (self.along_u - normal * normal.dot(self.along_u)).try_normalize()?;
        let across = normal.cross(tangent);
        let bitangent = across * across.dot(self.along_v).signum();
        let local = texel * 2.0 - 1.0;
        (scale * (tangent * local.x + bitangent * local.y) + normal * local.z).try_normalize()
    }
}

/// One of a mesh's sets of texture coordinates; of what has one, that.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum UvSet {
    First,
    Second,
}

/// The texel of a normal map at a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NormalTexel {
    pub texel: DVec3,
    /// Multiplies red and green, after they are taken from 0 to 1 to −1 to 1.
    pub scale: f64,
    /// The coordinates that the map lies by.
    pub set: UvSet,
}

impl UvSet {
    /// The coordinates that a texture lies by.
    pub fn of(texture: &Texture) -> Self {
        if texture.by_second_uvs { Self::Second } else { Self::First }
    }

    /// The coordinates along which a normal map that is this texture has its directions.
    pub fn of_directions(texture: &Texture) -> Self {
        if texture.bends_by_first_uvs { Self::First } else { Self::of(texture) }
    }
}

/// The normal maps of a scene's materials.
#[derive(Debug, Clone)]
pub struct NormalMaps {
    /// The scene's; images are shared.
    textures: Vec<Texture>,
    of_material: Vec<Option<TextureId>>,
}

impl NormalMaps {
    pub fn new(scene: &Scene) -> Self {
        let of_material: Vec<_> = scene.materials.iter().map(|material| material.normal_map).collect();
        let any = of_material.iter().any(Option::is_some);
        Self { textures: if any { scene.textures.clone() } else { Vec::new() }, of_material }
    }

    /// Says that the shadowing term of perturbed normals applies to the material's map.
    pub fn shadows(&self, material: MaterialId) -> bool {
        self.of_material[material].is_some_and(|texture| self.textures[texture].shadows_perturbed_normals)
    }

    /// Normals that the material's map bends away from the viewer are mirrored.
    pub fn mirrors(&self, material: MaterialId) -> bool {
        self.of_material[material].is_some_and(|texture| self.textures[texture].mirrors_perturbed_normals)
    }

    /// The shading normal as the material's map bends it; as it is where there is no map or no tangent. `tangents` are those of the coordinates
    /// that the map lies by.
    pub fn bend(
        &self,
        material: MaterialId,
        [normal, geometric_normal]: [DVec3; 2],
        uv: Coordinates,
        tangents: impl FnOnce(UvSet) -> Option<Tangents>,
    ) -> DVec3 {
        let Some(texture) = self.of_material[material] else { return normal };
        let Some(tangents) = tangents(UvSet::of_directions(&self.textures[texture])) else { return normal };
        let perturbed = match self.textures[texture].relief {
            Relief::Normals(scale) => {
                let texel = texture::look_up(&self.textures, texture, uv).to_vector();
                tangents.direction(normal, texel, scale)
            }
            Relief::Heights(scale) => {
                tangents.lifted(normal, geometric_normal, scale * texture::gradient::gradient(&self.textures, texture, uv))
            }
        };
        perturbed.unwrap_or(normal)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flat_texel_leaves_the_normal() {
        let tangents = Tangents::along(DVec3::new(2.0, 0.5, 0.0), DVec3::new(-0.3, 1.0, 0.4));
        let normal = DVec3::new(0.1, -0.2, 1.0).normalize();
        let perturbed = tangents.direction(normal, DVec3::new(0.5, 0.5, 1.0), 1.0).expect("there is a tangent");
        assert!((perturbed - normal).length() < 1e-15);
    }

    #[test]
    fn red_bends_towards_u_and_green_towards_v() {
        // v grows upward for one, downward for the other: a mirrored mapping.
        for along_v in [DVec3::Y, -DVec3::Y] {
            let tangents = Tangents::along(DVec3::X * 3.0, along_v);
            let perturbed = |r, g| tangents.direction(DVec3::Z, DVec3::new(r, g, 1.0), 1.0).expect("there is a tangent");
            assert!((perturbed(1.0, 0.5) - DVec3::new(1.0, 0.0, 1.0).normalize()).length() < 1e-15);
            assert!((perturbed(0.5, 1.0) - (DVec3::Z + along_v).normalize()).length() < 1e-15);
        }
        assert_eq!(Tangents::along(DVec3::Z, DVec3::Y).direction(DVec3::Z, DVec3::ONE, 1.0), None);
    }

    /// A plane that is lifted by a slope of its own in u and v, whichever way v runs.
    #[test]
    fn heights_tilt_the_surface() {
        for along_v in [DVec3::Y * 4.0, DVec3::NEG_Y * 4.0] {
            let tangents = Tangents { along_u: DVec3::X * 2.0, along_v, uv_area: 2.0 };
            let lifted = tangents.lifted(DVec3::Z, DVec3::Z, DVec2::new(0.5, -1.0)).expect("it has a normal");
            // Along x by 1 the height grows by 0.5, along v's direction by 2 it falls by 1.
            let expected = DVec3::new(-0.5, 0.5 * along_v.y.signum(), 1.0).normalize();
            assert!((lifted - expected).length() < 1e-15, "{lifted} {expected}");
        }
    }

    /// Directions found by moving along the mapping itself.
    #[test]
    fn tangents_follow_the_coordinates() {
        let corners = [DVec3::new(1.0, 0.2, 0.0), DVec3::new(3.0, 1.0, 0.5), DVec3::new(0.5, 2.0, 1.5)];
        for uvs in [[[0.1, 0.2], [0.9, 0.3], [0.4, 0.8]], [[0.1, 0.2], [0.4, 0.8], [0.9, 0.3]]] {
            let uvs = uvs.map(DVec2::from);
            let Tangents { along_u, along_v, uv_area } = Tangents::of_triangle(corners, uvs).expect("the uvs span an area");
            // A step from the first corner by (s, t) of the edges changes uv by this; both directions step along one axis alone.
            let change = |direction: DVec3| {
                let (edge_b, edge_c) = (corners[1] - corners[0], corners[2] - corners[0]);
                let normal = edge_b.cross(edge_c);
                let (s, t) = (direction.cross(edge_c).dot(normal), edge_b.cross(direction).dot(normal));
                ((uvs[1] - uvs[0]) * s + (uvs[2] - uvs[0]) * t) / normal.length_squared()
            };
            assert!(change(along_u).x > 0.0 && change(along_u).y.abs() < 1e-12);
            assert!(change(along_v).y > 0.0 && change(along_v).x.abs() < 1e-12);
            assert!((change(along_u / uv_area).x - 1.0).abs() < 1e-12 && (change(along_v / uv_area).y - 1.0).abs() < 1e-12);
        }
        assert_eq!(Tangents::of_triangle(corners, [DVec2::ZERO, DVec2::ONE, DVec2::ONE * 2.0]), None);
    }
}
