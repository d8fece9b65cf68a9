#!/usr/bin/env python3
"""Renders one scene with gpt and with Blender's Cycles, blend by blend, and says whether the pictures agree.

A sphere of flat facets stands on a floor under a lamp and a constant sky: a mesh that both read, so that neither its normals nor its
shading normals can differ. Its surface is diffuse and a rough metal that reflects everything, blended by the exact Fresnel equations
or by a constant, and rough gold alone. Two more cases must differ: Schlick's approximation against Cycles' exact equations, and a
constant that is off by 0.02.

Cycles is set to the same model: one bounce less than path edges minus one, GGX with single scattering (not Multiscatter GGX), roughness
√alpha, a box filter, no clamping, no filtering of gloss, no light threshold, no adaptive sampling, no denoiser, no light tree.

Both render the same number of seeds; the verdict is that of agreement.py. Exit status: 0 if every case came out as expected, else 7.
"""

import argparse
import math
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import bpy
import numpy as np
from mathutils import Matrix, Vector

from agreement import print_means, verdict
from export_cycles import new_tree, node

HERE = Path(__file__).resolve().parent

SIZE = (160, 120)
MAX_DEPTH = 6
POSITION, LOOK_AT, VFOV = (0.0, 1.6, 5.0), (0.0, 0.8, 0.0), 32.0
GROUND, BASE = (0.5, 0.45, 0.4), (0.1, 0.3, 0.6)
FLOOR = ((-8, 0, 8), (16, 0, 0), (0, 0, -16))
LAMP, LAMP_RADIANCE = ((-3.4, 3.4, 1.6), (0.7, 1.2, -0.8), (1.4, 0, 1.2)), (9.0, 8.0, 7.0)
SKY = (0.35, 0.38, 0.42)
ALPHA = 0.09
GOLD = {"eta": (0.143119, 0.374957, 1.44248), "k": (3.98316, 2.38572, 1.60322), "alpha": 0.4}

# Name, gpt's weight of the diffuse part (None: gold alone), Cycles' weight of it (a number, or the index of refraction of its Fresnel
# node), whether agreement is expected.
EXACT = '{ type = "fresnel", ior = 1.5, exact = true }'
CASES = [
    ("exact Fresnel", EXACT, {"ior": 1.5}, True),
    ("constant 0.7", '{ type = "constant", value = 0.7 }', {"value": 0.7}, True),
    ("rough gold", None, None, True),
    ("Schlick against exact Fresnel", EXACT.replace("true", "false"), {"ior": 1.5}, False),
    ("constant 0.72 against 0.7", '{ type = "constant", value = 0.72 }', {"value": 0.7}, False),
]


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--spp", type=int, default=1024, help="samples per pixel in all (default: 1024)")
    parser.add_argument("--seeds", type=int, default=8, help="replications they are split into, at least 2 (default: 8)")
    parser.add_argument("--alpha", type=float, default=0.01, help="level of each of the two verdicts (default: 0.01)")
    parser.add_argument("--gpt", type=Path, default=HERE.parents[1] / "target" / "release" / "gpt", help="the program")
    parser.add_argument("--device", default="auto", help="gpt's device (default: auto)")
    parser.add_argument("--only", help="cases whose name holds this")
    parser.add_argument("--picture", type=Path, help="a PNG of the agreeing cases: gpt left, Cycles in the middle, ten times the difference right")
    return parser.parse_args()


def sphere(columns=96, rows=48):
    """Positions and triangles, counter-clockwise from outside; radius 1, on the floor."""
    positions = [(0.0, 2.0, 0.0)]
    for row in range(1, rows):
        theta = math.pi * row / rows
        for column in range(columns):
            phi = 2 * math.pi * column / columns
            positions.append((math.sin(theta) * math.cos(phi), 1 + math.cos(theta), -math.sin(theta) * math.sin(phi)))
    positions.append((0.0, 0.0, 0.0))
    at = lambda row, column: 1 + (row - 1) * columns + column % columns  # noqa: E731
    faces = []
    for column in range(columns):
        faces.append((0, at(1, column), at(1, column + 1)))
        for row in range(1, rows - 1):
            a, b, c, d = at(row, column), at(row + 1, column), at(row + 1, column + 1), at(row, column + 1)
            faces += [(a, b, c), (a, c, d)]
        faces.append((at(rows - 1, column), len(positions) - 1, at(rows - 1, column + 1)))
    return positions, faces


# gpt


