#!/usr/bin/env python3
"""Drafts our garments for the mannequins and writes their pattern files.

Usage: draft.py [--check]        writes beside this file; --check only compares, and fails where a file differs

Centimetres, y up, bodies on the floor facing +z: docs/patterns.md.  Panels are drawn as they hang: fronts before the
body, backs behind it, sleeves along the arms; the left side is drawn and the right one is its mirror image.  Fronts run
counter-clockwise and backs clockwise, so that outer sides face away from the body.
"""
import math
import pathlib
import sys

from panels import Garment, Panel, arc, length, rounded, solved


# ---- bodies ----

DANCER = dict(waist=67.5, waist_y=108.5, hips=96.4, hip_y=90, crotch_y=79, neck=(9.0, 145.6), tip=(19.2, 142.2), joint=(17.0, 136.7),
              wrist=54.0, bust_y=124)
MAN = dict(waist=81.8, waist_y=109, hips=96.8, hip_y=89, crotch_y=83, neck=(9.6, 153.4), tip=(21.6, 149.3), joint=(19.0, 143.2),
           wrist=58.5, bust_y=130)

FRONT, BACK = 20, -24  # z of the panels


# ---- parts ----

def waistband(garment, waist, y, height, joints, b, fabric=None, gap=1.0):
    """Front and back, `waist` around, above y; `joints` = (front, back): x of the right half's lower corners beside the middle one."""
    for name, z, xs in (("waistband_front", FRONT, joints[0]), ("waistband_back", BACK, joints[1])):
        w = waist / 4
        panel = Panel(name, "body", (0, y + gap, z), start=(-w, 0))
        stops = sorted({x for x in xs} | {-x for x in xs} | {w})
        for k, x in enumerate(s for s in stops if s > -w):
            panel.to(x, 0, name=f"lower{k}")
        panel.to(w, height, name="left_end").to(-w, height, name="upper").to(-w, 0, name="right_end").elastic(v=b)
        if fabric:
            panel.of(fabric)
        garment.add(panel)
    garment.sew_sides("waistband_front/left_end", "waistband_back/left_end")


def dart(panel, a, b, share, width, long, toward, name):
    """The line from a to b with a dart: edges name + "_before", "_leg_a", "_leg_b", "_after"; the tip lies on the side of `toward`."""
    full = math.dist(a, b)
    u = ((b[0] - a[0]) / full, (b[1] - a[1]) / full)
    at = lambda s: (a[0] + s * u[0], a[1] + s * u[1])
    middle = at(share * full)
    n = (-u[1], u[0])
    if n[0] * (toward[0] - middle[0]) + n[1] * (toward[1] - middle[1]) < 0:
        n = (u[1], -u[0])
    panel.to(*at(share * full - width / 2), name=name + "_before")
    panel.to(middle[0] + long * n[0], middle[1] + long * n[1], name=name + "_leg_a")
    panel.to(*at(share * full + width / 2), name=name + "_leg_b").to(*b, name=name + "_after")


def skirt(name, body, length_cm, band, ease, angle, slit=0):
    """Two sectors of `angle` degrees whose upper edges, `ease` times the band, are drawn into an elastic band; sides open below."""
    garment = Garment(name)
    top = ease * band / 2
    radius = top / math.radians(angle)
    y = body["waist_y"] - 1.5
    for which, z in (("front", FRONT), ("back", BACK)):
        centre = (0, radius)
        inner = arc(radius, -90 + angle / 2, -90 - angle / 2, centre)   # from the left end (x > 0) to the right one
        outer = arc(radius + length_cm, -90 - angle / 2, -90 + angle / 2, centre)
        panel = Panel(which, "leg", (0, y, z), start=outer[0])
        between = lambda p, q: tuple(a + slit / length_cm * (b - a) for a, b in zip(p, q))
        panel.to(*outer[3], *outer[1:3], name="hem")
        if slit:
            panel.to(*between(outer[3], inner[0]), name="left_slit")
        panel.to(*inner[0], name="left_side").to(*inner[3], *inner[1:3], name="waist")
        if slit:
            panel.to(*between(outer[0], inner[3]), name="right_side").to(*outer[0], name="right_slit")
        else:
            panel.to(*outer[0], name="right_side")
        garment.add(panel)
    garment.sew_sides("front/left_side", "back/left_side")
    waistband(garment, band, y + radius * (1 - math.cos(math.radians(angle / 2))), 3.0, ([], []), 0.86)
    garment.sew("front/waist", "waistband_front/lower0")
    garment.sew("back/waist", "waistband_back/lower0")
    return garment


