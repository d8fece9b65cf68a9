//! How open the places of surfaces are, where weights of blends ask for it: computed at the vertices of meshes, once.
//!
//! From each vertex 256 rays with fixed directions go out about its normal, evenly by their cosines. The share that meets nothing within the distance,
//! to the weight's power, becomes a texture coordinate, and the weight the texture that has the coordinate for its value. So a weight costs what a
//! texture does, has no noise, and is the same on every device; between vertices it is interpolated.

use std::sync::Arc;

use glam::{DMat3, DVec3, Vec2, Vec3};
use rayon::prelude::*;

use crate::math::Frame;
use crate::reference::intersect::{PathTime, Ray, World};
use crate::reference::warp::cosine_hemisphere;
use crate::renderer::RenderError;
use crate::scene::{
    BlendWeight, Channel, Geometry, ImageData, ImageTexture, MaterialKind, Mesh, Scene, Shape, Texels, Texture, TextureFilter,
    TextureKind, TextureWrap,
};

/// Rays from a vertex: the first points of Hammersley's set.
const RAYS: u32 = 256;
/// The height above the surface at which rays begin, as a share of their length.
const START: f64 = 1e-4;

/// The scene with textures in place of weights by openness; None where it has no such weights.
///
/// # Errors
/// [`RenderError`] for a scene that the reference cannot trace.
pub fn baked(scene: &Scene) -> Result<Option<Scene>, RenderError> {
    let open = scene.openness();
    let mut kinds: Vec<[f64; 2]> = open.iter().flatten().copied().collect();
    kinds.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    kinds.dedup();
    if kinds.is_empty() {
        return Ok(None);
    }
    let world = World::new(scene)?;
    let mut found = scene.clone();
    for (index, shape) in scene.shapes.iter().enumerate() {
        let wanted = |kind: &[f64; 2]| shape.materials().any(|id| open[id].contains(kind));
        let Geometry::Mesh(mesh) = &shape.geometry else { continue };
        if !kinds.iter().any(wanted) {
            continue;
        }
        let places = places(scene, shape, mesh);
        let time = PathTime::new(scene, scene.camera.shutter[0]);
        let coordinate = |kind: Option<&[f64; 2]>, place: &Option<[DVec3; 2]>| match (kind.filter(|kind| wanted(kind)), place) {
            (Some([distance, power]), Some(place)) => openness(&world, &time, place, *distance).powf(*power),
            _ => 1.0,
        };
        let at = |place: &Option<[DVec3; 2]>| {
            let [u, v] = [kinds.first(), kinds.get(1)].map(|kind| coordinate(kind, place) as f32);
            // The value of a texel is met at its centre.
            Vec2::new(0.25 + 0.5 * u, 0.25 + 0.5 * v)
        };
        let second_uvs: Vec<Vec2> = places.par_iter().map(at).collect();
        let uvs = if mesh.uvs.is_empty() { vec![Vec2::ZERO; mesh.positions.len()] } else { mesh.uvs.clone() };
        found.shapes[index].geometry = Geometry::Mesh(Arc::new(Mesh { second_uvs, uvs, ..Mesh::clone(mesh) }));
    }
    let first = found.textures.len();
    found.textures.extend((0..kinds.len()).map(coordinate_texture));
    for material in &mut found.materials {
        if let MaterialKind::Blend { weight, .. } = &mut material.kind {
            replace(weight, &|kind| first + kinds.iter().position(|other| *other == kind).unwrap_or_default());
        }
    }
    Ok(Some(found))
}

/// Puts textures in place of weights by openness.
fn replace(weight: &mut BlendWeight, texture: &dyn Fn([f64; 2]) -> usize) {
    match weight {
        BlendWeight::Open { distance, power } => {
            let texture = texture([*distance, *power]);
            *weight = BlendWeight::Channel { texture, channel: Channel::R, factor: 1.0 };
        }
        BlendWeight::Reverse { of } | BlendWeight::Threshold { of, .. } => replace(of, texture),
        _ => {}
    }
}

/// A texture that has the second coordinate u, or v, for its value, between the centres of its two texels.
fn coordinate_texture(along_v: usize) -> Texture {
    let [black, white] = [Vec3::ZERO, Vec3::ONE];
    // Rows stand from the top, where v is 1.
    let (width, height, colors) = if along_v == 0 { (2, 1, vec![black, white]) } else { (1, 2, vec![white, black]) };
    let image = Arc::new(ImageData { width, height, texels: Texels::from(colors), has_alpha: false });
    let image = ImageTexture { image, wrap: [TextureWrap::Clamp; 2], filter: TextureFilter::Bilinear, scale: [1.0, 1.0] };
    Texture { by_second_uvs: true, ..Texture::new("openness", TextureKind::Image(image)) }
}

