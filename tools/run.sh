#!/usr/bin/env bash
# run.sh SCENE: the window; without a display, its picture and the picked ray's plots as files.
set -euo pipefail
cd "$(dirname "$0")/.."

if [ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ]; then
    tools/system_libraries.sh window
    exec .venv/bin/jaart gui "$1"
fi
echo "No display (neither DISPLAY nor WAYLAND_DISPLAY is set): rendering to files instead of opening the window."
exec .venv/bin/jaart preview "$1" --output out
