"""The text of a sentence as it grows, against what its words spell."""

from hypothesis import example, given, settings
from hypothesis import strategies as st

from lightgesture.fsm.language.forms import spell
from lightgesture.fsm.rules.dwell import Hold
from lightgesture.fsm.sentence import Sentence

HOLD = Hold(pair=("a", "a"), frames=3, confidence=0.9, first_frame=4, first_time_s=0.1)
SIGNED = st.lists(st.sampled_from(["0", "1", "5", "AND", "STOP", "PARAM 3", "SNAP"]), max_size=12)


@given(SIGNED, st.sampled_from(["AND", None]))
@example(["5", "AND", "0", "0"], "AND")
@example(["0", "AND", "5"], "AND")
@example(["0", "0", "SNAP", "0", "1"], "AND")
@example(["PARAM 3", "5"], "AND")
@settings(max_examples=200, deadline=None)
def test_a_sentence_grows_to_what_its_words_spell(signed, join):
    sentence = Sentence(start_frame=0, start_time_s=0.0, touched_s=0.0)
    words = ["STOP", "HOVER"]
    # The table lets the joining word stand between digits alone.
    for word, after in zip(signed, [*signed, ""][1:], strict=True):
        is_between = words[-1].isdigit() and after.isdigit()
        if word != "AND" or (join and is_between):
            words.append(word)
    for count, word in enumerate(words, 1):
        sentence.add(word, HOLD, 0, 0.0, join)
        assert sentence.text == spell(words[:count], join)
