"""[tags] and [motions]: words that say themselves, by a printed card or by a pair of cards that is moved."""

from typing import Final

from lightgesture.fsm.language.document import key_path
from lightgesture.fsm.language.grammar import STILL, CardWords, Defect, MotionWords
from lightgesture.fsm.language.schema import GrammarFile, MotionsTable, TagsTable
from lightgesture.fsm.signs import Pair

FAMILIES: Final = {"25h9": 35, "36h10": 2320, "36h11": 587}
"""AprilTag families and how many ids each has. 16h5 is left out: five wrong cells of 16 make another of its tags."""

CANCEL: Final = "CANCEL"
"""The word that cancels by a card or a motion where [control] names none."""


def words_of(table: TagsTable | MotionsTable | None) -> dict[str, str]:
    """Key -> word of one of the two tables; none without it."""
    return {} if table is None else dict(table.model_extra or {})


def cancel_word(content: GrammarFile) -> str | None:
    """The word that drops the open sentence, None where there is none."""
    said = {*words_of(content.tags).values(), *words_of(content.motions).values()}
    return content.control.cancel or (CANCEL if CANCEL in said else None)


def read_tags(content: GrammarFile, defects: list[Defect]) -> CardWords | None:
    """The words of single cards; None without [tags]."""
    table = content.tags
    if table is None:
        return None
    count = _family_size("tags.family", table.family, defects)
    words: dict[int, str] = {}
    for key, word in words_of(table).items():
        number = _read_id(key_path("tags", key), key, table.family, count, defects)
        if number is not None:
            words[number] = word
    return CardWords(table.family, table.hold_seconds, words)


def read_motions(content: GrammarFile, defects: list[Defect]) -> MotionWords | None:
    """The words of moved cards; None without [motions]. Which motions there are, the data base of shapes knows."""
    table = content.motions
    if table is None:
        return None
    count = _family_size("motions.family", table.family, defects)
    for place, number in (("motions.left_id", table.left_id), ("motions.right_id", table.right_id)):
        _read_id(place, str(number), table.family, count, defects)
    if table.left_id == table.right_id:
        reason = f"both hands have tag {table.left_id}"
        defects.append(Defect("motions.right_id", reason, "give each its own"))
    words: dict[Pair, str] = {}
    for key, word in words_of(table).items():
        left, comma, right = (part.strip() for part in key.partition(","))
        place = key_path("motions", key)
        if not comma or not left or not right:
            remedy = 'write "left hand,right hand", such as "still,up"'
            defects.append(Defect(place, "is no pair of motions", remedy))
        elif left == right == STILL:
            defects.append(Defect(place, "two hands at rest are no motion", "name a shape for one of them"))
        elif (left, right) in words:
            reason = "pair used twice"
            defects.append(Defect(place, reason, f"keep one, here or for {words[left, right]}"))
        else:
            words[left, right] = word
    return MotionWords(table.family, table.left_id, table.right_id, table.hold_seconds, words)


def check_words(content: GrammarFile, used: set[str], defects: list[Defect]) -> None:
    """Every card and motion says a word that some form, or control, uses. used: all such words."""
    for name, table in (("tags", content.tags), ("motions", content.motions)):
        for key, word in words_of(table).items():
            if word not in used and word != CANCEL:
                reason, remedy = f"no form uses '{word}'", f"use it in one or remove it from [{name}]"
                defects.append(Defect(key_path(name, key), reason, remedy, is_fatal=False))


def _family_size(place: str, family: str, defects: list[Defect]) -> int:
    """How many ids a family has; 0, and a defect, where it is none."""
    if family not in FAMILIES:
        known = ", ".join(FAMILIES)
        reason = f"'{family[:40]}' is no family of tags that is read"
        defects.append(Defect(place, reason, f"use one of {known}"))
    return FAMILIES.get(family, 0)


def _read_id(place: str, text: str, family: str, count: int, defects: list[Defect]) -> int | None:
    if not text.isascii() or not text.isdigit() or (text != "0" and text.startswith("0")):
        defects.append(Defect(place, "is no id of a tag", 'write a whole number from 0, as in 4 = "HOVER"'))
    elif count and int(text[:9]) >= count:
        defects.append(Defect(place, f"{family} has the ids 0 to {count - 1}", "use one of them"))
    else:
        return int(text)
    return None
