"""Panels and garments as draft.py draws them: outlines of lines and Bezier curves, in centimetres, and their pattern file."""
import json
import math


# ---- lines: a piece of an outline is (control points..., end), with the point before it as its start ----

def bezier(points, t):
    while len(points) > 1:
        points = [((1 - t) * a[0] + t * b[0], (1 - t) * a[1] + t * b[1]) for a, b in zip(points, points[1:])]
    return points[0]


def length(*points):
    fine = [bezier(list(points), i / 400) for i in range(401)]
    return sum(math.dist(a, b) for a, b in zip(fine, fine[1:]))


def arc(radius, angle0, angle1, centre=(0, 0)):
    """Control points of the cubic next to an arc of a circle, angles in degrees from +x."""
    a, b = math.radians(angle0), math.radians(angle1)
    k = 4 / 3 * math.tan((b - a) / 4) * radius
    p = lambda t, along: (centre[0] + radius * math.cos(t) - along * math.sin(t), centre[1] + radius * math.sin(t) + along * math.cos(t))
    return [p(a, 0), p(a, k), p(b, -k), p(b, 0)]


def solved(wanted, measure, low, high):
    """x between low and high where measure(x), which rises, is `wanted`."""
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if measure(middle) < wanted else (low, middle)
    return (low + high) / 2


class Panel:
    """An outline: start, then pieces.  A piece is a dict: to, via (0 to 2 control points), name, label."""

    def __init__(self, name, label, translation, turn=0, start=None, yaw=0):
        self.name, self.label, self.translation, self.turn, self.yaw = name, label, translation, turn, yaw
        self.start, self.pieces, self.extension, self.folds, self.finishes = start, [], {}, [], []

    def to(self, x, y, *via, name=None, label=None):
        self.pieces.append({"to": (x, y), "via": list(via), "name": name, "label": label})
        return self

    def elastic(self, **rest_stretch):
        self.extension.update({f"rest_stretch_{k}": v for k, v in rest_stretch.items()})
        return self

    def of(self, fabric):
        self.extension["fabric"] = fabric
        return self

    def finished(self, mm, *names):
        """A tape or a hem, "tape_mm" or "hem_mm", on these edges."""
        self.finishes += [(name, mm) for name in names]
        return self

    def on_the_bias(self):
        """Cut at 45 degrees to the warp: drawn turned, and hung turned back."""
        turned = lambda p: ((p[0] - p[1]) * math.sqrt(0.5), (p[0] + p[1]) * math.sqrt(0.5))
        other = Panel(self.name, self.label, self.translation, self.turn - 45, turned(self.start))
        for p in self.pieces:
            other.to(*turned(p["to"]), *map(turned, p["via"]), name=p["name"], label=p["label"])
        other.extension, other.finishes = self.extension, self.finishes
        return other

    def fold(self, a, b, angle_deg):
        """Along the straight line between two corners, given by their coordinates."""
        self.folds.append((a, b, angle_deg))
        return self

    def corners(self):
        return [self.start] + [p["to"] for p in self.pieces[:-1]]

    def points(self, k):
        return [self.corners()[k], *self.pieces[k]["via"], self.pieces[k]["to"]]

    def edge(self, name):
        return next(k for k, p in enumerate(self.pieces) if p["name"] == name)

    def edge_length(self, name):
        return length(*self.points(self.edge(name)))

    def area(self):
        ring = [bezier(self.points(k), i / 16) for k in range(len(self.pieces)) for i in range(16)]
        return sum(a[0] * b[1] - a[1] * b[0] for a, b in zip(ring, ring[1:] + ring[:1])) / 2

    def reversed(self):
        other = Panel(self.name, self.label, self.translation, self.turn, self.start, self.yaw)
        corners = self.corners()
        for k in reversed(range(len(self.pieces))):
            p = self.pieces[k]
            other.to(*corners[k], *reversed(p["via"]), name=p["name"], label=p["label"])
        other.extension, other.folds, other.finishes = self.extension, self.folds, self.finishes
        return other

    def whole(self, name):
        """The panel, drawn counter-clockwise with its last or first edge "middle" on x = 0, and its image in one."""
        k = self.edge("middle")
        pieces = self.pieces[k + 1:] + self.pieces[:k]
        start = self.pieces[k]["to"]
        other = Panel(name, self.label, self.translation, self.turn, start)
        for p in pieces:
            other.to(*p["to"], *p["via"], name="left_" + p["name"], label=p["label"])
        points = [start] + [p["to"] for p in pieces]
        for k in reversed(range(len(pieces))):
            p = pieces[k]
            other.to(-points[k][0], points[k][1], *[(-x, y) for x, y in reversed(p["via"])], name="right_" + p["name"], label=p["label"])
        other.extension = self.extension
        other.finishes = [(side + name, mm) for name, mm in self.finishes for side in ("left_", "right_")]
        return other

    def facing(self):
        """Counter-clockwise in front of the body, clockwise behind it."""
        return self if (self.area() > 0) == (self.translation[2] > 0) else self.reversed()

    def mirrored(self):
        swap = lambda s: s.replace("left", "right") if s else s
        flip = lambda p: (-p[0], p[1])
        x, y, z = self.translation
        other = Panel(swap(self.name), self.label, (-x, y, z), -self.turn, flip(self.start), -self.yaw)
        for p in self.pieces:
            other.to(*flip(p["to"]), *map(flip, p["via"]), name=swap(p["name"]), label=p["label"])
        other.extension = dict(self.extension)
        other.folds = [(flip(a), flip(b), angle) for a, b, angle in self.folds]
        other.finishes = [(swap(name), mm) for name, mm in self.finishes]
        return other.facing()