def write_scene(folder, weight, mesh):
    positions, faces = mesh
    with (folder / "sphere.obj").open("w", encoding="utf-8") as file:
        file.writelines(f"v {x:.7f} {y:.7f} {z:.7f}\n" for x, y, z in positions)
        file.writelines("f " + " ".join(str(index + 1) for index in face) + "\n" for face in faces)
    show = lambda values: "[" + ", ".join(f"{value:g}" for value in values) + "]"  # noqa: E731
    material = lambda name, kind, **keys: f'[[material]]\nname = "{name}"\ntype = "{kind}"\n' + "".join(f"{key} = {value}\n" for key, value in keys.items())  # noqa: E731
    rectangle = lambda name, corner, u, v: f'[[shape]]\ntype = "rectangle"\ncorner = {show(corner)}\nedge_u = {show(u)}\nedge_v = {show(v)}\nmaterial = "{name}"\n'  # noqa: E731
    gold = material("target", "conductor", eta=show(GOLD["eta"]), k=show(GOLD["k"]), alpha=GOLD["alpha"])
    blend = material("target", "blend", materials='["base", "gloss"]', weight=weight)
    parts = [
        f"[film]\nsize = {show(SIZE)}\n[render]\nmax_depth = {MAX_DEPTH}\n",
        f"[camera]\nposition = {show(POSITION)}\nlook_at = {show(LOOK_AT)}\nvfov = {VFOV}\n",
        material("base", "diffuse", reflectance=show(BASE)),
        material("gloss", "conductor", reflectance=1, alpha=ALPHA),
        material("ground", "diffuse", reflectance=show(GROUND)),
        material("lamp", "emissive", radiance=show(LAMP_RADIANCE)),
        gold if weight is None else blend,
        '[[shape]]\ntype = "mesh"\nfile = "sphere.obj"\nsmooth = false\nmaterial = "target"\n',
        rectangle("ground", *FLOOR),
        rectangle("lamp", *LAMP),
        f'[[light]]\ntype = "environment"\nradiance = {show(SKY)}\n',
    ]
    path = folder / "scene.toml"
    path.write_text("\n".join(parts), encoding="utf-8")
    return path


def render_gpt(options, scene, seed):
    picture = scene.with_name("gpt.exr")
    spp = options.spp // options.seeds
    run = [options.gpt, "render", scene, "--device", options.device, "--quiet", "--strict", "--spp", spp, "--seed", seed, "-o", picture]
    subprocess.run([str(part) for part in run], check=True)
    return read(picture)


# Cycles


def finish(tree, shader):
    node(tree, "ShaderNodeOutputMaterial", {"Surface": shader.outputs[0]})


def diffuse(tree, colour):
    return node(tree, "ShaderNodeBsdfDiffuse", {"Color": (*colour, 1), "Roughness": 0.0})


def target_material(weight):
    material = bpy.data.materials.new("target")
    tree = new_tree(material)
    if weight is None:
        optics = {"IOR": GOLD["eta"], "Extinction": GOLD["k"], "Roughness": math.sqrt(GOLD["alpha"]), "Anisotropy": 0.0}
        finish(tree, node(tree, "ShaderNodeBsdfMetallic", optics, distribution="GGX", fresnel_type="PHYSICAL_CONDUCTOR"))
        return material
    base = diffuse(tree, BASE)
    gloss = node(tree, "ShaderNodeBsdfAnisotropic", {"Color": (1, 1, 1, 1), "Roughness": math.sqrt(ALPHA), "Anisotropy": 0.0}, distribution="GGX")
    # The mix node's factor is the weight of its second shader.
    factor = node(tree, "ShaderNodeFresnel", {"IOR": weight["ior"]}).outputs[0] if "ior" in weight else 1 - weight["value"]
    mix = node(tree, "ShaderNodeMixShader", {"Fac": factor})
    tree.links.new(base.outputs[0], mix.inputs[1])
    tree.links.new(gloss.outputs[0], mix.inputs[2])
    finish(tree, mix)
    return material


def lamp_material():
    """Emits to the front only."""
    material = bpy.data.materials.new("lamp")
    tree = new_tree(material)
    back = node(tree, "ShaderNodeNewGeometry").outputs["Backfacing"]
    front = node(tree, "ShaderNodeMath", {0: 1.0, 1: back}, operation="SUBTRACT")
    finish(tree, node(tree, "ShaderNodeEmission", {"Color": (*LAMP_RADIANCE, 1), "Strength": front.outputs[0]}))
    return material


def ground_material():
    material = bpy.data.materials.new("ground")
    tree = new_tree(material)
    finish(tree, diffuse(tree, GROUND))
    return material


def add_mesh(name, positions, faces, material):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(positions, [], faces)
    mesh.materials.append(material)
    bpy.context.scene.collection.objects.link(bpy.data.objects.new(name, mesh))


def add_rectangle(name, rectangle, material):
    corner, u, v = (np.array(part, dtype=float) for part in rectangle)
    add_mesh(name, [tuple(corner), tuple(corner + u), tuple(corner + u + v), tuple(corner + v)], [(0, 1, 2, 3)], material)


