#include "client/io/export/obj.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <tuple>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/io/export/number_text.h"
#include "core/base/status.h"
#include "core/picture/surface_normals.h"

namespace cleave {
namespace {

// Numbers what is equal once, from 1, as OBJ counts.
template <typename K>
class Numbered {
 public:
  // The number of `key`, and whether it is new.
  std::pair<int64_t, bool> Of(const K& key) {
    const auto [entry, is_new] =
        numbers_.try_emplace(key, static_cast<int64_t>(numbers_.size()) + 1);
    return {entry->second, is_new};
  }

 private:
  std::map<K, int64_t> numbers_;
};

class ObjText {
 public:
  ObjText(const ShownSurface& surface, const SurfaceMaterials& materials, const ObjOptions& options)
      : surface_(surface), materials_(materials), options_(options) {}

  std::string Write() {
    out_ = absl::StrFormat("# %s, time %.9g s, frame %d; m\nmtllib %s\no %s\n", options_.comment,
                           surface_.time, surface_.frame, options_.material_file, options_.object);
    for (const Vec3& point : surface_.points) {
      out_ += "v ";
      AppendFloats(point, " ", out_);
      out_ += '\n';
    }
    if (options_.normals) normals_ = CornerNormals(surface_);
    // Lists of corners come first, so that faces may name them.
    const std::vector<size_t> order = Order();
    for (const size_t triangle : order) AddCorners(triangle);
    AddFaces(order);
    return std::move(out_);
  }

 private:
  size_t MaterialOf(size_t triangle) const {
    return materials_.IndexOf(surface_.regions[triangle], surface_.inside[triangle] != 0);
  }

  // Triangles by piece, then material.
  std::vector<size_t> Order() const {
    std::vector<size_t> order(surface_.triangles.size());
    for (size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::sort(order.begin(), order.end(), [&](size_t a, size_t b) {
      return std::tuple(surface_.pieces[a], MaterialOf(a), a) <
             std::tuple(surface_.pieces[b], MaterialOf(b), b);
    });
    return order;
  }

  void AddCorners(size_t triangle) {
    const auto& [a, b, c] = surface_.triangles[triangle];
    const auto rest = [&](int32_t point) {
      return surface_.rest_points[static_cast<size_t>(point)];
    };
    const size_t axis = FacedAxis(rest(a), rest(b), rest(c));
    for (size_t k = 0; k < 3; ++k) {
      const int32_t point = surface_.triangles[triangle][k];
      const bool has_own = !surface_.uvs.empty() && surface_.inside[triangle] == 0;
      const std::array<float, 2> own = has_own ? surface_.uvs[triangle][k] : std::array<float, 2>{};
      const auto [uv, new_uv] =
          uvs_.Of(has_own ? std::array{-1, std::bit_cast<int32_t>(own[0] + 0.0f),
                                       std::bit_cast<int32_t>(own[1] + 0.0f)}
                          : std::array{point, static_cast<int32_t>(axis), 0});
      if (new_uv) {
        const auto [u, v] =
            has_own ? std::array<double, 2>{own[0], own[1]} : RestUv(rest(point), axis);
        out_ += "vt ";
        AppendNumber(static_cast<float>(u), out_);
        out_ += ' ';
        AppendNumber(static_cast<float>(v), out_);
        out_ += '\n';
      }
      corners_.push_back({uv, 0});
      if (!options_.normals) continue;
      std::array<int32_t, 3> rounded{};
      for (size_t i = 0; i < 3; ++i) {
        rounded[i] = static_cast<int32_t>(
            std::lround(normals_[triangle][k][static_cast<Eigen::Index>(i)] * 10000));
      }
      const auto [normal, new_normal] = directions_.Of(rounded);
      if (new_normal) {
        absl::StrAppendFormat(&out_, "vn %.4f %.4f %.4f\n", rounded[0] / 1e4, rounded[1] / 1e4,
                              rounded[2] / 1e4);
      }
      corners_.back()[1] = normal;
    }
  }

  void AddFaces(const std::vector<size_t>& order) {
    size_t corner = 0;
    for (size_t i = 0; i < order.size(); ++i) {
      const size_t triangle = order[i];
      const bool new_piece = i == 0 || surface_.pieces[triangle] != surface_.pieces[order[i - 1]];
      if (new_piece) absl::StrAppend(&out_, "g piece_", surface_.pieces[triangle], "\n");
      if (new_piece || MaterialOf(triangle) != MaterialOf(order[i - 1])) {
        absl::StrAppend(&out_, "usemtl ", materials_.list()[MaterialOf(triangle)].name, "\n");
      }
      out_ += 'f';
      for (const int32_t point : surface_.triangles[triangle]) {
        const auto& [uv, normal] = corners_[corner++];
        absl::StrAppend(&out_, " ", point + 1, "/", uv);
        if (options_.normals) absl::StrAppend(&out_, "/", normal);
      }
      out_ += '\n';
    }
  }

  const ShownSurface& surface_;
  const SurfaceMaterials& materials_;
  const ObjOptions& options_;
  std::vector<std::array<Eigen::Vector3f, 3>> normals_;
  // Of a point and the axis along which it is seen, or -1 and texture coordinates, bit by bit.
  Numbered<std::array<int32_t, 3>> uvs_;
  Numbered<std::array<int32_t, 3>> directions_;  // ten thousandths
  std::vector<std::array<int64_t, 2>> corners_;  // in the order of the faces: uv, normal
  std::string out_;
};

}  // namespace

absl::StatusOr<std::string> EncodeObj(const ShownSurface& surface,
                                      const SurfaceMaterials& materials,
                                      const ObjOptions& options) {
  CLEAVE_RETURN_IF_ERROR(CheckShownSurface(surface));
  if (surface.triangles.empty()) {
    return absl::InvalidArgumentError("the surface has no triangles, so no pieces to write");
  }
  if (surface.rest_points.empty()) {
    return absl::InvalidArgumentError("rest_points: are not known, so there is no texture");
  }
  return ObjText(surface, materials, options).Write();
}

std::string EncodeMtl(const SurfaceMaterials& materials) {
  std::string out = "# Cleave: faces of the body's own surface and faces that cracks opened\n";
  for (const SurfaceMaterial& material : materials.list()) {
    const auto& [red, green, blue] = material.color;
    absl::StrAppendFormat(&out, "newmtl %s\nKd %.4f %.4f %.4f\nKs 0 0 0\nillum 1\n", material.name,
                          red, green, blue);
  }
  return out;
}

}  // namespace cleave
