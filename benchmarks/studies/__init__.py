"""Trainings that tell what decides, and what is compared with."""
