"""Pictures to learn from: composed, altered, lit and covered."""
