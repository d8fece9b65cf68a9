"""Cases of BSDFs."""

from . import files, values
from .scene import Case, ball, bsdf, card, diffuse, element, flag, number, rgb, string, texture, tilted

RED, BLUE = diffuse(0.7, 0.15, 0.1), diffuse(0.1, 0.2, 0.6)
GLASS = 7


def cases():
    yield from colours()
    yield from numbers()
    yield from conductors()
    yield from dielectrics()
    yield from plastics()
    yield from principled()
    yield from around()


def colours():
    """Every form on one slot of each kind, the usual ones on the others."""
    slots = [
        ("diffuse", "reflectance", (), card, True),
        ("conductor", "specular_reflectance", (), tilted, True),
        ("roughconductor", "specular_reflectance", (number("alpha", 0.3), string("material", "Au")), tilted, False),
        ("dielectric", "specular_reflectance", (), lambda surface: card(surface, GLASS), False),
        ("dielectric", "specular_transmittance", (), lambda surface: card(surface, GLASS), False),
        ("roughdielectric", "specular_reflectance", (number("alpha", 0.3),), lambda surface: card(surface, GLASS), False),
        ("roughdielectric", "specular_transmittance", (number("alpha", 0.3),), lambda surface: card(surface, GLASS), False),
        ("thindielectric", "specular_reflectance", (), lambda surface: card(surface, GLASS), False),
        ("thindielectric", "specular_transmittance", (), lambda surface: card(surface, GLASS), False),
        ("plastic", "diffuse_reflectance", (), card, True),
        ("plastic", "specular_reflectance", (), tilted, False),
        ("roughplastic", "diffuse_reflectance", (number("alpha", 0.3),), card, False),
        ("roughplastic", "specular_reflectance", (number("alpha", 0.3),), tilted, False),
        ("principled", "base_color", (), card, False),
        ("principledthin", "base_color", (), card, False),
    ]
    for name, parameter, others, rig, all_forms in slots:
        for form, written in values.of_surface(parameter):
            if all_forms or form in values.SHORT:
                yield Case("bsdf", name, parameter, form, rig(bsdf(name, *others, written)), rig(bsdf(name, *others)))
    yield Case("bsdf", "diffuse", "reflectance", "black", ball(bsdf("diffuse", rgb("reflectance", 0))), ball(bsdf("diffuse")))
    yield Case("bsdf", "diffuse", "reflectance", "white", card(bsdf("diffuse", rgb("reflectance", 1))), card(bsdf("diffuse")))
    yield Case("bsdf", "diffuse", "reflectance", "not given", ball(bsdf("diffuse")), ball(diffuse(0.6)))
    yield Case("bsdf", "diffuse", "reflectance", "no bsdf at all", ball(""), ball(diffuse(0.6)))
    yield Case("bsdf", "diffuse", "reflectance", "above 1", card(diffuse(1.4, 0.5, 0.2)), card(diffuse(1, 0.5, 0.2)))


def numbers():
    """Slots of one number each."""
    gold = string("material", "Au")
    mixed = lambda written: bsdf("blendbsdf", written, RED, BLUE)
    masked = lambda written: bsdf("mask", written, RED)
    slots = [
        ("roughconductor", "alpha", lambda written: bsdf("roughconductor", gold, written), tilted, True),
        ("roughconductor", "alpha_u", lambda written: bsdf("roughconductor", gold, written, number("alpha_v", 0.3)), tilted, False),
        ("roughdielectric", "alpha", lambda written: bsdf("roughdielectric", written), lambda surface: tilted(surface, GLASS), False),
        ("blendbsdf", "weight", mixed, card, True),
        ("mask", "opacity", masked, card, True),
        ("principled", "roughness", lambda written: bsdf("principled", written, rgb("base_color", 0.8, 0.5, 0.2), number("metallic", 1)), tilted, False),
        ("principled", "metallic", lambda written: bsdf("principled", written, rgb("base_color", 0.8, 0.5, 0.2)), tilted, False),
    ]
    for name, parameter, made, rig, all_forms in slots:
        for form, written in values.of_number(parameter):
            if all_forms or form in values.SHORT_NUMBERS:
                yield Case("bsdf", name, parameter, form, rig(made(written)), rig(made(number(parameter, 0.95))))
        yield Case("bsdf", name, parameter, "not given", rig(made("")), rig(made(number(parameter, 0.77))))


