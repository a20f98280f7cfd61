"""The house in figures: `python -m lightgesture.benchmarks.census`."""
