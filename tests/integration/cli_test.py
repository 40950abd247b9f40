"""The command line against the real programs: what it leaves behind, says and exits with.

Usage: cli_test.py CLEAVE CLEAVED SCENE [unittest arguments]
"""

import base64
import json
import os
import pathlib
import re
import signal
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

CLEAVE, CLEAVED, SCENE = sys.argv[1:4]
SECONDS = 300  # for anything that must end

# A small block pulled at one side: a few tens of milliseconds a frame.
BLOCK = """{
  "name": "block",
  "mesh": {"box": {"size": [0.4, 0.1, 0.1],
    "resolution": {"layout": "MESH_LAYOUT_JITTERED_LATTICE", "cell_size": 0.05}}},
  "materials": [{"youngs_modulus": 1e5, "poisson_ratio": 0.3, "density": 1000}],
  "node_sets": [{"name": "left", "select": [{"plane": {"point": [0, 0, 0], "normal": [-1, 0, 0]}}]}],
  "motions": [{"node_set": "left"}],
  "gravity": [0, 0, -9.81],
  "timing": {"frame_count": %d}
}
"""


def environment():
    return {k: v for k, v in os.environ.items() if k != "CLEAVE_SERVER"}


def cleave(*arguments):
    """Runs to the end; (exit code, stdout, stderr)."""
    done = subprocess.run([CLEAVE, *map(str, arguments)], capture_output=True, text=True,
                          timeout=SECONDS, env=environment())
    return done.returncode, done.stdout, done.stderr


class CliTest(unittest.TestCase):
    def setUp(self):
        self._folder = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self._folder.name)
        self.addCleanup(self._folder.cleanup)

    def scene(self, text, name="block.scene.json"):
        path = self.folder / name
        path.write_text(text)
        return path


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
        address = f"unix:{self.folder}/socket"
        with open(self.folder / "log", "w") as log:
            server = subprocess.Popen([CLEAVED, "--listen", address, "--data", self.folder / "data"],
                                      stdout=log, stderr=log)
        self.addCleanup(server.wait)
        self.addCleanup(server.terminate)
        pull = ("probe", "raw_meat", "--direction", "1,1,0", "--format", "json")
        code, output, errors = cleave(*pull, "--server", address)
        self.assertEqual(code, 0, errors)
        self.assertEqual(output, cleave(*pull)[1])
        self.assertEqual(cleave("probe", "--list", "--server", address)[1],
                         cleave("probe", "--list")[1])
        code, _, errors = cleave("probe", "raw_meat", "--samples", "0", "--server", address)
        self.assertEqual((code, errors), (3, "samples: 0 is outside [1, 1000]\n"))


# A stroke across the block at x = 0.23, to half of its depth.
STROKE = {"name": "laser", "potency": 5, "weakening": 0.5, "falloff": 0.02,
          "strokes": {"curves": [{"points": [0.23, -1, 0, 0.23, 1, 0]}], "depth": 0.051}}


def grey_png(rows):
    """The bytes of an 8-bit grey PNG."""
    def chunk(kind, data):
        return (struct.pack(">I", len(data)) + kind + data +
                struct.pack(">I", zlib.crc32(kind + data)))
    header = struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 0, 0, 0, 0)
    data = zlib.compress(b"".join(b"\0" + bytes(row) for row in rows))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", data) +
            chunk(b"IEND", b""))


