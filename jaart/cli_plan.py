"""The command that says what a scene needs and what it does not."""

from __future__ import annotations

import json
import math
from typing import TYPE_CHECKING, Annotated, Any

import typer

from jaart import cli_arguments as typed

if TYPE_CHECKING:
    from jaart.core.plan import Plan, Value
    from jaart.core.scene import Scene
    from jaart.core.settings import Settings
    from jaart.core.stage import Stage

AsJson = Annotated[bool, typer.Option("--json", help="The same for programs.")]


def made(scene: Scene, settings: Settings, camera: list[str], size: tuple[int, int]) -> Plan:
    """The plan of a picture of that size from a camera as it was typed."""
    from jaart.core.plan import plan

    return plan(scene, settings, typed.camera(camera, scene, settings, size), size)


def text(made: Plan, as_json: bool) -> str:
    """A plan for people, or for programs."""
    return json.dumps(record(made), indent=1, ensure_ascii=False) if as_json else table(made)


def record(made: Plan) -> dict[str, Any]:
    """A plan in plain numbers and words; a value without end is null."""
    return {
        "source": made.source, "kind": made.kind,
        "stages": [{"name": one.name, "runs": one.runs, "reason": one.reason, "settings": made.deciding(one)}
                   for one in made.stages],
        "values": [{"name": one.name, "value": _finite(one.value), "unit": one.unit, "from": one.origin}
                   for one in made.values],
    }


def table(made: Plan) -> str:
    """A plan in three lists: what runs, what is left out, what the settings came to."""
    width = max(len(name) for name in (*(s.name for s in made.stages), *(v.name for v in made.values))) + 2
    return "\n".join([
        f"{made.source} ({made.kind})",
        "runs", *(_stage(made, one, width) for one in made.runs),
        "left out", *(_stage(made, one, width) for one in made.left_out),
        "values", *(_value(one, width) for one in made.values)])


def _stage(made: Plan, one: Stage, width: int) -> str:
    deciding = ", ".join(f"{name} = {value}" for name, value in made.deciding(one).items())
    return f"  {one.name:<{width}}{one.reason}{f' ({deciding})' if deciding else ''}"


def _value(one: Value, width: int) -> str:
    number = one.value if isinstance(one.value, str) else "none" if math.isinf(one.value) else f"{one.value:.6g}"
    unit = f" {one.unit}" if one.unit and number != "none" else ""
    return f"  {one.name:<{width}}{number}{unit} ({one.origin})"


def _finite(value: Any) -> Any:
    return None if isinstance(value, float) and math.isinf(value) else value
