"""The poses of bodies with skeletons, against an evaluation of the same files that is written here from the glTF specification alone.

Usage: gltf_pose_test.py PROGRAM SHARED_DATA
"""
import json
import math
import pathlib
import struct
import subprocess
import sys
import tempfile

FPS = 24
SAME = 1e-5  # of the body's height: body.pc2 holds 32 bits a number


# ---- matrices as lists of rows, 4 x 4
def product(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(4)) for j in range(4)] for i in range(4)]


def on(m, p):
    return [m[i][0] * p[0] + m[i][1] * p[1] + m[i][2] * p[2] + m[i][3] for i in range(3)]


def placed(t, q, s):
    x, y, z, w = (c / math.sqrt(sum(c * c for c in q)) for c in q)
    r = [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
         [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
         [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]
    return [[r[i][j] * s[j] for j in range(3)] + [t[i]] for i in range(3)] + [[0, 0, 0, 1]]


def slerped(a, b, u):
    dot = sum(p * q for p, q in zip(a, b))
    if dot < 0:
        b, dot = [-q for q in b], -dot
    angle = math.acos(min(1, dot))
    if angle < 1e-6:
        return [p + u * (q - p) for p, q in zip(a, b)]
    return [(math.sin((1 - u) * angle) * p + math.sin(u * angle) * q) / math.sin(angle) for p, q in zip(a, b)]


class Gltf:
    def __init__(self, path):
        data = pathlib.Path(path).read_bytes()
        size = struct.unpack_from("<I", data, 12)[0]
        self.json = json.loads(data[20:20 + size])
        self.bin = data[28 + size:]

    def numbers(self, accessor):
        a = self.json["accessors"][accessor]
        view = self.json["bufferViews"][a["bufferView"]]
        letter, width, top = {5121: ("B", 1, 255), 5123: ("H", 2, 65535), 5125: ("I", 4, 1), 5126: ("f", 4, 1)}[a["componentType"]]
        count = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}[a["type"]]
        stride = view.get("byteStride", count * width)
        first = view.get("byteOffset", 0) + a.get("byteOffset", 0)
        rows = [struct.unpack_from(f"<{count}{letter}", self.bin, first + k * stride) for k in range(a["count"])]
        return [[c / top for c in row] for row in rows] if a.get("normalized") else [list(row) for row in rows]

    def sampled(self, sampler, t, turns):
        times = [row[0] for row in self.numbers(sampler["input"])]
        rows = self.numbers(sampler["output"])
        per = len(rows) // len(times)  # 3 with tangents; the number of targets for weights
        how = sampler.get("interpolation", "LINEAR")
        each = per // 3 if how == "CUBICSPLINE" else per
        keys = [[c for row in rows[k * per + (each if how == "CUBICSPLINE" else 0):][:each] for c in row] for k in range(len(times))]
        if t <= times[0] or len(times) == 1:
            return keys[0]
        if t >= times[-1]:
            return keys[-1]
        k = max(i for i, time in enumerate(times) if time <= t)
        d = times[k + 1] - times[k]
        u = (t - times[k]) / d
        if how == "STEP":
            return keys[k]
        if how == "LINEAR":
            if turns:
                return slerped(keys[k], keys[k + 1], u)
            return [a + u * (b - a) for a, b in zip(keys[k], keys[k + 1])]
        out = [c for row in rows[k * per + 2 * each:][:each] for c in row]
        into = [c for row in rows[(k + 1) * per:][:each] for c in row]
        return [(2 * u**3 - 3 * u**2 + 1) * v + d * (u**3 - 2 * u**2 + u) * b + (3 * u**2 - 2 * u**3) * w + d * (u**3 - u**2) * a
                for v, b, w, a in zip(keys[k], out, keys[k + 1], into)]

    def length(self, clip):
        inputs = [self.numbers(s["input"]) for s in self.json["animations"][clip]["samplers"]]
        return max(times[-1][0] for times in inputs)

    def vertices(self, clip=None, t=0.0):
        """Of all meshes, in the order of their nodes."""
        nodes = [dict(node) for node in self.json["nodes"]]
        if clip is not None:
            animation = self.json["animations"][clip]
            for channel in animation["channels"]:
                target = channel["target"]
                nodes[target["node"]][target["path"]] = self.sampled(animation["samplers"][channel["sampler"]], t, target["path"] == "rotation")
        world = {}

        def walk(number, above):
            node = nodes[number]
            if "matrix" in node:
                own = [[node["matrix"][4 * j + i] for j in range(4)] for i in range(4)]
            else:
                own = placed(node.get("translation", [0, 0, 0]), node.get("rotation", [0, 0, 0, 1]), node.get("scale", [1, 1, 1]))
            world[number] = product(above, own)
            for child in node.get("children", []):
                walk(child, world[number])

        unmoved = [[float(i == j) for j in range(4)] for i in range(4)]
        for root in self.json["scenes"][0]["nodes"]:
            walk(root, unmoved)
        found = []
        for number in world:
            node = nodes[number]
            if "mesh" not in node:
                continue
            mesh = self.json["meshes"][node["mesh"]]
            for primitive in mesh["primitives"]:
                points = self.numbers(primitive["attributes"]["POSITION"])
                for k, target in enumerate(primitive.get("targets", [])):
                    weight = node.get("weights", mesh.get("weights", [0] * 9))[k]
                    points = [[p + weight * s for p, s in zip(point, shift)] for point, shift in zip(points, self.numbers(target["POSITION"]))]
                if "skin" not in node:
                    found += [on(world[number], p) for p in points]
                    continue
                skin = self.json["skins"][node["skin"]]
                inverse = [[[m[4 * j + i] for j in range(4)] for i in range(4)] for m in self.numbers(skin["inverseBindMatrices"])]
                palette = [product(world[joint], m) for joint, m in zip(skin["joints"], inverse)]
                joints = self.numbers(primitive["attributes"]["JOINTS_0"])
                weights = self.numbers(primitive["attributes"]["WEIGHTS_0"])
                for p, j, w in zip(points, joints, weights):
                    total = sum(w)
                    moved = [on(palette[int(joint)], p) for joint in j]
                    found.append([sum(w[k] / total * moved[k][i] for k in range(4)) for i in range(3)])
        return found


def person():
    """A column of nine square rings on three joints, and everything that moves: two clips, every interpolation, morphs, a scaled armature."""
    views, accessors, data = [], [], b""

    def accessor(rows, kind, letter="f", code=5126, **more):
        nonlocal data
        data += b"\0" * (-len(data) % 4)
        flat = [c for row in rows for c in (row if isinstance(row, (list, tuple)) else [row])]
        packed = struct.pack(f"<{len(flat)}{letter}", *flat)
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(packed)})
        data += packed
        accessors.append({"bufferView": len(views) - 1, "componentType": code, "count": len(rows), "type": kind, **more})
        return len(accessors) - 1

    rings = 9
    points = [(x, y, z) for ring in range(rings) for y in [20 * ring] for x, z in [(-15, -15), (-15, 15), (15, 15), (15, -15)]]  # cm
    faces = [(2, 1, 0), (3, 2, 0), (4 * rings - 4, 4 * rings - 3, 4 * rings - 2), (4 * rings - 4, 4 * rings - 2, 4 * rings - 1)]
    for ring in range(rings - 1):
        for side in range(4):
            a, b = 4 * ring + side, 4 * ring + (side + 1) % 4
            faces += [(a, b, b + 4), (a, b + 4, a + 4)]
    weights = []
    for _, y, _ in points:
        upper = min(1.0, max(0.0, (y - 50) / 60))
        weights.append((int(200 * (1 - upper)), int(200 * upper * 0.75), int(200 * upper * 0.25), 0))  # of 255: they do not sum to 1
    belly = [(0, 0, 6 if 60 < y < 120 and z > 0 else 0) for _, y, z in points]
    tall = [(0, 0.1 * y, 0) for _, y, _ in points]
    inverse = []
    for y in (0, 60, 110):
        inverse.append((1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -y, 0, 1))
    primitive = {
        "attributes": {"POSITION": accessor(points, "VEC3"),
                       "JOINTS_0": accessor([(0, 1, 2, 0)] * len(points), "VEC4", "B", 5121),
                       "WEIGHTS_0": accessor(weights, "VEC4", "B", 5121, normalized=True)},
        "targets": [{"POSITION": accessor(belly, "VEC3")}, {"POSITION": accessor(tall, "VEC3")}],
        "indices": accessor([i for face in faces for i in face], "SCALAR", "H", 5123)}
    s = math.sqrt(0.5)
    times = accessor([0.25, 0.5, 1.0], "SCALAR")
    outputs = {
        "LINEAR": ("rotation", 3, accessor([(0, 0, 0, 1), (0, 0, 0.3, math.sqrt(1 - 0.09)), (0, -0.4, 0, -math.sqrt(1 - 0.16))], "VEC4")),
        "CUBIC": ("rotation", 4, accessor([v for k in range(3) for v in ((0, 0, 0, 0), (0.2 * k, 0, 0, math.sqrt(1 - 0.04 * k * k)), (0.3, 0.2, 0, 0))], "VEC4")),
        "STEP": ("translation", 4, accessor([(0, 50, 0), (0, 52, 3), (1, 50, -2)], "VEC3")),
        "SCALE": ("scale", 3, accessor([(1, 1, 1), (1.1, 0.9, 1), (1, 1.2, 0.95)], "VEC3")),
        "WEIGHTS": ("weights", 0, accessor([0, 0, 1, 0.5, 0.25, 1], "SCALAR"))}
    how = {"CUBIC": "CUBICSPLINE", "STEP": "STEP"}
    samplers = [{"input": times, "output": out, "interpolation": how.get(name, "LINEAR")} for name, (_, _, out) in outputs.items()]
    channels = [{"sampler": k, "target": {"node": node, "path": path}} for k, (path, node, _) in enumerate(outputs.values())]
    turned = accessor([(0, 0, 0, 1), (0, s, 0, s)], "VEC4")
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
        "nodes": [{"name": "skin", "mesh": 0, "skin": 0, "translation": [7, 8, 9], "scale": [3, 3, 3], "weights": [0.5, 0]},
                  {"name": "armature", "children": [2], "scale": [0.01, 0.01, 0.01], "rotation": [-s, 0, 0, s]},
                  {"name": "hips", "children": [3], "rotation": [s, 0, 0, s]},
                  {"name": "chest", "children": [4], "translation": [0, 60, 0]}, {"name": "head", "translation": [0, 50, 0], "rotation": [0, 0, 0.1, 0.995]}],
        "meshes": [{"primitives": [primitive], "weights": [0, 0]}],
        "skins": [{"joints": [2, 3, 4], "inverseBindMatrices": accessor(inverse, "MAT4")}],
        "animations": [{"name": "bend", "samplers": samplers, "channels": channels},
                       {"name": "turn", "samplers": [{"input": accessor([0, 1], "SCALAR"), "output": turned}],
                        "channels": [{"sampler": 0, "target": {"node": 2, "path": "rotation"}}]}],
        "accessors": accessors, "bufferViews": views, "buffers": [{"byteLength": len(data)}]}
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    data += b"\0" * (-len(data) % 4)
    return (b"glTF" + struct.pack("<II", 2, 28 + len(text) + len(data)) + struct.pack("<I", len(text)) + b"JSON" + text
            + struct.pack("<I", len(data)) + b"BIN\0" + data)


