#include "client/io/export/export_series.h"

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/string_view.h"
#include "client/io/export/obj.h"
#include "client/io/export/ply.h"
#include "client/io/export/volume_cells.h"
#include "client/io/export/vtu.h"
#include "client/io/series/data_key.h"
#include "client/io/series/moved_points.h"
#include "client/io/series/surface_sequence.h"
#include "client/io/series/write_aside.h"
#include "core/base/state_hash.h"
#include "core/base/status.h"

namespace cleave {
namespace {

std::vector<int32_t> PointPieces(const ShownSurface& surface) {
  std::vector<int32_t> pieces(surface.points.size(), -1);
  for (size_t i = 0; i < surface.triangles.size(); ++i) {
    for (const int32_t point : surface.triangles[i]) {
      pieces[static_cast<size_t>(point)] = surface.pieces[i];
    }
  }
  return pieces;
}

VtuGrid SurfaceGrid(const SurfaceSequence& sequence) {
  const ShownSurface& surface = sequence.surface();
  VtuGrid grid;
  grid.time = surface.time;
  grid.points = surface.points;
  for (const auto& triangle : surface.triangles) {
    grid.connectivity.insert(grid.connectivity.end(), triangle.begin(), triangle.end());
    grid.offsets.push_back(static_cast<int64_t>(grid.connectivity.size()));
  }
  grid.types.assign(surface.triangles.size(), kVtuTriangle);
  const std::vector<int32_t> pieces = PointPieces(surface);
  grid.point_data.push_back(MakeVtuArray<int32_t>("piece", pieces));
  // Those of a render mesh have none that would last.
  const bool has_ids = sequence.embedded() == nullptr;
  if (has_ids)
    grid.point_data.push_back(MakeVtuArray<uint64_t>("id", sequence.topology().point_ids));
  grid.point_data.push_back(MakeVtuVectors("rest", surface.rest_points));
  grid.point_data.push_back(MakeVtuVectors("displacement", surface.displacements));
  grid.point_data.push_back(MakeVtuVectors("velocity", surface.velocities));
  grid.point_data.push_back(MakeVtuArray<float>("strain", surface.strains));
  grid.point_data.push_back(MakeVtuArray<float>("damage", surface.damages));
  if (!surface.potencies.empty()) {
    grid.point_data.push_back(MakeVtuArray<float>("potency", surface.potencies));
  }
  if (has_ids)
    grid.cell_data.push_back(MakeVtuArray<uint64_t>("id", sequence.topology().triangle_ids));
  grid.cell_data.push_back(MakeVtuArray<int32_t>("piece", surface.pieces));
  grid.cell_data.push_back(MakeVtuArray<int32_t>("region", surface.regions));
  grid.cell_data.push_back(MakeVtuArray<uint8_t>("inside", surface.inside));
  grid.cell_data.push_back(MakeVtuArray<int32_t>("tet", sequence.topology().tets));
  return grid;
}

// The volume's cells and where their points are, kept from frame to frame.
class VolumeSequence {
 public:
  VolumeSequence(const TetMesh& mesh, const SurfaceSequence& sequence,
                 const std::vector<double>& node_potencies)
      : mesh_(mesh),
        sequence_(sequence),
        node_potencies_(node_potencies),
        moved_(mesh, sequence.incidence()) {}

  // Call after every Advance of the sequence.
  void Advance(const Frame& frame) {
    const bool changed = sequence_.changed();
    if (changed) cells_ = BuildVolumeCells(mesh_, sequence_.topology().tet_masks);
    moved_.Advance(cells_.topology, changed, frame.positions, frame.time, true);
  }

  VtuGrid Grid(const Frame& frame) const {
    VtuGrid grid;
    grid.time = frame.time;
    grid.points = moved_.points();
    grid.connectivity = cells_.connectivity;
    grid.offsets = cells_.offsets;
    grid.types = cells_.types;
    AddData(frame, grid);
    return grid;
  }

