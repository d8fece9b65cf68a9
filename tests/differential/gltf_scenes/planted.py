"""Files in which a value is off by a little: the comparison with what the unchanged file shows has to find each of them.

A row is the name of a scene, what is changed, and a function that changes the JSON."""


def _node(document, **words):
    """Of the first node that has a mesh."""
    next(node for node in document["nodes"] if "mesh" in node).update(words)


def _material(document):
    return document["materials"][-1]


def _light(document, **words):
    document["extensions"]["KHR_lights_punctual"]["lights"][0].update(words)


PLANTED = [
    ("camera: perspective", "2 % of the angle of view", lambda json: json["cameras"][0]["perspective"].update(yfov=0.51)),
    ("camera: orthographic, wide", "2 % of the height", lambda json: json["cameras"][0]["orthographic"].update(ymag=0.816, xmag=1.632)),
    ("node: translation", "a hundredth to the right", lambda json: _node(json, translation=[0.21, -0.15, 0.4])),
    ("node: scale", "2 % of the width", lambda json: _node(json, scale=[0.816, 0.5, 1])),
    ("KHR_texture_transform: offset", "a hundredth of the picture", lambda json: _material(json)["emissiveTexture"]["extensions"]["KHR_texture_transform"].update(offset=[0.31, 0.15])),
    ("KHR_texture_transform: rotation", "a degree", lambda json: _material(json)["emissiveTexture"]["extensions"]["KHR_texture_transform"].update(rotation=0.5175)),
    ("sampler: clamp and clamp, nearest", "another wrap", lambda json: json["samplers"][0].update(wrapS=10497)),
    ("baseColor: factor, metallic 0", "5 % of red", lambda json: _material(json)["pbrMetallicRoughness"].update(baseColorFactor=[0.63, 0.9, 0.4, 1])),
    ("metallicRoughness: factors 1 and 0.5", "3 % of the roughness", lambda json: _material(json)["pbrMetallicRoughness"].update(roughnessFactor=0.515)),
    ("metallicRoughness: factors 0.5 and 0.5", "4 % of metal", lambda json: _material(json)["pbrMetallicRoughness"].update(metallicFactor=0.52)),
    ("KHR_materials_ior: 1.5", "an index of 1.6", lambda json: _material(json)["extensions"]["KHR_materials_ior"].update(ior=1.6)),
    ("KHR_materials_specular: factor 0.4", "a factor of 0.45", lambda json: _material(json)["extensions"]["KHR_materials_specular"].update(specularFactor=0.45)),
    ("emission: strength of 5", "2 % of light", lambda json: _material(json)["extensions"]["KHR_materials_emissive_strength"].update(emissiveStrength=5.1)),
    ("alpha: BLEND, factor 0.3", "an alpha of 0.32", lambda json: _material(json)["pbrMetallicRoughness"].update(baseColorFactor=[0, 0, 0, 0.32])),
    ("alpha: MASK, texture", "a cut-off of 0.6", lambda json: _material(json).update(alphaCutoff=0.6)),
    ("normalTexture: scale 0.5, metallic 0", "a scale of 0.55", lambda json: _material(json)["normalTexture"].update(scale=0.55)),
    ("KHR_lights_punctual: point, metallic 0", "2 % of light", lambda json: _light(json, intensity=20.4)),
    ("KHR_lights_punctual: spot, cones of 0.1 and 0.35, metallic 0", "an outer cone of 0.36", lambda json: _light(json, spot={"innerConeAngle": 0.1, "outerConeAngle": 0.36})),
    ("morph targets: weights of the mesh", "a weight of 0.82", lambda json: json["meshes"][0].update(weights=[0.82, 0.5])),
]
