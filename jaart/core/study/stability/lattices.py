"""Rows 53 to 63: thin, empty, full, wrong, huge and stretched lattices."""

from __future__ import annotations
