"""What the specification of glTF 2.0 says a picture shows, by numpy: triangles, textures, cameras, punctual lights, and the reflection of its
Appendix B.

Nothing is traced here but rays from the camera. So the scenes that are held against this have no light that is reflected twice."""

import math
from dataclasses import dataclass, field

import numpy

# Rays along each side of a pixel.
RAYS = 24


@dataclass
class Triangles:
    """Corners in the world, attributes of the vertices, and what is seen there: a function of the places in `Hit` that gives the radiance and the
    share that is opaque."""

    positions: numpy.ndarray
    faces: numpy.ndarray
    look: object
    attributes: dict = field(default_factory=dict)
    double_sided: bool = True


@dataclass
class Hit:
    position: numpy.ndarray
    # The normal of the face, towards the viewer.
    normal: numpy.ndarray
    # Towards the viewer.
    view: numpy.ndarray
    attributes: dict


@dataclass
class Camera:
    """Looks along -Z of its matrix. `half` is half the height at distance 1, or of an orthographic camera anywhere; `aspect` width over height."""

    matrix: numpy.ndarray
    half: float
    aspect: float = 1.0
    is_orthographic: bool = False


def picture(camera, things, width=16, height=16, background=(0.0, 0.0, 0.0)):
    """Means of pixels, by a ray in each cell of a grid over the pixel, and the variance of those means. An edge crosses about RAYS cells, in each
    of which it is met or not."""
    random = numpy.random.default_rng(1)
    columns, rows = numpy.meshgrid(numpy.arange(width * RAYS), numpy.arange(height * RAYS))
    place = lambda cells, count: (cells + random.random(cells.shape)) / (count * RAYS) * 2 - 1
    x, y = place(columns, width) * camera.half * camera.aspect, -place(rows, height) * camera.half
    matrix = numpy.asarray(camera.matrix, float)
    unit = matrix[:3, :3] / numpy.linalg.norm(matrix[:3, :3], axis=0)
    flat = numpy.stack([x.ravel(), y.ravel()], axis=1)
    if camera.is_orthographic:
        origins = matrix[:3, 3] + flat @ unit[:, :2].T
        directions = numpy.broadcast_to(-unit[:, 2], origins.shape)
    else:
        directions = flat @ unit[:, :2].T - unit[:, 2]
        directions = directions / numpy.linalg.norm(directions, axis=1, keepdims=True)
        origins = numpy.broadcast_to(matrix[:3, 3], directions.shape)
    colours = _seen(origins, directions, things, numpy.asarray(background, float))
    rays = colours.reshape(height, RAYS, width, RAYS, 3)
    return rays.mean(axis=(1, 3)), numpy.ptp(rays, axis=(1, 3)) ** 2 / (4 * RAYS**3)


def _seen(origins, directions, things, background):
    found = []
    for thing in things:
        for face in thing.faces:
            a, b, c = thing.positions[face]
            edge1, edge2 = b - a, c - a
            across = numpy.cross(directions, edge2)
            volume = across @ edge1
            with numpy.errstate(divide="ignore", invalid="ignore"):
                from_a = origins - a
                u = (from_a * across).sum(axis=1) / volume
                other = numpy.cross(from_a, edge1)
                v = (directions * other).sum(axis=1) / volume
                t = other @ edge2 / volume
                inside = (u >= 0) & (v >= 0) & (u + v <= 1) & (t > 1e-6) & (numpy.abs(volume) > 1e-12)
            if not thing.double_sided:
                # Seen from the front, the corners turn counter-clockwise.
                inside &= volume > 0
            found.append((numpy.where(inside, t, numpy.inf), u, v, thing, face))
    total = numpy.zeros((len(origins), 3))
    left = numpy.ones(len(origins))
    distances = numpy.array([one[0] for one in found])
    order = numpy.argsort(distances, axis=0)
    for rank in range(min(len(found), 6)):
        nearest = order[rank]
        for index, (t, u, v, thing, face) in enumerate(found):
            rays = numpy.nonzero((nearest == index) & numpy.isfinite(t) & (left > 0))[0]
            if not len(rays):
                continue
            weights = numpy.stack([1 - u[rays] - v[rays], u[rays], v[rays]], axis=1)
            a, b, c = thing.positions[face]
            normal = numpy.cross(b - a, c - a)
            normal = normal / numpy.linalg.norm(normal)
            facing = numpy.where((directions[rays] @ normal)[:, None] > 0, -normal, normal)
            values = {name: weights @ numpy.asarray(of[face], float) for name, of in thing.attributes.items()}
            hit = Hit(origins[rays] + t[rays, None] * directions[rays], facing, -directions[rays], values)
            radiance, opaque = thing.look(hit)
            total[rays] += (left[rays] * opaque)[:, None] * radiance
            left[rays] *= 1 - opaque
    return total + left[:, None] * background


