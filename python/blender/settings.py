"""Size, filter, samples, path length and exposure of the picture."""

import math


def export(scene, file, report):
    """Writes `[film]` and `[render]`; returns the flags of `gpt render` for what only a preview shows."""
    render = scene.render
    percentage = render.resolution_percentage / 100
    file.film["size"] = [max(1, int(render.resolution_x * percentage)), max(1, int(render.resolution_y * percentage))]
    cycles = getattr(scene, "cycles", None)
    exposure = scene.view_settings.exposure
    if cycles is not None:
        _cycles(cycles, file, report)
        if cycles.film_exposure != 1:
            report.add("film", f"an exposure of {cycles.film_exposure:g}", "the preview's --exposure; the .exr is not scaled")
            exposure += math.log2(max(cycles.film_exposure, 1e-9))
    if render.film_transparent:
        report.add("film", "a transparent film", "the background is seen; `--aov alpha` has the film's alpha")
    flags = []
    if exposure:
        flags += ["--exposure", f"{exposure:.6g}"]
    transform = scene.view_settings.view_transform
    tone = {"Standard": "clip", "Raw": "clip", "AgX": "agx"}.get(transform)
    if tone is None:
        report.add("view", f"the view transform {transform}", "AgX")
        tone = "agx"
    flags += ["--tonemap", tone]
    look = scene.view_settings.look
    if look not in ("", "None"):
        report.add("view", f"the look {look}", "the preview has none")
    if scene.view_settings.gamma != 1:
        report.add("view", f"a gamma of {scene.view_settings.gamma:g}", "the preview has none")
    return flags


def _cycles(cycles, file, report):
    # Cycles: Blackman-Harris goes from −width to width; the standard deviation of the Gaussian is a quarter of the width, here a third of the radius.
    file.film["filter"] = {
        "BOX": {"type": "box", "radius": 0.5},
        "GAUSSIAN": {"type": "gaussian", "radius": max(0.5, 0.75 * cycles.filter_width)},
        "BLACKMAN_HARRIS": {"type": "blackman_harris", "radius": max(0.5, cycles.filter_width)},
    }[cycles.pixel_filter_type]
    file.render["spp"] = cycles.samples
    # A bounce more is an edge more, and a path without bounces has an edge to the surface and one to the light.
    file.render["max_depth"] = cycles.max_bounces + 2
    file.render["seed"] = cycles.seed
    kinds = ("diffuse", "glossy", "transmission")
    fewer = [kind for kind in kinds if getattr(cycles, f"{kind}_bounces") < cycles.max_bounces]
    if fewer:
        limits = ", ".join(f"{kind} {getattr(cycles, f'{kind}_bounces')}" for kind in fewer)
        report.add("render", f"bounces limited by kind ({limits})", f"all kinds have {cycles.max_bounces}")
    if cycles.sample_clamp_indirect or cycles.sample_clamp_direct:
        report.add(
            "render", f"clamping (direct {cycles.sample_clamp_direct:g}, indirect {cycles.sample_clamp_indirect:g})",
            "no light is clamped; `--clamp` clamps whole samples",
        )
    if cycles.blur_glossy:
        report.add("render", f"Filter Glossy {cycles.blur_glossy:g}", "reflections after a bounce stay as sharp as they are")
    if not (cycles.caustics_reflective and cycles.caustics_refractive):
        report.add("render", "caustics left out", "they are rendered")
    if cycles.use_adaptive_sampling:
        report.add("render", "adaptive sampling", f"{cycles.samples} samples in every pixel; `--adaptive` with `--target-error` or `--time-limit` places them by noise")
    if cycles.use_denoising:
        report.add("render", "denoising", "none; `gpt denoise` makes a second picture")
