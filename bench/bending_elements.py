#!/usr/bin/env python3
"""Bending elements on five kinds of triangles, for small deflections: how far each is off, and what it costs.

    bench/bending_elements.py [--nu 0.3] [--cells 4 8]        needs numpy and scipy; a minute

A row for each mesh of a strip of 1 x 0.25 and each element, as in docs/theory/bend.md#which-element; all but the last two over what they
should be:

    rolled       stiffness inside the sheet when it is rolled up: least and most of eight directions
    twist        stiffness of the strip against twist, ends held, over that of a plate, 2 (1 - nu) D
    cantilever   tip under its own weight over that of a beam; nu = 0
    buckling     load at the tip at which the upright strip falls to the side, over that of plates with 32 cells across
    entries      of the stiffness matrix, per particle: blocks of 3 x 3 in a cloth
    unknowns     heights and slopes, per particle

hinge      one spring per inner edge, weight L^2/(A1 + A2).  The quadratic and the cubic bending energies of Bergou (2006) and Garg (2007)
           have this stencil and, on a plane, its angles: they differ in the weights.
average    a shape operator per triangle, its normal at an edge being the mean of both sides' (Grinspun et al. 2006 without its unknowns)
fit        a quadratic surface through a triangle and the far corners of its neighbours
plate      moments continuous across edges: Hellan, Herrmann, Johnson; the same as Morley's triangles, which are what is solved here
"""
import argparse
import collections

import numpy as np
import scipy.sparse
import scipy.sparse.linalg
from scipy.spatial import Delaunay

LENGTH, WIDTH = 1.0, 0.25
SIDES = ((1, 2), (2, 0), (0, 1))  # corners of the side opposite to each corner


def doubled_area(p):
    return (p[1, 0] - p[0, 0]) * (p[2, 1] - p[0, 1]) - (p[2, 0] - p[0, 0]) * (p[1, 1] - p[0, 1])


def length_and_normal(points, i, j):
    edge = points[j] - points[i]
    length = np.hypot(*edge)
    return length, np.array([edge[1], -edge[0]]) / length


# Meshes.


def delaunay(points, cell):
    triangles = Delaunay(points).simplices
    return np.array([t for t in triangles if abs(doubled_area(points[t])) > 1e-3 * cell * cell])


def equilateral(cells):
    cell = WIDTH / cells
    rows = round(LENGTH / (cell * np.sqrt(3) / 2))
    points = []
    for row in range(rows + 1):
        across = np.arange(cells + 1) * cell
        if row % 2:
            across = np.concatenate([[0], (np.arange(cells) + 0.5) * cell, [WIDTH]])
        points += [(row * LENGTH / rows, y - WIDTH / 2) for y in across]
    points = np.array(points)
    return points, delaunay(points, cell)


def mesher(cells):
    """Random points, each moved to the mean of its neighbours sixty times."""
    cell, random = WIDTH / cells, np.random.default_rng(1)
    along = round(LENGTH / cell)
    border = [(i * LENGTH / along, side * WIDTH / 2) for i in range(along + 1) for side in (-1, 1)]
    border = np.array(border + [(end, j * cell - WIDTH / 2) for j in range(1, cells) for end in (0, LENGTH)])
    count = int(LENGTH * WIDTH / (cell * cell * np.sqrt(3) / 2)) - len(border) // 2
    inner = np.column_stack([random.uniform(0.3 * cell, LENGTH - 0.3 * cell, count),
                             random.uniform(0.3 * cell - WIDTH / 2, WIDTH / 2 - 0.3 * cell, count)])
    for _ in range(60):
        points = np.vstack([border, inner])
        total, number = np.zeros_like(points), np.zeros(len(points))
        triangles = Delaunay(points).simplices
        for k in range(3):
            for other in (1, 2):
                np.add.at(total, triangles[:, k], points[triangles[:, (k + other) % 3]])
                np.add.at(number, triangles[:, k], 1)
        inner = (total / number[:, None])[len(border):]
    points = np.vstack([border, inner])
    return points, delaunay(points, cell)