class Impurities(CliTest):
    def test_layer_is_baked_to_files_and_a_picture(self):
        out = self.folder / "out"
        scene = self.scene((BLOCK % 1).replace('"density"', '"tensile_strength": 3e4, "density"'))
        code, output, errors = cleave("impurity", scene, "--layer", json.dumps(STROKE), "--out", out,
                                      "--width", "160")
        self.assertEqual(code, 0, errors)
        self.assertRegex(output, r"nodes: 81, [0-9]+ of them impure; potency 0 to 5\n")
        self.assertRegex(output, r"edges: [0-9]+, [0-9]+ of them affected")
        self.assertRegex(output, r"strength: [0-9]+(\.[0-9]+)? Pa to 3e\+04 Pa\n")
        self.assertTrue((out / "impurity.png").read_bytes().startswith(b"\x89PNG"))
        for name in ("impurity.vtu", "affected_edges.vtu"):
            self.assertIn(b'type="UnstructuredGrid"', (out / name).read_bytes())
        # Baked potencies can be worn as shares of another layer: 5 of them are the whole.
        worn = {"node_values": {"file": "out/impurity.vtu", "array": "impurity"}, "potency": 5}
        again = json.loads(cleave("impurity", scene, "--layer", json.dumps(worn), "--json")[1])
        first = json.loads(cleave("impurity", scene, "--layer", json.dumps(STROKE), "--json")[1])
        ends = {node for edge, weakening in enumerate(first["weakenings"]) if weakening != 1
                for node in first["edge_nodes"][2 * edge:2 * edge + 2]}
        for node, potency in enumerate(first["potencies"]):
            self.assertAlmostEqual(again["potencies"][node],
                                   max(potency, 2.5 if node in ends else 0))

    def test_picture_is_stamped_on_a_mesh(self):
        # A black bar, 20 pixels long, in the middle of a white picture.
        rows = [[255] * 40 for _ in range(40)]
        for y in range(18, 22):
            rows[y][10:30] = [0] * 20
        (self.folder / "bar.png").write_bytes(grey_png(rows))
        mesh = self.folder / "block.scene.json"
        self.scene(BLOCK % 1)
        layer = {"pattern": {"image": {"file": "bar.png"}, "origin": [0.2, 0.049, 0],
                             "scale": 0.4}, "weakening": 0}
        code, output, errors = cleave("impurity", mesh, "--layer", json.dumps(layer), "--json")
        self.assertEqual(code, 0, errors)
        answer = json.loads(output)
        # The bar is 0.2 m long: a cut along x through the lower half of the block.
        self.assertEqual(set(answer["weakenings"]), {0})
        self.assertEqual((answer["weakest"], answer["strongest"]), (0, "Infinity"))
        layer["pattern"]["image"]["threshold"] = 0.999999
        layer["pattern"]["image"]["bright"] = True
        code, _, errors = cleave("impurity", mesh, "--layer", json.dumps(layer), "--json")
        self.assertEqual(code, 0, errors)  # what is white, then
        (self.folder / "bar.png").write_bytes(grey_png([[255] * 8] * 8))
        del layer["pattern"]["image"]["bright"], layer["pattern"]["image"]["threshold"]
        code, _, errors = cleave("impurity", mesh, "--layer", json.dumps(layer))
        self.assertEqual(code, 3)
        self.assertIn("impurities.layers[0].pattern.image.file", errors)
        self.assertIn("no pixel is darker than the threshold", errors)

    def test_texture_paints_the_surface_of_a_body(self):
        # A quad over the block, of two triangles; the right half of its picture is drawn.
        (self.folder / "top.obj").write_text(
            "v 0 0 10\nv 40 0 10\nv 40 10 10\nv 0 10 10\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
            "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n")
        (self.folder / "half.png").write_bytes(grey_png([[0] * 8 + [255] * 8] * 4))
        layer = {"potency": 2, "weakening": "Infinity",
                 "paint": {"file": "top.obj", "unit_scale": 0.01, "depth": 1,
                           "texture": {"file": "half.png", "wrap": "TEXTURE_WRAP_CLAMP"}}}
        scene = self.scene((BLOCK % 1).replace('"density"', '"tensile_strength": 3e4, "density"'))
        code, output, errors = cleave("impurity", scene, "--layer", json.dumps(layer), "--json")
        self.assertEqual(code, 0, errors)
        answer = json.loads(output)
        self.assertEqual(answer["weakenings"].count("Infinity") +
                         answer["weakenings"].count(1), len(answer["weakenings"]))
        self.assertIn("Infinity", answer["weakenings"])
        # Four of nine layers of nodes on either side of the middle.
        self.assertEqual(answer["potencies"].count(0), 4 * 9)
        self.assertEqual(answer["potencies"].count(2), 4 * 9)
        del layer["paint"]["unit_scale"]
        code, _, errors = cleave("impurity", scene, "--layer", json.dumps(layer))
        self.assertEqual(code, 3)
        self.assertIn("impurities.layers[0].paint: its surface is farther than 1 m", errors)

    def test_bad_layers_are_refused_by_name(self):
        scene = self.scene(BLOCK % 1)
        miss = dict(STROKE, strokes={"curves": [{"points": [9, 0, 0, 9, 1, 0]}]})
        for layer, words in (
                (miss, "impurities.layers[0].strokes.curves[0]: crosses no edge of the mesh"),
                (dict(STROKE, potency="NaN"), 'potency: "NaN" is not a number'),
                ({"potency": 1, "pattern": {}}, "impurities.layers[0].pattern.curves: is empty"),
                ({"potency": 1, "node_values": {"shares": [1, 0]}},
                 "impurities.layers[0].node_values.shares: has 2 shares; the mesh has 81 nodes"),
                ({"potencyy": 1}, 'field "potencyy" is unknown')):
            code, _, errors = cleave("impurity", scene, "--layer", json.dumps(layer))
            self.assertEqual(code, 3, errors)
            self.assertIn(words, errors)
        self.assertEqual(cleave("impurity", scene)[0], 3)

    def test_server_gives_the_same_numbers(self):
        address = f"unix:{self.folder}/socket"
        with open(self.folder / "log", "w") as log:
            server = subprocess.Popen([CLEAVED, "--listen", address, "--data", self.folder / "data"],
                                      stdout=log, stderr=log)
        self.addCleanup(server.wait)
        self.addCleanup(server.terminate)
        ask = ("impurity", self.scene(BLOCK % 1), "--layer", json.dumps(STROKE), "--json")
        code, output, errors = cleave(*ask, "--server", address)
        self.assertEqual(code, 0, errors)
        self.assertEqual(output, cleave(*ask)[1])

    def test_scene_with_a_cut_comes_apart(self):
        cut = dict(STROKE, weakening=0, strokes={"curves": STROKE["strokes"]["curves"]})
        text = (BLOCK % 2).replace('"gravity"', '"impurities": {"layers": [%s]}, "gravity"'
                                   % json.dumps(cut))
        out = self.folder / "out"
        code, _, errors = cleave("run", self.scene(text), "--out", out, "-q")
        self.assertEqual(code, 0, errors)
        report = json.loads((out / "reports.jsonl").read_text().splitlines()[0])
        self.assertEqual(report["fragments"], 2)


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


