#ifndef CLEAVE_CLIENT_IO_EXPORT_VOLUME_SEQUENCE_H_
#define CLEAVE_CLIENT_IO_EXPORT_VOLUME_SEQUENCE_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "client/io/export/volume_cells.h"
#include "client/io/export/vtu.h"
#include "client/io/series/moved_points.h"
#include "client/io/series/surface_sequence.h"
#include "core/mesh/tet_mesh.h"
#include "core/stream/frame.h"

namespace cleave {

// The volume's cells and where their points are, kept from frame to frame. Not thread-safe.
class VolumeSequence {
 public:
  // `node_potencies` is empty or has a number a node. All arguments must outlive this object.
  VolumeSequence(const TetMesh& mesh, const SurfaceSequence& sequence,
                 const std::vector<double>& node_potencies)
      : mesh_(mesh),
        sequence_(sequence),
        node_potencies_(node_potencies),
        moved_(mesh, sequence.incidence()) {}

  // Call after every Advance or PassBy of the sequence.
  void Advance(const Frame& frame);

  // The frame of the last Advance of both, with the arrays of VtuContent::kVolume.
  VtuGrid Grid(const Frame& frame) const;

 private:
  void AddPointData(VtuGrid& grid) const;
  void AddCellData(const Frame& frame, VtuGrid& grid) const;
  std::vector<float> PointPotencies() const;
  int32_t Piece(int32_t node) const { return sequence_.node_pieces()[static_cast<size_t>(node)]; }

  const TetMesh& mesh_;
  const SurfaceSequence& sequence_;
  const std::vector<double>& node_potencies_;
  MovedPoints moved_;
  VolumeCells cells_;
};

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_EXPORT_VOLUME_SEQUENCE_H_
