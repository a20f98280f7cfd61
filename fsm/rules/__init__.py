"""When a sign counts: dwell, and signs that nobody read."""
