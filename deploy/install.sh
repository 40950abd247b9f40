#!/usr/bin/env bash
# Installs what building and running Cleave needs on Debian 12, and nothing that is there already; with
# --benchmarks also what core_stream_bench compares with. Usage: deploy/install.sh [--benchmarks]
set -euo pipefail

packages=(
  g++ cmake ninja-build ccache pkg-config    # build
  libgrpc++-dev protobuf-compiler-grpc libprotobuf-dev protobuf-compiler
  libabsl-dev libeigen3-dev libtbb-dev libzstd-dev libssl-dev libxxhash-dev
  libpugixml-dev zlib1g-dev                 # VTU meshes: XML, compressed arrays
  libcli11-dev                              # verbs and help of the command line
  libassimp-dev                             # surfaces: OBJ, PLY, STL
  libembree-dev libpng-dev                  # pictures, also of the server: rays, stills
  libwebp-dev                               # animations
  libjpeg-dev                               # pictures that are drawn on bodies
  python3 python3-grpcio python3-protobuf python3-numpy python3-zstandard    # the Python client
  libgtest-dev libgmock-dev                 # tests
)
case "${1:-}" in
  '') ;;
  --benchmarks) packages+=(libdraco-dev libmeshoptimizer-dev) ;;
  *) echo "usage: deploy/install.sh [--benchmarks]" >&2; exit 2 ;;
esac

missing=()
for package in "${packages[@]}"; do
  dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

echo "Installing: ${missing[*]}"
sudo=()
[ "$(id -u)" -eq 0 ] || sudo=(sudo)
"${sudo[@]}" apt-get update -qq
"${sudo[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
