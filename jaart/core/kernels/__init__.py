"""The compiled kernels. They import math, numpy, numba and each other, nothing else."""
