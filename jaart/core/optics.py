"""Rays at a surface between two media: mirrored, refracted, and how the light is shared [T §2.1.2]."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

#: A radicand this little below zero is the critical angle itself, but for rounding.
_CRITICAL = 4 * float(np.finfo(np.float64).eps)
#: Squares of lengths in between keep all their digits.
_PLAIN = (1e-280, 1e280)


class Split(NamedTuple):
    """What becomes of N rays at a surface.

    reflected, refracted: unit directions (N, 3); reflectance: share of the light that is mirrored (N,),
    1 where all of it is (total internal reflection). There refracted is the mirrored direction too.
    """

    reflected: Array
    refracted: Array
    reflectance: Array


def dots(a: Array, b: Array) -> Array:
    """<a, b> of each row (N,)."""
    products: Array = np.einsum("ij,ij->i", a, b)
    return products


def unit(vectors: Array) -> Array:
    """Vectors (N, 3) of length 1, zeros where they have no length; neither tiny nor huge ones are lost."""
    with np.errstate(over="ignore", under="ignore"):
        squared = dots(vectors, vectors)
    if ((squared > _PLAIN[0]) & (squared < _PLAIN[1])).all():
        quick: Array = vectors / np.sqrt(squared)[:, None]
        return quick
    largest = np.abs(vectors).max(axis=1, keepdims=True)
    scaled: Array = np.divide(vectors, largest, out=np.zeros_like(vectors), where=largest > 0)
    length = np.sqrt(dots(scaled, scaled))[:, None]
    np.divide(scaled, length, out=scaled, where=length > 0)
    return scaled


def reflect(i: Array, n: Array) -> Array:
    """The mirrored rays r = i - 2<n, i>n, of unit length (N, 3) [T §2.1.2].

    i: unit directions of incidence (N, 3); n: normals (N, 3) of any side and, but for rounding, length 1.
    """
    n = unit(n)
    mirrored: Array = i - 2 * dots(n, i)[:, None] * n
    return unit(mirrored)


def split(i: Array, n: Array, eta: Array | float) -> Split:
    """Mirrored and refracted rays, and the share of each.

    i, n: as for reflect; eta: the refractive index of the medium the ray comes from over that of the medium
    beyond (N,), 1/1.33 on the way from air into water. Snell's law sin θt = eta sin θi with
    t = eta i + (eta cos θi - sqrt(1 - eta² sin² θi)) n [T §2.1.2]; Fresnel's equations for unpolarised light.
    The sine is that of the cross product, for 1 - cos² loses all digits of a steep ray.
    """
    i, n = unit(i), unit(n)
    eta = np.broadcast_to(np.asarray(eta, dtype=np.float64), len(i))
    facing = dots(n, i)
    n = n * -np.copysign(1.0, facing)[:, None]
    cos_i, sine = np.abs(facing), np.cross(i, n)
    radicand = 1.0 - eta * eta * dots(sine, sine)
    total = radicand < -_CRITICAL
    cos_t = np.sqrt(np.maximum(radicand, 0.0))
    through = unit(eta[:, None] * i + (eta * cos_i - cos_t)[:, None] * n)
    mirrored = reflect(i, n)
    share = np.where(total, 1.0, fresnel(cos_i, cos_t, eta))
    return Split(mirrored, np.where(total[:, None], mirrored, through), share)


def refract(i: Array, n: Array, eta: Array | float) -> tuple[Array, NDArray[np.bool_]]:
    """The refracted rays (N, 3) and where there are none, for all light is mirrored (N,); see `split`."""
    both = split(i, n, eta)
    return both.refracted, both.reflectance >= 1.0


def fresnel(cos_i: Array, cos_t: Array, eta: Array | float) -> Array:
    """The share of unpolarised light that is mirrored (N,), in [0, 1].

    cos_i, cos_t: cosines of the angles of incidence and refraction, 0 or more; eta: as in `split`. A ray
    along the surface is mirrored whole.
    """
    across = _share(eta * cos_i - cos_t, eta * cos_i + cos_t)
    along = _share(eta * cos_t - cos_i, eta * cos_t + cos_i)
    return 0.5 * (across + along)


def _share(difference: Array, total: Array) -> Array:
    """(difference / total)², 1 where both are 0."""
    ratio = np.divide(difference, total, out=np.ones_like(total), where=total > 0)
    share: Array = np.minimum(ratio * ratio, 1.0)
    return share
