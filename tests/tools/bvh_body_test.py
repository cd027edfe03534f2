"""Recorded people move bodies: MakeHuman's base mesh on its rig, and a mannequin.  What is asked is what anybody would see.

Usage: bvh_body_test.py PROGRAM SHARED_DATA      skipped (77) without the data
"""
import json
import pathlib
import struct
import subprocess
import sys
import tempfile

FPS = 30
LEAD_IN = 0.5


def frames_of(path):
    data = path.read_bytes()
    points, samples = struct.unpack_from("<i", data, 16)[0], struct.unpack_from("<i", data, 28)[0]
    return [struct.unpack_from(f"<{3 * points}f", data, 32 + 12 * frame * points) for frame in range(samples)]


def start(program, folder, body, seconds):
    scene = {"cloth": [{"grid": {"width_m": 0.1, "height_m": 0.1, "edge_m": 0.05}, "placement": {"translation_m": [5, 9, 5]}}], "body": body,
             "world": {"gravity_m_per_s2": [0, 0, 0]}, "time": {"fps": FPS, "seconds": seconds, "drape_seconds": 0}}
    (folder / "scene.json").write_text(json.dumps(scene))
    return subprocess.run([program, "run", str(folder / "scene.json"), "--no-preview", "--quiet", "--out", str(folder / "run")],
                          capture_output=True, text=True)


def run(program, folder, body, seconds):
    done = start(program, folder, body, seconds)
    assert done.returncode == 0, done.stderr
    return frames_of(folder / "run" / "body.pc2")


def check(name, frames, seconds, way, floor_mm):
    """The person walks `way` metres, upright, one foot on the floor, and nothing of it is torn along."""
    heights = [frame[1::3] for frame in frames]
    floor, height = min(heights[0]), max(heights[0]) - min(heights[0])
    first = round((LEAD_IN + 0.2) * FPS)
    lowest = [1000 * (min(h) - floor) for h in heights[first:]]
    tallest = [(max(h) - min(h)) / height for h in heights[first:]]
    fastest = max(abs(a - b) * FPS for one, two in zip(frames, frames[1:]) for a, b in zip(one, two))
    middle = [[sum(frame[k::3]) / len(frame[k::3]) for k in range(3)] for frame in (frames[0], frames[-1])]
    went = [b - a for a, b in zip(*middle)]
    assert abs(floor) < 1e-6, "patterns expect a body whose soles are at 0"
    print(f"{name}: soles {min(lowest):.1f} to {max(lowest):.1f} mm, {min(tallest):.2f} to {max(tallest):.2f} of its height, "
          f"fastest {fastest:.1f} m/s, went {went[0]:.2f} {went[1]:.2f} {went[2]:.2f} m in {seconds} s")
    assert -floor_mm < min(lowest) and max(lowest) < floor_mm
    assert 0.93 < min(tallest) and max(tallest) < 1.04
    assert fastest < 8
    assert way[0] < went[2] < way[1] and abs(went[0]) < 0.3 * went[2] and abs(went[1]) < 0.12  # arms come down


def main(program, shared):
    shared = pathlib.Path(shared).resolve()
    people, recordings = shared / "bodies" / "makehuman", shared / "mocap"
    if not people.exists() or not recordings.exists():
        print(f"skipped: needs {people} and {recordings}")
        sys.exit(77)
    walk = {"file": str(recordings / "cmu_02_01_walk.bvh"), "lead_in_s": LEAD_IN}
    woman = {"mesh": str(people / "base.obj"), "unit": "dm", "rig": str(people / "rig.cmu_mb.json"),
             "targets": [{"file": str(people / "caucasian-female-young.target")}], "motion": walk}
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        check("MakeHuman", run(program, folder, woman, 2.5), 2.5, (1.8, 2.8), 15)
        warnings = json.loads((folder / "run" / "report.json").read_text())["warnings"]
        for told in ("arm is turned away from the body by up to", "skin that is folded onto itself yields by up to"):
            assert any(told in warning for warning in warnings), (told, warnings)
        alone = {key: woman[key] for key in ("mesh", "unit", "motion")}
        refused = start(program, folder, alone, 1)
        assert refused.returncode == 3 and "base.obj: skeleton: expected" in refused.stderr and "--rig" in refused.stderr, refused.stderr
    with tempfile.TemporaryDirectory() as name:
        check("mannequin", run(program, pathlib.Path(name), {"mannequin": "man", "motion": walk}, 2.5), 2.5, (1.8, 2.8), 15)
    # Both feet of this recording are turned round for most of it; one passes half a turn 2.35 s from its begin.
    dance = {"file": str(recordings / "cmu_05_06_dance.bvh"), "lead_in_s": LEAD_IN}
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        run(program, folder, {"mannequin": "man", "motion": dance}, 3)
        warnings = json.loads((folder / "run" / "report.json").read_text())["warnings"]
        for foot in ("LeftFoot", "RightFoot"):
            assert any(f'"{foot}" is turned by up to 180 degrees' in warning for warning in warnings), warnings


main(*sys.argv[1:])