def conductors():
    bronze = rgb("eta", 0.4, 0.9, 1.3), rgb("k", 3, 2.4, 2)
    plain = ball(bsdf("conductor"))
    rough = lambda *within: ball(bsdf("roughconductor", *within))
    for material in ("Au", "Ag", "Cu", "Al", "Cr", "W", "none", "a-C", "TiN", "Hg", "VN", "K", "Cu2O", "CuO", "d-C", "Ir", "Li", "MgO", "Mo", "Na_palik", "Nb", "Rh", "Se", "SiC", "SnTe", "Ta", "Te", "ThF4", "TiC", "TiO2", "VC", "AlAs", "AlSb", "Be", "CsI", "Cs", "Ni", "Pd", "Pt", "Ti", "V", "Na", "HgTe"):
        other = ball(bsdf("conductor", string("material", "Mo"))) if material == "none" else plain
        yield Case("bsdf", "conductor", "material", material, ball(bsdf("conductor", string("material", material))), other)
    for form, within in [
        ("rgb of three", bronze),
        ("float", (number("eta", 1.1), number("k", 1.5))),
        ("spectrum of pairs", (element("spectrum", name="eta", value="400:1.4 500:0.9 700:0.3"), element("spectrum", name="k", value="400:2 700:3.6"))),
        ("eta alone", (rgb("eta", 0.4, 0.9, 1.3),)),
        ("k alone", (rgb("k", 3, 2.4, 2),)),
        ("eta of 0 and k of 1", (number("eta", 0), number("k", 1))),
        ("eta as a bitmap", (values.bitmap("eta", files.COLOURS), number("k", 2))),
        ("k as a bitmap", (number("eta", 0.4), values.bitmap("k", files.COLOURS))),
        ("beside a tint", (*bronze, rgb("specular_reflectance", 0.9, 0.6, 0.4))),
    ]:
        yield Case("bsdf", "conductor", "eta, k", form, ball(bsdf("conductor", *within)), ball(bsdf("conductor", string("material", "Mo"))))
        yield Case("bsdf", "roughconductor", "eta, k", form, rough(number("alpha", 0.25), *within), rough(number("alpha", 0.25), string("material", "Mo")))
    yield Case("bsdf", "conductor", "material", "not given", plain, ball(bsdf("conductor", string("material", "Au"))))
    yield Case("bsdf", "roughconductor", "material", "not given", rough(), rough(string("material", "Au")))
    for material in ("Au", "none", "Cr"):
        yield Case("bsdf", "roughconductor", "material", material, rough(string("material", material)), rough(string("material", "Mo")))
    yield Case("bsdf", "roughconductor", "material", "none, with a tint", rough(string("material", "none"), rgb("specular_reflectance", 0.9, 0.5, 0.3)), rough())
    yield Case("bsdf", "roughconductor", "material", "not given, with a tint", rough(rgb("specular_reflectance", 0.9, 0.5, 0.3)), rough())
    gold = string("material", "Au")
    for distribution in ("beckmann", "ggx", "GGX"):
        for alpha in (0.02, 0.1, 0.3, 0.6, 1.0):
            within = gold, string("distribution", distribution), number("alpha", alpha)
            yield Case("bsdf", "roughconductor", "distribution", f"{distribution}, alpha {alpha}", rough(*within), rough(gold, number("alpha", 0.2)))
    for distribution in ("beckmann", "ggx"):
        for u, v in ((0.1, 0.4), (0.5, 0.15)):
            within = gold, string("distribution", distribution), number("alpha_u", u), number("alpha_v", v)
            other = gold, string("distribution", distribution), number("alpha_u", v), number("alpha_v", u)
            yield Case("bsdf", "roughconductor", "alpha_u, alpha_v", f"{distribution}, {u} and {v}, on a square", tilted(bsdf("roughconductor", *within)), tilted(bsdf("roughconductor", *other)))
            yield Case("bsdf", "roughconductor", "alpha_u, alpha_v", f"{distribution}, {u} and {v}, on a sphere", rough(*within), rough(*other))
    yield Case("bsdf", "roughconductor", "sample_visible", "false", rough(gold, number("alpha", 0.3), flag("sample_visible", False)), None)


