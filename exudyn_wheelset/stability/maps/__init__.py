"""Maps of stability: curves in two parameters, and the probability of hunting."""
