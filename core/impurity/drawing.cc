#include "core/impurity/drawing.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"

namespace cleave {
namespace {

struct Step {
  int x, y;
};
// Round a pixel, clockwise from above.
constexpr std::array<Step, 8> kRound = {
    {{0, -1}, {1, -1}, {1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}}};

// A mask with a border of pixels that are not drawn.
class Canvas {
 public:
  Canvas(const PixelMask& mask, int width, int height)
      : width_(width), height_(height), stride_(static_cast<size_t>(width) + 2) {
    cells_.assign(stride_ * (static_cast<size_t>(height) + 2), 0);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        cells_[Place(x, y)] =
            mask[static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)] != 0;
      }
    }
  }
  int width() const { return width_; }
  int height() const { return height_; }
  size_t stride() const { return stride_; }
  size_t Place(int x, int y) const {
    return static_cast<size_t>(y + 1) * stride_ + static_cast<size_t>(x + 1);
  }
  size_t Neighbour(size_t place, size_t k) const {
    return static_cast<size_t>(static_cast<int64_t>(place) +
                               kRound[k].y * static_cast<int64_t>(stride_) + kRound[k].x);
  }
  uint8_t& operator[](size_t place) { return cells_[place]; }
  uint8_t operator[](size_t place) const { return cells_[place]; }
  size_t size() const { return cells_.size(); }

 private:
  int width_, height_;
  size_t stride_;
  std::vector<uint8_t> cells_;
};

// One of the two passes of Zhang and Suen; whether anything went.
bool ThinOnce(Canvas& canvas, bool second, std::vector<size_t>& drawn) {
  std::vector<size_t> gone;
  for (const size_t place : drawn) {
    std::array<int, 8> p;
    int count = 0, changes = 0;
    for (size_t k = 0; k < 8; ++k) count += p[k] = canvas[canvas.Neighbour(place, k)];
    for (size_t k = 0; k < 8; ++k) changes += p[k] == 0 && p[(k + 1) % 8] == 1;
    if (count < 2 || count > 6 || changes != 1) continue;
    const bool keeps = second ? (p[0] * p[2] * p[6] != 0 || p[0] * p[4] * p[6] != 0)
                              : (p[0] * p[2] * p[4] != 0 || p[2] * p[4] * p[6] != 0);
    if (!keeps) gone.push_back(place);
  }
  for (const size_t place : gone) canvas[place] = 0;
  if (!gone.empty()) std::erase_if(drawn, [&](size_t place) { return canvas[place] == 0; });
  return !gone.empty();
}

Canvas Thin(Canvas canvas) {
  std::vector<size_t> drawn;
  for (size_t place = 0; place < canvas.size(); ++place)
    if (canvas[place] != 0) drawn.push_back(place);
  for (bool changed = true; changed;) {
    changed = ThinOnce(canvas, false, drawn);
    changed = ThinOnce(canvas, true, drawn) || changed;
  }
  return canvas;
}

// Squared distances to the nearest zero of f, a line at a time. Source: Felzenszwalb and
// Huttenlocher, "Distance transforms of sampled functions", 2012.
void DistancesOfLine(std::vector<double>& f, std::vector<double>& out, std::vector<size_t>& apex,
                     std::vector<double>& begin) {
  const size_t n = f.size();
  size_t last = 0;
  apex[0] = 0;
  begin[0] = -std::numeric_limits<double>::infinity();
  const auto meet = [&](size_t p, size_t q) {
    const auto a = static_cast<double>(p), b = static_cast<double>(q);
    return ((f[q] + b * b) - (f[p] + a * a)) / (2 * (b - a));
  };
  for (size_t q = 1; q < n; ++q) {
    double at = meet(apex[last], q);
    while (at <= begin[last]) at = meet(apex[--last], q);
    apex[++last] = q;
    begin[last] = at;
  }
  size_t k = 0;
  for (size_t q = 0; q < n; ++q) {
    while (k < last && begin[k + 1] < static_cast<double>(q)) ++k;
    const double off = static_cast<double>(q) - static_cast<double>(apex[k]);
    out[q] = off * off + f[apex[k]];
  }
  std::swap(f, out);
}

