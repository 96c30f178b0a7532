#!/usr/bin/env bash
# Checks pages in headless Chromium: hostile names, many grains, light, dark and as narrow as a phone. Needs Chromium and Python.
# Run folders given as arguments are checked too. With SHOTS=FOLDER pictures are kept.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
example() { cargo run --quiet -p granular-report --example "$@"; }
shots=(); [ -n "${SHOTS:-}" ] && shots=(--shots "$SHOTS")
example hostile_run "$work/hostile"
example large_run "$work/large" "${GRAINS:-100000}" "${FRAMES:-50}"
pages=()
for run in "$work/hostile" "$work/large" "$@"; do
    pages+=("$work/$(basename "$run").html")
    example write_page "${pages[-1]}" "$run"
done
if [ $# -gt 1 ]; then
    pages+=("$work/together.html")
    example write_page "${pages[-1]}" "$@"
fi
python3 "$here/browser.py" "${pages[@]}" --fps "${shots[@]}"
python3 "$here/browser.py" "${pages[@]}" --dark "${shots[@]}"
python3 "$here/browser.py" "${pages[@]}" --width 390 "${shots[@]}"