class Gallery(CliTest):
    def gallery(self, *arguments):
        return cleave("gallery", "locality", "--out", self.folder / "gallery", "--seeds", "1",
                      "--layout", "unstructured", "--coarseness", "2", "--width", "64", *arguments)

    def test_a_page_shows_pictures_criteria_and_verdicts(self):
        code, output, errors = self.gallery()
        self.assertEqual(code, 0, errors)
        page = self.folder / "gallery" / "index.html"
        self.assertEqual(output.strip(), str(page))
        text = page.read_text()
        self.assertIn("nothing differs in any bit", text)
        self.assertIn('class="good">met</td>', text)
        self.assertIn("2 of 2 verdicts are as they should be", errors)
        picture = next((self.folder / "gallery" / "pictures").glob("locality-with-*.png"))
        self.assertEqual(struct.unpack(">I", picture.read_bytes()[16:20])[0], 64)
        self.assertIn(base64.b64encode(picture.read_bytes()).decode(), text)

        # What is done is kept, and the page is the same to the last byte.
        code, _, errors = self.gallery()
        self.assertEqual((code, page.read_text()), (0, text))
        self.assertIn("1 of 1 runs are there", errors)
        picture.unlink()
        self.assertIn("[1/1] locality with, seed 1, unstructured", self.gallery()[2])

    def test_a_run_that_fails_is_named_on_the_page(self):
        runner = self.folder / "runner.sh"
        runner.write_text("""#!/bin/sh
case "$1 $2" in
*--list*|*--judge*) exec "%s" "$@" ;;
esac
echo "no <memory>" >&2
exit 1
""" % (pathlib.Path(CLEAVE).parent / "../../tests/scenes/scene_runner"))
        runner.chmod(0o755)
        code, _, errors = self.gallery("--runner", runner)
        self.assertEqual(code, 1)
        self.assertIn("1 of 1 runs failed", errors)
        text = (self.folder / "gallery" / "index.html").read_text()
        self.assertIn("no &lt;memory&gt;", text)
        self.assertIn('class="bad">not met</td>', text)

    def test_scenes_and_programs_that_are_not_there_exit_6(self):
        code, _, errors = cleave("gallery", "stake", "--out", self.folder / "gallery")
        self.assertEqual(code, 6)
        self.assertIn('there is no scene "stake"; there are: fibre_bar', errors)
        code, _, errors = self.gallery("--runner", "no/runner")
        self.assertEqual(code, 6)
        self.assertIn("no/runner", errors)

    def test_an_interrupted_gallery_exits_130_with_a_page_of_what_is_done(self):
        command = [CLEAVE, "gallery", "steak", "--out", str(self.folder / "gallery"), "--seeds",
                   "1", "--layout", "lattice", "--width", "64"]
        with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                              env=environment()) as process:
            runs = self.folder / "gallery" / "runs"
            while not runs.exists():
                self.assertIsNone(process.poll())
            process.send_signal(signal.SIGINT)
            _, errors = process.communicate(timeout=SECONDS)
        self.assertEqual(process.returncode, 130, errors)
        self.assertIn("the same command goes on from there", errors)
        self.assertTrue((self.folder / "gallery" / "index.html").exists())


