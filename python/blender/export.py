"""Writes an opened .blend as a scene file of gpt:

    blender --background file.blend --python python/blender/export.py -- out.toml
    python3 python/blender/export.py file.blend out.toml       (with the package bpy)

What a scene file cannot say is printed, a line each, and stands at the top of it.
"""

import importlib.util
import os
import sys


def package():
    """This folder as a Python package, whatever it is called and wherever it lies."""
    folder = os.path.dirname(os.path.abspath(__file__))
    spec = importlib.util.spec_from_file_location(
        "gpt_blender", os.path.join(folder, "__init__.py"), submodule_search_locations=[folder])
    module = importlib.util.module_from_spec(spec)
    sys.modules["gpt_blender"] = module
    spec.loader.exec_module(module)
    return module


def main(arguments):
    try:
        import bpy
    except ImportError:
        sys.exit("export.py: Blender's module bpy is not there: run it by `blender --background FILE --python export.py -- OUT.toml`, or `pip install bpy`")
    if len(arguments) == 2:
        bpy.ops.wm.open_mainfile(filepath=arguments.pop(0))
    if len(arguments) != 1 or not arguments[0].endswith(".toml"):
        sys.exit("export.py: one name is needed, of the scene file to write: OUT.toml")
    package()
    from gpt_blender.scene import export

    try:
        report, flags = export(bpy.context.scene, arguments[0])
    except ValueError as error:
        sys.exit(f"export.py: {error}")
    print(f"{arguments[0]} is written; as Blender shows it: gpt render {arguments[0]} {' '.join(flags)}")
    for line in report.lines:
        print(f"could not be said: {line}")


if __name__ == "__main__":
    main(sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else sys.argv[1:])
