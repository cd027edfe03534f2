"""How notebooks show an object: IPython calls `_repr_png_` and `_repr_html_`."""

from __future__ import annotations

import html
from typing import Any

from ._errors import Error

# Of a picture: pixels, where it is seen from, paths per pixel.
VIEW: dict[str, Any] = {"width": 480, "height": 480, "azimuth_deg": 25.0, "elevation_deg": 10.0, "samples": 8}


class ShowsItself:
    """Shows itself as a picture, or, without pictures, as text with the reason."""

    def _still(self) -> bytes:
        """A PNG; kept until there is another.  Raises Error."""
        raise NotImplementedError

    def _repr_png_(self) -> bytes | None:
        try:
            return self._still()
        except Error:
            return None

    def _repr_html_(self) -> str | None:
        try:
            self._still()
        except Error as error:
            return f"<p>{html.escape(repr(self))}<br>No picture: {html.escape(str(error))}</p>"
        return None
