#!/usr/bin/env bash
# system_libraries.sh window|test|peers: what pip cannot bring. Quick when all is there; else apt-get as root.
set -euo pipefail
cd "$(dirname "$0")/.."
. tools/apt.sh

[ "$(uname -s)" = Linux ] || exit 0
packages=$(.venv/bin/python -I tools/missing_packages.py "$1")
if [ "$1" = test ]; then
    command -v xvfb-run >/dev/null || packages="$packages xvfb"
    command -v xauth >/dev/null || packages="$packages xauth"
fi
# shellcheck disable=SC2086  # one word for each package
[ -z "${packages// /}" ] || install_packages "system libraries" $packages