def dielectrics():
    for name, others in (("dielectric", ()), ("thindielectric", ()), ("roughdielectric", (number("alpha", 0.2),))):
        rig = lambda *within: ball(bsdf(name, *others, *within), GLASS)
        plain = rig()
        yield Case("bsdf", name, "int_ior, ext_ior", "not given", plain, rig(number("int_ior", 1.2)))
        for form, within in [
            ("int_ior of 1.33", (number("int_ior", 1.33),)),
            ("int_ior of 2.4", (number("int_ior", 2.4),)),
            ("ext_ior of 1.2", (number("ext_ior", 1.2),)),
            ("below 1", (number("int_ior", 1.0), number("ext_ior", 1.5))),
            ("int_ior by name", (string("int_ior", "diamond"),)),
            ("ext_ior by name", (string("ext_ior", "water"),)),
            ("equal", (number("int_ior", 1.3), number("ext_ior", 1.3))),
        ]:
            yield Case("bsdf", name, "int_ior, ext_ior", form, rig(*within), plain)
    for material in ("vacuum", "bromine", "water ice", "fused quartz", "pyrex", "acrylic glass", "polypropylene", "bk7", "sodium chloride", "amber", "pet", "acetone", "ethanol", "carbon tetrachloride", "glycerol", "benzene", "silicone oil", "helium", "hydrogen", "air", "carbon dioxide", "water"):
        yield Case("bsdf", "dielectric", "int_ior, ext_ior", f"name {material}", ball(bsdf("dielectric", string("int_ior", material)), GLASS), ball(bsdf("dielectric", number("int_ior", 1.9)), GLASS))
    rough = lambda *within: ball(bsdf("roughdielectric", *within), GLASS)
    for distribution in ("beckmann", "ggx"):
        for alpha in (0.05, 0.3, 0.7):
            yield Case("bsdf", "roughdielectric", "distribution", f"{distribution}, alpha {alpha}", rough(string("distribution", distribution), number("alpha", alpha)), rough(number("alpha", 0.15)))
        yield Case("bsdf", "roughdielectric", "alpha_u, alpha_v", distribution, tilted(bsdf("roughdielectric", string("distribution", distribution), number("alpha_u", 0.1), number("alpha_v", 0.5)), GLASS), tilted(bsdf("roughdielectric", string("distribution", distribution), number("alpha_u", 0.5), number("alpha_v", 0.1)), GLASS))
    yield Case("bsdf", "roughdielectric", "sample_visible", "false", rough(number("alpha", 0.3), flag("sample_visible", False)), None)


def plastics():
    for name, others in (("plastic", ()), ("roughplastic", (number("alpha", 0.2),))):
        rig = lambda *within: ball(bsdf(name, *others, *within))
        plain = rig()
        yield Case("bsdf", name, "int_ior, ext_ior", "not given", plain, rig(number("int_ior", 1.2)))
        for form, within in [
            ("int_ior of 1.9", (number("int_ior", 1.9),)),
            ("ext_ior of 1.2", (number("ext_ior", 1.2),)),
            ("int_ior by name", (string("int_ior", "diamond"),)),
        ]:
            yield Case("bsdf", name, "int_ior, ext_ior", form, rig(*within), plain)
        tint = rgb("diffuse_reflectance", 0.9, 0.6, 0.3)
        yield Case("bsdf", name, "nonlinear", "true", rig(flag("nonlinear", True), tint), rig(tint))
        yield Case("bsdf", name, "nonlinear", "false", rig(flag("nonlinear", False), tint), rig(flag("nonlinear", True), tint))
    rough = lambda *within: ball(bsdf("roughplastic", *within))
    yield Case("bsdf", "roughplastic", "alpha", "not given", rough(), rough(number("alpha", 0.5)))
    for distribution in ("beckmann", "ggx"):
        for alpha in (0.05, 0.3, 0.6):
            yield Case("bsdf", "roughplastic", "distribution", f"{distribution}, alpha {alpha}", rough(string("distribution", distribution), number("alpha", alpha)), rough(number("alpha", 0.95)))
    yield Case("bsdf", "roughplastic", "sample_visible", "false", rough(number("alpha", 0.3), flag("sample_visible", False)), None)


