#!/usr/bin/env python3
"""Holds that files include the headers of the names they use, themselves or through the project's.

Precompiled headers (CLEAVE_PRECOMPILE) put these before every file, so that compilers do not tell
what a file lacks until somebody builds without. Run with no argument for the whole check; it also
checks itself on text that it must refuse.
"""

import functools
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent

ALGORITHMS = ("max min minmax clamp sort stable_sort nth_element fill fill_n copy copy_n copy_if transform "
              "find find_if any_of all_of none_of count_if lower_bound upper_bound equal_range "
              "binary_search max_element min_element reverse rotate unique partition remove_if equal "
              r"lexicographical_compare ranges::\w+")
MATHS = "abs sqrt cbrt hypot pow exp log cos sin floor ceil lround isfinite isnan"


def standard(names, *headers):
  return (re.compile(r"\bstd::(%s)\b(?!_)" % "|".join(names.split())), headers)


# Names, and headers of which a file that uses one includes some; / at the end: any header below.
# std::move and its like come with every header that needs them, and are left out.
RULES = [
    (re.compile(r"\bstd::(%s)\b *[(<]" % "|".join(ALGORITHMS.split())), ("algorithm",)),
    (re.compile(r"\bstd::(%s)\b *\(" % "|".join(MATHS.split())), ("cmath",)),
    (re.compile(r"\bu?int(8|16|32|64)_t\b"), ("cstdint",)),
    standard("array", "array"),
    standard("atomic", "atomic"),
    standard("bit_cast popcount countr_zero", "bit"),
    standard("bitset", "bitset"),
    standard("condition_variable", "condition_variable"),
    standard("chrono", "chrono"),
    standard("memcpy memcmp memset", "cstring"),
    standard("filesystem", "filesystem"),
    standard("ifstream ofstream fstream", "fstream"),
    standard("function", "functional"),
    standard("numeric_limits", "limits"),
    standard("map multimap", "map"),
    standard("unique_ptr make_unique shared_ptr make_shared weak_ptr", "memory"),
    standard("mutex lock_guard unique_lock", "mutex"),
    standard("accumulate iota", "numeric"),
    standard("optional nullopt", "optional"),
    standard("set multiset", "set"),
    standard("span", "span"),
    standard("stringstream istringstream ostringstream", "sstream"),
    standard("string to_string getline stoi", "string"),
    standard("thread this_thread", "thread"),
    standard("tuple tie", "tuple"),
    standard("is_same_v conditional_t decay_t remove_cvref_t invoke_result_t", "type_traits"),
    standard("unordered_map", "unordered_map"),
    standard("variant visit", "variant"),
    standard("vector", "vector"),
    (re.compile(r"\bEigen::"), ("Eigen/",)),
    (re.compile(r"\babsl::\w*(Status|Error)\b"), ("absl/status/",)),
    (re.compile(r"\babsl::StatusOr\b"), ("absl/status/statusor.h",)),
    (re.compile(r"\babsl::(StrCat|StrAppend|AlphaNum)\b"), ("absl/strings/str_cat.h",)),
    (re.compile(r"\babsl::string_view\b"), ("absl/strings/",)),
    (re.compile(r"\bgrpc::"), ("grpcpp/", "cleave/v1/")),
    (re.compile(r"\bCLI::"), ("CLI/",)),
    (re.compile(r"\b(TEST|TEST_F|TYPED_TEST)\("), ("gtest/", "gmock/")),
    (re.compile(r"\bEXPECT_THAT\("), ("gmock/",)),
]

INCLUDE = re.compile(r'^\s*#\s*include\s*["<]([^">]+)[">]', re.MULTILINE)
NO_CODE = re.compile(r'//[^\n]*|"(?:\\.|[^"\\\n])*"|^\s*#\s*include[^\n]*', re.MULTILINE)


@functools.lru_cache(None)
def text_of(path):
  return (ROOT / path).read_text()


@functools.lru_cache(None)
def foreign_headers_of(header):
  """`header` itself, or if it is the project's, what it includes from elsewhere."""
  return foreign_headers(text_of(header)) if (ROOT / header).is_file() else frozenset([header])


def foreign_headers(text):
  """What `text` includes from elsewhere, itself or through headers of the project."""
  return frozenset().union(*(foreign_headers_of(header) for header in INCLUDE.findall(text)))


def faults_of(path, text):
  """What `text` at `path` lacks: a list of sentences."""
  headers = foreign_headers(text)
  code = NO_CODE.sub("", text)
  found = []
  for name, needed in RULES:
    if any(h == n or n.endswith("/") and h.startswith(n) for h in headers for n in needed):
      continue
    used = name.search(code)
    if used:
      found.append(f"{path}: {used.group(0).rstrip(' (<')} needs " +
                   " or ".join(f"<{n}>" for n in needed))
  return found


def check_itself():
  refused = [
      "int f(int a) { return std::max(a, 1); }",
      "#include <vector>\nstd::vector<std::string> names;",
      '#include "absl/status/status.h"\nabsl::StatusOr<int> f();',
      "#include <grpcpp/grpcpp.h>\nvoid Add(CLI::App& app);",
      "int64_t count = 0;  // #include <cstdint>",
  ]
  accepted = [
      "#include <vector>\nstd::vector<int> numbers;  // not std::string",
      '#include "core/base/parallel.h"\nstd::vector<int64_t> numbers;',
      '#include "cleave/v1/session.grpc.pb.h"\ngrpc::Status f();',
  ]
  return ([f"self-check: accepted {text!r}" for text in refused if not faults_of("a.cc", text)] +
          [f"self-check: refused {text!r}" for text in accepted if faults_of("a.cc", text)])


def main():
  faults = check_itself()
  files = 0
  for top in ("core", "proto", "server", "client", "tests"):
    for path in sorted((ROOT / top).rglob("*")):
      if path.suffix in (".h", ".cc"):
        files += 1
        path = str(path.relative_to(ROOT))
        faults += faults_of(path, text_of(path))
  for line in faults:
    print(line)
  print(f"{files} files, {len(faults)} faults")
  return 1 if faults or files == 0 else 0


if __name__ == "__main__":
  sys.exit(main())
