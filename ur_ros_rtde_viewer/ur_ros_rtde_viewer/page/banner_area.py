"""Where the page shows banners: over the scene."""

import html
from typing import Any, Dict, List, Tuple

from . import style


class BannerArea:
    """The banners of all robots, one below the other."""

    def __init__(self, gui: Any):
        self._element = gui.add_html("", visible=False)
        self._shown: Dict[str, List[Tuple[str, str]]] = {}

    def show(self, name: str, shown: List[Tuple[str, str]]) -> None:
        """Replaces the banners of a robot by these colors and texts."""
        self._shown[name] = shown
        content = "".join(f"<div style='background:{color}'>{html.escape(text)}</div>"
                          for found in self._shown.values() for color, text in found)
        self._element.content = f"<div class='{style.BANNERS}'>{content}</div>"
        self._element.visible = bool(content)
