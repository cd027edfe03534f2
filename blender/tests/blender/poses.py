"""How Toile poses the characters of glTF files, against Blender's importer: each vertex, at the keys of each animation.

Usage: as in_blender.py: ZIP PROGRAM SOURCE_ROOT      skipped where the models of others are not there
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).parent))
sys.dont_write_bytecode = True

import bpy  # noqa: E402
import numpy as np  # noqa: E402
import scenes  # noqa: E402

arguments = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else sys.argv[1:]
program, source = arguments[1], pathlib.Path(arguments[2])
SAME = 1e-5  # of the body's height: point caches have 32 bits a number, Blender's bones too
LEAD_IN_S = 0.5
FIRST_S = 1 / 6  # after which the clock of the motion runs evenly
# File, unit, poses a second of which each key is one.
MODELS = (("Fox.glb", "cm", 120, ("Survey", "Walk", "Run")), ("kenney_platformer_character.glb", "m", 30, ("idle", "walk", "jump")))


def toile_poses(folder, file, unit, clip, fps, count):
    """(n, 3) the body at rest, and (count, n, 3) its poses from the clip's beginning on."""
    scene = {"cloth": [{"grid": {"width_m": 0.1, "height_m": 0.1, "edge_m": 0.05}, "placement": {"translation_m": [5, 9, 5]}}],
             "body": {"mesh": str(file), "unit": unit, "motion": {"file": str(file), "clip": clip, "fps": fps, "lead_in_s": LEAD_IN_S}},
             "world": {"gravity_m_per_s2": [0, 0, 0]}, "time": {"fps": fps, "seconds": LEAD_IN_S + (count - 1) / fps, "drape_seconds": 0}}
    (folder / "scene.json").write_text(json.dumps(scene))
    subprocess.run([program, "run", folder / "scene.json", "--no-preview", "--quiet", "--out", folder / clip], check=True)
    samples = scenes.samples(folder / clip / "body.pc2")
    return samples[0], samples[round(LEAD_IN_S * fps):]


def play(clip):
    """Puts this animation on whatever it moves.  Returns the frames at which everything that moves has a key, and the last one: between keys
    Blender mixes quaternions in another way."""
    keys, last = None, 0
    for thing in [*bpy.data.objects, *bpy.data.shape_keys]:
        if thing.animation_data is None:
            continue
        actions = [track.strips[0].action for track in thing.animation_data.nla_tracks if track.name == clip]
        thing.animation_data.action = actions[0] if actions else None
        for curve in (curve for action in actions for curve in action.fcurves):
            points = [point.co for point in curve.keyframe_points]
            if any(abs(p[1] - points[0][1]) > 1e-7 for p in points):
                found = {round(p[0]) for p in points if abs(p[0] - round(p[0])) < 1e-3}
                keys, last = found if keys is None else keys & found, max(last, round(points[-1][0]))
    return sorted(keys), last


def blender_points(scale):
    bpy.context.view_layer.update()
    meshes = [o for o in bpy.context.scene.objects if o.type == "MESH"]
    return scale * np.concatenate([scenes.y_up(scenes.world_points(o)) for o in meshes])


def nearest(points, places):
    """Of each point the place nearest to it, and how far that is."""
    apart = [np.abs(places - p).max(axis=1) for p in points]
    return np.array([int(a.argmin()) for a in apart]), max(float(a.min()) for a in apart)


def compare(folder, file, unit, fps, clip):
    scenes.empty_scene()
    bpy.context.scene.render.fps = fps
    if "bool" not in vars(np):
        np.bool = bool  # the importer of 3.4 asks for it
    bpy.ops.import_scene.gltf(filepath=str(file))
    for helper in [o for o in bpy.context.scene.objects if o.type == "MESH" and o.users_collection[0].name.startswith("glTF_not_exported")]:
        bpy.data.objects.remove(helper)  # how bones look
    scale = {"m": 1, "cm": 0.01}[unit]
    keys, last = play(clip)
    rest, poses = toile_poses(folder, file, unit, clip, fps, last + 1)
    height = float(np.ptp(rest[:, 1]))
    worst, moved, compared, pairs = 0.0, 0.0, 0, None
    for step in (key for key in keys if key >= FIRST_S * fps):
        bpy.context.scene.frame_set(step)
        points = blender_points(scale)
        if pairs is None:
            pairs = nearest(poses[step], points)[0]
        worst = max(worst, float(np.abs(points[pairs] - poses[step]).max()))
        moved = max(moved, float(np.abs(poses[step] - rest).max()))
        compared += 1
    print(f"{file.name} {clip}: {len(rest)} vertices, {compared} poses, {worst / height:.2g} of the height apart, moved by {moved:.3g} m")
    return worst < SAME * height and moved > 0.02 * height and compared > 4


def main():
    print(f"Blender {bpy.app.version_string}", flush=True)
    models = source.resolve().parent / "shared/data/gltf"
    good = True
    with tempfile.TemporaryDirectory() as folder:
        for name, unit, fps, clips in MODELS:
            if not (models / name).exists():
                print(f"skipped: needs {models / name}")
                continue
            for clip in clips:
                good &= compare(pathlib.Path(folder), models / name, unit, fps, clip)
    return 0 if good else 1


code = main()
sys.stdout.flush()
os._exit(code)
