"""The track: how it lies (layout) and how far it lies off that (irregularity); pure numpy."""
