#ifndef CLEAVE_TESTS_UNIT_CLIENT_IO_SCENE_FULL_SCENE_H_
#define CLEAVE_TESTS_UNIT_CLIENT_IO_SCENE_FULL_SCENE_H_

// A scene that uses every kind of value: numbers, whole numbers as numbers and as strings, names,
// lists, oneofs, explicit presence, escapes.
inline constexpr char kFullScene[] = R"json({
  "name": "notched b\u00e4r \ud83d\ude00 \"x\"",
  "mesh": {
    "box": {
      "origin": [0, -0.5, 1e-3],
      "size": [1, 0.25, 0.25],
      "resolution": {"layout": "MESH_LAYOUT_JITTERED_LATTICE", "cellSize": 0.05, "jitter": 0.1, "seed": 4294967295}
    },
    "unit_scale": 0.001
  },
  "materials": [
    {"name": "body", "youngs_modulus": 2.0E5, "poisson_ratio": 0.3, "density": 1000},
    {"name": "notch", "regions": ["left", "7"], "youngs_modulus": 1e5, "poisson_ratio": 0.2,
     "density": 900, "tensile_strength": 1234.5}
  ],
  "node_sets": [
    {"name": "ends", "select": [
      {"box": {"min": [0, 0, 0], "max": [0.01, 1, 1]}},
      {"sphere": {"center": [1, 0, 0], "radius": 0.1}},
      {"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}},
      {"region": "left"},
      {"ids": {"ids": [0, "1", 2, -3]}}
    ]}
  ],
  "motions": [
    {"node_set": "ends", "axes": ["AXIS_X", "AXIS_Z"],
     "keyframes": [{"time": 0}, {"time": 1.5, "translation": [0.1, 0, 0], "rotation": 3.14}]}
  ],
  "initial_velocities": [{"velocity": [0, 0, -1]}],
  "gravity": [0, 0, -9.81],
  "fracture": {"max_passes": 60, "simultaneity": 0.9},
  "timing": {"frames_per_second": 24, "frame_count": "48", "steps_per_frame": 4},
  "quality": {"newton_iterations": 8, "linear_tolerance": 1e-3, "max_step_halvings": 0},
  "output": {"keyframe_interval": 24},
  "seed": 7
}
)json";

#endif  // CLEAVE_TESTS_UNIT_CLIENT_IO_SCENE_FULL_SCENE_H_
