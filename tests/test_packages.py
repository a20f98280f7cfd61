"""Every folder of modules is named in pyproject.toml: one that is not would be missing from the installed package."""

import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
SETUPTOOLS = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["setuptools"]


def test_folders_of_modules_are_packages():
    found = set()
    for package, room in SETUPTOOLS["package-dir"].items():
        folder = ROOT / room
        links = [
            item for item in folder.iterdir() if item.is_symlink()
        ]  # from the application to the other rooms
        for file in folder.rglob("*.py"):
            if not any(file.is_relative_to(link) for link in links):
                found.add(".".join((package, *file.parent.relative_to(folder).parts)))
    assert found == set(SETUPTOOLS["packages"])
