#include "volmesh/envelope/sheet_heights.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "geom/math/constants.h"
#include "volmesh/case/growth_law.h"
#include "volmesh/envelope/envelope.h"
#include "volmesh/envelope/initial.h"

namespace sterna::volmesh {
namespace {

constexpr double k_tallest_first = 0.8;          ///< largest height of first cells in a sheet's last rows, as a fraction of the height of a regular tetrahedron
constexpr double k_sheet_rounding = 1.0 + 1e-9;  ///< tolerance for comparisons of growth ratios

/// Returns a demand with the values of the options at every vertex.
LayerDemand demand_everywhere(const LayerBase& base, const EnvelopeOptions& options) {
  const std::size_t n = base.wall.n_vertices();
  LayerDemand demand;
  demand.first_height.assign(n, options.first_height);
  demand.max_growth.assign(n, options.max_growth);
  demand.max_thickness.assign(n, thickness_limit(options.max_thickness, options.total_height, base.body_length));
  demand.layers.assign(n, static_cast<std::uint16_t>(options.layers));
  return demand;
}

/// Layer targets for both sides of a sheet at one base vertex.
struct SheetLine {
  double first_height = 0.0, height = 0.0, growth = 1.0;  ///< m: first height and total height; growth of the layer upstream of the edge
  int layers = 0;
};

class SheetGrower {
 public:
  SheetGrower(const DoubledSheets& sheets, const EnvelopeOptions& options, LayerBase& base) : sheets_(sheets), base_(base), scale_(base, options) {}

  void grow() {
    for (const DoubledSheets::BaseVertex& base_vertex : sheets_.base_vertices) lines_.push_back(line_of(base_vertex));
    share_with_images();
    LayerDemand demand = base_.demand;
    if (demand.total_height.empty()) {
      demand.total_height.assign(base_.wall.n_vertices(), k_automatic);
      for (const VertexId v : base_.wall.points.ids()) demand.total_height[v] = scale_.total_height(v);
    }
    level(demand.layers);
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      if (sheets_.base_vertices[i].row == 0) continue;
      for (const VertexId v : sheets_.base_vertices[i].sides) {
        demand.first_height[v] = std::min(lines_[i].first_height, lines_[i].height / demand.layers[v]);
        demand.total_height[v] = lines_[i].height;
      }
    }
    base_.demand = std::move(demand);
  }

 private:
  SheetLine line_of(const DoubledSheets::BaseVertex& base_vertex) const {
    SheetLine line;
    line.layers = scale_.n(base_vertex.sides[0]);
    if (base_vertex.row == 0) return line;
    const int all = scale_.n(base_vertex.start[0]);
    const double before = std::min(scale_.h0(base_vertex.start[0]), scale_.h0(base_vertex.start[1]));
    double edge = 0.0;
    for (std::size_t k = 0; k < 2; ++k) {
      const VertexId v = base_vertex.sides[k];
      const double requested = scale_.total_height(v);
      const double by_edge = height_by_edge(before, base_.layer_edge[v], scale_.max_growth(v), all, scale_.has_common_growth());
      const double height = std::min(is_automatic(requested) ? by_edge : requested, scale_.max_thickness(v));
      line.height = k == 0 ? height : std::min(line.height, height);
      edge = k == 0 ? base_.layer_edge[v] : std::min(edge, base_.layer_edge[v]);
    }
    line.growth = growth_for_height(before, line.height, all);
    for (const VertexId v : base_vertex.sides)
      for_each_edge(base_.topology, v, [&](HalfedgeId, VertexId w) {
        if (base_.is_sheet_border(w)) line.height = std::min(line.height, k_border_slope * distance(base_.wall.points[v], base_.wall.points[w]));
      });
    const double tallest = std::max(before, std::min(line.height, k_tallest_first * k_regular_height * edge));
    line.first_height = std::min(tallest, before * std::pow(std::min(base_vertex.height_growth, line.growth), base_vertex.row));
    line.layers = layers_for(line, all);
    return line;
  }

