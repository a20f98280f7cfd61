"""Hours of generated video at full speed: memory, handles, threads and speed over time, and results that stay right."""
