"""The line that a command fails with."""

from pathlib import Path

from jaart.__main__ import main

SMALL = ["--size", "40x30"]


def fails(capsys, status, *arguments):
    """The one line on stderr of a command that ends with that status, and leaves no file."""
    before = set(Path().iterdir())
    assert main(list(arguments)) == status
    out, err = capsys.readouterr()
    assert out == ""
    assert set(Path().iterdir()) == before
    lines = [line for line in err.splitlines() if not line.startswith("jaart: note: ")]
    assert len(lines) == 1 and lines[0].startswith("jaart: ")
    return lines[0]
