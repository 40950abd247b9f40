"""`cleave probe`: materials without a mesh, here and at a server."""

import json
import re

from cleave_cli import BLOCK, CliTest, cleave, main


class Probes(CliTest):
    def test_preset_is_pulled_along_and_across_its_fibres(self):
        out = self.folder / "out"
        code, output, errors = cleave("probe", "dry_wood", "--out", out)
        self.assertEqual(code, 0, errors)
        self.assertIn("pulled along 1 0 0: Young's modulus 11.9 GPa; breaks at a strain of", output)
        self.assertIn("(tensile strength of edges along 0 1 0)", output)
        self.assertTrue((out / "curves.svg").read_text().startswith("<svg"))
        rows = (out / "curves.csv").read_text().splitlines()
        self.assertEqual(len(rows), 1 + 2 * 101)
        self.assertEqual(len(rows[0].split(",")), len(rows[-1].split(",")))

    def test_formats_hold_the_same_numbers(self):
        pull = ("probe", "bread", "--direction=-1,2,0", "--samples", "4", "--format")
        curve = json.loads(cleave(*pull, "json")[1])["curves"][0]
        table = [row.split(",") for row in cleave(*pull, "csv")[1].splitlines()]
        column = table[0].index("nominal_stress_pa")
        self.assertEqual([float(row[column]) for row in table[1:]], curve["nominal_stress"])
        self.assertEqual(curve["end"], "CURVE_END_TENSILE_STRENGTH")

    def test_gradient_has_energy_stress_and_tangent(self):
        code, output, errors = cleave("probe", "rubber", "--deformation", "1,0,0,0,1,0,0,0,1",
                                      "--format", "json")
        self.assertEqual(code, 0, errors)
        answer = json.loads(output)
        self.assertEqual(answer["curves"], [])
        self.assertEqual(answer["points"][0]["stress"], [0] * 9)
        self.assertAlmostEqual(answer["points"][0]["tangent"][10] / (1.5e6 / 2.9), 1)

    def test_material_of_a_scene_is_named_with_its_line(self):
        scene = self.scene((BLOCK % 3).replace("0.3,", "0.7,"))
        code, _, errors = cleave("probe", scene, "--samples", "0")
        self.assertEqual(code, 3)
        self.assertRegex(errors, r"block.scene.json:5: materials\[0\].poisson_ratio: 0.7 is outside")
        self.assertIn("samples: 0 is outside", errors)
        code, output, errors = cleave("probe", self.scene(BLOCK % 3), "--max-strain", "0.1")
        self.assertEqual(code, 0, errors)
        self.assertIn("holds up to the largest strain, 10 %", output)

    def test_presets_are_listed_with_their_sources(self):
        code, output, _ = cleave("probe", "--list")
        self.assertEqual(code, 0)
        for words in ("dry_wood: Sitka spruce", "- EN 572-1", "fibres along 1 0 0: 425 kPa"):
            self.assertIn(words, output)
        self.assertEqual(cleave("probe")[0], 2)
        self.assertIn('did you mean "glass"?', cleave("probe", "glas")[2])

    def test_preset_in_a_scene_is_simulated_again_in_the_same_folder(self):
        scene = self.scene(re.sub(r'"materials": .*', '"materials": [{"preset": "cheese"}],',
                                  BLOCK % 2))
        for _ in range(2):
            code, _, errors = cleave("run", scene, "--out", self.folder / "out", "-q")
            self.assertEqual(code, 0, errors)

    def test_server_gives_the_same_numbers(self):
        _, address = self.serve()
        pull = ("probe", "raw_meat", "--direction", "1,1,0", "--format", "json")
        code, output, errors = cleave(*pull, "--server", address)
        self.assertEqual(code, 0, errors)
        self.assertEqual(output, cleave(*pull)[1])
        self.assertEqual(cleave("probe", "--list", "--server", address)[1],
                         cleave("probe", "--list")[1])
        code, _, errors = cleave("probe", "raw_meat", "--samples", "0", "--server", address)
        self.assertEqual((code, errors), (3, "samples: 0 is outside [1, 1000]\n"))


if __name__ == "__main__":
    main()
