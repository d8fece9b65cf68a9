"""Materials of Blender as materials of a scene file, each written once."""

import numpy

from .scene_file import grey
from .shaders import READERS
from .surfaces import Scaled, Surfaces
from .values import Constant, Mesh, Picture, Textures, Values

COLORS_TO_1 = ("reflectance", "transmittance", "base_color", "specular_reflectance", "sheen_color", "diffuse_transmission_color")
COLORS = (*COLORS_TO_1, "emission", "radiance", "specular_color", "eta", "k")


class Materials:
    """Writes each material once; one that shows colours of a mesh's corners once for each mesh."""

    def __init__(self, file, report):
        self._file, self._report = file, report
        self._textures = Textures(file, report)
        self._known = {}

    def of(self, material, mesh, found, where, hidden=False):
        """Name of a Blender material's entry, and the source of its textures' coordinates or None."""
        key = (None if material is None else material.name_full, hidden)
        if key in self._known:
            return self._known[key]
        context = Mesh(mesh, found, where)
        name = "default" if material is None else material.name
        values = Values(self._report, f"material {name}", context)
        surface = Surfaces(values, READERS).of_material(material)
        if hidden:
            surface = {"type": "blend", "materials": [{"type": "pass"}, surface], "weight": {"type": "camera"}}
        sources = []
        entry = self._finished(surface, f"material {name}", sources)
        if len(set(sources)) > 1:
            self._report.add(f"material {name}", f"textures by {len(set(sources))} sets of coordinates", f"all by {' '.join(sources[0])}")
        result = self._file.add_material(entry, name), sources[0] if sources else None
        if not context.used:
            self._known[key] = result
        return result

    def _finished(self, entry, where, sources):
        """The entry as the scene file has it."""
        result = {}
        for key, value in entry.items():
            if key == "materials":
                result[key] = [self._finished(part, where, sources) for part in value]
            elif key == "weight":
                result[key] = self._finished_weight(value, where, sources)
            elif key in ("anisotropy", "alpha_u"):
                # Directions along a surface are those of its texture coordinates.
                sources.append(("uv", ""))
                result[key] = value
            elif key in ("normal_map", "bump_map"):
                result[key] = self._texture(value, where, sources)["texture"]
            elif isinstance(value, Constant):
                color = numpy.maximum(value.pixels[:3].astype(float), 0)
                color = numpy.minimum(color, 1) if key in COLORS_TO_1 else color
                result[key] = grey(color) if key in COLORS else float(value.pixels[0])
                if key not in COLORS and key != "normal_scale":
                    result[key] = min(max(result[key], 0.0), 1.0)
            elif isinstance(value, Picture):
                result[key] = self._texture(self._limited(key, value, where), where, sources)
                if key not in COLORS and "channel" not in result[key]:
                    result[key]["channel"] = "r"
            elif isinstance(value, Scaled):
                result[key] = self._texture(self._limited(key, value.picture, where), where, sources)
                if not numpy.allclose(value.factor, 1):
                    result[key]["factor"] = grey(value.factor)
            else:
                result[key] = value
        return result

    def _finished_weight(self, weight, where, sources):
        if isinstance(weight.get("texture"), Picture):
            texture = self._texture(weight["texture"], where, sources)
            return {**weight, "texture": texture["texture"], "channel": texture.get("channel", "r")}
        if "of" in weight:
            return {**weight, "of": self._finished_weight(weight["of"], where, sources)}
        return weight

    def _limited(self, key, picture, where):
        """A picture of shares, from 0 to 1, and of light, which is not negative."""
        if picture.image is not None and not picture.image.is_float:
            return picture
        pixels = picture.pixels
        most = numpy.inf if key in COLORS and key not in COLORS_TO_1 else 1.0
        if pixels[..., :3].min() >= 0 and pixels[..., :3].max() <= most:
            return picture
        self._report.add(where, f"texels of {picture.name} beyond what a {key} can be", f"limited to {'0 and more' if most > 1 else '0 to 1'}")
        return picture.with_pixels(numpy.clip(pixels, 0, most))

    def _texture(self, picture, where, sources):
        sources.append(picture.source)
        reference = {"texture": self._textures.name(picture, where)}
        if picture.channel is not None:
            reference["channel"] = picture.channel
        return reference