// Pixels from every place of the canvas to the nearest that is not drawn.
std::vector<double> DistancesToBlank(const Canvas& canvas) {
  const size_t width = canvas.stride(), height = canvas.size() / width;
  const double far = 4.0 * static_cast<double>(width * width + height * height);
  std::vector<double> squares(canvas.size());
  const size_t longest = std::max(width, height);
  std::vector<double> line, out, begin(longest);
  std::vector<size_t> apex(longest);
  const auto run = [&](size_t first, size_t step, size_t count, bool fill) {
    line.resize(count);
    out.resize(count);
    for (size_t k = 0; k < count; ++k) {
      const size_t place = first + k * step;
      line[k] = !fill ? squares[place] : (canvas[place] != 0 ? far : 0);
    }
    DistancesOfLine(line, out, apex, begin);
    for (size_t k = 0; k < count; ++k) squares[first + k * step] = line[k];
  };
  for (size_t x = 0; x < width; ++x) run(x, width, height, true);
  for (size_t y = 0; y < height; ++y) run(y * width, 1, width, false);
  for (double& square : squares) square = std::sqrt(square);
  return squares;
}

// Follows the lines of a thinned canvas: links between neighbours, each of one curve.
class Tracer {
 public:
  explicit Tracer(const Canvas& thin) : thin_(thin), links_(thin.size(), 0) {
    for (size_t place = 0; place < thin.size(); ++place) {
      if (thin[place] == 0) continue;
      for (size_t k = 0; k < 8; ++k) {
        // A diagonal that two sides make anyway is no link of its own.
        const bool corner = k % 2 == 1 && (Drawn(place, k - 1) || Drawn(place, (k + 1) % 8));
        if (Drawn(place, k) && !corner) links_[place] |= static_cast<uint8_t>(1u << k);
      }
    }
  }

  // Places of each curve; closed ones end where they begin. A lone pixel is a curve of one place.
  // Left out are the spurs that thinning leaves where lines were wide: from a fork to an end within
  // `reach` of it, pixels at every place.
  std::vector<std::vector<size_t>> Curves(const std::vector<double>& reach) {
    std::vector<std::vector<size_t>> curves;
    std::vector<uint8_t> degrees(links_.size(), 0);
    for (size_t place = 0; place < links_.size(); ++place)
      degrees[place] = static_cast<uint8_t>(std::popcount(links_[place]));
    // Ends and forks first, then what is left: rings.
    for (const bool rings : {false, true}) {
      for (size_t place = 0; place < links_.size(); ++place) {
        if (thin_[place] == 0) continue;
        if (!rings && degrees[place] == 0) curves.push_back({place});
        if (!rings && degrees[place] == 2) continue;
        while (links_[place] != 0) {
          std::vector<size_t> curve = Follow(place, degrees);
          const size_t first = curve.front(), last = curve.back();
          const auto length = static_cast<double>(curve.size() - 1);
          const bool spur = (degrees[first] == 1 && degrees[last] > 2 && length <= reach[last]) ||
                            (degrees[last] == 1 && degrees[first] > 2 && length <= reach[first]);
          if (!spur) curves.push_back(std::move(curve));
        }
      }
    }
    return curves;
  }

 private:
  bool Drawn(size_t place, size_t k) const { return thin_[thin_.Neighbour(place, k)] != 0; }

  std::vector<size_t> Follow(size_t place, const std::vector<uint8_t>& degrees) {
    std::vector<size_t> curve = {place};
    do {
      const auto k = static_cast<size_t>(std::countr_zero(links_[place]));
      const size_t next = thin_.Neighbour(place, k);
      links_[place] &= static_cast<uint8_t>(~(1u << k));
      links_[next] &= static_cast<uint8_t>(~(1u << ((k + 4) % 8)));
      curve.push_back(next);
      place = next;
    } while (degrees[place] == 2 && links_[place] != 0);
    return curve;
  }

  const Canvas& thin_;
  std::vector<uint8_t> links_;  // a bit a neighbour that is still to be visited
};

// A point of a curve, pixels.
struct Traced {
  double x, y, half_width;
};

