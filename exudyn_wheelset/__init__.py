"""Profiled wheels on profiled rails for the multibody engine Exudyn."""
