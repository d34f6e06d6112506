"""Rows 30 and 31: sums that are empty, and an energy where it is 0/0."""

from __future__ import annotations
