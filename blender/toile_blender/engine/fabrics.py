"""Fabrics of the program by name, and the numbers of one that the user may set: docs/theory/fabrics.md."""

from __future__ import annotations

from typing import NamedTuple

NAMES = (
    "silk", "cotton", "wool", "denim", "knit",
    "chiffon", "satin", "jersey", "rib", "poplin", "linen", "flannel", "suiting", "canvas", "leather", "neoprene",
)


class Number(NamedTuple):
    key: str  # of the scene file
    words: str
    unit: str
    cotton: float  # what is shown before the user sets one
    least: float
    most: float


NUMBERS = (
    Number("density_kg_per_m2", "Weight", "kg/m²", 0.15, 0.001, 1000.0),
    Number("stretch_u_N_per_m", "Warp", "stiffness along the warp, N/m", 3000.0, 1.0, 1e9),
    Number("stretch_v_N_per_m", "Weft", "stiffness along the weft, N/m", 2000.0, 1.0, 1e9),
    Number("shear_N_per_m", "Shear", "stiffness, N/m", 60.0, 0.0, 1e9),
    Number("bend_u_N_m", "Bend Warp", "bending rigidity of the warp, N m", 7.3e-6, 0.0, 1e6),
    Number("bend_v_N_m", "Bend Weft", "bending rigidity of the weft, N m", 7.3e-6, 0.0, 1e6),
    Number("bend_friction_N", "Bend Friction", "moment per width that rubbing threads hold, half of KES-F's 2HB, N", 3.85e-4, 0.0, 1.0),
    Number("strain_limit", "Strain Limit", "0.05: no thread gets more than 5 % longer; 0: no limit", 0.0, 0.0, 1.0),
    Number("friction", "Friction", "on another layer", 0.35, 0.0, 100.0),
    Number("thickness_m", "Thickness", "m", 0.0025, 0.0001, 0.1),
)
