#!/usr/bin/env python3
"""Runs the scenes of the gallery and makes the pictures and the table of docs/gallery.md.

Usage: gallery.py TOILE OUT [NAME ...]      e.g. gallery.py build/release/toile out/gallery flag curtain; without names: all of them

Runs go to OUT/NAME; pictures, one view of preview.png in studio style, 360 pixels wide in 256 colours, to docs/pictures/gallery.
The table is printed.  Needs Pillow (pip install pillow).
"""
import json
import pathlib
import subprocess
import sys

from PIL import Image

root = pathlib.Path(__file__).resolve().parent.parent
views = ("front", "side", "back")
# name: scene, view, what it is
scenes = {
    "tshirt": ("scenes/tshirt.json", "front", "T-shirt, knit, with a neckband; walking"),
    "walking-shirt": ("scenes/gallery/walking-shirt.json", "front", "shirt with collar and cuffs, cotton; walking"),
    "hoody": ("scenes/gallery/hoody.json", "front", "hoody, knit, with its hood up"),
    "coat": ("scenes/gallery/coat.json", "front", "coat, wool, lapped and belted"),
    "jeans": ("scenes/gallery/jeans.json", "back", "trousers with an elastic waist, denim"),
    "silk-blouse": ("scenes/gallery/silk-blouse.json", "front", "blouse, silk, over a long skirt, wool"),
    "slip": ("scenes/gallery/slip.json", "front", "slip on the bias, silk"),
    "pleated-skirt": ("scenes/gallery/pleated-skirt.json", "front", "pleated skirt, wool suiting, on an elastic band"),
    "scarf": ("scenes/gallery/scarf.json", "front", "scarf, wool, wound around the neck by moved pins"),
    "table-cloth": ("scenes/gallery/table-cloth.json", "front", "table cloth, cotton"),
    "flag": ("scenes/gallery/flag.json", "front", "flag, silk, in a wind of 6 m/s"),
    "curtain": ("scenes/gallery/curtain.json", "front", "curtain, silk, drawn together"),
    "bed-sheet": ("scenes/gallery/bed-sheet.json", "front", "sheet on a bed, cotton"),
    "wrung-towel": ("scenes/gallery/wrung-towel.json", "front", "towel, knit, wrung by two turns"),
    "cushion": ("scenes/cushion.json", "front", "cushion with piping, cotton, 300 Pa inside"),
}
margin, width, height, shown_px = 16, 618, 1032, 360  # of preview.png in studio style


def run(toile, out, name):
    scene, view, what = scenes[name]
    folder = out / name
    subprocess.run([toile, "run", root / scene, "--out", folder, "--no-preview", "--quiet"], check=True)
    subprocess.run([toile, "preview", folder, "--style", "studio", "--no-film", "--quiet"], check=True)
    left = margin + views.index(view) * (width + margin)
    picture = Image.open(folder / "preview.png").crop((left, margin, left + width, margin + height))
    # What is drawn, outstretched arms among it, fills the width, seldom the height: the middle is kept.
    cut = (height - width) // 2 if name in ("table-cloth", "flag", "bed-sheet", "wrung-towel", "cushion", "hoody", "coat") else 0
    picture = picture.crop((0, cut, width, height - cut))
    picture = picture.resize((shown_px, shown_px * picture.height // width), Image.Resampling.LANCZOS)
    target = root / "docs/pictures/gallery" / f"{name}.png"
    target.parent.mkdir(exist_ok=True)
    picture.quantize(256, dither=Image.Dither.FLOYDSTEINBERG).save(target, optimize=True)
    report = json.loads((folder / "report.json").read_text())
    crossings = sum(report["penetrations"][kind]["last"] for kind in ("cloth_body_edges", "cloth_cloth_edges"))
    return (f"| ![{what}](pictures/gallery/{name}.png) | {what}: `{scene}` | {report['verdict']}, {report['cloth']['vertices']:,} vertices, "
            f"{report['frames']} frames in {report['seconds_total']:.0f} s; p99 of stretch {100 * report['stretch']['p99']:.1f} %; "
            f"{crossings} crossings |")


def main():
    if len(sys.argv) < 3 or set(sys.argv[3:]) - set(scenes):
        sys.exit(__doc__)
    toile, out = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    lines = [run(toile, out, name) for name in sys.argv[3:] or scenes]
    print("\n".join(["| | scene | figures |", "|---|---|---|"] + lines))


if __name__ == "__main__":
    main()
