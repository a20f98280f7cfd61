"""Hands found in whole frames and clips, whatever they show."""
