#ifndef CLEAVE_TESTS_STABILITY_HOSTILE_INPUT_H_
#define CLEAVE_TESTS_STABILITY_HOSTILE_INPUT_H_

#include <functional>
#include <string>
#include <vector>

#include "core/mesh/tet_mesh.h"
#include "core/scene/scene.h"
#include "core/simulation/simulation.h"

// The hostile inputs of the method note, section 12, by its numbers: what must be refused by name,
// what must be accepted with a warning, and what must simulate. Each is tried in float and double.

namespace cleave {

struct HostileBody {
  Scene scene;
  TetMesh mesh;
};

enum class Verdict { kRefused, kWarned, kSimulated };

struct HostileInput {
  int number;        // of the method note's list
  const char* name;  // a fact, in CamelCase
  Verdict verdict;
  // The field that the fault must name and a part of what it must say; empty where it simulates.
  const char* field;
  const char* says;
  int frames;  // to simulate, where it is not refused
  std::function<HostileBody()> make;
  // What else must hold at the end, besides finite numbers; empty: nothing. Returns what is wrong.
  std::function<std::string(const Simulation&)> check = {};
};

// A soft cube of 3x3x3 cells under gravity on its pinned floor, at default quality.
HostileBody SoftCube();
// The same cube with its floor free.
HostileBody FreeCube();
// A cube whose lid goes down by `depth` of its height in 0.2 s.
HostileBody CrushedCube(double depth);

std::vector<HostileInput> RefusedInputs();
std::vector<HostileInput> WarnedInputs();
std::vector<HostileInput> SimulatedInputs();

}  // namespace cleave

#endif  // CLEAVE_TESTS_STABILITY_HOSTILE_INPUT_H_
