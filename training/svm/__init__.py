"""The support vector machine."""
