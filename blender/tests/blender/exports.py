"""What `toile export` writes, read by Blender's own importers: how far each vertex is from the run.

Usage: as in_blender.py: ZIP PROGRAM SOURCE_ROOT
"""
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
program = arguments[1]
NEAR_M = 1e-6


def import_obj(path):
    bpy.ops.wm.obj_import(filepath=str(path))


def import_ply(path):
    """Since 4.0 the importer turns the axes; before, the object has to be turned."""
    if bpy.app.version >= (4, 0, 0):
        bpy.ops.wm.ply_import(filepath=str(path), forward_axis="NEGATIVE_Z", up_axis="Y")
    else:
        bpy.ops.import_mesh.ply(filepath=str(path))
        bpy.context.object.rotation_euler.x = np.pi / 2


def import_gltf(path):
    if "bool" not in vars(np):
        np.bool = bool  # the importer of 3.4 asks for it, and Debian's NumPy has it no more: there a user's import fails
    bpy.ops.import_scene.gltf(filepath=str(path))


def imported():
    """(n, 3) in Toile's axes, of all meshes of the scene, and their UV maps' count."""
    bpy.context.view_layer.update()
    meshes = [o for o in bpy.context.scene.objects if o.type == "MESH"]
    return np.concatenate([scenes.y_up(scenes.world_points(o)) for o in meshes]), sum(len(o.data.uv_layers) for o in meshes), len(meshes)


def distance(points, sample):
    """The farthest of the imported vertices from its nearest in the run, and of the run's from its nearest import."""
    apart = lambda a, b: max(float(np.abs(b - p).max(axis=1).min()) for p in a)  # noqa: E731
    return max(apart(points, sample), apart(sample, points))


def main():
    print(f"Blender {bpy.app.version_string}", flush=True)
    failed = False
    with tempfile.TemporaryDirectory() as folder:
        run = pathlib.Path(folder) / "run"
        subprocess.run([program, "demo", "skirt", "--resolution", "4", "--seconds", "0.1", "--no-preview", "--quiet", "--out", run], check=False)
        frames = scenes.samples(run / "cloth.pc2")
        last = len(frames) - 1
        for to, ending, reader in (("obj", "obj", import_obj), ("ply", "ply", import_ply), ("gltf", "glb", import_gltf)):
            everything = run / to
            subprocess.run([program, "export", run, "--to", to, "--all", "--out", everything], check=True, stdout=subprocess.DEVNULL)
            files = sorted(everything.iterdir())
            if len(files) != len(frames):
                failed = True
            for number in (0, last):
                scenes.empty_scene()
                reader(everything / f"cloth_{number:04d}.{ending}")
                points, maps, meshes = imported()
                same_order = len(points) == len(frames[number]) and float(np.abs(points - frames[number]).max()) < NEAR_M
                worst = distance(points, frames[number])
                print(f"{to} frame {number}: {meshes} meshes, {len(points)} vertices of {len(frames[number])}, {maps} UV maps, "
                      f"farthest {worst:.2g} m, {'same' if same_order else 'another'} order")
                failed |= worst > NEAR_M or maps == 0 or (to == "obj" and not same_order)
    return 1 if failed else 0


code = main()
sys.stdout.flush()
os._exit(code)
