#!/usr/bin/env python3
"""Holds that deploy/unity_groups.py keeps files apart that cannot be compiled as one."""

import pathlib
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "deploy"))
import unity_groups


def anonymous(line):
  return f"namespace cleave {{\nnamespace {{\n\n{line}\n\n}}  // namespace\n}}  // namespace cleave\n"


class UnityGroups(unittest.TestCase):

  def test_files_that_define_a_name_twice_are_apart(self):
    for first, second in [
        ("constexpr double kSize = 1;  // m", "constexpr int kSize[] = {1, 2};"),
        ("struct Options {\n  int size = 0;\n};", "class Options final : public Base {};"),
        ("double At(double x) { return x; }", "Vec3 At(\n    const Vec3& x) {\n  return x;\n}"),
        ("template <typename T>\nT Mix(T a, T b) {\n  return a;\n}", "Color Mix(Color a) {}"),
        ("using Laws = int;", "enum class Laws { kOne };"),
        ("const std::vector<int> kEdges = {\n    1};", "const auto* const kEdges = Make(1);"),
        ("#define TWICE(x) x", "int TWICE() { return 0; }"),
    ]:
      with self.subTest(first):
        self.assertEqual(unity_groups.groups_of([anonymous(first), anonymous(second)]), [0, 1])

  def test_files_that_mention_a_name_of_another_are_apart(self):
    own = anonymous("Scene BreakingScene() { return {}; }")
    for use in ("const Scene kScene = BreakingScene();", "TEST(Bar, Breaks) {\n  BreakingScene();\n}"):
      with self.subTest(use):
        self.assertEqual(unity_groups.groups_of([own, anonymous(use)]), [0, 1])
        self.assertEqual(unity_groups.groups_of([anonymous(use), own]), [0, 1])

  def test_files_whose_headers_mention_a_name_of_another_are_apart(self):
    own = anonymous("class ElasticLaw {};")
    use = '#include "core/model/build_model.h"\n' + anonymous("int Other() { return 0; }")
    self.assertEqual(unity_groups.groups_of([own, use]), [0, 1])

  def test_members_qualified_names_comments_and_texts_are_no_mention(self):
    own = anonymous("int Load() { return 0; }")
    use = anonymous('TEST(Bar, Loads) {\n  file.Load();\n  at->Load();\n  Bar::Load("Load");  // Load\n}')
    self.assertEqual(unity_groups.groups_of([own, use]), [0, 0])

  def test_what_all_may_use_may_be_mentioned(self):
    public = "namespace cleave {\n\nint Load() { return 0; }\n\n}  // namespace cleave\n"
    self.assertEqual(unity_groups.groups_of([public, anonymous("int Twice() { return Load(); }")]), [0, 0])

  def test_files_that_use_the_same_names_are_together(self):
    text = anonymous("using ::testing::Not;\n\nTEST(Bar, {0}) {{\n  const int size = 1;\n}}")
    texts = [text.replace("{0}", name) for name in ("Bends", "Breaks")]
    self.assertEqual(unity_groups.groups_of(texts), [0, 0])

  def test_later_files_fill_the_groups_that_there_are(self):
    at, other = anonymous("int At() { return 0; }"), anonymous("int Other() { return 0; }")
    self.assertEqual(unity_groups.groups_of([at, at, other]), [0, 1, 0])

  def test_groups_are_no_larger_than_what_a_compiler_bears(self):
    texts = [anonymous(f"int Name{k}() {{ return 0; }}") for k in range(unity_groups.MOST + 1)]
    self.assertEqual(unity_groups.groups_of(texts), [0] * unity_groups.MOST + [1])


if __name__ == "__main__":
  unittest.main()
