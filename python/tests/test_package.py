"""The package itself: its version, its types, and that everything public says what it is."""

import ast
import inspect
import pathlib
import re

import pytest
from conftest import root

import toile

package = pathlib.Path(toile.__file__).parent
public = [(name, getattr(toile, name)) for name in toile.__all__ if name != "__version__"]


def test_the_version_is_that_of_the_project():
    assert re.search(r"project\(toile VERSION ([\d.]+)", (root / "CMakeLists.txt").read_text()).group(1) == toile.__version__


def test_it_is_typed():
    assert (package / "py.typed").is_file()
    stub = (package / "_toile.pyi").read_text()
    ast.parse(stub)
    for word in ("class Simulation", "class StepReport", "def advance", "NDArray", "density_kg_per_m2"):
        assert word in stub, word


def test_the_stub_of_fabric_names_its_fields():
    words = re.search(r"def __init__\(self, \*, (name: str.*)\) -> None", (package / "_toile.pyi").read_text()).group(1)
    assert [word.split(":")[0] for word in words.split(", ")] == list(toile.Fabric().fields())


@pytest.mark.parametrize("name, thing", public, ids=[name for name, _ in public])
def test_everything_public_says_what_it_is(name, thing):
    assert inspect.getdoc(thing), name
    if inspect.isclass(thing) and thing.__module__ != "toile._errors":
        for part, value in vars(thing).items():
            if not part.startswith("_") and (callable(value) or isinstance(value, (property, classmethod, staticmethod))):
                plain = {"let_go", "panel_names", "warnings", "cloth_body_edges", "cloth_cloth_edges"}  # their names do
                assert inspect.getdoc(value) or part in plain, f"{name}.{part}"


def test_arguments_with_a_unit_say_it():
    """What is a length, time, force ... has its unit in its name."""
    bare = {"seconds", "fps", "fabric", "friction", "threads", "barycentric"}
    for thing in (toile.Simulation, toile.Cloth, toile.Body):
        for name, method in inspect.getmembers(thing, callable):
            if name.startswith("_") and name != "__init__":
                continue
            for argument, parameter in inspect.signature(method).parameters.items():
                if isinstance(parameter.default, float) and argument not in bare:
                    assert re.search(r"_(m|s|kg|N|deg|per)", argument), f"{name}({argument})"


def test_all_units_of_work_are_short():
    for folder in ("python/src", "python/toile", "python/tests"):
        for path in (root / folder).glob("*.[chp]*"):
            assert len(path.read_text().splitlines()) < 420, path