def principled():
    base = rgb("base_color", 0.8, 0.5, 0.2)
    for parameter, amounts in [
        ("metallic", (0.5, 1)), ("roughness", (0.1, 0.9)), ("specular", (0.1, 0.9)), ("eta", (1.3, 1.8)), ("spec_tint", (1,)), ("anisotropic", (0.8,)),
        ("sheen", (1,)), ("sheen_tint", (1,)), ("clearcoat", (1,)), ("clearcoat_gloss", (0.9,)), ("flatness", (1,)), ("spec_trans", (0.6, 1)),
    ]:
        with_ = {"sheen_tint": (number("sheen", 1),), "clearcoat_gloss": (number("clearcoat", 1),), "anisotropic": (number("metallic", 1), number("roughness", 0.4)), "spec_tint": (number("specular", 0.8),)}.get(parameter, ())
        if parameter == "eta":
            with_ = (number("spec_trans", 0.5),)
        for amount in amounts:
            depth = GLASS if parameter in ("spec_trans", "eta") else 3
            yield Case("bsdf", "principled", parameter, str(amount), ball(bsdf("principled", base, *with_, number(parameter, amount)), depth), ball(bsdf("principled", base, *with_), depth))
    yield Case("bsdf", "principled", "base_color", "nothing given", ball(bsdf("principled")), ball(bsdf("principled", base)))
    for parameter, amounts in [("roughness", (0.1, 0.9)), ("eta", (1.3, 1.8)), ("spec_tint", (1,)), ("anisotropic", (0.8,)), ("sheen", (1,)), ("sheen_tint", (1,)), ("flatness", (1,)), ("spec_trans", (0.6, 1)), ("diff_trans", (0.5, 2))]:
        with_ = {"sheen_tint": (number("sheen", 1),), "anisotropic": (number("spec_trans", 0.8), number("roughness", 0.4)), "spec_tint": (number("spec_trans", 0.8),), "eta": (number("spec_trans", 0.5),)}.get(parameter, ())
        for amount in amounts:
            yield Case("bsdf", "principledthin", parameter, str(amount), tilted(bsdf("principledthin", base, *with_, number(parameter, amount)), GLASS), tilted(bsdf("principledthin", base, *with_), GLASS))
    for parameter in ("diffuse_reflectance_sampling_rate", "main_specular_sampling_rate", "clearcoat_sampling_rate"):
        yield Case("bsdf", "principled", parameter, "2", ball(bsdf("principled", base, number(parameter, 2))), None)


