#include <string>

#include "absl/strings/str_cat.h"
#include "proto/convert/scene_parts.h"

namespace cleave {
namespace {

MeshResolution Resolution(const std::string& field, const v1::MeshResolution& message,
                          const FieldReader& read) {
  MeshResolution resolution;
  switch (message.layout()) {
    case v1::MESH_LAYOUT_UNSPECIFIED:
    case v1::MESH_LAYOUT_UNSTRUCTURED:
      resolution.layout = MeshLayout::kUnstructured;
      break;
    case v1::MESH_LAYOUT_JITTERED_LATTICE:
      resolution.layout = MeshLayout::kJitteredLattice;
      break;
    default:
      read.faults().Error(field + ".layout",
                          absl::StrCat(static_cast<int>(message.layout()), " is not a MeshLayout"));
  }
  resolution.cell_size = message.cell_size();
  if (message.has_jitter()) resolution.jitter = message.jitter();
  if (message.has_seed()) resolution.seed = message.seed();
  return resolution;
}

}  // namespace

MeshSource MeshSourceFromMessage(const v1::MeshSource& message, const FieldReader& read) {
  MeshSource mesh;
  if (message.has_unit_scale()) mesh.unit_scale = message.unit_scale();
  switch (message.source_case()) {
    case v1::MeshSource::kFile:
      mesh.source = MeshFile{message.file()};
      break;
    case v1::MeshSource::kAsset:
      mesh.source = MeshAsset{message.asset()};
      break;
    case v1::MeshSource::kBox: {
      BoxMesh box;
      box.origin = read.Vector("mesh.box.origin", message.box().origin(), box.origin);
      box.size = read.RequiredVector("mesh.box.size", message.box().size(), {1, 1, 1});
      box.resolution = Resolution("mesh.box.resolution", message.box().resolution(), read);
      mesh.source = box;
      break;
    }
    case v1::MeshSource::kCylinder: {
      CylinderMesh cylinder;
      cylinder.origin = read.Vector("mesh.cylinder.origin", message.cylinder().origin(), {0, 0, 0});
      cylinder.radius = message.cylinder().radius();
      cylinder.height = message.cylinder().height();
      cylinder.resolution =
          Resolution("mesh.cylinder.resolution", message.cylinder().resolution(), read);
      mesh.source = cylinder;
      break;
    }
    case v1::MeshSource::kTube: {
      TubeMesh tube;
      tube.origin = read.Vector("mesh.tube.origin", message.tube().origin(), {0, 0, 0});
      tube.outer_radius = message.tube().outer_radius();
      tube.inner_radius = message.tube().inner_radius();
      tube.height = message.tube().height();
      tube.resolution = Resolution("mesh.tube.resolution", message.tube().resolution(), read);
      mesh.source = tube;
      break;
    }
    case v1::MeshSource::kDisc: {
      DiscMesh disc;
      disc.origin = read.Vector("mesh.disc.origin", message.disc().origin(), {0, 0, 0});
      disc.radius = message.disc().radius();
      disc.thickness = message.disc().thickness();
      disc.resolution = Resolution("mesh.disc.resolution", message.disc().resolution(), read);
      mesh.source = disc;
      break;
    }
    case v1::MeshSource::SOURCE_NOT_SET:
      break;
  }
  return mesh;
}

RenderMeshSource RenderMeshSourceFromMessage(const v1::RenderMeshSource& message) {
  RenderMeshSource mesh;
  if (message.has_unit_scale()) mesh.unit_scale = message.unit_scale();
  switch (message.source_case()) {
    case v1::RenderMeshSource::kFile:
      mesh.source = MeshFile{message.file()};
      break;
    case v1::RenderMeshSource::kAsset:
      mesh.source = MeshAsset{message.asset()};
      break;
    case v1::RenderMeshSource::SOURCE_NOT_SET:
      break;
  }
  return mesh;
}

}  // namespace cleave
