"""What is published beside the code: the site of the documents, the citation, the container file."""

import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from lightgesture import __version__

ROOT = Path(__file__).resolve().parents[1]


def build(folder, out):
    command = [sys.executable, "-m", "mkdocs", "build", "--strict", "--quiet", "-d", out]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    pytest.importorskip("mkdocs")
    out = tmp_path_factory.mktemp("site")
    done = build(ROOT, out)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", ""), "links, anchors and pages are checked"
    return out


def test_every_document_is_a_page(site):
    pages = {f"{path.stem}.html" for path in (ROOT / "docs").glob("*.md")}
    assert {
        page
        for page in pages | {"index.html", "benchmarks.html", "changelog.html"}
        if not (site / page).is_file()
    } == set()


def test_links_of_pages_lead_to_files_of_the_site(site):
    dead = [
        (page.name, target)
        for page in site.glob("*.html")
        if page.name != "404.html"
        for target in re.findall(r'(?:href|src)="([^"#:]+)(?:#[^"]*)?"', page.read_text(encoding="utf-8"))
        if not (page.parent / target).exists()
    ]
    assert dead == []


def test_nothing_is_loaded_from_elsewhere(site):
    loaded = [
        address
        for page in site.glob("*.html")
        for address in re.findall(
            r'<(?:script|link|img)[^>]*(?:src|href)="(https?:[^"]+)', page.read_text("utf-8")
        )
    ]
    assert loaded == []


def test_the_citation_is_of_this_version():
    text = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert f"\nversion: {__version__}\n" in text
    assert f"\nlicense: {project['license']}\n" in text
    assert f"\n  - name: {project['authors'][0]['name']}\n" in text
    yaml = pytest.importorskip("yaml")
    content = yaml.safe_load(text)
    assert {"cff-version", "message", "title", "authors"} <= set(content)
    assert content["references"][0]["authors"][0]["family-names"] == "Islam"


def test_the_container_file_takes_what_is_there():
    text = (ROOT / "deploy" / "Containerfile").read_text(encoding="utf-8").replace("\\\n", " ")
    commands = [line for line in text.splitlines() if line and not line.startswith("#")]
    assert {line.split()[0] for line in commands} <= {
        *("ARG", "FROM", "COPY", "RUN", "ENV", "USER", "WORKDIR", "ENTRYPOINT", "CMD")
    }
    assert all((ROOT / place).exists() for place in re.findall(r"/source/(\S+)", text))
    assert "USER diver" in commands
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    (python,) = re.findall(r"ARG PYTHON=(\S+)", text)
    assert f"Programming Language :: Python :: {python}" in project["classifiers"]


def test_the_small_versions_are_allowed():
    requirements = pytest.importorskip("packaging.requirements")
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    allowed = [requirements.Requirement(text) for text in project["dependencies"]]
    pinned = [
        requirements.Requirement(line)
        for line in (ROOT / "deploy" / "small.txt").read_text(encoding="utf-8").splitlines()
        if not line.startswith("#")
    ]
    for pin in pinned:
        version = str(pin.specifier).removeprefix("==")
        assert any(one.name == pin.name and one.specifier.contains(version) for one in allowed), pin.name
