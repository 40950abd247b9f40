"""Verbs that ask a server: submit, step, watch, list, plan, cancel, info."""

import json
import signal
import subprocess

from cleave_cli import BLOCK, CLEAVE, SECONDS, CliTest, cleave, environment, main


class Server(CliTest):
    def setUp(self):
        super().setUp()
        self.server, self.address = self.serve()

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
        code, output, errors = self.ask("watch", "block", "--from", "5", "--json")
        self.assertEqual(code, 0, errors)
        self.assertEqual(json.loads(output.splitlines()[-1])["frame"], 6)
        code, output, errors = self.ask("watch", "block", "--from", "7", "--json")
        self.assertEqual((code, output), (3, ""), errors)
        self.assertIn("--from: 7 is outside [0, 6]: block rests at frame 6", errors)
        code, output, _ = self.ask("list", "--json")
        self.assertEqual([json.loads(line)["name"] for line in output.splitlines()],
                         ["sessions/block"])
        self.assertEqual(self.ask("cancel", "block", "--delete")[0], 0)
        self.assertEqual(self.ask("watch", "block")[0], 6)
        code, output, _ = self.ask("info", "--json")
        info = json.loads(output)
        self.assertEqual(info["api_versions"], ["cleave.v1"])
        self.assertIn("region", info["features"])

    def test_interrupted_step_pauses_its_session_and_tells_how_far_it_came(self):
        scene = self.scene(BLOCK % 2)
        self.assertEqual(self.ask("submit", scene, "--idle", "--session", "block")[0], 0)
        stepping = subprocess.Popen([CLEAVE, "step", "block", "-n", "9999", "--server", self.address],
                                    stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                    env=environment(), start_new_session=True)
        self.addCleanup(stepping.kill)
        state = {}
        while int(state.get("head_frame", 0)) < 2:
            state = json.loads(self.ask("list", "--json")[1])
        stepping.send_signal(signal.SIGINT)
        output, errors = stepping.communicate(timeout=SECONDS)
        self.assertEqual(stepping.returncode, 130, errors)
        self.assertRegex(errors, "stopped after [0-9]+ frames")
        self.assertIn("idle", output)
        self.assertEqual(json.loads(self.ask("list", "--json")[1])["state"], "SESSION_STATE_IDLE")

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
        seen = self.folder / "seen"
        code, _, errors = self.ask("watch", "fine", "--surface", "--out", seen)
        self.assertEqual(code, 0, errors)
        self.assertIn("(standard)", errors)
        for made in ("ply", "obj", "vtu"):
            self.assertEqual(cleave("export", seen, "--format", made, "--last", "1")[0], 0)
        for made in ("vtu-volume", "bake-pc2"):
            code, _, errors = cleave("export", seen, "--format", made)
            self.assertEqual(code, 7, errors)
            self.assertIn("surface view", errors)
        region = ("watch", "fine", "--rung", "standard", "--region-node", 0, "--region-node", 3)
        code, output, errors = self.ask(*region, "--outside", "preview", "--json")
        self.assertEqual(code, 0, errors)
        first = json.loads(output.splitlines()[0])
        self.assertAlmostEqual(first["outside_tolerance"] / first["tolerance"], 10)
        code, _, errors = self.ask(*region, "--region-box", 0, 0, 0, -1, 1, 1)
        self.assertEqual(code, 3, errors)
        self.assertIn("region.box.max: (-1, 1, 1) m is outside [0, inf) along x", errors)
        self.assertEqual(self.ask("watch", "fine", "--region-node", 0, "--outside", "far")[0], 2)
        self.assertEqual(self.ask("watch", "fine", "--outside", "preview")[0], 3)
        self.assertEqual(self.ask("watch", "fine", "--rung", "fine", "--tolerance", 1)[0], 2)
        code, _, errors = self.ask("run", scene, "--out", self.folder / "run", "--rung", "preview")
        self.assertEqual(code, 0, errors)
        self.assertIn("(preview)", errors)
        code, _, errors = self.ask("run", scene, "--out", self.folder / "run", "--rung", "standard")
        self.assertEqual(code, 7, errors)
        self.assertIn("keeps its frames at rung preview", errors)

    def test_whoever_wants_the_latest_is_told_what_is_left_out(self):
        scene = self.scene((BLOCK % 9).replace('"timing"', '"output": {"keyframe_interval": 4}, "timing"'))
        self.assertEqual(self.ask("submit", scene, "--idle", "--session", "block")[0], 0)
        self.assertEqual(self.ask("step", "block", "-n", "9")[0], 0)
        code, output, errors = self.ask("watch", "block", "--latest", "--json")
        self.assertEqual(code, 0, errors)
        gap, *frames = map(json.loads, output.splitlines())
        self.assertEqual(gap, {"event": "gap", "first_frame": 0, "last_frame": 7})
        self.assertEqual([frame["frame"] for frame in frames], [8, 9])
        code, _, errors = self.ask("watch", "block", "--latest")
        self.assertIn("8 frames were left out to keep up", errors)
        self.assertEqual(self.ask("watch", "block", "--latest", "--out", self.folder / "out")[0], 2)

    def test_render_mesh_comes_with_a_recording_of_a_session(self):
        (self.folder / "fine.obj").write_text(
            "v 0 0 0\nv 0.4 0 0\nv 0 0.1 0\nv 0 0 0.1\nvt 0 0\n"
            "f 1/1 3/1 2/1\nf 1/1 2/1 4/1\nf 2/1 3/1 4/1\nf 1/1 4/1 3/1\n")
        text = (BLOCK % 2).replace('"gravity"', '"render_mesh": {"file": "fine.obj"}, "gravity"')
        self.assertEqual(self.ask("submit", self.scene(text), "--session", "clad")[0], 0)
        out = self.folder / "out"
        code, output, errors = self.ask("watch", "clad", "--out", out)
        self.assertEqual(code, 0, errors)
        self.assertIn(f"{out}/render_mesh.pb", output.split())
        code, _, errors = cleave("export", out, "--format", "ply")
        self.assertEqual(code, 0, errors)
        self.assertTrue(b"texcoord" in (out / "ply" / "cleave_000000.ply").read_bytes())

    def test_name_taken_by_another_scene_exits_7_and_bad_name_3(self):
        scene = self.scene(BLOCK % 2)
        self.assertEqual(self.ask("submit", scene, "--idle", "--session", "block")[0], 0)
        self.assertEqual(self.ask("submit", scene, "--idle", "--session", "block")[0], 0)  # again
        code, _, errors = self.ask("submit", self.scene(BLOCK % 3), "--idle", "--session", "block")
        self.assertEqual(code, 7, errors)
        code, _, errors = self.ask("submit", scene, "--session", "Not A Name")
        self.assertEqual(code, 3)
        self.assertEqual(errors.splitlines()[-1][:24], '--session: "Not A Name" ')
        code, _, errors = self.ask("watch", "Not A Name")
        self.assertEqual(code, 3)
        self.assertIn("2 to 62 letters, digits or dashes", errors)

    def test_plan_names_parts_and_costs_without_a_session(self):
        code, output, errors = self.ask("plan", self.scene(BLOCK % 2), "--json")
        self.assertEqual(code, 0, errors)
        plan = json.loads(output)
        self.assertGreater(int(plan["tet_count"]), 100)
        self.assertEqual(self.ask("list", "--json")[1], "")


if __name__ == "__main__":
    main()
