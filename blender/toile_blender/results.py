"""Runs come back: a Mesh Cache modifier on an object, new objects for what was sewn, the rate of the scene."""

from __future__ import annotations

from collections import deque
from pathlib import Path
from typing import Generator

import bpy
import numpy as np

from .engine import axes, obj_file, point_cache, run_files
from .engine.errors import ToileError
from .engine.run_files import Progress
from .evaluate import CACHE_MODIFIER, is_deforming, metres_per_unit, positions


def moves(obj: bpy.types.Object) -> bool:
    """Its transform may change from frame to frame."""
    at: bpy.types.Object | None = obj
    while at is not None:
        if at.animation_data is not None or len(at.constraints) > 0 or at.rigid_body is not None or at.parent_type != "OBJECT":
            return True
        at = at.parent
    return False


def write_cache(
    cache: Path, positions_m: point_cache.Reader, particles: np.ndarray, obj: bpy.types.Object, first_frame: int
) -> Generator[Progress, None, None]:
    """The cloth in the space of the object, per sample; sample 0 is shown at `first_frame`.  `particles`: of each vertex of the object, -1 where it has none:
    those stay where the mesh has them."""
    scene = bpy.context.scene
    unit = metres_per_unit(scene)
    own = positions(obj.data) if len(obj.data.vertices) == len(particles) else np.zeros((len(particles), 3), dtype=np.float32)
    moved = particles >= 0
    animated, shown = moves(obj), (scene.frame_current, scene.frame_subframe)
    try:
        with point_cache.Writer(cache, len(particles)) as writer:
            for sample in range(positions_m.samples):
                if animated:
                    scene.frame_set(first_frame + sample)
                into_object = _inverse(obj)
                local = own.copy()
                local[moved] = axes.moved(axes.to_blender(positions_m.sample(sample), unit), into_object)[particles[moved]]
                writer.add(local)
                yield Progress(f"reading frame {sample + 1} of {positions_m.samples}", (sample + 1) / positions_m.samples)
    finally:
        if animated:
            scene.frame_set(shown[0], subframe=shown[1])


def _inverse(obj: bpy.types.Object) -> np.ndarray:
    matrix = np.array(obj.matrix_world, dtype=np.float64)
    if abs(np.linalg.det(matrix[:3, :3])) < 1e-18:
        raise ToileError(f"'{obj.name}' is scaled to nothing: give it a scale")
    return np.linalg.inv(matrix)


def show_cache(obj: bpy.types.Object, cache: Path, first_frame: int) -> None:
    """One modifier of ours, above everything that gives the mesh other vertices."""
    modifier = obj.modifiers.get(CACHE_MODIFIER)
    if modifier is None or modifier.type != "MESH_CACHE":
        modifier = obj.modifiers.new(CACHE_MODIFIER, "MESH_CACHE")
    modifier.name = CACHE_MODIFIER
    place = list(obj.modifiers).index(modifier)
    first_other = next((k for k, other in enumerate(obj.modifiers) if other != modifier and not is_deforming(other)), len(obj.modifiers))
    wanted = first_other if first_other < place else first_other - 1
    if wanted != place:
        with bpy.context.temp_override(object=obj):
            bpy.ops.object.modifier_move_to_index(modifier=CACHE_MODIFIER, index=wanted)
        modifier = obj.modifiers[CACHE_MODIFIER]
    modifier.cache_format, modifier.filepath = "PC2", as_blender_names(cache)
    modifier.deform_mode, modifier.interpolation = "OVERWRITE", "LINEAR"
    modifier.play_mode, modifier.time_mode = "SCENE", "FRAME"
    modifier.frame_start, modifier.frame_scale = first_frame, 1
    modifier.forward_axis, modifier.up_axis = "POS_Y", "POS_Z"  # the cache is in the space of the object already
    modifier.show_viewport = modifier.show_render = modifier.show_in_editmode = modifier.show_on_cage = True
    obj.update_tag()
    obj.data.update()


def as_blender_names(path: Path) -> str:
    """Relative to the file, where it has been saved and is on the same disk."""
    if bpy.data.is_saved:
        try:
            return bpy.path.relpath(str(path))
        except ValueError:
            pass
    return str(path)


