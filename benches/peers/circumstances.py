"""The machine and the device that results are of."""

import json
import os
import platform
import subprocess
from pathlib import Path


def machine():
    model = [line.split(":")[1].strip() for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines() if line.startswith("model name")]
    return {"processor": model[0] if model else platform.processor(), "cores": os.cpu_count(), "system": platform.platform()}


def device(program, name="auto"):
    """Name and driver of the device that the program gpt renders on."""
    listed = json.loads(subprocess.run([program, "devices", "--json"], check=True, capture_output=True, text=True).stdout)
    chosen = [found for found in listed if found["chosen_by_auto"]] if name == "auto" else []
    return {"name": chosen[0]["name"], "driver": chosen[0]["driver"]} if chosen else {"name": name}
