"""Rows 32 to 38: rays along a plane, from within, from the surface itself, and without a direction."""

from __future__ import annotations
