"""`cleave run` with a server of its own, and `export` and `preview` of what it leaves."""

import json
import os
import signal
import struct
import subprocess

from cleave_cli import BLOCK, CLEAVE, SECONDS, CliTest, cleave, environment, main


# A closed mesh in millimetres with texture coordinates.
FINE = ("v 0 0 0\nv 400 0 0\nv 0 100 0\nv 0 0 100\nvt 0 0\nvt 1 0\nvt 0 0.625\n"
        "f 1/1 3/2 2/3\nf 1/1 2/2 4/3\nf 2/1 3/2 4/3\nf 1/1 4/2 3/3\n")
RENDER_MESH = '"render_mesh": {"file": "fine.obj", "unit_scale": 0.001},'


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
        code, output, errors = cleave("preview", out, "--still", "last", "--width", "64")
        self.assertEqual((code, output), (0, f"{out}/still_000004.png\n"), errors)

    def test_run_that_failed_by_the_machine_goes_on_when_that_is_mended(self):
        scene, out = self.scene(BLOCK % 4), self.folder / "out"
        self.assertEqual(cleave("run", scene, "--out", out, "-q", "--frames", "2")[0], 0)
        (session,) = (out / "server" / "sessions").iterdir()
        checkpoints, aside = session / "checkpoints", session / "aside"
        checkpoints.rename(aside)
        checkpoints.touch()
        code, _, errors = cleave("run", scene, "--out", out, "-q")
        self.assertEqual(code, 5, errors)
        self.assertIn("Not a directory", errors)
        checkpoints.unlink()
        aside.rename(checkpoints)
        code, _, errors = cleave("run", scene, "--out", out, "-q")
        self.assertEqual(code, 0, errors)
        self.assertEqual(cleave("run", scene, "--out", self.folder / "whole", "-q")[0], 0)
        self.assertEqual((out / "frames.clv").read_bytes(),
                         (self.folder / "whole" / "frames.clv").read_bytes())

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

    def test_render_mesh_of_the_scene_is_shown_and_changes_no_bit_of_the_run(self):
        bare, out = self.folder / "bare", self.folder / "out"
        self.assertEqual(cleave("run", self.scene(BLOCK % 2), "--out", bare, "-q")[0], 0)
        (self.folder / "fine.obj").write_text(FINE)
        text = (BLOCK % 2).replace('"gravity"', RENDER_MESH + ' "gravity"')
        code, output, errors = cleave("run", self.scene(text), "--out", out, "--ply")
        self.assertEqual(code, 0, errors)
        self.assertIn(f"{out}/render_mesh.pb\n{out}/events.jsonl\n", output)
        self.assertEqual((out / "frames.clv").read_bytes(), (bare / "frames.clv").read_bytes())
        first = (out / "ply" / "cleave_000000.ply").read_bytes()
        self.assertTrue(b"texcoord" in first)
        self.assertEqual(cleave("export", out, "--format", "obj")[0], 0)
        self.assertIn("vt 0 0.625", (out / "obj" / "cleave_000002.obj").read_text())
        self.assertEqual(cleave("export", out, "--format", "obj", "--own-surface", "--to",
                                self.folder / "own")[0], 0)
        self.assertNotIn("vt 0 0.625", (self.folder / "own" / "cleave_000002.obj").read_text())
        self.assertEqual(cleave("export", out / "frames.clv", "--format", "vtu-volume")[0], 0)
        shown, own = self.folder / "shown", self.folder / "own"
        for folder, options in ((shown, ()), (own, ("--own-surface",))):
            code, _, errors = cleave("preview", out, "--still", "2", "--width", "64", "--to", folder,
                                     *options)
            self.assertEqual(code, 0, errors)
        self.assertNotEqual((shown / "still_000002.png").read_bytes(),
                            (own / "still_000002.png").read_bytes())
        code, _, errors = cleave("export", out, "--own-surface", "--render-mesh", "fine.obj")
        self.assertEqual(code, 3)
        self.assertIn("--own-surface: shows no render mesh", errors)
        # Bad ones are told with their line.
        code, _, errors = cleave("validate", self.scene(text.replace("0.001", "1")))
        self.assertEqual(code, 3)
        self.assertIn("block.scene.json:8: render_mesh.points: spans 424.264 m, the body 0.424264 m",
                      errors)
        (self.folder / "fine.obj").write_text(FINE.replace("400", "nan"))
        code, _, errors = cleave("run", self.scene(text), "--out", self.folder / "bad")
        self.assertEqual(code, 3)
        self.assertIn("block.scene.json:8: render_mesh.file: ", errors)
        # A damaged one in a run's folder.
        (out / "render_mesh.pb").write_bytes((out / "render_mesh.pb").read_bytes()[:-7])
        code, _, errors = cleave("export", out, "--format", "ply")
        self.assertEqual(code, 3)
        self.assertIn("render_mesh.pb: ", errors)

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
        code, _, errors = cleave("export", out, "--name", "a\nb")
        self.assertEqual(code, 3)
        self.assertIn('--name: "a\\nb" holds a control character', errors)

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
        code, _, errors = cleave("export", out, "--format", "ply", "--last", "0")
        self.assertEqual(code, 0, errors)
        self.assertIn("was cut after frame", errors)
        code, _, errors = cleave("run", scene, "--out", out, "-q", "--frames", frames[-1] + 20)
        self.assertEqual(code, 0, errors)


if __name__ == "__main__":
    main()
