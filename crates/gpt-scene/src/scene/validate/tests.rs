use std::sync::Arc;

use glam::{DVec3, Vec2, Vec3};

use super::*;
use crate::scene::{
    Aperture, ApertureShape, BrownConrady, CoatNormalMap, ConductorFresnel, CubeLayout, CubeMap, Cuboid, Cylindrical,
    DirectionalLight, Disk, Emission, Equirectangular, Fisheye, FisheyeFit, FisheyeMapping, Geometry, ImageData, ImageTexture,
    Intrinsics, KannalaBrandt, Masking, Medium, Mesh, Microfacets, Motion, MotionStep, Phase, PhaseKind, Plane, PointLight,
    Principled, ProjectedTexture, Projection, Rectangle, Sphere, SpotLight, Stereo, StereoLayout, Texture, TextureFilter,
    TextureWrap, Transform, TransformStep,
};
use crate::spectrum::Spectrum;

fn material(name: &str, kind: MaterialKind) -> Material {
    Material { name: name.into(), kind, normal_map: None, emission: None, two_sided: true, interior: None }
}

/// Gives the first material a coat with a normal map.
fn coat_normals(scene: &mut Scene, texture: usize, scale: f64) {
    let [zero, one] = [0.0, 1.0].map(ColorInput::grey);
    scene.materials[0].kind = MaterialKind::Principled(Box::new(Principled {
        base_color: one,
        metallic: one,
        roughness: one,
        ior: 1.5,
        dispersion: None,
        specular: one,
        specular_color: one,
        transmission: zero,
        diffuse_transmission: zero,
        diffuse_transmission_color: one,
        subsurface: None,
        thin: false,
        attenuation: None,
        clearcoat: one,
        clearcoat_roughness: zero,
        coat_normal_map: Some(CoatNormalMap { texture, scale }),
        sheen_color: zero,
        sheen_roughness: zero,
        anisotropy: None,
        anisotropy_direction: None,
        anisotropy_rotation_degrees: 0.0,
        thin_film: None,
        thin_film_share: zero,
        masking: Masking::Separable,
        energy_compensation: false,
    }));
}

fn shape(label: &str, geometry: Geometry, material: MaterialId) -> Shape {
    Shape { label: label.into(), geometry, material, transform: Transform::default(), motion: None, portal: false, receiver: 0 }
}

fn pixels(width: u32, height: u32) -> Arc<ImageData> {
    let texels = vec![Vec3::splat(0.5); (width * height) as usize];
    Arc::new(ImageData { width, height, texels: texels.into(), has_alpha: false })
}

