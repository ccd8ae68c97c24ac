"""Readers and writers of profile files, one module a format; see `raw` for their interface."""
