"""Results as notebooks show them."""

from __future__ import annotations

import base64
import html


def page(text: str, pictures: list[str]) -> str:
    """A text in a fixed font, and SVG documents below it, each an image of its own (so that their
    internal names do not collide)."""
    shown = [f'<pre style="line-height:1.25">{html.escape(text)}</pre>']
    for svg in pictures:
        data = base64.b64encode(svg.encode()).decode()
        shown.append(f'<img style="max-width:100%" src="data:image/svg+xml;base64,{data}">')
    return "<div>" + "\n".join(shown) + "</div>"
