#!/usr/bin/env python3
"""Says which C++ files of a target can be compiled as one: unity_groups.py FILE...

Prints the number of a group for each file, with semicolons between them, as CMake's lists have. No file
of a group defines a name for itself, in a namespace without a name, that another one of it or a header
of that so much as mentions: not only would two definitions clash, but a function of the one would
silently stand in for one that the other has from a header. At most MOST files are in a group, and what
they include is then parsed once for all. Definitions are looked for at the margin, where they begin.
"""

import functools
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
MOST = 8

SKIPPED = re.compile(r"(#|//|/\*|namespace\b|using (namespace\b|::)|extern\b|})")
# Tests have names of their own, which the linker would refuse to have twice.
TESTS = re.compile(r"(TYPED_)?TEST(_F|_P)?\(")
TYPE = re.compile(r"(?:template\b.*)?\b(?:struct|class|enum class|enum|union|using)\s+(\w+)")
NAME = re.compile(r"(\w+)(?:\[[^]]*\])?\s*(?:\(|=|\{|;)")
MACRO = re.compile(r"#define (\w+)")

INCLUDE = re.compile(r'^#include "([^"]+)"', re.MULTILINE)
UNREAD = re.compile(r'//.*|"(?:\\.|[^"\\\n])*"')
# Members, and names that say whose they are, mean the same wherever they stand.
MENTION = re.compile(r"(?<![\w.])(?<!->)(?<!::)[A-Za-z_]\w*")


def own_names(text):
  names = set()
  inside = False
  for line in text.split("\n"):
    if line.startswith("namespace {"):
      inside = True
    elif line.startswith("}  // namespace"):
      inside = False
    if macro := MACRO.match(line):
      names.add(macro[1])
    if not inside or not line or not (line[0].isalpha() or line[0] == "_"):
      continue
    if SKIPPED.match(line) or TESTS.match(line):
      continue
    found = TYPE.match(line) or NAME.search(line)
    if found:
      names.add(found[1])
  return names


def mentions(text):
  return set(MENTION.findall(UNREAD.sub("", text)))


@functools.cache
def header(path):
  """Names that a header of the project mentions, and the headers that it includes."""
  if not (ROOT / path).is_file():
    return frozenset(), ()
  text = (ROOT / path).read_text(encoding="utf-8")
  return frozenset(mentions(text)), tuple(INCLUDE.findall(text))


def mentions_with_headers(text):
  names = mentions(text)
  left, seen = INCLUDE.findall(text), set()
  while left:
    path = left.pop()
    if path in seen:
      continue
    seen.add(path)
    more, included = header(path)
    names |= more
    left += included
  return names


def groups_of(texts):
  """A group for each text: the first with room whose files bear it."""
  groups = []  # [count, names of their own, names mentioned]
  chosen = []
  for text in texts:
    own = own_names(text)
    mentioned = own | mentions_with_headers(text)
    for number, group in enumerate(groups):
      if group[0] < MOST and not own & group[2] and not mentioned & group[1]:
        break
    else:
      number = len(groups)
      groups.append([0, set(), set()])
    groups[number][0] += 1
    groups[number][1] |= own
    groups[number][2] |= mentioned
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
