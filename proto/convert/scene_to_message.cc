#include "proto/convert/impurity_layer.h"
#include "proto/convert/scene.h"

namespace cleave {
namespace {

using Numbers = google::protobuf::RepeatedField<double>;

void Write(const Vec3& vector, Numbers* numbers) { numbers->Add(vector.begin(), vector.end()); }

void Write(const MeshResolution& resolution, v1::MeshResolution* message) {
  message->set_layout(resolution.layout == MeshLayout::kJitteredLattice
                          ? v1::MESH_LAYOUT_JITTERED_LATTICE
                          : v1::MESH_LAYOUT_UNSTRUCTURED);
  message->set_cell_size(resolution.cell_size);
  message->set_jitter(resolution.jitter);
  message->set_seed(resolution.seed);
}

struct WriteSource {
  v1::MeshSource* message;

  void operator()(std::monostate) const {}
  void operator()(const MeshFile& file) const { message->set_file(file.path); }
  void operator()(const MeshAsset& asset) const { message->set_asset(asset.sha256); }
  void operator()(const BoxMesh& box) const {
    v1::BoxMesh* to = message->mutable_box();
    Write(box.origin, to->mutable_origin());
    Write(box.size, to->mutable_size());
    Write(box.resolution, to->mutable_resolution());
  }
  void operator()(const CylinderMesh& cylinder) const {
    v1::CylinderMesh* to = message->mutable_cylinder();
    Write(cylinder.origin, to->mutable_origin());
    to->set_radius(cylinder.radius);
    to->set_height(cylinder.height);
    Write(cylinder.resolution, to->mutable_resolution());
  }
  void operator()(const TubeMesh& tube) const {
    v1::TubeMesh* to = message->mutable_tube();
    Write(tube.origin, to->mutable_origin());
    to->set_outer_radius(tube.outer_radius);
    to->set_inner_radius(tube.inner_radius);
    to->set_height(tube.height);
    Write(tube.resolution, to->mutable_resolution());
  }
  void operator()(const DiscMesh& disc) const {
    v1::DiscMesh* to = message->mutable_disc();
    Write(disc.origin, to->mutable_origin());
    to->set_radius(disc.radius);
    to->set_thickness(disc.thickness);
    Write(disc.resolution, to->mutable_resolution());
  }
};

struct WriteSelector {
  v1::Selector* message;

  void operator()(std::monostate) const {}
  void operator()(const BoxSelector& box) const {
    Write(box.min, message->mutable_box()->mutable_min());
    Write(box.max, message->mutable_box()->mutable_max());
  }
  void operator()(const SphereSelector& sphere) const {
    Write(sphere.center, message->mutable_sphere()->mutable_center());
    message->mutable_sphere()->set_radius(sphere.radius);
  }
  void operator()(const PlaneSelector& plane) const {
    Write(plane.point, message->mutable_plane()->mutable_point());
    Write(plane.normal, message->mutable_plane()->mutable_normal());
  }
  void operator()(const RegionSelector& region) const { message->set_region(region.region); }
  void operator()(const IdSelector& selector) const {
    message->mutable_ids()->mutable_ids()->Add(selector.ids.begin(), selector.ids.end());
  }
};

struct WriteDirection {
  v1::FibreFamily* message;

  void operator()(std::monostate) const {}
  void operator()(const ConstantDirection& constant) const {
    Write(constant.vector, message->mutable_constant()->mutable_vector());
  }
  void operator()(const CylindricalDirection& cylindrical) const {
    v1::CylindricalDirection* to = message->mutable_cylindrical();
    Write(cylindrical.center, to->mutable_center());
    Write(cylindrical.axis, to->mutable_axis());
    Write(cylindrical.mixture, to->mutable_mixture());
  }
  void operator()(const TetDirections& directions) const {
    Numbers* to = message->mutable_per_tet()->mutable_vectors();
    for (const Vec3& vector : directions.vectors) Write(vector, to);
  }
  void operator()(const CurveDirections& directions) const {
    for (const Polyline& curve : directions.curves) {
      v1::Polyline* to = message->mutable_curves()->add_curves();
      for (const Vec3& point : curve.points) Write(point, to->mutable_points());
    }
    message->mutable_curves();
  }
};

v1::ElasticLaw MessageFromLaw(ElasticLaw law) {
  switch (law) {
    case ElasticLaw::kInvertibleNeoHookean:
      return v1::ELASTIC_LAW_INVERTIBLE_NEO_HOOKEAN;
    case ElasticLaw::kCorotatedLinear:
      return v1::ELASTIC_LAW_COROTATED_LINEAR;
    case ElasticLaw::kStVenantKirchhoff:
      return v1::ELASTIC_LAW_ST_VENANT_KIRCHHOFF;
    case ElasticLaw::kStableNeoHookean:
      break;
  }
  return v1::ELASTIC_LAW_STABLE_NEO_HOOKEAN;
}

void Write(const std::vector<Keyframe>& keyframes,
           google::protobuf::RepeatedPtrField<v1::Keyframe>* message) {
  for (const Keyframe& keyframe : keyframes) {
    v1::Keyframe* to = message->Add();
    to->set_time(keyframe.time);
    Write(keyframe.translation, to->mutable_translation());
    to->set_rotation(keyframe.rotation);
  }
}

void WriteRelease(const Release& release, v1::Release* message) {
  if (release.time.has_value()) message->set_time(*release.time);
  message->set_first_fracture(release.first_fracture);
  if (release.broken_share.has_value()) message->set_broken_share(*release.broken_share);
  if (release.pieces.has_value()) message->set_pieces(*release.pieces);
  for (const std::string& set : release.separated_node_sets) message->add_separated_node_sets(set);
}

struct WriteLoadKind {
  v1::Load* message;

