#!/usr/bin/env python3
"""Makes the plots and tables of docs/validation.md from what the validation tests measured.

Usage: plot_validation.py [FOLDER]      FOLDER: the tests' tables, build/release/validation by default

Run all validation tests first, the long ones too.  Tables go between the marks <!-- table NAME --> and <!-- end --> of the page;
the rest of it is written by hand.  Plots need matplotlib (pip install matplotlib); without it only the tables are made.
"""
import csv
import pathlib
import sys
from collections import defaultdict

root = pathlib.Path(__file__).resolve().parent.parent
page = root / "docs/validation.md"
images = root / "docs/images"


def read(folder):
    """[test] -> rows: case, mesh, quantity, reference (or None), measured"""
    found = defaultdict(list)
    for path in sorted(folder.glob("*.csv")):
        with path.open() as file:
            for row in csv.DictReader(file):
                if row.get("measured"):
                    found[row["test"]].append((row["case"], row["mesh"], row["quantity"],
                                               float(row["reference"]) if row["reference"] else None, float(row["measured"])))
    return found


def number(value):
    return "" if value is None else f"{value:.4g}"


def deviation(reference, measured):
    if reference is None:
        return ""
    return number(measured) if reference == 0 else f"{100 * (measured / reference - 1):+.1f} %"


def by_mesh(rows, quantity, first="case", with_deviation=True):
    """One line per case: the reference, then what each mesh measured."""
    rows = [r for r in rows if r[2] == quantity]
    meshes = list(dict.fromkeys(r[1] for r in rows))
    lines = [f"| {first} | reference | " + " | ".join(meshes) + " |", "|---" * (len(meshes) + 2) + "|"]
    for case in dict.fromkeys(r[0] for r in rows):
        cells = {r[1]: r for r in rows if r[0] == case}
        reference = next(iter(cells.values()))[3]
        texts = []
        for mesh in meshes:
            if mesh not in cells:
                texts.append("")
                continue
            measured = cells[mesh][4]
            extra = f" ({deviation(reference, measured)})" if with_deviation and reference else ""
            texts.append(number(measured) + extra)
        lines.append(f"| {case} | {number(reference)} | " + " | ".join(texts) + " |")
    return lines


def without_reference(rows, quantity, first):
    lines = by_mesh(rows, quantity, first, with_deviation=False)
    return ["|".join(line.split("|")[:2] + line.split("|")[3:]) for line in lines]


def drape_table(rows):
    meshes = list(dict.fromkeys(r[1] for r in rows))
    lines = ["| fabric | " + " | ".join(meshes) + " |", "|---" * (len(meshes) + 1) + "|"]
    value = {(r[0], r[1], r[2]): r[4] for r in rows}
    for fabric in dict.fromkeys(r[0] for r in rows):
        lines.append(f"| {fabric} | " + " | ".join(
            f"{value[fabric, mesh, 'DC %']:.1f} %, {value[fabric, mesh, 'folds']:.0f} folds" for mesh in meshes) + " |")
    return lines


def tables(figures):
    return {
        "cantilever_curve": by_mesh(figures["cantilever_curve"], "H/W"),
        "cantilever_refined": by_mesh([(f"{r[0]}, {r[1].rsplit(' ', 1)[0]}", r[1].rsplit(" ", 1)[1], *r[2:])
                                       for r in figures["cantilever_refined"]], "H/W"),
        "cantilever_anisotropic": by_mesh(figures["cantilever_anisotropic"], "D realised / asked", "D_u : D_v"),
        "bending_length": bending_length_table(figures["bending_length_fabrics"]),
        "lateral_buckling": by_mesh(figures["lateral_buckling"], "Gamma critical"),
        "hanging_strip": by_mesh(figures["hanging_strip"], "elongation mm"),
        "pure_shear": [line for q in ("force per width N/m", "energy mJ")
                       for line in by_mesh([(q, *r[1:]) for r in figures["pure_shear"]], q)[0 if q[0] == "f" else 2:]],
        "decay": decay_table(figures["decay"]),
        "decay_plates": decay_table(figures["decay_plates"]),
        "energy": without_reference(figures["energy"], "rises / loss", "case"),
        "momentum": without_reference(figures["momentum"], "angular momentum lost in 1 s", "free sheet"),
        "drape": drape_table(figures["drape"]),
        "drape_seeds": drape_table(figures["drape_seeds"]),
    }


