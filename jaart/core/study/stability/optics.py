"""Rows 47 to 49 and 66: refraction at its limits, and lights at or in the surface."""

from __future__ import annotations
