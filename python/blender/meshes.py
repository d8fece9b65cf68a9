"""Meshes with their modifiers applied, as PLY files; instances share theirs."""

import numpy

from .scene_file import TO_Y_UP, steps


def corners(mesh):
    """The corners of a mesh's triangles: indices of loops and vertices, positions, normals, and the triangles' material slots."""
    mesh.calc_loop_triangles()
    count = len(mesh.loop_triangles)
    loops = _read(mesh.loop_triangles, "loops", 3 * count, numpy.int32)
    slots = _read(mesh.loop_triangles, "material_index", count, numpy.int32)
    vertices = _read(mesh.loops, "vertex_index", len(mesh.loops), numpy.int32)[loops]
    positions = _read(mesh.vertices, "co", 3 * len(mesh.vertices), numpy.float32).reshape(-1, 3)[vertices]
    normals = _read(mesh.corner_normals, "vector", 3 * len(mesh.loops), numpy.float32).reshape(-1, 3)[loops]
    return {"loops": loops, "vertices": vertices, "positions": positions, "normals": normals, "slots": slots}


def _read(collection, name, count, kind):
    values = numpy.empty(count, dtype=kind)
    collection.foreach_get(name, values)
    return values


def uv_of(mesh, found, source, generated):
    """Texture coordinates of all corners: of a map, `source` = ("uv", name), or of x and y where the corner lies, ("generated",), ("object",)."""
    if source[0] == "generated":
        low, size = generated
        return (found["positions"][:, :2] - low[:2]) / size[:2]
    if source[0] == "object":
        return found["positions"][:, :2]
    if source[0] == "blocks":
        return block_uvs(len(found["slots"]))
    layer = mesh.uv_layers.get(source[1]) if source[1] else None
    if layer is None:
        layer = next((layer for layer in mesh.uv_layers if layer.active_render), None)
    if layer is None:
        return None
    return _read(layer.uv, "vector", 2 * len(mesh.loops), numpy.float32).reshape(-1, 2)[found["loops"]]


def block_columns(triangles):
    return max(1, int(numpy.ceil(numpy.sqrt(triangles))))


