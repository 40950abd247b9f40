#include "client/cli/scene_input.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <system_error>
#include <type_traits>
#include <utility>
#include <variant>

#include "absl/strings/cord.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "client/cli/render_mesh_input.h"
#include "client/cpp/rpc_error.h"
#include "client/io/impurity/layer_files.h"
#include "client/io/impurity/trim_paint.h"
#include "client/io/mesh/file_bytes.h"
#include "client/io/mesh/mesh_file.h"
#include "client/io/surface/surface_file.h"
#include "core/base/status.h"
#include "core/mesh/mesh_check.h"
#include "core/mesh/procedural.h"
#include "core/scene/render_mesh_rules.h"
#include "core/scene/validate.h"
#include "proto/convert/mesh.h"
#include "proto/convert/scene.h"

namespace cleave {
namespace {

bool IsSceneName(const std::string& path) {
  for (const char* ending : {".json", ".textproto", ".txtpb", ".pbtxt"})
    if (absl::EndsWith(path, ending)) return true;
  return false;
}

std::string DescribeFaults(const std::string& path, const Faults& faults) {
  std::string text =
      absl::StrJoin(faults.errors(), "\n", [&path](std::string* out, const Fault& fault) {
        absl::StrAppend(out, path, ": ", fault.field, fault.field.empty() ? "" : ": ",
                        fault.description);
      });
  const long more = faults.error_count() - static_cast<long>(faults.errors().size());
  if (more > 0) absl::StrAppend(&text, "\n", path, ": and ", more, " faults more");
  return text;
}

void AppendWarnings(const std::string& prefix, const Faults& faults, std::vector<Fault>& all) {
  for (const Fault& warning : faults.warnings())
    all.push_back({absl::StrCat(prefix, warning.field), warning.description});
}

// Puts what the surface files of colliders hold in the place of their names: servers see no files.
void ReadColliderSurfaces(SceneFile& file, std::vector<Fault>& faults) {
  for (int i = 0; i < file.scene.colliders_size(); ++i) {
    v1::Collider& collider = *file.scene.mutable_colliders(i);
    if (collider.surface().file().empty()) continue;
    v1::SurfaceShape& shape = *collider.mutable_surface();
    const std::string field = absl::StrCat("colliders[", i, "].surface.file");
    if (shape.vertices_size() > 0 || shape.triangles_size() > 0) {
      faults.push_back({field, "stands beside vertices or triangles; give one of both"});
      continue;
    }
    const auto surface = ReadSurfaceFile(PathBeside(file, shape.file()));
    if (!surface.ok()) {
      faults.push_back({field, std::string(surface.status().message())});
      continue;
    }
    for (const Vec3& vertex : surface->vertices)
      shape.mutable_vertices()->Add(vertex.begin(), vertex.end());
    for (const auto& triangle : surface->triangles)
      shape.mutable_triangles()->Add(triangle.begin(), triangle.end());
    shape.clear_file();
  }
}

void ReadRenderMesh(SceneInput& input, std::vector<Fault>& faults) {
  const v1::RenderMeshSource& source = input.file.scene.render_mesh();
  if (source.file().empty()) return;
  constexpr char kField[] = "render_mesh.file";
  auto mesh = ReadRenderMeshFile(PathBeside(input.file, source.file()));
  if (!mesh.ok()) {
    faults.push_back({kField, std::string(mesh.status().message())});
    return;
  }
  input.render_mesh = *std::move(mesh);
  if (const int64_t open = CountOpenEdges(input.render_mesh->triangles); open > 0)
    input.warnings.push_back({kField, OpenEdgesNote(open)});
}

// The rules of the scene alone, but of fields at fault already. A file as mesh or render mesh
// stands for the asset that it will be.
void CheckScene(SceneInput& input, std::vector<Fault>& faults) {
  Faults found;
  input.scene = SceneFromMessage(input.file.scene, found);
  Scene as_sent = input.scene;
  if (std::holds_alternative<MeshFile>(as_sent.mesh.source))
    as_sent.mesh.source = MeshAsset{std::string(64, '0')};
  if (as_sent.render_mesh && std::holds_alternative<MeshFile>(as_sent.render_mesh->source))
    as_sent.render_mesh->source = MeshAsset{std::string(64, '0')};
  found.Append("", ValidateScene(as_sent));
  AppendWarnings("", found, input.warnings);
  const std::vector<Fault> known = faults;
  std::copy_if(found.errors().begin(), found.errors().end(), std::back_inserter(faults),
               [&](const Fault& fault) {
                 return std::none_of(known.begin(), known.end(), [&](const Fault& earlier) {
                   return earlier.field == fault.field;
                 });
               });
}

absl::Status CheckWithMesh(SceneInput& input, const std::string& mesh_path) {
  TetMesh mesh = *input.mesh;
  ScaleMesh(input.scene.mesh.unit_scale, mesh);
  const Faults mesh_faults = CheckAndOrientMesh(mesh);
  AppendWarnings(absl::StrCat(mesh_path, ": "), mesh_faults, input.warnings);
  if (!mesh_faults.ok()) return absl::InvalidArgumentError(DescribeFaults(mesh_path, mesh_faults));
  const Faults scene_faults = CheckWithBody(input, mesh);
  AppendWarnings("", scene_faults, input.warnings);
  if (!scene_faults.ok())
    return absl::InvalidArgumentError(input.file.Describe(scene_faults.errors()));
  return absl::OkStatus();
}

// Makes a scene that is too large for servers smaller, or says which layer makes it so large.
absl::Status FitMessage(SceneInput& input) {
  v1::Scene& message = input.file.scene;
  if (message.ByteSizeLong() <= kMostSceneBytes || !message.has_impurities())
    return absl::OkStatus();
  if (const absl::StatusOr<TetMesh> mesh = SceneMesh(input); mesh.ok()) {
    TrimPaint(input.scene, *mesh, message);
    Faults none;  // as many as before
    input.scene = SceneFromMessage(message, none);
  }
  if (message.ByteSizeLong() <= kMostSceneBytes) return absl::OkStatus();
  int largest = 0;
  for (int k = 1; k < message.impurities().layers_size(); ++k) {
    const v1::Impurities& impurities = message.impurities();
    if (impurities.layers(k).ByteSizeLong() > impurities.layers(largest).ByteSizeLong())
      largest = k;
  }
  const bool layered = message.impurities().layers_size() > 0;
  const size_t bytes = layered ? message.impurities().layers(largest).ByteSizeLong()
                               : message.impurities().ByteSizeLong();
  return absl::InvalidArgumentError(input.file.Describe(
      {{layered ? absl::StrCat("impurities.layers[", largest, "]") : "impurities",
        absl::StrFormat("holds %.1f MiB; a scene with all its layers travels in %.1f MiB",
                        static_cast<double>(bytes) / (1 << 20),
                        static_cast<double>(kMostSceneBytes) / (1 << 20))}}));
}

// All that follows the reading of the scene file.
absl::Status Complete(SceneInput& input) {
  std::vector<Fault> faults;
  ReadColliderSurfaces(input.file, faults);
  if (input.file.scene.has_impurities()) {
    const std::vector<Fault> of_layers =
        ReadLayerFiles(PathBeside(input.file, ""), *input.file.scene.mutable_impurities());
    faults.insert(faults.end(), of_layers.begin(), of_layers.end());
  }
  ReadRenderMesh(input, faults);
  CheckScene(input, faults);
  const std::string mesh_path = MeshPath(input.file);
  if (!faults.empty()) {
    // What is in the mesh waits: it may take long to read.
    std::error_code error;
    if (!mesh_path.empty() && !std::filesystem::exists(mesh_path, error))
      faults.push_back({"mesh.file", absl::StrCat(mesh_path, " is not there")});
    return absl::InvalidArgumentError(input.file.Describe(faults));
  }
  if (mesh_path.empty()) return FitMessage(input);
  CLEAVE_ASSIGN_OR_RETURN(input.mesh, ReadMeshFile(mesh_path));
  CLEAVE_RETURN_IF_ERROR(CheckWithMesh(input, mesh_path));
  return FitMessage(input);
}

bool IsOfScene(absl::string_view field) {
  const std::string first(field.substr(0, field.find_first_of(".[")));
  return v1::Scene::descriptor()->FindFieldByName(first) != nullptr;
}

// What says a field of a call on the command line.
absl::string_view OptionOf(absl::string_view field) {
  if (field == "session_id") return "--session";
  if (field == "threads") return "--threads";
  return field == "rung" ? "--rung" : field;
}

}  // namespace

absl::StatusOr<SceneInput> LoadScene(const std::string& path) {
  SceneInput input;
  CLEAVE_ASSIGN_OR_RETURN(input.file, ReadSceneFile(path));
  CLEAVE_RETURN_IF_ERROR(Complete(input));
  return input;
}

absl::StatusOr<SceneInput> LoadSceneWithLayers(const std::string& path, double unit_scale,
                                               const std::vector<v1::ImpurityLayer>& layers) {
  SceneInput input;
  if (IsSceneName(path)) {
    CLEAVE_ASSIGN_OR_RETURN(input.file, ReadSceneFile(path));
  } else {
    input.file.path = path;
    v1::Scene& scene = input.file.scene;
    scene.mutable_mesh()->set_file(std::filesystem::path(path).filename().string());
    scene.mutable_mesh()->set_unit_scale(unit_scale);
    v1::Material& material = *scene.add_materials();
    material.set_youngs_modulus(1);
    material.set_density(1);
    material.set_poisson_ratio(0.3);
    material.set_tensile_strength(1);
  }
  for (const v1::ImpurityLayer& layer : layers)
    *input.file.scene.mutable_impurities()->add_layers() = layer;
  CLEAVE_RETURN_IF_ERROR(Complete(input));
  return input;
}

Faults CheckWithBody(const SceneInput& input, const TetMesh& mesh) {
  Faults faults = ValidateSceneWithMesh(input.scene, mesh);
  if (input.render_mesh.has_value()) {
    RenderMesh render = *input.render_mesh;
    ScaleMesh(input.scene.render_mesh->unit_scale, render);
    faults.Append("render_mesh.", CheckRenderMeshFits(render, mesh.rest_positions));
  }
  return faults;
}

absl::StatusOr<TetMesh> SceneMesh(const SceneInput& input) {
  absl::StatusOr<TetMesh> mesh = std::visit(
      [&input](const auto& source) -> absl::StatusOr<TetMesh> {
        using Source = std::decay_t<decltype(source)>;
        if constexpr (std::is_same_v<Source, MeshFile>) {
          return *input.mesh;
        } else if constexpr (std::is_same_v<Source, MeshAsset>) {
          return absl::FailedPreconditionError(
              absl::StrCat(input.file.path, ": mesh.asset is known to servers only"));
        } else if constexpr (std::is_same_v<Source, std::monostate>) {
          return absl::InvalidArgumentError(absl::StrCat(input.file.path, ": has no mesh"));
        } else {
          return BuildMesh(source);
        }
      },
      input.scene.mesh.source);
  if (!mesh.ok()) return mesh;
  ScaleMesh(input.scene.mesh.unit_scale, *mesh);
  return mesh;
}

absl::StatusOr<TetMesh> ReadAnyMesh(const std::string& path, double unit_scale) {
  if (unit_scale != 1 && (IsSceneName(path) || absl::EndsWith(path, ".pb"))) {
    return absl::InvalidArgumentError(absl::StrCat(
        "--unit-scale: ", path, " says itself what unit it has; only other mesh files need it"));
  }
  if (IsSceneName(path)) {
    CLEAVE_ASSIGN_OR_RETURN(const SceneFile file, ReadSceneFile(path));
    SceneInput input;
    input.file = file;
    Faults faults;
    input.scene = SceneFromMessage(file.scene, faults);
    if (!faults.ok()) return absl::InvalidArgumentError(file.Describe(faults.errors()));
    const std::string mesh_path = MeshPath(file);
    if (!mesh_path.empty()) {
      CLEAVE_ASSIGN_OR_RETURN(input.mesh, ReadMeshFile(mesh_path));
    }
    return SceneMesh(input);
  }
  if (absl::EndsWith(path, ".pb")) {
    CLEAVE_ASSIGN_OR_RETURN(const std::string bytes, ReadFileBytes(path));
    auto mesh = ParseMesh(bytes);
    if (mesh.ok()) return mesh;
    return absl::Status(mesh.status().code(), absl::StrCat(path, ": ", mesh.status().message()));
  }
  CLEAVE_ASSIGN_OR_RETURN(TetMesh mesh, ReadMeshFile(path));
  ScaleMesh(unit_scale, mesh);
  return mesh;
}

absl::Status WithLines(const SceneFile& file, const absl::Status& status) {
  std::vector<Fault> of_scene;
  std::vector<std::string> lines;  // of the call
  for (const Fault& fault : FaultsOf(status)) {
    if (IsOfScene(fault.field)) {
      of_scene.push_back(fault);
    } else {
      lines.push_back(absl::StrCat(OptionOf(fault.field), ": ", fault.description));
    }
  }
  if (!of_scene.empty()) lines.push_back(file.Describe(of_scene));
  if (lines.empty()) return status;
  absl::Status named(status.code(), absl::StrJoin(lines, "\n"));
  status.ForEachPayload([&named](absl::string_view type, const absl::Cord& payload) {
    named.SetPayload(type, payload);
  });
  return named;
}

}  // namespace cleave
