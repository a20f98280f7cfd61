"""Accuracy, latency and peers."""
