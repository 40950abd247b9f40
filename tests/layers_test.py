#!/usr/bin/env python3
"""Holds every include of the project against the arrows between its folders.

CMake targets make a wrong call fail to link, but headers need no link; this closes the gap. Run with
no argument for the whole check; it also checks itself on includes that it must refuse.
"""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent

TOP_LEVEL = {
    "CMakeLists.txt", "CMakePresets.json", "README.md", "CHANGELOG.md", "CONTRIBUTING.md", "LICENSE",
    "proto", "server", "client", "core", "deploy", "tests",
}

# What a folder may include besides itself, core/base, the standard library and Abseil. A name ending
# in / is any header below it. The most specific folder of a file decides; folders are listed so that
# reading this table is reading the architecture.
POSIX = "<posix>"
ARROWS = {
    "core/base": ["tbb", "xxhash.h", "openssl", "nmmintrin.h", "immintrin.h"],
    "core/mesh": ["core/mesh", "Eigen"],
    "core/scene": ["core/scene", "core/mesh", "Eigen"],
    "core/material": ["core/material", "core/scene", "core/mesh", "Eigen"],
    "core/damage": ["core/damage", "core/mesh", "core/scene", "Eigen"],
    "core/contact": ["core/contact", "core/scene", "core/mesh", "Eigen"],
    "core/impurity": ["core/impurity", "core/contact", "core/scene", "core/mesh", "Eigen"],
    "core/model": ["core/model", "core/contact", "core/impurity", "core/damage", "core/material", "core/scene",
                   "core/mesh", "Eigen"],
    "core/probe": ["core/probe", "core/material", "core/damage", "core/scene", "core/mesh", "Eigen"],
    "core/solver": ["core/solver", "core/model", "core/damage", "core/material", "core/scene",
                    "core/mesh", "Eigen", "tbb", "immintrin.h"],
    "core/simulation": ["core/simulation", "core/solver", "core/model", "core/damage",
                        "core/material", "core/scene", "core/mesh", "Eigen", "tbb"],
    "core/surface": ["core/surface", "core/damage", "core/mesh", "Eigen"],
    # Pixels in memory, for both sides: the client's pictures and the server's of impurities. Embree casts
    # rays on the processor, libpng codes into a buffer; neither opens a file or asks for a display.
    "core/picture": ["core/picture", "core/mesh", "Eigen", "embree3", "png.h"],
    "core/stream": ["core/stream", "core/mesh", "zstd.h", "immintrin.h"],
    "proto/convert": ["proto/convert", "cleave", "google", "core/scene", "core/mesh", "core/stream",
                      "core/probe/probe.h", "core/model/impurity_preview.h",
                      "core/picture/impurity_picture.h"],
    "server/files": ["server/files", POSIX],
    "server/control": ["server/control", "server/files", "google", POSIX],
    "server/session": ["server/session", "server/files", "proto/convert", "cleave", "google", "core/scene",
                       "core/mesh", "core/stream", "core/simulation", POSIX],
    "server/worker": ["server/worker", "server/session", "server/control", "server/files",
                      "proto/convert", "cleave", "google",
                      "core/simulation", "core/stream", "core/scene", "core/mesh", "core/surface",
                      "spdlog", "tbb", POSIX],
    "server/gateway": ["server/gateway", "server/session", "server/control", "server/files",
                       "proto/convert", "cleave", "google",
                       "core/scene", "core/mesh", "core/stream", "core/model/footprint.h", "spdlog",
                       "zstd.h", POSIX],
    "server/gateway/rpc": ["server/gateway", "server/session", "server/files", "proto/convert", "cleave", "google",
                           "grpc", "grpcpp", "core/scene", "core/mesh", "core/stream",
                           "core/model/footprint.h", "core/model/impurity_preview.h", "core/impurity/drawing.h",
                           "core/picture", "spdlog", POSIX],
    "client/cpp": ["client/cpp", "proto/convert", "cleave", "google", "grpc", "grpcpp", "core/scene",
                   "core/mesh", "core/stream", "zstd.h", POSIX],
    "client/io": ["client/io", "proto/convert", "cleave", "google", "core/scene", "core/mesh",
                  "core/surface", "core/damage", "core/impurity", "core/picture", "core/stream", "Eigen",
                  "zlib.h", "zstd.h", "png.h", "jpeglib.h", "webp", "assimp", "pugixml.hpp", "tbb", POSIX],
    "client/cli": ["client/cli", "client/cpp", "client/io", "proto/convert", "cleave", "google",
                   "core/scene", "core/mesh", "core/surface", "core/picture", "core/stream", "core/probe", "CLI",
                   "core/model/impurity_preview.h", POSIX],
}
EVERYWHERE = ["core/base", "absl"]

