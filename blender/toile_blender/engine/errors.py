"""What goes wrong in the user's terms."""

from __future__ import annotations


class ToileError(Exception):
    """A sentence for the user: what was expected, and what there is."""
