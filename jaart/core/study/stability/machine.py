"""Rows 71 to 74: what compilers, threads and number formats do."""

from __future__ import annotations
