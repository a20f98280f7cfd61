"""Pictures to AprilTags: their ids, their corners and how clearly they stand out."""