def frames_of(path):
    data = path.read_bytes()
    points, samples = struct.unpack_from("<i", data, 16)[0], struct.unpack_from("<i", data, 28)[0]
    return [[struct.unpack_from("<3f", data, 32 + 12 * (frame * points + k)) for k in range(points)] for frame in range(samples)]


def check(program, folder, file, clip, unit, begin):
    """Runs a scene with this body, and compares every frame after the lead-in."""
    gltf, metres = Gltf(file), {"m": 1, "cm": 0.01}[unit]
    number = next(k for k, animation in enumerate(gltf.json["animations"]) if animation["name"] == clip)
    length = gltf.length(number) - begin
    steps = round(length * FPS)
    scene = {"cloth": [{"grid": {"width_m": 0.1, "height_m": 0.1, "edge_m": 0.05}, "placement": {"translation_m": [5, 9, 5]}}],
             "body": {"mesh": str(file), "unit": unit, "motion": {"file": str(file), "clip": clip, "fps": FPS, "lead_in_s": 0.5}},
             "world": {"gravity_m_per_s2": [0, 0, 0]},
             "time": {"fps": FPS, "seconds": 0.5 + steps / FPS, "drape_seconds": 0}}
    (folder / "scene.json").write_text(json.dumps(scene))
    done = subprocess.run([program, "run", str(folder / "scene.json"), "--no-preview", "--quiet", "--out", str(folder / clip)],
                          capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    frames = frames_of(folder / clip / "body.pc2")
    rest = [[metres * c for c in p] for p in gltf.vertices()]
    height = max(p[1] for p in rest) - min(p[1] for p in rest)
    sources = []
    for p in frames[0]:  # vertices that lie in one place have become one
        apart = [max(abs(a - b) for a, b in zip(p, q)) for q in rest]
        sources.append(apart.index(min(apart)))
        assert min(apart) < SAME * height, f"at rest {min(apart)}"
    worst, moved = 0, 0
    for step in range(4, steps + 1):  # from where the clock of the motion runs evenly
        t = begin + step * length / steps
        expected = gltf.vertices(number, t)
        for p, source, before in zip(frames[12 + step], sources, frames[0]):
            worst = max(worst, max(abs(a - metres * b) for a, b in zip(p, expected[source])))
            moved = max(moved, max(abs(a - b) for a, b in zip(p, before)))
    print(f"{file.name} {clip}: {len(frames[0])} vertices, {steps + 1} poses, {worst / height:.2g} of the height apart, moved by {moved:.3g} m")
    assert worst < SAME * height, worst / height
    assert moved > 0.02 * height


def main(program, shared):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        made = folder / "person.glb"
        made.write_bytes(person())
        check(program, folder, made, "bend", "m", 0.25)
        fox = pathlib.Path(shared).resolve() / "gltf" / "Fox.glb"
        if fox.exists():
            check(program, folder, fox, "Walk", "cm", 0)
            check(program, folder, fox, "Survey", "cm", 0)


main(*sys.argv[1:])
