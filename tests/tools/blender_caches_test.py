"""Blender's Mesh Cache on the baked OBJ with its PC2 and MDD; run inside Blender, with -- FOLDER.

Asserts that every vertex of every frame is where the file says, that groups are pieces and materials are
outer and inside faces. With a second argument, also renders a frame of the break to that PNG file.
"""

import struct
import sys

import bpy
import numpy as np

arguments = sys.argv[sys.argv.index("--") + 1:]
folder = arguments[0]


def cache_of(path):
  with open(path, "rb") as file:
    data = file.read()
  if path.endswith(".pc2"):
    assert data[:12] == b"POINTCACHE2\0"
    _, count, start, sampling, frames = struct.unpack_from("<iiffi", data, 12)
    assert (start, sampling) == (0, 1)
    values = np.frombuffer(data, "<f4", 3 * count * frames, 32)
  else:
    frames, count = struct.unpack_from(">ii", data)
    times = np.frombuffer(data, ">f4", frames, 8)
    assert np.allclose(times, np.arange(frames) / 24, atol=1e-6)
    values = np.frombuffer(data, ">f4", 3 * count * frames, 8 + 4 * frames)
  return values.astype(np.float32).reshape(frames, count, 3)


def shown(body):
  mesh = body.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
  positions = np.empty(3 * len(mesh.vertices), np.float32)
  mesh.vertices.foreach_get("co", positions)
  return positions.reshape(-1, 3)


def load(kind):
  bpy.ops.wm.read_factory_settings(use_empty=True)
  bpy.ops.wm.obj_import(filepath=f"{folder}/bake-{kind}/cleave.obj", forward_axis="Y", up_axis="Z",
                        import_vertex_groups=True)
  assert len(bpy.data.objects) == 1
  body = bpy.data.objects[0]
  modifier = body.modifiers.new("bake", "MESH_CACHE")
  modifier.cache_format = kind.upper()
  modifier.filepath = f"{folder}/bake-{kind}/cleave.{kind}"
  return body


for kind in ("mdd", "pc2"):
  body = load(kind)
  cache = cache_of(f"{folder}/bake-{kind}/cleave.{kind}")
  assert np.allclose(body.matrix_world, np.eye(4))
  assert len(body.data.vertices) == cache.shape[1]
  worst = 0
  for frame in range(len(cache)):
    bpy.context.scene.frame_set(frame)
    worst = max(worst, np.abs(shown(body) - cache[frame]).max())
  assert worst < 1e-7, worst
  groups = {group.name for group in body.vertex_groups}
  assert {"piece_0", "piece_1"} <= groups, groups
  materials = {slot.name for slot in body.material_slots}
  assert {"outside_gauge", "inside_gauge"} <= materials, materials
  assert len(body.data.uv_layers) == 1
  print(f"{kind}: {len(cache)} frames of {cache.shape[1]} points, at most {worst} m off")

if len(arguments) > 1:
  scene = bpy.context.scene
  scene.frame_set(len(cache) - 1)
  low, high = cache[-1].min(axis=0), cache[-1].max(axis=0)
  center, size = (low + high) / 2, np.linalg.norm(high - low)
  camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
  camera.data.lens, camera.data.clip_start = 60, 0.01 * size
  camera.location = center + size * np.array([0.14, -0.62, 0.4])
  target = bpy.data.objects.new("target", None)
  target.location = center
  sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
  sun.data.energy, sun.data.angle = 4.5, 0.1
  sun.rotation_euler = (0.7, -0.35, 0.3)
  for each in (camera, target, sun):
    scene.collection.objects.link(each)
  look = camera.constraints.new("TRACK_TO")
  look.target = target
  bpy.ops.mesh.primitive_plane_add(size=6 * size, location=(center[0], center[1], low[2]))
  ground = bpy.data.materials.new("ground")
  ground.use_nodes = True
  ground.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (0.5, 0.5, 0.5, 1)
  bpy.context.object.data.materials.append(ground)
  scene.world = bpy.data.worlds.new("world")
  scene.world.use_nodes = True
  scene.world.node_tree.nodes["Background"].inputs[0].default_value = (0.32, 0.34, 0.38, 1)
  scene.camera = camera
  scene.render.engine = "CYCLES"
  scene.cycles.samples = 64
  scene.cycles.use_denoising = False  # Debian builds Blender without the denoiser
  scene.view_settings.view_transform = "Standard"
  scene.render.resolution_x, scene.render.resolution_y = 800, 380
  scene.render.image_settings.color_mode = "RGB"
  scene.render.filepath = arguments[1]
  bpy.ops.render.render(write_still=True)
