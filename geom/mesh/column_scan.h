// All measures from a pass over the prisms of columns, four layers at a time.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geom/base/borrowed.h"
#include "geom/mesh/lanes.h"

namespace sterna {

/// Measures of one prism as in is_wedge_valid (its filter only), wedge_volume, wedge_quality and skew_angle; the angle has an error of 2e-8.
struct PrismMeasures {
  bool is_surely_valid = false;  ///< false: call is_wedge_valid
  double volume = 0.0;           ///< m^3
  double quality = 0.0;
  double skew = 0.0;  ///< radians
};

class ColumnScan {
 public:
  explicit ColumnScan(Borrowed<const HybridMesh> mesh) : mesh_(mesh) {}
  /// Returns the measures of the prisms of a column from the wall up; valid until the next call.
  /// \pre is_prismatic(column)
  const std::vector<PrismMeasures>& measure(std::size_t column);

 private:
  const HybridMesh& mesh_;
  std::array<lanes::LineVectors, 3> lines_;
  std::vector<PrismMeasures> measures_;
};

}  // namespace sterna
