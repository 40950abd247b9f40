#ifndef CLEAVE_CLIENT_CLI_IMPURITY_TEXT_H_
#define CLEAVE_CLIENT_CLI_IMPURITY_TEXT_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "cleave/v1/impurity.pb.h"
#include "core/mesh/tet_mesh.h"

namespace cleave {

// A few lines for people: potencies, affected edges, strengths. `relative` strengths are shares of
// the pure body's, else Pa.
std::string ImpurityText(const v1::PreviewImpurityResponse& preview, bool relative);

// ImpurityShares of a preview with edges.
std::vector<double> ShownImpurities(const v1::PreviewImpurityResponse& preview);

// The bytes of VTU files: the mesh with potency a node, and the affected edges as lines with
// weakening and strength (Pa; edges that never break have the largest number). The mesh is in
// metres.
absl::StatusOr<std::string> PotencyVtu(const TetMesh& mesh,
                                       const v1::PreviewImpurityResponse& preview);
absl::StatusOr<std::string> AffectedEdgesVtu(const TetMesh& mesh,
                                             const v1::PreviewImpurityResponse& preview);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_CLI_IMPURITY_TEXT_H_