def set_camera(scene):
    back = (Vector(POSITION) - Vector(LOOK_AT)).normalized()
    right = Vector((0, 1, 0)).cross(back).normalized()
    up = back.cross(right)
    camera = bpy.data.cameras.new("camera")
    camera.sensor_fit, camera.sensor_height = "VERTICAL", 24.0
    camera.lens = 12.0 / math.tan(math.radians(VFOV) / 2)
    camera.clip_start, camera.clip_end = 1e-3, 1e4
    scene.camera = bpy.data.objects.new("camera", camera)
    scene.camera.matrix_world = Matrix.Translation(POSITION) @ Matrix((right, up, back)).transposed().to_4x4()
    scene.collection.objects.link(scene.camera)


def set_cycles(scene, spp):
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.device, cycles.samples = "CPU", spp
    bounces = MAX_DEPTH - 2  # none: light sources seen directly and direct lighting, two edges
    for kind in ("max", "diffuse", "glossy", "transmission"):
        setattr(cycles, f"{kind}_bounces", bounces)
    cycles.pixel_filter_type = "BOX"
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0.0
    cycles.blur_glossy = 0.0
    cycles.light_sampling_threshold = 0.0
    cycles.use_adaptive_sampling = cycles.use_denoising = cycles.use_light_tree = cycles.use_guiding = False
    cycles.caustics_reflective = cycles.caustics_refractive = True
    render = scene.render
    render.resolution_x, render.resolution_y, render.resolution_percentage = *SIZE, 100
    render.threads_mode, render.threads = "FIXED", os.cpu_count()
    render.image_settings.file_format, render.image_settings.color_depth = "OPEN_EXR", "32"


def build_cycles(weight, mesh, spp):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    add_mesh("sphere", *mesh, target_material(weight))
    add_rectangle("floor", FLOOR, ground_material())
    add_rectangle("lamp", LAMP, lamp_material())
    scene.world = bpy.data.worlds.new("sky")
    tree = new_tree(scene.world)
    background = node(tree, "ShaderNodeBackground", {"Color": (*SKY, 1), "Strength": 1.0})
    node(tree, "ShaderNodeOutputWorld", {"Surface": background.outputs[0]})
    set_camera(scene)
    set_cycles(scene, spp)
    return scene


def render_cycles(scene, folder, seed):
    scene.cycles.seed = seed
    scene.render.filepath = str(folder / "cycles.exr")
    # Blender writes its progress to the process's standard output.
    kept = os.dup(1)
    with open(os.devnull, "w", encoding="utf-8") as nowhere:
        sys.stdout.flush()
        os.dup2(nowhere.fileno(), 1)
        try:
            bpy.ops.render.render(write_still=True)
        finally:
            os.dup2(kept, 1)
            os.close(kept)
    return read(folder / "cycles.exr")


# Both


def read(path):
    """Rows from the top, RGB."""
    image = bpy.data.images.load(str(path), check_existing=False)
    width, height = image.size
    pixels = np.empty(width * height * image.channels, dtype=np.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    return pixels.reshape(height, width, -1)[::-1, :, :3].astype(np.float64)


def write_png(path, picture):
    encoded = np.where(picture <= 0.0031308, 12.92 * picture, 1.055 * np.maximum(picture, 1e-9) ** (1 / 2.4) - 0.055)
    height, width, _ = picture.shape
    image = bpy.data.images.new("comparison", width, height)
    rgba = np.ones((height, width, 4), dtype=np.float32)
    rgba[..., :3] = np.clip(encoded, 0, 1)[::-1]
    image.pixels.foreach_set(rgba.ravel())
    image.filepath_raw, image.file_format = str(path.resolve()), "PNG"
    image.save()


def main():
    options = arguments()
    surprises, rows, mesh, known = [], [], sphere(), {}
    for name, ours, theirs, agrees in CASES:
        if options.only and options.only not in name:
            continue
        print(f"\n== {name}; {'agreement' if agrees else 'a difference'} is expected", flush=True)
        with tempfile.TemporaryDirectory() as folder:
            path = write_scene(Path(folder), ours, mesh)
            our_pictures = np.stack([render_gpt(options, path, seed) for seed in range(options.seeds)])
            if str(theirs) not in known:
                scene = build_cycles(theirs, mesh, options.spp // options.seeds)
                known[str(theirs)] = np.stack([render_cycles(scene, Path(folder), seed) for seed in range(options.seeds)])
            their_pictures = known[str(theirs)]
        print_means("gpt", our_pictures)
        print_means("Cycles", their_pictures)
        if verdict("Cycles", our_pictures, their_pictures, options.alpha) != (0 if agrees else 7):
            surprises.append(name)
        if agrees:
            first, second = our_pictures.mean(axis=0), their_pictures.mean(axis=0)
            rows.append(np.concatenate([first, second, 10 * np.abs(first - second)], axis=1))
    if options.picture and rows:
        write_png(options.picture, np.concatenate(rows))
    print(f"\nBlender {bpy.app.version_string}; not as expected: {', '.join(surprises) or 'none'}")
    return 7 if surprises else 0


if __name__ == "__main__":
    sys.exit(main())