def around():
    """BSDFs that hold others."""
    from .scene import LAMP, camera, light_box, path, rotate, scale, scene, shape, transform

    def behind(surface, depth=2):
        """A square that shows its back."""
        seen = shape("rectangle", transform(rotate(0, 1, 0, 155), scale(1.3)), surface)
        return scene(path(depth), camera("0, 0.8, 5", fov=26), seen, light_box(), LAMP)

    two = lambda *within: bsdf("twosided", *within)
    for name, surface in [("diffuse", RED), ("plastic", bsdf("plastic")), ("roughconductor", bsdf("roughconductor", string("material", "Au"), number("alpha", 0.3))), ("conductor", bsdf("conductor", string("material", "Cu")))]:
        yield Case("bsdf", "twosided", "bsdf", f"{name}, from behind", behind(two(surface)), behind(surface))
        yield Case("bsdf", name, "twosided", "not there, from behind", behind(surface), behind(two(surface)))
        yield Case("bsdf", "twosided", "bsdf", f"{name}, on a sphere", ball(two(surface)), ball(BLUE))
    yield Case("bsdf", "twosided", "bsdf", "two, from the front", card(two(RED, BLUE)), card(two(BLUE, RED)))
    yield Case("bsdf", "twosided", "bsdf", "two, from behind", behind(two(RED, BLUE)), behind(two(BLUE, RED)))
    yield Case("bsdf", "twosided", "bsdf", "two of a rough metal and a diffuse one, from behind", behind(two(BLUE, bsdf("roughconductor", number("alpha", 0.3)))), behind(two(BLUE)))
    yield Case("bsdf", "twosided", "bsdf", "two alike, from behind", behind(two(RED, RED)), behind(RED))
    yield Case("bsdf", "twosided", "bsdf", "around a mask, from behind", behind(bsdf("mask", number("opacity", 0.6), two(RED))), behind(bsdf("mask", number("opacity", 0.6), RED)))
    yield Case("bsdf", "twosided", "bsdf", "around a blend, from behind", behind(two(bsdf("blendbsdf", number("weight", 0.3), RED, BLUE))), behind(RED))
    yield Case("bsdf", "twosided", "bsdf", "within a blend, from behind", behind(bsdf("blendbsdf", number("weight", 0.3), two(RED), two(BLUE))), behind(RED))
    yield Case("bsdf", "twosided", "bsdf", "one part of a blend, from behind", behind(bsdf("blendbsdf", number("weight", 0.3), two(RED), BLUE)), behind(bsdf("blendbsdf", number("weight", 0.3), RED, two(BLUE))))
    for name, surface in [("mask", bsdf("mask", number("opacity", 0.6), RED)), ("blendbsdf", bsdf("blendbsdf", number("weight", 0.3), RED, BLUE))]:
        yield Case("bsdf", name, "bsdf", "from behind", behind(surface), behind(two(RED)))
    for opacity in (0, 0.25, 0.5, 1):
        yield Case("bsdf", "mask", "opacity", f"{opacity}, on a sphere", ball(bsdf("mask", number("opacity", opacity), RED), 6), ball(bsdf("mask", number("opacity", 0.75), RED), 6))
    inner = {
        "plastic": bsdf("plastic"), "glass": bsdf("dielectric"), "rough metal": bsdf("roughconductor", string("material", "Au"), number("alpha", 0.3)),
        "rough plastic": bsdf("roughplastic"), "mirror": bsdf("conductor"), "principled": bsdf("principled"), "mask": bsdf("mask", number("opacity", 0.5), BLUE),
        "rough glass": bsdf("roughdielectric", number("alpha", 0.3)), "nothing": bsdf("null"),
    }
    for name, surface in inner.items():
        yield Case("bsdf", "mask", "bsdf", name, ball(bsdf("mask", number("opacity", 0.6), surface), 6), ball(bsdf("mask", number("opacity", 0.6), RED), 6))
        yield Case("bsdf", "blendbsdf", "bsdf", f"diffuse and {name}", ball(bsdf("blendbsdf", number("weight", 0.4), RED, surface), 6), ball(bsdf("blendbsdf", number("weight", 0.4), RED, BLUE), 6))
        yield Case("bsdf", "blendbsdf", "bsdf", f"{name} and diffuse", ball(bsdf("blendbsdf", number("weight", 0.4), surface, RED), 6), ball(bsdf("blendbsdf", number("weight", 0.4), BLUE, RED), 6))
    yield Case("bsdf", "blendbsdf", "weight", "below 0", card(bsdf("blendbsdf", number("weight", -0.5), RED, BLUE)), card(bsdf("blendbsdf", number("weight", 0.5), RED, BLUE)))
    yield Case("bsdf", "blendbsdf", "weight", "above 1", card(bsdf("blendbsdf", number("weight", 1.5), RED, BLUE)), card(bsdf("blendbsdf", number("weight", 0.5), RED, BLUE)))
    yield Case("bsdf", "null", "bsdf", "on a sphere", ball(bsdf("null"), 5), ball(RED, 5))
    normals = values.bitmap("normalmap", files.NORMALS, raw=True, filter_="bilinear")
    smooth = values.bitmap("normalmap", files.NORMALS, filter_="bilinear")
    metal = bsdf("roughconductor", string("material", "Au"), number("alpha", 0.3))
    for name, surface in [("diffuse", RED), ("roughconductor", metal), ("plastic", bsdf("plastic")), ("roughplastic", bsdf("roughplastic", number("alpha", 0.2))), ("conductor", bsdf("conductor")), ("twosided", two(RED)), ("dielectric", bsdf("dielectric"))]:
        depth = GLASS if name == "dielectric" else 2
        yield Case("bsdf", "normalmap", "normalmap", f"over {name}, on a square", tilted(bsdf("normalmap", normals, surface), depth), tilted(surface, depth))
        yield Case("bsdf", "normalmap", "normalmap", f"over {name}, on a sphere", ball(bsdf("normalmap", normals, surface), depth), ball(surface, depth))
    yield Case("bsdf", "normalmap", "normalmap", "not raw", tilted(bsdf("normalmap", smooth, RED)), tilted(RED))
    yield Case("bsdf", "normalmap", "normalmap", "within twosided, from behind", behind(two(bsdf("normalmap", normals, RED))), behind(two(RED)))
    yield Case("bsdf", "normalmap", "normalmap", "within a blend", tilted(bsdf("blendbsdf", number("weight", 0.4), bsdf("normalmap", normals, RED), bsdf("normalmap", normals, BLUE))), tilted(RED))
    yield Case("bsdf", "normalmap", "normalmap", "over a blend", tilted(bsdf("normalmap", normals, bsdf("blendbsdf", number("weight", 0.4), RED, BLUE))), tilted(RED))
    yield Case("bsdf", "normalmap", "normalmap", "one part of a blend", tilted(bsdf("blendbsdf", number("weight", 0.4), bsdf("normalmap", normals, RED), BLUE)), tilted(RED))
    yield Case("bsdf", "normalmap", "normalmap", "within a mask", tilted(bsdf("mask", number("opacity", 0.6), bsdf("normalmap", normals, RED))), tilted(RED))
    yield Case("bsdf", "normalmap", "normalmap", "over a mask", tilted(bsdf("normalmap", normals, bsdf("mask", number("opacity", 0.6), RED))), tilted(RED))
    for parameter in ("use_shadowing_function", "flip_invalid_normals"):
        yield Case("bsdf", "normalmap", parameter, "false", tilted(bsdf("normalmap", flag(parameter, False), normals, metal)), tilted(metal))
    heights = values.bitmap(None, files.HEIGHTS, raw=True, filter_="bilinear")
    for name, surface in [("diffuse", RED), ("roughconductor", metal), ("twosided", two(RED))]:
        yield Case("bsdf", "bumpmap", "texture", f"over {name}, on a square", tilted(bsdf("bumpmap", heights, number("scale", 0.3), surface)), tilted(surface))
        yield Case("bsdf", "bumpmap", "texture", f"over {name}, on a sphere", ball(bsdf("bumpmap", heights, number("scale", 0.3), surface)), ball(surface))
    yield Case("bsdf", "bumpmap", "scale", "not given", tilted(bsdf("bumpmap", heights, RED)), tilted(RED))
    yield Case("bsdf", "bumpmap", "scale", "negative", tilted(bsdf("bumpmap", heights, number("scale", -0.3), RED)), tilted(bsdf("bumpmap", heights, number("scale", 0.3), RED)))
    yield Case("bsdf", "bumpmap", "texture", "not raw", tilted(bsdf("bumpmap", values.bitmap(None, files.HEIGHTS, filter_="bilinear"), number("scale", 0.3), RED)), tilted(bsdf("bumpmap", heights, number("scale", 0.3), RED)))
    yield Case("bsdf", "bumpmap", "texture", "in single precision", tilted(bsdf("bumpmap", values.bitmap(None, files.HEIGHTS_FLOAT, filter_="bilinear"), number("scale", 0.3), RED)), tilted(RED))
    for parameter in ("use_shadowing_function", "flip_invalid_normals"):
        yield Case("bsdf", "bumpmap", parameter, "false", tilted(bsdf("bumpmap", flag(parameter, False), heights, number("scale", 0.4), metal)), tilted(metal))
    checks = texture("checkerboard")
    yield Case("bsdf", "bumpmap", "texture", "a checkerboard", tilted(bsdf("bumpmap", checks, RED)), None)
