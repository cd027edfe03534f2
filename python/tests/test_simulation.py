"""Time, hands, states: what the methods say they do."""

import pickle
import subprocess
import sys

import numpy as np
import pytest
from conftest import box_arrays, level_sheet, root, sheet_arrays

import toile


def advance(sim, frames=3):
    for _ in range(frames):
        step = sim.advance(1 / 30)
        assert step.ok, step.explain()


def test_time_goes_on_by_exactly_what_was_asked(sheet):
    sheet.pin([0])
    assert sheet.time_s == 0
    step = sheet.advance(0.05)
    assert step.ok and bool(step) and step.steps >= 1 and step.cg_iterations > 0
    assert 0 < step.step_min_s <= step.step_max_s <= 0.05 and "steps" in step.explain()
    assert sheet.time_s == 0.05
    for wrong in (0, -1, float("nan"), 1e9):
        with pytest.raises(toile.InputError, match="h_s"):
            sheet.advance(wrong)
    assert sheet.time_s == 0.05


def test_gravity_is_what_it_was_said_to_be():
    still = level_sheet(gravity_m_per_s2=(0, 0, 0))
    advance(still)
    assert np.abs(still.velocities_m_per_s).max() < 1e-6
    still.set_gravity((1, 0, 0))
    advance(still, 6)
    assert still.velocities_m_per_s[:, 0].min() > 0.1


def test_wind_blows_where_there_is_air():
    speeds = []
    for density in (0, 1.2):
        sim = level_sheet(gravity_m_per_s2=(0, 0, 0), air_density_kg_per_m3=density)
        sim.set_wind((0, 3, 0))
        advance(sim, 6)
        speeds.append(sim.velocities_m_per_s[:, 1].mean())
    assert abs(speeds[0]) < 1e-6 and speeds[1] > 0.1


def test_pins_hold_until_they_are_released(sheet):
    corners = [0, 8, 72, 80]
    sheet.pin(corners)
    start = sheet.positions_m
    advance(sheet)
    assert sheet.pinned == corners and np.array_equal(sheet.positions_m[corners], start[corners])
    assert sheet.positions_m[40, 1] < start[40, 1] - 1e-3
    sheet.release(corners[1:])
    advance(sheet, 6)
    assert sheet.pinned == [0] and np.array_equal(sheet.positions_m[0], start[0]) and sheet.positions_m[80, 1] < -0.01
    with pytest.raises(toile.InputError, match="81"):
        sheet.pin([81])


def test_moved_pins_arrive_and_stay(sheet):
    sheet.pin(0)
    there = sheet.positions_m[[0]] + [0, 0.02, 0]
    sheet.move_pins([0], there)
    advance(sheet, 1)
    assert np.allclose(sheet.positions_m[[0]], there, atol=1e-9)
    advance(sheet, 2)
    assert np.allclose(sheet.positions_m[[0]], there, atol=1e-9)
    with pytest.raises(toile.InputError, match="pinned"):
        sheet.move_pins([1], there)


def zigzag(start, samples=7, step_m=0.01):
    """Up and down, so that a sample that is cut off is seen."""
    return start + (np.arange(samples) % 2)[:, None, None] * [0, step_m, 0]


def test_pins_follow_a_path_through_every_sample(sheet):
    ids = [0, 8]
    path = zigzag(sheet.positions_m[ids])
    advance(sheet, 2)
    path = path - path[0] + sheet.positions_m[ids]
    sheet.pin(ids, path_m=path, fps=30)
    for k in range(1, len(path)):
        advance(sheet, 1)
        assert np.allclose(sheet.positions_m[ids], path[k], atol=1e-9), k
    advance(sheet, 2)  # beyond its end
    assert np.allclose(sheet.positions_m[ids], path[-1], atol=1e-9)


def test_a_longer_advance_passes_the_samples_within_it():
    by_sample, at_once = level_sheet(), level_sheet()
    for sim in (by_sample, at_once):
        sim.pin([0], path_m=zigzag(sim.positions_m[[0]]), fps=30)
    advance(by_sample, 2)
    step = at_once.advance(2 / 30)
    assert step.ok and step.steps >= 2
    # The corner went up by a centimetre and came down again; cut off it had stood still, and the cloth beside it would not know.
    assert np.allclose(at_once.positions_m, by_sample.positions_m, atol=1e-9)
    still = level_sheet()
    still.pin([0])
    still.advance(2 / 30)
    assert np.abs(still.positions_m - at_once.positions_m).max() > 1e-4


