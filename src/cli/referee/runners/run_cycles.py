"""Renders a glTF by Blender's Cycles: SCENE.glb OUTPUT.exr SPP SEED WIDTH HEIGHT."""

import sys

import bpy

scene_file, output, spp, seed, width, height = sys.argv[1:]
bpy.ops.wm.read_factory_settings(use_empty=True)
# Lights keep the numbers of the file, in the units that glTF states, and not those of an eye's sensitivity.
bpy.ops.import_scene.gltf(filepath=scene_file, export_import_convert_lighting_mode="COMPAT")
scene = bpy.context.scene
scene.camera = next(thing for thing in scene.objects if thing.type == "CAMERA")
scene.world = None
scene.render.engine = "CYCLES"
scene.cycles.samples, scene.cycles.seed = int(spp), int(seed)
scene.cycles.use_adaptive_sampling = scene.cycles.use_denoising = False
scene.cycles.sample_clamp_direct = scene.cycles.sample_clamp_indirect = 0
scene.cycles.pixel_filter_type = "BOX"
scene.cycles.max_bounces = scene.cycles.diffuse_bounces = scene.cycles.glossy_bounces = 64
scene.cycles.transmission_bounces = scene.cycles.transparent_max_bounces = 64
scene.render.resolution_x, scene.render.resolution_y = int(width), int(height)
scene.render.resolution_percentage = 100
scene.view_settings.view_transform = "Raw"
scene.render.image_settings.file_format = "OPEN_EXR"
scene.render.image_settings.color_depth = "32"
scene.render.filepath = output
bpy.ops.render.render(write_still=True)
