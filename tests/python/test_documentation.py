"""What is written about the package is true: stubs, docstrings, the API page, the README."""

import inspect
import re
import subprocess
import sys

import pytest
import tilebind
from api import PAGE, members, page

PUBLIC = [getattr(tilebind, name) for name in tilebind.__all__ if name != "__version__"]


def test_everything_is_documented():
    for thing in PUBLIC:
        assert thing.__doc__, thing
        for name, member in members(thing):
            assert inspect.getdoc(member), f"{thing.__name__}.{name}"


def test_parameters_are_those_of_the_signatures():
    for thing in PUBLIC:
        for name, member in [("", thing), *members(thing)]:
            text = inspect.getdoc(member) or ""
            if isinstance(thing, type) and not name or "Parameters\n---" not in text:
                continue
            listed = text.split("Parameters\n----------\n")[1]
            listed = re.split(r"\n\n\w+\n---", listed)[0]
            told = re.findall(r"^(\*{0,2}\w[\w, *]*?)(?: : .*)?$", listed, re.M)
            told = {one.strip(" *") for line in told for one in line.split(",")}
            has = inspect.signature(member).parameters.values()
            # What is asked is told keyword by keyword.
            has = {one.name for one in has if one.kind != one.VAR_KEYWORD} - {"self", "cls"}
            assert has <= told, (thing.__name__, name, has - told)


def test_the_stubs_are_those_of_the_package():
    pytest.importorskip("mypy")
    checked = [sys.executable, "-m", "mypy.stubtest", "tilebind._tilebind", "--ignore-missing-stub"]
    done = subprocess.run(checked, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_api_page_is_up_to_date():
    assert PAGE.read_text() == page(), "python tests/python/api.py writes it anew"


def test_the_readme_holds(root, tmp_path, monkeypatch):
    sections = re.split(r"^## ", (root / "README.md").read_text(), flags=re.M)
    python = [section for section in sections if section.startswith("Python\n")]
    if not python:
        pytest.skip("the README has no section Python")
    blocks = re.findall(r"```python\n(.*?)```", python[0], re.S)
    assert blocks
    (tmp_path / "shapes").symlink_to(root / "shapes")
    monkeypatch.chdir(tmp_path)
    names = {}
    for block in blocks:
        exec(compile(block, "README.md", "exec"), names)
