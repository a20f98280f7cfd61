"""Where the hands of a frame may be: learned and classical choice."""