def bending_length_table(rows):
    value = {(r[0].rsplit(" ", 1)[0], r[0].rsplit(" ", 1)[1], r[2]): r[4] for r in rows}
    lines = ["| fabric | bending length, cm, warp and weft | chord at twice that, degrees | off |", "|---|---|---|---|"]
    for fabric in dict.fromkeys(key[0] for key in value):
        lengths, chords = ([value[fabric, thread, quantity] for thread in ("warp", "weft")] for quantity in ("bending length cm", "chord deg"))
        lines.append(f"| {fabric} | {lengths[0]:.2f}, {lengths[1]:.2f} | {chords[0]:.1f}, {chords[1]:.1f} | "
                     f"{deviation(41.5, chords[0])}, {deviation(41.5, chords[1])} |")
    return lines


def decay_table(rows):
    steps = list(dict.fromkeys(r[0].split(", ")[1] for r in rows))
    lines = ["| period | " + " | ".join(steps) + " |", "|---" * (len(steps) + 1) + "|"]
    for period in dict.fromkeys(r[0].split(", ")[0] for r in rows):
        cells = {r[0].split(", ")[1]: r for r in rows if r[0].split(", ")[0] == period}
        texts = (f"{r[4]:.4f} of {r[3]:.4f} ({deviation(r[3], r[4])})" if r else "" for r in map(cells.get, steps))
        lines.append(f"| {period.removeprefix('period ')} | " + " | ".join(texts) + " |")
    return lines


def write_tables(figures):
    text = page.read_text()
    for name, lines in tables(figures).items():
        if len(lines) < 3:
            print(f"no figures for {name}: run its test")
            continue
        mark = f"<!-- table {name} -->"
        if mark not in text:
            print(f"docs/validation.md has no place for {name}")
            continue
        before, rest = text.split(mark, 1)
        text = before + mark + "\n" + "\n".join(lines) + "\n" + rest[rest.index("<!-- end -->"):]
    page.write_text(text)


