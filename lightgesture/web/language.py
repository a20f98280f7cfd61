"""What the page of signs shows: the words of a grammar with their pairs, their drawings, and what may follow now."""

import json
from typing import Any

from lightgesture.fsm import Grammar
from lightgesture.signs.drawings import KINDS, drawing_file
from lightgesture.signs.sentences import following, pairs_by_word
from lightgesture.signs.text import MIRROR_NOTE, TOKEN_NAMES, form_lines, hold_note


class Language:
    """A grammar for browsers."""

    def __init__(self, grammar: Grammar) -> None:
        self._grammar = grammar

    def expected(self, sentence: str, state: str) -> list[str]:
        """The words that may follow the sentence so far, as the grammar's page orders them."""
        return following(self._grammar, sentence, state)

    def files(self) -> dict[str, tuple[bytes, str]]:
        """Path to content and type: the language as JSON, and its drawings."""
        files = {"/signs.json": (json.dumps(self._content()).encode(), "application/json")}
        for token in self._grammar.tokens:
            for kind in KINDS:
                file = drawing_file(token, kind)
                if file is not None:
                    files[f"/hands/{file.name}"] = (file.read_bytes(), "image/svg+xml")
        return files

    def _content(self) -> dict[str, Any]:
        grammar = self._grammar
        drawn = [token for token in grammar.tokens if drawing_file(token) is not None]
        return {
            "tokens": {token: TOKEN_NAMES.get(token, "") for token in grammar.tokens},
            "drawn": drawn,
            "words": [{"word": word, "pairs": pairs} for word, pairs in pairs_by_word(grammar).items()],
            "said": list(form_lines(grammar)),
            "note": f"{MIRROR_NOTE}; {hold_note(grammar)}",
        }
