"""Grammar files in words and pictures."""
