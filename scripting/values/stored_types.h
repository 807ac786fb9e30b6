// The structs that go into keys and entries of the cache, with their number of members. A wrong number does not compile; see members.h.
#pragma once

#include "geom/mesh/check.h"
#include "geom/model/aircraft.h"
#include "scripting/cache/archive.h"
#include "scripting/values/stages.h"
#include "scripting/values/verbs.h"
#include "surfmesh/model/model_wall.h"
#include "surfmesh/remesh/remesh_surface.h"

namespace sterna::scripting {

// Surfaces.
template <>
inline constexpr std::size_t k_members<Uv> = 2;
template <>
inline constexpr std::size_t k_members<Patch> = 2;
template <>
inline constexpr std::size_t k_members<TriMesh> = 4;
template <>
inline constexpr std::size_t k_members<InputFile> = 2;
template <>
inline constexpr std::size_t k_members<VertexPlace> = 2;
template <>
inline constexpr std::size_t k_members<surfmesh::EdgePlace> = 2;
template <>
inline constexpr std::size_t k_members<surfmesh::WallPlaces> = 4;
template <>
inline constexpr std::size_t k_members<surfmesh::StitchOptions> = 7;
template <>
inline constexpr std::size_t k_members<surfmesh::StitchReport> = 12;
template <>
inline constexpr std::size_t k_members<surfmesh::RepairOptions> = 11;
template <>
inline constexpr std::size_t k_members<surfmesh::WrapOptions> = 10;
template <>
inline constexpr std::size_t k_members<surfmesh::RemeshOptions> = 18;
template <>
inline constexpr std::size_t k_members<surfmesh::SurfaceMeshOptions> = 24;
template <>
inline constexpr std::size_t k_members<surfmesh::PatchSurfaceOptions> = 14;
template <>
inline constexpr std::size_t k_members<surfmesh::FaceMeshSummary> = 13;
template <>
inline constexpr std::size_t k_members<surfmesh::AbsorbedPart> = 3;
template <>
inline constexpr std::size_t k_members<surfmesh::CrossingFaces> = 6;
template <>
inline constexpr std::size_t k_members<surfmesh::LooseEdge> = 5;
template <>
inline constexpr std::size_t k_members<surfmesh::BandSummary> = 7;
template <>
inline constexpr std::size_t k_members<surfmesh::SurfaceMeshReport> = 21;
template <>
inline constexpr std::size_t k_members<surfmesh::SurfaceMesh> = 7;
template <>
inline constexpr std::size_t k_members<SurfaceRecipe> = 4;
template <>
inline constexpr std::size_t k_members<surfmesh::SurfaceDistance> = 4;
template <>
inline constexpr std::size_t k_members<surfmesh::RowReport> = 6;
template <>
inline constexpr std::size_t k_members<surfmesh::RemeshReport> = 21;
template <>
inline constexpr std::size_t k_members<surfmesh::RemeshResult> = 2;
template <>
inline constexpr std::size_t k_members<UnionOptions> = 5;
template <>
inline constexpr std::size_t k_members<volmesh::SizeSource> = 12;
template <>
inline constexpr std::size_t k_members<volmesh::PatchRule> = 10;
template <>
inline constexpr std::size_t k_members<volmesh::ActuatorDisc> = 6;
template <>
inline constexpr std::size_t k_members<volmesh::WakeSheet> = 5;
template <>
inline constexpr std::size_t k_members<volmesh::PeriodicNames> = 2;
template <>
inline constexpr std::size_t k_members<volmesh::PlacedPart> = 5;

// Volume meshes.
template <>
inline constexpr std::size_t k_members<LayerBlock> = 5;
template <>
inline constexpr std::size_t k_members<LayerRequest> = 10;
template <>
inline constexpr std::size_t k_members<BoundaryTriangle> = 2;
template <>
inline constexpr std::size_t k_members<BoundaryQuad> = 2;
template <>
inline constexpr std::size_t k_members<HybridMesh> = 11;
template <>
inline constexpr std::size_t k_members<ErrorPlace> = 2;
template <>
inline constexpr std::size_t k_members<CellCounts> = 4;
template <>
inline constexpr std::size_t k_members<CheckFinding> = 3;
template <>
inline constexpr std::size_t k_members<Quality> = 9;
template <>
inline constexpr std::size_t k_members<PatchCoverage> = 9;
template <>
inline constexpr std::size_t k_members<GateLimits> = 4;
template <>
inline constexpr std::size_t k_members<Forcing> = 2;
template <>
inline constexpr std::size_t k_members<GatePlace> = 4;
template <>
inline constexpr std::size_t k_members<GateExtent> = 3;
template <>
inline constexpr std::size_t k_members<GateResult> = 21;
template <>
inline constexpr std::size_t k_members<Consumers> = 2;
template <>
inline constexpr std::size_t k_members<ConsumerPlaces> = 3;
template <>
inline constexpr std::size_t k_members<CheckReport> = 22;
template <>
inline constexpr std::size_t k_members<PeriodicSides> = 3;
template <>
inline constexpr std::size_t k_members<PeriodicMatchReport> = 6;
template <>
inline constexpr std::size_t k_members<volmesh::PatchLayerReport> = 10;
template <>
inline constexpr std::size_t k_members<volmesh::VisibilityReport> = 4;
template <>
inline constexpr std::size_t k_members<volmesh::InterfaceReport> = 4;
template <>
inline constexpr std::size_t k_members<volmesh::FirstNodeReport> = 11;
template <>
inline constexpr std::size_t k_members<volmesh::LayerReport> = 22;
template <>
inline constexpr std::size_t k_members<volmesh::WorstElement> = 3;
template <>
inline constexpr std::size_t k_members<volmesh::EnvelopeCertificate> = 10;
template <>
inline constexpr std::size_t k_members<volmesh::ImproveReport> = 12;
template <>
inline constexpr std::size_t k_members<volmesh::NeedleReport> = 7;
template <>
inline constexpr std::size_t k_members<volmesh::VolumeMeshResult> = 13;
template <>
inline constexpr std::size_t k_members<volmesh::ClosedFans> = 2;
template <>
inline constexpr std::size_t k_members<volmesh::EnvelopeStage> = 3;
template <>
inline constexpr std::size_t k_members<volmesh::BoundarySplits::Origin> = 2;
template <>
inline constexpr std::size_t k_members<volmesh::BoundarySplits> = 4;
template <>
inline constexpr std::size_t k_members<volmesh::TetraResult> = 9;
template <>
inline constexpr std::size_t k_members<volmesh::FilledStage> = 9;
template <>
inline constexpr std::size_t k_members<volmesh::PartEnvelope> = 2;

// Aircraft.
template <>
inline constexpr std::size_t k_members<Placement> = 2;
template <>
inline constexpr std::size_t k_members<Transform> = 4;
template <>
inline constexpr std::size_t k_members<EndCap> = 2;
template <>
inline constexpr std::size_t k_members<RefinementRegion> = 7;
template <>
inline constexpr std::size_t k_members<MeshCriterion> = 15;
template <>
inline constexpr std::size_t k_members<BodyFrame> = 16;
template <>
inline constexpr std::size_t k_members<InletLip> = 3;
template <>
inline constexpr std::size_t k_members<Body> = 10;
template <>
inline constexpr std::size_t k_members<WingPatch::Place> = 3;
template <>
inline constexpr std::size_t k_members<WingPatch::Slot> = 5;
template <>
inline constexpr std::size_t k_members<WingPatch> = 4;
template <>
inline constexpr std::size_t k_members<WingSection> = 18;
template <>
inline constexpr std::size_t k_members<Wing> = 13;
template <>
inline constexpr std::size_t k_members<HingePoint> = 2;
template <>
inline constexpr std::size_t k_members<ControlSurface> = 5;
template <>
inline constexpr std::size_t k_members<Deflection> = 8;
template <>
inline constexpr std::size_t k_members<CowlSection> = 3;
template <>
inline constexpr std::size_t k_members<Cowl> = 2;
template <>
inline constexpr std::size_t k_members<CowlNacelle> = 5;
template <>
inline constexpr std::size_t k_members<ControlParticipation> = 2;
template <>
inline constexpr std::size_t k_members<Control> = 2;
template <>
inline constexpr std::size_t k_members<EngineRegion> = 2;
template <>
inline constexpr std::size_t k_members<Turbofan> = 11;
template <>
inline constexpr std::size_t k_members<JetEngine> = 7;
template <>
inline constexpr std::size_t k_members<SumoSettings> = 6;
template <>
inline constexpr std::size_t k_members<Aircraft> = 12;

namespace detail {

/// A struct with a base class: its members are spread over two classes.
template <>
struct Archive<volmesh::Envelope> {
  static void write(ByteSink& sink, const volmesh::Envelope& value) {
    for_each_column([&](const auto& column) { write_value(sink, column); }, value);
  }
  static void read(ByteSource& source, volmesh::Envelope& value) {
    for_each_column([&](auto& column) { read_value(source, column); }, value);
  }
};

}  // namespace detail
}  // namespace sterna::scripting