def grid(cells, kind):
    cell, along = WIDTH / cells, round(LENGTH * cells / WIDTH)
    points = [(i * LENGTH / along, j * cell - WIDTH / 2) for i in range(along + 1) for j in range(cells + 1)]
    triangles = []
    for i in range(along):
        for j in range(cells):
            a = i * (cells + 1) + j
            b, c, d = a + cells + 1, a + cells + 2, a + 1
            if kind == "criss-cross":
                points.append(tuple((np.array(points[a]) + points[c]) / 2))
                middle = len(points) - 1
                triangles += [(a, b, middle), (b, c, middle), (c, d, middle), (d, a, middle)]
            elif kind == "one diagonal" or (i + j) % 2:
                triangles += [(a, b, c), (a, c, d)]
            else:
                triangles += [(a, b, d), (b, c, d)]
    return np.array(points), np.array(triangles)


def mesh(kind, cells):
    points, triangles = {"equilateral": equilateral, "mesher": mesher}.get(kind, lambda n: grid(n, kind))(cells)
    return points, np.array([t if doubled_area(points[t]) > 0 else t[[0, 2, 1]] for t in triangles])


# Elements: stiffness over heights (and slopes), and where the slopes are.


def rigidity(nu):
    return np.array([[1, nu, 0], [nu, 1, 0], [0, 0, (1 - nu) / 2]])


def edges_of(triangles):
    edges = collections.defaultdict(list)
    for t, corners in enumerate(triangles):
        for k, (i, j) in enumerate(SIDES):
            edges[min(corners[i], corners[j]), max(corners[i], corners[j])].append((t, k))
    return edges


def fold_angle(points, i, j, p, q):
    """d theta / d height of the corners, for the edge i j with far corners p and q."""
    length, _ = length_and_normal(points, i, j)
    high = {far: abs(doubled_area(points[[i, j, far]])) / length for far in (p, q)}
    share = {far: (points[far] - points[i]) @ (points[j] - points[i]) / length**2 for far in (p, q)}
    return {p: -1 / high[p], q: -1 / high[q], i: sum((1 - share[far]) / high[far] for far in (p, q)),
            j: sum(share[far] / high[far] for far in (p, q))}


def hinges_of(points, triangles):
    hinges = {}
    for edge, sides in edges_of(triangles).items():
        if len(sides) == 2:
            (t, k), (other, m) = sides
            i, j = (triangles[t][c] for c in SIDES[k])
            hinges[edge] = fold_angle(points, i, j, triangles[t][k], triangles[other][m])
    return hinges


class Matrix:
    def __init__(self):
        self.rows, self.columns, self.values = [], [], []

    def add(self, left, right, factor):
        for i, x in left.items():
            for j, y in right.items():
                self.rows.append(i)
                self.columns.append(j)
                self.values.append(factor * x * y)

    def csr(self, size):
        return scipy.sparse.csr_matrix((self.values, (self.rows, self.columns)), (size, size))


def hinge_terms(points, triangles):
    edges = edges_of(triangles)
    for edge, g in hinges_of(points, triangles).items():
        area = sum(doubled_area(points[triangles[t]]) / 2 for t, _ in edges[edge])
        yield [g], np.array([[min(20, length_and_normal(points, *edge)[0] ** 2 / area)]]), area / 3, True


def triangle_terms(points, triangles, nu, of_angles):
    """A/2 S.C S, S linear in a triangle's three fold angles; those at a free edge take their natural values."""
    hinges, C = hinges_of(points, triangles), rigidity(nu)
    for corners in triangles:
        area = doubled_area(points[corners]) / 2
        sides = [tuple(sorted((corners[i], corners[j]))) for i, j in SIDES]
        B = of_angles(points, corners, [hinges.get(side) for side in sides])
        Q = area * B.T @ C @ B
        have = [k for k in range(3) if sides[k] in hinges]
        free = [k for k in range(3) if k not in have]
        reduced = Q[np.ix_(have, have)]
        if free and have:
            reduced = reduced - Q[np.ix_(have, free)] @ np.linalg.solve(Q[np.ix_(free, free)], Q[np.ix_(free, have)])
        yield [hinges[sides[k]] for k in have], reduced, area, not free


