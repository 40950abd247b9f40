#!/usr/bin/env bash
# Installs what is missing, builds everything and runs all tests; then sends damaged requests, scenes
# and files to a build that reports every memory error and undefined behaviour.
set -euo pipefail
cd "$(dirname "$0")/.."
./deploy/install.sh

# Precompiled headers take a third off a build from scratch; a file that then lacks an include is found
# by tests/includes_test.py.
cmake --preset release -DCLEAVE_PRECOMPILE=ON >/dev/null
cmake --build --preset release
ctest --preset release --no-tests=error -j "$(nproc)"

cmake --preset asan -DCLEAVE_PRECOMPILE=ON >/dev/null
cmake --build --preset asan --target mutation_tests
ctest --preset asan --no-tests=error -L mutation -j "$(nproc)"
