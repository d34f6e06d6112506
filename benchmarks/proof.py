"""What a proof of every miss costs, and how many rays it leaves undecided."""

from __future__ import annotations

import jaart

SIZE = (128, 128)
SCENES = (("splash", {"border": "closed"}), ("splash", {"weight": "wendland"}), ("standard", {}),
          ("standard", {"neighbourhood": "ball"}), ("bumpy", {"normal": "surfel"}))


def main() -> None:
    print(f"tangent surface, safe search, {SIZE[0]}x{SIZE[1]} rays: evaluations a ray without and with proof")
    print(f"{'scene':9} {'':20} {'hits':>6} {'missed':>7} {'undecided':>10} {'without':>8} {'with':>6} {'most':>6}")
    for name, values in SCENES:
        scene = jaart.load(name)
        settings = jaart.Settings(method="tangent", search="safe", **values)
        free, proven = (jaart.render(scene, settings.replace(proof=proof), size=SIZE) for proof in (False, True))
        assert (free.hit == proven.hit).all()
        words = " ".join(f"{key}={value}" for key, value in values.items())
        undecided = proven.counts().get("undecided", 0)
        print(f"{name:9} {words:20} {proven.hit.sum():6} {(~proven.hit).sum():7} {undecided:10} "
              f"{free.evaluations.mean():8.2f} {proven.evaluations.mean():6.2f} {proven.evaluations.max():6}")


if __name__ == "__main__":
    main()
