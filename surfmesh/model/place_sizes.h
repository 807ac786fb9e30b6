// What places of a model ask for apart from curvature and edges: leading and trailing edges of wings, their tips, gaps, and the user's sources.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <vector>

#include "geom/model/model.h"
#include "surfmesh/model/background_sizes.h"
#include "surfmesh/model/edge_samples.h"

namespace sterna::surfmesh {

struct ModelSizes;
struct SpaceSizes;

/// Factors of the largest edge over a wing (docs/method/surface.md, "Factors on wings"): at its leading and trailing edges, blending to one over a quarter of
/// the way around the section; in strips beside its tips.
class WingFactors {
 public:
  struct Line {
    Point a, b;
  };
  std::vector<Line> leading, trailing, tips;
  double span = 0.0;  ///< m

  double operator()(const Point& p, double leading_factor, double trailing_factor, bool has_strips) const;
};

/// Wings and pylons of a model, by component; nothing for the others. Leading edges are edges between an upper and a lower face that are smooth or, of two
/// sharp ones, the one with the smaller x; trailing edges are the other and the borders of bases.
Column<ComponentId, std::shared_ptr<WingFactors>> find_wings(const Model& model, const Column<EdgeId, EdgeSamples>& edges);

class PlaceSizes {
 public:
  PlaceSizes() = default;
  /// \pre sizes.faces resolved
  PlaceSizes(const Model& model, const Column<EdgeId, EdgeSamples>& edges, const ModelSizes& sizes, const SpaceSizes& asked, double refinement);
  /// Adds sources that count on this face only.
  /// \pre none of it before
  void set_sources(FaceId f, const std::vector<SizeSite>& sources, const RunContext& context);

  /// Metres: at most the face's largest edge.
  double operator()(FaceId f, const Point& p) const;
  /// Nobody on the face within `reach` asks for less than its largest edge.
  bool is_level_within(FaceId f, const Point& p, double reach) const;
  /// A function of the user may be called by the thread that began alone.
  bool is_serial() const { return static_cast<bool>(function_); }

 private:
  struct OfFace {
    double max_edge = 0.0;
    double leading = 1.0, trailing = 1.0;
    bool has_strips = false;
    std::shared_ptr<const WingFactors> wing;
    std::shared_ptr<const BackgroundSizes> sources;
  };
  Column<FaceId, OfFace> faces_;
  std::function<double(const Point&, double)> regions_;
  std::function<double(const Point&)> function_;
  double refinement_ = 1.0;
  double growth_ = 0.0;  ///< of sizes by distance, before refinement
};

}  // namespace sterna::surfmesh
