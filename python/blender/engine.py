"""The scene as Blender renders it: modifiers, visibility and instances of a render, which only a render engine is shown.

An engine of our own is run for one moment; what it is handed is exported, and nothing is rendered.
"""

import os
import tempfile

import bpy
import numpy


def with_render_depsgraph(scene, work):
    """Calls `work(depsgraph)` within a render of the scene, and returns its result."""
    results = []

    class Exporter(bpy.types.RenderEngine):
        bl_idname = "GPT_EXPORT"
        bl_label = "gpt (export)"
        bl_use_preview = False

        def render(self, depsgraph):
            try:
                results.append((work(depsgraph), None))
            except Exception as error:  # Blender prints what an engine raises and goes on.
                results.append((None, error))

    bpy.utils.register_class(Exporter)
    render = scene.render
    kept = {name: getattr(render, name) for name in ("engine", "use_compositing", "use_sequencer")}
    try:
        # No picture is made, so nothing is done to it.
        render.engine = "GPT_EXPORT"
        render.use_compositing = render.use_sequencer = False
        bpy.ops.render.render(write_still=False, scene=scene.name)
    finally:
        for name, value in kept.items():
            setattr(render, name, value)
        bpy.utils.unregister_class(Exporter)
    if not results:
        raise RuntimeError("Blender has not rendered: the scene needs a camera and a view layer that is rendered")
    result, error = results[0]
    if error is not None:
        raise error
    return result


def bake_world(world, size):
    """A lat-long picture of a world by Cycles, rows from the top, in Blender's orientation."""
    scene = bpy.data.scenes.new("gpt world")
    data = bpy.data.cameras.new("gpt world")
    camera = bpy.data.objects.new("gpt world", data)
    folder = tempfile.mkdtemp(prefix="gpt-world-")
    path = os.path.join(folder, "world.exr")
    try:
        scene.collection.objects.link(camera)
        scene.camera, scene.world = camera, world
        data.type = "PANO"
        data.panorama_type = "EQUIRECTANGULAR"
        # Upright, facing x: the middle of Blender's environment maps.
        camera.rotation_euler = (numpy.pi / 2, 0, -numpy.pi / 2)
        scene.render.engine = "CYCLES"
        scene.cycles.samples = 1
        scene.cycles.use_denoising = scene.cycles.use_adaptive_sampling = False
        scene.cycles.pixel_filter_type = "BOX"
        scene.render.resolution_x, scene.render.resolution_y = size
        scene.render.image_settings.file_format = "OPEN_EXR"
        scene.render.image_settings.color_depth = "32"
        scene.render.filepath = path
        bpy.ops.render.render(write_still=True, scene=scene.name)
        image = bpy.data.images.load(path)
        pixels = numpy.empty(4 * size[0] * size[1], dtype=numpy.float32)
        image.pixels.foreach_get(pixels)
        bpy.data.images.remove(image)
        return pixels.reshape(size[1], size[0], 4)[::-1]
    finally:
        bpy.data.scenes.remove(scene)
        bpy.data.objects.remove(camera)
        bpy.data.cameras.remove(data)
        if os.path.exists(path):
            os.remove(path)
        os.rmdir(folder)
