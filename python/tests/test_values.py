"""Fabrics, cloth and bodies: how they are made, what is refused in which words, and that they pickle."""

import copy
import os
import pickle

import numpy as np
import pytest
from conftest import box_arrays, root, sheet_arrays

import toile


def test_fabric_fields_are_keywords_with_the_defaults_of_the_library():
    assert toile.Fabric() == toile.fabric("cotton")
    heavy = toile.Fabric(name="felt", density_kg_per_m2=0.4)
    assert (heavy.name, heavy.density_kg_per_m2, heavy.friction) == ("felt", 0.4, toile.Fabric().friction)
    assert heavy.replace(friction=0.5).friction == 0.5 and heavy.friction != 0.5
    assert toile.fabric("silk", strain_limit=0.05).strain_limit == 0.05
    with pytest.raises(TypeError, match="no field `density`.*density_kg_per_m2"):
        toile.Fabric(density=0.4)
    with pytest.raises(TypeError, match="friction: expected a number"):
        toile.Fabric(friction="much")
    with pytest.raises(AttributeError):
        heavy.friction = 1


def test_fabrics_go_by_name_wherever_one_is_taken():
    assert set(toile.fabric_names()) >= {"silk", "cotton", "wool", "denim", "knit"}
    with pytest.raises(toile.InputError, match="cotton"):
        toile.fabric("coton")
    cloth = toile.Cloth.grid(width_m=0.2, height_m=0.2, edge_m=0.1)
    for call in (cloth.set_fabric, lambda f: toile.Simulation(cloth, f)):
        call("denim")
        call(toile.fabric("denim"))
        with pytest.raises(toile.InputError, match="denim"):
            call("demin")
        with pytest.raises(TypeError, match="toile.Fabric or the name"):
            call(3)


def test_the_fabric_of_a_simulation_is_what_its_cloth_is_made_of():
    # Heavier cloth stretches more under its own weight: the lowest point of a sheet that hangs from its upper edge.
    def lowest(fabric):
        sim = toile.Simulation(toile.Cloth.grid(width_m=0.2, height_m=0.4, edge_m=0.05), fabric)
        sim.pin(np.flatnonzero(sim.positions_m[:, 1] > 0.19))
        for _ in sim.frames(1, fps=30):
            pass
        return sim.positions_m[:, 1].min()

    soft = toile.Fabric(stretch_u_N_per_m=20, stretch_v_N_per_m=20, density_kg_per_m2=0.5)
    assert lowest(soft) < lowest("denim") - 0.005


@pytest.mark.parametrize("made", [
    lambda: toile.fabric("silk", friction=0.2),
    lambda: toile.State(b"bytes \0 of any kind"),
])
def test_values_pickle_and_are_equal(made):
    value = made()
    again = pickle.loads(pickle.dumps(value))
    assert again == value and hash(again) == hash(value) and again is not value


def positions(cloth):
    return toile.Simulation(cloth, threads=1).positions_m


def test_cloth_pickles_as_it_was_made_and_copies_are_independent():
    vertices, faces = sheet_arrays()
    cloth = toile.Cloth(vertices, faces, name="napkin").set_fabric("wool").place((0, 1, 0), rotation_deg=(0, 30, 0))
    vertices += 100  # cloth has its own copy
    again = pickle.loads(pickle.dumps(cloth))
    assert np.array_equal(positions(again), positions(cloth)) and positions(cloth).max() < 2
    other = copy.copy(cloth)
    other.place((0, 5, 0))
    assert positions(other)[:, 1].min() > 4 > positions(cloth)[:, 1].max()


def test_a_pattern_is_read_from_where_it_was_when_the_working_directory_was_another(tmp_path, monkeypatch):
    monkeypatch.chdir(root)
    cloth = toile.Cloth.from_pattern("patterns/skirt.json", edge_m=0.05)
    monkeypatch.chdir(tmp_path)
    again = pickle.loads(pickle.dumps(cloth))
    assert len(positions(again)) == len(positions(cloth)) > 50


def test_uv_may_be_of_vertices_or_of_the_corners_of_faces():
    vertices, faces = sheet_arrays()
    of_vertices = vertices[:, [0, 2]] * [1, -1]
    of_corners = of_vertices[faces]
    a = toile.Simulation(toile.Cloth(vertices, faces, uv_m=of_vertices))
    b = toile.Simulation(toile.Cloth(vertices, faces, uv_m=of_corners))
    assert np.array_equal(a.uv_m, of_corners) and np.array_equal(a.uv_m, b.uv_m)
    # Cut smaller than it is: it pulls itself together.
    tight = toile.Simulation(toile.Cloth(vertices, faces, uv_m=0.9 * of_vertices), gravity_m_per_s2=(0, 0, 0))
    for sim in (a, tight):
        sim.set_gravity((0, 0, 0))
        for _ in range(10):
            assert sim.advance(1 / 30).ok
    assert np.ptp(tight.positions_m[:, 0]) < 0.95 * np.ptp(a.positions_m[:, 0])


