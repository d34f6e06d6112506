"""What can be set: every parameter by group, one of them, one group, or a preset."""

from __future__ import annotations

import difflib
import textwrap
from collections.abc import Iterable

from jaart.cli_options import DEFAULT_PRESET
from jaart.core.errors import SettingsError
from jaart.core.parameter import KINDS, Parameter, shown
from jaart.core.settings import PARAMETERS, PRESETS, Settings

#: Characters of a line, and of the names before what is said of them.
_WIDTH, _NAMES = 100, 18


def text(name: str | None = None) -> str:
    """All parameters and presets, or what a name stands for. Raises SettingsError for a name of nothing."""
    groups = _groups()
    if name is None:
        return "\n\n".join([*(_group(title, held) for title, held in groups.items()), _presets(PRESETS)])
    if name in PARAMETERS:
        return _parameter(PARAMETERS[name])
    if name in PRESETS:
        return _presets([name])
    for title, held in groups.items():
        if title.lower() == name.lower():
            return _group(title, held)
    close = difflib.get_close_matches(name, [*PARAMETERS, *PRESETS, *(t.lower() for t in groups)], n=1)
    hint = f"did you mean {close[0]}?" if close else "jaart settings lists them"
    raise SettingsError(f"no setting, group or preset is called {name!r}; {hint}")


def _groups() -> dict[str, list[Parameter]]:
    groups: dict[str, list[Parameter]] = {}
    for about in PARAMETERS.values():
        groups.setdefault(about.group, []).append(about)
    return groups


def _group(title: str, held: list[Parameter]) -> str:
    return "\n".join([title, *(_parameter(about) for about in held)])


def _parameter(about: Parameter) -> str:
    """Name and default, what may be typed, and what it means."""
    unit = f", in {'cells or cloud units' if about.unit == 'units' else about.unit}" if about.unit else ""
    first = PRESETS[DEFAULT_PRESET].get(about.name)
    instead = "" if first is None else f" ({shown(first)} in the preset {DEFAULT_PRESET})"
    lines = [f"default {shown(getattr(Settings(), about.name))}{instead}; {about.expected}{unit}"]
    if about.scenes != KINDS:
        lines.append(f"for a {' or a '.join(about.scenes)} only")
    source = about.source.replace(" ", "\N{NO-BREAK SPACE}")  # it is not torn apart
    lines.append(f"{about.help} {source}".rstrip())
    return _beside(about.name, lines)


def _presets(names: Iterable[str]) -> str:
    return "\n".join(["Presets", *(_beside(name, [_values(name)]) for name in names)])


def _values(name: str) -> str:
    values = [f"{k}={shown(v)}" for k, v in PRESETS[name].items()]
    return " ".join(values) if values else "every setting at its default"


def _beside(name: str, lines: list[str]) -> str:
    """A name with lines beside it, wrapped."""
    wrapped = [part for line in lines for part in textwrap.wrap(line, _WIDTH - _NAMES, break_on_hyphens=False)]
    first = f"  {name:<{_NAMES - 2}}{wrapped[0]}"
    return "\n".join([first, *(" " * _NAMES + line for line in wrapped[1:])]).replace("\N{NO-BREAK SPACE}", " ")
