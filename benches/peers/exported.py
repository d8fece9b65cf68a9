"""A scene file as the scene of Mitsuba 3 that `gpt export` writes of it: for scenes that scene_file.py has no translation of."""

import re
import subprocess
from pathlib import Path


class Exported:
    """Takes the place of scene_file.Scene and export_mitsuba: `scene()` loads it, `sensor()` makes a sensor of another sampler."""

    def __init__(self, mi, program, path, size):
        self.mi, self.size = mi, size
        path = Path(path)
        # Portals are how gpt draws directions; in Mitsuba they are surfaces, which take an edge of the path.
        tables = re.split(r"(?m)^(?=\[\[)", path.read_text(encoding="utf-8"))
        plain = path.with_name(f"{path.stem}-for-peers.toml")
        plain.write_text("".join(table for table in tables if "portal = true" not in table), encoding="utf-8")
        self.file = plain.with_suffix(".xml")
        subprocess.run([program, "export", str(plain), "-o", str(self.file)], check=True)
        self.text = self.file.read_text(encoding="utf-8")
        for name, value in (("width", size[0]), ("height", size[1])):
            self.text = self.replaced(rf'(<integer name="{name}" value=")\d+', value)

    def replaced(self, pattern, value):
        text, count = re.subn(pattern, rf"\g<1>{value}", self.text, count=1)
        if count != 1:
            raise ValueError(f"{self.file}: {pattern} is not there")
        return text

    def scene(self):
        self.file.write_text(self.text, encoding="utf-8")
        return self.mi.load_file(str(self.file))

    def sensor(self, sampler, spp):
        """The scene's own, alone in a scene."""
        self.text = self.replaced(r'(<sampler type=")\w+', sampler)
        self.text = self.replaced(r'(<integer name="sample_count" value=")\d+', spp)
        sensor = re.search(r"(?s)<sensor .*?</sensor>", self.text).group(0)
        # One within a medium names it.
        media = "".join(re.findall(r"(?sm)^  <medium .*?^  </medium>", self.text))
        return self.mi.load_string(f'<scene version="3.0.0">{media}{sensor}</scene>').sensors()[0]
