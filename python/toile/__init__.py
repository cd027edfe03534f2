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
from ._simulation import Simulation
from ._toile import Crossings, DressReport, Fabric, Reason, State, StepReport, fabric_names
from ._toile import version as __version__

__all__ = [
    "Batch",
    "Body",
    "Cloth",
    "Crossings",
    "DressReport",
    "Error",
    "Fabric",
    "Frame",
    "InputError",
    "IoError",
    "Reason",
    "Simulation",
    "State",
    "StepReport",
    "__version__",
    "fabric",
    "fabric_names",
]
