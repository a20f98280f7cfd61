"""Small int8 nets: their layout, files and run-times."""
