"""From pixels to hand regions and numbers."""
