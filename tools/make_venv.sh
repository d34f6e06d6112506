#!/usr/bin/env bash
# Make .venv with a Python that is new enough, installing what Debian leaves out of it.
set -euo pipefail
cd "$(dirname "$0")/.."
. tools/apt.sh
python=${PYTHON:-python3}

command -v "$python" >/dev/null || install_packages "Python" python3 python3-venv
if ! "$python" -c 'import sys; sys.exit(sys.version_info < (3, 11))'; then
    echo "Jaart needs Python 3.11 or newer, and $python is $("$python" -V 2>&1); try: make PYTHON=python3.12" >&2
    exit 1
fi
if ! "$python" -c 'import ensurepip, venv' 2>/dev/null; then
    install_packages "the venv module" python3-venv
fi
[ -x .venv/bin/pip ] || "$python" -m venv --clear .venv
