"""Rows 12 to 16: sheets close to each other, and a single surfel."""

from __future__ import annotations
