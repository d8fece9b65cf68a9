"""Scenes of glTF with what the specification says they show."""

import math
from dataclasses import dataclass

import numpy

from .document import BYTE, FLOAT, SHORT, UBYTE, UINT, USHORT, Document, png
from .expected import CLAMP, LINEAR, MIRROR, NEAREST, REPEAT, Camera, Triangles, linear, picture, reflected, sample

WORDS = {REPEAT: "repeat", CLAMP: "clamp", MIRROR: "mirror", NEAREST: "nearest", LINEAR: "linear"}


@dataclass
class Case:
    """`beside_cycles`: Cycles' importer says the same as the specification here."""

    group: str
    form: str
    document: Document
    camera: Camera
    things: list
    depth: int = 1
    width: int = 16
    height: int = 16
    beside_cycles: bool = True
    binary: bool = False
    variant: str = ""

    @property
    def name(self):
        return f"{self.group}: {self.form}"

    def expected(self):
        return picture(self.camera, self.things, self.width, self.height)


# Geometry --------------------------------------------------------------------------------------------------------------------------------

CORNERS = numpy.array([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], float)
FACES = numpy.array([(0, 1, 2), (0, 2, 3)])
# v runs downward.
UVS = numpy.array([(0, 1), (1, 1), (1, 0), (0, 0)], float)


def texels(channels=3, width=4, height=4, seed=5):
    """No row or column is alike."""
    return numpy.round((0.1 + 0.85 * numpy.random.default_rng(seed).random((height, width, channels))) * 255) / 255


PICTURE = texels()


def matrix(translation=(0, 0, 0), rotation=(0, 0, 0, 1), scale=(1, 1, 1)):
    x, y, z, w = numpy.array(rotation, float) / numpy.linalg.norm(rotation)
    turn = numpy.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ])
    made = numpy.eye(4)
    made[:3, :3] = turn * numpy.array(scale, float)
    made[:3, 3] = translation
    return made


def quaternion(axis, degrees):
    axis = numpy.array(axis, float) / numpy.linalg.norm(axis)
    half = math.radians(degrees) / 2
    return [*(axis * math.sin(half)), math.cos(half)]


def moved(map_, positions=CORNERS):
    return positions @ map_[:3, :3].T + map_[:3, 3]


def eye(document, translation=(0, 0, 5), rotation=(0, 0, 0, 1), yfov=0.42, aspect=1.0, **words):
    """A camera with a perspective, in the file and as it is."""
    index = document.add("cameras", {"type": "perspective", "perspective": {"yfov": yfov, "aspectRatio": aspect, "znear": 0.01}})
    document.node(camera=index, translation=list(translation), rotation=list(rotation), **words)
    return Camera(matrix(translation, rotation), math.tan(yfov / 2), aspect)


