"""Constants of nature, as the field rounds them."""

# Acceleration of gravity [m/s^2]: the value behind every axle load in the sources of this package.
GRAVITY = 9.81
