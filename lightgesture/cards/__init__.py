"""Cards, each a tag that says a word: read one at a time, or moved in pairs; printed as a book."""

from lightgesture.cards.opening import FrontEndName, language_of_cards, make_card_reader

__all__ = ["FrontEndName", "language_of_cards", "make_card_reader"]
