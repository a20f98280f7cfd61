"""Grammar files: read, checked, compiled."""
