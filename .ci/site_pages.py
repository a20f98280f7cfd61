"""Hooks of mkdocs: pages that lie outside `docs`, and links from page to page as they are in the repository.

In the repository a document links to files by their place; on the site some of these have another name, and others,
grammar files and scripts, are no pages and are given as they are.
"""

import posixpath
import re
from pathlib import Path

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files
from mkdocs.structure.pages import Page

ROOT = Path(__file__).resolve().parents[1]

PAGES = {
    "README.md": "index.md",
    "benchmarks/README.md": "benchmarks.md",
    "CHANGELOG.md": "changelog.md",
    "SECURITY.md": "security.md",
}
"""Document of the repository to its page."""

LINK = re.compile(r"(!?\[[^\]]*\]\()([^)\s#]+)((?:#[^)\s]*)?\))")
SOURCE = re.compile(r"(<img src=\")([^\"#]+)(\")")
"""Pictures of a given width, which Markdown has no words for."""


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add the pages, and the files that any page links to."""
    for source, page in PAGES.items():
        files.append(File.generated(config, page, abs_src_path=str(ROOT / source)))
    for file in list(files.documentation_pages()):
        for target in _targets(place_of(file.src_uri)):
            name = page_of(target)
            if files.get_file_from_path(name) is None and (ROOT / target).is_file():
                files.append(File.generated(config, name, abs_src_path=str(ROOT / target)))
    return files


def on_page_markdown(markdown: str, page: Page, **_: object) -> str:
    """Let links lead to pages of the site; those to folders become words."""
    here = place_of(page.file.src_uri)

    def change(link: re.Match[str]) -> str:
        before, target, after = link.groups()
        if "://" in target:
            return link[0]
        place = posixpath.normpath(posixpath.join(posixpath.dirname(here), target))
        if (ROOT / place).is_dir():
            return before.lstrip("![").removesuffix("](")
        return before + posixpath.relpath(page_of(place), posixpath.dirname(page.file.src_uri) or ".") + after

    return SOURCE.sub(change, LINK.sub(change, markdown))


def place_of(page: str) -> str:
    """Where the document of a page lies in the repository."""
    return next((source for source, name in PAGES.items() if name == page), f"docs/{page}")


def page_of(place: str) -> str:
    """Where a file of the repository is found on the site."""
    return PAGES.get(place) or (
        place.removeprefix("docs/") if place.startswith("docs/") else f"files/{place}"
    )


def _targets(document: str) -> list[str]:
    text = (ROOT / document).read_text(encoding="utf-8")
    found = [*LINK.findall(text), *SOURCE.findall(text)]
    links = [target for _, target, _ in found if "://" not in target]
    return [posixpath.normpath(posixpath.join(posixpath.dirname(document), target)) for target in links]