def hide_cache(obj: bpy.types.Object) -> None:
    modifier = obj.modifiers.get(CACHE_MODIFIER)
    if modifier is not None and modifier.type == "MESH_CACHE":
        obj.modifiers.remove(modifier)


def new_object(name: str, obj: Path, before: bpy.types.Object | None = None) -> bpy.types.Object:
    """Of a mesh that Toile wrote.  `before`: an earlier result; it keeps what the user made of it, its vertex groups too where the mesh is the same."""
    scene = bpy.context.scene
    mesh = obj_file.read(obj)
    points = axes.to_blender(mesh.positions, metres_per_unit(scene))
    if before is not None and before.name in scene.objects and before.type == "MESH":
        if _has(before.data, len(points), mesh.triangles):
            return before
        old, before.data = before.data, _mesh(name, points, mesh)
        if old.users == 0:
            bpy.data.meshes.remove(old)
        return before
    made = bpy.data.objects.new(name, _mesh(name, points, mesh))
    bpy.context.collection.objects.link(made)
    return made


def _has(mesh: bpy.types.Mesh, vertices: int, triangles: np.ndarray) -> bool:
    if len(mesh.vertices) != vertices or len(mesh.polygons) != len(triangles) or len(mesh.loops) != triangles.size:
        return False
    corners = np.empty(triangles.size, dtype=np.int32)
    mesh.loops.foreach_get("vertex_index", corners)
    return bool(np.array_equal(corners, triangles.ravel()))


def _mesh(name: str, points: np.ndarray, from_file: obj_file.Mesh) -> bpy.types.Mesh:
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(points.tolist(), [], from_file.triangles.tolist())
    if from_file.uv is not None:
        layer = mesh.uv_layers.new(name="Pattern")  # in metres, the warp along v
        layer.data.foreach_set("uv", from_file.uv.astype(np.float32).ravel())
    if len(from_file.panel_names) > 1 and from_file.panel is not None:
        for panel in from_file.panel_names:
            mesh.materials.append(bpy.data.materials.get(panel) or bpy.data.materials.new(panel))
        mesh.polygons.foreach_set("material_index", from_file.panel.astype(np.int32))
    mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
    mesh.update()
    return mesh


def set_rate(scene: bpy.types.Scene, fps: float) -> None:
    """23.976 is 24 / 1.001 in Blender."""
    whole = max(1, round(fps))
    scene.render.fps, scene.render.fps_base = whole, whole / fps


def scene_rate(scene: bpy.types.Scene) -> float:
    fps = scene.render.fps / scene.render.fps_base
    if not 1 <= fps <= 1000:
        raise ToileError(f"the scene's frame rate must be from 1 to 1000 frames per second, it is {fps:g}")
    return float(f"{fps:.9g}")


def load_run(run: Path) -> tuple[bpy.types.Object, bpy.types.Object | None]:
    """Cloth and body of any run of Toile, at the scene's first frame; the scene gets its rate, and room for all frames."""
    scene = bpy.context.scene
    fps = run_files.rate(run)
    cloth = _load(run, "cloth")
    if cloth is None:
        raise ToileError(f"{run}: there is no cloth.obj with cloth.pc2: it was ended before the cloth was put on")
    set_rate(scene, fps)
    samples = point_cache.header(run / "cloth.pc2")[1]
    scene.frame_end = max(scene.frame_end, scene.frame_start + samples - 1)
    return cloth, _load(run, "body")


def _load(run: Path, what: str) -> bpy.types.Object | None:
    obj, pc2 = run / (what + ".obj"), run / (what + ".pc2")
    if not (obj.is_file() and pc2.is_file()):
        return None
    first_frame = bpy.context.scene.frame_start
    made = new_object(f"{run.name}.{what}", obj)
    cache = run.parent / f"{run.name}.{what}.blender.pc2"
    deque(write_cache(cache, point_cache.Reader(pc2), np.arange(len(made.data.vertices)), made, first_frame), maxlen=0)
    show_cache(made, cache, first_frame)
    return made
