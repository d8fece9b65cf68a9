//! Textures come back: the same colour at the same place of a surface.

use std::sync::Arc;

use glam::{DVec2, Vec2, Vec3};

use super::{POINT, SQUARE, Trip, round_trip, scene};
use crate::scene::{
    BlendWeight, Channel, ColorInput, ColorSpace, Geometry, ImageData, ImageTexture, MaterialKind, Mesh, Relief, Scene, Texels,
    Texture, TextureFilter, TextureId, TextureKind, TextureWrap, UvTransform,
};
use crate::scene_writer::inputs::{Colour, Scalar};
use crate::spectrum::Spectrum;

/// The texel of a picture for texture coordinates, the nearest one.
fn texel(scene: &Scene, id: TextureId, uv: Vec2) -> [f64; 4] {
    let texture = &scene.textures[id];
    let (image, scale) = match &texture.kind {
        TextureKind::Image(image) => (image, DVec2::from(image.scale)),
        TextureKind::Checker { a, b, scale } => {
            let at = texture.placed(uv.as_dvec2() * DVec2::from(*scale)).floor();
            let colour = if (at.x + at.y).rem_euclid(2.0) == 0.0 { a } else { b };
            return colour.extend(1.0).to_array();
        }
        other => panic!("{other:?}"),
    };
    let at = texture.placed(uv.as_dvec2() * scale);
    let [width, height] = [image.image.width as usize, image.image.height as usize];
    let column = image.wrap[0].index((at.x * width as f64).floor() as i64, width);
    let row = height - 1 - image.wrap[1].index((at.y * height as f64).floor() as i64, height);
    image.image.texels.get(row * width + column).map(f64::from)
}

/// Texture coordinates at a place within the first triangle of the first shape.
fn uv_at(scene: &Scene, shares: [f32; 3]) -> Vec2 {
    let Geometry::Mesh(mesh) = &scene.shapes[0].geometry else { panic!("it is no mesh") };
    let [a, b, c] = mesh.faces[0].map(|vertex| mesh.uvs[vertex as usize]);
    a * shares[0] + b * shares[1] + c * shares[2]
}

/// Places within a triangle, none of them between two texels.
fn places() -> impl Iterator<Item = [f32; 3]> {
    (0..11)
        .flat_map(|i| (0..11 - i).map(move |j| [(i as f32 + 0.31) / 12.0, (j as f32 + 0.37) / 12.0]))
        .map(|[a, b]| [a, b, 1.0 - a - b])
}

/// A square of two triangles with texture coordinates, of one material, and its textures.
fn textured(keys: &str, textures: Vec<Texture>) -> Scene {
    let mut made = scene(&format!("[[material]]\nname = \"probe\"\n{keys}\n{SQUARE}{POINT}"));
    made.textures = textures;
    let positions = vec![Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y];
    let uvs = positions.iter().map(|at| at.truncate() * 1.5 + Vec2::new(0.1, -0.2)).collect();
    let mesh = Mesh { positions, uvs, faces: vec![[0, 1, 2], [0, 2, 3]], ..Mesh::default() };
    made.shapes[0].geometry = Geometry::Mesh(mesh.into());
    made
}

fn picture(space: ColorSpace, seed: u32) -> Texture {
    let code = |index: u32, channel: u32| ((index * 37 + channel * 91 + seed * 53) % 251) as u8;
    let codes = (0..8 * 4).map(|index| [0, 1, 2, 3].map(|channel| code(index, channel))).collect();
    let image = ImageData { width: 8, height: 4, texels: Texels::Bytes { codes, space }, has_alpha: true };
    let kind = TextureKind::Image(ImageTexture {
        image: Arc::new(image),
        wrap: [TextureWrap::Repeat, TextureWrap::Mirror],
        filter: TextureFilter::Nearest,
        scale: [1.0; 2],
    });
    Texture::new("picture", kind)
}

fn diffuse_of(made: &mut Scene, input: ColorInput) {
    made.materials[0].kind = MaterialKind::Diffuse { reflectance: input };
}

fn reflectance(scene: &Scene) -> Colour {
    let MaterialKind::Diffuse { reflectance } = scene.materials[scene.shapes[0].material].kind else {
        panic!("{:?}", scene.materials)
    };
    Colour::of(reflectance)
}

fn colour_at(scene: &Scene, shares: [f32; 3]) -> Spectrum {
    match reflectance(scene) {
        Colour::Constant(colour) => colour,
        Colour::Map(map) => map.of_texel(texel(scene, map.texture, uv_at(scene, shares))),
    }
}

/// The largest difference of colours at places.
fn difference(a: &Scene, b: &Scene) -> f64 {
    places().map(|place| colour_at(a, place).distance(colour_at(b, place))).fold(0.0, f64::max)
}

