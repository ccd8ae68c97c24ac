"""The type of arrays in signatures."""

import numpy as np

Array = np.ndarray
