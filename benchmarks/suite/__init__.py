"""The whole chain on clips of a signing diver with known truth."""
