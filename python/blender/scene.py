"""A scene of Blender as a scene file: what belongs to it, in the order in which it is written."""

import numpy

from . import camera, engine, lamps, settings, world
from .links import Links
from .materials import Materials
from .meshes import Meshes
from .report import Report
from .scene_file import SceneFile
from .values import Values, mean

SURFACES = ("MESH", "CURVE", "SURFACE", "META", "FONT")
SILENT = ("CAMERA", "EMPTY", "ARMATURE", "LATTICE", "SPEAKER", "LIGHT_PROBE")


def export(scene, path):
    """Writes the scene file and what it refers to; returns the report and flags for a preview as Blender would show it."""
    file, report = SceneFile(path), Report()
    baked = {}
    if scene.world is not None:
        # A render within a render is not possible: a world that needs Cycles is looked at first.
        world.export(scene.world, SceneFile(path), Report(), lambda of, size: baked.setdefault("picture", engine.bake_world(of, size)))
    flags = settings.export(scene, file, report)
    if scene.camera is None:
        raise ValueError("the scene has no camera: add one, or choose one in the scene's properties")
    engine.with_render_depsgraph(scene, lambda depsgraph: _objects(scene, depsgraph, file, report))
    world.export(scene.world, file, report, lambda of, size: baked["picture"])
    comments = ["Exported from Blender."]
    if flags:
        comments.append("As Blender shows it: gpt render " + " ".join(flags))
    if report.lines:
        comments += ["What could not be said:", *[f"- {line}" for line in report.lines]]
    file.write(comments)
    return report, flags


def _objects(scene, depsgraph, file, report):
    evaluated_camera = scene.camera.evaluated_get(depsgraph)
    camera.export(scene, evaluated_camera, file, report)
    links = Links(scene, report)
    found = Meshes(file, Materials(file, report), report)
    waiting, corners = [], []
    for instance in depsgraph.object_instances:
        thing = instance.object
        if not instance.show_self:
            continue
        if thing.type == "LIGHT":
            waiting.append(_Kept(thing, numpy.array(instance.matrix_world)))
        elif thing.type in SURFACES:
            if found.add(instance, _key(thing), links.receiver(thing)):
                box = numpy.array([[*corner, 1] for corner in thing.bound_box])
                corners.append((box @ numpy.array(instance.matrix_world).T)[:, :3])
        elif thing.type not in SILENT:
            report.add(f"object {thing.name}", f"an object of the type {thing.type}", "left out")
        if thing.particle_systems and any(system.settings.type == "HAIR" and system.settings.render_type == "PATH" for system in thing.particle_systems):
            report.add(f"object {thing.name}", "hair", "left out")
    found.write()
    corners = numpy.concatenate(corners) if corners else numpy.zeros((1, 3))
    corners = numpy.concatenate([corners, [evaluated_camera.matrix_world.translation[:]]])
    middle = (corners.min(axis=0) + corners.max(axis=0)) / 2
    sphere = middle, float(numpy.linalg.norm(corners - middle, axis=1).max())
    for lamp in waiting:
        lamps.export(lamp, file, report, sphere, lamp_factor(report), links)


class _Kept:
    """A lamp of the dependency graph, whose instances are valid for one step of the loop alone."""

    def __init__(self, thing, matrix):
        self.object, self.matrix_world = thing, matrix


def _key(thing):
    """What is equal for places that show the same mesh with the same materials."""
    data = thing.data
    slots = tuple(slot.material.name_full if slot.material else None for slot in thing.material_slots)
    # An evaluated mesh that modifiers made belongs to its object alone; else linked duplicates share the original's.
    original = thing.original
    own = original.name_full if len(original.modifiers) or thing.type != "MESH" else None
    return thing.type, data.name_full, data.as_pointer(), own, slots, thing.visible_camera


def lamp_factor(report):
    """Reads what a lamp's nodes multiply its power by."""

    def factor(lamp, where):
        values = Values(report, where)
        emission = next((node for node in lamp.node_tree.nodes if node.type == "EMISSION"), None)
        if emission is None:
            return numpy.ones(3)
        color = values.color(emission.inputs["Color"])
        strength = values.constant(emission.inputs["Strength"], emission, "Strength")
        return numpy.array(mean(color)[:3], dtype=float) * strength

    return factor
