"""How far an evaluation is."""

from collections.abc import Iterable
from typing import Protocol, TypeVar

Item = TypeVar("Item")


class Progress(Protocol):
    """Passes items on and shows how far they are, under a heading."""

    def __call__(self, items: Iterable[Item], heading: str, /) -> Iterable[Item]: ...


def progress_bar(items: Iterable[Item], heading: str) -> Iterable[Item]:
    """Pass items on behind a progress bar on stderr; silent where stderr is no terminal."""
    from tqdm import tqdm

    bar: Iterable[Item] = tqdm(items, desc=heading, leave=False, disable=None)
    return bar
