#!/usr/bin/env bash
# Installs the programs that the test lane "tools" opens exported files with: Blender, VTK's readers, the
# Khronos glTF validator, three.js and tinyusdz. They are called as programs, and nothing of Cleave links them.
# About 0.8 GB. Usage: deploy/install_tools.sh [FOLDER for the packages of npm, default build/tools]
set -euo pipefail
cd "$(dirname "$0")/.."
folder=${1:-build/tools}

sudo=()
[ "$(id -u)" -eq 0 ] || sudo=(sudo)
packages=(
  blender libegl1 libegl-mesa0    # Blender draws without a display through EGL
  python3-numpy                   # Blender's glTF importer
  python3-vtk9
)
command -v node >/dev/null || packages+=(nodejs)
command -v npm >/dev/null || packages+=(npm)
missing=()
for package in "${packages[@]}"; do
  dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
done
if [ ${#missing[@]} -gt 0 ]; then
  echo "Installing: ${missing[*]}"
  "${sudo[@]}" apt-get update -qq
  "${sudo[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
fi
mkdir -p "$folder"
npm install --silent --no-fund --no-audit --prefix "$folder" gltf-validator@2.0.0-dev.3.10 three@0.187.0 \
  tinyusdz@0.9.0-rc10