POSIX_HEADERS = re.compile(
    r"^(sys/\w+|unistd|fcntl|signal|spawn|poll|errno|pthread|termios|dirent|netinet/\w+|arpa/\w+)\.h$")
# The core has no files, no console, no processes and no wall clock.
NOT_IN_CORE = {"fstream", "iostream", "filesystem", "cstdio", "stdio.h", "ctime", "random", "thread"}
# Where the core has threads and pages of memory from.
SOURCES_OF = {"core/base/parallel.cc": {"thread"}, "core/base/large_vector.cc": {"sys/mman.h"}}
INCLUDE = re.compile(r'^\s*#\s*include\s*(["<])([^">]+)[">]', re.MULTILINE)


def is_standard(name):
  return "/" not in name and not name.endswith((".h", ".hpp"))


def allowed(header, entries):
  for entry in entries + EVERYWHERE:
    if entry == "<posix>":
      if POSIX_HEADERS.match(header):
        return True
    elif header == entry or header.startswith(entry + "/"):
      return True
  return False


def folder_of(path):
  """The most specific folder of the table that holds `path`, or None."""
  best = None
  for folder in ARROWS:
    if path.startswith(folder + "/") and (best is None or len(folder) > len(best)):
      best = folder
  return best


def faults_of(path, text):
  """Why `text` may not stand at `path`: a list of sentences."""
  folder = folder_of(path)
  if folder is None:
    return [f"{path}: its folder is not in the table of arrows"]
  found = []
  for _, header in INCLUDE.findall(text):
    if is_standard(header):
      if (folder.startswith("core/") and header in NOT_IN_CORE and
          header not in SOURCES_OF.get(path, ())):
        found.append(f"{path}: <{header}> is not for the core")
    elif header in SOURCES_OF.get(path, ()):
      continue
    elif header.startswith("tests/") or not allowed(header, ARROWS[folder]):
      found.append(f"{path}: {folder} may not include {header}")
  return found


def check_itself():
  refused = [
      ("core/base/large_vector.h", "#include <sys/mman.h>"),
      ("core/mesh/a.h", '#include "core/scene/scene.h"'),
      ("core/solver/a.cc", "#include <fstream>"),
      ("core/stream/a.cc", '#include "cleave/v1/frame.pb.h"'),
      ("core/picture/a.cc", '#include "client/io/series/write_aside.h"'),
      ("server/worker/a.cc", "#include <grpcpp/grpcpp.h>"),
      ("server/gateway/a.cc", "#include <grpcpp/grpcpp.h>"),
      ("server/gateway/rpc/a.cc", '#include "client/cpp/channel.h"'),
      ("client/cli/a.cc", '#include "server/session/journal.h"'),
      ("core/surface/a.cc", '#include "tests/metrics/crack.h"'),
      ("elsewhere/a.cc", ""),
  ]
  accepted = [
      ("core/base/large_vector.cc", "#include <sys/mman.h>"),
      ("core/mesh/a.cc", '#include <Eigen/Dense>\n#include <vector>\n#include "core/base/vec3.h"'),
      ("server/gateway/rpc/a.cc", "#include <grpcpp/grpcpp.h>"),
      ("server/worker/a.cc", "#include <sys/socket.h>"),
  ]
  return ([f"self-check: accepted {text!r} at {path}" for path, text in refused
           if not faults_of(path, text)] +
          [f"self-check: refused {text!r} at {path}" for path, text in accepted
           if faults_of(path, text)])


def main():
  faults = check_itself()
  files = 0
  for top in ("core", "proto", "server", "client"):
    for path in sorted((ROOT / top).rglob("*")):
      if path.suffix in (".h", ".cc"):
        files += 1
        faults += faults_of(str(path.relative_to(ROOT)), path.read_text())
  for entry in ROOT.iterdir():
    name = entry.name
    if not name.startswith(".") and name not in TOP_LEVEL and name not in ("build", "out"):
      faults.append(f"{name}: the top level is fixed")
  for line in faults:
    print(line)
  print(f"{files} files, {len(faults)} faults")
  return 1 if faults or files == 0 else 0


if __name__ == "__main__":
  sys.exit(main())