def block_uvs(triangles):
    """Texture coordinates that lead the corners of each triangle to the middles of three texels of a block of 2 × 2 of its own."""
    columns = block_columns(triangles)
    rows = max(1, -(-triangles // columns))
    index = numpy.arange(triangles)
    column, row = index % columns, index // columns
    u = (2 * column[:, None] + numpy.array([0.5, 1.5, 0.5])) / (2 * columns)
    v = 1 - (2 * row[:, None] + numpy.array([0.5, 0.5, 1.5])) / (2 * rows)
    return numpy.stack([u, v], axis=-1).reshape(-1, 2).astype(numpy.float32)


def block_pixels(values):
    """The picture of these blocks: `values` has a colour for each corner, three to a triangle; the texture filter `triangle` reads them."""
    triangles = len(values) // 3
    columns = block_columns(triangles)
    rows = max(1, -(-triangles // columns))
    pixels = numpy.zeros((2 * rows, 2 * columns, values.shape[1]), dtype=numpy.float32)
    index = numpy.arange(triangles)
    x, y = 2 * (index % columns), 2 * (index // columns)
    a, b, c = values[0::3], values[1::3], values[2::3]
    pixels[y, x], pixels[y, x + 1], pixels[y + 1, x] = a, b, c
    return pixels


def color_attribute(mesh, found, name):
    """Linear colours of all corners by an attribute's name, or by the active one's; None where there is no such attribute."""
    attribute = mesh.color_attributes.get(name) if name else mesh.color_attributes.active_color
    if name and attribute is None:
        attribute = mesh.attributes.get(name)
    if attribute is None or attribute.domain not in ("POINT", "CORNER", "FACE"):
        return None
    count = len(attribute.data)
    if attribute.data_type in ("FLOAT_COLOR", "BYTE_COLOR"):
        values = _read(attribute.data, "color", 4 * count, numpy.float32).reshape(-1, 4)
    elif attribute.data_type == "FLOAT_VECTOR":
        values = numpy.ones((count, 4), dtype=numpy.float32)
        values[:, :3] = _read(attribute.data, "vector", 3 * count, numpy.float32).reshape(-1, 3)
    elif attribute.data_type == "FLOAT":
        values = numpy.repeat(_read(attribute.data, "value", count, numpy.float32)[:, None], 4, axis=1)
        values[:, 3] = 1
    else:
        return None
    if attribute.domain == "FACE":
        faces = _read(mesh.loop_triangles, "polygon_index", len(found["slots"]), numpy.int32)
        return values[numpy.repeat(faces, 3)]
    return values[found["loops"] if attribute.domain == "CORNER" else found["vertices"]]


def write_ply(path, found, uvs):
    """A binary PLY file; corners that agree in everything share a vertex."""
    columns = [found["positions"], found["normals"]]
    names = ["x", "y", "z", "nx", "ny", "nz"]
    if uvs is not None:
        columns.append(uvs)
        names += ["u", "v"]
    table = numpy.ascontiguousarray(numpy.concatenate(columns, axis=1).astype("<f4")) + numpy.float32(0)
    keys = table.view(numpy.dtype((numpy.void, table.dtype.itemsize * table.shape[1]))).ravel()
    _, first, index = numpy.unique(keys, return_index=True, return_inverse=True)
    faces = numpy.empty(len(found["slots"]), dtype=[("count", "u1"), ("corners", "<i4", 3), ("slot", "<i4")])
    faces["count"] = 3
    faces["corners"] = index.reshape(-1, 3)
    faces["slot"] = found["slots"]
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(first)}"]
    header += [f"property float {name}" for name in names]
    header += [f"element face {len(faces)}", "property list uchar int vertex_indices", "property int material_index", "end_header", ""]
    with open(path, "wb") as file:
        file.write("\n".join(header).encode() + table[first].tobytes() + faces.tobytes())


class Meshes:
    """Collects objects as the dependency graph lists them; `write` puts each mesh into one file and names it once for each place."""

    def __init__(self, file, materials, report):
        self._file, self._materials, self._report = file, materials, report
        self._used = {}

    def add(self, instance, key, receiver):
        """Adds a visible object. Places with the same key show the same mesh and materials; `receiver` is the name of its group of
        receivers, or None. True if it has triangles."""
        if key not in self._used:
            self._used[key] = self._prepare(instance.object)
        shape, by_receiver = self._used[key]
        places = by_receiver.setdefault(receiver, [])
        if shape is not None:
            places.append(TO_Y_UP @ numpy.array(instance.matrix_world))
        return shape is not None

    def _prepare(self, evaluated):
        mesh = evaluated.to_mesh()
        try:
            if mesh is None or not len(mesh.polygons):
                return None, {}
            return self._shape(evaluated, mesh), {}
        finally:
            evaluated.to_mesh_clear()

    def _shape(self, evaluated, mesh):
        found = corners(mesh)
        slots = [slot.material for slot in evaluated.material_slots] or [None]
        found["slots"] = numpy.clip(found["slots"], 0, len(slots) - 1)
        without = numpy.linalg.norm(found["normals"], axis=1) < 1e-6
        found["normals"][without] = (0, 0, 1)
        names, uvs = {}, None
        where = f"object {evaluated.name}"
        original = evaluated.original if evaluated.original else evaluated
        for slot in numpy.unique(found["slots"]):
            name, source = self._materials.of(slots[slot], mesh, found, where, hidden=not evaluated.visible_camera)
            names[int(slot)] = name
            if source is None:
                continue
            own = uv_of(mesh, found, source, _generated(original, found))
            if own is None:
                self._report.add(where, "a texture by coordinates that the mesh does not have", "the texture's corner at (0, 0)")
                continue
            if uvs is None:
                uvs = numpy.zeros((len(found["positions"]), 2), dtype=numpy.float32)
            chosen = numpy.repeat(found["slots"] == slot, 3)
            uvs[chosen] = own[chosen]
        path, reference = self._file.new_file(evaluated.name, ".ply")
        write_ply(path, found, uvs)
        shape = {"type": "mesh", "file": reference}
        if len(set(names.values())) == 1:
            shape["material"] = next(iter(names.values()))
        else:
            shape["materials"] = {str(slot): name for slot, name in names.items()}
        self._unsaid(evaluated, where)
        return {"name": evaluated.name, "shape": shape}

    def _unsaid(self, evaluated, where):
        hidden = [
            name for name in ("diffuse", "glossy", "transmission", "volume_scatter", "shadow")
            if not getattr(evaluated, f"visible_{name}")
        ]
        if hidden:
            self._report.add(where, f"invisible to {', '.join(hidden)} rays", "it is seen by them")
        if evaluated.is_shadow_catcher or evaluated.is_holdout:
            self._report.add(where, "a shadow catcher or holdout", "an ordinary surface")

    def write(self):
        for shape, by_receiver in self._used.values():
            if shape is None:
                continue
            group = None
            for receiver, places in by_receiver.items():
                said = {"receiver": receiver} if receiver else {}
                if len(places) == 1 and len(by_receiver) == 1:
                    self._file.shapes.append({**shape["shape"], "transform": steps(places[0]), **said})
                    continue
                if group is None:
                    group = self._file.new_name("group", shape["name"])
                    self._file.groups.append({"name": group, "shape": [shape["shape"]]})
                self._file.instances.append({"group": group, "places": [[float(x) for x in place[:3].ravel()] for place in places], **said})


def _generated(original, found):
    """Lower corner and size of the box by which Blender's generated coordinates go from 0 to 1."""
    box = numpy.array([corner[:] for corner in original.bound_box])
    data = original.data
    if getattr(data, "use_auto_texspace", True) is False:
        location, size = numpy.array(data.texspace_location), numpy.array(data.texspace_size)
        return location - size, numpy.where(size > 0, 2 * size, 1)
    low, size = box.min(axis=0), box.max(axis=0) - box.min(axis=0)
    return low, numpy.where(size > 0, size, 1)
