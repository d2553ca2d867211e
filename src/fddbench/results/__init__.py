"""Tables of results on disk: schema, shards, manifest, provenance."""
