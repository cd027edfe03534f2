"""What notebooks show of an object by itself: IPython asks for `_repr_png_` and `_repr_html_`."""

from __future__ import annotations

import html
from typing import Callable

from ._errors import Error

# Of a picture: pixels, where it is seen from, paths per pixel.
VIEW = {"width": 480, "height": 480, "azimuth_deg": 25.0, "elevation_deg": 10.0, "samples": 8}


def png_or_none(draw: Callable[[], bytes]) -> bytes | None:
    try:
        return draw()
    except Error:
        return None


def why_none(shown: object, draw: Callable[[], bytes]) -> str | None:
    """Where there is a picture nothing: it is shown.  Where there is none, what the object is and why."""
    try:
        draw()
    except Error as error:
        return f"<p>{html.escape(repr(shown))}<br>No picture: {html.escape(str(error))}</p>"
    return None