def test_panels_have_numbers_and_names():
    vertices, faces = sheet_arrays()
    panel = (np.arange(len(faces)) % 2).astype(np.int64)  # of any integer type
    sim = toile.Simulation(toile.Cloth(vertices, faces, panel=panel))
    assert sim.panel_names == ["panel_0", "panel_1"] and np.array_equal(sim.panel, panel)
    named = toile.Cloth(vertices, faces, panel=panel, panel_names=["front", "back"]).set_panel_fabric("back", "knit")
    assert toile.Simulation(named).panel_names == ["front", "back"]
    with pytest.raises(toile.InputError, match="bakc"):
        toile.Simulation(named.set_panel_fabric("bakc", "knit"))
    with pytest.raises(TypeError, match="panel_names"):
        toile.Cloth(vertices, faces, panel_names="front")


def test_what_is_no_cloth_is_refused_with_its_place():
    vertices, faces = sheet_arrays()
    with pytest.raises(toile.InputError, match="faces.*999"):
        toile.Cloth(vertices, np.where(faces == 3, 999, faces))
    with pytest.raises(toile.InputError, match="faces.*999"):  # also where uv would have to be looked up by them
        toile.Cloth(vertices, np.where(faces == 3, 999, faces), uv_m=vertices[:, :2])
    holed = vertices.copy()
    holed[5, 1] = np.nan
    with pytest.raises(toile.InputError):
        toile.Cloth(holed, faces)


def test_seam_allowances_have_widths_and_may_be_stitched_down():
    assert "skirt" in repr(toile.Cloth.from_pattern("patterns/skirt.json", allowance_m=0.01, topstitched=True))
    for options, what in (({"allowance_m": -0.01}, "allowance_m"), ({"topstitched": True}, "topstitched.*allowance_m")):
        with pytest.raises(toile.InputError, match=what):
            toile.Cloth.from_pattern("patterns/skirt.json", **options)


def test_hems_and_tapes_have_widths():
    assert "skirt" in repr(toile.Cloth.from_pattern("patterns/skirt.json", hem_m=0.02, tape_m=0))
    for widths in ({"hem_m": -0.01}, {"tape_m": float("nan")}):
        with pytest.raises(toile.InputError, match=next(iter(widths))):
            toile.Cloth.from_pattern("patterns/skirt.json", **widths)


def test_files_that_are_not_there_are_io_errors():
    for call in (lambda: toile.Simulation(toile.Cloth.from_pattern("/nowhere/pattern.json")), lambda: toile.State.load("/nowhere/state"),
                 lambda: toile.Simulation.from_scene("/nowhere/scene.json")):
        with pytest.raises(toile.IoError, match="/nowhere") as caught:
            call()
        assert isinstance(caught.value, (toile.Error, RuntimeError)) and isinstance(caught.value, OSError)
        assert caught.value.code == "input_output"


def test_errors_are_also_those_of_python():
    with pytest.raises(ValueError) as caught:
        toile.fabric("coton")
    assert isinstance(caught.value, RuntimeError) and caught.value.code == "bad_input"
    again = pickle.loads(pickle.dumps(caught.value))  # they come back from other processes
    assert type(again) is toile.InputError and str(again) == str(caught.value) and again.code == "bad_input"


def test_names_of_bodies_are_checked():
    with pytest.raises(toile.InputError, match="woman"):
        toile.Body.mannequin("womna")
    with pytest.raises(toile.InputError, match="automatic, m, dm, cm"):
        toile.Body.from_file("body.obj", unit="inch")
    with pytest.raises(TypeError, match="Body.mannequin"):
        toile.Body()
    assert "walk" in toile.Body.motion_names()


def test_bodies_from_arrays_pickle_and_have_to_be_closed(sheet):
    vertices, faces = box_arrays()
    body = pickle.loads(pickle.dumps(toile.Body.from_arrays(vertices, faces).set_friction(0.3).set_offset(0.004)))
    sim = toile.Simulation(toile.Cloth(*sheet_arrays()), body=body)
    assert np.array_equal(sim.body_positions_m, vertices) and np.array_equal(sim.body_faces, faces)
    assert sheet.body_positions_m.shape == (0, 3) and sheet.body_faces.shape == (0, 3)
    with pytest.raises(toile.InputError):
        toile.Simulation(toile.Cloth(*sheet_arrays()), body=toile.Body.from_arrays(vertices, faces[:-1]))


def test_a_body_in_motion_is_where_its_frames_are():
    vertices, faces = box_arrays()
    frames = vertices + np.linspace(0, -0.1, 11)[:, None, None] * [0, 1, 0]
    sim = toile.Simulation(toile.Cloth(*sheet_arrays()), body=toile.Body.from_frames(frames, faces, fps=20))
    assert np.array_equal(sim.body_positions_m, frames[0])
    for k in range(1, 4):
        assert sim.advance(1 / 20).ok
        assert np.allclose(sim.body_positions_m, frames[k], atol=1e-3)


def test_a_mannequin_stands():
    sim = toile.Simulation(toile.Cloth.grid(width_m=0.2, height_m=0.2, edge_m=0.1).place((0, 3, 0)), body=toile.Body.mannequin("woman"))
    assert 1.5 < np.ptp(sim.body_positions_m[:, 1]) < 2


def test_paths_may_be_path_objects(tmp_path):
    state = tmp_path / "state"
    toile.State(b"abc").save(os.fspath(state))
    assert toile.State.load(os.fspath(state)) == toile.State(b"abc")
