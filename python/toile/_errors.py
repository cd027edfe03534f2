"""What is raised for what cannot be meant.  Physics that goes badly is not raised: it is in a report."""

from __future__ import annotations


class Error(RuntimeError):
    """Something that cannot be done.

    `code` is one word: "usage" (a call in the wrong order, or an option out of its range), "bad_input", "bad_start",
    "input_output", "resource_limit" or "internal" (a bug of Toile).
    """

    code: str = "usage"


class InputError(Error, ValueError):
    """A file or an array that is not what it should be: where, what was expected, and what there is."""

    code = "bad_input"


class IoError(Error, OSError):
    """A file that cannot be read or written: its path and the system's reason."""

    code = "input_output"