  void operator()(std::monostate) const {}
  void operator()(const PointForce& force) const {
    Write(force.total, message->mutable_force()->mutable_total());
  }
  void operator()(const SurfaceTraction& traction) const {
    Write(traction.traction, message->mutable_traction()->mutable_traction());
  }
  void operator()(const SurfacePressure& pressure) const {
    message->mutable_pressure()->set_pressure(pressure.pressure);
  }
};

void WriteMotion(const Motion& motion, v1::Motion* message) {
  message->set_node_set(motion.node_set);
  for (int axis = 0; axis < 3; ++axis) {
    if (motion.axes[static_cast<size_t>(axis)]) {
      message->add_axes(static_cast<v1::Axis>(v1::AXIS_X + axis));
    }
  }
  Write(motion.keyframes, message->mutable_keyframes());
  Write(motion.rotation_center, message->mutable_rotation_center());
  Write(motion.rotation_axis, message->mutable_rotation_axis());
  if (motion.release.has_value()) WriteRelease(*motion.release, message->mutable_release());
}

void WriteLoad(const Load& load, v1::Load* message) {
  message->set_node_set(load.node_set);
  std::visit(WriteLoadKind{message}, load.kind);
  for (const LoadKeyframe& keyframe : load.keyframes) {
    v1::LoadKeyframe* to = message->add_keyframes();
    to->set_time(keyframe.time);
    to->set_intensity(keyframe.intensity);
  }
  if (load.release.has_value()) WriteRelease(*load.release, message->mutable_release());
}

struct WriteShape {
  v1::Collider* message;

  void operator()(std::monostate) const {}
  void operator()(const PlaneShape& plane) const {
    Write(plane.point, message->mutable_plane()->mutable_point());
    Write(plane.normal, message->mutable_plane()->mutable_normal());
  }
  void operator()(const SphereShape& sphere) const {
    Write(sphere.center, message->mutable_sphere()->mutable_center());
    message->mutable_sphere()->set_radius(sphere.radius);
  }
  void operator()(const BoxShape& box) const {
    v1::BoxShape* to = message->mutable_box();
    Write(box.center, to->mutable_center());
    Write(box.size, to->mutable_size());
    Write(box.rotation_axis, to->mutable_rotation_axis());
    to->set_rotation(box.rotation);
  }
  void operator()(const SurfaceShape& surface) const {
    v1::SurfaceShape* to = message->mutable_surface();
    for (const Vec3& vertex : surface.vertices) Write(vertex, to->mutable_vertices());
    for (const auto& triangle : surface.triangles)
      to->mutable_triangles()->Add(triangle.begin(), triangle.end());
    to->set_file(surface.file);
  }
};

void WriteCollider(const Collider& collider, v1::Collider* message) {
  message->set_name(collider.name);
  std::visit(WriteShape{message}, collider.shape);
  Write(collider.keyframes, message->mutable_keyframes());
  Write(collider.rotation_center, message->mutable_rotation_center());
  Write(collider.rotation_axis, message->mutable_rotation_axis());
  if (collider.body.has_value()) {
    v1::RigidBody* to = message->mutable_body();
    if (collider.body->mass.has_value()) to->set_mass(*collider.body->mass);
    if (collider.body->density.has_value()) to->set_density(*collider.body->density);
    Write(collider.body->velocity, to->mutable_velocity());
    Write(collider.body->angular_velocity, to->mutable_angular_velocity());
  }
  message->set_friction(collider.friction);
  message->set_stiffness(collider.stiffness);
  message->set_margin(collider.margin);
}

struct WriteEdges {
  v1::Weakening* message;

