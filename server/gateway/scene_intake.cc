#include "server/gateway/scene_intake.h"

#include <optional>
#include <utility>
#include <variant>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "core/base/faults.h"
#include "core/base/status.h"
#include "core/mesh/incidence.h"
#include "core/mesh/mesh_check.h"
#include "core/mesh/procedural.h"
#include "core/model/footprint.h"
#include "core/scene/render_mesh_rules.h"
#include "core/scene/scene.h"
#include "core/scene/validate.h"
#include "google/rpc/error_details.pb.h"
#include "proto/convert/mesh.h"
#include "proto/convert/scene.h"
#include "server/gateway/errors.h"

namespace cleave {
namespace {

bool IsSound(absl::string_view part, const Faults& faults) {
  for (const Fault& fault : faults.errors()) {
    if (absl::StartsWith(fault.field, part)) return false;
  }
  return true;
}

absl::Status MissingAsset(const std::string& sha256) {
  absl::Status status = MakeError(
      absl::StatusCode::kFailedPrecondition, "ASSET_MISSING",
      absl::StrCat("the server has no asset ", sha256, "; upload it first"), {{"asset", sha256}});
  google::rpc::PreconditionFailure failure;
  google::rpc::PreconditionFailure::Violation& violation = *failure.add_violations();
  violation.set_type("ASSET_MISSING");
  violation.set_subject(sha256);
  violation.set_description("upload it first");
  AddDetail(failure, status);
  return status;
}

// The mesh in its own units. Faults of the source go to `faults`, and then there is no mesh.
absl::StatusOr<std::optional<TetMesh>> ObtainMesh(const MeshSource& mesh, const AssetStore& assets,
                                                  bool other_faults, Faults& faults) {
  if (std::holds_alternative<MeshFile>(mesh.source)) {
    faults.Error("mesh.file", "names a file of the client: upload it and send its asset");
    return std::nullopt;
  }
  if (const auto* asset = std::get_if<MeshAsset>(&mesh.source)) {
    if (!assets.Has(asset->sha256)) {
      // With other faults it is one among them; alone it has its own code.
      if (!other_faults) return MissingAsset(asset->sha256);
      faults.Error("mesh.asset", "the server has no such asset; upload it first");
      return std::nullopt;
    }
    CLEAVE_ASSIGN_OR_RETURN(TetMesh loaded, assets.LoadMesh(asset->sha256));
    if (loaded.tet_count() > assets.limits().max_tets) {  // it came as an asset of another kind
      return MakeError(absl::StatusCode::kResourceExhausted, "TET_QUOTA",
                       absl::StrCat("the mesh has ", loaded.tet_count(),
                                    " tets; this server takes ", assets.limits().max_tets));
    }
    return loaded;
  }
  return std::visit(
      [&](const auto& shape) -> absl::StatusOr<std::optional<TetMesh>> {
        if constexpr (requires { BuildMesh(shape); }) {
          if (const double tets = EstimateTets(shape);
              tets > static_cast<double>(assets.limits().max_tets)) {
            return MakeError(absl::StatusCode::kResourceExhausted, "TET_QUOTA",
                             absl::StrCat("the mesh would have about ", static_cast<int64_t>(tets),
                                          " tets; this server takes ", assets.limits().max_tets));
          }
          CLEAVE_ASSIGN_OR_RETURN(TetMesh built, BuildMesh(shape));
          return built;
        } else {
          faults.Error("mesh", "needs a source");
          return std::nullopt;
        }
      },
      mesh.source);
}

// Holds a render mesh to its rules, and to the body's where that is sound (else null).
absl::Status CheckRenderMeshOf(const RenderMeshSource& source, const TetMesh* body,
                               const AssetStore& assets, bool other_faults, Faults& faults) {
  const auto* asset = std::get_if<MeshAsset>(&source.source);
  if (asset == nullptr) return absl::OkStatus();  // is a fault already
  if (!assets.Has(asset->sha256)) {
    if (!other_faults) return MissingAsset(asset->sha256);
    faults.Error("render_mesh.asset", "the server has no such asset; upload it first");
    return absl::OkStatus();
  }
  CLEAVE_ASSIGN_OR_RETURN(RenderMesh mesh, assets.LoadRenderMesh(asset->sha256));
  Faults own = CheckRenderMesh(mesh);
  if (own.ok() && body != nullptr) {
    ScaleMesh(source.unit_scale, mesh);
    own = CheckRenderMeshFits(mesh, body->rest_positions);
  }
  faults.Append("render_mesh.", own);
  return absl::OkStatus();
}

v1::Plan PlanOf(const Scene& scene, const TetMesh& mesh) {
  v1::Plan plan;
  plan.set_node_count(mesh.node_count());
  plan.set_tet_count(mesh.tet_count());
  plan.set_edge_count(BuildIncidence(mesh).edge_count());
  const Footprint footprint =
      PlanModel(scene, plan.node_count(), plan.tet_count(), plan.edge_count());
  for (const Part& part : footprint.parts) {
    v1::PlanPart& listed = *plan.add_parts();
    listed.set_name(part.name);
    listed.set_bytes(part.bytes);
  }
  plan.set_total_bytes(footprint.total_bytes);
  plan.set_seconds_per_frame(footprint.seconds_per_frame);
  plan.set_total_seconds(footprint.total_seconds);
  return plan;
}

// CheckSceneAndMesh. Also gives `message` the numbers of its presets and, when `store_mesh`, the
// asset of a procedural mesh.
absl::StatusOr<CheckedScene> Check(v1::Scene& message, const Faults& request_faults,
                                   AssetStore& assets, bool store_mesh) {
  Faults faults;
  ResolvePresets(message, faults);  // a session keeps the numbers, whatever presets become
  CheckedScene checked;
  checked.scene = SceneFromMessage(message, faults);
  const Scene& scene = checked.scene;
  faults.Append("", ValidateScene(scene));
  std::optional<TetMesh> mesh;
  if (IsSound("mesh", faults)) {
    CLEAVE_ASSIGN_OR_RETURN(
        mesh, ObtainMesh(scene.mesh, assets, !(faults.ok() && request_faults.ok()), faults));
  }
  if (mesh.has_value()) {
    if (store_mesh && faults.ok() && request_faults.ok() &&
        !std::holds_alternative<MeshAsset>(scene.mesh.source)) {
      CLEAVE_ASSIGN_OR_RETURN(const std::string bytes, SerializeMesh(*mesh));
      CLEAVE_ASSIGN_OR_RETURN(*message.mutable_mesh()->mutable_asset(), assets.Add(bytes));
    }
    ScaleMesh(scene.mesh.unit_scale, *mesh);
    const Faults mesh_faults = CheckAndOrientMesh(*mesh);
    faults.Append("mesh.", mesh_faults);
    if (mesh_faults.ok()) faults.Append("", ValidateSceneWithMesh(scene, *mesh));
  }
  if (scene.render_mesh.has_value() && IsSound("render_mesh", faults)) {
    const bool has_body = mesh.has_value() && IsSound("mesh", faults);
    CLEAVE_RETURN_IF_ERROR(CheckRenderMeshOf(*scene.render_mesh, has_body ? &*mesh : nullptr,
                                             assets, !(faults.ok() && request_faults.ok()),
                                             faults));
  }
  Faults all = request_faults;
  all.Append("scene.", faults);
  if (!all.ok()) return MakeBadRequest("PARAM_OUT_OF_RANGE", "", all);
  for (const Fault& warning : faults.warnings())
    checked.warnings.push_back(absl::StrCat(warning.field, ": ", warning.description));
  checked.mesh = *std::move(mesh);
  return checked;
}

}  // namespace

absl::StatusOr<CheckedScene> CheckSceneAndMesh(const v1::Scene& message,
                                               const Faults& request_faults, AssetStore& assets) {
  v1::Scene resolved = message;
  return Check(resolved, request_faults, assets, false);
}

absl::StatusOr<AcceptedScene> AcceptScene(const v1::Scene& message, const Faults& request_faults,
                                          AssetStore& assets, bool store_mesh) {
  AcceptedScene accepted;
  accepted.scene = message;
  CLEAVE_ASSIGN_OR_RETURN(CheckedScene checked,
                          Check(accepted.scene, request_faults, assets, store_mesh));
  accepted.warnings = std::move(checked.warnings);
  accepted.plan = PlanOf(checked.scene, checked.mesh);
  return accepted;
}

}  // namespace cleave
