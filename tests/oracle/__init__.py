"""The slow oracle: every formula as its source has it, in plain Python, for the fast kernels to be held against.

Nothing here is shared with the package. A point or normal is a sequence of three floats; lengths are in the scene's
own units. Sums are correctly rounded (`math.fsum`) and taken about x, and no weight underflows: what is slow here
need not be inexact. None stands for "undefined", never NaN.

weights, neighbourhoods, normals, surfaces, projection, cylinder, energies: one formula a function.
gradients: the truth in 50 digits. searches: the plain way to a root or a minimum along a ray.
samples: clouds whose surfaces are known exactly. vectors: what the others share.
"""