 private:
  void AddData(const Frame& frame, VtuGrid& grid) const {
    const std::vector<float> tet_strains = sequence_.TetStrains(frame.positions);
    const std::vector<float> tet_damages = sequence_.TetDamages();
    std::vector<int32_t> point_pieces;
    for (const int32_t node : cells_.point_nodes) point_pieces.push_back(Piece(node));
    std::vector<int32_t> pieces;
    std::vector<int32_t> regions;
    std::vector<float> strains;
    std::vector<float> damages;
    std::vector<uint8_t> broken;
    std::vector<uint8_t> separated;
    for (size_t cell = 0; cell < cells_.types.size(); ++cell) {
      const auto tet = static_cast<size_t>(cells_.cell_tets[cell]);
      const EdgeMask mask = cells_.topology.tet_masks[tet];
      pieces.push_back(Piece(cells_.cell_nodes[cell]));
      regions.push_back(mesh_.region_of(cells_.cell_tets[cell]));
      // A separated tet spans a gap, which is no strain.
      strains.push_back(Separated(mask) ? 0.0f : tet_strains[tet]);
      damages.push_back(tet_damages[tet]);
      broken.push_back(static_cast<uint8_t>(__builtin_popcount(mask)));
      separated.push_back(Separated(mask) ? 1 : 0);
    }
    grid.point_data.push_back(MakeVtuArray<int32_t>("piece", point_pieces));
    const std::vector<Vec3> displacements = Displacements(cells_.topology, grid.points);
    std::vector<Vec3> rest_points;
    for (const SurfacePoint& point : cells_.topology.points) rest_points.push_back(point.rest);
    grid.point_data.push_back(MakeVtuVectors("rest", rest_points));
    grid.point_data.push_back(MakeVtuVectors("displacement", displacements));
    grid.point_data.push_back(MakeVtuVectors("velocity", moved_.velocities()));
    if (!node_potencies_.empty()) {
      grid.point_data.push_back(MakeVtuArray<float>("potency", PointPotencies()));
    }
    grid.cell_data.push_back(MakeVtuArray<int32_t>("piece", pieces));
    grid.cell_data.push_back(MakeVtuArray<int32_t>("region", regions));
    grid.cell_data.push_back(MakeVtuArray<int32_t>("tet", cells_.cell_tets));
    grid.cell_data.push_back(MakeVtuArray<float>("strain", strains));
    grid.cell_data.push_back(MakeVtuArray<float>("damage", damages));
    grid.cell_data.push_back(MakeVtuArray<uint8_t>("broken_edges", broken));
    grid.cell_data.push_back(MakeVtuArray<uint8_t>("separated", separated));
  }
  std::vector<float> PointPotencies() const {
    std::vector<float> potencies;
    for (const SurfacePoint& point : cells_.topology.points) {
      double mean = 0;
      for (size_t k = 0; k < point.node_count; ++k) {
        mean += point.weights[k] * node_potencies_[static_cast<size_t>(point.nodes[k])];
      }
      potencies.push_back(static_cast<float>(mean));
    }
    return potencies;
  }
  int32_t Piece(int32_t node) const { return sequence_.node_pieces()[static_cast<size_t>(node)]; }

  const TetMesh& mesh_;
  const SurfaceSequence& sequence_;
  const std::vector<double>& node_potencies_;
  MovedPoints moved_;
  VolumeCells cells_;
};

// How a format goes on to a frame, and what it makes of it.
struct Format {
  // Called for every frame, also where its file stands: later frames depend on it.
  std::function<absl::Status(const Frame& frame)> advance;
  std::function<absl::StatusOr<std::string>(const Frame& frame, const std::string& comment)> encode;
};

// Tells potencies apart in a key.
std::string PotencyName(const std::vector<double>& potencies) {
  StateHash hash;
  hash.Update(potencies.data(), potencies.size() * sizeof(double));
  return absl::StrCat(hash.Digest());
}

// What a render mesh adds to the name of a format.
std::string RenderKey(const RenderMesh* mesh) {
  if (mesh == nullptr) return "";
  StateHash hash;
  hash.Update(mesh->points.data(), mesh->points.size() * sizeof(Vec3));
  hash.Update(mesh->triangles.data(), mesh->triangles.size() * sizeof(mesh->triangles[0]));
  hash.Update(mesh->uvs.data(), mesh->uvs.size() * sizeof(CornerUvs));
  return absl::StrCat(" render ", hash.Digest());
}

int64_t OpenFacesOf(const SurfaceSequence& sequence) {
  return sequence.embedded() == nullptr ? 0 : sequence.embedded()->open_faces();
}

// What series carry beside positions, from options for the lot.
SequenceOptions Carried(const ExportOptions& options) {
  return {.strains = true,
          .damages = true,
          .displacements = true,
          .velocities = true,
          .node_potencies = options.node_potencies,
          .render_mesh = options.render_mesh};
}

class SeriesWriter {
 public:
  SeriesWriter(const TetMesh& mesh, const ExportOptions& options, absl::string_view ending,
               absl::string_view format)
      : options_(options),
        nodes_(mesh.node_count()),
        ending_(ending),
        key_(mesh, absl::StrCat(format, " ", PotencyName(options.node_potencies),
                                RenderKey(options.render_mesh))) {}

  absl::Status Write(const FrameSource& frames, const Format& format, const Progress& progress) {
    if (frames.count <= 0) return absl::InvalidArgumentError("there are no frames to export");
    CLEAVE_RETURN_IF_ERROR(CheckPotencies());
    CLEAVE_RETURN_IF_ERROR(MakeDirectories(options_.folder));
    for (int64_t position = 0; position < frames.count; ++position) {
      CLEAVE_ASSIGN_OR_RETURN(const Frame frame, frames.read(position));
      CLEAVE_RETURN_IF_ERROR(format.advance(frame));
      key_.Add(frame);
      const std::string file = absl::StrFormat("%s_%06d.%s", options_.name, frame.frame, ending_);
      const std::string path = PathOf(file);
      // The comment stands in the first lines; a file is only ever renamed into place whole.
      if (absl::StrContains(ReadStart(path, 256), key_.Comment())) {
        ++result_.kept;
      } else {
        CLEAVE_ASSIGN_OR_RETURN(const std::string bytes, format.encode(frame, key_.Comment()));
        CLEAVE_RETURN_IF_ERROR(WriteAside(path, bytes));
        ++result_.written;
      }
      entries_.push_back({frame.time, file});
      if (progress && !progress(position + 1, frames.count)) {
        return absl::CancelledError(
            absl::StrCat("export stopped after ", position + 1, " of ", frames.count, " frames"));
      }
    }
    return absl::OkStatus();
  }

