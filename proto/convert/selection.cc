#include <string>
#include <variant>

#include "proto/convert/scene_parts.h"

namespace cleave {

Selector SelectorFromMessage(const v1::Selector& message, const std::string& field,
                             const FieldReader& read) {
  switch (message.kind_case()) {
    case v1::Selector::kBox:
      return BoxSelector{read.RequiredVector(field + ".box.min", message.box().min(), {0, 0, 0}),
                         read.RequiredVector(field + ".box.max", message.box().max(), {0, 0, 0})};
    case v1::Selector::kSphere:
      return SphereSelector{
          read.RequiredVector(field + ".sphere.center", message.sphere().center(), {0, 0, 0}),
          message.sphere().radius()};
    case v1::Selector::kPlane:
      return PlaneSelector{
          read.RequiredVector(field + ".plane.point", message.plane().point(), {0, 0, 0}),
          read.RequiredVector(field + ".plane.normal", message.plane().normal(), {0, 0, 1})};
    case v1::Selector::kRegion:
      return RegionSelector{message.region()};
    case v1::Selector::kIds:
      return IdSelector{{message.ids().ids().begin(), message.ids().ids().end()}};
    case v1::Selector::KIND_NOT_SET:
      break;
  }
  return std::monostate{};
}

Weakening WeakeningFromMessage(const v1::Weakening& message, const std::string& field,
                               const FieldReader& read) {
  Weakening weakening;
  switch (message.edges_case()) {
    case v1::Weakening::kNodeSet:
      weakening.edges = EdgesOfNodes{message.node_set()};
      break;
    case v1::Weakening::kBox:
      weakening.edges =
          BoxSelector{read.RequiredVector(field + ".box.min", message.box().min(), {0, 0, 0}),
                      read.RequiredVector(field + ".box.max", message.box().max(), {0, 0, 0})};
      break;
    case v1::Weakening::kSphere:
      weakening.edges = SphereSelector{
          read.RequiredVector(field + ".sphere.center", message.sphere().center(), {0, 0, 0}),
          message.sphere().radius()};
      break;
    case v1::Weakening::EDGES_NOT_SET:
      break;
  }
  if (!message.has_factor()) read.faults().Error(field + ".factor", "is missing");
  if (message.has_factor()) weakening.factor = message.factor();
  return weakening;
}

}  // namespace cleave