def averaged(points, corners, _):
    area = doubled_area(points[corners]) / 2
    columns = []
    for i, j in SIDES:
        length, n = length_and_normal(points, corners[i], corners[j])
        columns.append(-length / (2 * area) * np.array([n[0] ** 2, n[1] ** 2, 2 * n[0] * n[1]]))
    return np.array(columns).T


def fitted(points, corners, angles):
    rows = []
    for k, (i, j) in enumerate(SIDES):
        g, at = angles[k], points
        if g is None:  # the triangle's own mirror image
            at = np.vstack([points, points[corners[i]] + points[corners[j]] - points[corners[k]]])
            g = fold_angle(at, corners[i], corners[j], corners[k], len(points))
        middle = sum(at[c] for c in g) / 4
        rows.append(sum(w * np.array([x * x / 2, y * y / 2, x * y / 2])
                        for c, w in g.items() for x, y in [at[c] - middle]))
    return np.linalg.inv(np.array(rows))


def of_terms(points, terms):
    matrix = Matrix()
    for angles, Q, _, _ in terms:
        for a, left in enumerate(angles):
            for b, right in enumerate(angles):
                matrix.add(left, right, Q[a, b])
    return matrix.csr(len(points)), {}


def plate(points, triangles, nu):
    """Morley's triangles: heights, and the slope across the middle of every edge."""
    matrix, C = Matrix(), rigidity(nu)
    slopes = {edge: len(points) + k for k, edge in enumerate(edges_of(triangles))}
    for corners in triangles:
        origin, unknowns, X = points[corners].mean(axis=0), list(corners), np.zeros((6, 6))
        for k in range(3):
            x, y = points[corners[k]] - origin
            X[k] = [1, x, y, x * x / 2, y * y / 2, x * y / 2]
        for k, (i, j) in enumerate(SIDES):
            edge = tuple(sorted((corners[i], corners[j])))
            (n_x, n_y), (x, y) = length_and_normal(points, *edge)[1], points[list(edge)].mean(axis=0) - origin
            X[3 + k] = [0, n_x, n_y, x * n_x, y * n_y, (n_x * y + n_y * x) / 2]
            unknowns.append(slopes[edge])
        curvature = np.linalg.inv(X)[3:]
        element = doubled_area(points[corners]) / 2 * curvature.T @ C @ curvature
        for a, left in enumerate(unknowns):
            for b, right in enumerate(unknowns):
                matrix.add({left: 1}, {right: 1}, element[a, b])
    return matrix.csr(len(points) + len(slopes)), slopes


TERMS = {
    "hinge": lambda points, triangles, nu: hinge_terms(points, triangles),
    "average": lambda points, triangles, nu: triangle_terms(points, triangles, nu, averaged),
    "fit": lambda points, triangles, nu: triangle_terms(points, triangles, nu, fitted),
}


def stiffness(name, points, triangles, nu):
    return plate(points, triangles, nu) if name == "plate" else of_terms(points, TERMS[name](points, triangles, nu))


# Tests.


def rolled(name, points, triangles, nu):
    if name == "plate":
        return 1.0, 1.0  # Plates.ConstantCurvatureIsExactOnAnyTriangles
    terms, ratios = list(TERMS[name](points, triangles, nu)), []
    for k in range(8):
        z = (points @ np.array([np.cos(np.pi * k / 8), np.sin(np.pi * k / 8)])) ** 2 / 2
        energy = area = 0
        for angles, Q, own_area, whole in terms:
            if whole:
                theta = np.array([sum(w * z[c] for c, w in g.items()) for g in angles])
                energy, area = energy + theta @ Q @ theta, area + own_area
        ratios.append(energy / area)
    return min(ratios), max(ratios)


def solved(K, z, held, load=None):
    free = np.flatnonzero(~held)
    right = -K[free][:, np.flatnonzero(held)] @ z[held] + (0 if load is None else load[free])
    z[free] = scipy.sparse.linalg.spsolve(K[free][:, free].tocsc(), right)
    return z


