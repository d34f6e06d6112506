"""What a parameter is: declared once, it gives the form, the command line, validation and help."""

from __future__ import annotations

import dataclasses
import math
import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

from jaart.core.errors import SettingsError

Kind = Literal["choice", "number", "integer", "flag", "length", "vector", "vectors"]
Value = Any

#: Stages of the computation in their order; a parameter names the first one it enters.
STAGES = ("levels", "surfels", "neighbours", "rays", "trace", "shade")

#: Kinds of scenes.
KINDS = ("lattice", "model", "cloud")

_LENGTH = re.compile(r"^\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*([ds]?)\s*$")


@dataclass(frozen=True)
class Length:
    """A length in scene units, as a fraction of the diagonal ("d") or a multiple of the spacing ("s")."""

    value: float
    unit: Literal["", "d", "s"] = ""

    def __str__(self) -> str:
        return f"{self.value:g}{self.unit}"

    def resolve(self, diagonal: float, spacing: float) -> float:
        """The length in cells or cloud units."""
        return self.value * {"": 1.0, "d": diagonal, "s": spacing}[self.unit]


@dataclass(frozen=True)
class Parameter:
    """One setting.

    name: as typed after --set; kind: how it is entered; default: its value when nobody says;
    group: its heading in the form; label, help: for people; unit: "" when it has none;
    source: the equation it enters; stage: the first stage that uses it (see STAGES);
    choices: of a choice, or words that stand for a value; low, high: bounds (low is excluded when
    open_low); step: of a slider; when: whether the setting has a meaning beside the others; needs: which
    others these are, in words; scenes: the kinds of scenes in which it has one.
    """

    name: str
    kind: Kind
    default: Value
    group: str
    label: str
    help: str
    stage: str
    unit: str = ""
    source: str = ""
    choices: tuple[str, ...] = ()
    low: float = -math.inf
    high: float = math.inf
    open_low: bool = False
    step: float = 0.0
    when: Callable[[Any], bool] | None = None
    needs: str = ""
    scenes: tuple[str, ...] = KINDS

    def check(self, value: Value) -> Value:
        """The value in its own type. Raises SettingsError, naming the parameter, when it cannot be."""
        if isinstance(value, str) and value in self.choices:
            return value
        try:
            return _CHECKS[self.kind](self, value)
        except (TypeError, ValueError, OverflowError):
            shown = value if isinstance(value, Length) else repr(value)
            raise SettingsError(f"{self.name} = {shown}: expected {self.expected}") from None

    @property
    def expected(self) -> str:
        """What may be typed, in words."""
        words = {"flag": "true or false", "vector": "x,y,z",
                 "vectors": "x,y,z or several of them apart by ;", "integer": "a whole number",
                 "number": "a finite number", "choice": "",
                 "length": "a finite number"}[self.kind]
        bounds = []
        if self.low > -math.inf:
            bounds.append(f"{'>' if self.open_low else '>='} {self.low:g}")
        if self.high < math.inf:
            bounds.append(f"<= {self.high:g}")
        number = " ".join(w for w in (words, " and ".join(bounds)) if w)
        if self.kind == "length":
            first = f"{' or '.join(self.choices)}, or " if self.choices else ""
            return f"{first}{number}, alone or followed by d (diagonals) or s (spacings)"
        return " or ".join(w for w in (number, *self.choices) if w)

    def matters(self, settings: Any) -> bool:
        """Whether the parameter has a meaning beside the others."""
        return self.when is None or self.when(settings)


def parameter(kind: Kind, default: Value, **about: Any) -> Any:
    """A dataclass field that carries its Parameter; the name is filled in by `declared`."""
    return dataclasses.field(default=default, metadata={"kind": kind, **about})


def declared(record: type) -> dict[str, Parameter]:
    """The parameters of a settings class, in the order they are declared."""
    return {f.name: Parameter(name=f.name, default=f.default, **f.metadata)
            for f in dataclasses.fields(record)}


def shown(value: Value) -> str:
    """A value as it may be typed."""
    if isinstance(value, bool):
        return str(value).lower()
    return f"{value:g}" if isinstance(value, float) else str(value)


def _plain(text: Value) -> Value:
    """A value that is no text with an underscore, which Python would read as a number."""
    if isinstance(text, str) and "_" in text:
        raise ValueError
    return text


def _in_range(p: Parameter, number: float) -> float:
    below = number <= p.low if p.open_low else number < p.low
    if not math.isfinite(number) or below or number > p.high:
        raise ValueError
    return number


def _check_choice(p: Parameter, value: Value) -> str:
    if isinstance(value, bool) or str(value) not in p.choices:
        raise ValueError
    return str(value)


def _check_number(p: Parameter, value: Value) -> float:
    if isinstance(value, bool):
        raise TypeError
    return _in_range(p, float(_plain(value)))


def _check_integer(p: Parameter, value: Value) -> int:
    if isinstance(value, bool) or (isinstance(value, float) and value != int(value)):
        raise TypeError
    return int(_in_range(p, int(_plain(value))))


def _check_flag(p: Parameter, value: Value) -> bool:
    words = {"true": True, "on": True, "yes": True, "false": False, "off": False, "no": False}
    if isinstance(value, bool):
        return value
    if str(value).lower() not in words:
        raise ValueError
    return words[str(value).lower()]


def _check_length(p: Parameter, value: Value) -> Length:
    if isinstance(value, str):
        match = _LENGTH.match(value)
        if match is None:
            raise ValueError
        value = Length(float(match[1]), match[2])  # type: ignore[arg-type]
    length: Length = value if isinstance(value, Length) else Length(float(value))
    _in_range(p, length.value)
    return length


def _check_vector(p: Parameter, value: Value) -> tuple[float, float, float]:
    numbers = value.split(",") if isinstance(value, str) else list(value)
    if len(numbers) != 3:
        raise ValueError
    x, y, z = (_in_range(p, float(_plain(n))) for n in numbers)
    return x, y, z


def _check_vectors(p: Parameter, value: Value) -> tuple[tuple[float, float, float], ...]:
    several: list[Any] = value.split(";") if isinstance(value, str) else list(value)
    if several and isinstance(several[0], int | float):
        several = [several]
    if not several:
        raise ValueError
    return tuple(_check_vector(p, one) for one in several)


_CHECKS: dict[str, Callable[[Parameter, Value], Value]] = {
    "choice": _check_choice, "number": _check_number, "integer": _check_integer,
    "flag": _check_flag, "length": _check_length, "vector": _check_vector,
    "vectors": _check_vectors,
}
