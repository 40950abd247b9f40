#!/usr/bin/env python3
"""Breaks the tensile specimen and exports it in every format: export_run.py CLEAVE SCENE FOLDER."""

import shutil
import subprocess
import sys

cleave, scene, folder = sys.argv[1:]
shutil.rmtree(folder, ignore_errors=True)
subprocess.run([cleave, "run", scene, "--out", folder], check=True)
for export in ("vtu", "vtu-volume", "ply", "obj", "bake-pc2", "bake-mdd", "glb", "usda"):
  options = ["--rate", "24"] if export in ("bake-mdd", "glb", "usda") else []
  subprocess.run([cleave, "export", folder, "--format", export, *options], check=True)
