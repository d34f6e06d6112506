"""Make the reference: `python -m tests.reference.make` writes rays.json beside this file, in minutes."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from tests.reference import scenes
from tests.reference.rays import Ray, rays
from tests.reference.scenes import Surfels, written
from tests.reference.tangent import MP
from tests.reference.tracer import Tracer

FILE = Path(__file__).with_name("rays.json")
#: Digits that are written.
STORED = 40


def main() -> None:
    surfels = {name: scenes.made(name) for name in scenes.NAMES}
    kept = {name: {"points": written(s.points), "normals": written(s.normals)} for name, s in surfels.items()}
    found = [row(ray, surfels) for ray in rays(surfels)]
    FILE.write_text(json.dumps({"scenes": kept, "rays": found}, indent=0) + "\n")
    hits = sum(ray["hit"] is not None for ray in found)
    print(f"{len(found)} rays, {hits} of them hit: {FILE}")


def row(ray: Ray, surfels: dict[str, Surfels]) -> dict[str, Any]:
    """A ray and its answer as the file keeps them; numbers of the answer are decimal."""
    return {"stratum": ray.stratum, "scene": ray.scene, "normal": ray.normal,
            "margin": None if ray.margin != ray.margin else f"{ray.margin:.6e}",
            "origin": written([ray.o])[0], "direction": written([ray.d])[0],
            "hit": answer(Tracer(surfels[ray.scene].surface(ray.scene, ray.normal)), ray)}


def answer(tracer: Tracer, ray: Ray) -> dict[str, str] | None:
    """t, the normal, the off-centre value and f's slope along the ray, to 40 digits; None for a miss."""
    hit = tracer.hit(ray.o, ray.d)
    if hit is None:
        return None
    return {"t": digits(hit.t), "n": " ".join(digits(c) for c in hit.n), "off": digits(hit.off),
            "slope": digits(hit.slope)}


def digits(number: Any) -> str:
    """A number with all its stored digits."""
    text: str = MP.nstr(number, STORED, strip_zeros=False)
    return text


if __name__ == "__main__":
    main()
