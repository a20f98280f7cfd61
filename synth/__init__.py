"""The synthetic diver: rendered hands, people, water and rooms with known truth, made by this package alone.

Nothing here is imported by the decoding path; it serves tests, training, benchmarks and the bundled clip.
"""
