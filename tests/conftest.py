"""What all tests share: the measured data, where it is there, and how hypothesis searches."""

from __future__ import annotations

import os
import signal

os.environ["JAART_CALL_KERNELS"] = "1"  # before any kernel is imported: tests call those that are not entries, too

from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import settings

if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:  # a shell's background job ignores it, and so does what it starts
    signal.signal(signal.SIGINT, signal.default_int_handler)

# The same examples each time: a change that fails was made by a person, not by chance.
settings.register_profile("jaart", deadline=None, derandomize=True)
settings.load_profile("jaart")


@pytest.fixture(scope="session")
def data() -> Callable[[str], Path]:
    """Path of a file of the measured data; the test is skipped where it is absent.

    The folder is named by JAART_DATA, or lies at ../shared/data beside the checkout.
    """
    beside = Path(__file__).resolve().parents[2] / "shared" / "data"
    folder = Path(os.environ.get("JAART_DATA", beside))

    def find(name: str) -> Path:
        if not (folder / name).is_file():
            pytest.skip(f"no {name} in {folder}")
        return folder / name

    return find
