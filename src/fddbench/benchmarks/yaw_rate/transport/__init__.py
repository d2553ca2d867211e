"""The yaw-rate benchmark with six degrees of freedom: manoeuvres, laws with protections and holds, sensors, loop."""
