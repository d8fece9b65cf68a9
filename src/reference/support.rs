//! What the reference integrator renders. What it does not, it refuses by name.

use crate::renderer::RenderError;
use crate::scene::settings::{MOST_LIGHT_SAMPLES, MOST_LIGHT_SAMPLES_DEPTH};
use crate::scene::{
    ColorInput, EnvironmentRadiance, Geometry, Heuristic, Light, Material, MaterialId, MaterialKind, Mesh, Scene, Shape,
    TextureId, TextureKind, check_blends,
};

/// Checks that every index of the scene is in range and that nothing is used that the reference cannot render.
pub fn check(scene: &Scene) -> Result<(), RenderError> {
    settings(scene).map_err(RenderError::Internal)?;
    scene.materials.iter().try_for_each(|m| material(scene, m)).map_err(RenderError::Internal)?;
    let exists = |id: &MaterialId| *id < scene.materials.len();
    if let Some(missing) = scene.materials.iter().flat_map(|material| material.parts()).find(|id| !exists(id)) {
        return Err(RenderError::Internal(format!("there is no material {missing}")));
    }
    check_blends(&scene.materials).map_err(|(_, message)| RenderError::Internal(message))?;
    scene.shapes.iter().try_for_each(|s| shape(scene, s)).map_err(RenderError::Internal)?;
    scene.lights.iter().try_for_each(light).map_err(RenderError::Internal)
}

/// What is wrong, in words.
type Check = Result<(), String>;

fn settings(scene: &Scene) -> Check {
    let settings = &scene.render;
    if scene.film.size.contains(&0) {
        return Err("the picture has no pixels".into());
    }
    if !(1..=MOST_LIGHT_SAMPLES).contains(&settings.light_samples) {
        return Err(format!(
            "{} light samples at a path's first surface; 1 to {MOST_LIGHT_SAMPLES} are possible",
            settings.light_samples
        ));
    }
    if !(1..=MOST_LIGHT_SAMPLES_DEPTH).contains(&settings.light_samples_depth) {
        return Err(format!(
            "several light samples at the surfaces of {} edges; 1 to {MOST_LIGHT_SAMPLES_DEPTH} are possible",
            settings.light_samples_depth
        ));
    }
    if settings.max_depth == 0 && settings.roulette_depth == 0 {
        return Err("paths never end: max_depth and roulette_depth are both 0".into());
    }
    Ok(())
}

fn material(scene: &Scene, material: &Material) -> Check {
    if let Some(id) = material.normal_map {
        texture(scene, id)?;
    }
    if let Some(emission) = &material.emission {
        color(scene, &emission.radiance)?;
    }
    match &material.kind {
        MaterialKind::Glass { ior, .. } | MaterialKind::RoughGlass { ior, .. } if !(ior.is_finite() && *ior > 0.0) => {
            Err(format!("{}: the index of refraction must be positive", material.name))
        }
        MaterialKind::Blend { materials, weight } => {
            let has_map = |id: &MaterialId| scene.materials.get(*id).is_some_and(|part| part.normal_map.is_some());
            if materials.iter().any(has_map) {
                return Err(format!("{}: the normal map of a blend is its own, not that of a part", material.name));
            }
            heuristic(scene, weight)
        }
        kind => kind.colors().try_for_each(|input| color(scene, &input)),
    }
}

fn heuristic(scene: &Scene, heuristic: &Heuristic) -> Check {
    match heuristic {
        Heuristic::Texture { texture: id } => texture(scene, *id),
        Heuristic::Reverse { of } | Heuristic::Threshold { of, .. } => self::heuristic(scene, of),
        Heuristic::Constant { .. } | Heuristic::Facing { .. } | Heuristic::Fresnel { .. } => Ok(()),
    }
}

fn color(scene: &Scene, input: &ColorInput) -> Check {
    match input {
        ColorInput::Constant(_) => Ok(()),
        ColorInput::Texture(id) | ColorInput::ScaledTexture(id, _) | ColorInput::SquaredTexture(id) => texture(scene, *id),
    }
}

fn texture(scene: &Scene, id: TextureId) -> Check {
    let texture = scene.textures.get(id).ok_or_else(|| format!("there is no texture {id}"))?;
    let TextureKind::Image(texture) = &texture.kind else { return Ok(()) };
    let image = &texture.image;
    let texels = u64::from(image.width) * u64::from(image.height);
    if texels == 0 || texels != image.texels.len() as u64 {
        return Err(format!("texture {id} has {} texels and not {} × {}", image.texels.len(), image.width, image.height));
    }
    Ok(())
}

fn shape(scene: &Scene, shape: &Shape) -> Check {
    shape.check_motion(scene.camera.shutter).map_err(|(_, message)| format!("{}: {message}", shape.label))?;
    let determinant = shape.transform.to_affine().matrix3.determinant();
    if determinant == 0.0 || !determinant.is_finite() {
        return Err(format!("{}: the transform is singular", shape.label));
    }
    let has_uv = match &shape.geometry {
        Geometry::Mesh(mesh) => {
            indices(&shape.label, mesh)?;
            mesh.face_materials.iter().try_for_each(|&id| material_exists(scene, shape, id))?;
            !mesh.uvs.is_empty()
        }
        Geometry::Disk { .. } | Geometry::Plane { .. } => false,
        Geometry::Sphere { .. } | Geometry::Rectangle { .. } | Geometry::Box { .. } => true,
    };
    material_exists(scene, shape, shape.material)?;
    if !has_uv && materials_of(shape).into_iter().any(|id| scene.uses_texture(id)) {
        return Err(format!("{}: a textured material needs texture coordinates", shape.label));
    }
    Ok(())
}

fn material_exists(scene: &Scene, shape: &Shape, id: MaterialId) -> Check {
    if id < scene.materials.len() { Ok(()) } else { Err(format!("{}: there is no material {id}", shape.label)) }
}

fn materials_of(shape: &Shape) -> Vec<MaterialId> {
    match &shape.geometry {
        Geometry::Mesh(mesh) if !mesh.face_materials.is_empty() => {
            let mut ids = mesh.face_materials.clone();
            ids.sort_unstable();
            ids.dedup();
            ids
        }
        _ => vec![shape.material],
    }
}

/// Every list of a mesh is as long as the others need it.
fn indices(label: &str, mesh: &Mesh) -> Check {
    let vertices = mesh.positions.len();
    if mesh.faces.iter().flatten().any(|&vertex| vertex as usize >= vertices) {
        return Err(format!("{label}: a face names a vertex beyond the last, {}", vertices.saturating_sub(1)));
    }
    let fits = |length: usize, needed: usize| length == 0 || length == needed;
    if !fits(mesh.normals.len(), vertices) || !fits(mesh.uvs.len(), vertices) {
        return Err(format!("{label}: normals and uvs must be as many as positions"));
    }
    if !fits(mesh.face_materials.len(), mesh.faces.len()) {
        return Err(format!("{label}: face materials must be as many as faces"));
    }
    Ok(())
}

fn light(light: &Light) -> Check {
    let Light::Environment(environment) = light else { return Ok(()) };
    let EnvironmentRadiance::Map(image) = &environment.radiance else { return Ok(()) };
    let texels = u64::from(image.width) * u64::from(image.height);
    if texels == 0 || texels != image.texels.len() as u64 {
        return Err(format!("the environment has {} texels and not {} × {}", image.texels.len(), image.width, image.height));
    }
    Ok(())
}
