"""The picture of the report in docs/golden-pictures.md: runs the commands of the page that make the report, and opens it in Chromium.

    python3 report.py GPT CHROMIUM       needs the package playwright
"""

import re
import subprocess
import sys
import tempfile
from pathlib import Path

from playwright.sync_api import sync_playwright

HERE = Path(__file__).resolve().parent
gpt, chromium = sys.argv[1:]
page = (HERE.parent / "golden-pictures.md").read_text()

with tempfile.TemporaryDirectory() as folder:
    folder = Path(folder)
    (folder / "scenes").mkdir()
    for name, text in re.findall(r"^```toml (\S+)\n(.*?)^```", page, re.M | re.S):
        (folder / name).write_text(text)
    (folder / "gpt").symlink_to(Path(gpt).resolve())
    # All commands up to the test that turns red.
    commands = re.findall(r"^```sh run[ 0-9]*\n(.*?)^```", page, re.M | re.S)[:3]
    for block in commands:
        subprocess.run(["bash", "-c", f"PATH={folder}:$PATH; {block}"], cwd=folder, check=False)
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=chromium, args=["--no-sandbox"])
        view = browser.new_page(viewport={"width": 860, "height": 900})
        view.goto(f"file://{folder}/report.html")
        view.get_by_role("button", name="z-map").first.click()
        view.wait_for_timeout(300)
        view.screenshot(path=HERE / "report.png", clip={"x": 0, "y": 230, "width": 640, "height": 660})
        browser.close()
