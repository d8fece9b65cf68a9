"""A renderer as a process of its own that takes orders, one JSON object a line, and answers each with one.

{"order": "load", "scene": FILE, "size": [w, h]}      → {"seconds": …}: to read the scene and be ready
{"order": "settings"}                                 → {"settings": […]}: what this renderer can be set to for this scene
{"order": "prepare", "setting": S, "spp": N}          → {"spp"}: compiles what that render needs; the samples per pixel it will really take
{"order": "render", "setting": S, "spp": N, "seed": K, "picture": FILE}
                                                      → {"seconds", "learning", "wall", "cpu", "spp"}: of the render alone, and what of its seconds
                                                        is the same for any number of samples; the picture as FILE (.npy)

A renderer is an object with the methods `load(path, size)`, `settings()`, `prepare(setting, spp)` and `render(setting, spp, seed)`; the latter returns
the picture (rows from the top, RGB), the seconds of the render without loading and compiling, and the samples per pixel it really took. What learns
before its first sample has an attribute `learning_seconds`, a part of the seconds of its last render.
"""

import json
import os
import sys
import time
import traceback

import numpy as np

# Renderers print to standard output, some as soon as they are imported: answers alone go there, all else to standard error.
ANSWERS = os.fdopen(os.dup(1), "w", encoding="utf-8")
os.dup2(2, 1)


def serve(renderer):
    """Answers orders until standard input ends."""
    print(json.dumps({"name": renderer.name, "version": renderer.version}), file=ANSWERS, flush=True)
    for line in sys.stdin:
        order = json.loads(line)
        try:
            answer = obey(renderer, order)
        except Exception as error:  # noqa: BLE001  a renderer may raise anything: the driver has to be told
            traceback.print_exc()
            answer = {"error": f"{type(error).__name__}: {error}"}
        print(json.dumps(answer), file=ANSWERS, flush=True)


def obey(renderer, order):
    start, cpu = time.perf_counter(), cpu_seconds()
    if order["order"] == "load":
        renderer.load(order["scene"], order["size"])
        return {"seconds": time.perf_counter() - start}
    if order["order"] == "settings":
        return {"settings": renderer.settings()}
    if order["order"] == "prepare":
        return {"spp": renderer.prepare(order["setting"], order["spp"])}
    picture, seconds, spp = renderer.render(order["setting"], order["spp"], order["seed"])
    answer = {"seconds": seconds, "learning": getattr(renderer, "learning_seconds", 0.0), "wall": time.perf_counter() - start, "cpu": cpu_seconds() - cpu, "spp": spp}
    np.save(order["picture"], np.asarray(picture, dtype=np.float32))
    return answer


def cpu_seconds():
    """User and system time of this process, all its threads and the children that have ended."""
    return sum(os.times()[:4])
