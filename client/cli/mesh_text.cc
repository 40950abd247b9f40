#include "client/cli/mesh_text.h"

#include <cmath>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"

namespace cleave {
namespace {

constexpr double kDegrees = 180 / M_PI;

std::string Vector(const Vec3& v) { return absl::StrFormat("%.6g %.6g %.6g", v[0], v[1], v[2]); }
std::string VectorJson(const Vec3& v) {
  return JsonList({JsonNumber(v[0]), JsonNumber(v[1]), JsonNumber(v[2])});
}
std::string RangeJson(const Range& range) {
  return JsonLine().Add("min", range.min).Add("mean", range.mean).Add("max", range.max).Str();
}

}  // namespace

std::string MeshReportText(const MeshReport& report) {
  std::vector<std::string> lines;
  lines.push_back(absl::StrCat("nodes        ", report.node_count, " (",
                               report.unreferenced_node_count, " in no tet)"));
  lines.push_back(absl::StrCat("tets         ", report.tet_count));
  lines.push_back(absl::StrCat("edges        ", report.edge_count));
  lines.push_back(absl::StrCat("surface      ", report.boundary_face_count, " triangles, ",
                               absl::StrFormat("%.6g m^2", report.surface_area)));
  lines.push_back(absl::StrCat("components   ", report.component_count));
  lines.push_back(absl::StrFormat("volume       %.6g m^3", report.volume));
  lines.push_back(absl::StrCat("from         ", Vector(report.min_corner), " m"));
  lines.push_back(absl::StrCat("to           ", Vector(report.max_corner), " m"));
  lines.push_back(absl::StrFormat("edge length  %.4g to %.4g m, mean %.4g m",
                                  report.edge_length.min, report.edge_length.max,
                                  report.edge_length.mean));
  lines.push_back(absl::StrFormat("aspect       %.3g to %.3g, mean %.3g (1: regular)",
                                  report.aspect.min, report.aspect.max, report.aspect.mean));
  lines.push_back(absl::StrFormat("angles       %.1f to %.1f degrees between faces (regular: 70.5)",
                                  report.min_dihedral * kDegrees, report.max_dihedral * kDegrees));
  for (const RegionReport& region : report.regions)
    lines.push_back(absl::StrCat("region       ", region.id,
                                 region.name.empty() ? "" : absl::StrCat(" \"", region.name, "\""),
                                 ": ", region.tet_count, " tets, ",
                                 absl::StrFormat("%.6g m^3", region.volume)));
  lines.push_back(absl::StrCat(
      "worst tets   ",
      absl::StrJoin(report.worst, ", ", [](std::string* out, const WorstTet& worst) {
        absl::StrAppendFormat(out, "%d (%.1f deg)", worst.tet, worst.min_dihedral * kDegrees);
      })));
  return absl::StrJoin(lines, "\n");
}

JsonLine MeshReportJson(const MeshReport& report, const std::vector<Fault>& from) {
  std::vector<std::string> regions, worst, warnings;
  for (const RegionReport& region : report.regions)
    regions.push_back(JsonLine()
                          .Add("id", int64_t{region.id})
                          .Add("name", region.name)
                          .Add("tets", region.tet_count)
                          .Add("volume", region.volume)
                          .Str());
  for (const WorstTet& tet : report.worst)
    worst.push_back(JsonLine()
                        .Add("tet", tet.tet)
                        .Add("min_dihedral_degrees", tet.min_dihedral * kDegrees)
                        .Add("aspect", tet.aspect)
                        .Str());
  for (const Fault& warning : from)
    warnings.push_back(
        JsonLine().Add("field", warning.field).Add("description", warning.description).Str());
  JsonLine line;
  line.Add("nodes", report.node_count)
      .Add("tets", report.tet_count)
      .Add("edges", report.edge_count)
      .Add("boundary_faces", report.boundary_face_count)
      .Add("components", report.component_count)
      .Add("unreferenced_nodes", report.unreferenced_node_count)
      .Add("volume", report.volume)
      .Add("surface_area", report.surface_area)
      .AddJson("min_corner", VectorJson(report.min_corner))
      .AddJson("max_corner", VectorJson(report.max_corner))
      .AddJson("edge_length", RangeJson(report.edge_length))
      .AddJson("aspect", RangeJson(report.aspect))
      .Add("min_dihedral_degrees", report.min_dihedral * kDegrees)
      .Add("max_dihedral_degrees", report.max_dihedral * kDegrees)
      .AddJson("regions", JsonList(regions))
      .AddJson("worst_tets", JsonList(worst))
      .AddJson("warnings", JsonList(warnings));
  return line;
}

VtuGrid TetGrid(const TetMesh& mesh) {
  VtuGrid grid;
  grid.points = mesh.rest_positions;
  for (const auto& tet : mesh.tets) {
    grid.connectivity.insert(grid.connectivity.end(), tet.begin(), tet.end());
    grid.offsets.push_back(static_cast<int64_t>(grid.connectivity.size()));
  }
  grid.types.assign(mesh.tets.size(), kVtuTetrahedron);
  if (!mesh.tet_regions.empty())
    grid.cell_data = {MakeVtuArray<int32_t>("region", mesh.tet_regions)};
  return grid;
}

}  // namespace cleave