// Keeps the points without which the curve would stray by more than `tolerance`, in place or half
// width. Source: Douglas and Peucker, 1973; without recursion.
std::vector<Traced> Simplified(const std::vector<Traced>& points, double tolerance,
                               bool with_width) {
  std::vector<uint8_t> kept(points.size(), 0);
  kept.front() = kept.back() = 1;
  std::vector<std::pair<size_t, size_t>> spans = {{0, points.size() - 1}};
  while (!spans.empty()) {
    const auto [first, last] = spans.back();
    spans.pop_back();
    const Traced &a = points[first], &b = points[last];
    const double dx = b.x - a.x, dy = b.y - a.y, squared = dx * dx + dy * dy;
    double worst = tolerance;
    size_t split = 0;
    for (size_t k = first + 1; k < last; ++k) {
      const Traced& p = points[k];
      const double along = squared > 0 ? ((p.x - a.x) * dx + (p.y - a.y) * dy) / squared : 0;
      const double share = std::clamp(along, 0.0, 1.0);
      double off = std::hypot(p.x - a.x - share * dx, p.y - a.y - share * dy);
      if (with_width) {
        const double width = a.half_width + share * (b.half_width - a.half_width);
        off = std::max(off, std::abs(p.half_width - width));
      }
      if (off > worst) {
        worst = off;
        split = k;
      }
    }
    if (split == 0) continue;
    kept[split] = 1;
    spans.push_back({first, split});
    spans.push_back({split, last});
  }
  std::vector<Traced> simple;
  for (size_t k = 0; k < points.size(); ++k)
    if (kept[k] != 0) simple.push_back(points[k]);
  return simple;
}

}  // namespace

PixelMask DrawnPixels(const GreyRaster& raster, const ImageDrawing& image) {
  const auto threshold = static_cast<float>(image.threshold);
  PixelMask drawn;
  drawn.reserve(raster.values.size());
  for (const float value : raster.values)
    drawn.push_back(image.bright ? value > threshold : value < threshold);
  return drawn;
}

PixelMask Thinned(const PixelMask& drawn, int width, int height) {
  const Canvas thin = Thin(Canvas(drawn, width, height));
  PixelMask mask;
  mask.reserve(drawn.size());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) mask.push_back(thin[thin.Place(x, y)]);
  return mask;
}

absl::StatusOr<std::vector<DrawnCurve>> TraceDrawing(const GreyRaster& raster,
                                                     const ImageDrawing& image) {
  if (raster.width <= 0 || raster.height <= 0)
    return absl::InvalidArgumentError("the picture has no pixels");
  const PixelMask drawn = DrawnPixels(raster, image);
  const auto count = std::count(drawn.begin(), drawn.end(), 1);
  if (count == 0 || count == static_cast<int64_t>(drawn.size())) {
    return absl::InvalidArgumentError(absl::StrCat(
        count == 0 ? "no pixel is " : "every pixel is ", image.bright ? "brighter" : "darker",
        " than the threshold ", image.threshold, ": there is nothing to trace"));
  }
  const Canvas canvas(drawn, raster.width, raster.height);
  const Canvas thin = Thin(canvas);
  const std::vector<double> blank = DistancesToBlank(canvas);
  const double unit = raster.width;
  std::vector<DrawnCurve> curves;
  for (const std::vector<size_t>& places : Tracer(thin).Curves(blank)) {
    std::vector<Traced> points;
    for (const size_t place : places) {
      // Pixels are half in and half out of the border's distance.
      points.push_back({static_cast<double>(place % canvas.stride()) - 0.5,
                        static_cast<double>(place / canvas.stride()) - 0.5, blank[place] - 0.5});
    }
    if (points.size() == 1) {  // a dot is as long as its pixel
      points.push_back(points[0]);
      points[0].x -= 0.5;
      points[1].x += 0.5;
    }
    DrawnCurve& curve = curves.emplace_back();
    for (const Traced& p : Simplified(points, image.tolerance, image.keep_width)) {
      curve.points.push_back(
          {(p.x - raster.width / 2.0) / unit, (raster.height / 2.0 - p.y) / unit});
      if (image.keep_width) curve.half_widths.push_back(p.half_width / unit);
    }
  }
  return curves;
}

}  // namespace cleave
