#!/usr/bin/python3
"""The page of a study in a real browser: opened from file:// without a network, it draws its charts and fills its table.

Usage: study_page.py OGIVE SCENE DIRECTORY. Exit code 77: there is no browser to open it with.
"""

import os
import re
import shutil
import subprocess
import sys

import matplotlib.image
import numpy as np

STUDY = """
title = "Boxes </script> & <b>charts</b>"
scene = "{scene}"
settings = ["output.particle_interval=0", "output.checkpoint_steps=0", "stop.time=0.02"]
[measures.V]
summary = "results.residual_velocity"
unit = "m/s"
reference = 10
[charts]
cell = "cell"
[[sweeps]]
[[sweeps.axes]]
name = "cell"
key = "grid.cell_size"
values = [1, 0.8, 0.5]
[[sweeps.axes]]
name = "shape"
key = "numerics.shape_function"
values = ["linear", "quadratic_bspline"]
"""


def main():
    program, scene, directory = sys.argv[1:]
    browser = next((path for path in map(shutil.which, ("chromium", "chromium-browser", "google-chrome")) if path), None)
    if not browser:
        print("skipped: no Chromium to open the page with (Debian: chromium)")
        sys.exit(77)
    shutil.rmtree(directory, ignore_errors=True)
    os.makedirs(directory)
    with open(os.path.join(directory, "page.toml"), "w", encoding="utf-8") as file:
        file.write(STUDY.format(scene=scene))
    subprocess.run([program, "study", "page.toml"], cwd=directory, check=True)
    results = os.path.join(directory, "page-study")
    for name in ("study-cost.png", "study-cells.svg", "study-split.png"):
        assert os.path.getsize(os.path.join(results, name)) > 5000, name

    def browse(*options):
        return subprocess.run([browser, "--headless", "--no-sandbox", "--disable-gpu", "--window-size=1280,2200", "--hide-scrollbars",
                               "--host-resolver-rules=MAP * ~NOTFOUND", f"--user-data-dir={directory}/profile", *options,
                               "file://" + os.path.join(results, "study.html")], cwd=directory, check=True, timeout=120,
                              stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True).stdout

    page = browse("--dump-dom")
    assert 'data-drawn="6"' in page, "the page's script did not reach its end"
    body = page[page.index("<body"):page.index("<script>")]
    assert "Boxes &lt;/script&gt; &amp; &lt;b&gt;charts&lt;/b&gt;" in body, "the title is not the text that was given"
    rows = re.findall(r"<tr[^>]*><td", body[body.index('id="cases"'):])
    assert len(rows) == 6, f"the table has {len(rows)} rows"
    assert len(re.findall(r'class="text (stable|drifts|fails)"', body)) == 6, "the table tells no verdicts"
    assert not re.search(r'(src|href)="?(https?:)?//', page), "the page asks for something from outside"

    browse(f"--screenshot={directory}/page.png")
    picture = matplotlib.image.imread(os.path.join(directory, "page.png"))[:, :, :3]
    colourful = (picture.max(axis=2) - picture.min(axis=2)) > 0.25
    # Points and bars of three charts: two side by side, one below. Measured: 1 % of the picture, most of it bars.
    top, bars = colourful[:picture.shape[0] // 3], colourful[picture.shape[0] // 5:]
    for name, part in (("left", top[:, :640]), ("right", top[:, 640:]), ("bars", bars)):
        assert part.sum() > 300, f"{name}: {part.sum()} coloured pixels"
    print("page drawn:", int(colourful.sum()), "coloured pixels")


if __name__ == "__main__":
    main()
