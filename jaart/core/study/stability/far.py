"""Rows 1 to 7: h far below or above all distances."""

from __future__ import annotations
