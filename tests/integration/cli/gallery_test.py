"""`cleave gallery`: a page of runs and verdicts."""

import base64
import csv
import pathlib
import signal
import struct
import subprocess

from cleave_cli import CLEAVE, SECONDS, CliTest, cleave, environment, main


class Gallery(CliTest):
    def gallery(self, *arguments):
        return cleave("gallery", "locality", "--out", self.folder / "gallery", "--seeds", "1",
                      "--layout", "unstructured", "--coarseness", "2", "--width", "64", *arguments)

    def test_a_page_shows_pictures_criteria_and_verdicts(self):
        code, output, errors = self.gallery()
        self.assertEqual(code, 0, errors)
        page = self.folder / "gallery" / "index.html"
        table = self.folder / "gallery" / "verdicts.csv"
        self.assertEqual(output.split(), [str(page), str(table)])
        text = page.read_text()
        self.assertIn("nothing differs in any bit", text)
        self.assertIn('class="good">met</td>', text)
        self.assertIn("5 of 5 verdicts are as they should be", errors)
        with table.open(newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual({(row["scene"], row["seeds"], row["verdict"]) for row in rows},
                         {("locality", "1", "met"), ("locality", "1", "fails, as it should")})
        frame = next(row for row in rows if row["measured"] == "first frame that differs")
        self.assertGreater(float(frame["values"]), 2)
        picture = next((self.folder / "gallery" / "pictures").glob("locality-with-*.png"))
        self.assertEqual(struct.unpack(">I", picture.read_bytes()[16:20])[0], 64)
        self.assertIn(base64.b64encode(picture.read_bytes()).decode(), text)

        # What is done is kept, and the page is the same to the last byte.
        code, _, errors = self.gallery()
        self.assertEqual((code, page.read_text()), (0, text))
        self.assertIn("3 of 3 runs are there", errors)
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
        self.assertIn("3 of 3 runs failed", errors)
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


if __name__ == "__main__":
    main()
