"""Rows 39 to 43: rays through faces, edges and corners of the cells."""

from __future__ import annotations
