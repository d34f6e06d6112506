"""Rows 17 to 24: clouds with too little in them, and points that are none."""

from __future__ import annotations
