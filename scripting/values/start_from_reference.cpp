#include "scripting/values/start_from_reference.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "geom/base/error.h"
#include "scripting/values/stored_types.h"
#include "scripting/values/value_keys.h"
#include "volmesh/envelope/build_envelope.h"

namespace sterna::scripting {

/// A part's envelope, which may have started from the reference's envelope, and a text about that.
struct StartedEnvelope {
  volmesh::PartEnvelope part;
  std::string outcome;
};
namespace {

using surfmesh::CarriedMesh;
using surfmesh::ModelStructure;

std::string part_name_of(const Model& part) { return part.components.size() == 0 ? part.faces.raw().front().name : part.components.raw().front().name; }

ContentKey points_key(const Column<VertexId, Point>& points) { return KeyMaker("points of vertices").add(points).key(); }

std::string at(const Point& location) { return ", at " + format_point(location); }

bool is_same(const OptionValue& a, const OptionValue& b) {
  const auto *x = std::get_if<double>(&a), *y = std::get_if<double>(&b);
  return x && y && is_automatic(*x) && is_automatic(*y) ? true : a == b;
}

/// Returns the names of the options that differ, except those in `except` (separated and surrounded by blanks); empty: none.
std::string differing(const OptionTable& a, const OptionTable& b, std::string_view except = " ") {
  std::string names;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (except.find(" " + std::string(a[i].name) + " ") == std::string_view::npos && !is_same(a[i].get(), b[i].get()))
      names += (names.empty() ? "" : ", ") + std::string(a[i].name);
  return names;
}

// ---- Surfaces --------------------------------------------------------------------------------------------------------------------------------

KeptPart kept_part(const PartTask& task, const surfmesh::SurfaceMesh& mesh, const RunContext& context) {
  KeptPart part{.name = part_name_of(task.model),
                .mesh = {surfmesh::structure_of(task.model), mesh},
                .options = task.options,
                .patches = task.patches,
                .has_local_sizes = task.has_local_sizes};
  part.geometry = points_key(surfmesh::carried_points(part.mesh, task.model, part.mesh.structure, context));
  return part;
}

/// Returns the reference's part of this structure, preferably of the same call of surface_mesh; null if there is none.
const KeptPart* find_like(const std::vector<KeptPart>& parts, const ModelStructure& structure, std::uint64_t call) {
  for (const bool is_of_call : {true, false})
    for (const KeptPart& part : parts)
      if ((part.call == call) == is_of_call && surfmesh::difference_of(part.mesh.structure, structure).empty()) return &part;
  return nullptr;
}

/// Returns why no part of the reference is similar: the difference from the part of the same name.
std::string difference_text(const std::vector<KeptPart>& parts, const std::string& name, const ModelStructure& structure) {
  for (const KeptPart& part : parts)
    if (part.name == name) return surfmesh::difference_of(part.mesh.structure, structure);
  return "the reference has no part with this name";
}

/// Returns a reason against taking over triangles that is known before any attempt; empty: there is none.
std::string objection(const KeptPart& like, const PartTask& task) {
  surfmesh::SurfaceMeshOptions before = like.options, now = task.options;
  if (const std::string names = differing(sterna::options_of(before), sterna::options_of(now)); !names.empty())
    return "options differ from those of the reference: " + names;
  if (KeyMaker("rules").add(like.patches).key() != KeyMaker("rules").add(task.patches).key()) return "options of patches differ from those of the reference";
  if (like.has_local_sizes || task.has_local_sizes) return "sources and size functions set edge lengths by the part's present position";
  if (!task.options.periodic.empty()) return "borders of periodic sides need identical nodes at their present position";
  if (task.options.sizes.gap_cells > 0.0) return "gap_cells sets edge lengths by the present neighbours";
  return {};
}

surfmesh::SurfaceMesh mesh_from_reference(const PartTask& task, const Reuse& reuse, const PartMesher& ordinary, const std::optional<ContentKey>& key,
                                          const RunContext& context) {
  ReferenceUse& reference = *reuse.reference;
  const std::string what = "surface of " + part_name_of(task.model) + ": ";
  const auto from_scratch = [&](const std::string& why) {
    reference.report(what + "meshed again: " + why, reuse, context);
    return ordinary(task, context);
  };
  const std::vector<KeptPart>& parts = reference.parts(context);
  const ModelStructure structure = surfmesh::structure_of(task.model);
  const KeptPart* like = find_like(parts, structure, reference.surface());
  if (like == nullptr) return from_scratch(difference_text(parts, part_name_of(task.model), structure));
  const std::string against = objection(*like, task);
  Column<VertexId, Point> points = surfmesh::carried_points(like->mesh, task.model, structure, context);
  if (points_key(points) == like->geometry) {
    if (!against.empty()) reference.report(what + "meshed again: " + against, reuse, context);
    return ordinary(task, context);  // the part has the reference's own geometry
  }
  if (!against.empty()) return from_scratch(against);
  const std::string of_cache = "of " + part_name_of(task.model) + " with the triangles of " + reference.name();
  std::optional<ContentKey> of_like;  // number of the reference's part
  if (key) of_like = KeyMaker("carried").add(*key).add(static_cast<std::uint64_t>(like - parts.data())).key();
  CarriedMesh carried = cached<CarriedMesh>(reuse, "surface_mesh", of_cache, of_like, context,
                                            [&] { return surfmesh::carry_mesh(like->mesh, task.model, structure, std::move(points), task.options, context); });
  if (!carried.mesh) return from_scratch(carried.objection + at(carried.location));
  reference.report(what + "topology of " + reference.name(), reuse, context);
  reference.note_carried(carried.mesh->mesh, part_name_of(task.model));
  return std::move(*carried.mesh);
}

// ---- Envelopes -------------------------------------------------------------------------------------------------------------------------------

/// Options in which the case may differ from the reference: heights follow those of this case, and the feature angle depends on the wall.
constexpr std::string_view k_free_options = " layers first_height max_growth total_height solve_for max_thickness max_relative_height feature_angle ";

/// Returns "envelope of wing: "; if the part took over triangles, marks its envelope as reported.
std::string envelope_of(const TriMesh& wall, ReferenceUse& reference) {
  CarriedPart* carried = reference.carried(triangles_key(wall));
  if (carried) carried->has_envelope = true;
  return "envelope of " + (carried ? carried->name : wall.patches.raw().front().name) + ": ";
}

/// Returns the reference's envelope from which the envelope of this wall may start. Returns null and reports the reason if the reference has no envelope of a
/// wall with these triangles, or if its options differ. Returns null without a report if the wall is the reference's own, or if no part of it took over
/// triangles (`has_carried` false).
const KeptEnvelope* find_start(const TriMesh& wall, volmesh::EnvelopeOptions options, const std::string& what, bool has_carried, const Reuse& reuse,
                               const RunContext& context) {
  const ContentKey connectivity = connectivity_of(wall);
  std::string against = "the reference has no envelope of a wall with these triangles";
  for (const KeptEnvelope& kept : reuse.reference->envelopes(context)) {
    if (kept.wall != connectivity || kept.start.points.size() != wall.n_vertices()) continue;
    if (kept.start.points.raw() == wall.points.raw()) return nullptr;
    volmesh::EnvelopeOptions before = kept.options;
    const std::string names = differing(sterna::options_of(before), sterna::options_of(options), k_free_options);
    if (names.empty()) return &kept;
    against = "options differ from those of the reference: " + names;
  }
  if (has_carried) reuse.reference->report(what + "made from scratch: " + against, reuse, context);
  return nullptr;
}

volmesh::Envelope start_or_build(const KeptEnvelope& from, const std::string& name, const volmesh::LayerBase& base, const volmesh::EnvelopeOptions& options,
                                 volmesh::Collider& collider, std::string& outcome, const RunContext& context) {
  volmesh::WarmStart start = volmesh::warm_start(base, options, from.start, collider, context);
  outcome = start.envelope ? "started from " + name : "made from scratch: " + start.objection + at(start.location);
  return start.envelope ? std::move(*start.envelope) : volmesh::build_envelope(base, options, collider, context);
}

volmesh::PartEnvelope part_from_reference(const volmesh::PartEnvelopeTask& task, const Reuse& reuse, const volmesh::PartEnvelopeMaker& ordinary,
                                          const std::optional<ContentKey>& key, const RunContext& context) {
  const bool has_carried = reuse.reference->carried(triangles_key(task.wall)) != nullptr;
  const std::string what = envelope_of(task.wall, *reuse.reference);
  const KeptEnvelope* from = find_start(task.wall, task.options, what, has_carried, reuse, context);
  if (from == nullptr) return ordinary(task, context);
  const auto make = [&] {
    StartedEnvelope started;
    started.part = volmesh::part_envelope(
        task, context, [&](const volmesh::LayerBase& base, const volmesh::EnvelopeOptions& options, volmesh::Collider& collider, const RunContext& of_step) {
          return start_or_build(*from, reuse.reference->name(), base, options, collider, started.outcome, of_step);
        });
    return started;
  };
  StartedEnvelope started = cached<StartedEnvelope>(reuse, "envelope", "of a part beside " + reuse.reference->name(), key, context, make);
  reuse.reference->report(what + started.outcome, reuse, context);
  return std::move(started.part);
}

volmesh::Envelope wall_from_reference(const volmesh::LayerBase& base, const volmesh::EnvelopeOptions& options, volmesh::Collider& collider, const Reuse& reuse,
                                      const RunContext& context) {
  ReferenceUse& reference = *reuse.reference;
  if (reference.is_this()) {
    volmesh::Envelope envelope = volmesh::build_envelope(base, options, collider, context);
    reference.keep({connectivity_of(base.wall), options, {base.wall.points, envelope}});
    return envelope;
  }
  const std::string what = envelope_of(base.wall, reference);
  bool has_carried = false;  // the wall is the part of the surface that has layers; its triangles may belong to none of the parts
  for (CarriedPart& part : reference.all_carried()) has_carried = part.has_envelope = true;
  const KeptEnvelope* from = find_start(base.wall, options, what, has_carried, reuse, context);
  if (from == nullptr) return volmesh::build_envelope(base, options, collider, context);
  std::string outcome;
  volmesh::Envelope envelope = start_or_build(*from, reference.name(), base, options, collider, outcome, context);
  reference.report(what + outcome, reuse, context);
  return envelope;
}

}  // namespace

PartMesher starting_mesher(const Reuse& reuse, const PartMesher& ordinary,
                           const std::function<std::optional<ContentKey>(const PartTask&, const RunContext&)>& key) {
  if (reuse.reference == nullptr) return ordinary;
  return [reuse, ordinary, key](const PartTask& task, const RunContext& context) {
    if (!reuse.reference->is_this())
      return mesh_from_reference(task, reuse, ordinary, key ? beside_reference(key(task, context), reuse, context) : std::nullopt, context);
    surfmesh::SurfaceMesh mesh = ordinary(task, context);
    reuse.reference->keep(kept_part(task, mesh, context));
    return mesh;
  };
}

volmesh::Makers starting_envelopes(volmesh::Makers makers, const Reuse& reuse, const volmesh::PartEnvelopeMaker& ordinary,
                                   const std::function<ContentKey(const volmesh::PartEnvelopeTask&, const RunContext&)>& key) {
  makers.part_envelope = [reuse, ordinary, key](const volmesh::PartEnvelopeTask& task, const RunContext& context) {
    if (!reuse.reference->is_this()) return part_from_reference(task, reuse, ordinary, beside_reference(key(task, context), reuse, context), context);
    volmesh::PartEnvelope made = ordinary(task, context);
    reuse.reference->keep({connectivity_of(task.wall), task.options, {task.wall.points, made.envelope}});
    return made;
  };
  makers.wall_envelope = [reuse](const volmesh::LayerBase& base, const volmesh::EnvelopeOptions& of_wall, volmesh::Collider& collider,
                                 const RunContext& context) { return wall_from_reference(base, of_wall, collider, reuse, context); };
  return makers;
}

void report_other_envelopes(const std::vector<volmesh::PlacedPart>& parts, const Reuse& reuse, const RunContext& context) {
  if (reuse.reference == nullptr) return;
  for (const volmesh::PlacedPart& placed : parts) {
    CarriedPart* part = placed.own ? reuse.reference->carried(triangles_key(*placed.own)) : nullptr;
    if (part == nullptr || part->has_envelope) continue;
    part->has_envelope = true;
    reuse.reference->report("envelope of " + part->name + ": made from scratch: its layer depends on adjacent parts", reuse, context);
  }
}

std::optional<ContentKey> beside_reference(const std::optional<ContentKey>& key, const Reuse& reuse, const RunContext& context) {
  if (reuse.reference == nullptr || !key) return key;
  return KeyMaker("beside a reference").add(*key).add(reuse.reference->key(context)).key();
}

void write_beside(ByteSink& sink, const ReferenceUse::Beside& beside) { write_value(sink, beside); }

ReferenceUse::Beside read_beside(ByteSource& source) {
  ReferenceUse::Beside beside;
  read_value(source, beside);
  return beside;
}

}  // namespace sterna::scripting
