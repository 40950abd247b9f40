#!/usr/bin/env bash
# Installs what is missing, builds Cleave, and breaks a tensile specimen through the real programs:
# starts the gateway on a local socket, submits the bundled scene, streams its frames, and leaves the
# frame log, a ParaView series, pictures and a plot in out/.
set -euo pipefail
cd "$(dirname "$0")/.."

scene=tests/scenes/tensile_bar.scene.json
out=$PWD/out
bin=build/release

./deploy/install.sh
cmake --preset release -DCLEAVE_PRECOMPILE=ON >/dev/null
cmake --build --preset release --target cleave cleaved cleave-worker

rm -rf "$out"
mkdir -p "$out"
# A socket's path is short by law (107 bytes), so it does not go below the project.
run_dir=$(mktemp -d)
socket=unix:$run_dir/cleaved.sock
"$bin/server/gateway/cleaved" --listen "$socket" --data "$out/server" 2>"$out/cleaved.log" &
server=$!
finish() {
  kill "$server" 2>/dev/null && wait "$server" || true
  rm -rf "$run_dir"
}
trap finish EXIT

cleave=$bin/client/cli/cleave
"$cleave" run "$scene" --server "$socket" --out "$out"
"$cleave" export "$out" --format vtu
"$cleave" preview "$out" --sheet --animation
"$cleave" export "$out" --format plot --to "$out" --reports "$out"/server/sessions/*/reports.jsonl

cat <<MSG

The specimen broke. What it left in $out:
  contact_sheet.png    the break at a glance
  preview.webp         the break as an animation; any browser opens it
  plot.svg             pull force and broken edges over time
  vtu/cleave.pvd       the series for ParaView
  frames.clv           the frame log, as it was streamed
  server/              the session as the server keeps it: journal, checkpoints, reports
MSG