class EmbeddedRuns(CliTest):
    def test_run_tells_what_broke(self):
        text = (BLOCK % 3).replace('"density"', '"tensile_strength": 1e-3, "density"')
        out = self.folder / "out"
        code, _, errors = cleave("run", self.scene(text), "--out", out, "-q", "--frames", "2")
        self.assertEqual(code, 0, errors)
        first = (out / "events.jsonl").read_text()
        events = [json.loads(line) for line in first.splitlines()]
        reports = [json.loads(line) for line in (out / "reports.jsonl").read_text().splitlines()]
        broken = [event for event in events if event["event"] == "edge_break"]
        self.assertEqual(len(broken), reports[-1]["broken_edges"])
        self.assertGreater(len(broken), 0)
        off = [event for event in events if event["event"] == "separation"]
        self.assertEqual(len(off) + 1, reports[-1]["fragments"])
        self.assertEqual([event["piece"] for event in off], list(range(1, len(off) + 1)))
        # What leads the recording is cut, and going on adds what follows.
        with open(out / "events.jsonl", "a") as lines:
            lines.write('{"frame":3,"event":"edge_break"}\n{"frame":3,')
        code, _, errors = cleave("run", self.scene(text), "--out", out, "-q")
        self.assertEqual(code, 0, errors)
        lines = (out / "events.jsonl").read_text()
        self.assertTrue(lines.startswith(first))
        self.assertNotIn('{"frame":3,"event":"edge_break"}\n', lines)

    def test_run_leaves_a_recording_that_exports(self):
        out = self.folder / "out"
        code, output, errors = cleave("run", self.scene(BLOCK % 4), "--out", out, "--plot")
        self.assertEqual(code, 0, errors)
        self.assertEqual(output.split(), [f"{out}/{name}" for name in
                                          ("frames.clv", "mesh.pb", "events.jsonl", "reports.jsonl",
                                           "plot.svg")])
        self.assertIn("frame 4 of 4", errors)
        self.assertEqual(len((out / "reports.jsonl").read_text().splitlines()), 4)
        code, output, errors = cleave("export", out)
        self.assertEqual((code, output), (0, f"{out}/vtu/cleave.pvd\n"), errors)
        self.assertEqual(len(list((out / "vtu").glob("*.vtu"))), 5)
        code, output, errors = cleave("preview", out, "--still", "4", "--width", "64")
        self.assertEqual((code, output), (0, f"{out}/still_000004.png\n"), errors)
        self.assertEqual(cleave("preview", out, "--still", "9")[0], 3)

    def test_render_mesh_is_written_in_place_of_the_surface(self):
        out = self.folder / "out"
        self.assertEqual(cleave("run", self.scene(BLOCK % 2), "--out", out, "-q")[0], 0)
        mesh = self.folder / "fine.obj"
        mesh.write_text("v 0 0 0\nv 400 0 0\nv 0 100 0\nv 0 0 100\n"
                        "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n")
        code, output, errors = cleave("export", out, "--format", "ply", "--render-mesh", mesh,
                                      "--render-scale", "0.001")
        self.assertEqual((code, output), (0, f"{out}/ply\n"), errors)
        self.assertEqual(len(list((out / "ply").glob("*.ply"))), 3)
        self.assertNotIn("not closed", errors)
        mesh.write_text("v 0 0 0\nv 400 0 0\nv 0 100 0\nf 1 3 2\n")
        code, _, errors = cleave("export", out, "--format", "ply", "--render-mesh", mesh,
                                 "--render-scale", "0.001")
        self.assertIn("is not closed: 3 edges", errors)
        code, _, errors = cleave("export", out, "--format", "ply", "--render-mesh", mesh)
        self.assertEqual(code, 3)
        self.assertIn("same units", errors)
        code, _, errors = cleave("export", out, "--format", "vtu-volume", "--render-mesh", mesh)
        self.assertEqual(code, 3)
        self.assertIn("--render-mesh: goes with --format", errors)
        mesh.write_text("v 0 0 0\nv 0.4 0 0\nv 0 0.1 0\nv 0 0 0.1\nvt 0 0\nvt 1 0\nvt 0 0.625\n"
                        "f 1/1 3/2 2/3\nf 1/1 2/2 4/3\nf 2/1 3/2 4/3\nf 1/1 4/2 3/3\n")
        code, output, errors = cleave("export", out, "--format", "bake-pc2", "--render-mesh", mesh)
        self.assertEqual(code, 0, errors)
        self.assertIn("vt 0 0.625", (out / "bake-pc2/cleave.obj").read_text())
        self.assertEqual(cleave("export", out, "--format", "glb", "--render-mesh", mesh)[0], 0)
        code, output, errors = cleave("preview", out, "--still", "2", "--width", "64",
                                      "--render-mesh", mesh)
        self.assertEqual((code, output), (0, f"{out}/still_000002.png\n"), errors)

    def test_damaged_frame_is_named_and_exits_3_and_files_follow_the_umask(self):
        out = self.folder / "out"
        self.assertEqual(cleave("run", self.scene(BLOCK % 4), "--out", out, "-q")[0], 0)
        modes = {path.name: path.stat().st_mode & 0o777 for path in out.iterdir()
                 if path.is_file()}
        self.assertEqual(set(modes.values()), {0o666 & ~self.umask()}, modes)
        frames = bytearray((out / "frames.clv").read_bytes())
        offset, = struct.unpack_from("<Q", frames, len(frames) - 24)  # of the index
        third, = struct.unpack_from("<Q", frames, offset + 16 + 3 * 80 + 24)
        frames[third + 200] ^= 1
        (out / "frames.clv").write_bytes(frames)
        code, _, errors = cleave("export", out, "--format", "ply")
        self.assertEqual(code, 3, errors)
        self.assertIn("frames.clv: frame 3: ", errors)
        code, _, errors = cleave("export", out, "--format", "plot", "--first", "1", "--stride", "2")
        self.assertEqual(code, 3)
        self.assertIn("--first: goes with frames", errors)
        self.assertIn("--stride: goes with frames", errors)
        code, _, errors = cleave("export", out, "--reports", out / "reports.jsonl")
        self.assertEqual(code, 3)
        self.assertIn("--reports: goes with --format plot, not vtu", errors)

    @staticmethod
    def umask():
        mask = os.umask(0)
        os.umask(mask)
        return mask

    def test_other_scene_in_the_same_folder_is_refused_unless_fresh(self):
        out = self.folder / "out"
        self.assertEqual(cleave("run", self.scene(BLOCK % 2), "--out", out, "-q")[0], 0)
        other = self.scene((BLOCK % 2).replace("1e5", "2e5"))
        code, _, errors = cleave("run", other, "--out", out)
        self.assertEqual(code, 7)
        self.assertIn("another --out", errors)
        self.assertEqual(cleave("run", other, "--out", out, "--fresh", "-q")[0], 0)

    def interrupted_run(self, out, number, scene):
        """Sends a signal when the second frame has come; (exit code, last frame, stderr)."""
        process = subprocess.Popen([CLEAVE, "run", scene, "--out", out, "--json"],
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                   env=environment(), start_new_session=True)
        self.addCleanup(process.kill)
        frames = []
        for line in process.stdout:
            event = json.loads(line)
            if event["event"] != "frame":
                continue
            frames.append(event["frame"])
            if len(frames) == 2:
                process.send_signal(number)
        errors = process.stderr.read()
        process.stdout.close()
        process.stderr.close()
        return process.wait(timeout=SECONDS), frames, errors

    def test_interrupted_run_is_paused_and_goes_on_with_the_bytes_of_an_unbroken_one(self):
        frame_count = 150
        scene = self.scene(BLOCK % frame_count)
        whole, parts = self.folder / "whole", self.folder / "parts"
        self.assertEqual(cleave("run", scene, "--out", whole, "-q")[0], 0)
        code, first, errors = self.interrupted_run(parts, signal.SIGINT, scene)
        self.assertEqual(code, 130, errors)
        self.assertLess(first[-1], frame_count)
        self.assertIn(f"cleave run {scene} --out {parts}", errors)
        code, second, errors = self.interrupted_run(parts, signal.SIGTERM, scene)
        self.assertEqual(code, 143, errors)
        self.assertEqual(second[0], first[-1] + 1)
        code, _, errors = cleave("run", scene, "--out", parts, "-q")
        self.assertEqual(code, 0, errors)
        self.assertEqual((parts / "frames.clv").read_bytes(), (whole / "frames.clv").read_bytes())

    def test_killed_run_takes_its_server_along_and_goes_on(self):
        scene, out = self.scene(BLOCK % 150), self.folder / "out"
        code, frames, _ = self.interrupted_run(out, signal.SIGKILL, scene)
        self.assertEqual(code, -signal.SIGKILL)
        code, _, errors = cleave("run", scene, "--out", out, "-q", "--frames", frames[-1] + 20)
        self.assertEqual(code, 0, errors)