  void operator()(std::monostate) const {}
  void operator()(const EdgesOfNodes& edges) const { message->set_node_set(edges.node_set); }
  void operator()(const BoxSelector& box) const {
    Write(box.min, message->mutable_box()->mutable_min());
    Write(box.max, message->mutable_box()->mutable_max());
  }
  void operator()(const SphereSelector& sphere) const {
    Write(sphere.center, message->mutable_sphere()->mutable_center());
    message->mutable_sphere()->set_radius(sphere.radius);
  }
};

void WriteImpurities(const Impurities& impurities, v1::Impurities* message) {
  message->set_effect(impurities.effect == ImpurityEffect::kUpgradation
                          ? v1::IMPURITY_EFFECT_UPGRADATION
                          : v1::IMPURITY_EFFECT_DEGRADATION);
  // Both enums have the same order; 0 is "unspecified" in messages.
  message->set_model(static_cast<v1::ImpurityModel>(static_cast<int>(impurities.model) + 1));
  message->set_mode(impurities.mode == ImpurityMode::kSampled ? v1::IMPURITY_MODE_SAMPLED
                                                              : v1::IMPURITY_MODE_EXPECTED);
  message->set_potency(impurities.potency);
  message->mutable_map()->Add(impurities.map.begin(), impurities.map.end());
  for (const PotencyPatch& patch : impurities.patches) {
    v1::PotencyPatch* to = message->add_patches();
    to->set_node_set(patch.node_set);
    to->set_share(patch.share);
  }
  message->set_noise(impurities.noise);
  message->set_distribution(impurities.distribution == NoiseDistribution::kUniform
                                ? v1::NOISE_DISTRIBUTION_UNIFORM
                                : v1::NOISE_DISTRIBUTION_GAUSSIAN);
  message->set_steepness(impurities.steepness);
  message->set_pure_offset(impurities.pure_offset);
  if (impurities.degree_weight.has_value()) message->set_degree_weight(*impurities.degree_weight);
  for (const ImpurityLayer& layer : impurities.layers) WriteLayer(layer, *message->add_layers());
}

void WriteSettings(const Scene& scene, v1::Scene& message) {
  message.mutable_fracture()->set_max_passes(scene.fracture.max_passes);
  message.mutable_fracture()->set_simultaneity(scene.fracture.simultaneity);
  message.mutable_fracture()->set_stress(scene.fracture.stress == FractureStress::kTotal
                                             ? v1::FRACTURE_STRESS_TOTAL
                                             : v1::FRACTURE_STRESS_MATRIX);

  v1::Timing* timing = message.mutable_timing();
  timing->set_frames_per_second(scene.timing.frames_per_second);
  timing->set_frame_count(scene.timing.frame_count);
  timing->set_steps_per_frame(scene.timing.steps_per_frame);

  if (scene.damping.has_value()) {
    v1::Damping* damping = message.mutable_damping();
    damping->set_mass_coefficient(scene.damping->mass_coefficient);
    damping->set_stiffness_coefficient(scene.damping->stiffness_coefficient);
  }

  v1::Quality* quality = message.mutable_quality();
  quality->set_newton_iterations(scene.quality.newton_iterations);
  quality->set_residual_tolerance(scene.quality.residual_tolerance);
  quality->set_step_tolerance(scene.quality.step_tolerance);
  quality->set_linear_tolerance(scene.quality.linear_tolerance);
  quality->set_max_step_halvings(scene.quality.max_step_halvings);
  quality->set_precision(scene.quality.precision == Precision::kFloat ? v1::PRECISION_FLOAT
                                                                      : v1::PRECISION_DOUBLE);

  v1::Output* output = message.mutable_output();
  if (scene.output.tolerance.has_value()) output->set_tolerance(*scene.output.tolerance);
  output->set_keyframe_interval(scene.output.keyframe_interval);
  output->set_checkpoint_interval(scene.output.checkpoint_interval);
}

}  // namespace

v1::Material MessageFromMaterial(const Material& material) {
  v1::Material message;
  message.set_name(material.name);
  message.mutable_regions()->Add(material.regions.begin(), material.regions.end());
  message.set_law(MessageFromLaw(material.law));
  message.set_youngs_modulus(material.youngs_modulus);
  message.set_poisson_ratio(material.poisson_ratio);
  message.set_density(material.density);
  if (material.tensile_strength.has_value()) {
    message.set_tensile_strength(*material.tensile_strength);
  }
  if (material.compressive_strength.has_value())
    message.set_compressive_strength(*material.compressive_strength);
  for (const FibreFamily& family : material.fibres) {
    v1::FibreFamily* fibres = message.add_fibres();
    fibres->set_stiffness(family.stiffness);
    std::visit(WriteDirection{fibres}, family.direction);
    fibres->set_strength_ratio(family.strength_ratio);
  }
  if (material.fatigue.has_value()) {
    v1::Fatigue* fatigue = message.mutable_fatigue();
    fatigue->set_strength_coefficient(material.fatigue->strength_coefficient);
    fatigue->set_strength_exponent(material.fatigue->strength_exponent);
    if (material.fatigue->endurance_limit.has_value())
      fatigue->set_endurance_limit(*material.fatigue->endurance_limit);
    fatigue->set_degradation_exponent(material.fatigue->degradation_exponent);
  }
  if (material.plasticity.has_value()) {
    v1::Plasticity* plasticity = message.mutable_plasticity();
    plasticity->set_yield_stress(material.plasticity->yield_stress);
    plasticity->set_hardening(material.plasticity->hardening);
    plasticity->set_flow_rate(material.plasticity->flow_rate);
    if (material.plasticity->failure_strain.has_value()) {
      plasticity->set_failure_strain(*material.plasticity->failure_strain);
    }
  }
  if (material.strands.has_value()) {
    message.mutable_strands()->set_residual_factor(material.strands->residual_factor);
    message.mutable_strands()->set_stretch_limit(material.strands->stretch_limit);
  }
  return message;
}

v1::Scene MessageFromScene(const Scene& scene) {
  v1::Scene message;
  message.set_name(scene.name);
  message.mutable_mesh()->set_unit_scale(scene.mesh.unit_scale);
  std::visit(WriteSource{message.mutable_mesh()}, scene.mesh.source);
  for (const Material& material : scene.materials) {
    *message.add_materials() = MessageFromMaterial(material);
  }
  for (const NodeSet& set : scene.node_sets) {
    v1::NodeSet* to = message.add_node_sets();
    to->set_name(set.name);
    for (const Selector& selector : set.select) {
      std::visit(WriteSelector{to->add_select()}, selector);
    }
  }
  for (const Motion& motion : scene.motions) WriteMotion(motion, message.add_motions());
  for (const Load& load : scene.loads) WriteLoad(load, message.add_loads());
  for (const InitialVelocity& start : scene.initial_velocities) {
    v1::InitialVelocity* to = message.add_initial_velocities();
    to->set_node_set(start.node_set);
    Write(start.velocity, to->mutable_velocity());
    Write(start.angular_velocity, to->mutable_angular_velocity());
    Write(start.center, to->mutable_center());
  }
  if (scene.gravity.has_value()) Write(*scene.gravity, message.mutable_gravity());
  for (const Weakening& weakening : scene.weakenings) {
    v1::Weakening* to = message.add_weakenings();
    std::visit(WriteEdges{to}, weakening.edges);
    to->set_factor(weakening.factor);
  }
  if (scene.contact.has_value()) {
    message.mutable_contact()->set_stiffness(scene.contact->stiffness);
    message.mutable_contact()->set_friction(scene.contact->friction);
  }
  if (scene.sleep.has_value()) {
    message.mutable_sleep()->set_speed(scene.sleep->speed);
    message.mutable_sleep()->set_time(scene.sleep->time);
  }
  if (scene.render_mesh.has_value()) {
    v1::RenderMeshSource* to = message.mutable_render_mesh();
    to->set_unit_scale(scene.render_mesh->unit_scale);
    if (const auto* file = std::get_if<MeshFile>(&scene.render_mesh->source))
      to->set_file(file->path);
    if (const auto* asset = std::get_if<MeshAsset>(&scene.render_mesh->source))
      to->set_asset(asset->sha256);
  }
  for (const Collider& collider : scene.colliders) WriteCollider(collider, message.add_colliders());
  message.mutable_fracture()->set_aggregation(scene.fracture.aggregation == StressAggregation::kMax
                                                  ? v1::STRESS_AGGREGATION_MAX
                                                  : v1::STRESS_AGGREGATION_MEAN);
  message.mutable_fracture()->set_reformulation(scene.fracture.reformulation ==
                                                        Reformulation::kEdgeProjected
                                                    ? v1::REFORMULATION_EDGE_PROJECTED
                                                    : v1::REFORMULATION_UNIFORM);
  if (scene.impurities.has_value())
    WriteImpurities(*scene.impurities, message.mutable_impurities());
  WriteSettings(scene, message);
  message.set_seed(scene.seed);
  return message;
}

}  // namespace cleave
