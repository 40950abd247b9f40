"""Blender's glTF importer on the GLB; run inside Blender, with -- FOLDER.

Asserts that each frame shows one shape key, and that every vertex then is where the point cache of the same
run has a point of the same rest position.
"""

import collections
import struct
import sys

import bpy
import numpy as np

np.bool = bool  # Debian's importer is older than its numpy

folder = sys.argv[sys.argv.index("--") + 1]
with open(folder + "/bake-pc2/cleave.pc2", "rb") as file:
  data = file.read()
count, frames = struct.unpack_from("<i", data, 16)[0], struct.unpack_from("<i", data, 28)[0]
cache = np.frombuffer(data, "<f4", 3 * count * frames, 32).reshape(frames, count, 3)
rest = []
with open(folder + "/bake-pc2/cleave.obj", encoding="ascii") as file:
  for line in file:
    if line.startswith("v "):
      rest.append(tuple(np.float32(text) for text in line.split()[1:]))
copies = collections.defaultdict(list)
for point, place in enumerate(rest):
  copies[place].append(point)

bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.context.scene.render.fps = 24
bpy.ops.import_scene.gltf(filepath=folder + "/glb/cleave.glb")
assert len(bpy.data.objects) == 1
body = bpy.data.objects[0]
assert len(body.data.shape_keys.key_blocks) == frames + 1
assert {"outside_gauge", "inside_gauge"} <= {slot.name for slot in body.material_slots}
# The importer turns the file's y up to z, the node turns it back: undone here without rounding.
assert np.allclose(body.matrix_world, [[1, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]],
                   atol=1e-6)


def positions_of(mesh):
  values = np.empty(3 * len(mesh.vertices), np.float32)
  mesh.vertices.foreach_get("co", values)
  values = values.reshape(-1, 3)
  return np.stack([values[:, 0], values[:, 2], -values[:, 1]], axis=1)


base = positions_of(body.data)
places = [copies[tuple(place)] for place in base]
assert all(places), "a vertex at rest is at no point of the bake"

# Copies of a point share their rest position: a vertex is the one that it follows through all frames.
distance = [np.zeros(len(points)) for points in places]
for frame in range(frames):
  bpy.context.scene.frame_set(frame)
  weights = [key.value for key in body.data.shape_keys.key_blocks[1:]]
  assert abs(weights[frame] - 1) < 1e-4 and abs(sum(weights) - 1) < 1e-4, (frame, weights)
  shown = positions_of(body.evaluated_get(bpy.context.evaluated_depsgraph_get()).data)
  for vertex, points in enumerate(places):
    distance[vertex] = np.maximum(distance[vertex],
                                  np.abs(cache[frame][points] - shown[vertex]).max(axis=1))
worst = max(each.min() for each in distance)
assert worst < 2e-6, worst
print(f"glb: {frames} frames of {len(base)} vertices, at most {worst} m off")