class Server(CliTest):
    def setUp(self):
        super().setUp()
        self.address = f"unix:{self.folder}/socket"
        log = open(self.folder / "log", "w")
        self.addCleanup(log.close)
        self.server = subprocess.Popen(
            [CLEAVED, "--listen", self.address, "--data", self.folder / "data"],
            stdout=log, stderr=log)
        self.addCleanup(self.server.wait)
        self.addCleanup(self.server.terminate)

    def ask(self, verb, *arguments):
        return cleave(verb, *arguments, "--server", self.address)

    def test_session_is_submitted_stepped_watched_and_deleted(self):
        scene = self.scene(BLOCK % 6)
        code, output, errors = self.ask("submit", scene, "--idle", "--session", "block")
        self.assertEqual((code, output), (0, "sessions/block\n"), errors)
        code, output, errors = self.ask("step", "block", "-n", "2", "--json")
        self.assertEqual(code, 0, errors)
        self.assertEqual(json.loads(output)["head_frame"], "2")
        out = self.folder / "out"
        code, output, errors = self.ask("watch", "block", "--run", "--out", out, "--json")
        self.assertEqual(code, 0, errors)
        self.assertEqual([json.loads(line)["frame"] for line in output.splitlines()],
                         list(range(7)))
        self.assertEqual(cleave("export", out, "--format", "ply", "--last", "0")[0], 0)
        code, output, _ = self.ask("list", "--json")
        self.assertEqual([json.loads(line)["name"] for line in output.splitlines()],
                         ["sessions/block"])
        self.assertEqual(self.ask("cancel", "block", "--delete")[0], 0)
        self.assertEqual(self.ask("watch", "block")[0], 6)
        code, output, _ = self.ask("info", "--json")
        self.assertEqual(json.loads(output)["api_versions"], ["cleave.v1"])

    def test_viewers_choose_among_the_accuracies_that_a_session_keeps(self):
        scene = self.scene(BLOCK % 6)
        self.assertEqual(self.ask("submit", scene, "--session", "fine", "--rung", "fine")[0], 0)
        sizes = []
        for rung in ("preview", "standard", "fine"):
            out = self.folder / rung
            code, output, errors = self.ask("watch", "fine", "--rung", rung, "--out", out, "--json")
            self.assertEqual(code, 0, errors)
            first, *frames = map(json.loads, output.splitlines())
            self.assertEqual((first["event"], first["rung"]), ("accuracy", rung))
            self.assertEqual([frame["frame"] for frame in frames], list(range(7)))
            sizes.append((out / "frames.clv").stat().st_size)
            self.assertEqual(cleave("export", out, "--format", "ply", "--last", "0")[0], 0)
        self.assertEqual(sizes, sorted(sizes))
        tolerance = first["tolerance"]
        code, _, errors = self.ask("watch", "fine", "--tolerance", 99.9 * tolerance)
        self.assertEqual(code, 0, errors)
        self.assertIn("(standard)", errors)
        code, _, errors = self.ask("watch", "fine", "--tolerance", tolerance / 2)
        self.assertEqual(code, 7, errors)
        self.assertIn("is finer than", errors)
        code, _, errors = self.ask("watch", "fine", "--rung", "preview", "--out", out)
        self.assertEqual(code, 7, errors)
        self.assertIn("another accuracy", errors)
        self.assertEqual(self.ask("watch", "fine", "--rung", "finest")[0], 2)
        self.assertEqual(self.ask("watch", "fine", "--rung", "fine", "--tolerance", 1)[0], 2)
        code, _, errors = self.ask("run", scene, "--out", self.folder / "run", "--rung", "preview")
        self.assertEqual(code, 0, errors)
        self.assertIn("(preview)", errors)
        code, _, errors = self.ask("run", scene, "--out", self.folder / "run", "--rung", "standard")
        self.assertEqual(code, 7, errors)

    def test_name_taken_by_another_scene_exits_7_and_bad_name_3(self):
        scene = self.scene(BLOCK % 2)
        self.assertEqual(self.ask("submit", scene, "--idle", "--session", "block")[0], 0)
        self.assertEqual(self.ask("submit", scene, "--idle", "--session", "block")[0], 0)  # again
        code, _, errors = self.ask("submit", self.scene(BLOCK % 3), "--idle", "--session", "block")
        self.assertEqual(code, 7, errors)
        self.assertEqual(self.ask("submit", scene, "--session", "Not A Name")[0], 3)

    def test_plan_names_parts_and_costs_without_a_session(self):
        code, output, errors = self.ask("plan", self.scene(BLOCK % 2), "--json")
        self.assertEqual(code, 0, errors)
        plan = json.loads(output)
        self.assertGreater(int(plan["tet_count"]), 100)
        self.assertEqual(self.ask("list", "--json")[1], "")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]])
