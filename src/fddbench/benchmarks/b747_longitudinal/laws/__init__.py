"""Laws of the Boeing 747: files of numbers, and the block that flies them."""
