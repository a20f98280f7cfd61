"""Nets: architectures, samples, training, quantisation."""
