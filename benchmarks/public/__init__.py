"""Public sets of hands in whole pictures, read as they are published, for the tables of real divers."""