def linear(encoded):
    """Of sRGB; alpha, the fourth channel, is as it stands."""
    encoded = numpy.asarray(encoded, float)
    decoded = numpy.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)
    return numpy.concatenate([decoded[..., :3], encoded[..., 3:]], axis=-1)


REPEAT, CLAMP, MIRROR = 10497, 33071, 33648
NEAREST, LINEAR = 9728, 9729


def sample(texels, uv, wrap=(REPEAT, REPEAT), is_linear=True):
    """Texels at texture coordinates whose origin is the upper left corner of the picture."""
    height, width = texels.shape[:2]
    places = uv * [width, height]

    def wrapped(index, count, mode):
        if mode == CLAMP:
            return numpy.clip(index, 0, count - 1)
        if mode == MIRROR:
            index = index % (2 * count)
            return numpy.where(index >= count, 2 * count - 1 - index, index)
        return index % count

    if not is_linear:
        index = numpy.floor(places).astype(int)
        return texels[wrapped(index[:, 1], height, wrap[1]), wrapped(index[:, 0], width, wrap[0])]
    places = places - 0.5
    low = numpy.floor(places).astype(int)
    part = places - low
    total = 0
    for dx in (0, 1):
        for dy in (0, 1):
            share = (part[:, 0] if dx else 1 - part[:, 0]) * (part[:, 1] if dy else 1 - part[:, 1])
            total = total + share[:, None] * texels[wrapped(low[:, 1] + dy, height, wrap[1]), wrapped(low[:, 0] + dx, width, wrap[0])]
    return total


def reflected(base, metallic, roughness, normal, view, light, ior=1.5, specular=1.0, specular_colour=(1, 1, 1)):
    """BRDF times cosine of Appendix B, with KHR_materials_ior and KHR_materials_specular."""
    dot = lambda a, b: (a * b).sum(axis=-1)
    half = view + light
    half = half / numpy.linalg.norm(half, axis=-1, keepdims=True)
    alpha2 = roughness**4
    nh, nl, nv, vh = (numpy.clip(dot(a, b), 0, 1) for a, b in ((normal, half), (normal, light), (normal, view), (view, half)))
    distribution = alpha2 / (math.pi * (nh**2 * (alpha2 - 1) + 1) ** 2)
    with numpy.errstate(divide="ignore", invalid="ignore"):
        visible = 0.5 / (nl * numpy.sqrt(nv**2 * (1 - alpha2) + alpha2) + nv * numpy.sqrt(nl**2 * (1 - alpha2) + alpha2))
    lobe = numpy.where(nl > 0, visible * distribution, 0)[..., None]
    grazing = ((1 - vh) ** 5)[..., None]
    f0 = numpy.minimum(((ior - 1) / (ior + 1)) ** 2 * numpy.asarray(specular_colour, float), 1) * specular
    fresnel = f0 + (specular - f0) * grazing
    # The diffuse part loses what the strongest channel reflects.
    dielectric = (1 - fresnel.max(axis=-1, keepdims=True)) * base / math.pi + fresnel * lobe
    metal = (base + (1 - base) * grazing) * lobe
    return (metallic * metal + (1 - metallic) * dielectric) * nl[..., None]
