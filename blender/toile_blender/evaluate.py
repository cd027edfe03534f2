"""Objects as Blender shows them: with modifiers and armatures, in the world, in metres of Toile."""

from __future__ import annotations

from contextlib import contextmanager
from typing import Iterator

import bpy
import numpy as np

from .engine import axes
from .engine.errors import ToileError

CACHE_MODIFIER = "Toile"

# Modifiers that keep every vertex.
DEFORMING = frozenset(
    "ARMATURE CAST CORRECTIVE_SMOOTH CURVE DATA_TRANSFER DISPLACE HOOK LAPLACIANDEFORM LAPLACIANSMOOTH LATTICE MESH_CACHE MESH_DEFORM MESH_SEQUENCE_CACHE "
    "NORMAL_EDIT SHRINKWRAP SIMPLE_DEFORM SMOOTH SURFACE_DEFORM UV_PROJECT UV_WARP VERTEX_WEIGHT_EDIT VERTEX_WEIGHT_MIX VERTEX_WEIGHT_PROXIMITY "
    "WARP WAVE WEIGHTED_NORMAL".split()
)

# Without these a garment is not whole, or is moved twice.  All others (a subdivision, a thickness, geometry nodes) act after the cloth.
_NOT_ON_A_GARMENT = frozenset("ARRAY BOOLEAN BUILD CLOTH EXPLODE MIRROR OCEAN REMESH SCREW SKIN SOFT_BODY VOLUME_TO_MESH WELD".split())


def metres_per_unit(scene: bpy.types.Scene) -> float:
    units = scene.unit_settings
    return 1.0 if units.system == "NONE" else float(units.scale_length)


def check_shown(obj: bpy.types.Object, scene: bpy.types.Scene, what: str) -> None:
    if obj.name not in scene.objects:
        raise ToileError(f"{what} '{obj.name}' is not in the scene '{scene.name}'")
    if obj.hide_viewport or not obj.visible_get():
        raise ToileError(f"{what} '{obj.name}' is hidden, so Blender does not move it: show it in the viewport")


def evaluated(obj: bpy.types.Object) -> tuple[np.ndarray, np.ndarray]:
    """((n, 3) as float32 metres of Toile, (t, 3) triangles counter-clockwise from outside) with all modifiers."""
    scene = bpy.context.scene
    seen = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = seen.to_mesh()
    try:
        matrix = np.array(seen.matrix_world)
        return _in_the_world(positions(mesh), matrix, scene), triangles(mesh, matrix)
    finally:
        seen.to_mesh_clear()


def positions(mesh: bpy.types.Mesh) -> np.ndarray:
    values = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    mesh.vertices.foreach_get("co", values)
    return values.reshape(-1, 3)


def triangles(mesh: bpy.types.Mesh, matrix: np.ndarray) -> np.ndarray:
    mesh.calc_loop_triangles()
    values = np.empty(3 * len(mesh.loop_triangles), dtype=np.int32)
    mesh.loop_triangles.foreach_get("vertices", values)
    corners = values.reshape(-1, 3)
    return corners[:, ::-1] if axes.turns_inside_out(matrix) else corners


def drawing(mesh: bpy.types.Mesh, matrix: np.ndarray) -> np.ndarray | None:
    """(t, 3, 2): the active UV map at the corners of `triangles`; None without one."""
    layer = mesh.uv_layers.active
    if layer is None:
        return None
    uv = np.empty(2 * len(mesh.loops), dtype=np.float32)
    layer.data.foreach_get("uv", uv)
    mesh.calc_loop_triangles()
    loops = np.empty(3 * len(mesh.loop_triangles), dtype=np.int32)
    mesh.loop_triangles.foreach_get("loops", loops)
    corners = uv.reshape(-1, 2)[loops].reshape(-1, 3, 2).astype(np.float64)
    return corners[:, ::-1] if axes.turns_inside_out(matrix) else corners


def undeformed(obj: bpy.types.Object) -> np.ndarray:
    """The mesh without modifiers and shape keys, with the size and the turn of the object."""
    return _in_the_world(positions(obj.data), np.array(obj.matrix_world), bpy.context.scene)


def _in_the_world(local: np.ndarray, matrix: np.ndarray, scene: bpy.types.Scene) -> np.ndarray:
    return axes.to_toile(axes.moved(local, matrix), metres_per_unit(scene)).astype(np.float32)


def is_deforming(modifier: bpy.types.Modifier) -> bool:
    return modifier.type in DEFORMING and modifier.name != CACHE_MODIFIER


def check_order(obj: bpy.types.Object) -> None:
    """What deforms the garment stands above what gives it other vertices: the cloth is the mesh in between."""
    first = None
    for modifier in obj.modifiers:
        if modifier.name == CACHE_MODIFIER or not modifier.show_viewport:
            continue
        if modifier.type in _NOT_ON_A_GARMENT:
            raise ToileError(f"the modifier '{modifier.name}' of '{obj.name}' cannot stay on a garment: apply it or remove it")
        if not is_deforming(modifier):
            first = first or modifier
        elif first is not None:
            raise ToileError(
                f"the modifier '{modifier.name}' of '{obj.name}' deforms it after '{first.name}' gave it other vertices: "
                f"move it above '{first.name}', or apply that one"
            )


@contextmanager
def only_deforming(obj: bpy.types.Object) -> Iterator[None]:
    """The object has the vertices of its mesh: what would give it others, and our cache, are switched off."""
    off = [modifier for modifier in obj.modifiers if modifier.show_viewport and not is_deforming(modifier)]
    for modifier in off:
        modifier.show_viewport = False
    try:
        yield
    finally:
        for modifier in off:
            modifier.show_viewport = True


def armatures_of(*objects: bpy.types.Object | None) -> list[bpy.types.Armature]:
    """That move these objects, by a modifier or as a parent."""
    found: dict[str, bpy.types.Armature] = {}
    for obj in filter(None, objects):
        movers = [modifier.object for modifier in obj.modifiers if modifier.type == "ARMATURE"]
        while obj is not None:
            movers.append(obj)
            obj = obj.parent
        for mover in movers:
            if mover is not None and mover.type == "ARMATURE":
                found[mover.data.name] = mover.data
    return list(found.values())


@contextmanager
def rest_pose(armatures: list[bpy.types.Armature]) -> Iterator[None]:
    before = [armature.pose_position for armature in armatures]
    for armature in armatures:
        armature.pose_position = "REST"
    bpy.context.view_layer.update()
    try:
        yield
    finally:
        for armature, position in zip(armatures, before):
            armature.pose_position = position
        bpy.context.view_layer.update()
