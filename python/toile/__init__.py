"""Cloth on bodies: sewing patterns or meshes in, draped clothing out.

    import toile
    sim = toile.Simulation(toile.Cloth.from_pattern("tshirt.json"), "cotton", toile.Body.mannequin("woman", motion="walk"))
    print(sim.dress(progress=True).explain())
    for frame in sim.frames(seconds=4, fps=30):
        draw(frame.positions_m, sim.faces)

Numbers are in SI units, which are part of the names; y is up, right-handed.  More: docs/howto/python.md.
"""

from ._errors import Error, InputError, IoError  # isort: skip  (the module below raises them)
from ._batch import Batch
from ._body import Body
from ._cloth import Cloth, fabric
from ._frame import Frame
from ._run_batch import run_batch
from ._runs import RunWriter, check_pattern, export_run, preview, run_scene, verify
from ._simulation import Simulation
from ._toile import CheckReport, Crossings, DressReport, Fabric, Finding, Reason, State, StepReport, Verdict, fabric_names
from ._toile import version as __version__

__all__ = [
    "Batch",
    "Body",
    "CheckReport",
    "Cloth",
    "Crossings",
    "DressReport",
    "Error",
    "Fabric",
    "Finding",
    "Frame",
    "InputError",
    "IoError",
    "Reason",
    "RunWriter",
    "Simulation",
    "State",
    "StepReport",
    "Verdict",
    "__version__",
    "check_pattern",
    "export_run",
    "fabric",
    "fabric_names",
    "preview",
    "run_batch",
    "run_scene",
    "verify",
]
