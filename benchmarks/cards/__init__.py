"""Cards and moved cards: the suite of sentences, tags against size and blur, and the study of three ways."""
