"""Particles of a mesh, and how it rests."""

import numpy as np
import pytest
from conftest import sheet

from toile_blender.engine import garment_mesh
from toile_blender.engine.errors import ToileError


def split(positions, triangles, column):
    """Cut along a line of the sheet, as importers do along a seam of the UV map: its vertices twice."""
    count = len(positions)
    on_seam = np.flatnonzero(np.isclose(positions[:, 0], column))
    right = positions[triangles][:, :, 0].mean(axis=1) > column
    twin = {int(v): count + k for k, v in enumerate(on_seam)}
    cut = triangles.copy()
    cut[right] = [[twin.get(int(v), int(v)) for v in triangle] for triangle in triangles[right]]
    return np.concatenate([positions, positions[on_seam]]), cut


def test_split_vertices_are_one_particle_and_the_order_stays():
    positions, triangles = sheet()
    cut_positions, cut = split(positions, triangles, 0.0)
    assert len(cut_positions) == 30
    particle, count = garment_mesh.particles_of(cut_positions, cut)
    assert count == 25
    assert particle[:25].tolist() == list(range(25))
    assert np.array_equal(cut_positions[:25][particle[25:]], cut_positions[25:])


def test_two_layers_on_each_other_stay_two():
    positions, triangles = sheet()
    both = np.concatenate([positions, positions])
    particle, count = garment_mesh.particles_of(both, np.concatenate([triangles, triangles + 25]))  # hems run in one direction
    assert count == 50


def test_three_edges_in_one_place_are_left_alone():
    positions = np.array([[0.0, 0, 0], [0, 1, 0], [1, 0, 0], [0.0, 0, 0], [0, 1, 0], [-1, 0, 0], [0.0, 0, 0], [0, 1, 0], [0, 0, 1]])
    _, count = garment_mesh.particles_of(positions, np.array([[0, 2, 1], [3, 4, 5], [6, 7, 8]]))
    assert count == 9
    _, count = garment_mesh.particles_of(positions[:6], np.array([[0, 2, 1], [3, 4, 5]]))
    assert count == 4
    _, count = garment_mesh.particles_of(positions[:6], np.array([[0, 2, 1], [3, 5, 4]]))
    assert count == 6  # both run from the upper end to the lower


def test_loose_vertices_are_no_particles():
    positions, triangles = sheet()
    particle, count = garment_mesh.particles_of(np.concatenate([[[9.0, 9, 9]], positions]), triangles + 1)
    assert count == 25 and particle[0] == -1 and particle[1] == 0


def lengths(triangles):
    return np.linalg.norm(triangles - np.roll(triangles, 1, axis=1), axis=-1)


def test_the_drawing_has_the_lengths_of_the_rest_shape():
    positions, triangles = sheet()
    positions = positions + np.random.default_rng(3).normal(scale=0.01, size=positions.shape)
    drawn = garment_mesh.rest_drawing(positions, triangles)
    assert np.allclose(lengths(drawn), lengths(positions[triangles]), atol=1e-12)
    p, q = drawn[:, 1] - drawn[:, 0], drawn[:, 2] - drawn[:, 0]
    assert np.all(p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0] > 0)  # right side up


def test_the_warp_runs_upwards_and_where_the_uv_map_says():
    upright = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]])
    triangle = np.array([[0, 1, 2]])
    assert np.allclose(garment_mesh.rest_drawing(upright, triangle)[0], [[0, 0], [1, 0], [0, 1]])
    turned = np.array([[[0.0, 0], [0, 1], [-1, 0]]])  # v runs along the first edge
    assert np.allclose(garment_mesh.rest_drawing(upright, triangle, turned)[0], [[0, 0], [0, 1], [-1, 0]])
    mirrored = np.array([[[0.0, 0], [0, 1], [1, 0]]])
    assert np.allclose(garment_mesh.rest_drawing(upright, triangle, mirrored)[0], [[0, 0], [0, 1], [-1, 0]])
    stretched = 7 * turned  # a texture's size does not matter
    assert np.allclose(garment_mesh.rest_drawing(upright, triangle, stretched)[0], [[0, 0], [0, 1], [-1, 0]])


def test_a_level_sheet_has_one_warp_in_all_faces():
    positions, triangles = sheet()
    drawn = garment_mesh.rest_drawing(positions, triangles)
    along_x = positions[triangles][:, :, 0] - positions[triangles][:, :1, 0]
    assert np.allclose(np.abs(drawn[:, :, 0]), np.abs(along_x))


def test_a_face_without_area_is_named():
    with pytest.raises(ToileError, match="triangle 1"):
        garment_mesh.rest_drawing(np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [2, 0, 0]]), np.array([[0, 1, 2], [0, 1, 3]]))


def test_the_area_tells_a_map_in_metres():
    positions, triangles = sheet()
    metric = np.stack([positions[triangles][:, :, 2], positions[triangles][:, :, 0]], axis=-1)
    assert garment_mesh.area_ratio(positions, triangles, metric) == pytest.approx(1)
    assert garment_mesh.area_ratio(positions, triangles, 3 * metric) == pytest.approx(9)
