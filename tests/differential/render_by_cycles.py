"""Renders glTF files by Blender's own importer and Cycles: render_by_cycles.py JOBS.json, of which each has a scene, a size, a depth and an array
to write, of renders that differ in their random numbers. Runs in a Python that has bpy."""

import json
import sys
import tempfile
from pathlib import Path

import bpy
import numpy

RENDERS, SAMPLES = 8, 64


def render(job):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    # Candela and lux as they are written, without a division by 683 lm/W.
    bpy.ops.import_scene.gltf(filepath=job["scene"], export_import_convert_lighting_mode="COMPAT")
    scene = bpy.context.scene
    scene.camera = next(thing for thing in scene.objects if thing.type == "CAMERA")
    scene.render.engine = "CYCLES"
    scene.render.resolution_x, scene.render.resolution_y = job["size"]
    scene.render.resolution_percentage = 100
    cycles = scene.cycles
    cycles.device, cycles.samples, cycles.use_adaptive_sampling, cycles.use_denoising = "CPU", SAMPLES, False, False
    cycles.pixel_filter_type, cycles.filter_width = "BOX", 1.0
    cycles.max_bounces = job["depth"] - 1
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    # Point lights without extent.
    for lamp in bpy.data.lights:
        if lamp.type in ("POINT", "SPOT"):
            lamp.shadow_soft_size = 0
        elif lamp.type == "SUN":
            lamp.angle = 0
    scene.world = bpy.data.worlds.new("black")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0
    for material in bpy.data.materials:
        for node in material.node_tree.nodes if material.node_tree else ():
            if node.type == "BSDF_PRINCIPLED":
                # Scatters once, as Appendix B has it.
                node.distribution = "GGX"
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.render.image_settings.exr_codec = "NONE"
    pictures = []
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(RENDERS):
            cycles.seed = seed
            scene.render.filepath = str(Path(folder) / "picture.exr")
            bpy.ops.render.render(write_still=True)
            image = bpy.data.images.load(scene.render.filepath)
            values = numpy.array(image.pixels[:], numpy.float64).reshape(job["size"][1], job["size"][0], -1)[::-1, :, :3]
            bpy.data.images.remove(image)
            pictures.append(values)
    numpy.save(job["out"], numpy.array(pictures))


for job in json.loads(Path(sys.argv[1]).read_text()):
    try:
        render(job)
    except Exception as error:
        print(f"{job['scene']}: {error}", file=sys.stderr)
