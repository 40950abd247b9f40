#!/usr/bin/env python3
"""Says which C++ files of a target can be compiled as one: unity_groups.py FILE...

Prints the number of a group for each file, with semicolons between them, as CMake's lists have. Files
of a group define no name twice, at most MOST of them are in one, and what they include is then parsed
once for all. Names are taken from lines that begin at the margin, which is where definitions do.
"""

import re
import sys

MOST = 8

SKIPPED = re.compile(r"(#|//|/\*|namespace\b|using (namespace\b|::)|extern\b|public:|private:|})")
# Tests have names of their own, which the linker would refuse to have twice.
TESTS = re.compile(r"(TYPED_)?TEST(_F|_P)?\(")
TYPE = re.compile(r"(?:template\b.*)?\b(?:struct|class|enum class|enum|union|using)\s+(\w+)")
NAME = re.compile(r"(\w+)(?:\[[^]]*\])?\s*(?:\(|=|\{|;)")
MACRO = re.compile(r"#define (\w+)")


def defined_names(text):
  names = set()
  for line in text.split("\n"):
    if macro := MACRO.match(line):
      names.add(macro[1])
    if not line or not (line[0].isalpha() or line[0] == "_"):
      continue
    if SKIPPED.match(line) or TESTS.match(line):
      continue
    found = TYPE.match(line) or NAME.search(line)
    if found:
      names.add(found[1])
  return names


def groups_of(texts):
  """A group for each text: the first with room in which all its names are new."""
  groups = []  # [count, names]
  chosen = []
  for names in map(defined_names, texts):
    for number, group in enumerate(groups):
      if group[0] < MOST and not names & group[1]:
        break
    else:
      number = len(groups)
      groups.append([0, set()])
    groups[number][0] += 1
    groups[number][1] |= names
    chosen.append(number)
  return chosen


def main():
  texts = []
  for path in sys.argv[1:]:
    with open(path, encoding="utf-8") as source:
      texts.append(source.read())
  print(";".join(map(str, groups_of(texts))))


if __name__ == "__main__":
  main()
