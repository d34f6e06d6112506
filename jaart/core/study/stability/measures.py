"""Rows 67 to 70: what is measured where nothing can be, and solids below the resolution."""

from __future__ import annotations
