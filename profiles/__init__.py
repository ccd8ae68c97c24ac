"""Profile files that come with the package, read with importlib.resources."""