def rounded(x, digits=3):
    x = round(x, digits)
    return int(x) if x == int(x) else x


class Garment:
    def __init__(self, name):
        self.name, self.panels, self.stitches = name, [], []

    def add(self, *panels):
        self.panels += [p.facing() for p in panels]

    def pair(self, panel):
        """The panel and its mirror image."""
        self.add(panel, panel.mirrored())

    def sew(self, a, b, right_wrong=False, angle_deg=0):
        """Edges as "panel/edge"."""
        self.stitches.append((a, b, right_wrong, angle_deg))

    def sew_sides(self, a, b, **how):
        """The same on the left and on the right."""
        self.sew(a, b, **how)
        self.sew(a.replace("left", "right"), b.replace("left", "right"), **how)

    def part(self, name, side="left"):
        """The panel of that name, or that side's half of it."""
        return next(p for p in self.panels if p.name in (name, f"{side}_{name}"))

    def side(self, text):
        name, edge = text.split("/")
        panel = self.part(name, edge.split("_")[0])
        return {"panel": panel.name, "edge": panel.edge(edge)}

    def text(self):
        one = lambda value: json.dumps(value)
        lines, extension = [], {}
        for panel in self.panels:
            corners = panel.corners()
            number = {tuple(rounded(c) for c in corner): k for k, corner in enumerate(corners)}
            edges = []
            for k, piece in enumerate(panel.pieces):
                start, end = corners[k], piece["to"]
                edge = {"endpoints": [k, (k + 1) % len(corners)]}
                if piece["via"]:
                    e = (end[0] - start[0], end[1] - start[1])
                    e2 = e[0] ** 2 + e[1] ** 2
                    relative = lambda p: [rounded(((p[0] - start[0]) * e[0] + (p[1] - start[1]) * e[1]) / e2, 5),
                                          rounded(((p[1] - start[1]) * e[0] - (p[0] - start[0]) * e[1]) / e2, 5)]
                    edge["curvature"] = {"type": "quadratic" if len(piece["via"]) == 1 else "cubic",
                                         "params": [relative(p) for p in piece["via"]]}
                if piece["label"]:
                    edge["label"] = piece["label"]
                edges.append("     " + one(edge))
            lines.append(f'   {one(panel.name)}: {{\n    "translation": {one([rounded(t) for t in panel.translation])},\n'
                         f'    "rotation": {one([0, panel.yaw, panel.turn])},\n    "vertices": [\n     '
                         + ",\n     ".join(one([rounded(c) for c in corner]) for corner in corners)
                         + '\n    ],\n    "edges": [\n' + ",\n".join(edges) + f'\n    ],\n    "label": {one(panel.label)}\n   }}')
            more = dict(panel.extension)
            if panel.folds:
                more["folds"] = [{"endpoints": [number[tuple(map(rounded, a))], number[tuple(map(rounded, b))]], "angle_deg": angle}
                                 for a, b, angle in panel.folds]
            if panel.finishes:
                more["edges"] = [{"edge": panel.edge(name), **mm} for name, mm in panel.finishes]
            if more:
                extension[panel.name] = more
        stitches = ",\n".join("   " + one([self.side(a), self.side(b)] + ["right_wrong"] * turned) for a, b, turned, _ in self.stitches)
        pressed = [{"stitch": k, "angle_deg": angle} for k, (_, _, _, angle) in enumerate(self.stitches) if angle]
        text = ('{\n "pattern": {\n  "panels": {\n' + ",\n".join(lines) + '\n  },\n  "stitches": [\n' + stitches
                + '\n  ],\n  "panel_order": ' + one([p.name for p in self.panels]) + '\n },\n')
        ours = []
        if extension:
            ours.append('  "panels": {\n' + ",\n".join(f"   {one(k)}: {one(v)}" for k, v in extension.items()) + '\n  }')
        if pressed:
            ours.append('  "stitches": ' + one(pressed))
        if ours:
            text += ' "toile": {\n' + ",\n".join(ours) + '\n },\n'
        return text + (' "parameters": {},\n "parameter_order": [],\n "properties": {\n  "curvature_coords": "relative",\n'
                       '  "normalize_panel_translation": false,\n  "normalized_edge_loops": true,\n  "units_in_meter": 100\n }\n}\n')
