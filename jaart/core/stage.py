"""A stage of the computation as a plan names it: whether it runs, and why."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Stage:
    """One stage.

    name: for people; runs: whether it is needed; reason: why, or why not; settings: names of those that decide, none
    where the scene alone does.
    """

    name: str
    runs: bool
    reason: str
    settings: tuple[str, ...] = ()


def stage(name: str, runs: bool, why: str, why_not: str, *settings: str) -> Stage:
    """A stage with the reason that holds."""
    return Stage(name, runs, why if runs else why_not, settings)
