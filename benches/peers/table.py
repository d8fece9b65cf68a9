"""The results as tables in Markdown, and the pictures beside each other."""

import mitsuba as mi
import numpy as np

import scenes

TITLES = {"gpt-default": "gpt, default", "gpt": "gpt, best setting", "mitsuba-llvm": "Mitsuba llvm", "mitsuba-scalar": "Mitsuba scalar", "cycles": "Cycles", "luxcore": "LuxCore"}
# What is wanted, by kind of scene: how many times as long the peer has to take at least.
MARKS = {("small", "mitsuba-llvm"): 1.5, ("model", "mitsuba-llvm"): 1.0}
OTHER_MARK = 1.5
OURS = ["gpt-default", "gpt"]
# Beyond, the peer's error has been carried so far below what it rendered that only the order of magnitude is known.
FAR = 50


def markdown(report):
    ways = [key for key in OURS if key in report["versions"]]
    peers = [key for key in TITLES if key not in OURS and key in report["versions"]]
    machine = report["machine"]
    versions = ", ".join(dict.fromkeys(f"{about['name']} {about['version']}" for about in report["versions"].values()))
    lines = [
        f"{report['date']}; {machine['processor']}, {machine['cores']} cores; {versions}; {report['seeds']} seeds, renders of up to about {report['seconds']:g} s.",
        "",
        "How many times as long as gpt the peer renders to reach an equal relMSE, median (least–largest) of the seeds:",
        "",
        row("scene", *(f"{TITLES[key]} / {TITLES[way]}" for key in peers for way in ways)),
        row("---", *("---" for _ in peers for _ in ways)),
    ]
    lines += [row(name, *(cell(name, found, key, way) for key in peers for way in ways)) for name, found in report["scenes"].items()]
    lines += ["", f"Bold: short of the mark ({MARKS['small', 'mitsuba-llvm']} and {MARKS['model', 'mitsuba-llvm']:g} against Mitsuba llvm in small scenes and models, {OTHER_MARK:g} against all others).", ""]
    lines += details(report)
    lines += [f"- {key} was left out: {reason}" for key, reason in report["absent"].items()]
    return "\n".join(lines) + "\n"


def row(*cells):
    return "| " + " | ".join(str(cell) for cell in cells) + " |"


def cell(name, found, key, way):
    if key in found["left_out"]:
        return "other model"
    if key not in found["pairs"]:
        return "failed"
    pair = found["pairs"][key]
    if pair["agreement"]["verdict"] == "differ":
        return "means differ"
    ratio = pair["ratios"].get(way)
    if ratio is None:
        return "failed"
    text = f"{ratio['median']:.2f} ({ratio['least']:.2f}–{ratio['largest']:.2f})"
    if ratio["median"] > FAR:
        text = f"> {FAR}"
    if pair["agreement"]["verdict"] == "no verdict":
        text += " (agreement not shown)"
    return text if ratio["median"] >= MARKS.get((scenes.ALL[name].kind, key), OTHER_MARK) else f"**{text}**"


def details(report):
    lines = [
        "Each peer at its best setting; slope of error against time; start-up to the first sample per pixel, with warm caches of kernels; then, against",
        "gpt's default, the ratio with start-up, the ratio of processor seconds, and the largest difference of a channel's mean:",
        "",
        row("scene", "renderer", "setting", "spp", "seconds", "relMSE", "slope", "start-up s", "with start-up", "processor", "means"),
        row(*["---"] * 11),
    ]
    for name, found in report["scenes"].items():
        for key, own in found["renderers"].items():
            last, pair = own["levels"][-1], found["pairs"].get(key)
            cells = [name, TITLES[key], own["setting"], f"{last['spp']:g}", f"{np.median(last['seconds']):.2f}", f"{np.mean(last['relmse']):.2e}"]
            cells += [f"{own['slope']:.2f}", f"{own['start_up_seconds']:.2f}"]
            if pair is None:
                cells += ["", "", ""]
            else:
                first = next(iter(pair["ratios"].values()))
                cells += [f"{first['with_start_up']:.2f}", f"{first['processor']:.2f}", agreement(pair)]
            lines.append(row(*cells))
    return [*lines, ""]


def agreement(pair):
    judgement = pair["agreement"]
    largest = max(judgement["difference"], key=abs)
    allowed = f", up to {pair['allowed_difference']:.1%} allowed: {pair['allowed_because']}" if pair["allowed_because"] else ""
    return f"{judgement['verdict']} ({largest:+.3%}{allowed})"


def write_pictures(path, pictures):
    path.parent.mkdir(parents=True, exist_ok=True)
    beside = np.concatenate([np.clip(picture, 0, 1) for picture in pictures.values()], axis=1).astype(np.float32)
    mi.Bitmap(beside).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.UInt8, srgb_gamma=True).write(str(path))
