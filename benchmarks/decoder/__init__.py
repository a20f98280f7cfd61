"""The decoder alone: its time, its peers, and what misreadings do to it."""
