#include "core/simulation/scene_digest.h"

#include <optional>
#include <string>
#include <type_traits>
#include <variant>

#include "core/base/bytes.h"
#include "core/base/state_hash.h"

namespace cleave {
namespace {

void PutText(absl::string_view text, ByteWriter& out) {
  out.Put<uint64_t>(text.size());
  out.PutBytes(text);
}

void PutSelector(const Selector& selector, ByteWriter& out) {
  out.Put<uint64_t>(selector.index());
  if (const auto* box = std::get_if<BoxSelector>(&selector)) {
    out.Put(box->min);
    out.Put(box->max);
  } else if (const auto* sphere = std::get_if<SphereSelector>(&selector)) {
    out.Put(sphere->center);
    out.Put(sphere->radius);
  } else if (const auto* plane = std::get_if<PlaneSelector>(&selector)) {
    out.Put(plane->point);
    out.Put(plane->normal);
  } else if (const auto* region = std::get_if<RegionSelector>(&selector)) {
    PutText(region->region, out);
  } else if (const auto* list = std::get_if<IdSelector>(&selector)) {
    out.PutVector(list->ids);
  }
}

void PutFibres(const FibreFamily& family, ByteWriter& out) {
  out.Put(family.stiffness);
  out.Put(family.strength_ratio);
  out.Put<uint64_t>(family.direction.index());
  if (const auto* constant = std::get_if<ConstantDirection>(&family.direction)) {
    out.Put(constant->vector);
  } else if (const auto* cylindrical = std::get_if<CylindricalDirection>(&family.direction)) {
    out.Put(cylindrical->center);
    out.Put(cylindrical->axis);
    out.Put(cylindrical->mixture);
  } else if (const auto* per_tet = std::get_if<TetDirections>(&family.direction)) {
    out.PutVector(per_tet->vectors);
  } else if (const auto* directions = std::get_if<CurveDirections>(&family.direction)) {
    out.Put<uint64_t>(directions->curves.size());
    for (const Polyline& curve : directions->curves) out.PutVector(curve.points);
  }
}

void PutFatigue(const Fatigue& fatigue, ByteWriter& out) {
  out.Put(fatigue.strength_coefficient);
  out.Put(fatigue.strength_exponent);
  out.Put<uint8_t>(fatigue.endurance_limit.has_value());
  out.Put(fatigue.endurance_limit.value_or(0));
  out.Put(fatigue.degradation_exponent);
}

void PutPlasticity(const Plasticity& plasticity, ByteWriter& out) {
  out.Put(plasticity.yield_stress);
  out.Put(plasticity.hardening);
  out.Put(plasticity.flow_rate);
  out.Put<uint8_t>(plasticity.failure_strain.has_value());
  out.Put(plasticity.failure_strain.value_or(0));
}

void PutOptional(const std::optional<double>& value, ByteWriter& out) {
  out.Put<uint8_t>(value.has_value());
  out.Put(value.value_or(0));
}

void PutImpuritySource(const ImpuritySource& source, ByteWriter& out) {
  out.Put<uint64_t>(source.index());
  if (const auto* values = std::get_if<NodeValues>(&source)) {
    out.PutVector(values->shares);
  } else if (const auto* noise = std::get_if<NoiseField>(&source)) {
    out.Put(static_cast<uint32_t>(noise->distribution));
    out.Put(noise->correlation_length);
  } else if (const auto* bands = std::get_if<BandField>(&source)) {
    out.Put(static_cast<uint32_t>(bands->shape));
    out.Put(bands->center);
    out.Put(bands->axis);
    out.Put(bands->position);
    out.Put(bands->width);
    PutOptional(bands->spacing, out);
  } else if (const auto* pockets = std::get_if<PocketField>(&source)) {
    out.Put(pockets->count);
    out.Put(pockets->radius);
  } else if (const auto* strokes = std::get_if<Strokes>(&source)) {
    out.Put<uint64_t>(strokes->curves.size());
    for (const Polyline& curve : strokes->curves) out.PutVector(curve.points);
    out.Put(strokes->direction);
    PutOptional(strokes->depth, out);
    out.Put(strokes->radius);
  } else if (const auto* pattern = std::get_if<SegmentPattern>(&source)) {
    out.Put<uint64_t>(pattern->curves.size());
    for (const DrawnCurve& curve : pattern->curves) {
      out.PutVector(curve.points);
      out.PutVector(curve.half_widths);
    }
    out.Put(pattern->origin);
    out.Put(pattern->direction);
    out.Put(pattern->up);
    out.Put(pattern->rotation);
    out.Put(pattern->scale);
    PutOptional(pattern->depth, out);
  } else if (const auto* paint = std::get_if<SurfacePaint>(&source)) {
    out.PutVector(paint->shares);
    out.PutVector(paint->vertices);
    out.PutVector(paint->triangles);
    out.Put(paint->depth);
    if (paint->texture) {
      out.Put(paint->texture->width);
      out.Put(paint->texture->height);
      out.PutVector(paint->texture->values);
      out.PutVector(paint->texture->uvs);
      out.Put(static_cast<uint32_t>(paint->texture->wrap));
      out.Put<uint8_t>(paint->texture->invert);
    }
  }
}

void PutImpurityLayer(const ImpurityLayer& layer, ByteWriter& out) {
  PutImpuritySource(layer.source, out);
  PutText(layer.node_set, out);
  PutOptional(layer.potency, out);
  PutOptional(layer.weakening, out);
  out.Put(static_cast<uint32_t>(layer.blend));
  out.Put(layer.falloff);
  out.Put(static_cast<uint32_t>(layer.falloff_shape));
  out.Put<uint8_t>(layer.seed.has_value());
  out.Put(layer.seed.value_or(0));
}

void PutImpurities(const Impurities& impurities, ByteWriter& out) {
  out.Put(static_cast<uint32_t>(impurities.effect));
  out.Put(static_cast<uint32_t>(impurities.model));
  out.Put(static_cast<uint32_t>(impurities.mode));
  out.Put(impurities.potency);
  out.PutVector(impurities.map);
  out.Put<uint64_t>(impurities.patches.size());
  for (const PotencyPatch& patch : impurities.patches) {
    PutText(patch.node_set, out);
    out.Put(patch.share);
  }
  out.Put(impurities.noise);
  out.Put(static_cast<uint32_t>(impurities.distribution));
  out.Put(impurities.steepness);
  out.Put(impurities.pure_offset);
  out.Put<uint8_t>(impurities.degree_weight.has_value());
  out.Put(impurities.degree_weight.value_or(0));
  out.Put<uint64_t>(impurities.layers.size());
  for (const ImpurityLayer& layer : impurities.layers) PutImpurityLayer(layer, out);
}

void PutKeyframes(const std::vector<Keyframe>& keyframes, ByteWriter& out) {
  out.Put<uint64_t>(keyframes.size());
  for (const Keyframe& keyframe : keyframes) {
    out.Put(keyframe.time);
    out.Put(keyframe.translation);
    out.Put(keyframe.rotation);
  }
}

void PutCollider(const Collider& collider, ByteWriter& out) {
  out.Put<uint64_t>(collider.shape.index());
  if (const auto* plane = std::get_if<PlaneShape>(&collider.shape)) {
    out.Put(plane->point);
    out.Put(plane->normal);
  } else if (const auto* sphere = std::get_if<SphereShape>(&collider.shape)) {
    out.Put(sphere->center);
    out.Put(sphere->radius);
  } else if (const auto* box = std::get_if<BoxShape>(&collider.shape)) {
    out.Put(box->center);
    out.Put(box->size);
    out.Put(box->rotation_axis);
    out.Put(box->rotation);
  } else if (const auto* surface = std::get_if<SurfaceShape>(&collider.shape)) {
    out.PutVector(surface->vertices);
    out.PutVector(surface->triangles);
  }
  PutKeyframes(collider.keyframes, out);
  out.Put(collider.rotation_center);
  out.Put(collider.rotation_axis);
  out.Put<uint8_t>(collider.body.has_value());
  if (collider.body.has_value()) {
    PutOptional(collider.body->mass, out);
    PutOptional(collider.body->density, out);
    out.Put(collider.body->velocity);
    out.Put(collider.body->angular_velocity);
  }
  out.Put(collider.friction);
  out.Put(collider.stiffness);
  out.Put(collider.margin);
}

void PutRelease(const std::optional<Release>& release, ByteWriter& out) {
  out.Put<uint8_t>(release.has_value());
  if (!release) return;
  out.Put<uint8_t>(release->time.has_value());
  out.Put(release->time.value_or(0));
  out.Put<uint8_t>(release->first_fracture);
  out.Put<uint8_t>(release->broken_share.has_value());
  out.Put(release->broken_share.value_or(0));
  out.Put<uint8_t>(release->pieces.has_value());
  out.Put(release->pieces.value_or(0));
  out.Put<uint64_t>(release->separated_node_sets.size());
  for (const std::string& set : release->separated_node_sets) PutText(set, out);
}

void PutLoad(const Load& load, ByteWriter& out) {
  PutText(load.node_set, out);
  out.Put<uint64_t>(load.kind.index());
  if (const auto* force = std::get_if<PointForce>(&load.kind)) {
    out.Put(force->total);
  } else if (const auto* traction = std::get_if<SurfaceTraction>(&load.kind)) {
    out.Put(traction->traction);
  } else if (const auto* pressure = std::get_if<SurfacePressure>(&load.kind)) {
    out.Put(pressure->pressure);
  }
  out.PutVector(load.keyframes);
  PutRelease(load.release, out);
}

template <typename T>
void Update(const std::vector<T>& items, StateHash& hash) {
  const uint64_t count = items.size();
  hash.Update(&count, sizeof(count));
  hash.Update(items.data(), items.size() * sizeof(T));
}

}  // namespace

uint64_t DigestScene(const Scene& scene, const TetMesh& mesh) {
  std::string bytes;
  ByteWriter out(bytes);
  out.Put<uint64_t>(mesh.regions.size());
  for (const MeshRegion& region : mesh.regions) {
    out.Put(region.id);
    PutText(region.name, out);
  }
  out.Put<uint64_t>(scene.materials.size());
  for (const Material& material : scene.materials) {
    out.Put<uint64_t>(material.regions.size());
    for (const std::string& region : material.regions) PutText(region, out);
    out.Put(static_cast<uint32_t>(material.law));
    out.Put(material.youngs_modulus);
    out.Put(material.poisson_ratio);
    out.Put(material.density);
    out.Put<uint8_t>(material.tensile_strength.has_value());
    out.Put(material.tensile_strength.value_or(0));
    out.Put<uint8_t>(material.compressive_strength.has_value());
    out.Put(material.compressive_strength.value_or(0));
    out.Put<uint64_t>(material.fibres.size());
    for (const FibreFamily& family : material.fibres) PutFibres(family, out);
    out.Put<uint8_t>(material.fatigue.has_value());
    if (material.fatigue) PutFatigue(*material.fatigue, out);
    out.Put<uint8_t>(material.plasticity.has_value());
    if (material.plasticity) PutPlasticity(*material.plasticity, out);
    out.Put<uint8_t>(material.strands.has_value());
    if (material.strands) {
      out.Put(material.strands->residual_factor);
      out.Put(material.strands->stretch_limit);
    }
  }
  out.Put<uint64_t>(scene.node_sets.size());
  for (const NodeSet& set : scene.node_sets) {
    PutText(set.name, out);
    out.Put<uint64_t>(set.select.size());
    for (const Selector& selector : set.select) PutSelector(selector, out);
  }
  out.Put<uint64_t>(scene.motions.size());
  for (const Motion& motion : scene.motions) {
    PutText(motion.node_set, out);
    out.Put(motion.axes);
    PutKeyframes(motion.keyframes, out);
    out.Put(motion.rotation_center);
    out.Put(motion.rotation_axis);
    PutRelease(motion.release, out);
  }
  out.Put<uint64_t>(scene.loads.size());
  for (const Load& load : scene.loads) PutLoad(load, out);
  out.Put<uint64_t>(scene.initial_velocities.size());
  for (const InitialVelocity& initial : scene.initial_velocities) {
    PutText(initial.node_set, out);
    out.Put(initial.velocity);
    out.Put(initial.angular_velocity);
    out.Put(initial.center);
  }
  out.Put<uint8_t>(scene.gravity.has_value());
  out.Put(scene.gravity.value_or(Vec3{0, 0, 0}));
  out.Put(scene.fracture.max_passes);
  out.Put(scene.fracture.simultaneity);
  out.Put(static_cast<uint32_t>(scene.fracture.stress));
  out.Put(static_cast<uint32_t>(scene.fracture.aggregation));
  out.Put(static_cast<uint32_t>(scene.fracture.reformulation));
  out.Put<uint64_t>(scene.weakenings.size());
  for (const Weakening& weakening : scene.weakenings) {
    out.Put<uint64_t>(weakening.edges.index());
    if (const auto* of_nodes = std::get_if<EdgesOfNodes>(&weakening.edges)) {
      PutText(of_nodes->node_set, out);
    } else if (const auto* box = std::get_if<BoxSelector>(&weakening.edges)) {
      PutSelector(*box, out);
    } else if (const auto* sphere = std::get_if<SphereSelector>(&weakening.edges)) {
      PutSelector(*sphere, out);
    }
    out.Put(weakening.factor);
  }
  out.Put<uint8_t>(scene.impurities.has_value());
  if (scene.impurities) PutImpurities(*scene.impurities, out);
  out.Put<uint64_t>(scene.colliders.size());
  for (const Collider& collider : scene.colliders) PutCollider(collider, out);
  out.Put<uint8_t>(scene.contact.has_value());
  if (scene.contact.has_value()) {
    out.Put(scene.contact->stiffness);
    out.Put(scene.contact->friction);
  }
  out.Put(scene.timing.frames_per_second);
  out.Put(scene.timing.steps_per_frame);
  out.Put(scene.quality.newton_iterations);
  out.Put(scene.quality.residual_tolerance);
  out.Put(scene.quality.step_tolerance);
  out.Put(scene.quality.linear_tolerance);
  out.Put(scene.quality.max_step_halvings);
  out.Put(static_cast<uint32_t>(scene.quality.precision));
  out.Put(scene.seed);
  // Of a part that most scenes do not have, only where they have it.
  if (scene.sleep) {
    out.Put(scene.sleep->speed);
    out.Put(scene.sleep->time);
  }
  if (IsDamped(scene)) {
    // So that these bytes are of no other part.
    PutText("damping", out);
    out.Put(scene.damping->mass_coefficient);
    out.Put(scene.damping->stiffness_coefficient);
  }

  StateHash hash;
  Update(mesh.rest_positions, hash);
  Update(mesh.tets, hash);
  Update(mesh.tet_regions, hash);
  hash.Update(bytes.data(), bytes.size());
  return hash.Digest();
}

}  // namespace cleave
