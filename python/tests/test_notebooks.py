"""Runs the notebooks, in Jupyter's kernel where it is installed and cell by cell in plain Python where it is not."""

import json
import os

import pytest
from conftest import has_pictures, one_core, root

notebooks = sorted((root / "python/notebooks").glob("*.ipynb"))


def test_there_are_three():
    assert len(notebooks) == 3


@pytest.mark.parametrize("path", notebooks, ids=lambda path: path.stem)
def test_a_notebook_runs_and_is_stored_without_outputs(path, tmp_path, monkeypatch):
    cells = json.loads(path.read_text())["cells"]
    code = [cell for cell in cells if cell["cell_type"] == "code"]
    assert code and all(not cell["outputs"] and cell["execution_count"] is None for cell in code)
    pytest.importorskip("matplotlib", reason="the notebooks draw with matplotlib, which is not installed")
    monkeypatch.chdir(tmp_path)
    try:
        import ipykernel  # noqa: F401
        import nbclient
        import nbformat
    except ImportError:
        monkeypatch.setenv("MPLBACKEND", "Agg")
        space = {"__name__": "__main__"}
        for k, cell in enumerate(code):
            exec(compile("".join(cell["source"]), f"{path.name} cell {k + 1}", "exec"), space)
        return
    notebook = nbformat.read(path, as_version=4)
    monkeypatch.delenv("MPLBACKEND", raising=False)  # pictures go into the notebook
    cores = os.sched_getaffinity(0)
    one_core()
    try:
        nbclient.NotebookClient(notebook, timeout=300, kernel_name="python3", resources={"metadata": {"path": str(tmp_path)}}).execute()
    finally:
        os.sched_setaffinity(0, cores)
    drawn = [o for cell in notebook.cells for o in cell.get("outputs", []) if "image/png" in o.get("data", {})]
    assert drawn, "no cell drew anything"
    if path.stem == "1-quick-start" and has_pictures():
        shown = [o for o in drawn if o.output_type == "execute_result" and "<Simulation of" in o["data"]["text/plain"]]
        assert len(shown) == 2, "a simulation shows itself"
