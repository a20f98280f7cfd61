"""The frame of every sentence form: start word, action, ..., end word."""

from collections.abc import Sequence

from lightgesture.fsm.forms import Form, FormError


def check_frame(form: Form, starts: Sequence[str], end: str, join: str | None) -> None:
    """FormError unless nothing can ever be issued without start word, action and end word."""
    if len(form.items) < 3:
        raise FormError(f"'{form.sentence}' is too short", "write start word, action and end word")
    first, action, last = form.items[0], form.items[1], form.items[-1]
    if first.optional or not first.words or not first.words <= frozenset(starts):
        raise FormError(f"'{form.sentence}' has no start word", "begin with " + "|".join(sorted(starts)))
    if last.optional or last.words != frozenset([end]):
        raise FormError(f"'{form.sentence}' has no end word", f"end with {end}")
    if action.optional or action.slot:
        raise FormError(f"'{form.sentence}' has no action", "put a word after the start word")
    if any(form.is_repeated(item) for item in (0, 1, len(form.items) - 1)):
        raise FormError(
            f"'{form.sentence}' repeats its frame", "put {...} after the action and before the end"
        )
    reserved = {*starts, end, join}
    for item in form.items[1:-1]:
        if item.words & reserved:
            word = min(item.words & reserved)
            raise FormError(f"'{word}' stands inside '{form.sentence}'", "use sentinels at the ends alone")
