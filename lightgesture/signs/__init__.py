"""What a diver signs: words and sentences as pairs of drawn hands, told in a terminal, on paper and to a browser."""