  absl::Status WriteCollection() {
    if (entries_.empty()) return absl::OkStatus();
    CLEAVE_ASSIGN_OR_RETURN(const std::string bytes, EncodePvd(entries_));
    result_.collection = PathOf(absl::StrCat(options_.name, ".pvd"));
    return WriteAside(result_.collection, bytes);
  }

  ExportResult result(int64_t open_faces) const {
    ExportResult result = result_;
    result.open_faces = open_faces;
    return result;
  }

 private:
  absl::Status CheckPotencies() const {
    const auto count = static_cast<int64_t>(options_.node_potencies.size());
    if (count == 0 || count == nodes_) return absl::OkStatus();
    return absl::InvalidArgumentError(
        absl::StrCat("node_potencies: has ", count, " items; the mesh has ", nodes_, " nodes"));
  }

  std::string PathOf(const std::string& file) const {
    return options_.folder.empty() ? file : absl::StrCat(options_.folder, "/", file);
  }

  const ExportOptions& options_;
  const int64_t nodes_;
  const std::string ending_;
  DataKey key_;
  std::vector<PvdEntry> entries_;
  ExportResult result_;
};

}  // namespace

absl::StatusOr<ExportResult> WriteVtuSeries(const TetMesh& mesh, const FrameSource& frames,
                                            VtuContent content, const ExportOptions& options,
                                            const Progress& progress) {
  SequenceOptions carried = Carried(options);
  if (content == VtuContent::kVolume) carried.render_mesh = nullptr;
  SurfaceSequence sequence(mesh, carried);
  std::optional<VolumeSequence> volume;
  if (content == VtuContent::kVolume) volume.emplace(mesh, sequence, options.node_potencies);
  Format format;
  format.advance = [&](const Frame& frame) -> absl::Status {
    CLEAVE_RETURN_IF_ERROR(sequence.Advance(frame));
    if (volume) volume->Advance(frame);
    return absl::OkStatus();
  };
  format.encode = [&](const Frame& frame, const std::string& comment) {
    return EncodeVtu(volume ? volume->Grid(frame) : SurfaceGrid(sequence), comment);
  };
  SeriesWriter writer(mesh, options, "vtu", volume ? "vtu volume" : "vtu surface");
  const absl::Status written = writer.Write(frames, format, progress);
  const absl::Status collected = writer.WriteCollection();
  CLEAVE_RETURN_IF_ERROR(written);
  CLEAVE_RETURN_IF_ERROR(collected);
  return writer.result(OpenFacesOf(sequence));
}

absl::StatusOr<ExportResult> WritePlySeries(const TetMesh& mesh, const FrameSource& frames,
                                            const ExportOptions& options,
                                            const Progress& progress) {
  SurfaceSequence sequence(mesh, Carried(options));
  Format format;
  format.advance = [&](const Frame& frame) { return sequence.Advance(frame); };
  format.encode = [&](const Frame&, const std::string& comment) {
    return EncodePly(sequence.surface(), comment);
  };
  SeriesWriter writer(mesh, options, "ply", "ply");
  CLEAVE_RETURN_IF_ERROR(writer.Write(frames, format, progress));
  return writer.result(OpenFacesOf(sequence));
}

absl::StatusOr<ExportResult> WriteObjSeries(const TetMesh& mesh, const FrameSource& frames,
                                            const ExportOptions& options,
                                            const Progress& progress) {
  SurfaceSequence sequence(mesh, {.render_mesh = options.render_mesh});
  const SurfaceMaterials materials(mesh);
  const ObjOptions look{"", options.name, absl::StrCat(options.name, ".mtl"), true};
  Format format;
  format.advance = [&](const Frame& frame) { return sequence.Advance(frame); };
  format.encode = [&](const Frame&, const std::string& comment) {
    ObjOptions of_frame = look;
    of_frame.comment = comment;
    return EncodeObj(sequence.surface(), materials, of_frame);
  };
  SeriesWriter writer(mesh, options, "obj", absl::StrCat("obj ", options.name));
  CLEAVE_RETURN_IF_ERROR(writer.Write(frames, format, progress));
  CLEAVE_RETURN_IF_ERROR(WriteAside(options.folder.empty()
                                        ? look.material_file
                                        : absl::StrCat(options.folder, "/", look.material_file),
                                    EncodeMtl(materials)));
  return writer.result(OpenFacesOf(sequence));
}

}  // namespace cleave
