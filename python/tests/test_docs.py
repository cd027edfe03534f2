"""Runs the Python that the documents show: every ```python block of a document, one after the other, in an empty folder."""

import re

import pytest
from conftest import root

documents = ["README.md", "docs/howto/python.md"]


def blocks(text):
    return re.findall(r"^```python\n(.*?)^```", text, re.MULTILINE | re.DOTALL)


@pytest.mark.parametrize("document", documents)
def test_the_code_of_a_document_runs(document, tmp_path, monkeypatch):
    code = blocks((root / document).read_text())
    assert code, f"{document} shows no Python"
    (tmp_path / "patterns").symlink_to(root / "patterns")
    (tmp_path / "scenes").symlink_to(root / "scenes")
    monkeypatch.chdir(tmp_path)
    space = {"__name__": "__main__"}
    for k, block in enumerate(code):
        exec(compile(block, f"{document} block {k + 1}", "exec"), space)


def test_the_quick_start_is_short():
    code = blocks((root / "README.md").read_text())
    assert len(code) == 1 and len(code[0].strip().splitlines()) <= 12
