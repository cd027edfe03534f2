"""What goes in has a shape with a name; what comes out is the simulation's own, is not copied twice, and cannot dangle."""

import gc
import sys

import numpy as np
import pytest
from conftest import level_sheet, sheet_arrays

import toile

vertices, faces = sheet_arrays()
n, f = len(vertices), len(faces)


@pytest.mark.parametrize("call, words", [
    (lambda: toile.Cloth(vertices[:, :2], faces), rf"vertices_m: expected numbers of shape \(vertices, 3\), got \({n}, 2\)"),
    (lambda: toile.Cloth(vertices.ravel(), faces), rf"vertices_m: .*\(vertices, 3\), got \({3 * n},\)"),
    (lambda: toile.Cloth(vertices, faces[:, :2]), rf"faces: expected integers of shape \(faces, 3\), got \({f}, 2\)"),
    (lambda: toile.Cloth(vertices, faces, uv_m=np.zeros((n + 1, 2))), rf"uv_m: .*\({f}, 3, 2\) or \({n}, 2\), got \({n + 1}, 2\)"),
    (lambda: toile.Cloth(vertices, faces, panel=[0]), rf"panel: .*\({f},\), got \(1,\)"),
    (lambda: toile.Cloth([[0, 0, 0], [1, 0]], faces), "vertices_m: .*rows of different lengths"),
    (lambda: toile.Cloth(vertices, faces.astype(np.int64) + 2**40), "faces: .*32 bits"),
    (lambda: toile.Body.from_frames(vertices, faces, fps=30), r"frames_m: .*\(frames, vertices, 3\)"),
    (lambda: toile.Body.cylinder(top_m=(0, 1)), r"top_m: .*\(3,\), got \(2,\)"),
    (lambda: level_sheet().pin([[0, 1]]), r"particles: .*\(particles,\), got \(1, 2\)"),
    (lambda: level_sheet().pin([0], np.zeros((5, 2, 3)), fps=30), r"path_m: .*\(samples, 1, 3\), got \(5, 2, 3\)"),
    (lambda: level_sheet().move_pins([0], [0, 0, 0]), r"to_m: .*\(1, 3\), got \(3,\)"),
    (lambda: level_sheet().set_gravity(9.81), r"m_per_s2: .*\(3,\), got \(\)"),
    (lambda: level_sheet(wind_m_per_s=(1, 2)), r"wind_m_per_s: .*\(3,\)"),
    (lambda: level_sheet(body=toile.Body.cylinder()).set_body(vertices), r"vertices_m: .*, 3\), got"),
])
def test_a_wrong_shape_is_named_with_what_was_expected(call, words):
    with pytest.raises(ValueError, match=words) as caught:
        call()
    assert isinstance(caught.value, toile.InputError)


@pytest.mark.parametrize("call, words", [
    (lambda: toile.Cloth(vertices.astype(str), faces), "vertices_m: expected numbers"),
    (lambda: toile.Cloth(vertices, faces.astype(float)), "faces: expected integers .* got float64"),
    (lambda: level_sheet().pin([0.5]), "particles: expected integers"),
    (lambda: level_sheet().pin([0], np.zeros((1, 1, 3))), "path_m and fps"),
    (lambda: toile.Simulation("shirt"), "toile.Cloth or a list"),
    (lambda: toile.Simulation(toile.Cloth(vertices, faces), body="woman"), "toile.Body or None"),
    (lambda: level_sheet().grab(), "a face, or a particle"),
    (lambda: level_sheet().dress(progress=3), "progress"),
])
def test_a_wrong_type_is_a_type_error(call, words):
    with pytest.raises(TypeError, match=words):
        call()


def test_arrays_of_any_layout_and_number_type_are_taken():
    wanted = level_sheet().positions_m
    for given in (np.asfortranarray(vertices), np.repeat(vertices, 2, axis=0)[::2], vertices.tolist()):
        assert np.array_equal(toile.Simulation(toile.Cloth(given, faces.astype(np.uint16))).positions_m, wanted)


def test_what_comes_out_has_the_documented_shapes(sheet):
    assert sheet.positions_m.shape == sheet.velocities_m_per_s.shape == (n, 3)
    assert sheet.faces.shape == (f, 3) and sheet.uv_m.shape == (f, 3, 2) and sheet.panel.shape == (f,)
    assert sheet.positions_m.dtype == sheet.uv_m.dtype == np.float64 and sheet.faces.dtype == sheet.panel.dtype == np.int32
    assert np.array_equal(sheet.faces, faces)


def test_reading_twice_is_no_copy_and_nobody_can_write(sheet):
    x = sheet.positions_m
    assert sheet.positions_m.ctypes.data == x.ctypes.data
    assert sheet.frame().positions_m.ctypes.data == x.ctypes.data
    assert sheet.faces.ctypes.data == sheet.faces.ctypes.data
    for array in (x, sheet.velocities_m_per_s, sheet.faces, sheet.uv_m, sheet.panel):
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 0
        with pytest.raises(ValueError):
            array.flags.writeable = True


def test_an_array_is_of_the_moment_when_it_was_read(sheet):
    before = sheet.positions_m
    kept = before.copy()
    assert sheet.advance(1 / 30).ok
    after = sheet.positions_m
    assert np.array_equal(before, kept) and not np.array_equal(after, kept)
    assert sheet.faces is sheet.faces  # the mesh did not change
    sheet.reset()
    assert np.array_equal(sheet.positions_m, kept) and not np.array_equal(after, kept)


def test_arrays_outlive_their_simulation():
    sim = level_sheet()
    arrays = [sim.positions_m, sim.faces, sim.uv_m]
    kept = [a.copy() for a in arrays]
    del sim
    gc.collect()
    churn = [level_sheet() for _ in range(5)]  # takes the memory that was freed
    assert all(np.array_equal(a, b) for a, b in zip(arrays, kept)) and churn


def test_frames_own_their_arrays(sheet):
    frames = list(sheet.frames(seconds=0.2, fps=30))
    assert [round(30 * frame.t_s) for frame in frames] == [1, 2, 3, 4, 5, 6]
    heights = [frame.positions_m[:, 1].mean() for frame in frames]
    assert all(b < a for a, b in zip(heights, heights[1:]))  # it falls, in each of them
    assert np.array_equal(frames[-1].positions_m, sheet.positions_m)
    assert all(frame.step.ok and frame.velocities_m_per_s.shape == (n, 3) for frame in frames)


def test_no_array_is_leaked(sheet):
    x = sheet.positions_m
    assert sheet.advance(1 / 30).ok
    assert sys.getrefcount(x) == 2  # this variable and the call: the simulation has let go of it
