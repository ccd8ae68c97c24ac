"""Names of the normal contact models and their numbers in the kernels.

In a file of their own: kernels are compiled anew where a file changes that they import, and the
descriptions that choose a model by its name change oftener than the models do.
"""

NORMAL_MODELS = {
    "hertz": 0, "hertz-local": 1, "virtual-penetration": 2, "strips": 3, "ritz": 4, "energy": 5,
}  # fmt: skip
