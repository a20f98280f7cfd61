"""The selector of hands: pictures, trees, contour bank."""
