"""`lightgesture evaluate`."""