def twist(points, K, nu):
    ends = np.zeros(K.shape[0], bool)
    ends[:len(points)] = (points[:, 0] < 1e-9) | (points[:, 0] > LENGTH - 1e-9)
    z = np.zeros(K.shape[0])
    z[:len(points)] = np.where(ends[:len(points)], points[:, 0] * points[:, 1], 0)
    z = solved(K, z, ends)
    return z @ (K @ z) / (2 * (1 - nu) * LENGTH * WIDTH)


def clamp(points, size, slopes):
    """Held unknowns and where the clamp lies: a held line of particles bends for half a row on its far side, unless slopes are held."""
    held = np.zeros(size, bool)
    if not slopes:
        row = np.sqrt(np.sqrt(3) / 2 * LENGTH * WIDTH / len(points))  # of equilateral triangles
        held[:len(points)] = points[:, 0] < 1.4 * row
        return held, points[held[:len(points)], 0].max() - row / 2
    held[:len(points)] = points[:, 0] < 1e-9
    for (a, b), unknown in slopes.items():
        held[unknown] = points[a, 0] < 1e-9 and points[b, 0] < 1e-9
    return held, 0.0


def cantilever(name, points, triangles):
    K, slopes = stiffness(name, points, triangles, 0)
    load = np.zeros(K.shape[0])
    for t in triangles:
        load[t] += doubled_area(points[t]) / 6
    held, start = clamp(points, K.shape[0], slopes)
    z = solved(K, np.zeros(K.shape[0]), held, load)
    return z[:len(points)][points[:, 0] > LENGTH - 1e-9].mean() / ((LENGTH - start) ** 4 / 8)


def buckling(points, triangles, K, slopes):
    """P L^2 / D at which K + P K_stress is singular, with the stresses of a beam."""
    inertia, matrix = WIDTH**3 / 12, Matrix()
    for t in triangles:
        p, area = points[t], doubled_area(points[t]) / 2
        gradient = np.array([[p[1, 1] - p[2, 1], p[2, 1] - p[0, 1], p[0, 1] - p[1, 1]],
                             [p[2, 0] - p[1, 0], p[0, 0] - p[2, 0], p[1, 0] - p[0, 0]]]) / (2 * area)
        stress = np.zeros((2, 2))
        for a, b in SIDES:
            x, y = (p[a] + p[b]) / 2
            shear = (WIDTH**2 / 4 - y * y) / (2 * inertia)
            stress += np.array([[-(LENGTH - x) * y / inertia, shear], [shear, 0]]) / 3
        element = area * gradient.T @ stress @ gradient
        for a in range(3):
            for b in range(3):
                matrix.add({t[a]: 1}, {t[b]: 1}, element[a, b])
    held, start = clamp(points, K.shape[0], slopes)
    free = np.flatnonzero(~held)
    K_stress = matrix.csr(K.shape[0])
    largest = scipy.sparse.linalg.eigsh(K_stress[free][:, free].tocsc(), k=1, M=K[free][:, free].tocsc(), which="LA",
                                        return_eigenvectors=False)[0]
    return (LENGTH - start) ** 2 / largest


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--nu", type=float, default=0.3)
    parser.add_argument("--cells", type=int, nargs="+", default=[4, 8])
    options = parser.parse_args()
    points, triangles = mesh("one diagonal", 32)
    limit = buckling(points, triangles, *plate(points, triangles, options.nu))
    print("| mesh, cells across | element | rolled | twist | cantilever | buckling | entries | unknowns |")
    print("|---|---|---|---|---|---|---|---|")
    for kind in ("equilateral", "mesher", "one diagonal", "union jack", "criss-cross"):
        for cells in options.cells:
            points, triangles = mesh(kind, cells)
            for name in (*TERMS, "plate"):
                K, slopes = stiffness(name, points, triangles, options.nu)
                low, high = rolled(name, points, triangles, options.nu)
                print(f"| {kind}, {cells} | {name} | {low:.2f} to {high:.2f} | {twist(points, K, options.nu):.2f} "
                      f"| {cantilever(name, points, triangles):.3f} | {buckling(points, triangles, K, slopes) / limit:.2f} "
                      f"| {K.nnz / len(points):.0f} | {K.shape[0] / len(points):.1f} |", flush=True)


if __name__ == "__main__":
    main()