#[test]
fn pictures_lie_where_they_lay() {
    let input = |made: &mut Scene| diffuse_of(made, ColorInput::ScaledTexture(0, Spectrum::new(0.5, 1.0, 0.25)));
    let transforms = [([1.0, 1.0], 0.0, [0.0, 0.0]), ([2.0, 0.5], 0.0, [0.25, 0.125]), ([2.0, -1.5], 30.0, [0.1, 0.7])];
    for (scale, rotation_degrees, offset) in transforms {
        let mut texture = picture(ColorSpace::Srgb, 1);
        texture.transform = UvTransform { rotation_degrees, offset };
        let TextureKind::Image(image) = &mut texture.kind else { panic!() };
        image.scale = scale;
        let mut written = textured("type = \"diffuse\"\nreflectance = 0.5", vec![texture]);
        input(&mut written);
        let Trip { read, lost, back, .. } = round_trip(&written);
        assert_eq!((lost.len(), back.len()), (0, 0), "{lost:?} {back:?}");
        assert!(difference(&read, &written) < 1e-6, "{scale:?} {rotation_degrees} {}", difference(&read, &written));
        let TextureKind::Image(image) = &read.textures[0].kind else { panic!() };
        assert_eq!((image.wrap, image.filter), ([TextureWrap::Repeat, TextureWrap::Mirror], TextureFilter::Nearest));
        let mut other = written.clone();
        other.textures[0].transform.offset[0] += 0.3;
        assert!(difference(&read, &other) > 0.1, "the control");
    }
}

#[test]
fn checkers_and_linear_pictures_come_back() {
    let tiles = Texture::new(
        "tiles",
        TextureKind::Checker { a: Spectrum::new(0.1, 0.5, 0.9), b: Spectrum::grey(0.8), scale: [3.0, 5.0] },
    );
    for (texture, most) in [(tiles, 3e-5), (picture(ColorSpace::Linear, 2), 3e-5)] {
        let mut written = textured("type = \"diffuse\"\nreflectance = 0.5", vec![texture]);
        diffuse_of(&mut written, ColorInput::Texture(0));
        let Trip { read, lost, back, .. } = round_trip(&written);
        assert_eq!((lost.len(), back.len()), (0, 0), "{lost:?} {back:?}");
        let found = difference(&read, &written);
        assert!(found < most, "{found}");
        let mut other = written.clone();
        other.textures[0].transform.offset[1] += 0.27;
        assert!(difference(&read, &other) > 0.1, "the control");
    }
}

/// Metal and roughness, of textures of their own, share one there.
#[test]
fn numbers_come_back_in_their_channels() {
    let textures = vec![picture(ColorSpace::Linear, 1), picture(ColorSpace::Linear, 7)];
    let mut written = textured("type = \"principled\"\nbase_color = 0.5", textures);
    let MaterialKind::Principled(principled) = &mut written.materials[0].kind else { panic!() };
    let channel = |texture: TextureId, channel: Channel, factor: f64| {
        ColorInput::Channel(crate::scene::ChannelInput { texture, channel, factor: Spectrum::grey(factor), is_squared: false })
    };
    (principled.metallic, principled.roughness) = (channel(0, Channel::R, 0.5), channel(1, Channel::A, 1.0));
    let Trip { read, lost, back, json } = round_trip(&written);
    assert_eq!((lost.len(), back.len()), (0, 0), "{lost:?} {back:?}");
    assert_eq!(json["images"].as_array().map(Vec::len), Some(1));
    let value = |scene: &Scene, of: fn(&crate::scene::Principled) -> ColorInput, shares: [f32; 3]| {
        let MaterialKind::Principled(principled) = &scene.materials[scene.shapes[0].material].kind else { panic!() };
        let Scalar::Map(map) = Scalar::of(of(principled)) else { panic!("{principled:?}") };
        map.of_texel(texel(scene, map.texture, uv_at(scene, shares)))
    };
    for place in places() {
        for of in [|of: &crate::scene::Principled| of.metallic, |of: &crate::scene::Principled| of.roughness] {
            assert!((value(&read, of, place) - value(&written, of, place)).abs() < 1e-6);
        }
    }
    let apart = places().map(|place| (value(&read, |of| of.metallic, place) - value(&written, |of| of.roughness, place)).abs());
    assert!(apart.fold(0.0, f64::max) > 0.1, "the control");
}

