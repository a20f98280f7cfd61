"""Pictures of real divers, read by the product: hands found and read in whole frames and in given boxes."""
