"""Renderers that run as processes of their own (worker.py), as the driver sees them."""

import json
import os
import subprocess
import sys
import time
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent


class PeerError(RuntimeError):
    """A renderer did not do what it was ordered."""


class Process:
    """One renderer. It is started when it is first needed and again after it broke down."""

    def __init__(self, key, command, folder):
        self.key, self.command, self.folder = key, [str(part) for part in command], Path(folder)
        self.process, self.about, self.seconds_to_start = None, {}, 0.0

    def start(self):
        if self.process is not None and self.process.poll() is None:
            return
        start = time.perf_counter()
        log = (self.folder / f"{self.key}.log").open("a", encoding="utf-8")
        self.process = subprocess.Popen(
            self.command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=log, text=True, encoding="utf-8", cwd=HERE, env=os.environ
        )
        self.about = self.answer()
        self.seconds_to_start = time.perf_counter() - start

    def answer(self):
        line = self.process.stdout.readline()
        if not line:
            status = self.process.wait()
            raise PeerError(f"{self.key} ended with status {status}: {self.last_words()}")
        found = json.loads(line)
        if "error" in found:
            raise PeerError(f"{self.key}: {found['error']}")
        return found

    def last_words(self):
        lines = (self.folder / f"{self.key}.log").read_text(encoding="utf-8", errors="replace").strip().splitlines()
        return lines[-1] if lines else "it said nothing"

    def ask(self, order, **values):
        self.start()
        try:
            print(json.dumps({"order": order} | values), file=self.process.stdin, flush=True)
        except BrokenPipeError as error:
            raise PeerError(f"{self.key} has ended: {self.last_words()}") from error
        return self.answer()

    def load(self, path, size):
        return self.ask("load", scene=str(path), size=list(size))["seconds"]

    def settings(self):
        return self.ask("settings")["settings"]

    def prepare(self, setting, spp):
        """Compiles what a render needs. The samples per pixel that it will take."""
        return self.ask("prepare", setting=setting, spp=spp)["spp"]

    def render(self, setting, spp, seed):
        """The answer, with the picture in it."""
        picture = self.folder / f"{self.key}.npy"
        found = self.ask("render", setting=setting, spp=spp, seed=seed, picture=str(picture))
        return found | {"picture": np.load(picture)}

    def stop(self):
        if self.process is not None and self.process.poll() is None:
            self.process.stdin.close()
            try:
                self.process.wait(timeout=20)
            except subprocess.TimeoutExpired:
                print(f"{self.key} does not end by itself", file=sys.stderr)
                self.process.kill()
                self.process.wait()
