// Sizes required at locations of a model for reasons other than curvature and edges: leading and trailing edges of wings, tips, gaps, and user sources.
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

/// Factors of the largest edge on a wing (docs/method/surface.md, "Factors on wings"). One factor applies at its leading and trailing edges and blends to one
/// over a quarter of the perimeter of the section. Others apply in strips beside its tips.
class WingFactors {
 public:
  struct Line {
    Point a, b;
  };
  std::vector<Line> leading, trailing, tips;
  double span = 0.0;  ///< m

  double operator()(const Point& p, double leading_factor, double trailing_factor, bool has_strips) const;
};

/// Finds the wings and pylons of a model. The entries of other components are empty. Leading edges are smooth edges between an upper and a lower face; of two
/// sharp edges the leading edge is the one with the smaller x. Trailing edges are the other sharp edge and the borders of bases.
Column<ComponentId, std::shared_ptr<WingFactors>> find_wings(const Model& model, const Column<EdgeId, EdgeSamples>& edges);

class LocalSizes {
 public:
  LocalSizes() = default;
  /// \pre sizes.faces are resolved
  LocalSizes(const Model& model, const Column<EdgeId, EdgeSamples>& edges, const ModelSizes& sizes, const SpaceSizes& requested, double refinement);
  /// Adds sources that apply to this face only.
  /// \pre the face has no sources yet
  void set_sources(FaceId f, const std::vector<SizePoint>& sources, const RunContext& context);

  /// Returns the size in metres: at most the face's largest edge.
  double operator()(FaceId f, const Point& p) const;
  /// Returns true if no size on the face within `reach` is below its largest edge.
  bool is_level_within(FaceId f, const Point& p, double reach) const;
  /// Returns true if a user function is set. Only the thread that started the run may call such a function.
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
  double growth_ = 0.0;  ///< change of sizes per distance, before refinement
};

}  // namespace sterna::surfmesh
