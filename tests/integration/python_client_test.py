"""The Python client against the real server.

Usage: python_client_test.py CLEAVED CLEAVE STUBS_FOLDER [unittest arguments]; client/python is on the path.
"""

import contextlib
import io
import itertools
import pathlib
import subprocess
import sys
import tempfile
import unittest

CLEAVED, CLEAVE, STUBS = sys.argv[1:4]

import make_stubs  # noqa: E402

make_stubs.make_stubs(pathlib.Path(STUBS))
sys.path.insert(1, STUBS)

import first_steps  # noqa: E402
import grpc  # noqa: E402
import numpy as np  # noqa: E402
from google.protobuf import json_format  # noqa: E402

from cleave.answers import Mesh  # noqa: E402
from cleave.client import CleaveError, Client, Region  # noqa: E402
from cleave.embedded import EmbeddedVertices  # noqa: E402
from cleave.events import read_events  # noqa: E402
from cleave.impurity_picture import (  # noqa: E402
    draw_impurities, shown_impurities, write_png)
from cleave.v1 import scene_pb2, session_pb2  # noqa: E402


def ply_points(path):
    """The vertices of a binary PLY file, n x 3."""
    head, _, body = path.read_bytes().partition(b"end_header\n")
    vertices = head.decode().split("element vertex ")[1].split("element face")[0].splitlines()
    kinds = {"float": "<f4", "uchar": "u1"}
    layout = [(name, kinds[kind]) for _, kind, name in map(str.split, vertices[1:])]
    table = np.frombuffer(body, layout, int(vertices[0]))
    return np.column_stack([table[axis] for axis in "xyz"])


class PythonClientTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls._folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls._folder.cleanup)
        cls.address = f"unix:{cls._folder.name}/socket"
        with open(f"{cls._folder.name}/log", "w") as log:
            cls.server = subprocess.Popen(
                [CLEAVED, "--listen", cls.address, "--data", f"{cls._folder.name}/data"],
                stdout=log, stderr=log)
        cls.addClassCleanup(cls.server.wait)
        cls.addClassCleanup(cls.server.terminate)

    def setUp(self):
        self.client = Client(self.address)
        self.addCleanup(self.client.close)

    def test_first_steps_break_a_bar(self):
        with contextlib.redirect_stdout(io.StringIO()) as output:
            first_steps.main(self.address)
        frames = [line for line in output.getvalue().splitlines() if line.startswith("frame")]
        self.assertEqual(len(frames), 25)
        self.assertNotIn(" 0 broken edges", frames[-1])
        self.assertEqual(len(self.client.sessions()), 0)

    def test_uploaded_mesh_is_simulated_and_comes_back(self):
        positions = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]], float)
        tets = np.array([[0, 1, 2, 3], [1, 2, 3, 4]])
        asset = self.client.upload_mesh(positions, tets, regions=[1, 2], region_names={1: "low"})
        self.assertEqual(self.client.upload_mesh(positions, tets, [1, 2], {1: "low"}), asset)
        scene = scene_pb2.Scene(
            mesh=scene_pb2.MeshSource(asset=asset, unit_scale=0.5),
            materials=[scene_pb2.Material(youngs_modulus=1e6, poisson_ratio=0.3, density=1000)],
            gravity=[0, 0, -10],
            timing=scene_pb2.Timing(frame_count=5),
        )
        session = self.client.create_session("two-tets", scene)
        self.addCleanup(session.delete)
        mesh = session.mesh()
        np.testing.assert_array_equal(mesh.positions, 0.5 * positions)
        self.assertEqual(len(mesh.edges()), 9)
        session.run()
        frames = list(session.frames())
        self.assertEqual([frame.number for frame in frames], list(range(6)))
        np.testing.assert_array_less(frames[-1].positions[:, 2], mesh.positions[:, 2])
        # Attached to later, and from the middle.
        again = self.client.session("two-tets")
        self.assertEqual([frame.number for frame in again.frames(3, 4)], [3, 4])
        np.testing.assert_array_equal(list(again.frames(5))[0].positions, frames[-1].positions)

    def test_render_mesh_is_there_for_all_who_join_and_breaks_with_the_body(self):
        # Half of the bar's four long sides, as triangles between 41 squares, a little outside of it.
        ring = np.array([[-0.1, -0.1], [1.1, -0.1], [1.1, 1.1], [-0.1, 1.1]]) * first_steps.SIDE
        points = np.array([[x, *corner] for x in np.linspace(0, first_steps.LENGTH, 41)
                           for corner in ring])
        triangles = np.array([[4 * i + j, 4 * i + j + 4, 4 * i + (j + 1) % 4]
                              for i in range(40) for j in range(4)])
        uvs = np.arange(6 * len(triangles), dtype="f4").reshape(-1, 3, 2)
        scene = first_steps.bar()
        scene.render_mesh.asset = self.client.upload_render_mesh(1000 * points, triangles, uvs)
        scene.render_mesh.unit_scale = 0.001
        session = self.client.create_session("clad", scene)
        self.addCleanup(session.delete)
        self.assertIsNone(self.client.create_session("bare", first_steps.bar()).render_mesh())
        self.client.session("bare").delete()
        session.run()
        joined = self.client.session("clad")
        shown = joined.render_mesh()
        np.testing.assert_allclose(shown.points, points, atol=1e-15)
        np.testing.assert_array_equal(shown.triangles, triangles)
        np.testing.assert_array_equal(shown.uvs, uvs)
        mesh = joined.mesh()
        # The command line's exports have the vertices where Python has them.
        recorded = pathlib.Path(self._folder.name) / "clad"
        for words in (["watch", "clad", "--server", self.address, "--out", recorded],
                      ["export", recorded, "--format", "ply"]):
            subprocess.run([CLEAVE, *words], check=True, capture_output=True)
        fine = EmbeddedVertices(mesh.positions, mesh.tets, shown.points)
        for frame in joined.frames(mesh=mesh):
            moved = fine.move(frame.positions, frame.broken_edges)
            exported = ply_points(recorded / "ply" / f"cleave_{frame.number:06}.ply")
            np.testing.assert_allclose(moved, exported[: len(points)], rtol=0, atol=2e-8)
            torn = fine.torn(shown.triangles)
            if frame.number == 0:
                np.testing.assert_allclose(moved, points, atol=1e-6)
                self.assertFalse(torn.any())
        self.assertTrue(torn.any())
        self.assertFalse(torn.all())
        triangles[3, 1] = len(points)
        with self.assertRaisesRegex(CleaveError, r"render_mesh.triangles\[3\]: point 164 is outside"):
            self.client.upload_render_mesh(points, triangles)
        scene.render_mesh.unit_scale = 1
        with self.assertRaisesRegex(CleaveError, "render_mesh.points: spans .* in the same units"):
            self.client.create_session("wrong", scene)
        scene.render_mesh.asset = "f" * 64
        with self.assertRaisesRegex(CleaveError, "the server has no asset f"):
            self.client.create_session("wrong", scene)

    def test_frames_tell_what_broke(self):
        session = self.client.create_session("told", first_steps.bar())
        self.addCleanup(session.delete)
        session.run()
        mesh = session.mesh()
        edges = mesh.edges()
        told = {}
        pieces = 1
        for frame in session.frames(mesh=mesh, events=True):
            told.update(zip(frame.events.edges.tolist(), frame.events.energies))
            self.assertEqual(sorted(told), frame.broken_edges.tolist())
            np.testing.assert_array_equal(edges[frame.events.edges], frame.events.nodes)
            np.testing.assert_allclose(
                mesh.positions[frame.events.nodes].mean(axis=1), frame.events.rest, atol=1e-12)
            for split in frame.events.splits:
                for separation in split.separations:
                    self.assertEqual(separation.part.piece, pieces)
                    self.assertLessEqual(separation.part.volume, split.kept.volume)
                    pieces += 1
            self.assertEqual(pieces, frame.fragments)
        self.assertGreater(len(told), 0)
        # From the middle, and without asking.
        stream = session.frames(first_frame=20, events=True)
        late = next(stream)
        self.assertEqual(late.number, 20)
        names = {piece.piece for piece in late.events.all_pieces}
        self.assertGreater(len(names), 0)
        for frame in itertools.chain([late], stream):
            for split in frame.events.splits:
                self.assertIn(split.kept.piece, names)
                names |= {separation.part.piece for separation in split.separations}
            self.assertEqual(len(names), frame.fragments)
        self.assertIsNone(next(iter(session.frames(20))).events)

    def test_viewers_ask_for_the_accuracy_that_they_need(self):
        session = self.client.create_session("accurate", first_steps.bar(), rung="fine")
        self.addCleanup(session.delete)
        session.run()
        mesh = session.mesh()
        fine = list(session.frames(mesh=mesh))
        preview = list(session.frames(mesh=mesh, rung="preview"))
        self.assertEqual(len(preview), len(fine))
        self.assertAlmostEqual(preview[0].tolerance / fine[0].tolerance, 100)
        for coarse, exact in zip(preview, fine):
            np.testing.assert_array_equal(coarse.broken_edges, exact.broken_edges)
            error = np.abs(coarse.positions - exact.positions).max()
            self.assertLessEqual(error, coarse.tolerance - exact.tolerance)
        latest = list(session.frames(mesh=mesh, tolerance=5 * fine[0].tolerance, latest=True))
        self.assertEqual(latest[0].tolerance, fine[0].tolerance)
        self.assertEqual(latest[-1].number, fine[-1].number)
        self.assertLess(len(latest), len(fine))
        # With what is told to be left out, every frame is accounted for.
        numbers = []
        for frame in latest:
            if frame.left_out is not None:
                numbers += range(frame.left_out[0], frame.left_out[1] + 1)
            numbers.append(frame.number)
        self.assertEqual(numbers, [frame.number for frame in fine])
        self.assertTrue(all(frame.left_out is None for frame in fine))
        with self.assertRaisesRegex(CleaveError, "is finer than"):
            list(session.frames(mesh=mesh, tolerance=0.5 * fine[0].tolerance))

    def test_a_region_is_as_accurate_as_asked_and_the_rest_is_coarser(self):
        session = self.client.create_session("region", first_steps.bar(), rung="fine")
        self.addCleanup(session.delete)
        session.run()
        mesh = session.mesh()
        kept = list(session.frames(mesh=mesh))
        box = ((-1e3, -1e3, -1e3), (-1e2, 1e3, 1e3))  # where nothing is
        seen = list(session.frames(mesh=mesh, rung="standard", region=Region(box=box)))
        self.assertEqual(len(seen), len(kept))
        for one, other in zip(seen, kept):
            error = np.abs(one.positions - other.positions).max(axis=1)
            self.assertTrue((error <= one.tolerances - other.tolerance).all())
            self.assertLessEqual(one.tolerances.max(), 10.001 * one.tolerance)
            self.assertGreater(one.tolerances.max(), 3 * one.tolerance)
        near = next(session.frames(mesh=mesh, rung="standard", region=Region((0,), None, "preview")))
        self.assertAlmostEqual(near.tolerances[0] / near.tolerance, 1)
        with self.assertRaisesRegex(CleaveError, "below twice"):
            next(session.frames(mesh=mesh, rung="fine", region=Region((0,))))

    def test_a_surface_view_tells_of_nodes_that_surfaces_need(self):
        session = self.client.create_session("surface", first_steps.bar(), rung="fine")
        self.addCleanup(session.delete)
        session.run()
        mesh = session.mesh()
        kept = list(session.frames(mesh=mesh))
        seen = list(session.frames(mesh=mesh, rung="standard", surface=True))
        self.assertEqual(len(seen), len(kept))
        for one, other in zip(seen, kept):
            np.testing.assert_array_equal(one.broken_edges, other.broken_edges)
            error = np.abs(one.positions - other.positions).max(axis=1)
            self.assertTrue((error[one.visible] <= one.tolerance - other.tolerance).all())
            self.assertTrue(np.isnan(one.positions[~one.visible]).all())
        self.assertIsNone(kept[0].visible)
        self.assertGreater(seen[-1].visible.sum(), seen[0].visible.sum())
        self.assertLess(seen[0].visible.sum(), len(mesh.positions))
        fine = EmbeddedVertices(mesh.positions, mesh.tets, mesh.positions[:1])
        with self.assertRaisesRegex(ValueError, "surface view"):
            fine.move(seen[0].positions, seen[0].broken_edges)

    def test_events_of_a_run_folder_are_read(self):
        place = '"rest":[1,2,3],"position":[1.5,2,3],"energy":0.25}'
        part = '"volume":0.5,"node_count":4,"first_node":%d,'
        folder = pathlib.Path(self._folder.name) / "run"
        folder.mkdir()
        (folder / "events.jsonl").write_text(
            '{"frame":4,"event":"edge_break","time":0.5,"edge":17,"nodes":[3,8],"pieces":[0,1],'
            + place + '\n{"frame":4,"event":"split","time":0.5,"piece":0,' + part % 0
            + '"separated":[1],' + place + '\n{"frame":4,"event":"separation","time":0.5,"piece":1,'
            + '"from":0,' + part % 8 + place + "\n")
        events = read_events(folder)
        self.assertEqual(list(events), [4])
        np.testing.assert_array_equal(events[4].nodes, [[3, 8]])
        np.testing.assert_array_equal(events[4].positions, [[1.5, 2, 3]])
        (split,) = events[4].splits
        self.assertEqual(split.separations[0].part.first_node, 8)
        self.assertEqual(split.separations[0].part.piece, 1)
        self.assertEqual(split.place.energy, 0.25)

    def test_session_is_stepped(self):
        session = self.client.create_session("stepped", first_steps.bar())
        self.addCleanup(session.delete)
        self.assertEqual(session.step(2).frames_done, 2)
        self.assertEqual(session.state().head_frame, 2)
        self.assertEqual(session.state().state, session_pb2.SESSION_STATE_IDLE)

    def test_probed_material_answers_in_arrays(self):
        self.assertIn("Wood Handbook", self.client.presets()["dry_wood"].sources[0])
        gradient = np.eye(3)
        gradient[0, 1] = 1e-4
        probe = self.client.probe("glass", [gradient, np.eye(3)], [[0, 0, 2]], samples=10)
        shear_modulus = 70e9 / 2.46
        np.testing.assert_allclose(probe.energy, [shear_modulus * 1e-8 / 2, 0], rtol=1e-6)
        self.assertAlmostEqual(probe.stress[0, 1, 0] / (shear_modulus * 1e-4), 1, places=6)
        self.assertAlmostEqual(probe.tangent[1, 0, 1, 1, 0] / shear_modulus, 1, places=9)
        (curve,) = probe.curves
        self.assertEqual(curve.end, "TENSILE_STRENGTH")
        np.testing.assert_allclose(curve.nominal_stress[-1], 45e6, rtol=1e-9)
        np.testing.assert_allclose(curve.strain, np.linspace(0, curve.strain[-1], 11))
        along, across = self.client.probe("dry_wood").curves
        self.assertGreater(along.youngs_modulus, 10 * across.youngs_modulus)
        with self.assertRaises(CleaveError) as caught:
            self.client.probe(scene_pb2.Material(youngs_modulus=-1), samples=0)
        self.assertEqual([field for field, _ in caught.exception.faults],
                         ["material.youngs_modulus", "material.density", "samples"])

    def test_impurities_are_previewed_as_arrays(self):
        def layer(**source):
            return scene_pb2.ImpurityLayer(potency=4, weakening=0.5, **source)

        line = scene_pb2.Polyline(points=[0.31, -9, 0, 0.31, 9, 0])
        scene = scene_pb2.Scene(
            mesh=scene_pb2.MeshSource(box=scene_pb2.BoxMesh(
                size=[1, 0.5, 0.25],
                resolution=scene_pb2.MeshResolution(
                    layout=scene_pb2.MESH_LAYOUT_JITTERED_LATTICE, cell_size=0.125))),
            materials=[scene_pb2.Material(youngs_modulus=1e6, density=1000, tensile_strength=2000)],
            impurities=scene_pb2.Impurities(
                layers=[layer(strokes=scene_pb2.Strokes(curves=[line]))]),
        )
        preview = self.client.preview_impurity(scene, with_edges=True)
        self.assertEqual(preview.potencies.shape, (9 * 5 * 3,))
        self.assertEqual(set(preview.potencies), {0, 4})
        self.assertEqual(preview.edges.shape, (preview.affected_edges, 2))
        self.assertLess(preview.affected_edges, preview.edge_count)
        cut = preview.weakenings == 0.5
        self.assertGreater(cut.sum(), 15)
        # Crossed edges have impure ends, and lie across the stroke.
        self.assertTrue((preview.potencies[preview.edges[cut]] == 4).all())
        self.assertEqual(preview.strengths.min(), preview.weakest)
        self.assertLess(preview.weakest, 1000)
        self.assertAlmostEqual(preview.strongest, 2000)
        self.assertEqual(self.client.preview_impurity(scene).edges.size, 0)
        # Shares of nodes from an array.
        shares = np.linspace(0, 1, len(preview.potencies))
        scene.impurities.layers[0].CopyFrom(
            layer(node_values=scene_pb2.NodeValues(shares=shares)))
        np.testing.assert_allclose(self.client.preview_impurity(scene).potencies, 4 * shares)

        # The upper half of a picture on the side of the box, and no end of strength.
        picture = np.zeros((8, 8), np.uint8)
        picture[:4] = 255
        scene.impurities.layers[0].CopyFrom(layer(paint=scene_pb2.SurfacePaint(
            depth=2, vertices=[0, 0, 0, 1, 0, 0, 1, 0.5, 0, 0, 0.5, 0], triangles=[0, 1, 2, 0, 2, 3],
            texture=scene_pb2.SurfaceTexture(
                width=8, height=8, values=picture.tobytes(), wrap=scene_pb2.TEXTURE_WRAP_CLAMP,
                uvs=[0, 0, 1, 0, 1, 1, 0, 0, 1, 1, 0, 1]))))
        scene.impurities.layers[0].weakening = float("inf")
        loaded = json_format.Parse(json_format.MessageToJson(scene), scene_pb2.Scene())
        self.assertIn('"Infinity"', json_format.MessageToJson(scene))
        preview = self.client.preview_impurity(loaded, with_edges=True)
        # Two of five layers of nodes on either side of the middle.
        self.assertEqual((preview.potencies == 0).sum(), 2 * 9 * 3)
        self.assertEqual((preview.potencies == 4).sum(), 2 * 9 * 3)
        self.assertTrue(np.isinf(preview.weakenings[preview.weakenings != 1]).all())
        self.assertTrue(np.isinf(preview.strongest))

        scene.impurities.layers[0].CopyFrom(
            layer(pattern=scene_pb2.SegmentPattern(image=scene_pb2.ImageDrawing(file="star.png"))))
        scene.impurities.layers.append(layer(strokes=scene_pb2.Strokes(
            curves=[scene_pb2.Polyline(points=[5, 0, 0, 6, 0, 0])])))
        scene.impurities.layers.append(layer(node_values=scene_pb2.NodeValues(shares=[1, 0])))
        with self.assertRaises(CleaveError) as caught:
            self.client.preview_impurity(scene)
        self.assertEqual([field for field, _ in caught.exception.faults],
                         ["scene.impurities.layers[0].pattern.image.file",
                          "scene.impurities.layers[1].strokes.curves[0]",
                          "scene.impurities.layers[2].node_values.shares"])
        with self.assertRaises(CleaveError) as caught:
            self.client.preview_impurity(first_steps.bar())
        self.assertEqual(caught.exception.faults[0][0], "scene.impurities")

    def test_impurities_are_drawn_in_magenta_on_yellow(self):
        scene = first_steps.bar()
        session = self.client.create_session("drawn", scene)
        mesh = session.mesh()
        session.delete()
        scene.impurities.layers.add(
            potency=3, bands={"axis": [1, 0, 0], "position": 0.05, "width": 0.03})
        preview = self.client.preview_impurity(scene, with_edges=True)
        picture = draw_impurities(mesh, preview, width=200, azimuth=-90, elevation=0)
        self.assertEqual(picture.shape[1:], (200, 3))
        middle = picture[len(picture) // 2].astype(int)
        red, green, blue = middle.T
        np.testing.assert_array_equal(middle[[0, 1, -2, -1]], 245)  # beside the body
        yellow, magenta = green > 2 * blue, blue > 2 * green
        at = 0.05 + (np.arange(200) - 99.5) / 180 * first_steps.LENGTH
        self.assertTrue(yellow[(at > 0.002) & (at < 0.02) | (at > 0.08) & (at < 0.098)].all())
        self.assertTrue(magenta[abs(at - 0.05) < 0.008].all())
        self.assertGreater(red[100], 100)
        # What only weakens is shown as well, and a cut as most.
        scene.impurities.layers[0].ClearField("potency")
        scene.impurities.layers[0].weakening = 0
        cut = self.client.preview_impurity(scene, with_edges=True)
        np.testing.assert_array_equal(shown_impurities(cut) == 1, preview.potencies == 3)

        # The server's own, of the same body.
        self.assertEqual(cut.picture_png, b"")
        for options, width in ({}, 960), ({"width": 100, "azimuth": 5, "elevation": 40}, 100):
            drawn = self.client.preview_impurity(scene, picture=options).picture_png
            self.assertEqual(drawn[:8], b"\x89PNG\r\n\x1a\n")
            self.assertEqual(int.from_bytes(drawn[16:20], "big"), width)
        with self.assertRaises(CleaveError) as caught:
            self.client.preview_impurity(scene, picture={"width": 0})
        self.assertEqual([field for field, _ in caught.exception.faults], ["picture.width"])

        path = f"{self._folder.name}/drawn.png"
        write_png(path, picture)
        with open(path, "rb") as file:
            self.assertEqual(file.read(8), b"\x89PNG\r\n\x1a\n")
        with self.assertRaisesRegex(ValueError, "the mesh has 4"):
            draw_impurities(Mesh(np.eye(4, 3), np.array([[0, 1, 2, 3]])), preview)

    def test_pictures_become_patterns(self):
        grey = np.full((60, 80), 255, np.uint8)
        grey[28:32, 10:70] = 0
        curve, = self.client.trace_drawing(grey)
        points = np.array(curve.points).reshape(-1, 2)
        # One line across the middle, in units of the picture's width.
        np.testing.assert_allclose(points[:, 1], 0, atol=0.01)
        np.testing.assert_allclose(sorted(points[[0, -1], 0]), [-0.36, 0.36], atol=0.03)
        self.assertEqual(len(curve.half_widths), 0)
        wide, = self.client.trace_drawing(grey, keep_width=True)
        np.testing.assert_allclose(np.median(wide.half_widths), 2 / 80, atol=0.01)
        # The same of floats, of colours, through what is transparent, and of its negative.
        rgba = np.zeros((60, 80, 4))
        rgba[..., 3] = grey == 0
        for picture, bright in [(grey / 255, False), (np.stack(3 * [grey], -1), False),
                                (rgba, False), (255 - grey, True)]:
            self.assertEqual(self.client.trace_drawing(picture, bright=bright), [curve])

        scene = first_steps.bar()
        scene.impurities.layers.add(weakening=0.5, pattern=scene_pb2.SegmentPattern(
            curves=[curve], origin=[0.05, 0.01, 0], scale=0.05))
        self.assertGreater(self.client.preview_impurity(scene).affected_edges, 20)

        for picture, options, field in [(np.full((4, 4), 255, np.uint8), {}, "pixels"),
                                        (grey, {"threshold": 1}, "image.threshold"),
                                        (grey, {"tolerance": float("nan")}, "image.tolerance"),
                                        (np.zeros((0, 4), np.uint8), {}, "height")]:
            with self.assertRaises(CleaveError) as caught:
                self.client.trace_drawing(picture, **options)
            self.assertEqual([name for name, _ in caught.exception.faults], [field])
        for picture in [np.zeros(5), np.zeros((5, 5, 2)), np.full((5, 5), 1.5), np.zeros((3000, 3000))]:
            with self.assertRaisesRegex(ValueError, "pixels"):
                self.client.trace_drawing(picture)

    def test_what_makes_a_scene_too_large_is_named(self):
        scene = first_steps.bar()
        scene.impurities.layers.add(potency=1, noise=scene_pb2.NoiseField())
        scene.impurities.layers.add(potency=1, node_values=scene_pb2.NodeValues(
            shares=np.zeros(600_000)))
        for call in [self.client.preview_impurity,
                     lambda large: self.client.create_session("large", large)]:
            with self.assertRaises(CleaveError) as caught:
                call(scene)
            self.assertEqual(caught.exception.code, grpc.StatusCode.RESOURCE_EXHAUSTED)
            self.assertEqual(caught.exception.faults[0][0],
                             "scene.impurities.layers[1].node_values.shares")

    def test_session_keeps_the_numbers_of_a_preset(self):
        scene = first_steps.bar()
        scene.materials[0].Clear()
        scene.materials[0].preset = "cheese"
        session = self.client.create_session("cheese", scene)
        self.addCleanup(session.delete)
        material = session.state().scene.materials[0]
        self.assertEqual((material.name, material.preset), ("cheese", ""))
        self.assertEqual(material.youngs_modulus, 113e3)
        scene.materials[0].preset = "chese"
        with self.assertRaises(CleaveError) as caught:
            self.client.create_session("chese", scene)
        self.assertEqual(caught.exception.faults[0][0], "scene.materials[0].preset")

    def test_every_fault_of_a_scene_is_named_by_field(self):
        scene = first_steps.bar()
        scene.materials[0].poisson_ratio = 0.7
        scene.materials[0].density = -1
        with self.assertRaises(CleaveError) as caught:
            self.client.create_session("bad", scene)
        self.assertEqual(caught.exception.code, grpc.StatusCode.INVALID_ARGUMENT)
        self.assertEqual({field for field, _ in caught.exception.faults},
                         {"scene.materials[0].poisson_ratio", "scene.materials[0].density"})

    def test_a_server_that_does_not_answer_is_named(self):
        with self.assertRaisesRegex(CleaveError, "no server answers at unix:/nowhere within 0.1 s"):
            Client("unix:/nowhere", connect_seconds=0.1)

    def test_unknown_session_is_not_found(self):
        with self.assertRaises(CleaveError) as caught:
            self.client.session("nobody")
        self.assertEqual(caught.exception.code, grpc.StatusCode.NOT_FOUND)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]])