/// Something of every kind that has a number or an index of its own.
fn scene() -> Scene {
    let mut scene = Scene::default();
    scene.film.size = [8, 4];
    let image =
        ImageTexture { image: pixels(2, 3), wrap: [TextureWrap::Repeat; 2], filter: TextureFilter::Bilinear, scale: [1.0; 2] };
    let [a, b] = [Spectrum::BLACK, Spectrum::WHITE];
    for (name, kind) in [
        ("picture", TextureKind::Image(image)),
        ("checks", TextureKind::Checker { a, b, scale: [4.0; 2] }),
        ("clouds", TextureKind::Perlin { scale: 3.0, octaves: 4, a, b, seed: 1 }),
        ("cells", TextureKind::Worley { scale: 3.0, a, b, seed: 1 }),
    ] {
        scene.textures.push(Texture::new(name, kind));
    }
    let grey = ColorInput::grey(0.5);
    let textured = MaterialKind::Diffuse { reflectance: ColorInput::Texture(0) };
    let glass =
        MaterialKind::Glass { ior: 1.5, reflectance: grey, transmittance: grey, thin: false, film: None, dispersion: None };
    let metal = MaterialKind::Conductor {
        fresnel: ConductorFresnel::Complex { eta: Spectrum::WHITE, k: Spectrum::WHITE },
        facets: Microfacets::ggx(grey),
        specular_reflectance: grey,
        film: None,
    };
    let weight = BlendWeight::Reverse { of: Box::new(BlendWeight::Texture { texture: 1 }) };
    let blend = MaterialKind::Blend { materials: [1, 2], weight };
    for (name, kind) in [
        ("grey", MaterialKind::Diffuse { reflectance: grey }),
        ("textured", textured),
        ("glass", glass),
        ("metal", metal),
        ("blend", blend),
    ] {
        scene.materials.push(material(name, kind));
    }
    scene.materials[0].emission = Some(Emission { radiance: grey, two_sided: false });
    let mesh = Mesh {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
        uvs: vec![Vec2::ZERO, Vec2::X, Vec2::Y],
        faces: vec![[0, 1, 2]],
        face_materials: vec![4],
        ..Mesh::default()
    };
    let center = DVec3::new(0.0, 0.0, -2.0);
    for (label, geometry, material) in [
        ("mesh", Geometry::Mesh(Arc::new(mesh)), 0),
        ("sphere", Geometry::Sphere(Sphere { center, radius: 1.0 }), 1),
        ("disk", Geometry::Disk(Disk { center, normal: DVec3::Z, radius: 1.0 }), 2),
        ("rectangle", Geometry::Rectangle(Rectangle { corner: center, edge_u: DVec3::X, edge_v: DVec3::Y }), 3),
        ("box", Geometry::Box(Cuboid { min: center, max: DVec3::ONE }), 4),
        ("plane", Geometry::Plane(Plane { point: center, normal: DVec3::Y }), 0),
    ] {
        scene.shapes.push(shape(label, geometry, material));
    }
    let spot = Light::Spot(SpotLight {
        position: DVec3::ONE,
        direction: DVec3::Y,
        intensity: b,
        angle_degrees: 30.0,
        falloff_degrees: 20.0,
        curve: Default::default(),
        picture: None,
        profile: None,
    });
    let map = Environment {
        radiance: EnvironmentRadiance::Map(pixels(4, 2)),
        rotation_degrees: 0.0,
        rows: Default::default(),
        turn: None,
        mirrored: false,
    };
    scene.lights = vec![
        Light::Point(PointLight { position: DVec3::ONE, intensity: b, profile: None }),
        spot,
        Light::Directional(DirectionalLight { direction: DVec3::X, irradiance: b }),
        Light::Environment(map),
    ];
    scene
}

#[test]
fn what_can_be_rendered_passes() {
    assert_eq!(scene().validate(), Ok(()));
    assert_eq!(Scene::default().validate(), Ok(()));
}