def pleated_skirt(name, body, length_cm, band, band_b, pleats):
    """Two rectangles, each laid in `pleats` knife pleats of three layers on an elastic band, and pressed from waist to hem."""
    garment = Garment(name)
    layer = band / 2 / pleats
    half = 1.5 * band / 2  # of a rectangle, three times as wide as its half of the band
    at = [rounded(k * layer - half) for k in range(3 * pleats + 1)]
    y = body["waist_y"] - 2.5
    for which, z in (("front", FRONT), ("back", BACK)):
        panel = Panel(which, "leg", (0, y, z), start=(at[0], -length_cm))
        for k, x in enumerate(at[1:]):
            panel.to(x, -length_cm, name=f"hem{k}")
        panel.to(at[-1], 0, name="left_side")
        for k in reversed(range(3 * pleats)):
            panel.to(at[k], 0, name=f"layer{k}")
        panel.pieces[-1]["name"] = "layer0"
        panel.to(at[0], -length_cm, name="right_side")
        for k in range(3 * pleats + 1):
            if k % 3:
                panel.fold((at[k], -length_cm), (at[k], 0), 160 if k % 3 == 1 else -160)
        garment.add(panel)
    garment.sew("front/left_side", "back/left_side")
    garment.sew("front/right_side", "back/right_side")
    joints = [rounded(k * layer) for k in range((pleats + 1) // 2)]
    waistband(garment, band, y, 3.0, (joints, joints), band_b)
    for which in ("front", "back"):
        for k in range(3 * pleats):
            garment.sew(f"waistband_{which}/lower{k // 3}", f"{which}/layer{k}", right_wrong=k % 3 == 1)
    return garment


def bodice(garment, which, body, z, chest, hem, underarm_y, hem_y, neck_half, neck_depth, scoop, balance, bust_dart=0, side=None, lap=0):
    """Front or back in one piece; chest and hem are half widths, `scoop` is how far the armhole is cut in.

    With `lap` in two that reach so far over the middle, the right one outside.
    """
    tip = (body["tip"][0], body["tip"][1] + balance)
    neck = (neck_half, body["neck"][1] - (neck_half - body["neck"][0]) * 0.41 + balance)
    y0 = hem_y
    left = Panel(which, "body", (0, y0, z), start=(hem, -bust_dart))
    under = (chest, underarm_y - y0)
    if bust_dart:
        bust = (8, body["bust_y"] - y0)
        dart(left, left.start, under, 0.78, bust_dart, 11, bust, "side")
    else:
        share = side / math.dist(left.start, under) if side else 0.78  # where the front's dart ends
        at = lambda k: left.start[k] + share * (under[k] - left.start[k])
        left.to(at(0), at(1), name="side_before").to(*under, name="side_after")
    shoulder = (tip[0], tip[1] - y0)
    left.to(*shoulder, (under[0] - scoop, under[1]), (shoulder[0] - 1.9, shoulder[1] - 0.39 * (shoulder[1] - under[1])), name="armhole")
    left.to(neck[0], neck[1] - y0, name="shoulder")
    low = (0, neck[1] - neck_depth - y0)
    left.to(*low, (neck[0] - 0.15 * neck[0], neck[1] - 0.75 * neck_depth - y0), (0.55 * neck[0], low[1]), name="neck")
    if lap:
        left.name = "left_" + which
        left.to(-lap, low[1] + 0.15 * lap, name="lapel").to(-lap, 0, name="edge").to(*left.start, name="hem")
        for p in left.pieces:
            p["name"] = "left_" + p["name"]
        right = left.mirrored()
        right.translation = (0, y0, z + 4)
        garment.add(left, right)
    else:
        left.to(0, -bust_dart, name="middle").to(*left.start, name="hem")
        garment.add(left.whole(which))
    return garment.part(which)


def sleeves(garment, body, fronts, half_arm, cap, sleeve_end, wrist, cuff, cuff_height, cuff_b, drop=0, turn=-45, ease=1.01):
    """Two halves each along the arm, and elastic cuffs; wrist and cuff are half girths; the wrist is drawn `drop` below the arm's axis."""
    c = math.cos(math.radians(turn))
    joint = body["joint"]
    out = lambda d: (round(joint[0] + d * c, 3), round(joint[1] - d * c, 3))
    cap_line = lambda top, low: ((0, top), (0, top - 0.55 * (top + low)), (cap - 0.27, -low + 0.4 * (top + low)), (cap, -low))
    spans = [solved(ease * panel.edge_length("left_armhole"), lambda x: length(*cap_line(x, 0)), 5, 60) for panel in fronts]
    low = sum(spans) / 2 - half_arm  # of both halves: what the front's armhole is longer lies above the arm
    for which, z, span in (("front", 13, spans[0]), ("back", -18, spans[1])):
        p = cap_line(span - low, low)
        sleeve = Panel("left_sleeve_" + which, "arm", (*out(5), z), turn, start=p[0])
        sleeve.to(*p[3], *p[1:3], name="cap").to(sleeve_end, -wrist / 2 - drop, name="under").to(sleeve_end, wrist / 2 - drop, name="wrist")
        sleeve.to(*p[0], name="over")
        garment.pair(sleeve)
        band = Panel("left_cuff_" + which, "arm", (*out(6), z), turn, start=(sleeve_end, -cuff / 2 - drop))
        band.to(sleeve_end + cuff_height, -cuff / 2 - drop, name="under").to(sleeve_end + cuff_height, cuff / 2 - drop, name="end")
        band.to(sleeve_end, cuff / 2 - drop, name="over").to(sleeve_end, -cuff / 2 - drop, name="wrist")
        if cuff_b != 1:
            band.elastic(u=cuff_b)
        garment.pair(band)
        garment.sew_sides(f"left_sleeve_{which}/cap", f"{which}/left_armhole")
        garment.sew_sides(f"left_sleeve_{which}/wrist", f"left_cuff_{which}/wrist")
    for part in ("sleeve", "cuff"):
        for edge in ("over", "under"):
            garment.sew_sides(f"left_{part}_front/{edge}", f"left_{part}_back/{edge}")


def top(name, body, chest, hem, underarm_y, hem_y, neck, bust_dart, sleeve, balance, lap=0):
    """neck = (half width, depth in front, depth behind); chest and hem = half widths (front, back).

    `balance` makes the front longer and the back shorter above the armhole: a chest stands farther forward than a back does behind.
    """
    garment = Garment(name)
    front = bodice(garment, "front", body, FRONT + 1, chest[0], hem[0], underarm_y, hem_y, neck[0], neck[1], 7.1, balance, bust_dart, lap=lap)
    back = bodice(garment, "back", body, BACK - 1, chest[1], hem[1], underarm_y, hem_y, neck[0], neck[2], 5.8, -balance,
                  side=front.edge_length("left_side_before"))
    for edge in ("shoulder", "side_before", "side_after"):
        garment.sew_sides("front/left_" + edge, "back/left_" + edge)
    if bust_dart:
        garment.sew_sides("front/left_side_leg_a", "front/left_side_leg_b")
    sleeves(garment, body, (front, back), **sleeve)
    return garment


def collar(garment, body, stand, fall, angle_deg, fabric):
    """A turned-down collar, open in front: a stand on the neckline, and a fall that hangs over it from a pressed seam."""
    front, back = garment.part("front"), garment.part("back")
    y = body["neck"][1] + 2.5
    ends = 0.6 * stand  # the stand's height in front
    for name, z, lower, low in (("front", FRONT + 1, front.edge_length("left_neck"), ends), ("back", BACK - 1, back.edge_length("left_neck"), stand)):
        for k, layer in enumerate(("stand", "fall")):
            top, out = y + stand + 1.0, math.copysign(5, z)
            panel = Panel(f"left_{layer}_{name}", "body", ((0.5 + 2 * k) if name == "front" else 0, y if layer == "stand" else top, z + k * out))
            if layer == "stand":
                panel.start = (0, 0)
                panel.to(lower, 0, name="neck").to(lower, stand, name="side").to(0, low, name="top")
            else:
                panel.start = (0, -(stand - low))
                flare, point = (2.5, 2.0) if name == "front" else (2.5, 0)
                panel.to(-point, -(stand - low) - fall - point, name="middle" if name == "back" else "point")
                panel.to(lower + flare, -fall, name="edge").to(lower, 0, name="side")
                panel.to(0, -(stand - low), name="top")
            if layer == "stand":
                panel.to(0, 0, name="middle" if name == "back" else "end")
            if fabric:
                panel.of(fabric)
            if name == "front":
                garment.pair(panel)
            else:
                garment.add(panel.whole(f"{layer}_back"))
    garment.sew_sides("left_stand_front/neck", "front/left_neck")
    garment.sew_sides("stand_back/left_neck", "back/left_neck")
    garment.sew_sides("left_stand_front/top", "left_fall_front/top", right_wrong=True, angle_deg=angle_deg)
    garment.sew_sides("stand_back/left_top", "fall_back/left_top", right_wrong=True, angle_deg=angle_deg)
    for layer in ("stand", "fall"):
        garment.sew_sides(f"left_{layer}_front/side", f"{layer}_back/left_side")


def hem_band(garment, halves, height, b, fabric):
    """A rib below the hem, `halves` = half widths in front and behind, which the hem is eased into."""
    for which, w in zip(("front", "back"), halves):
        above = garment.part(which)
        x, y, z = above.translation
        panel = Panel("waistband_" + which, "body", (x, y - 1 - height, z), start=(-w, 0))
        panel.to(w, 0, name="lower").to(w, height, name="left_end").to(0, height, name="left_upper").to(-w, height, name="right_upper")
        panel.to(-w, 0, name="right_end").elastic(v=b).of(fabric)
        garment.add(panel)
        garment.sew_sides(f"waistband_{which}/left_upper", f"{which}/left_hem")
    garment.sew_sides("waistband_front/left_end", "waistband_back/left_end")


def hood(garment, body, apart, z, raised, rise, height, depth):
    """Two halves beside the head, `apart` from the middle plane, seen from the side: x runs to the back.  `rise` = how much higher than in front
    the neck's edge ends at the side and behind."""
    spans = [garment.part(which).edge_length("left_neck") for which in ("front", "back")]
    line = lambda x: ((0, 0), (0.45 * x, 0), (x, rise))
    side = solved(spans[0], lambda x: length(*line(x)), 1, 40)
    nape = side + math.sqrt(spans[1] ** 2 - 1)
    half = Panel("left_hood", "body", (apart, body["neck"][1] + raised, z), start=(0, 0), yaw=90)
    half.to(side, rise, line(side)[1], name="neck_front").to(nape, rise - 1, name="neck_back")
    half.to(depth, 0.55 * height, (nape, rise + 5), (depth, 0.4 * height), name="nape")
    half.to(1, height, (depth, 0.88 * height), (0.6 * depth, height), name="crown").to(0, 0, name="face")
    garment.pair(half)
    garment.sew_sides("left_hood/neck_front", "front/left_neck")
    garment.sew_sides("left_hood/neck_back", "back/left_neck")
    for edge in ("nape", "crown"):
        garment.sew("left_hood/" + edge, "right_hood/" + edge)


def belt(name, body, girth, height, b):
    """A ring of two halves around the waist, to be worn over something."""
    garment = Garment(name)
    for which, z in (("front", FRONT + 10), ("back", BACK - 10)):
        w = girth / 4
        panel = Panel(which, "body", (0, body["waist_y"] - height / 2, z), start=(-w, 0)).to(w, 0, name="lower", label="lower_interface")
        garment.add(panel.to(w, height, name="left_end").to(-w, height, name="upper").to(-w, 0, name="right_end").elastic(v=b))
    garment.sew_sides("front/left_end", "back/left_end")
    return garment


def pants(name, body, ease, band, band_height, band_b, waist_y, hem_y, hem):
    """hem = widths of the front and the back leg there."""
    garment = Garment(name)
    cy = body["crotch_y"] - 3.5
    quarter = (body["hips"] + ease) / 4
    hip_y = body["hip_y"]
    quarter_band, gather = band / 4, 1.03

    def leg(which, z, width, fork, rise, slant, crotch_height, hem_width, drop, dart_width):
        middle = (width - fork) / 2 - 0.5
        inner, outer = middle - hem_width / 2, middle + hem_width / 2
        top_long = gather * quarter_band + dart_width
        side_top = slant + math.sqrt(top_long ** 2 - rise ** 2)
        panel = Panel("left_" + which, "leg", (fork + 0.5, 0, z), start=(inner, hem_y)).to(outer, hem_y, name="hem")
        panel.to(width, hip_y, (outer, hem_y + 30), (width + 0.3, hip_y - 22), name="side_low")
        panel.to(side_top, waist_y, (width - 0.1, hip_y + 0.45 * (waist_y - hip_y)), name="side_high")
        centre = (slant, waist_y + rise)
        if dart_width:
            dart(panel, (side_top, waist_y), centre, 0.5, dart_width, 9, (side_top - 10, 0), "waist")
        else:
            panel.to(*centre, name="waist")
        panel.to(0, cy + crotch_height, name="centre")
        panel.to(-fork, cy - drop, (0, cy + 0.3 * crotch_height), (-0.45 * fork, cy - drop + 0.1), name="crotch")
        panel.to(inner, hem_y, (inner - 1, cy - 20), (inner, cy - 40), name="inseam")
        return panel

    front = leg("front", FRONT, quarter - 0.5, 5.0, 0, 1.0, 6.5, hem[0], 0, 0)
    back_of = lambda drop: leg("back", BACK, quarter + 0.5, 10.0, 2.0, 3.0, 9.0, hem[1], drop, 2.2)
    drop = solved(-front.edge_length("inseam"), lambda d: -back_of(d).edge_length("inseam"), -2, 5)
    back = back_of(drop)
    garment.pair(front)
    garment.pair(back)
    d = quarter_band / 2  # the band's corner where the dart ends
    waistband(garment, band, waist_y + 2, band_height, ((0,), (0, d)), band_b)
    for edge in ("side_low", "side_high", "inseam"):
        garment.sew_sides("left_front/" + edge, "left_back/" + edge)
    for part in ("front", "back"):
        for edge in ("centre", "crotch"):
            garment.sew(f"left_{part}/{edge}", f"right_{part}/{edge}")
    garment.sew_sides("left_back/waist_leg_a", "left_back/waist_leg_b")
    garment.sew("left_front/waist", "waistband_front/lower1")
    garment.sew("right_front/waist", "waistband_front/lower0")
    garment.sew("left_back/waist_before", "waistband_back/lower3")
    garment.sew("left_back/waist_after", "waistband_back/lower2")
    garment.sew("right_back/waist_after", "waistband_back/lower1")
    garment.sew("right_back/waist_before", "waistband_back/lower0")
    return garment


def slip(name, body, bust, waist, hips, hip_y, hem, hem_y, strap, peak, low, underarm_y, bust_dart):
    """Front and back on the bias, hung from straps.

    Half widths (front, back) at bust, waist and hips, and at the hem; the hips are measured at hip_y; `peak` = heights of the straps' lower ends in front and
    behind, `low` = of the edge between them in the middle; strap = (width, x in front, x behind, length in front, length behind).
    """
    garment = Garment(name)
    width, at, strap_long = strap[0], strap[1:3], strap[3:]
    sides = {}
    for k, (which, z) in enumerate((("front", FRONT), ("back", BACK))):
        y = lambda height: height - hem_y
        panel = Panel(which, "body", (0, hem_y, z), start=(hem, 0))
        x, drop = at[k], 0 if k else bust_dart  # below the dart the front is drawn lower
        mid, under = (waist[k], y(body["waist_y"]) - drop), (bust[k], y(underarm_y))
        low_line = lambda start_y, hip: ((hem, start_y), (hip[0] + 0.35 * (hem - hip[0]), start_y + 0.5 * (hip[1] - start_y)), hip)
        mid_line = lambda hip: (hip, (hip[0] + 0.1, hip[1] + 0.35 * (mid[1] - hip[1])), (mid[0], mid[1] - 0.3 * (mid[1] - hip[1])), mid)
        hip, start_y = (hips[k], y(hip_y) - drop), -drop
        if k:  # as long as the front's, though wider at the hips
            hip = (hips[k], -solved(sides["middle"], lambda h: length(*mid_line((hips[k], -h))), -hip[1] - 5, -hip[1] + 5))
            start_y = -solved(sides["low"], lambda d: length(*low_line(-d, hip)), -5, 5)
        panel.start = (hem, start_y)
        panel.to(*hip, low_line(start_y, hip)[1], name="side_low")
        panel.to(*mid, *mid_line(hip)[1:3], name="side_middle")
        if not k:
            dart(panel, mid, under, 0.68, bust_dart, 10.5, (8, y(body["bust_y"])), "side")
            sides = {edge: panel.edge_length("side_" + edge) for edge in ("low", "middle", "before", "after")}
        else:
            share = sides["before"] / (sides["before"] + sides["after"])
            panel.to(mid[0] + share * (under[0] - mid[0]), mid[1] + share * (under[1] - mid[1]), name="side_before").to(*under, name="side_after")
        top = y(peak[k])
        out, inner = (x + width / 2, top), (x - width / 2, top)
        panel.to(*out, (out[0] + 3.5, under[1] + 0.3), (out[0] + 0.6, out[1] - 4), name="armhole")
        panel.to(*inner, name="strap")
        centre = (0, y(low[k]))
        panel.to(*centre, (inner[0] - 1.5, inner[1] - 3.5), (0.45 * inner[0], centre[1]), name="neck")
        panel.to(0, panel.start[1], name="middle").to(*panel.start, name="hem")
        panel.finished({"tape_mm": 6}, "armhole", "neck").finished({"hem_mm": 6}, "hem")
        garment.add(panel.whole(which).on_the_bias())
        piece = Panel("left_strap_" + which, "body", (x, peak[k] + 0.6, z), start=(-width / 2, 0))
        piece.to(width / 2, 0, name="lower").to(width / 2, strap_long[k], name="outer").to(-width / 2, strap_long[k], name="shoulder")
        piece.to(-width / 2, 0, name="inner")
        garment.pair(piece)
        garment.sew_sides(f"left_strap_{which}/lower", f"{which}/left_strap")
    garment.sew_sides("left_strap_front/shoulder", "left_strap_back/shoulder")
    for edge in ("low", "middle", "before", "after"):
        garment.sew_sides("front/left_side_" + edge, "back/left_side_" + edge)
    garment.sew_sides("front/left_side_leg_a", "front/left_side_leg_b")
    return garment


# ---- the garments ----

def garments():
    blouse_sleeve = dict(half_arm=10.5, cap=11, sleeve_end=55.5, wrist=14, cuff=11.5, cuff_height=4, cuff_b=0.76, drop=3)
    shirt_sleeve = dict(half_arm=11, cap=13, sleeve_end=54.5, wrist=13, cuff=12, cuff_height=5, cuff_b=1)
    shirt = top("man_shirt", MAN, (28.0, 27.6), (25.0, 24.6), 126, 85, (9.0, 9.5, 1.5), 0, shirt_sleeve, 1.5)
    collar(shirt, MAN, 3.0, 5.0, -120, None)
    hoody_sleeve = dict(half_arm=11.5, cap=13, sleeve_end=53.5, wrist=12, cuff=10.4, cuff_height=6, cuff_b=0.88, drop=1.5)
    hoody = top("hoody", MAN, (29.0, 28.6), (26.5, 26.1), 125, 90, (9.5, 8.5, 1.5), 0, hoody_sleeve, 1.5)
    hem_band(hoody, (24.4, 24.0), 6, 0.97, "knit")
    hood(hoody, MAN, 13, 11, 0, 5, 40, 26.5)
    coat_sleeve = dict(half_arm=12.5, cap=13.5, sleeve_end=55, wrist=16, cuff=15.8, cuff_height=6, cuff_b=1, drop=3)
    coat = top("coat", MAN, (31.0, 30.4), (36, 36), 122, 58, (9.8, 10.0, 1.8), 0, coat_sleeve, 1.5, lap=9)
    collar(coat, MAN, 3.5, 6.5, -120, None)
    return [
        shirt,
        pants("man_pants", MAN, 10, 88, 4, 0.80, 104, 9.5, (22, 24)),
        skirt("short_skirt", DANCER, 38, 72, 1.04, 46, slit=15),
        skirt("long_skirt", DANCER, 84, 72, 1.12, 84),
        pleated_skirt("pleated_skirt", DANCER, 52, 70, 0.93, 8),
        top("blouse", DANCER, (26.2, 26.6), (27, 26.5), 120.5, 86, (9.5, 9.5, 2.0), 2.5, blouse_sleeve, 1.5),
        hoody,
        coat,
        belt("belt", MAN, 140, 5, 0.68),
        slip("slip", DANCER, (22.8, 20.8), (19.2, 18.6), (24.6, 26.4), 84, 31.5, 46, (1.2, 9.0, 6.5, 17.6, 19.0), (131, 127), (122.5, 121.5), 122.5, 2.5),
    ]


def main():
    folder = pathlib.Path(__file__).resolve().parent
    stale = []
    for garment in garments():
        path = folder / (garment.name + ".json")
        if sys.argv[1:] != ["--check"]:
            path.write_text(garment.text())
        elif not path.exists() or path.read_text() != garment.text():
            stale.append(path.name)
    if stale:
        print("differ from what patterns/draft.py draws:", ", ".join(stale))
    return 1 if stale else 0


if __name__ == "__main__":
    sys.exit(main())
