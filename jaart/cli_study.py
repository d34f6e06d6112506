"""The command that lets the program examine itself."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from jaart import cli_arguments as typed
from jaart.core.errors import FileError

if TYPE_CHECKING:
    from collections.abc import Callable

    from jaart.core.study.stability.case import Result

#: The studies there are.
NAMES = ("stability",)

StudyName = Annotated[str, typer.Argument(metavar="NAME", help=f"Which study: {', '.join(NAMES)}.")]
Quick = Annotated[bool, typer.Option("--quick", help="Fewer rays where a case takes many.")]
Folder = Annotated[Path, typer.Option("--output", "-o", metavar="DIR", help="For its tables; made when absent.")]


def check(name: str, output: Path) -> None:
    """Refuse, before any work, a study that there is not and a folder that cannot be."""
    if name not in NAMES:
        raise typed.usage("NAME", f"{name!r}: expected {' or '.join(NAMES)}")
    if output.exists() and not output.is_dir():
        raise FileError(output, "is a file; expected a folder")


def run_stability(output: Path, quick: bool, progress: Callable[[int, int], None] | None) -> int:
    """Run the stiff and extreme cases, print their table and save it; the exit status is 1 where one does not hold."""
    from jaart.core.study.stability.study import holding, save, stability

    results = stability(quick, progress)
    for result in results:
        print(_lines(result))
    for path in save(results, output):
        print(f"wrote {path}")
    print(f"{holding(results)} of {len(results)} cases hold")
    return 0 if holding(results) == len(results) else 1


def _lines(result: Result) -> str:
    """A case of the table: its number, verdict and input, what was expected, and what came."""
    return (f"{result.number:>3}  {result.verdict:<7}  {result.title}\n"
            f"              expected  {result.expected}\n              got       {result.got}")
