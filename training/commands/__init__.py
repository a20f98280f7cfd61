"""`lightgesture train`."""
