"""Runs the Python that the documents show: every ```python block of a document, one after the other, in an empty folder."""

import os
import pathlib
import re
import subprocess
import sys

import pytest
from conftest import one_core, root

batches = "docs/howto/batch.md"
documents = ["README.md", "docs/howto/python.md", batches]


def blocks(text):
    return re.findall(r"^```python\n(.*?)^```", text, re.MULTILINE | re.DOTALL)


@pytest.mark.parametrize("document", documents)
def test_the_code_of_a_document_runs(document, tmp_path):
    code = blocks((root / document).read_text())
    assert code, f"{document} shows no Python"
    env = dict(os.environ)
    if document == batches:
        pytest.importorskip("distributed", reason="Dask is not installed")
        program = env.get("TOILE_PROGRAM") or pytest.skip("the program is not built")
        env["PATH"] = f"{pathlib.Path(program).parent}:{env['PATH']}"
    (tmp_path / "patterns").symlink_to(root / "patterns")
    (tmp_path / "scenes").symlink_to(root / "scenes")
    done = subprocess.run([sys.executable, "-"], input="\n".join(code), text=True, cwd=tmp_path, env=env, capture_output=True, preexec_fn=one_core)
    assert done.returncode == 0, done.stderr


def test_the_quick_start_is_short():
    code = blocks((root / "README.md").read_text())
    assert len(code) == 1 and len(code[0].strip().splitlines()) <= 12
