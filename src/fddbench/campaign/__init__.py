"""From a YAML file to numbered, fully sampled cases."""
