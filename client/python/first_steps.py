#!/usr/bin/python3
"""Breaks a bar: first steps with Cleave in Python.

Start a server, generate the stubs once, and run this:

    cleaved --listen unix:/tmp/cleave.sock --data /tmp/cleave-data &
    client/python/make_stubs.py
    client/python/first_steps.py unix:/tmp/cleave.sock
"""

import sys
import uuid

import numpy as np

from cleave.client import Client
from cleave.v1 import scene_pb2 as scene

LENGTH, SIDE = 0.1, 0.02  # m


def bar():
    """A soft bar, held at its left end and pulled at its right until it breaks."""
    box = scene.BoxMesh(
        size=[LENGTH, SIDE, SIDE],
        resolution=scene.MeshResolution(
            layout=scene.MESH_LAYOUT_JITTERED_LATTICE, cell_size=SIDE / 4
        ),
    )
    ends = {"left": [-1, 0, 0], "right": [1, 0, 0]}
    return scene.Scene(
        name="first steps",
        mesh=scene.MeshSource(box=box),
        materials=[
            scene.Material(
                youngs_modulus=1e6, poisson_ratio=0.3, density=1000, tensile_strength=5e4
            )
        ],
        node_sets=[
            scene.NodeSet(
                name=name,
                select=[
                    scene.Selector(
                        plane=scene.PlaneSelector(
                            point=[0 if name == "left" else LENGTH, 0, 0], normal=normal
                        )
                    )
                ],
            )
            for name, normal in ends.items()
        ],
        motions=[
            scene.Motion(node_set="left"),
            scene.Motion(
                node_set="right",
                keyframes=[
                    scene.Keyframe(time=0),
                    scene.Keyframe(time=0.1, translation=[0.2 * LENGTH, 0, 0]),
                ],
            ),
        ],
        timing=scene.Timing(frames_per_second=240, frame_count=24),
    )


def main(address):
    with Client(address) as client:
        print(f"server {client.server.server_version} at {address}")
        session = client.create_session(f"first-steps-{uuid.uuid4().hex[:6]}", bar())
        mesh = session.mesh()
        print(f"{len(mesh.positions)} nodes, {len(mesh.tets)} tets, {len(mesh.edges())} edges")
        session.run()
        for frame in session.frames(mesh=mesh):
            stretch = np.ptp(frame.positions[:, 0]) / LENGTH
            print(
                f"frame {frame.number:3}  {frame.time:.4f} s  stretch {stretch:.3f}  "
                f"{len(frame.broken_edges)} broken edges  {frame.fragments} pieces"
            )
        session.delete()


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
