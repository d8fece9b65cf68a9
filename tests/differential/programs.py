"""Runs gpt and reads what it writes."""

import re
import subprocess
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


@dataclass
class Said:
    """How a run of gpt ended: what it reports as read otherwise, and the error, where it refused."""

    warnings: list = field(default_factory=list)
    error: str = ""


class Gpt:
    def __init__(self, program, device="cpu"):
        self.program, self.device = str(program), device

    def render(self, scene, out, samples, seed, *more):
        """A picture with the variance of a sample as a layer, and what was said. Independent samples, for the tests to hold."""
        out.unlink(missing_ok=True)
        command = [self.program, "render", str(scene), "--device", self.device, "--sampler", "independent", "--spp", str(samples)]
        command += ["--seed", str(seed), "--aov", "variance", "--quiet", *more, "-o", str(out)]
        try:
            run = subprocess.run(command, capture_output=True, text=True, check=False, timeout=300)
        except subprocess.TimeoutExpired:
            return Said(error="no picture within 300 s")
        said = Said()
        for line in run.stderr.splitlines():
            line = re.sub(r"\x1b\[[0-9;]*m", "", line)
            if re.match(r"\s*(warning|note)\b", line):
                said.warnings.append(line.strip())
        if run.returncode != 0 or not out.exists():
            said.error = " ".join(run.stderr.split())[:300] or f"exit {run.returncode}"
        return said
