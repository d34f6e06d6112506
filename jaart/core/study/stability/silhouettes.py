"""Rows 44 to 46: rays that graze the surface."""

from __future__ import annotations
