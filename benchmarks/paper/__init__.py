"""The paper's own way, to measure progress against: region selection, bank of contours, network."""
