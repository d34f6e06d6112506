"""Rows 50 to 52: tolerances beyond the floor, too few steps, lists too short."""

from __future__ import annotations
