"""What can fly on the yaw-rate benchmark, a file each."""
