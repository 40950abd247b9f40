#include "client/io/export/volume_sequence.h"

namespace cleave {

void VolumeSequence::Advance(const Frame& frame) {
  const bool changed = sequence_.changed();
  if (changed) cells_ = BuildVolumeCells(mesh_, sequence_.topology().tet_masks);
  moved_.Advance(cells_.topology, changed, frame.positions, frame.time, true);
}

VtuGrid VolumeSequence::Grid(const Frame& frame) const {
  VtuGrid grid;
  grid.time = frame.time;
  grid.points = moved_.points();
  grid.connectivity = cells_.connectivity;
  grid.offsets = cells_.offsets;
  grid.types = cells_.types;
  AddPointData(grid);
  AddCellData(frame, grid);
  return grid;
}

void VolumeSequence::AddPointData(VtuGrid& grid) const {
  std::vector<int32_t> point_pieces;
  for (const int32_t node : cells_.point_nodes) point_pieces.push_back(Piece(node));
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
}

void VolumeSequence::AddCellData(const Frame& frame, VtuGrid& grid) const {
  const std::vector<float> tet_strains = sequence_.TetStrains(frame.positions);
  const std::vector<float> tet_damages = sequence_.TetDamages();
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
  grid.cell_data.push_back(MakeVtuArray<int32_t>("piece", pieces));
  grid.cell_data.push_back(MakeVtuArray<int32_t>("region", regions));
  grid.cell_data.push_back(MakeVtuArray<int32_t>("tet", cells_.cell_tets));
  grid.cell_data.push_back(MakeVtuArray<float>("strain", strains));
  grid.cell_data.push_back(MakeVtuArray<float>("damage", damages));
  grid.cell_data.push_back(MakeVtuArray<uint8_t>("broken_edges", broken));
  grid.cell_data.push_back(MakeVtuArray<uint8_t>("separated", separated));
}

std::vector<float> VolumeSequence::PointPotencies() const {
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

}  // namespace cleave
