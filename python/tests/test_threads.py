"""The GIL is free while a simulation works, Ctrl-C is heard, and nothing depends on who works beside whom."""

import os
import signal
import threading
import time

import pytest
from conftest import level_sheet, sheet_arrays

import toile


def slow(cells=80):
    """Cloth that hangs, whose advance() by 10 s takes the better part of a minute."""
    sim = toile.Simulation(toile.Cloth(*sheet_arrays(cells, 0.01)), "cotton", threads=1)
    sim.pin([0, cells])
    return sim


class CtrlC:
    """The signal of the keyboard, after a while."""

    def __init__(self, after_s):
        self._timer = threading.Timer(after_s, os.kill, (os.getpid(), signal.SIGINT))

    def __enter__(self):
        self._timer.start()
        self.begin = time.monotonic()
        return self

    def __exit__(self, *_):
        self.took_s = time.monotonic() - self.begin
        self._timer.join()


def heard(call, after_s=0.4):
    with CtrlC(after_s) as ctrl_c, pytest.raises(KeyboardInterrupt):
        call()
    assert after_s * 0.9 < ctrl_c.took_s < after_s + 10  # the call would take several times that


def test_ctrl_c_ends_advance_and_the_simulation_goes_on():
    sim = slow()
    heard(lambda: sim.advance(10))
    assert sim.advance(1e-3).ok


def test_ctrl_c_ends_dress_which_can_be_begun_again():
    sim = slow()
    heard(lambda: sim.dress(longest_s=1000))
    assert sim.dress(longest_s=0.01).ended != "interrupted"


def test_ctrl_c_ends_a_batch():
    batch = toile.Batch([slow() for _ in range(3)], threads=2)
    heard(lambda: batch.advance(10))
    assert all(step.ok for step in batch.advance(1e-3))


def test_cancel_ends_a_call_from_another_thread():
    sim = slow()
    timer = threading.Timer(0.4, sim.cancel)
    timer.start()
    step = sim.advance(10)
    timer.join()
    assert step.cancelled and not step.ok and step.explain() == "cancelled"


def test_other_threads_run_while_it_works():
    sim, ticks, done = slow(), [], threading.Event()

    def tick():
        while not done.is_set():
            ticks.append(time.monotonic())
            time.sleep(0.002)

    ticker = threading.Thread(target=tick)
    timer = threading.Timer(1.0, sim.cancel)  # it can only be heard if the GIL is free
    ticker.start()
    timer.start()
    begin = time.monotonic()
    sim.advance(10)
    end = time.monotonic()
    done.set()
    ticker.join()
    timer.join()
    while_it_worked = [t for t in ticks if begin + 0.1 < t < end - 0.1]
    assert len(while_it_worked) > 20


def test_a_simulation_at_work_refuses_a_second_call_instead_of_waiting_for_itself(draped):
    refused = []

    def progress(*_):
        for use in (lambda: draped.advance(0.01), lambda: draped.positions_m, lambda: draped.pin([0])):
            try:
                use()
            except toile.Error as error:
                refused.append(error.code)

    draped.dress(longest_s=0.5, progress=progress)
    assert len(refused) >= 3 and set(refused) == {"usage"}
    assert draped.positions_m.shape[1] == 3  # and is free again


def test_two_simulations_in_two_threads_have_the_bits_of_one_alone():
    def run(sim):
        for _ in range(8):
            assert sim.advance(1 / 30).ok
        return sim.state_hash

    wanted = [run(level_sheet(fabric=name)) for name in ("silk", "denim")]
    got = {}
    threads = [threading.Thread(target=lambda n=n: got.update({n: run(level_sheet(fabric=n))})) for n in ("silk", "denim")]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert [got["silk"], got["denim"]] == wanted and wanted[0] != wanted[1]


def test_the_number_of_threads_does_not_change_a_bit():
    hashes = set()
    for threads in (1, 2, 0):
        sim = toile.Simulation(toile.Cloth(*sheet_arrays(20, 0.02)), threads=threads)
        sim.pin([0])
        for _ in range(4):
            assert sim.advance(1 / 30).ok
        hashes.add(sim.state_hash)
    assert len(hashes) == 1


def test_a_batch_has_the_bits_of_one_after_the_other():
    fabrics = ["silk", "cotton", "wool", "denim", "knit"]

    def made():
        sims = [level_sheet(fabric=name, threads=1) for name in fabrics]
        for sim in sims:
            sim.pin([0])
        return sims

    alone = made()
    for sim in alone:
        for _ in range(5):
            assert sim.advance(1 / 30).ok
    batch = toile.Batch(made(), threads=2)
    for _ in range(5):
        steps = batch.advance(1 / 30)
        assert len(steps) == 5 and all(step.ok for step in steps)
    assert [sim.state_hash for sim in batch] == [sim.state_hash for sim in alone]
    assert [x.shape for x in batch.positions_m] == [sim.positions_m.shape for sim in alone]
    assert len(set(sim.state_hash for sim in batch)) == 5


def test_a_batch_works_on_several_at_once(monkeypatch):
    meeting = threading.Barrier(2)

    def advance(self, h_s):
        meeting.wait(timeout=30)  # broken if they come one after the other
        return toile.StepReport

    monkeypatch.setattr(toile.Simulation, "advance", advance)
    assert len(toile.Batch([level_sheet(), level_sheet()], threads=2).advance(0.1)) == 2


def test_an_error_in_a_batch_comes_out_and_each_simulation_is_in_it_once(sheet):
    batch = toile.Batch([sheet])
    with pytest.raises(toile.InputError, match="h_s"):
        batch.advance(-1)
    with pytest.raises(toile.InputError, match="once"):
        toile.Batch([sheet, sheet])
    with pytest.raises(TypeError, match="Simulation"):
        toile.Batch([sheet, "sheet"])
