"""JSON schemas of campaign and design files, so that an editor completes, explains and refuses what is written."""
