"""`cleave mesh`: a body from a surface."""

import json
import re

from cleave_cli import BLOCK, CliTest, cleave, main


class Mesh(CliTest):
    def test_a_surface_becomes_a_body_that_runs(self):
        # A box of 40 x 10 x 10 cm without its top.
        surface = self.folder / "box.obj"
        surface.write_text(
            "v 0 0 0\nv 40 0 0\nv 40 10 0\nv 0 10 0\nv 0 0 10\nv 40 0 10\nv 40 10 10\nv 0 10 10\n"
            "f 1 4 3 2\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n")
        body = self.folder / "box.vtu"
        code, output, errors = cleave("mesh", surface, "--cell", "0.03", "--unit-scale", "0.01", "-o",
                                      body, "--layout", "lattice", "--json")
        self.assertEqual(code, 0, errors)
        report = json.loads(output)
        self.assertEqual(report["open_edges"], 4)
        self.assertAlmostEqual(report["surface_volume"], 0.004, places=6)
        self.assertAlmostEqual(report["volume"], 0.004, delta=0.0003)
        self.assertGreater(report["min_dihedral_degrees"], 5)
        box = re.search(r'"mesh": \{"box".*?\}\}\}', BLOCK, re.S).group(0)
        scene = self.scene((BLOCK % 1).replace(box, '"mesh": {"file": "box.vtu"}'))
        code, _, errors = cleave("run", scene, "--out", self.folder / "out", "-q")
        self.assertEqual(code, 0, errors)
        self.assertIn("angles ", cleave("mesh", surface, "--cell", "3")[1])
        code, _, errors = cleave("mesh", surface, "--cell", "1e-5")
        self.assertEqual(code, 3)
        self.assertIn("box.obj: cell_size: 1e-05 m makes about", errors)
        code, _, errors = cleave("mesh", surface, "--cell", "3", "-o", self.folder / "box.msh")
        self.assertEqual(code, 3)
        self.assertIn("box.msh does not end in .vtu", errors)
        self.assertFalse((self.folder / "box.msh").exists())
        deep = self.folder / "a" / "b" / "box.vtu"
        self.assertEqual(cleave("mesh", surface, "--cell", "3", "-o", deep)[0], 0)
        self.assertTrue(deep.exists())


if __name__ == "__main__":
    main()
