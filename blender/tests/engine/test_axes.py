"""Blender's world and Toile's."""

import numpy as np

from toile_blender.engine import axes


def test_up_and_front_are_where_the_other_has_them():
    assert axes.to_toile(np.array([0, 0, 2.0])).tolist() == [0, 2, 0]  # up
    assert axes.to_toile(np.array([0, -1.0, 0])).tolist() == [0, 0, 1]  # who looks along -Y in Blender looks along +z here
    assert axes.to_toile(np.array([3.0, 0, 0])).tolist() == [3, 0, 0]


def test_there_and_back_loses_nothing():
    points = np.random.default_rng(1).normal(size=(1000, 3)).astype(np.float32)
    there = axes.to_toile(points).astype(np.float32)
    assert np.array_equal(axes.to_blender(there).astype(np.float32), points)


def test_handedness_is_kept():
    x, y = axes.to_toile(np.array([1.0, 0, 0])), axes.to_toile(np.array([0, 1.0, 0]))
    assert np.array_equal(np.cross(x, y), axes.to_toile(np.array([0, 0, 1.0])))


def test_a_unit_of_a_centimetre():
    assert np.allclose(axes.to_toile(np.array([0, 0, 180.0]), 0.01), [0, 1.8, 0])
    assert np.allclose(axes.to_blender(np.array([0, 1.8, 0]), 0.01), [0, 0, 180])


def test_mirrored_objects_are_told():
    assert axes.turns_inside_out(np.diag([-1.0, 1, 1, 1]))
    assert not axes.turns_inside_out(np.diag([-1.0, -1, 1, 1]))
    matrix = np.array([[0, -2.0, 0, 5], [2, 0, 0, 0], [0, 0, 2, 1], [0, 0, 0, 1]])
    assert axes.moved(np.array([[1.0, 0, 0]]), matrix).tolist() == [[5, 2, 1]]