/// Each scene has one thing wrong; the words name the part and the mistake.
#[test]
fn each_mistake_is_named_with_its_part() {
    type Change = fn(&mut Scene);
    /// Fog, which the camera is within.
    fn medium(scene: &mut Scene) -> &mut Medium {
        let (absorption, scattering, emission) = (Spectrum::grey(0.1), Spectrum::WHITE, Spectrum::BLACK);
        scene.media.push(Medium { name: "fog".into(), absorption, scattering, emission, phase: Phase::isotropic(), grids: None });
        scene.camera_medium = Some(0);
        &mut scene.media[0]
    }
    fn mesh(scene: &mut Scene) -> &mut Mesh {
        match &mut scene.shapes[0].geometry {
            Geometry::Mesh(mesh) => Arc::make_mut(mesh),
            other => panic!("{other:?} is no mesh"),
        }
    }
    fn aperture(scene: &mut Scene, radius: f64, blades: u32) {
        let shape = ApertureShape::Polygon { blades, rotation_degrees: 0.0 };
        scene.camera.aperture = Some(Aperture { shape, radius });
    }
    fn fisheye(scene: &mut Scene, mapping: FisheyeMapping, fov_degrees: f64) {
        scene.camera.projection = Projection::Fisheye(Fisheye { mapping, fov_degrees, fit: FisheyeFit::Inside });
    }
    fn lens(scene: &mut Scene, focal: f64, principal: f64, k1: f64) {
        let intrinsics = Intrinsics { image_size: [512, 512], focal: [focal; 2], principal_point: [principal; 2] };
        let radial = [k1, 0.0, 0.0, 0.0, 0.0, 0.0];
        scene.camera.projection = Projection::BrownConrady(BrownConrady::new(intrinsics, radial, [0.0; 2]));
    }
    fn eyes(scene: &mut Scene, eye_distance: f64, convergence: f64) {
        let convergence = Some(convergence);
        scene.camera.stereo = Some(Stereo { layout: StereoLayout::SideBySide, eye_distance, convergence });
    }
    fn emission(scene: &mut Scene, radiance: ColorInput) {
        scene.materials[0].emission = Some(Emission { radiance, two_sided: false });
    }
    fn environment(radiance: EnvironmentRadiance) -> Light {
        Light::Environment(Environment { radiance, rotation_degrees: 0.0, turn: None, rows: Default::default(), mirrored: false })
    }
    let cases: &[(Change, &str)] = &[
        (|s| medium(s).scattering = Spectrum::grey(-1.0), "medium `fog`: its scattering must be finite and not negative"),
        (|s| medium(s).emission = Spectrum::grey(f64::NAN), "medium `fog`: its emission must be finite and not negative"),
        (
            |s| medium(s).phase = Phase::of(PhaseKind::HenyeyGreenstein { g: 1.0 }),
            "medium `fog`: the mean cosine of its phase function must be above -1 and below 1",
        ),
        (|s| medium(s).phase.0.clear(), "medium `fog`: the weights of its phase function"),
        (|s| s.camera_medium = Some(0), "camera: there is no medium 0"),
        (|s| s.materials[0].interior = Some(3), "material `grey`: there is no medium 3"),
        (|s| s.film.size = [0, 4], "film: size: a picture of 0 x 4 pixels is empty"),
        (|s| s.film.size = [1 << 16, 1 << 16], "film: size: a picture of 65536 x 65536 pixels is too large"),
        (|s| s.film.filter.radius = f64::NAN, "film: filter: expected a radius from 0.5 to 16 pixels, found NaN"),
        (
            |s| s.render.light_samples = 17.into(),
            "render settings: light_samples: expected a whole number from 1 to 16, or auto, found 17",
        ),
        (
            |s| s.render.light_samples_depth = 0,
            "render settings: light_samples_depth: expected a whole number from 1 to 3, found 0",
        ),
        (
            |s| (s.render.max_depth, s.render.roulette_depth) = (0, 0.into()),
            "render settings: roulette_depth: with max_depth = 0 and roulette_depth = 0 paths would never end",
        ),
        (|s| s.camera.look_at = s.camera.position, "camera: it looks at the point it stands at"),
        (|s| s.camera.up = DVec3::Z, "camera: it looks at the point it stands at, or along `up`"),
        (|s| s.camera.projection = Projection::Perspective { vertical_fov_degrees: 180.0 }, "camera: the field of view"),
        (|s| s.camera.projection = Projection::Orthographic { height: 0.0 }, "camera: the height of its window"),
        (|s| aperture(s, -1.0, 6), "camera: the aperture's radius"),
        (|s| aperture(s, 1.0, 2), "camera: an aperture has 3 to 64 blades, not 2"),
        (|s| s.camera.shutter = [1.0, 0.0], "camera: the shutter closes before it opens"),
        (
            |s| {
                let azimuth_degrees = [10.0, 10.0];
                s.camera.projection = Projection::Equirectangular(Equirectangular { azimuth_degrees, ..Default::default() });
            },
            "camera: its azimuths must rise",
        ),
        (
            |s| {
                let elevation_degrees = Some([-20.0, 90.0]);
                s.camera.projection = Projection::Cylindrical(Cylindrical { elevation_degrees, ..Default::default() });
            },
            "camera: its elevations must rise, and lie from -89.9 to 89.9",
        ),
        (|s| fisheye(s, FisheyeMapping::Stereographic, 360.0), "camera: the field of view of a fisheye that is stereographic"),
        (|s| fisheye(s, FisheyeMapping::Orthographic, 180.5), "camera: the field of view of a fisheye that is orthographic"),
        (|s| fisheye(s, FisheyeMapping::Equisolid, f64::NAN), "camera: the field of view of a fisheye that is equisolid"),
        (
            |s| {
                fisheye(s, FisheyeMapping::Equidistant, 180.0);
                aperture(s, 1.0, 6);
            },
            "camera: a camera that is fisheye has no plane to be in focus",
        ),
        (
            |s| {
                fisheye(s, FisheyeMapping::Equidistant, 180.0);
                s.camera.shift = [0.1, 0.0];
            },
            "camera: a camera that is fisheye has no window to shift",
        ),
        (
            |s| s.camera.projection = Projection::CubeMap(CubeMap { layout: CubeLayout::Grid }),
            "camera: its picture has 3 × 2 views, into which 8 × 4 pixels cannot be divided evenly",
        ),
        (
            |s| {
                s.film.size = [600, 200];
                s.camera.projection = Projection::CubeMap(CubeMap { layout: CubeLayout::Grid });
            },
            "camera: the sides of a cube map are squares, 3 × 2 of them in the picture, and these would have 200 × 100 pixels",
        ),
        (
            |s| {
                s.film.size = [600, 100];
                s.camera.projection = Projection::CubeMap(CubeMap { layout: CubeLayout::Row });
                eyes(s, 1.0, 1.0);
            },
            "camera: a camera that is cube_map has one eye",
        ),
        (|s| eyes(s, 0.0, 1.0), "camera: the distance of its eyes must be positive"),
        (|s| eyes(s, 1.0, -1.0), "camera: the distance at which its eyes converge must be positive"),
        (|s| lens(s, -1.0, 256.0, 0.0), "camera: its focal lengths must be positive"),
        (|s| lens(s, 300.0, f64::NAN, 0.0), "camera: its principal point must be finite"),
        (|s| lens(s, 300.0, 256.0, f64::INFINITY), "camera: the coefficients of its distortion must be finite"),
        (|s| lens(s, 10.0, -9e3, -0.5), "camera: no place of its picture sees anything"),
        (
            |s| {
                let intrinsics = Intrinsics { image_size: [0, 4], focal: [1.0; 2], principal_point: [0.0; 2] };
                s.camera.projection = Projection::KannalaBrandt(KannalaBrandt::new(intrinsics, [0.0; 4], 360.0));
            },
            "camera: its calibration must be by pictures that have pixels",
        ),
        (
            |s| {
                let TextureKind::Image(texture) = &mut s.textures[0].kind else { panic!("the first is an image") };
                Arc::make_mut(&mut texture.image).texels = vec![Vec3::splat(0.5); 5].into();
            },
            "texture `picture`: it has 5 texels and not 2 × 3",
        ),
        (
            |s| {
                s.textures[2].kind =
                    TextureKind::Perlin { scale: 1.0, octaves: 17, a: Spectrum::BLACK, b: Spectrum::WHITE, seed: 0 }
            },
            "texture `clouds`: 17 octaves",
        ),
        (
            |s| {
                s.textures[3].kind = TextureKind::Worley { scale: f64::INFINITY, a: Spectrum::BLACK, b: Spectrum::WHITE, seed: 0 }
            },
            "texture `cells`: its colours and its scale must be finite",
        ),
        (|s| s.materials[0].normal_map = Some(4), "material `grey`: there is no texture 4"),
        (|s| coat_normals(s, 4, 1.0), "material `grey`: there is no texture 4"),
        (|s| coat_normals(s, 0, f64::NAN), "material `grey`: the scale of its coat's normal map must be finite"),
        (
            |s| emission(s, ColorInput::grey(-1.0)),
            "material `grey`: a colour, or a complex index of refraction, must be finite and not negative",
        ),
        (|s| emission(s, ColorInput::SquaredTexture(9)), "material `grey`: there is no texture 9"),
        (|s| emission(s, ColorInput::ScaledTexture(0, Spectrum::grey(f64::NAN))), "material `grey`: the factor of a texture"),
        (
            |s| s.materials[1].kind = MaterialKind::Mirror { reflectance: ColorInput::Texture(usize::MAX) },
            "material `textured`: there is no texture",
        ),
        (
            |s| {
                let white = ColorInput::grey(1.0);
                s.materials[2].kind = MaterialKind::Glass {
                    ior: 0.0,
                    reflectance: white,
                    transmittance: white,
                    thin: false,
                    film: None,
                    dispersion: None,
                };
            },
            "material `glass`: the index of refraction must be positive",
        ),
        (
            |s| {
                let fresnel = ConductorFresnel::Complex { eta: Spectrum::grey(f64::NAN), k: Spectrum::WHITE };
                s.materials[3].kind = MaterialKind::Conductor {
                    fresnel,
                    facets: Microfacets::ggx(ColorInput::grey(0.1)),
                    specular_reflectance: ColorInput::grey(1.0),
                    film: None,
                };
            },
            "material `metal`: a colour, or a complex index of refraction",
        ),
        (
            |s| s.materials[4].kind = MaterialKind::Blend { materials: [0, 5], weight: BlendWeight::Constant { value: 0.5 } },
            "material `blend`: there is no material 5",
        ),
        (
            |s| s.materials[4].kind = MaterialKind::Blend { materials: [0, 4], weight: BlendWeight::Constant { value: 0.5 } },
            "material `blend`: the blend `blend` contains itself",
        ),
        (
            |s| s.materials[4].kind = MaterialKind::Blend { materials: [0, 1], weight: BlendWeight::Texture { texture: 4 } },
            "material `blend`: there is no texture 4",
        ),
        (
            |s| s.materials[4].kind = MaterialKind::Blend { materials: [0, 1], weight: BlendWeight::Constant { value: 1.5 } },
            "material `blend`: a number of the blend's weight is out of its range",
        ),
        (|s| s.materials[1].normal_map = Some(0), "material `blend`: the normal map of a blend is its own"),
        (|s| mesh(s).faces.push([0, 1, 3]), "mesh: a face names a vertex beyond the last, 2"),
        (|s| mesh(s).uvs.truncate(2), "mesh: normals and uvs must be as many as positions"),
        (|s| mesh(s).normals = vec![Vec3::Z], "mesh: normals and uvs must be as many as positions"),
        (|s| mesh(s).face_materials.push(0), "mesh: face materials must be as many as faces"),
        (|s| mesh(s).face_materials[0] = 5, "mesh: there is no material 5"),
        (|s| mesh(s).positions[1].x = f32::INFINITY, "mesh: positions must be finite"),
        (|s| mesh(s).uvs.clear(), "mesh: a textured material needs texture coordinates"),
        (|s| s.shapes[1].material = 5, "sphere: there is no material 5"),
        (
            |s| s.shapes[1].geometry = Geometry::Sphere(Sphere { center: DVec3::ZERO, radius: 0.0 }),
            "sphere: its numbers must be finite",
        ),
        (
            |s| s.shapes[1].transform.steps.push(TransformStep::Scale(DVec3::new(1.0, 1.0, 2.0))),
            "sphere: a sphere can only be scaled by the same factor along every axis",
        ),
        (|s| s.shapes[2].material = 4, "disk: a textured material needs texture coordinates"),
        (
            |s| s.shapes[3].transform.steps.push(TransformStep::Scale(DVec3::new(1.0, 0.0, 1.0))),
            "rectangle: the transform is singular",
        ),
        (
            |s| s.shapes[3].motion = Some(Motion::new(vec![MotionStep::Scale(DVec3::ZERO)])),
            "rectangle: the scale shrinks the shape to nothing",
        ),
        (|s| s.shapes[4].geometry = Geometry::Box(Cuboid { min: DVec3::ONE, max: DVec3::ZERO }), "box: its numbers"),
        (
            |s| s.shapes[1].transform.steps = vec![TransformStep::Scale(DVec3::splat(1e10)); 2],
            "sphere: it reaches farther than 1e18",
        ),
        (|s| s.shapes[4].transform.steps = vec![TransformStep::Translate(DVec3::splat(7e17)); 2], "box: it reaches farther than"),
        (
            |s| s.shapes[3].motion = Some(Motion::new(vec![MotionStep::Scale(DVec3::splat(1e10)); 2])),
            "rectangle: the motion leaves the range of numbers",
        ),
        (
            |s| s.shapes[3].motion = Some(Motion::new(vec![MotionStep::Translate(DVec3::X * 6e17); 2])),
            "rectangle: the motion leaves the range of numbers",
        ),
        (
            |s| {
                s.shapes[3].transform.steps = vec![TransformStep::Translate(DVec3::X * 9e17)];
                s.shapes[3].motion = Some(Motion::new(vec![MotionStep::Translate(DVec3::X * 9e17)]));
            },
            "rectangle: it reaches farther than 1e18",
        ),
        (|s| s.camera.position = DVec3::Z * 1.1e18, "camera: it reaches farther than 1e18"),
        (
            |s| s.lights[0] = Light::Point(PointLight { position: DVec3::X * 1.1e18, intensity: Spectrum::WHITE, profile: None }),
            "light[0]: it reaches farther than 1e18",
        ),
        (|s| s.shapes[5].portal = true, "plane: a plane cannot be a portal"),
        (|s| s.shapes[5].geometry = Geometry::Plane(Plane { point: DVec3::ZERO, normal: DVec3::ZERO }), "plane: its numbers"),
        (
            |s| s.lights[0] = Light::Point(PointLight { position: DVec3::ONE, intensity: Spectrum::grey(-1.0), profile: None }),
            "light[0]: its light must be",
        ),
        (
            |s| s.lights[0] = Light::Point(PointLight { position: DVec3::NAN, intensity: Spectrum::WHITE, profile: None }),
            "light[0]: its position must be finite",
        ),
        (
            |s| {
                let (position, intensity) = (DVec3::ZERO, Spectrum::WHITE);
                s.lights[1] = Light::Spot(SpotLight {
                    position,
                    direction: DVec3::Y,
                    intensity,
                    angle_degrees: 10.0,
                    falloff_degrees: 20.0,
                    curve: Default::default(),
                    picture: None,
                    profile: None,
                });
            },
            "light[1]: its light falls off from 20 to 10 degrees",
        ),
        (
            |s| {
                let Light::Spot(spot) = &mut s.lights[1] else { panic!("it is a spot light") };
                spot.picture = Some(ProjectedTexture { texture: 99, up: DVec3::X });
            },
            "light[1]: there is no texture 99",
        ),
        (
            |s| {
                let Light::Spot(spot) = &mut s.lights[1] else { panic!("it is a spot light") };
                spot.picture = Some(ProjectedTexture { texture: 0, up: DVec3::Y });
            },
            "light[1]: its position must be",
        ),
        (
            |s| s.lights[2] = Light::Directional(DirectionalLight { direction: DVec3::ONE, irradiance: Spectrum::WHITE }),
            "light[2]: its position must be",
        ),
        (
            |s| {
                let image = ImageData { width: 3, ..(*pixels(4, 2)).clone() };
                s.lights[3] = environment(EnvironmentRadiance::Map(Arc::new(image)));
            },
            "light[3]: it has 8 texels and not 3 × 2",
        ),
        (
            |s| s.lights.push(environment(EnvironmentRadiance::Constant(Spectrum::WHITE))),
            "environment: a map or a sky is the scene's only",
        ),
    ];
    for (index, (change, words)) in cases.iter().enumerate() {
        let mut changed = scene();
        change(&mut changed);
        let error = changed.validate().expect_err(words).to_string();
        assert!(error.starts_with(words), "case {index}: `{error}` and not `{words}`");
    }
}

