"""From tokens to instructions."""
