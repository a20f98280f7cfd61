"""Training data from real pictures: never imported on the decode path."""
