"""Scenes that are right and wrong, command lines that are, and who answers."""

import json
import re

from cleave_cli import BLOCK, SCENE, CliTest, cleave, main


class Scenes(CliTest):
    def test_bad_scene_exits_3_with_every_fault_at_its_line(self):
        text = (BLOCK % 3).replace('"youngs_modulus"', '"youngs_moduls"')
        code, output, errors = cleave("run", self.scene(text), "--out", self.folder / "out")
        self.assertEqual(code, 3)
        self.assertEqual(output, "")
        self.assertIn('block.scene.json:5: material field "youngs_moduls" is unknown; '
                      'did you mean "youngs_modulus"?', errors)
        text = (BLOCK % 3).replace("0.3", "0.7").replace("1000", "-1")
        code, _, errors = cleave("validate", self.scene(text))
        self.assertEqual(code, 3)
        self.assertEqual(len([line for line in errors.splitlines()
                              if "block.scene.json:5: materials[0]." in line]), 2, errors)

    def test_valid_scene_exits_0(self):
        code, _, errors = cleave("validate", SCENE)
        self.assertEqual((code, errors.splitlines()[-1]), (0, f"{SCENE} is valid"))

    def test_missing_files_exit_6(self):
        self.assertEqual(cleave("validate", self.folder / "none.scene.json")[0], 6)
        text = re.sub(r'"mesh": \{"box".*?\}\}\}', '"mesh": {"file": "none.msh"}', BLOCK % 3,
                      flags=re.DOTALL)
        code, _, errors = cleave("inspect", self.scene(text))
        self.assertEqual(code, 6)
        self.assertIn("none.msh", errors)

    def test_inspect_counts_a_mesh(self):
        code, output, _ = cleave("inspect", SCENE, "--json")
        self.assertEqual(code, 0)
        report = json.loads(output)
        self.assertGreater(report["tets"], 1000)
        self.assertEqual(report["components"], 1)
        self.assertIn("gauge", [region["name"] for region in report["regions"]])


class Usage(CliTest):
    def test_wrong_command_lines_exit_2(self):
        for arguments in ([], ["frobnicate"], ["run"], ["list"], ["run", "a", "--frames", "-1"],
                          ["run", "a", "--no-such-flag"]):
            self.assertEqual(cleave(*arguments)[0], 2, arguments)
        self.assertIn('did you mean "inspect"?', cleave("inspct")[2])

    def test_every_verb_explains_itself_with_an_example(self):
        code, output, _ = cleave("--help")
        self.assertEqual(code, 0)
        for verb in ("run", "submit", "watch", "step", "list", "cancel", "validate", "plan",
                     "inspect", "export", "preview", "info", "probe", "impurity", "mesh", "gallery"):
            self.assertIn(f"\n  {verb} ", output)
            code, help_text, _ = cleave(verb, "--help")
            self.assertEqual(code, 0)
            self.assertIn(f"  cleave {verb} ", help_text)

    def test_nobody_at_the_address_exits_4(self):
        code, _, errors = cleave("list", "--server", f"unix:{self.folder}/none",
                                 "--connect-timeout", "0.3")
        self.assertEqual(code, 4)
        self.assertIn("no server answers", errors)


if __name__ == "__main__":
    main()
