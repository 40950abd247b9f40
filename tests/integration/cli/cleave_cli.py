"""What tests of the command line share: the real programs, a small scene, a folder a test.

Each test is run as: VERB_test.py CLEAVE CLEAVED SCENE [unittest arguments]
"""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

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

    def serve(self):
        """Starts a server that ends with the test; (its process, its address)."""
        address = f"unix:{self.folder}/socket"
        with open(self.folder / "log", "w") as log:
            server = subprocess.Popen([CLEAVED, "--listen", address, "--data", self.folder / "data"],
                                      stdout=log, stderr=log)
        self.addCleanup(server.wait)
        self.addCleanup(server.terminate)
        return server, address


def main():
    """Runs the tests of the file that is run."""
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]])
