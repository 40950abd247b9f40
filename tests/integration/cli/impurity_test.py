"""`cleave impurity`: layers baked without a simulation, and runs with them."""

import json
import struct
import zlib

from cleave_cli import BLOCK, CliTest, cleave, main


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

    def test_server_draws_the_same_picture(self):
        _, address = self.serve()
        scene = self.scene((BLOCK % 1).replace('"density"', '"tensile_strength": 3e4, "density"'))
        pictures = []
        for where in (), ("--server", address):
            out = self.folder / f"out{len(where)}"
            code, output, errors = cleave("impurity", scene, "--layer", json.dumps(STROKE), "--out", out,
                                          "--width", "160", "--azimuth", "-40", "--json", *where)
            self.assertEqual(code, 0, errors)
            self.assertEqual(json.loads(output)["picture_png"], "")  # it is in its file
            pictures.append((out / "impurity.png").read_bytes())
        self.assertTrue(pictures[0].startswith(b"\x89PNG"))
        self.assertEqual(pictures[0], pictures[1])
        code, _, errors = cleave("impurity", scene, "--layer", json.dumps(STROKE), "--out", out,
                                 "--width", "1921", "--server", address)
        self.assertEqual(code, 3)
        self.assertIn("picture.width: 1921 is outside [16, 1920] pixels", errors)

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
        _, address = self.serve()
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


if __name__ == "__main__":
    main()