def plots(figures, folder):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    plt.rcParams.update({"font.size": 9, "axes.grid": True, "grid.alpha": 0.3,
                         "axes.spines.top": False, "axes.spines.right": False})

    def save(figure, name):
        images.mkdir(exist_ok=True)
        figure.tight_layout()
        figure.savefig(images / f"{name}.png", dpi=90)
        plt.close(figure)

    rows = figures["cantilever_curve"]
    figure, (curve, error) = plt.subplots(1, 2, figsize=(7.6, 3.1))
    meshes = list(dict.fromkeys(r[1] for r in rows))
    gamma = lambda r: float(r[0].split()[1])
    first = [r for r in rows if r[1] == meshes[0]]
    curve.loglog([gamma(r) for r in first], [r[3] for r in first], "k-", lw=1, label="elastica")
    for mesh, mark in zip(meshes, "os^Dv"):
        mine = [r for r in rows if r[1] == mesh]
        curve.loglog([gamma(r) for r in mine], [r[4] for r in mine], mark, ms=4, mfc="none", label=mesh)
        error.semilogx([gamma(r) for r in mine], [100 * (r[4] / r[3] - 1) for r in mine], mark + "-", ms=3, lw=0.7, mfc="none")
    error.axhspan(-2, 2, color="0.9", zorder=0)
    error.set(xlabel="Γ = ρ g L³/D", ylabel="deviation of H/W, %", ylim=(-4, 4))
    curve.set(xlabel="Γ = ρ g L³/D", ylabel="drop over reach, H/W")
    curve.legend(frameon=False, fontsize=7)
    save(figure, "validation_cantilever")

    rows = [r for r in figures["drape"] if r[2] == "DC %"]
    bands = {"silk": (20, 40), "cotton": (60, 76), "wool": (40, 70), "denim": (70, 90)}
    figure, (axes, shadow) = plt.subplots(1, 2, figsize=(7.6, 3.1), gridspec_kw={"width_ratios": [1.3, 1]})
    fabrics, meshes = list(dict.fromkeys(r[0] for r in rows)), list(dict.fromkeys(r[1] for r in rows))
    for place, fabric in enumerate(fabrics):
        if fabric in bands:
            low, high = bands[fabric]
            axes.bar(place, high - low, 0.8, low, color="0.87", label="published" if place == 0 else None)
        for k, mesh in enumerate(meshes):
            value = [r[4] for r in rows if r[0] == fabric and r[1] == mesh]
            axes.plot(place + 0.16 * (k - 1.5), value[0], "os^D"[k], ms=4, color=f"C{k}", label=mesh if place == 0 else None)
    axes.set_xticks(range(len(fabrics)), fabrics)
    axes.set(ylabel="drape coefficient, %", ylim=(0, 100))
    axes.legend(frameon=False, fontsize=7, ncols=2, loc="lower right")
    for fabric in fabrics:
        path = folder / f"drape_rim_{fabric}.txt"
        if path.exists():
            points = [tuple(map(float, line.split())) for line in path.read_text().splitlines()]
            points.append(points[0])
            shadow.plot([100 * p[0] for p in points], [-100 * p[1] for p in points], lw=1, label=fabric)
    shadow.add_patch(plt.Circle((0, 0), 9, fill=False, ls=":", color="k", lw=0.8))
    shadow.set(aspect="equal", xlabel="rim from above, cm", xlim=(-16, 16), ylim=(-16, 16))
    if shadow.get_lines():
        shadow.legend(frameon=False, fontsize=7, loc="center")
    save(figure, "validation_drape")

    figure, (decay, turn, buckle) = plt.subplots(1, 3, figsize=(7.6, 2.7))
    rows = figures["decay"]
    for k, step in enumerate(dict.fromkeys(r[0].split(", ")[1] for r in rows)):
        mine = [r for r in rows if r[0].endswith(step)]
        period = [float(r[0].split()[1]) for r in mine]
        decay.semilogx(period, [r[3] for r in mine], "-", color=f"C{k}", lw=0.8)
        decay.semilogx(period, [r[4] for r in mine], "o", ms=4, mfc="none", color=f"C{k}", label=step)
    decay.set(xlabel="period, s", ylabel="amplitude after one period", ylim=(0, 1))
    decay.legend(frameon=False, fontsize=7)
    rows = [r for r in figures["momentum"] if r[2].startswith("angular")]
    for k, case in enumerate(dict.fromkeys(r[0] for r in rows)):
        mine = [r for r in rows if r[0] == case]
        turn.semilogx([float(r[1].split("/")[1].split()[0]) for r in mine], [r[4] for r in mine], "os"[k] + "-", ms=4, mfc="none", label=case)
    turn.set(xlabel="steps per second", ylabel="angular momentum lost in 1 s", ylim=(0, 1.05))
    turn.set_xticks([30, 60, 120, 240], ["30", "60", "120", "240"])
    turn.set_xticks([], minor=True)
    turn.legend(frameon=False, fontsize=7, loc="lower left")
    for k, case in enumerate(dict.fromkeys(r[0] for r in figures["lateral_buckling"])):
        rows = [r for r in figures["lateral_buckling"] if r[0] == case]
        cells = [1 / float(r[1].rsplit("/", 1)[1]) for r in rows]
        buckle.plot(cells, [r[4] for r in rows], "o-", ms=4, lw=0.7, mfc="none", color=f"C{k}", label=case.rsplit(", ", 1)[1])
        buckle.axhline(rows[0][3], color=f"C{k}", lw=0.8, ls=":")
    buckle.set(xlabel="cell / width", ylabel="Γ at buckling", ylim=(10, 24), xlim=(0, 0.3))
    buckle.legend(frameon=False, fontsize=7)
    save(figure, "validation_motion")


def main():
    folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else root / "build/release/validation")
    figures = read(folder)
    if not figures:
        print(f"{folder} holds no tables: run the validation tests first")
        return 1
    write_tables(figures)
    try:
        plots(figures, folder)
    except ImportError:
        print("matplotlib is not there: tables only")
    return 0


if __name__ == "__main__":
    sys.exit(main())