def glowing(document, content, sampler=None, **info):
    """A black material whose texture glows."""
    info = {"index": document.texture(content, sampler=sampler), **info}
    return document.add("materials", {"pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1]}, "emissiveFactor": [1, 1, 1], "emissiveTexture": info, "doubleSided": True})


def glow(values=PICTURE, wrap=(REPEAT, REPEAT), is_linear=False, of="uv", map_=None):
    """What it looks like: the texels, decoded from sRGB."""
    decoded = linear(values)

    def look(hit):
        uv = hit.attributes[of]
        uv = uv if map_ is None else map_(uv)
        return sample(decoded, uv, wrap, is_linear)[:, :3], numpy.ones(len(uv))

    return look


NEAR = {"magFilter": NEAREST, "minFilter": NEAREST}


def quad(document, material, positions=None, uvs=None, indices=None, attributes=(), mode=None):
    """A primitive; attributes by accessor."""
    primitive = {"attributes": {"POSITION": document.accessor(CORNERS) if positions is None else positions}, "material": material}
    primitive["attributes"]["TEXCOORD_0"] = document.accessor(UVS) if uvs is None else uvs
    primitive["attributes"].update(attributes)
    if indices != "none":
        primitive["indices"] = document.accessor(FACES.ravel(), USHORT) if indices is None else indices
    if mode is not None:
        primitive["mode"] = mode
    return document.add("meshes", {"primitives": [primitive]})


def plain(positions=CORNERS, look=None, uvs=UVS, faces=FACES, **words):
    return Triangles(positions, faces, look or glow(), {"uv": uvs}, **words)


# Groups ----------------------------------------------------------------------------------------------------------------------------------


def cases():
    yield from accessors()
    yield from nodes()
    yield from textures()
    yield from pictures()
    yield from emission()
    yield from alpha()
    yield from cameras()
    yield from sides()
    yield from base_colours()
    yield from reflection()
    yield from lights()
    yield from normals()
    yield from others()


def shown(group, form, make, things=None, **words):
    """`make` fills the file and may give what is to be seen; a camera is put before it."""
    document = Document()
    camera = eye(document)
    made = make(document)
    return Case(group, form, document, camera, things or made or [plain()], **words)


def accessors():
    def with_mesh(**parts):
        def make(document):
            filled = {name: part(document) if callable(part) else part for name, part in parts.items()}
            document.node(mesh=quad(document, glowing(document, png(PICTURE), NEAR), **filled))
        return make

    for name, component in (("unsigned byte", UBYTE), ("unsigned short", USHORT), ("unsigned int", UINT)):
        yield shown("accessor", f"indices of {name}", with_mesh(indices=lambda document, component=component: document.accessor(FACES.ravel(), component)))
    spread = FACES.ravel()
    yield shown("accessor", "no indices", with_mesh(positions=lambda d: d.accessor(CORNERS[spread]), uvs=lambda d: d.accessor(UVS[spread]), indices="none"))
    strip = [0, 1, 3, 2]
    yield shown("accessor", "triangle strip", with_mesh(indices=lambda d: d.accessor(strip, USHORT), mode=5))
    yield shown("accessor", "triangle strip without indices", with_mesh(positions=lambda d: d.accessor(CORNERS[strip]), uvs=lambda d: d.accessor(UVS[strip]), indices="none", mode=5))
    yield shown("accessor", "triangle fan", with_mesh(indices=lambda d: d.accessor([0, 1, 2, 3], USHORT), mode=6))
    yield shown("accessor", "mode 4 written", with_mesh(mode=4))
    for name, component in (("unsigned byte", UBYTE), ("unsigned short", USHORT)):
        yield shown("accessor", f"normalized coordinates of {name}", with_mesh(uvs=lambda d, component=component: d.accessor(UVS, component, True)))
    yield shown("accessor", "bytes between elements", with_mesh(positions=lambda d: d.accessor(CORNERS, padding=12), uvs=lambda d: d.accessor(UVS, padding=4)))
    yield shown("accessor", "byteOffset", with_mesh(positions=lambda d: d.accessor(CORNERS, lead=24), uvs=lambda d: d.accessor(UVS, lead=8)))

    def interleaved(document):
        rows = numpy.concatenate([CORNERS, UVS], axis=1).astype(numpy.float32)
        view = document.view(rows.tobytes(), 20)
        position = document.add("accessors", {"bufferView": view, "componentType": FLOAT, "count": 4, "type": "VEC3", "min": [-1, -1, 0], "max": [1, 1, 0]})
        uv = document.add("accessors", {"bufferView": view, "byteOffset": 12, "componentType": FLOAT, "count": 4, "type": "VEC2"})
        document.node(mesh=quad(document, glowing(document, png(PICTURE), NEAR), position, uv))

    yield shown("accessor", "interleaved", interleaved)

    def sparse(document, component, base):
        """The second and the fourth corner are elsewhere."""
        changed = CORNERS.copy()
        changed[[1, 3]] = [(0.8, -0.4, 0), (-0.9, 0.7, 0)]
        start = CORNERS if base else numpy.zeros((4, 3))
        places = [index for index in range(4) if (start[index] != changed[index]).any()]
        indices = numpy.array(places, {UBYTE: numpy.uint8, USHORT: numpy.uint16, UINT: numpy.uint32}[component])
        made = {"componentType": FLOAT, "count": 4, "type": "VEC3", "min": changed.min(axis=0).tolist(), "max": changed.max(axis=0).tolist()}
        if base:
            made["bufferView"] = document.view(CORNERS.astype(numpy.float32).tobytes())
        made["sparse"] = {
            "count": len(places),
            "indices": {"bufferView": document.view(indices.tobytes()), "componentType": component},
            "values": {"bufferView": document.view(changed[places].astype(numpy.float32).tobytes())},
        }
        document.node(mesh=quad(document, glowing(document, png(PICTURE), NEAR), document.add("accessors", made)))
        return [plain(changed)]

    for name, component in (("unsigned byte", UBYTE), ("unsigned short", USHORT), ("unsigned int", UINT)):
        yield shown("accessor", f"sparse, indices of {name}", lambda d, component=component: sparse(d, component, True))
    yield shown("accessor", "sparse on nothing", lambda d: sparse(d, USHORT, False))

    def quantized(document, component, normalized):
        document.use("KHR_mesh_quantization")
        document.json["extensionsRequired"] = ["KHR_mesh_quantization"]
        most = 1 if normalized else 100
        own = (CORNERS + 1) / 2 if component in (UBYTE, USHORT) else CORNERS
        positions = document.accessor(own * most, component, normalized)
        made = document.json["accessors"][positions]
        made["min"], made["max"] = (own * most).min(axis=0).tolist(), (own * most).max(axis=0).tolist()
        size, shift = (2, -1) if component in (UBYTE, USHORT) else (1, 0)
        document.node(mesh=quad(document, glowing(document, png(PICTURE), NEAR), positions), scale=[size / most] * 3, translation=[shift, shift, shift])

    for name, component in (("byte", BYTE), ("unsigned byte", UBYTE), ("short", SHORT), ("unsigned short", USHORT)):
        for normalized in (True, False):
            yield shown("KHR_mesh_quantization", f"positions of {name}{', normalized' if normalized else ''}", lambda d, c=component, n=normalized: quantized(d, c, n))

    def quantized_uv(document):
        document.use("KHR_mesh_quantization", "KHR_texture_transform")
        document.json["extensionsRequired"] = ["KHR_mesh_quantization"]
        uvs = document.accessor(UVS * 200, SHORT)
        info = {"extensions": {"KHR_texture_transform": {"scale": [1 / 200, 1 / 200]}}}
        document.node(mesh=quad(document, glowing(document, png(PICTURE), NEAR, **info), uvs=uvs))

    yield shown("KHR_mesh_quantization", "coordinates of short", quantized_uv)
    yield shown("container", "binary file", with_mesh(), binary=True)


def nodes():
    turn = quaternion((0.6, 0.8, 0), 40)
    forms = {
        "translation": {"translation": [0.2, -0.15, 0.4]},
        "rotation": {"rotation": turn},
        "scale": {"scale": [0.8, 0.5, 1]},
        "all three": {"translation": [0.2, -0.15, 0.4], "rotation": turn, "scale": [0.8, 0.5, 1]},
        "mirrored": {"scale": [-0.8, 0.9, 1]},
        "mirrored in depth": {"scale": [0.8, 0.9, -1], "rotation": turn},
    }
    for form, words in forms.items():
        map_ = matrix(words.get("translation", (0, 0, 0)), words.get("rotation", (0, 0, 0, 1)), words.get("scale", (1, 1, 1)))

        def make(document, words=words, map_=map_):
            document.node(mesh=quad(document, glowing(document, png(PICTURE), NEAR)), **words)
            return [plain(moved(map_))]

        yield shown("node", form, make)

        def written(document, map_=map_):
            document.node(mesh=quad(document, glowing(document, png(PICTURE), NEAR)), matrix=map_.T.ravel().tolist())
            return [plain(moved(map_))]

        yield shown("node", f"matrix of {form}", written)

    def sheared(document):
        map_ = numpy.array([[0.8, 0.3, 0, 0.1], [0.1, 0.7, 0, 0], [0, 0.2, 1, 0], [0, 0, 0, 1]])
        document.node(mesh=quad(document, glowing(document, png(PICTURE), NEAR)), matrix=map_.T.ravel().tolist())
        return [plain(moved(map_))]

    yield shown("node", "matrix with a shear", sheared, beside_cycles=False)

    def nested(document):
        outer = document.node(translation=[0.1, 0.2, 0], rotation=quaternion((0, 0, 1), 30))
        inner = document.node(outer, scale=[0.7, 0.4, 1])
        document.node(inner, rotation=quaternion((0, 0, 1), 20), translation=[0.1, 0, 0], mesh=quad(document, glowing(document, png(PICTURE), NEAR)))
        map_ = matrix((0.1, 0.2, 0), quaternion((0, 0, 1), 30)) @ matrix(scale=(0.7, 0.4, 1)) @ matrix((0.1, 0, 0), quaternion((0, 0, 1), 20))
        return [plain(moved(map_))]

    # Blender's objects cannot hold a shear.
    yield shown("node", "uneven scale around a turn", nested, beside_cycles=False)

    def twice(document):
        mesh = quad(document, glowing(document, png(PICTURE), NEAR))
        for x in (-0.5, 0.5):
            document.node(mesh=mesh, translation=[x, 0, 0], scale=[0.45, 0.45, 1])
        return [plain(moved(matrix((x, 0, 0), scale=(0.45, 0.45, 1)))) for x in (-0.5, 0.5)]

    yield shown("node", "a mesh of two nodes", twice)

    def second_scene(document):
        mesh = quad(document, glowing(document, png(PICTURE), NEAR))
        document.node(mesh=mesh, scale=[0.3, 0.3, 1])
        camera = document.json["scenes"][0]["nodes"][0]
        document.json["scenes"].append({"nodes": [camera, document.add("nodes", {"mesh": mesh, "scale": [0.7, 0.5, 1]})]})
        document.json["scene"] = 1
        return [plain(moved(matrix(scale=(0.7, 0.5, 1))))]

    yield shown("node", "second scene", second_scene)

    def instanced(document):
        document.use("EXT_mesh_gpu_instancing")
        places = [(-0.5, 0.4, 0), (0.4, 0.3, 0.2), (0.1, -0.6, 0)]
        turns = [quaternion((0, 0, 1), angle) for angle in (0, 30, -50)]
        sizes = [(0.3, 0.3, 1), (0.4, 0.2, 1), (0.25, 0.35, 1)]
        attributes = {"TRANSLATION": document.accessor(places), "ROTATION": document.accessor(turns), "SCALE": document.accessor(sizes)}
        document.node(mesh=quad(document, glowing(document, png(PICTURE), NEAR)), extensions={"EXT_mesh_gpu_instancing": {"attributes": attributes}})
        return [plain(moved(matrix(*place))) for place in zip(places, turns, sizes)]

    yield shown("EXT_mesh_gpu_instancing", "three", instanced)

    def hidden(document):
        document.use("KHR_node_visibility")
        mesh = quad(document, glowing(document, png(PICTURE), NEAR))
        document.node(mesh=mesh, scale=[0.5, 0.5, 1])
        parent = document.node(extensions={"KHR_node_visibility": {"visible": False}})
        document.node(parent, mesh=mesh, translation=[0, 0, 0.5])
        return [plain(moved(matrix(scale=(0.5, 0.5, 1))))]

    yield shown("KHR_node_visibility", "false, of a parent", hidden, beside_cycles=False)


def textures():
    wide = UVS * [2.6, 1.9] - [0.8, 0.4]

    def with_sampler(sampler, uvs=wide, look=None, **info):
        def make(document):
            document.node(mesh=quad(document, glowing(document, png(PICTURE), sampler, **info), uvs=document.accessor(uvs)))
            return [plain(look=look, uvs=uvs)]
        return make

    for s in (REPEAT, CLAMP, MIRROR):
        for t in (REPEAT, CLAMP, MIRROR):
            for mag in (NEAREST, LINEAR):
                sampler = {"wrapS": s, "wrapT": t, "magFilter": mag, "minFilter": mag}
                # Blender wraps both ways alike, or by nodes whose seams are not filtered.
                yield shown("sampler", f"{WORDS[s]} and {WORDS[t]}, {WORDS[mag]}", with_sampler(sampler, look=glow(PICTURE, (s, t), mag == LINEAR)), beside_cycles=s == t and mag == NEAREST)
    yield shown("sampler", "none", with_sampler(None, look=glow(is_linear=True)))
    yield shown("sampler", "without filters", with_sampler({}, look=glow(is_linear=True)))
    yield shown("sampler", "nearest when magnified, linear when not", with_sampler({"magFilter": NEAREST, "minFilter": 9987}, look=glow()))
    transforms = {
        "offset": {"offset": [0.3, 0.15]},
        "scale": {"scale": [2, 1.5]},
        "rotation": {"rotation": 0.5},
        "rotation by a quarter": {"rotation": math.pi / 2},
        "all three": {"offset": [0.3, 0.15], "scale": [1.7, 0.6], "rotation": -0.7},
        "negative scale": {"scale": [-1, 1]},
        "nothing": {},
    }
    for form, words in transforms.items():
        offset, angle, size = words.get("offset", [0, 0]), words.get("rotation", 0), words.get("scale", [1, 1])
        # Translation × rotation × scale, as the extension's text writes the matrices.
        turn = numpy.array([[math.cos(angle), math.sin(angle)], [-math.sin(angle), math.cos(angle)]])
        map_ = lambda uv, turn=turn, offset=offset, size=size: (uv * size) @ turn.T + offset

        def make(document, words=words, map_=map_):
            document.use("KHR_texture_transform")
            document.node(mesh=quad(document, glowing(document, png(PICTURE), NEAR, extensions={"KHR_texture_transform": words})))
            return [plain(look=glow(map_=map_))]

        yield shown("KHR_texture_transform", form, make)

    def second_set(document, in_transform):
        other = UVS[:, ::-1] * 0.8
        info = {"texCoord": 1}
        if in_transform:
            document.use("KHR_texture_transform")
            info = {"texCoord": 0, "extensions": {"KHR_texture_transform": {"texCoord": 1}}}
        document.node(mesh=quad(document, glowing(document, png(PICTURE), NEAR, **info), attributes={"TEXCOORD_1": document.accessor(other)}))
        return [plain(uvs=other)]

    yield shown("textureInfo", "texCoord 1", lambda d: second_set(d, False))
    yield shown("KHR_texture_transform", "texCoord 1", lambda d: second_set(d, True))


def pictures():
    for channels, word in ((1, "grey"), (2, "grey with alpha"), (3, "colours"), (4, "colours with alpha")):
        for bits in (8, 16):
            values = texels(channels, seed=9)

            def make(document, values=values, bits=bits, channels=channels):
                seen = values if channels > 2 else numpy.repeat(values[:, :, :1], 3, axis=2)
                document.node(mesh=quad(document, glowing(document, png(values, bits), NEAR)))
                return [plain(look=glow(seen[:, :, :3]))]

            # Blender multiplies colours by alpha in its own way.
            yield shown("image", f"PNG of {word}, {bits} bits", make, beside_cycles=channels in (1, 3) and bits == 8)

    def oblong(document):
        values = texels(3, 5, 3)
        document.node(mesh=quad(document, glowing(document, png(values), NEAR)))
        return [plain(look=glow(values))]

    yield shown("image", "PNG of 5 by 3", oblong)


def emission():
    def material(document, **words):
        index = document.add("materials", {"pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1]}, "doubleSided": True, **words})
        document.node(mesh=quad(document, index))

    constant = lambda colour: lambda hit: (numpy.tile(numpy.array(colour, float), (len(hit.position), 1)), numpy.ones(len(hit.position)))
    for form, factor, strength in [("factor", (0.8, 0.4, 0.1), None), ("factor of 1", (1, 1, 1), None), ("not given", (0, 0, 0), None), ("strength of 5", (0.8, 0.4, 0.1), 5), ("strength of 0.3", (0.8, 0.4, 0.1), 0.3), ("strength of 0", (0.8, 0.4, 0.1), 0)]:
        def make(document, factor=factor, strength=strength, form=form):
            words = {} if form == "not given" else {"emissiveFactor": list(factor)}
            if strength is not None:
                document.use("KHR_materials_emissive_strength")
                words["extensions"] = {"KHR_materials_emissive_strength": {"emissiveStrength": strength}}
            material(document, **words)
            return [plain(look=constant(numpy.array(factor, float) * (1 if strength is None else strength)))]

        yield shown("emission", form, make)

    def times(document, strength):
        words = {"emissiveFactor": [0.5, 0.9, 0.3], "emissiveTexture": {"index": document.texture(png(PICTURE), sampler=NEAR)}}
        if strength != 1:
            document.use("KHR_materials_emissive_strength")
            words["extensions"] = {"KHR_materials_emissive_strength": {"emissiveStrength": strength}}
        material(document, **words)
        inner = glow()
        return [plain(look=lambda hit: (inner(hit)[0] * numpy.array([0.5, 0.9, 0.3]) * strength, inner(hit)[1]))]

    yield shown("emission", "factor times texture", lambda d: times(d, 1))
    yield shown("emission", "factor times texture times strength", lambda d: times(d, 3))

    def texture_alone(document):
        material(document, emissiveTexture={"index": document.texture(png(PICTURE), sampler=NEAR)})
        return [plain(look=constant((0, 0, 0)))]

    yield shown("emission", "texture without a factor", texture_alone)


def alpha():
    """Before a wall that glows."""
    veil = texels(4, seed=11)
    wall = numpy.array([(-3, -3, -1), (3, -3, -1), (3, 3, -1), (-3, 3, -1)], float)
    behind = numpy.array([0.2, 0.5, 0.9])

    def make(mode, factor=1.0, texture=False, cutoff=None, vertex=None):
        def fill(document):
            back = document.add("materials", {"pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1]}, "emissiveFactor": behind.tolist(), "doubleSided": True})
            document.node(mesh=quad(document, back, document.accessor(wall)))
            base = {"baseColorFactor": [0, 0, 0, factor]}
            if texture:
                base["baseColorTexture"] = {"index": document.texture(png(veil), sampler=NEAR)}
            words = {"pbrMetallicRoughness": base, "emissiveFactor": [0.9, 0.3, 0.1], "doubleSided": True}
            if mode:
                words["alphaMode"] = mode
            if cutoff is not None:
                words["alphaCutoff"] = cutoff
            colours = {}
            if vertex is not None:
                colours["COLOR_0"] = document.accessor([(0.5, 0.5, 0.5, one) for one in vertex])
            document.node(mesh=quad(document, document.add("materials", words), attributes=colours))

            def look(hit):
                share = numpy.full(len(hit.position), factor)
                if texture:
                    share = share * sample(veil[:, :, 3:], hit.attributes["uv"], is_linear=False)[:, 0]
                if vertex is not None:
                    share = share * hit.attributes["share"][:, 0]
                if mode == "MASK":
                    share = (share >= (0.5 if cutoff is None else cutoff)).astype(float)
                elif mode != "BLEND":
                    share = numpy.ones(len(share))
                return numpy.tile([0.9, 0.3, 0.1], (len(share), 1)), share

            front = plain(look=look)
            if vertex is not None:
                front.attributes["share"] = numpy.array(vertex, float)[:, None]
            return [plain(wall, lambda hit: (numpy.tile(behind, (len(hit.position), 1)), numpy.ones(len(hit.position)))), front]

        return fill

    rows = [
        ("no mode, factor 0.3", make(None, 0.3)), ("OPAQUE, factor 0.3", make("OPAQUE", 0.3)), ("OPAQUE, texture", make("OPAQUE", 1.0, True)),
        ("BLEND, factor 0.3", make("BLEND", 0.3)), ("BLEND, factor 0", make("BLEND", 0.0)), ("BLEND, factor 1", make("BLEND", 1.0)),
        ("BLEND, texture", make("BLEND", 1.0, True)), ("BLEND, factor 0.5 and texture", make("BLEND", 0.5, True)),
        ("MASK, factor 0.3", make("MASK", 0.3)), ("MASK, factor 0.5", make("MASK", 0.5)), ("MASK, texture", make("MASK", 1.0, True)),
        ("MASK, texture, cutoff 0.8", make("MASK", 1.0, True, 0.8)), ("MASK, factor 0.7 and texture, cutoff 0.4", make("MASK", 0.7, True, 0.4)),
        ("MASK, cutoff 0", make("MASK", 0.0, False, 0.0)), ("MASK, cutoff 0, texture", make("MASK", 1.0, True, 0.0)), ("MASK, cutoff 1", make("MASK", 1.0, False, 1.0)), ("MASK, cutoff 1.5", make("MASK", 1.0, False, 1.5)),
        ("MASK, cutoff 1.5, texture", make("MASK", 1.0, True, 1.5)),
        ("BLEND, vertices", make("BLEND", 1.0, False, None, (0.2, 0.9, 0.6, 0.1))),
        ("MASK, vertices", make("MASK", 1.0, False, 0.5, (0.2, 0.9, 0.6, 0.1))),
        ("BLEND, factor 0.5, vertices", make("BLEND", 0.5, False, None, (0.2, 0.9, 0.6, 0.1))),
    ]
    for form, fill in rows:
        # Blender's emission is not veiled, and it does not take vertex colours by itself.
        yield shown("alpha", form, fill, beside_cycles=False)


def cameras():
    def perspective(form, yfov, aspect, width, height, **where):
        document = Document()
        camera = eye(document, yfov=yfov, aspect=aspect, **where)
        document.node(mesh=quad(document, glowing(document, png(PICTURE), NEAR)))
        return Case("camera", form, document, camera, [plain()], width=width, height=height)

    yield perspective("perspective", 0.5, 1, 16, 16)
    yield perspective("perspective, wide", 0.42, 2, 24, 12)
    yield perspective("perspective, tall", 0.7, 0.5, 10, 20)
    yield perspective("perspective, turned", 0.42, 1, 16, 16, translation=(1.5, 1, 4), rotation=(numpy.array([math.sin(-0.12), 0, 0, math.cos(-0.12)]) * 1).tolist())
    yield perspective("perspective, rolled", 0.5, 1, 16, 16, rotation=tuple(quaternion((0, 0, 1), 25)))

    def orthographic(form, xmag, ymag, width, height, rotation=(0, 0, 0, 1), scale=None):
        document = Document()
        index = document.add("cameras", {"type": "orthographic", "orthographic": {"xmag": xmag, "ymag": ymag, "znear": 0.01, "zfar": 100}})
        words = {"scale": scale} if scale else {}
        document.node(camera=index, translation=[0.1, 0.2, 5], rotation=list(rotation), **words)
        document.node(mesh=quad(document, glowing(document, png(PICTURE), NEAR)))
        return Case("camera", form, document, Camera(matrix((0.1, 0.2, 5), rotation), abs(ymag), abs(xmag / ymag), True), [plain()], width=width, height=height)

    yield orthographic("orthographic", 1.1, 1.1, 16, 16)
    yield orthographic("orthographic, wide", 1.6, 0.8, 24, 12)
    yield orthographic("orthographic, tall", 0.6, 1.2, 10, 20)
    yield orthographic("orthographic, rolled", 1.1, 1.1, 16, 16, tuple(quaternion((0, 0, 1), 25)))

    def carried(document):
        document.json["scenes"][0]["nodes"].clear()
        document.json["nodes"].clear()
        parent = document.node(translation=[0.2, 0.1, 1], rotation=quaternion((0, 0, 1), 20), scale=[1, 1, 1])
        document.node(parent, camera=0, translation=[0, 0, 4])
        document.node(mesh=quad(document, glowing(document, png(PICTURE), NEAR)))

    document = Document()
    eye(document)
    carried(document)
    yield Case("camera", "of a node within another", document, Camera(matrix((0.2, 0.1, 1), quaternion((0, 0, 1), 20)) @ matrix((0, 0, 4)), math.tan(0.21)), [plain()])


def sides():
    """Surfaces that show their backs, before a wall."""
    wall = numpy.array([(-3, -3, -1), (3, -3, -1), (3, 3, -1), (-3, 3, -1)], float)
    flat = lambda colour: lambda hit: (numpy.tile(colour, (len(hit.position), 1)), numpy.ones(len(hit.position)))
    for form, words, is_double in [
        ("doubleSided true, from behind", {"rotation": quaternion((0, 1, 0), 150)}, True),
        ("doubleSided false, from behind", {"rotation": quaternion((0, 1, 0), 150)}, False),
        ("doubleSided false, from the front", {"rotation": quaternion((0, 1, 0), 30)}, False),
        ("doubleSided false, mirrored", {"scale": [-0.8, 0.8, 1]}, False),
        ("doubleSided false, mirrored and turned", {"scale": [-0.8, 0.8, 1], "rotation": quaternion((0, 1, 0), 150)}, False),
    ]:
        map_ = matrix(rotation=words.get("rotation", (0, 0, 0, 1)), scale=words.get("scale", (1, 1, 1)))

        def make(document, words=words, is_double=is_double, map_=map_):
            back = document.add("materials", {"pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1]}, "emissiveFactor": [0.2, 0.5, 0.9], "doubleSided": True})
            document.node(mesh=quad(document, back, document.accessor(wall)))
            material = glowing(document, png(PICTURE), NEAR)
            document.json["materials"][material]["doubleSided"] = is_double
            document.node(mesh=quad(document, material), **words)
            # A mirroring node turns which way its triangles wind.
            faces = FACES[:, ::-1] if numpy.linalg.det(map_[:3, :3]) < 0 else FACES
            return [plain(wall, flat([0.2, 0.5, 0.9])), plain(moved(map_), faces=faces, double_sided=is_double)]

        yield shown("doubleSided", form, make, beside_cycles=False)


SUN = numpy.array([0.3, 0.5, 0.8]) / numpy.linalg.norm([0.3, 0.5, 0.8])


def sun(document, direction=SUN, intensity=3.0, color=(1, 1, 1)):
    """A directional light; its node's -Z points where it shines."""
    axis = numpy.cross([0, 0, 1], direction)
    length = numpy.linalg.norm(axis)
    angle = math.degrees(math.atan2(length, direction[2]))
    rotation = quaternion(axis, angle) if length > 1e-9 else [0, 0, 0, 1]
    document.light({"type": "directional", "intensity": intensity, "color": list(color)}, rotation=rotation)


def under_sun(base, metallic=0.0, roughness=1.0, intensity=3.0, color=(1, 1, 1), normal=None, **words):
    """Radiance of a surface under it; parameters may be functions of a hit."""
    def look(hit):
        get = lambda value: value(hit) if callable(value) else numpy.asarray(value, float)
        facing = hit.normal if normal is None else normal(hit)
        one = get(roughness)
        found = reflected(get(base), get(metallic), one, facing, hit.view, numpy.broadcast_to(SUN, hit.view.shape), **{key: get(value) for key, value in words.items()})
        return found * intensity * numpy.array(color), numpy.ones(len(hit.position))

    return look


def lit(group, form, pbr, look, attributes=None, extra=None, uvs=True, beside_cycles=False, **words):
    """A quad under the sun."""
    def make(document):
        sun(document)
        made = pbr(document) if callable(pbr) else pbr
        material = {"pbrMetallicRoughness": made, "doubleSided": True, **((extra(document) if callable(extra) else extra) or {})}
        for name in material.get("extensions", {}):
            document.use(name)
        colours = attributes(document) if attributes else {}
        document.node(mesh=quad(document, document.add("materials", material), attributes=colours))
        return [plain(look=look)]

    return shown(group, form, make, depth=2, beside_cycles=beside_cycles, **words)


def base_colours():
    decoded = linear(PICTURE)
    tinted = lambda hit: sample(decoded, hit.attributes["uv"], is_linear=False) * [0.6, 0.9, 0.4]
    textured = lambda hit: sample(decoded, hit.attributes["uv"], is_linear=False)
    texture = lambda document: {"index": document.texture(png(PICTURE), sampler=NEAR)}
    for metallic in (0, 1):
        words = {"metallicFactor": metallic, "roughnessFactor": 1}
        yield lit("baseColor", f"factor, metallic {metallic}", {"baseColorFactor": [0.6, 0.9, 0.4, 1], **words}, under_sun([0.6, 0.9, 0.4], metallic), beside_cycles=metallic == 1)
        yield lit("baseColor", f"texture, metallic {metallic}", lambda d, w=words: {"baseColorTexture": texture(d), **w}, under_sun(textured, metallic), beside_cycles=metallic == 1)
        yield lit("baseColor", f"factor times texture, metallic {metallic}", lambda d, w=words: {"baseColorTexture": texture(d), "baseColorFactor": [0.6, 0.9, 0.4, 1], **w}, under_sun(tinted, metallic), beside_cycles=metallic == 1)
    colours = numpy.array([(0.9, 0.2, 0.3), (0.1, 0.8, 0.4), (0.5, 0.4, 0.9), (0.7, 0.7, 0.1)])
    rows = [("float", FLOAT, False), ("unsigned byte", UBYTE, True), ("unsigned short", USHORT, True)]
    for word, component, normalized in rows:
        for width in (3, 4):
            written = numpy.round(colours * 255) / 255
            values = written if width == 3 else numpy.concatenate([written, numpy.ones((4, 1))], axis=1)
            attribute = lambda d, v=values, c=component, n=normalized: {"COLOR_0": d.accessor(v, c, n)}
            for form, pbr, factor in [
                ("alone", lambda d: {"metallicFactor": 0}, lambda hit: 1.0),
                ("times factor", lambda d: {"metallicFactor": 0, "baseColorFactor": [0.6, 0.9, 0.4, 1]}, lambda hit: numpy.array([0.6, 0.9, 0.4])),
                ("times texture", lambda d: {"metallicFactor": 0, "baseColorTexture": texture(d)}, textured),
            ]:
                case = lit("COLOR_0", f"{form}, {width} of {word}", pbr, None, attribute)
                case.things[0].attributes["colour"] = written
                case.things[0].look = under_sun(lambda hit, factor=factor: hit.attributes["colour"] * factor(hit))
                yield case

    unlit = {"extensions": {"KHR_materials_unlit": {}}}
    shade = lambda value: lambda hit: (numpy.broadcast_to(value(hit), (len(hit.position), 3)), numpy.ones(len(hit.position)))
    yield lit("KHR_materials_unlit", "factor", {"baseColorFactor": [0.6, 0.9, 0.4, 1]}, shade(lambda hit: numpy.array([0.6, 0.9, 0.4])), extra=unlit)
    yield lit("KHR_materials_unlit", "texture", lambda d: {"baseColorTexture": texture(d)}, shade(textured), extra=unlit)
    yield lit("KHR_materials_unlit", "factor times texture", lambda d: {"baseColorTexture": texture(d), "baseColorFactor": [0.6, 0.9, 0.4, 1]}, shade(tinted), extra=unlit)
    case = lit("KHR_materials_unlit", "vertices", {}, shade(lambda hit: hit.attributes["colour"]), lambda d: {"COLOR_0": d.accessor(colours)}, extra=unlit)
    case.things[0].attributes["colour"] = colours
    yield case
    yield lit("baseColor", "nothing given", {}, under_sun([1, 1, 1], 1.0, 1.0), beside_cycles=True)


def reflection():
    base = [0.6, 0.9, 0.4]
    written = lambda **words: {"baseColorFactor": [*base, 1], **words}
    for metallic in (0, 0.5, 1):
        for roughness in (0.25, 0.5, 1):
            yield lit("metallicRoughness", f"factors {metallic} and {roughness}", written(metallicFactor=metallic, roughnessFactor=roughness), under_sun(base, metallic, roughness), beside_cycles=metallic == 1)
    values = numpy.stack([numpy.full((4, 4), 0.3), 0.4 + 0.6 * texels(1, seed=2)[:, :, 0], texels(1, seed=3)[:, :, 0]], axis=2)
    values = numpy.round(values * 255) / 255
    channel = lambda index, factor: lambda hit: sample(values, hit.attributes["uv"], is_linear=False)[:, index] * factor
    column = lambda index, factor: lambda hit: channel(index, factor)(hit)[:, None]
    for metallic, roughness in ((1, 1), (0.5, 0.8)):
        yield lit("metallicRoughness", f"texture times {metallic} and {roughness}", lambda d, m=metallic, r=roughness: written(metallicFactor=m, roughnessFactor=r, metallicRoughnessTexture={"index": d.texture(png(values), sampler=NEAR)}), under_sun(base, column(2, metallic), channel(1, roughness)))
    yield lit("metallicRoughness", "factors not given", written(), under_sun(base, 1, 1), beside_cycles=True)
    for ior in (1.0, 1.2, 1.5, 2.2):
        yield lit("KHR_materials_ior", str(ior), written(metallicFactor=0, roughnessFactor=0.4), under_sun(base, 0, 0.4, ior=ior), extra={"extensions": {"KHR_materials_ior": {"ior": ior}}})
    for form, words, meant in [
        ("factor 0.4", {"specularFactor": 0.4}, {"specular": 0.4}),
        ("factor 0", {"specularFactor": 0}, {"specular": 0.0}),
        ("colour", {"specularColorFactor": [0.9, 0.4, 0.2]}, {"specular_colour": (0.9, 0.4, 0.2)}),
        ("colour above 1", {"specularColorFactor": [3, 1.5, 0.5]}, {"specular_colour": (3, 1.5, 0.5)}),
        ("both", {"specularFactor": 0.6, "specularColorFactor": [0.9, 0.4, 0.2]}, {"specular": 0.6, "specular_colour": (0.9, 0.4, 0.2)}),
    ]:
        yield lit("KHR_materials_specular", form, written(metallicFactor=0, roughnessFactor=0.4), under_sun(base, 0, 0.4, **meant), extra={"extensions": {"KHR_materials_specular": words}})
    veil = texels(4, seed=21)
    share = lambda hit: sample(veil, hit.attributes["uv"], is_linear=False)[:, 3:]
    yield lit("KHR_materials_specular", "texture", written(metallicFactor=0, roughnessFactor=0.4), under_sun(base, 0, 0.4, specular=share), extra=lambda d: {"extensions": {"KHR_materials_specular": {"specularTexture": {"index": d.texture(png(veil), sampler=NEAR)}}}})
    tint = lambda hit: sample(linear(PICTURE), hit.attributes["uv"], is_linear=False)
    yield lit("KHR_materials_specular", "colour texture", written(metallicFactor=0, roughnessFactor=0.4), under_sun(base, 0, 0.4, specular_colour=tint), extra=lambda d: {"extensions": {"KHR_materials_specular": {"specularColorTexture": {"index": d.texture(png(PICTURE), sampler=NEAR)}}}})


def lights():
    """On a dielectric, and on a metal, which Cycles says alike."""
    for metallic in (0, 1):
        yield from lights_on(metallic)


def lights_on(metallic):
    base = numpy.array([0.6, 0.9, 0.4])
    material = {"pbrMetallicRoughness": {"baseColorFactor": [*base, 1], "metallicFactor": metallic, "roughnessFactor": 1}, "doubleSided": True}

    def under(place, radiant):
        def look(hit):
            toward = place - hit.position
            distance = numpy.linalg.norm(toward, axis=1, keepdims=True)
            light = toward / distance
            return reflected(base, metallic, 1.0, hit.normal, hit.view, light) * radiant(light, distance), numpy.ones(len(hit.position))
        return look

    def case(form, light, look, **where):
        def make(document):
            document.light(light, **where)
            document.node(mesh=quad(document, document.add("materials", material)))
            return [plain(look=look)]
        return shown("KHR_lights_punctual", f"{form}, metallic {metallic}", make, depth=2, beside_cycles=metallic == 1 and not form.startswith("spot"))

    place = numpy.array([0.4, 0.3, 1.5])
    for form, words, strength in [("point", {"intensity": 20}, 20), ("point with a colour", {"intensity": 20, "color": [1, 0.5, 0.2]}, numpy.array([20, 10, 4])), ("point, intensity not given", {}, 1)]:
        yield case(form, {"type": "point", **words}, under(place, lambda light, distance, s=strength: s / distance**2), translation=place.tolist())
    yield case("point, of a scaled node", {"type": "point", "intensity": 20}, under(place, lambda light, distance: 20 / distance**2), translation=place.tolist(), scale=[3, 3, 3])
    for form, words in [("directional", {"intensity": 3}), ("directional with a colour", {"intensity": 3, "color": [1, 0.5, 0.2]}), ("directional, intensity not given", {})]:
        def make(document, words=words):
            sun(document, intensity=words.get("intensity", 1.0), color=words.get("color", (1, 1, 1)))
            if "intensity" not in words:
                del document.json["extensions"]["KHR_lights_punctual"]["lights"][0]["intensity"]
            document.node(mesh=quad(document, document.add("materials", material)))
            return [plain(look=under_sun(base, metallic, 1, words.get("intensity", 1.0), words.get("color", (1, 1, 1))))]
        yield shown("KHR_lights_punctual", f"{form}, metallic {metallic}", make, depth=2, beside_cycles=metallic == 1)
    straight = numpy.array([0.1, -0.1, 2.5])
    for form, cone in [("cones of 0.1 and 0.35", (0.1, 0.35)), ("cones of 0.3 and 0.31", (0.3, 0.31)), ("inner cone not given", (0, 0.35)), ("no cones given", (0, math.pi / 4))]:
        written = {"innerConeAngle": cone[0], "outerConeAngle": cone[1]}
        if form == "inner cone not given":
            del written["innerConeAngle"]
        if form == "no cones given":
            written = {}

        def radiant(light, distance, cone=cone):
            """The note of the extension on angular attenuation."""
            cosine = light[:, 2:3]
            scale = 1 / max(0.001, math.cos(cone[0]) - math.cos(cone[1]))
            share = numpy.clip(cosine * scale - math.cos(cone[1]) * scale, 0, 1)
            return 20 * share**2 / distance**2

        # Recommendations of glTF.
        yield case(f"spot, {form}", {"type": "spot", "intensity": 20, "spot": written}, under(straight, radiant), translation=straight.tolist())


def normals():
    """A flat quad with coordinates along x and y: the tangent is +X, the bitangent +Y."""
    values = numpy.round((0.5 + 0.5 * numpy.stack([0.5 * texels(1, seed=4)[:, :, 0] - 0.2, 0.6 * texels(1, seed=6)[:, :, 0] - 0.3, numpy.full((4, 4), 0.9)], axis=2)) * 255) / 255

    def bent(scale):
        def normal(hit):
            vector = sample(values, hit.attributes["uv"], is_linear=False) * 2 - 1
            vector = vector * [scale, scale, 1]
            return vector / numpy.linalg.norm(vector, axis=1, keepdims=True)
        return normal

    for form, scale in (("scale not given", 1), ("scale 0.5", 0.5), ("scale 1.5", 1.5), ("scale 0", 0)):
        info = {} if form == "scale not given" else {"scale": scale}
        for metallic, roughness in ((0, 1), (1, 0.5)):
            yield lit("normalTexture", f"{form}, metallic {metallic}", {"baseColorFactor": [0.6, 0.9, 0.4, 1], "metallicFactor": metallic, "roughnessFactor": roughness}, under_sun([0.6, 0.9, 0.4], metallic, roughness, normal=bent(scale)), extra=lambda d, info=info: {"normalTexture": {"index": d.texture(png(values), sampler=NEAR), **info}}, attributes=lambda d: {"NORMAL": d.accessor([(0, 0, 1)] * 4)}, beside_cycles=metallic == 1 and scale <= 1)

    def turned(document):
        """Tangents that are written and lie otherwise than the coordinates do."""
        return {"NORMAL": document.accessor([(0, 0, 1)] * 4), "TANGENT": document.accessor([(0, 1, 0, -1)] * 4)}

    def by_tangents(hit):
        vector = sample(values, hit.attributes["uv"], is_linear=False) * 2 - 1
        tangent, bitangent = numpy.array([0, 1, 0]), -numpy.cross([0, 0, 1], [0, 1, 0])
        made = vector[:, :1] * tangent + vector[:, 1:2] * bitangent + vector[:, 2:] * [0, 0, 1]
        return made / numpy.linalg.norm(made, axis=1, keepdims=True)

    yield lit("TANGENT", "across the coordinates, turned over", {"baseColorFactor": [0.6, 0.9, 0.4, 1], "metallicFactor": 0}, under_sun([0.6, 0.9, 0.4], normal=by_tangents), extra=lambda d: {"normalTexture": {"index": d.texture(png(values), sampler=NEAR)}}, attributes=turned)

    def smooth(hit):
        vector = hit.attributes["normal"]
        return vector / numpy.linalg.norm(vector, axis=1, keepdims=True)

    bulge = numpy.array([(-0.4, -0.3, 1), (0.5, -0.2, 1), (0.3, 0.4, 1), (-0.2, 0.5, 1)])
    bulge = bulge / numpy.linalg.norm(bulge, axis=1, keepdims=True)
    for word, component, normalized in (("float", FLOAT, False),):
        case = lit("NORMAL", word, {"baseColorFactor": [0.6, 0.9, 0.4, 1], "metallicFactor": 0}, under_sun([0.6, 0.9, 0.4], normal=smooth), attributes=lambda d: {"NORMAL": d.accessor(bulge)})
        case.things[0].attributes["normal"] = bulge
        yield case


def others():
    def variants(document):
        document.use("KHR_materials_variants")
        document.json.setdefault("extensions", {})["KHR_materials_variants"] = {"variants": [{"name": "first"}, {"name": "second"}]}
        other = texels(3, seed=30)
        first, second = glowing(document, png(PICTURE), NEAR), glowing(document, png(other), NEAR)
        mesh = quad(document, first)
        document.json["meshes"][mesh]["primitives"][0]["extensions"] = {"KHR_materials_variants": {"mappings": [{"material": first, "variants": [0]}, {"material": second, "variants": [1]}]}}
        document.node(mesh=mesh)
        return [plain(look=glow(other))]

    yield shown("KHR_materials_variants", "second", variants, variant="second", beside_cycles=False)

    def glossy(document, texture):
        sun(document)
        words = {"diffuseFactor": [0.6, 0.9, 0.4, 1], "specularFactor": [0, 0, 0], "glossinessFactor": 0}
        if texture:
            words["diffuseTexture"] = {"index": document.texture(png(PICTURE), sampler=NEAR)}
        document.use("KHR_materials_pbrSpecularGlossiness")
        material = document.add("materials", {"extensions": {"KHR_materials_pbrSpecularGlossiness": words}, "doubleSided": True})
        document.node(mesh=quad(document, material))
        base = [0.6, 0.9, 0.4]
        if texture:
            base = lambda hit: sample(linear(PICTURE), hit.attributes["uv"], is_linear=False) * [0.6, 0.9, 0.4]

        def look(hit):
            colour = base(hit) if texture else numpy.array(base)
            cosine = numpy.clip((hit.normal * SUN).sum(axis=1), 0, 1)[:, None]
            return colour / math.pi * cosine * 3.0, numpy.ones(len(hit.position))

        return [plain(look=look)]

    for texture in (False, True):
        yield shown("KHR_materials_pbrSpecularGlossiness", f"diffuse {'factor and texture' if texture else 'factor'}", lambda d, t=texture: glossy(d, t), depth=2, beside_cycles=False)

    def morphed(document, at):
        moves = [numpy.array([(0, 0, 0), (-0.5, 0, 0), (0, -0.4, 0), (0, 0, 0)], float), numpy.array([(0.3, 0.2, 0), (0, 0, 0), (0, 0, 0), (0, -0.6, 0)], float)]
        mesh = quad(document, glowing(document, png(PICTURE), NEAR))
        document.json["meshes"][mesh]["primitives"][0]["targets"] = [{"POSITION": document.accessor(move)} for move in moves]
        weights = [0.8, 0.5]
        if at == "mesh":
            document.json["meshes"][mesh]["weights"] = weights
            document.node(mesh=mesh)
        else:
            document.json["meshes"][mesh]["weights"] = [0.0, 0.0]
            document.node(mesh=mesh, weights=weights)
        return [plain(CORNERS + 0.8 * moves[0] + 0.5 * moves[1])]

    for at in ("mesh", "node"):
        yield shown("morph targets", f"weights of the {at}", lambda d, at=at: morphed(d, at), beside_cycles=at == "mesh")

    def skinned(document):
        joints = [document.node(translation=[0.1, 0.2, 0]), document.node(rotation=quaternion((0, 0, 1), 20), scale=[0.8, 0.8, 1])]
        inverse = numpy.eye(4)
        inverse[:3, 3] = [-0.2, 0, 0]
        bind = document.accessor([numpy.eye(4).T.ravel(), inverse.T.ravel()])
        weights = numpy.array([(1, 0, 0, 0), (0, 1, 0, 0), (0.5, 0.5, 0, 0), (0.25, 0.75, 0, 0)])
        attributes = {"JOINTS_0": document.accessor([(0, 1, 0, 0)] * 4, UBYTE), "WEIGHTS_0": document.accessor(weights)}
        skin = document.add("skins", {"joints": joints, "inverseBindMatrices": bind})
        document.node(mesh=quad(document, glowing(document, png(PICTURE), NEAR), attributes=attributes), skin=skin, translation=[5, 5, 5])
        maps = [matrix((0.1, 0.2, 0)), matrix(rotation=quaternion((0, 0, 1), 20), scale=(0.8, 0.8, 1)) @ inverse]
        bent = sum(weights[:, index : index + 1] * moved(map_) for index, map_ in enumerate(maps))
        return [plain(bent)]

    yield shown("skin", "two joints", skinned, beside_cycles=False)
