"""Scenes that the tests build in Blender, and what they compare."""

import sys

import bpy
import numpy as np

FRAMES = 10


def empty_scene():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = 5, 5 + FRAMES - 1
    scene.render.fps, scene.render.fps_base = 24, 1.0
    scene.frame_set(7)  # neither first nor last: to be given back
    return scene


def addon(module_name):
    return sys.modules[module_name]


def link(name, mesh):
    made = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(made)
    bpy.context.view_layer.update()
    return made


def half_ball(rings=12, segments=16, radius=0.3):
    """The half x >= 0 of a sphere around (0, 0, 1); its rim lies exactly in x = 0."""
    vertices, faces = [(0.0, 0.0, 1 + radius)], []
    angle = np.pi / segments
    for ring in range(1, rings):
        polar = np.pi * ring / rings
        for k in range(segments + 1):
            turn = k * angle - np.pi / 2
            x = 0.0 if k in (0, segments) else radius * np.sin(polar) * np.cos(turn)
            vertices.append((x, radius * np.sin(polar) * np.sin(turn), 1 + radius * np.cos(polar)))
    vertices.append((0.0, 0.0, 1 - radius))
    row, last = segments + 1, len(vertices) - 1
    at = lambda ring, k: 1 + (ring - 1) * row + k  # noqa: E731
    for k in range(segments):
        faces.append((0, at(1, k), at(1, k + 1)))
        faces.append((last, at(rings - 1, k + 1), at(rings - 1, k)))
        faces += [(at(r, k), at(r + 1, k), at(r + 1, k + 1), at(r, k + 1)) for r in range(1, rings - 1)]
    mesh = bpy.data.meshes.new("half ball")
    mesh.from_pydata(vertices, [], faces)
    return mesh


def body_with_armature(lift_m=0.1):
    """Half a ball, mirrored, subdivided, and moved by the action of a bone: up by `lift_m` and aside, over all frames."""
    scene = bpy.context.scene
    body = link("Body", half_ball())
    armature = bpy.data.armatures.new("Armature")
    rig = bpy.data.objects.new("Rig", armature)
    scene.collection.objects.link(rig)
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    for name, low, high in (("hip", 0.0, 1.0), ("chest", 1.0, 1.6)):
        bone = armature.edit_bones.new(name)
        bone.head, bone.tail = (0, 0, low), (0, 0, high)
    armature.edit_bones["chest"].parent = armature.edit_bones["hip"]
    bpy.ops.object.mode_set(mode="OBJECT")
    weight = {"hip": lambda z: np.clip(0.5 - 3 * (z - 1), 0, 1), "chest": lambda z: np.clip(0.5 + 3 * (z - 1), 0, 1)}
    for name, of_height in weight.items():
        group = body.vertex_groups.new(name=name)
        for vertex in body.data.vertices:
            group.add([vertex.index], float(of_height(vertex.co.z)), "REPLACE")
    mirror = body.modifiers.new("Mirror", "MIRROR")
    mirror.merge_threshold = 1e-6
    body.modifiers.new("Armature", "ARMATURE").object = rig
    body.modifiers.new("Subdivision", "SUBSURF").levels = 1
    for name, axis, amount in (("hip", 1, lift_m), ("chest", 0, 0.05)):  # y of a bone runs along it
        bone = rig.pose.bones[name]
        for frame, share in ((scene.frame_start, 0.0), (scene.frame_end, 1.0)):
            bone.location[axis] = share * amount
            bone.keyframe_insert("location", frame=frame)
    bpy.context.view_layer.update()
    return body, rig


def bend_over(body, hip_m, neck_m, degrees):
    """An armature of two bones: what is above the hip leans forwards, along -Y, over all frames."""
    scene = bpy.context.scene
    armature = bpy.data.armatures.new("Spine")
    rig = bpy.data.objects.new("Spine", armature)
    scene.collection.objects.link(rig)
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    for name, low, high in (("legs", 0.0, hip_m), ("back", hip_m, neck_m)):
        bone = armature.edit_bones.new(name)
        bone.head, bone.tail = (0, 0, low), (0, 0, high)
    armature.edit_bones["back"].parent = armature.edit_bones["legs"]
    bpy.ops.object.mode_set(mode="OBJECT")
    heights = np.array([(body.matrix_world @ v.co).z for v in body.data.vertices])
    share = np.clip((heights - hip_m) / 0.2 + 0.5, 0, 1)
    for name, weights in (("legs", 1 - share), ("back", share)):
        group = body.vertex_groups.new(name=name)
        for vertex, weight in enumerate(weights):
            group.add([vertex], float(weight), "REPLACE")
    body.modifiers.new("Armature", "ARMATURE").object = rig
    bone = rig.pose.bones["back"]
    bone.rotation_mode = "XYZ"
    for frame, turn in ((scene.frame_start, 0.0), (scene.frame_end, np.radians(degrees))):
        bone.rotation_euler.x = turn
        bone.keyframe_insert("rotation_euler", frame=frame)
    bpy.context.view_layer.update()
    return rig


def cloth_sheet(name="Cloth", cells=12, size=0.5, height=1.35, group=None):
    """Quads, smaller in its own space than in the world, turned and moved, with a subdivision above the cloth."""
    line = np.linspace(-size, size, cells + 1)
    vertices = [(float(x), float(y), 0.0) for x in line for y in line]
    n = cells + 1
    faces = [(n * i + j, n * i + n + j, n * i + n + j + 1, n * i + j + 1) for i in range(cells) for j in range(cells)]
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(vertices, [], faces)
    made = link(name, mesh)
    made.scale, made.rotation_euler, made.location = (0.8, 0.8, 0.8), (0, 0, 0.3), (0.02, -0.01, height)
    if group:
        weights = made.vertex_groups.new(name=group)
        weights.add([k * n for k in range(n)], 1.0, "REPLACE")  # one side
        weights.add([k * n + 1 for k in range(n)], 0.2, "REPLACE")  # too light to be held
    made.modifiers.new("Subdivision", "SUBSURF").levels = 1
    bpy.context.view_layer.update()
    return made


def world_points(obj):
    """(n, 3) float64: as Blender shows it now."""
    seen = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = seen.to_mesh()
    points = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    mesh.vertices.foreach_get("co", points)
    seen.to_mesh_clear()
    matrix = np.array(seen.matrix_world, dtype=np.float64)
    return points.reshape(-1, 3).astype(np.float64) @ matrix[:3, :3].T + matrix[:3, 3]


def y_up(points):
    return np.stack([points[:, 0], points[:, 2], -points[:, 1]], axis=-1)


def samples(path):
    """(samples, points, 3) of a PC2 file, read here once more."""
    data = path.read_bytes()
    points, count = np.frombuffer(data, "<i4", 1, 16)[0], np.frombuffer(data, "<i4", 1, 28)[0]
    assert data[:12] == b"POINTCACHE2\0"
    return np.frombuffer(data, "<f4", 3 * points * count, 32).reshape(count, points, 3)


def farthest(obj, cache, first_frame):
    """Over all samples and vertices: how far Blender's cloth (without what acts after it) is from the cache in the world, metres."""
    later = [m for m in obj.modifiers if m.type == "SUBSURF" and m.show_viewport]
    for modifier in later:
        modifier.show_viewport = False
    worst = 0.0
    for k, sample in enumerate(samples(cache)):
        bpy.context.scene.frame_set(first_frame + k)
        shown = y_up(world_points(obj))
        assert shown.shape == sample.shape, (shown.shape, sample.shape)
        worst = max(worst, float(np.abs(shown - sample).max()))
    for modifier in later:
        modifier.show_viewport = True
    return worst
