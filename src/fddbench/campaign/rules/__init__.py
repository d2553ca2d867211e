"""What a campaign file may say: keys, names, numbers that fit together, and the words for what is wrong."""
