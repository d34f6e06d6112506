"""What a declared parameter accepts, refuses and says."""

from __future__ import annotations

import math
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from jaart.core.errors import SettingsError
from jaart.core.parameter import Kind, Length, Parameter


def make(kind: Kind, **about: Any) -> Parameter:
    """A parameter called p."""
    return Parameter(name="p", kind=kind, default=None, group="", label="", help="", stage="rays", **about)


@pytest.mark.parametrize(("kind", "text", "value"), [
    ("number", "0.25", 0.25), ("number", " 1e-3 ", 1e-3), ("number", 2, 2.0),
    ("integer", "12", 12), ("integer", 12.0, 12), ("flag", "Yes", True), ("flag", "off", False), ("flag", True, True),
    ("length", "0.004d", Length(0.004, "d")), ("length", "2 s", Length(2, "s")), ("length", ".5", Length(0.5)),
    ("length", 3, Length(3.0)), ("length", Length(1, "d"), Length(1, "d")),
    ("vector", "1, 2,-3e1", (1.0, 2.0, -30.0)), ("vector", [0, 1, 2], (0.0, 1.0, 2.0)),
])
def test_accepts(kind: Kind, text: object, value: object) -> None:
    found = make(kind).check(text)
    assert found == value and type(found) is type(value)


@pytest.mark.parametrize(("kind", "text"), [
    ("number", "nan"), ("number", "inf"), ("number", "1,5"), ("number", ""), ("number", None), ("number", True),
    ("integer", "1.5"), ("integer", 1.5), ("integer", math.inf), ("integer", False),
    ("flag", "2"), ("flag", 1.0), ("length", "3q"), ("length", "nan"), ("length", Length(math.inf)), ("length", "d"),
    ("vector", "1,2"), ("vector", "1,2,x"), ("vector", 5), ("vector", (0, 0, math.nan)), ("choice", "none"),
])
def test_refuses_by_name(kind: Kind, text: object) -> None:
    with pytest.raises(SettingsError, match=r"^p = .*: expected "):
        make(kind, choices=("first", "second")).check(text)


def test_bounds_are_kept_and_named() -> None:
    p = make("number", low=0, high=1, open_low=True)
    assert p.check("1") == 1.0
    for outside in ("0", "-1", "1.0000001"):
        with pytest.raises(SettingsError, match=r"> 0 and <= 1"):
            p.check(outside)
    assert make("length", low=0.5).check("0.5s") == Length(0.5, "s")
    with pytest.raises(SettingsError, match=r">= 0.5"):
        make("length", low=0.5).check("0.49")


def test_what_a_length_may_be_is_said_in_order() -> None:
    assert make("length", choices=("auto", "none"), low=0, high=5, open_low=True).expected == (
        "auto or none, or a finite number > 0 and <= 5, alone or followed by d (diagonals) or s (spacings)")
    assert make("length").expected == "a finite number, alone or followed by d (diagonals) or s (spacings)"


def test_a_word_may_stand_for_a_value() -> None:
    assert make("integer", choices=("file",)).check("file") == "file"
    assert make("choice", choices=("6", "26")).check("26") == "26"
    with pytest.raises(SettingsError, match="expected 6 or 26"):
        make("choice", choices=("6", "26")).check("7")


def test_huge_numbers_are_refused_in_words() -> None:
    with pytest.raises(SettingsError):
        make("integer", high=100).check("1" + "0" * 400)
    with pytest.raises(SettingsError):
        make("number").check(10 ** 400)


@settings(max_examples=40, deadline=None)
@given(st.floats(allow_nan=False, allow_infinity=False, min_value=0))
def test_a_length_is_read_back_from_its_text(value: float) -> None:
    short = float(f"{value:g}")
    for unit in ("", "d", "s"):
        assert make("length").check(str(Length(short, unit))) == Length(short, unit)


@settings(max_examples=40, deadline=None)
@given(st.text(max_size=12), st.sampled_from(["number", "integer", "flag", "length", "vector", "choice"]))
def test_any_text_is_a_value_or_a_settings_error(text: str, kind: Kind) -> None:
    try:
        value = make(kind, low=-5, high=5).check(text)
    except SettingsError:
        return
    numbers = value if isinstance(value, tuple) else (value.value if isinstance(value, Length) else value,)
    assert all(-5 <= n <= 5 for n in numbers)


def test_lengths_resolve_by_their_unit() -> None:
    assert [Length(2.0, u).resolve(diagonal=10, spacing=3) for u in ("", "d", "s")] == [2, 20, 6]
