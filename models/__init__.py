"""From numbers and patches to tokens."""
