#include "core/scene/impurity_blades.h"

#include <cmath>
#include <limits>

namespace cleave {
namespace {

double Dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Vec3 Cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Vec3 Sum(const Vec3& a, double factor, const Vec3& b) {
  return {a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]};
}

Vec3 Unit(const Vec3& v) { return Sum({0, 0, 0}, 1 / std::sqrt(Dot(v, v)), v); }

}  // namespace

CurveBlades BladesOf(const Strokes& strokes) {
  CurveBlades result;
  result.blades.direction = strokes.direction;
  result.blades.depth = strokes.depth.value_or(std::numeric_limits<double>::infinity());
  for (size_t c = 0; c < strokes.curves.size(); ++c) {
    const std::vector<Vec3>& points = strokes.curves[c].points;
    for (size_t k = 0; k + 1 < points.size(); ++k) {
      result.blades.segments.push_back(
          {points[k], points[k + 1], {strokes.radius, strokes.radius}});
      result.curve_of.push_back(static_cast<int32_t>(c));
    }
  }
  return result;
}

CurveBlades BladesOf(const SegmentPattern& pattern) {
  CurveBlades result;
  result.blades.direction = pattern.direction;
  result.blades.depth = pattern.depth.value_or(std::numeric_limits<double>::infinity());
  const Vec3 ahead = Unit(pattern.direction);
  const Vec3 up = Unit(Sum(pattern.up, -Dot(pattern.up, ahead), ahead));
  const Vec3 right = Cross(ahead, up);
  const double cosine = std::cos(pattern.rotation), sine = std::sin(pattern.rotation);
  const auto place = [&](const std::array<double, 2>& at) {
    const double x = pattern.scale * (cosine * at[0] - sine * at[1]);
    const double y = pattern.scale * (sine * at[0] + cosine * at[1]);
    return Sum(Sum(pattern.origin, x, right), y, up);
  };
  for (size_t c = 0; c < pattern.curves.size(); ++c) {
    const DrawnCurve& curve = pattern.curves[c];
    for (size_t k = 0; k + 1 < curve.points.size(); ++k) {
      BladeSegment& segment = result.blades.segments.emplace_back();
      segment.start = place(curve.points[k]);
      segment.end = place(curve.points[k + 1]);
      if (!curve.half_widths.empty()) {
        segment.radii = {pattern.scale * curve.half_widths[k],
                         pattern.scale * curve.half_widths[k + 1]};
      }
      result.curve_of.push_back(static_cast<int32_t>(c));
    }
  }
  return result;
}

}  // namespace cleave