/// Twice the scene takes about twice the time, whatever its parts name: blends of blends, and shapes of all of them.
#[test]
fn it_takes_time_in_proportion_to_the_scene() {
    let chain = |length: usize| {
        let mut scene = scene();
        scene.shapes.retain(|shape| shape.label == "disk");
        let first = scene.materials.len();
        for id in first..first + length {
            // Each blend has one material of its own and the blend before.
            let before = if id == first { 0 } else { id - 1 };
            let weight = BlendWeight::Constant { value: 0.5 };
            scene.materials.push(material("chain", MaterialKind::Blend { materials: [2, before], weight }));
            let disk = Shape { material: id, ..scene.shapes[0].clone() };
            scene.shapes.push(disk);
        }
        scene
    };
    let seconds = |length: usize| {
        let scene = chain(length);
        let start = std::time::Instant::now();
        assert_eq!(scene.validate(), Ok(()));
        start.elapsed().as_secs_f64()
    };
    // The least of several, so that whatever else runs does not count.
    let least = |length: usize| (0..5).map(|_| seconds(length)).fold(f64::INFINITY, f64::min);
    // A busy machine lengthens one measurement now and then, and quadratic work all of them.
    let too_long = || Some([4_000, 32_000].map(least)).filter(|[short, long]| *long >= 32.0 * short + 0.01);
    let seconds: Vec<_> = (0..4).map_while(|_| too_long()).collect();
    assert!(seconds.len() < 4, "for 4,000 and 32,000 blends: {seconds:?}");
}
