// Extrusion of the layer: nodes on curved growth lines between wall and envelope, and the repair of invalid cells (docs/method/prisms.md, "Repair"; [ET15
// §3.4]).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "geom/base/borrowed.h"
#include "geom/mesh/hybrid_mesh.h"
#include "volmesh/case/prism_options.h"
#include "volmesh/envelope/envelope.h"
#include "volmesh/layer/curving.h"
#include "volmesh/layer/truncate.h"

namespace sterna::volmesh {

struct Extrusion {
  LayerBlock layers;                ///< growth line k stands on wall vertex k; base triangles are the wall triangles
  std::vector<Point> points;        ///< nodes of all growth lines, one line after the other, each from the wall up
  std::int64_t n_straightened = 0;  ///< number of growth lines whose c_t was reduced
  /// Numbers of growth lines whose c_t was reduced, by the fraction of the target c_t: 0, up to 1/4, 1/2, 3/4, below 1.
  std::array<std::int64_t, 5> curving_shares{};
};

/// Creates and updates the layer of one wall. Nodes and curving are kept between calls. Later calls update only the growth lines whose envelope has changed,
/// and the columns beside them.
class Extruder {
 public:
  Extruder(Borrowed<const LayerBase> base, const EnvelopeOptions& envelope_options, const PrismOptions& options, const RunContext& context);

  /// Extrudes the layer. If truncation is requested, LayerNumbers determines the numbers of layers. LinePlacer places the nodes, with the largest c_t for which
  /// the growth along the growth line is allowed (G8), sides can be cut, and faces are not tilted (OpenFOAM). Columns with an invalid cell (exact tests of cell
  /// and dual sub-volumes) are repaired in this order. First, c_t of their growth lines is reduced to the largest value for which the column is valid, found by
  /// bisection, and smoothed over the surface (Curving). If straight growth lines are not sufficient, truncated growth lines get more layers. Then heights are
  /// made equal over the column's corners and lowered (through `unwarp`), until the corners collapse if necessary. Changes `envelope` accordingly.
  /// \post every cell is valid with positive dual sub-volumes; top nodes equal envelope.point() bit-exactly
  /// \throws Error(envelope_failed) if columns are still invalid after 200 rounds
  void extrude(Envelope& envelope);
  /// Returns the layer of the last extrude(), and empties the object.
  Extrusion take() &&;

 private:
  using Columns = std::vector<std::size_t>;  ///< numbers of columns (= wall triangles), ascending

  std::vector<VertexId> place_stale_lines(const Envelope& envelope);
  bool limit_growth(const Envelope& envelope, const std::vector<VertexId>& lines);
  bool limit_warp(const Envelope& envelope, const Columns* some);
  bool limit_tilt(const Envelope& envelope, const Columns* some);
  double upright_share(const Envelope& envelope, std::size_t column) const;
  Columns columns_at(const std::vector<VertexId>& lines) const;
  Columns invalid_among(const Columns* some) const;
  std::vector<HalfedgeId> warped_sides(const Envelope& envelope, const Columns* some) const;
  std::array<VertexId, 4> vertices_at(HalfedgeId side) const;
  int prisms_beside(const std::array<VertexId, 4>& around) const;
  int first_layer_at(HalfedgeId side) const;
  double unwarped_share(const Envelope& envelope, HalfedgeId side) const;
  double valid_share(const Envelope& envelope, std::size_t column) const;
  void choose_layers(const Envelope& envelope);
  Columns with_more_layers(const Columns& hopeless);
  bool is_truncating() const { return truncation_ != Truncation::never || !base_.truncation.empty(); }
  int layers(VertexId v) const { return layers_.layers_of_line(v.value()); }
  Columns reduce_curving(const Envelope& envelope, const Columns& bad);
  void lower_heights(const Columns& columns, Envelope& envelope) const;

  const LayerBase& base_;
  EnvelopeOptions envelope_options_;
  EnvelopeScale scale_;
  RunContext context_;
  Curving curving_;
  Truncation truncation_;                    ///< setting for walls without their own setting
  std::optional<LayerNumbers> numbers_;      ///< result of the last choose_layers()
  std::vector<std::uint16_t> least_layers_;  ///< smallest number of layers of each growth line, where truncation made a column invalid
  LayerBlock layers_;                        ///< all growth lines, including collapsed ones, have room for the nodes of all layers requested there
  std::vector<Point> points_;
  /// Parameters with which a growth line was placed.
  struct Placed {
    Vec3 direction;
    double height = -1.0, c_t = 0.0;
    int n_layers = 0;
    friend bool operator==(const Placed&, const Placed&) = default;
  };
  Column<VertexId, Placed> placed_;
  bool is_first_ = true;
};

/// Extrudes the layer with one call of an Extruder.
Extrusion extrude_prisms(const LayerBase& base, const EnvelopeOptions& envelope_options, const PrismOptions& options, Envelope& envelope,
                         const RunContext& context);

}  // namespace sterna::volmesh