def test_release_and_move_pins_end_a_path(sheet):
    ids = [0, 8]
    sheet.pin(ids, path_m=zigzag(sheet.positions_m[ids]), fps=30)
    start = sheet.positions_m
    sheet.release([8])
    sheet.move_pins([0], start[[0]])
    advance(sheet, 1)
    assert np.array_equal(sheet.positions_m[0], start[0]) and sheet.positions_m[8, 1] < start[8, 1]


def test_a_hand_pulls_and_lets_go():
    sim = level_sheet(gravity_m_per_s2=(0, 0, 0))
    for grip in ({"particle": 80}, {"face": 0, "barycentric": (0.2, 0.3, 0.5), "max_force_N": 1}):
        sim.reset()
        hand = sim.grab(**grip)
        at = sim.positions_m[80] if "particle" in grip else np.array([0.2, 0.3, 0.5]) @ sim.positions_m[sim.faces[0]]
        sim.drag(hand, at + [0, 0.2, 0])
        advance(sim, 10)
        pulled = sim.positions_m[:, 1].max()
        assert pulled > 0.02
        sim.let_go(hand)
        with pytest.raises(toile.InputError, match="hand"):
            sim.drag(hand, (0, 0, 0))
    with pytest.raises(toile.InputError, match="face"):
        sim.grab(10**6)
    with pytest.raises(toile.InputError, match="particle"):
        sim.grab(particle=81)


def test_a_body_goes_where_it_is_set():
    vertices, faces = box_arrays(high=(0.1, -0.005, 0.1))
    sim = toile.Simulation(toile.Cloth(*sheet_arrays()), body=toile.Body.from_arrays(vertices, faces))
    for k in range(1, 6):
        sim.set_body(vertices + [0, 0.02 * k, 0])
        advance(sim, 1)
    assert np.allclose(sim.body_positions_m, vertices + [0, 0.1, 0])
    assert sim.positions_m[40, 1] > 0.09  # it was lifted
    found = sim.crossings()
    assert (found.cloth_body_edges, found.cloth_cloth_edges) == (0, 0)


def test_dress_lets_cloth_come_to_rest_and_tells_of_it(draped):
    told = []
    report = draped.dress(longest_s=20, progress=lambda *what: told.append(what))
    assert report.ok == (not report.reasons) == bool(report), report.explain()
    assert report.ended in ("still", "time") and report.simulated_s == pytest.approx(draped.time_s)
    assert told and all(isinstance(p, str) and 0 <= s <= 1 and (left is None or left >= 0) for p, s, left in told)
    assert np.abs(draped.velocities_m_per_s).max() < 0.05
    assert draped.crossings().cloth_body_edges == 0


def test_an_exception_of_the_progress_ends_the_call_and_comes_back(draped):
    def progress(*_):
        raise KeyError("enough")

    with pytest.raises(KeyError, match="enough"):
        draped.dress(progress=progress)
    advance(draped, 1)  # it goes on


@pytest.mark.parametrize("tqdm", [True, False])
def test_progress_true_writes_a_bar(draped, capsys, monkeypatch, tqdm):
    if tqdm:
        pytest.importorskip("tqdm")
    else:
        monkeypatch.setitem(sys.modules, "tqdm", None)
        monkeypatch.setitem(sys.modules, "tqdm.auto", None)
    draped.dress(longest_s=1, progress=True)
    assert "%" in capsys.readouterr().err


def test_reset_takes_everything_back(draped):
    start = draped.state_hash
    draped.pin([0], path_m=zigzag(draped.positions_m[[0]]), fps=30)
    advance(draped)
    assert draped.state_hash != start
    draped.reset()
    assert draped.state_hash == start and draped.time_s == 0 and draped.pinned == []
    advance(draped)


def test_a_state_goes_on_with_the_same_bits_with_pins_hands_gravity_and_wind():
    def made():
        return level_sheet(threads=1)

    sim = made()
    advance(sim)
    sim.pin([0])
    sim.drag(sim.grab(particle=80), (0.2, 0.1, 0.2))
    sim.set_gravity((0, -5, 0))
    sim.set_wind((1, 0, 0))
    advance(sim)
    state = sim.state()
    advance(sim, 5)
    wanted = sim.state_hash
    sim.set_state(state)
    advance(sim, 5)
    assert sim.state_hash == wanted
    other = made()
    other.set_state(pickle.loads(pickle.dumps(state)))
    advance(other, 5)
    assert other.state_hash == wanted and other.pinned == [0]


