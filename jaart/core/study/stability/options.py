"""Rows 64 and 65: pictures and cameras that cannot be."""

from __future__ import annotations
