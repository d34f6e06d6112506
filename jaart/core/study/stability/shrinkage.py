"""Rows 8 to 11: dense spheres, cylinders and slabs, whose surface is known in closed form."""

from __future__ import annotations
