#!/usr/bin/env bash
# Installs what is missing, builds everything and runs all tests; then sends damaged requests, scenes
# and files to a build that reports every memory error and undefined behaviour.
set -euo pipefail
cd "$(dirname "$0")/.."
./deploy/install.sh

# Both take much off a build from scratch. What a file then lacks of precompiled headers is found by
# tests/includes_test.py; what one outside of tests/ lacks of others, by compiling it alone here.
cmake --preset release -DCLEAVE_PRECOMPILE=ON -DCLEAVE_UNITY=tests >/dev/null
cmake --build --preset release
ctest --preset release --no-tests=error -j "$(nproc)"

cmake --preset asan -DCLEAVE_PRECOMPILE=ON -DCLEAVE_UNITY=all >/dev/null
cmake --build --preset asan --target mutation_tests
ctest --preset asan --no-tests=error -L mutation -j "$(nproc)"
