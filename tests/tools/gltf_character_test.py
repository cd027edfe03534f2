"""Characters of other people's glTF files wear cloth: a fox a cape, through its three animations, and a square person a tunic.

Usage: gltf_character_test.py PROGRAM SHARED_DATA      skipped (77) without the data
"""
import json
import pathlib
import struct
import subprocess
import sys
import tempfile

STEP_MS = 16.7  # a fox that runs moves by 8 cm in a frame


def last_heights(path):
    data = path.read_bytes()
    points, samples = struct.unpack_from("<i", data, 16)[0], struct.unpack_from("<i", data, 28)[0]
    return struct.unpack_from(f"<{3 * points}f", data, 32 + 12 * (samples - 1) * points)[1::3]


def worn(program, folder, words, least_mean_height):
    """Cloth that is on at the end, was at no time in the body or in itself, and is not stretched."""
    done = subprocess.run([program, *map(str, words), "--no-preview", "--quiet", "--json", "--out", str(folder / "run")], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    report = json.loads(done.stdout)
    crossings = report["penetrations"]
    heights = last_heights(folder / "run" / "cloth.pc2")
    mean = sum(heights) / len(heights)
    print(f"{report['motion']['name']}: {report['verdict']}, {report['motion']['frames']} frames, crossings at most {crossings['cloth_body_edges']['max']} with the body "
          f"and {crossings['cloth_cloth_edges']['max']} of cloth, stretch p99 {100 * report['stretch']['p99']:.1f} %, the cloth's middle at {mean:.2f} m")
    assert report["verdict"] == "pass"
    assert crossings["cloth_body_edges"]["max"] == crossings["cloth_cloth_edges"]["max"] == 0
    assert report["stretch"]["p99"] < 0.03
    assert mean > least_mean_height, "it has fallen off"


def cape(program, folder, fox, clip, seconds):
    scene = {
        "cloth": [{"name": "cape", "grid": {"width_m": 0.42, "height_m": 0.62, "edge_m": 0.018},
                   "placement": {"rotation_deg": [-90, 0, 0], "translation_m": [0, 0.72, -0.02]},
                   # Three buttons at the neck, closed when it lies on the back.
                   "pins": [{"near_m": [x, 0.72, 0.29], "hold": "body", "from_s": 1} for x in (-0.1, 0, 0.1)]}],
        "body": {"mesh": str(fox), "unit": "cm", "motion": {"file": str(fox), "clip": clip, "fps": 60}},
        "time": {"seconds": seconds, "drape_seconds": 2, "step_max_ms": STEP_MS}}
    (folder / "scene.json").write_text(json.dumps(scene))
    worn(program, folder, ["run", folder / "scene.json"], 0.35)


def tunic(folder):
    """Two panels with openings for a neck of 8 cm and for square arms, for a body 80 cm tall and 60 cm wide and deep. In cm."""
    outline = [[-66, 0], [66, 0], [66, 20], [45, 98], [9, 98], [0, 94], [-9, 98], [-45, 98], [-66, 20]]
    edges = [{"endpoints": [k, (k + 1) % len(outline)]} for k in range(len(outline))]
    panels = {"front": {"translation": [0, 10, 45], "rotation": [0, 0, 0], "vertices": outline, "edges": edges},
              "back": {"translation": [0, 10, -50], "rotation": [0, 0, 0], "vertices": [[-x, y] for x, y in outline], "edges": edges}}
    seams = [(1, 8), (3, 6), (6, 3), (8, 1)]  # side, shoulder, shoulder, side
    stitches = [[{"panel": "front", "edge": a}, {"panel": "back", "edge": b}] for a, b in seams]
    pattern = {"pattern": {"panels": panels, "stitches": stitches},
               "properties": {"curvature_coords": "relative", "normalize_panel_translation": False, "units_in_meter": 100}}
    (folder / "tunic.json").write_text(json.dumps(pattern))
    return folder / "tunic.json"


def main(program, shared):
    models = pathlib.Path(shared).resolve() / "gltf"
    fox, person = models / "Fox.glb", models / "kenney_platformer_character.glb"
    if not fox.exists() or not person.exists():
        print(f"skipped: needs {fox} and {person}")
        sys.exit(77)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for clip, seconds in (("Survey", 3.5), ("Walk", 2), ("Run", 2.4)):
            cape(program, folder, fox, clip, seconds)
        worn(program, folder, ["dress", tunic(folder), "--body", person, "--motion", person, "--clip", "walk", "--seconds", 1, "--resolution", 4], 0.4)


main(*sys.argv[1:])
