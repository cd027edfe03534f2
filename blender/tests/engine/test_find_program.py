"""The order in which the program is looked for, and what the user is told."""

import os
import re
import stat

import pytest

from toile_blender.engine import find_program
from toile_blender.engine.errors import ToileError


def make(path, text="#!/bin/sh\necho toile 9.9\n"):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    path.chmod(0o755)
    return path


def test_preferences_then_path_then_what_came_with_it(tmp_path):
    preferred, in_path, carried = (make(tmp_path / name / "toile") for name in ("preferred", "path", "carried"))
    search = str(in_path.parent)
    assert find_program.find(str(preferred), search, carried) == preferred
    assert find_program.find(str(preferred.parent), search, carried) == preferred  # a folder will do
    assert find_program.find("", search, carried) == in_path
    assert find_program.find("", str(tmp_path), carried) == carried


def test_a_relative_path_is_of_the_folder_of_now(tmp_path, monkeypatch):
    there = make(tmp_path / "bin/toile")
    monkeypatch.chdir(tmp_path)
    assert find_program.find("bin/toile") == find_program.find("", "bin") == there


def test_what_came_in_a_zip_file_is_made_executable(tmp_path):
    carried = make(tmp_path / "toile")
    carried.chmod(0o644)
    assert find_program.find("", "", carried) == carried
    assert os.stat(carried).st_mode & stat.S_IXUSR


def test_errors_say_what_to_do(tmp_path):
    with pytest.raises(ToileError, match="preferences is not there: .*nowhere"):
        find_program.find(str(tmp_path / "nowhere"), str(make(tmp_path / "toile").parent))
    with pytest.raises(ToileError, match="make build"):
        find_program.find("", "", tmp_path / "none")
    plain = tmp_path / "plain"
    plain.write_text("")
    with pytest.raises(ToileError, match="may not be executed"):
        find_program.find(str(plain))
    with pytest.raises(ToileError, match="does not run: no such library"):
        find_program.version(make(tmp_path / "broken", "#!/bin/sh\necho no such library >&2\nexit 127\n"))


def test_the_program_of_the_build_says_its_version(program):
    assert re.fullmatch(r"[0-9]+(\.[0-9]+)+", find_program.version(program))