/// The opacity of a texture of its own is in the alpha of the colour's; a threshold is a mask.
#[test]
fn opacity_comes_back() {
    let textures = vec![picture(ColorSpace::Srgb, 1), picture(ColorSpace::Linear, 7)];
    let tables = format!(
        "[[material]]\nname = \"red\"\ntype = \"diffuse\"\nreflectance = 0.5\n[[material]]\nname = \"nothing\"\ntype = \"pass\"\n[[material]]\nname = \"probe\"\n\
         type = \"blend\"\nmaterials = [\"red\", \"nothing\"]\nweight = {{ type = \"constant\", value = 1 }}\n{SQUARE}{POINT}"
    );
    let share = |texture: TextureId, channel: Channel| BlendWeight::Channel { texture, channel, factor: 0.75 };
    for (colour, opacity, channel, tau) in [(0, 0, Channel::A, None), (0, 1, Channel::G, None), (0, 1, Channel::G, Some(0.3))] {
        let mut written = textured("type = \"diffuse\"\nreflectance = 0.5", textures.clone());
        let blend = scene(&tables);
        written.materials = blend.materials;
        written.shapes[0].material = 2;
        written.materials[0].kind = MaterialKind::Diffuse { reflectance: ColorInput::Texture(colour) };
        let MaterialKind::Blend { weight, .. } = &mut written.materials[2].kind else { panic!() };
        *weight = share(opacity, channel);
        if let Some(tau) = tau {
            *weight = BlendWeight::Threshold { tau, of: Box::new(weight.clone()) };
        }
        let Trip { read, lost, back, .. } = round_trip(&written);
        assert_eq!((lost.len(), back.len()), (0, 0), "{lost:?} {back:?}");
        let value = |scene: &Scene, shares: [f32; 3]| {
            let MaterialKind::Blend { weight, .. } = &scene.materials[scene.shapes[0].material].kind else { panic!() };
            let (texture, value) = crate::scene_writer::weights::of_texels(weight).unwrap();
            value(texel(scene, texture, uv_at(scene, shares)))
        };
        for place in places() {
            assert!((value(&read, place) - value(&written, place)).abs() < 1e-5, "{opacity} {channel:?}");
        }
        let apart = places().map(|place| (value(&read, place) - 0.5).abs()).fold(0.0, f64::max);
        assert!(apart > 0.1, "the control");
    }
}

#[test]
fn normal_maps_come_back() {
    let mut map = picture(ColorSpace::Linear, 3);
    map.relief = Relief::Normals(0.5);
    let mut written = textured("type = \"diffuse\"\nreflectance = 0.5", vec![map]);
    written.materials[0].normal_map = Some(0);
    let Trip { read, lost, back, .. } = round_trip(&written);
    assert_eq!((lost.len(), back.len()), (0, 0), "{lost:?} {back:?}");
    let id = read.materials[read.shapes[0].material].normal_map.expect("it has one");
    assert_eq!(read.textures[id].relief, Relief::Normals(0.5));
    for place in places() {
        let [found, expected] = [(&read, id), (&written, 0)].map(|(scene, id)| texel(scene, id, uv_at(scene, place)));
        assert_eq!(found[..3], expected[..3]);
    }
    written.textures[0].relief = Relief::Heights(0.5);
    assert_eq!(round_trip(&written).lost, ["bump map"], "the control");
}

/// Colours of vertices are an attribute there, whose numbers come back bit for bit.
#[test]
fn colours_of_vertices_come_back() {
    let colours = [[0.1, 0.2, 0.3], [0.9, 0.1, 0.5], [0.25, 0.75, 1.0], [0.4, 0.35, 0.6]];
    let image = ImageData { width: 2, height: 2, texels: Texels::Float(colours.to_vec()), has_alpha: false };
    let kind = TextureKind::Image(ImageTexture {
        image: Arc::new(image),
        wrap: [TextureWrap::Clamp; 2],
        filter: TextureFilter::Triangle,
        scale: [1.0; 2],
    });
    let mut written = textured("type = \"diffuse\"\nreflectance = 0.5", vec![Texture::new("paint", kind)]);
    diffuse_of(&mut written, ColorInput::Texture(0));
    let uvs = vec![Vec2::new(0.25, 0.75), Vec2::new(0.75, 0.75), Vec2::new(0.25, 0.25)];
    let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
    let mesh = Mesh { positions, uvs, faces: vec![[0, 1, 2]], ..Mesh::default() };
    written.shapes[0].geometry = Geometry::Mesh(mesh.into());
    let Trip { read, lost, back, json } = round_trip(&written);
    assert_eq!((lost.len(), back.len()), (0, 0), "{lost:?} {back:?}");
    assert!(json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"].is_u64() && json["images"].is_null(), "{json:#}");
    let corner = |scene: &Scene, corner: usize| {
        let shares = std::array::from_fn(|index| if index == corner { 1.0 } else { 0.0 });
        colour_at(scene, shares).to_f32()
    };
    for (index, expected) in colours.into_iter().take(3).enumerate() {
        assert_eq!((corner(&read, index), corner(&written, index)), (expected, expected));
    }
    assert_ne!(corner(&read, 0), corner(&read, 1), "the control");
}