  /// Gives base vertices on periodic sides bit-exactly the targets of their images.
  void share_with_images() {
    constexpr std::size_t k_none = static_cast<std::size_t>(-1);
    Column<VertexId, std::size_t> line_at(base_.wall.n_vertices(), k_none);
    for (std::size_t i = 0; i < lines_.size(); ++i) line_at[sheets_.base_vertices[i].sides[0]] = i;
    for (const std::vector<VertexId>& group : base_.groups) {
      std::vector<std::size_t> members;
      for (const VertexId v : group)
        if (line_at[v] != k_none) members.push_back(line_at[v]);
      if (members.empty()) continue;
      SheetLine shared = lines_[members.front()];
      for (const std::size_t i : members) {
        shared.first_height = std::min(shared.first_height, lines_[i].first_height);
        shared.height = std::min(shared.height, lines_[i].height);
        shared.growth = std::min(shared.growth, lines_[i].growth);
        shared.layers = std::max(shared.layers, lines_[i].layers);
      }
      for (const std::size_t i : members) lines_[i] = shared;
    }
  }

  /// Returns the smallest number of layers whose growth does not exceed the growth upstream of the edge.
  static int layers_for(const SheetLine& line, int all) {
    for (int n = 1; n < all; ++n)
      if (n == 1 ? line.height <= line.first_height * k_sheet_rounding : growth_for_height(line.first_height, line.height, n) <= line.growth * k_sheet_rounding)
        return n;
    return all;
  }

  /// Raises numbers of layers to one less than those of neighbours. Vertices on free edges count as if they had the largest number of their neighbours.
  void level(Column<VertexId, std::uint16_t>& layers) const {
    std::vector<VertexId> changed;
    for (std::size_t i = 0; i < lines_.size(); ++i)
      for (const VertexId v : sheets_.base_vertices[i].sides) {
        layers[v] = static_cast<std::uint16_t>(lines_[i].layers);
        changed.push_back(v);
      }
    Column<VertexId, VertexId> partner(base_.wall.n_vertices());
    for (const DoubledSheets::BaseVertex& base_vertex : sheets_.base_vertices)
      for (std::size_t k = 0; k < 2; ++k) partner[base_vertex.sides[k]] = base_vertex.sides[1 - k];
    while (!changed.empty()) {
      std::vector<VertexId> next;
      const auto raise = [&](VertexId v, int least) {
        if (!v.is_valid() || layers[v] >= least) return;
        layers[v] = static_cast<std::uint16_t>(least);
        next.push_back(v);
      };
      for (const VertexId v : changed) {
        raise(partner[v], layers[v]);
        for_each_edge(base_.topology, v, [&](HalfedgeId, VertexId w) {
          if (partner[w].is_valid()) raise(w, layers[v] - 1);
        });
      }
      changed.swap(next);
    }
    for (const VertexId border : sheets_.borders) {
      if (border.index() < sheets_.n_given_vertices) continue;
      layers[border] = 1;
      for_each_edge(base_.topology, border, [&](HalfedgeId, VertexId w) {
        if (partner[w].is_valid()) layers[border] = std::max(layers[border], layers[w]);
      });
    }
  }

  const DoubledSheets& sheets_;
  LayerBase& base_;
  EnvelopeScale scale_;
  std::vector<SheetLine> lines_;  ///< targets of each base vertex
};

}  // namespace

void grow_sheet_heights(const DoubledSheets& sheets, const EnvelopeOptions& options, LayerBase& base) {
  if (std::ranges::none_of(sheets.base_vertices, [](const DoubledSheets::BaseVertex& base_vertex) { return base_vertex.height_growth > 1.0; })) return;
  if (base.demand.is_empty()) base.demand = demand_everywhere(base, options);
  SheetGrower(sheets, options, base).grow();
}

}  // namespace sterna::volmesh
