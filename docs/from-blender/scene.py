"""The scene of docs/from-blender.md, made and exported by Blender 5.0 (the package bpy), and rendered by Cycles for comparison:

    python3 scene.py            makes scene.glb
    python3 scene.py cycles     and cycles.jpg
"""

import math
import sys
from pathlib import Path

import bpy

HERE = Path(__file__).resolve().parent


def material(name, color, **inputs):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    shader = made.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (*color, 1)
    for key, value in inputs.items():
        shader.inputs[key.replace("_", " ")].default_value = value
    return made


def finish(name, of):
    bpy.context.object.name = name
    bpy.context.object.data.materials.append(of)


bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.mesh.primitive_plane_add(size=16)
finish("Floor", material("Floor", (0.45, 0.42, 0.38), Roughness=0.6))

bpy.ops.mesh.primitive_monkey_add(size=1.8, location=(0, 0, 0.87), rotation=(math.radians(-32), 0, math.radians(20)))
modifier = bpy.context.object.modifiers.new("Subdivision", "SUBSURF")
modifier.levels = modifier.render_levels = 1
bpy.ops.object.shade_smooth()
finish("Suzanne", material("Lacquer", (0.75, 0.2, 0.04), Roughness=0.25))

bpy.ops.mesh.primitive_uv_sphere_add(radius=0.5, location=(-1.25, -0.75, 0.5), segments=48, ring_count=24)
bpy.ops.object.shade_smooth()
finish("Gold", material("Gold", (1.0, 0.77, 0.34), Metallic=1.0, Roughness=0.2))

bpy.ops.mesh.primitive_plane_add(size=1.6, location=(2.2, -1.8, 3.2), rotation=(math.radians(145), math.radians(35), 0))
finish("Lamp", material("Lamp", (0, 0, 0), Emission_Color=(1.0, 0.85, 0.7, 1), Emission_Strength=22.0))

bpy.ops.object.light_add(type="POINT", location=(-3, -2.5, 3))
bpy.context.object.data.energy = 120
bpy.context.object.data.color = (0.6, 0.75, 1.0)
bpy.context.object.data.shadow_soft_size = 0

bpy.ops.object.camera_add(location=(0.4, -6.6, 2.1), rotation=(math.radians(80.5), 0, math.radians(3)))
bpy.context.object.data.angle = math.radians(34)
scene = bpy.context.scene
scene.camera = bpy.context.object
scene.render.resolution_x, scene.render.resolution_y = 480, 270
scene.world = bpy.data.worlds.new("Grey")
scene.world.use_nodes = True
scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.05, 0.05, 0.05, 1)

bpy.ops.export_scene.gltf(
    filepath=str(HERE / "scene.glb"),
    export_apply=True,  # modifiers
    export_cameras=True,
    export_lights=True,
    export_import_convert_lighting_mode="COMPAT",  # "Unitless": watts stay watts
)

if sys.argv[1:] == ["cycles"]:
    scene.render.engine = "CYCLES"
    scene.cycles.samples = 128
    scene.cycles.use_denoising = False
    scene.view_settings.view_transform = "AgX"
    scene.render.image_settings.file_format = "JPEG"
    scene.render.filepath = str(HERE / "cycles.jpg")
    bpy.ops.render.render(write_still=True)
