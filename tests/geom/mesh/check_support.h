// Shared functions of the tests of check().
#pragma once

#include <gtest/gtest.h>

#include "geom/mesh/check.h"
#include "tests/support/hybrid_shapes.h"

namespace sterna::test {

/// Returns the report, after checking that 1, 2 and 7 threads give the same text and JSON.
inline CheckReport checked(const HybridMesh& mesh, const CheckOptions& options = {}) {
  CheckReport report = check(mesh, options, RunContext({.threads = 1}));
  for (const int threads : {2, 7}) {
    const CheckReport other = check(mesh, options, RunContext({.threads = threads}));
    EXPECT_EQ(to_text(report), to_text(other));
    EXPECT_EQ(to_json(report), to_json(other));
  }
  return report;
}

inline void move_points(HybridMesh& mesh, double scale, const Vec3& offset) {
  for (Point& p : mesh.points) p = scale * p + offset;
}

inline double distance_to_first(const CheckReport& report, Violation violation, const Point& location) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const CheckFinding& finding : report.findings)
    if (finding.violation == violation) nearest = std::min(nearest, distance(finding.position, location));
  return nearest;
}

template <class Nodes>
Point middle_of(const HybridMesh& mesh, const Nodes& nodes) {
  Point sum;
  for (const NodeId node : nodes) sum += mesh.points[node];
  return sum / static_cast<double>(nodes.size());
}

}  // namespace sterna::test
