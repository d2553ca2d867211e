"""From YAML with positions to plain data that remembers where everything stood."""