def test_states_of_others_and_broken_ones_are_refused(sheet, draped):
    before = sheet.state_hash
    broken = bytearray(sheet.state().to_bytes())
    broken[len(broken) // 2] ^= 1
    for state in (draped.state(), toile.State(b""), toile.State(bytes(broken))):
        with pytest.raises(toile.InputError):
            sheet.set_state(state)
    assert sheet.state_hash == before


def test_a_path_goes_on_after_set_state_and_not_where_it_had_not_begun(sheet):
    before = sheet.state()
    sheet.pin([0])
    held = sheet.state()
    path = zigzag(sheet.positions_m[[0]])
    advance(sheet, 1)
    sheet.pin([0], path_m=path, fps=30)
    advance(sheet, 1)
    state = sheet.state()
    advance(sheet, 2)
    wanted = sheet.state_hash
    sheet.set_state(state)
    advance(sheet, 2)
    assert sheet.state_hash == wanted
    sheet.set_state(held)
    advance(sheet, 2)
    assert sheet.pinned == [0] and np.array_equal(sheet.positions_m[[0]], path[0])
    sheet.set_state(held)
    sheet.pin([0], path_m=path, fps=30)
    sheet.set_state(before)
    advance(sheet, 2)
    assert sheet.pinned == [] and sheet.positions_m[0, 1] < -0.01


def test_a_state_is_kept_in_a_file(sheet, tmp_path):
    advance(sheet)
    wanted = sheet.state_hash
    sheet.state().save(str(tmp_path / "state"))
    advance(sheet)
    sheet.set_state(toile.State.load(str(tmp_path / "state")))
    assert sheet.state_hash == wanted


def test_a_simulation_pickles_into_another_process(draped):
    draped.pin([0], path_m=zigzag(draped.positions_m[[0]], samples=20), fps=30)
    advance(draped)
    pickled = pickle.dumps(draped)
    advance(draped)
    code = (
        "import pickle, sys\n"
        "sim = pickle.load(sys.stdin.buffer)\n"
        "for _ in range(3): assert sim.advance(1 / 30).ok\n"
        "print(sim.state_hash, sim.time_s)"
    )
    done = subprocess.run([sys.executable, "-c", code], input=pickled, capture_output=True)
    assert done.returncode == 0, done.stderr.decode()
    assert done.stdout.decode().split() == [draped.state_hash, str(draped.time_s)]


def test_cloth_to_be_sewn_is_flat_until_it_is_dressed_and_pickles_so():
    cloth = toile.Cloth.from_pattern(root / "patterns/skirt.json", edge_m=0.06)
    sim = toile.Simulation(cloth, "wool", toile.Body.mannequin("woman"))
    panels = len(sim.positions_m)
    with pytest.raises(toile.Error, match="dress") as caught:
        sim.advance(1 / 30)
    assert caught.value.code == "usage"
    again = pickle.loads(pickle.dumps(sim))
    assert len(again.positions_m) == panels and len(sim.panel_names) >= 2


def test_several_cloths_are_worn_together():
    lower = toile.Cloth(*sheet_arrays(), name="lower")
    upper = toile.Cloth(*sheet_arrays(), name="upper").place((0, 0.02, 0))
    both = toile.Simulation([lower, upper], "silk")
    assert len(both.positions_m) == 2 * len(sheet_arrays()[0]) and len(both.panel_names) == 2
    with pytest.raises(toile.InputError):
        toile.Simulation([])


class RefusesFrom:
    """A core whose steps fail from a time on."""

    def __init__(self, core, time_s):
        self._core, self._time_s = core, time_s

    def __getattr__(self, name):
        return getattr(self._core, name)

    def advance(self, h_s):
        return self._core.advance(h_s) if self._core.time_s + h_s < self._time_s else self

    ok = False

    def explain(self):
        return "too fast"


def test_frames_end_with_a_warning_where_a_step_cannot_be_made(sheet):
    sheet._core = RefusesFrom(sheet._core, 0.09)
    with pytest.warns(RuntimeWarning, match="frames end at 0.067 s: too fast"):
        frames = list(sheet.frames(1, fps=30))
    assert [frame.step.ok for frame in frames] == [True, True, False]


def test_a_modelled_garment_hangs_as_it_lies(tmp_path):
    file = tmp_path / "flag.obj"
    file.write_text("v 0 0 0\nv 20 0 0\nv 0 20 0\nv 20 20 0\nv 20 0 0\nv 40 0 0\nv 20 20 0\nv 40 20 0\n"
                    "g left\nf 1 2 4\nf 1 4 3\ng right\nf 5 6 8\nf 5 8 7\n")
    sim = toile.Simulation(toile.Cloth.from_file(file, unit="cm"))
    assert sim.positions_m.shape == (6, 3) and sim.panel_names == ["left", "right"]
    assert "2 vertices lie where another one does" in sim.warnings[0] and "vt" in sim.warnings[1]
    sim.pin([2])
    advance(sim, 10)
    assert sim.positions_m[2, 1] == 0.2 and sim.positions_m[5, 1] < 0.15
    with pytest.raises(toile.InputError, match="rest_shape: expected one of automatic, drawing, start"):
        toile.Cloth.from_file(file, rest_shape="cut")


def test_solids_have_their_own_friction_motion_and_place():
    table = toile.Body.box((0.6, 0.1, 0.6)).place((1, -0.05, 0)).set_moves([{"t_s": 0}, {"t_s": 1, "shift_m": (0, 0.2, 0)}])
    ball = toile.Body.sphere(0.1, edge_m=0.03).set_friction(0.8).set_offset(0.004)
    rail = toile.Body.capsule(0.02, (3, 0, 0), (3, 0, 1))
    cone = toile.Body.revolved([(0, 0.2), (0.1, 0), (0, 0)]).place((5, 0, 0), rotation_deg=(0, 45, 0)).set_inside_out(False)
    carried = toile.Cloth.grid(width_m=0.2, height_m=0.2, edge_m=0.04).place((1, 0.004, 0), rotation_deg=(-90, 0, 0))
    sim = toile.Simulation(carried, solids=[ball, table, rail, cone])
    assert sim.colliders == 4
    assert len(sim.body_positions_m) == sum(len(sim.collider_positions_m(k)) for k in range(4))
    start = sim.collider_positions_m(0)
    for k in range(30):
        sim.set_collider(0, start + [0, 0.01 * (k + 1), 0])
        advance(sim, 1)
    assert sim.positions_m[:, 1].mean() == pytest.approx(0.2, abs=0.006)
    assert np.allclose(sim.collider_positions_m(0), start + [0, 0.3, 0])
    again = pickle.loads(pickle.dumps(sim))
    assert again.state_hash == sim.state_hash and again.colliders == 4
    with pytest.raises(toile.InputError, match="from 0 to 3"):
        sim.collider_positions_m(4)
    with pytest.raises(toile.InputError, match="t_s"):
        toile.Body.sphere(1).set_moves([{"shift_m": (0, 0, 0)}])
    with pytest.raises(TypeError, match="solids"):
        toile.Simulation(carried, solids=["ball"])


def test_pressure_carries_a_sheet_and_changes_between_frames():
    weight_Pa = 9.81 * toile.fabric("cotton").density_kg_per_m2
    cloth = toile.Cloth(*sheet_arrays(), name="sheet").set_panel_pressure("sheet", weight_Pa)
    sim = toile.Simulation(cloth, "cotton")
    advance(sim, 15)
    assert np.allclose(sim.positions_m[:, 1], 0, atol=1e-6)
    sim.set_pressure(2 * weight_Pa)
    advance(sim, 15)
    assert sim.positions_m[:, 1].min() > 0.2
    with pytest.raises(toile.InputError, match="panel"):
        sim.set_pressure(1, panel=1)
    with pytest.raises(toile.InputError, match="Pa"):
        cloth.set_panel_pressure("sheet", float("nan"))


def test_what_is_attached_goes_with_the_body_and_friction_and_stiffness_change():
    pole = toile.Body.box((0.04, 0.4, 0.04)).set_moves([{"t_s": 0}, {"t_s": 1, "rotation_deg": (0, 90, 0)}])
    flag = toile.Cloth.grid(width_m=0.2, height_m=0.2, edge_m=0.04).place((0.13, 0, 0))
    sim = toile.Simulation(flag, solids=[pole])
    edge = np.flatnonzero(sim.positions_m[:, 0] < 0.031)
    before = sim.positions_m[edge]
    sim.attach(edge)
    assert sim.pinned == edge.tolist()
    sim.set_friction(0.1)
    sim.set_stiffness(stretch=0.5, bend=20)
    advance(sim, 30)
    turned = before[:, [2, 1, 0]] * [1, 1, -1]
    assert np.allclose(sim.positions_m[edge], turned, atol=1e-6)
    with pytest.raises(toile.InputError, match="panel"):
        sim.set_stiffness(panel=3)
    with pytest.raises(toile.Error):
        toile.Simulation(flag).attach(edge)
