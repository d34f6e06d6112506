"""Rows 25 to 29: coordinates far from the origin, tiny and huge ones, and numbers of neighbours."""

from __future__ import annotations
