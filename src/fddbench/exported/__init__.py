"""A detector as C for a flight computer: written block by block, with a self-test that travels with it."""
