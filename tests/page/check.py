#!/usr/bin/env python3
"""Opens the pages of all commands in headless Chromium and uses them.

    check.py PROGRAM [--pictures FOLDER]

PROGRAM is the built tilebind. Where there is no Chromium, Debian's is installed if that can be
done; where it cannot, the check is left out and says so. Exit status 0 where all holds.
"""

import argparse
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

from browser import Browser
from crowd import check_crowd
from landscapes import check_docking, check_page
from looking import Check
from others import check_others
from tables import SHAPES, check_comparison, check_sweep
from words import check_words


def chromium():
    """The browser's program, installed if needed; None if there is none."""
    names = ["chromium", "chromium-browser", "google-chrome"]
    found = next(filter(None, map(shutil.which, names)), None)
    if found or os.geteuid() != 0 or not shutil.which("apt-get"):
        return found
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    for command in (["apt-get", "update"], ["apt-get", "install", "-y", "--no-install-recommends", "chromium"]):
        subprocess.run(command, env={**os.environ, "DEBIAN_FRONTEND": "noninteractive"}, check=False, **quiet)
    return shutil.which("chromium")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("--pictures", type=pathlib.Path, help="keep screenshots here")
    parser.add_argument("--designs", nargs="*", default=["paper-tile", "triangle-teeth-10mm", "dovetail"])
    arguments = parser.parse_args()
    program = chromium()
    if program is None:
        print("tests/page: left out, there is no Chromium and it cannot be installed here")
        return 0
    if arguments.pictures:
        arguments.pictures.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        browser = Browser(program)
        check = Check(browser, arguments.pictures)
        try:
            for name in arguments.designs:
                print(f"tests/page: {name}")
                out = pathlib.Path(folder, name)
                subprocess.run([arguments.program, "analyse", SHAPES / f"{name}.toml", "--out", out, "--quiet",
                                "--certify-seconds", "2", "--complete-seconds", "4",
                                "--milestones", "1000"], check=True)
                check_page(check, name, out / "report.html")
            print("tests/page: compare, sweep")
            check_comparison(check, arguments.program, pathlib.Path(folder))
            check_sweep(check, arguments.program, pathlib.Path(folder))
            print("tests/page: words, crosstalk")
            check_words(check, arguments.program, pathlib.Path(folder))
            check_others(check, arguments.program, pathlib.Path(folder))
            print("tests/page: table")
            check_crowd(check, arguments.program, pathlib.Path(folder))
            print("tests/page: docking")
            out = pathlib.Path(folder, "docking")
            subprocess.run([arguments.program, "dock", SHAPES / "paper-tile.toml", "--drag", "0.5", "--no-walls", "--runs", "200",
                            "--out", out, "--quiet"], check=True)
            check_docking(check, out / "report.html")
        finally:
            browser.close()
    print(f"tests/page: {len(check.failures)} failures" if check.failures else "tests/page: all holds")
    return 1 if check.failures else 0


if __name__ == "__main__":
    sys.exit(main())
