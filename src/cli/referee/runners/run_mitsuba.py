"""Renders a scene of Mitsuba 3: SCENE.xml OUTPUT.exr SPP SEED VARIANT."""

import sys

import mitsuba as mi

scene_file, output, spp, seed, variant = sys.argv[1:]
mi.set_variant(variant)
scene = mi.load_file(scene_file)
picture = mi.render(scene, spp=int(spp), seed=int(seed))
mi.Bitmap(picture).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, srgb_gamma=False).write(output)
