"""Where Cycles' importer says something else than the specification, and why. A row of which every scene agrees fails the
comparison."""

KNOWN = [
    (r"^sampler: (none|without filters)$", "differs", "Cycles interpolates the encoded values of pictures of 8 bits, the specification decodes texels first"),
    (r"^sampler: nearest when magnified", "differs", "Blender filters where one of the two filters is linear"),
    (r"^KHR_lights_punctual: .*intensity not given", "differs", "Blender keeps its own 10 W where the specification has 1"),
    (r"^normalTexture: scale 0\.5", "differs", "Blender's strength goes from the surface's normal to the map's along a line, the specification scales x and y"),
]