/// The vertices of a mesh in the world with their normals; None for one that no face has.
fn places(scene: &Scene, shape: &Shape, mesh: &Mesh) -> Vec<Option<[DVec3; 2]>> {
    let moved = shape.moved_by(scene.camera.shutter[0]).unwrap_or_default();
    let map = moved * shape.transform.to_affine();
    let of_normals: DMat3 = map.matrix3.inverse().transpose();
    let positions: Vec<DVec3> = mesh.positions.iter().map(|position| map.transform_point3(position.as_dvec3())).collect();
    let mut normals = vec![DVec3::ZERO; positions.len()];
    if mesh.normals.is_empty() {
        for &face in &mesh.faces {
            let [a, b, c] = face.map(|vertex| positions[vertex as usize]);
            let normal = (b - a).cross(c - a) * map.matrix3.determinant().signum();
            face.into_iter().for_each(|vertex| normals[vertex as usize] += normal);
        }
    } else {
        normals.iter_mut().zip(&mesh.normals).for_each(|(normal, given)| *normal = of_normals * given.as_dvec3());
    }
    let unit = |normal: DVec3| normal.try_normalize();
    positions.into_iter().zip(normals).map(|(position, normal)| Some([position, unit(normal)?])).collect()
}

/// The share of directions about the normal in which nothing is nearer than the distance.
fn openness(world: &World, time: &PathTime, &[position, normal]: &[DVec3; 2], distance: f64) -> f64 {
    let frame = Frame::around(normal);
    let origin = position + normal * (START * distance);
    let is_open = |index: u32| {
        let [u1, u2] = [(f64::from(index) + 0.5) / f64::from(RAYS), f64::from(index.reverse_bits()) / 2.0_f64.powi(32)];
        let ray = Ray { origin, direction: frame.to_world(cosine_hemisphere(u1, u2)) };
        world.closest(ray, time).is_none_or(|hit| hit.distance >= distance)
    };
    f64::from((0..RAYS).filter(|&index| is_open(index)).count() as u32) / f64::from(RAYS)
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::load::load_toml_str;

    /// A vertex below a wall that stands at a distance, both in planes at right angles, has as many open directions as the wall leaves: one half where the
    /// wall is at the vertex and reaches beyond the distance, all of them where the wall is beyond it.
    #[test]
    fn walls_close_half_of_the_sky() {
        let scene = |wall: f64| {
            let text = format!(
                "camera = {{ position = [0, 3, 0], look_at = [0, 0, 0], up = [0, 0, 1], vfov = 40 }}\n\
                 light = [{{ type = \"environment\", radiance = 1 }}]\n\
                 material = [{{ name = \"a\", type = \"diffuse\", reflectance = 0.5 }}, {{ name = \"b\", type = \"mirror\" }},\n\
                 {{ name = \"c\", type = \"blend\", materials = [\"a\", \"b\"], weight = {{ type = \"reverse\", of = {{ type = \"open\", distance = 1 }} }} }}]\n\
                 shape = [{{ type = \"mesh\", material = \"c\", positions = [[-1, 0, 1], [1, 0, 1], [0, 0, -1]], faces = [[0, 1, 2]] }},\n\
                 {{ type = \"rectangle\", material = \"a\", corner = [{wall}, -9, -9], edge_u = [0, 18, 0], edge_v = [0, 0, 18] }}]\n"
            );
            load_toml_str(&text, "wall", Path::new("")).expect("the scene is valid")
        };
        let second = |wall: f64| {
            let baked = baked(&scene(wall)).expect("it can be traced").expect("there is a weight");
            let Geometry::Mesh(mesh) = &baked.shapes[0].geometry else { panic!("a mesh") };
            let MaterialKind::Blend { weight: BlendWeight::Reverse { of }, .. } = &baked.materials[2].kind else {
                panic!("a blend")
            };
            assert_eq!(**of, BlendWeight::Channel { texture: 0, channel: Channel::R, factor: 1.0 });
            mesh.second_uvs.iter().map(|uv| 2.0 * (f64::from(uv.x) - 0.25)).collect::<Vec<f64>>()
        };
        let near = second(1.0 + 1e-6);
        assert!((near[1] - 0.5).abs() < 0.02, "at the wall: {near:?}");
        assert_eq!([near[0], near[2]], [1.0, near[2]], "two units away, nothing is nearer than one");
        assert!(near[2] > 0.99, "one unit away: {near:?}");
        assert_eq!(second(2.5), [1.0; 3], "the control: beyond the distance nothing is closed");
    }

    #[test]
    fn weights_of_meshes_alone_are_baked() {
        let text = "camera = { position = [0, 3, 0], look_at = [0, 0, 0], up = [0, 0, 1], vfov = 40 }\n\
            light = [{ type = \"environment\", radiance = 1 }]\n\
            material = [{ name = \"a\", type = \"diffuse\", reflectance = 0.5 }, { name = \"b\", type = \"mirror\" },\n\
            { name = \"c\", type = \"blend\", materials = [\"a\", \"b\"], weight = { type = \"open\", distance = 1 } }]\n\
            shape = [{ type = \"sphere\", material = \"c\", center = [0, 0, 0], radius = 1 }]\n";
        let scene = load_toml_str(text, "ball", Path::new("")).expect("it can be read");
        let error = scene.validate().expect_err("a sphere has no vertices").to_string();
        assert!(error.contains("vertices of meshes"), "{error}");
    }
}
