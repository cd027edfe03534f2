"""The exceptions.  Invalid input raises one; a simulation that fails says so in its report instead."""

from __future__ import annotations


class Error(RuntimeError):
    """The base of all exceptions of Toile.

    `code` is one word: "usage" (a call in the wrong order, or an option out of its range), "bad_input", "bad_start",
    "input_output", "resource_limit" or "internal" (a bug of Toile).
    """

    code: str = "usage"


class InputError(Error, ValueError):
    """A file or an array with invalid contents: the place, the expected and the actual value."""

    code = "bad_input"


class IoError(Error, OSError):
    """A file that cannot be read or written: its path and the system's reason."""

    code = "input_output"
