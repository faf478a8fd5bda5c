#!/usr/bin/env python3
"""Writes src/python/API.md from the docstrings.

    python tests/python/api.py
"""

import inspect
import pathlib
import re

import tilebind

PAGE = pathlib.Path(__file__).resolve().parents[2] / "src/python/API.md"


def members(thing):
    """The public methods and attributes of a class, in alphabetical order."""
    if not isinstance(thing, type):
        return []
    inherited = {*dir(tuple), *dir(ValueError)} | {"get", "items", "keys", "values"}
    names = (n for n in vars(thing) if not n.startswith("_") and n not in inherited)
    return [(name, getattr(thing, name)) for name in sorted(names)]


def signature(thing):
    try:
        text = str(inspect.signature(thing))
    except (TypeError, ValueError):
        return ""
    return text.replace("($self, /", "(").replace("(self, /", "(").replace("(self", "(").replace("(, ", "(")


def body(thing):
    """A numpydoc docstring as Markdown."""
    text = inspect.getdoc(thing) or ""
    text = re.sub(r":(?:func|meth|attr|class):`(?:tilebind\.)?([^`]*)`", r"`\1`", text)
    text = re.sub(r"``([^`]*)``", r"`\1`", text)
    lines, section = [], None
    split = text.split("\n")
    for number, line in enumerate(split):
        under = split[number + 1] if number + 1 < len(split) else ""
        if re.fullmatch(r"-{3,}", under):
            section = line
            lines.append(f"**{line}**\n")
        elif re.fullmatch(r"-{3,}", line):
            continue
        elif section in ("Parameters", "Returns", "Raises", "Attributes") and line.strip():
            lines.append(f"  {line.strip()}" if line.startswith(" ") else f"- `{line}`  ")
        elif section == "Examples" and line.startswith((">>>", "...")) or section == "Examples" and line:
            lines.append(f"    {line}")
        else:
            lines.append(line)
    return "\n".join(lines).strip() + "\n"


def page():
    parts = ["# tilebind for Python\n", body(tilebind).replace(">>> ", "    >>> ")]
    for name in sorted(tilebind.__all__, key=str.lower):
        thing = getattr(tilebind, name)
        if name == "__version__":
            continue
        head = name if isinstance(thing, type) else f"{name}{signature(thing)}"
        parts += [f"## `{head}`\n", body(thing)]
        for called, member in members(thing):
            is_call = callable(member)
            parts += [f"### `{name}.{called}{signature(member) if is_call else ''}`\n", body(member)]
    return "\n".join(parts)


if __name__ == "__main__":
    PAGE.write_text(page())
