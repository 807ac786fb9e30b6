#include "volmesh/tetra/verify.h"

#include <gmock/gmock.h>

#include "tests/support/test_shapes.h"
#include "tests/volmesh/tetra/cases.h"

namespace sterna::volmesh {
namespace {

using test::Domain;
using test::error_info_of;
using testing::HasSubstr;

/// Each damage to a good mesh must be detected, for any number of threads.
class VerifyTetrahedra : public testing::Test {
 protected:
  VerifyTetrahedra() : domain(test::domain_around(test::cube(3), 10.0)), good(fill(domain.boundary(), nullptr, {}, RunContext{})), result(good) {}
  ErrorInfo verify() const {
    const ErrorInfo first = error_info_of([&] { verify_tetrahedra(domain.boundary(), result, RunContext({.threads = 1})); });
    const ErrorInfo again = error_info_of([&] { verify_tetrahedra(domain.boundary(), result, RunContext({.threads = 7})); });
    EXPECT_EQ(first.problem, again.problem);
    EXPECT_EQ(first.locations.size(), again.locations.size());
    for (std::size_t i = 0; i < first.locations.size(); ++i) EXPECT_EQ(first.locations[i].what, again.locations[i].what);
    return first;
  }
  Domain domain;
  TetraResult good, result;
};

TEST_F(VerifyTetrahedra, PassesAGoodMesh) { EXPECT_NO_THROW(verify_tetrahedra(domain.boundary(), result, RunContext{})); }

TEST_F(VerifyTetrahedra, NoTetrahedra) {
  result.tetrahedra.clear();
  EXPECT_EQ(verify().code, ErrorCode::tetra_result_invalid);
}

TEST_F(VerifyTetrahedra, AMissingTetrahedron) {
  for (const std::size_t i : {std::size_t{0}, good.tetrahedra.size() / 2, good.tetrahedra.size() - 1}) {
    result = good;
    result.tetrahedra.erase(result.tetrahedra.begin() + static_cast<std::ptrdiff_t>(i));
    const ErrorInfo error = verify();
    EXPECT_EQ(error.code, ErrorCode::tetra_result_invalid);
    EXPECT_EQ(error.n_locations, 4);
    EXPECT_EQ(error.locations.size(), 4u);
  }
}

TEST_F(VerifyTetrahedra, ADoubledTetrahedron) {
  result.tetrahedra.push_back(result.tetrahedra[17]);
  const ErrorInfo error = verify();
  EXPECT_THAT(error.problem, HasSubstr("4 faces of more than two cells"));
}

TEST_F(VerifyTetrahedra, AnInvertedTetrahedron) {
  std::swap(result.tetrahedra[17][0], result.tetrahedra[17][1]);
  const ErrorInfo error = verify();
  EXPECT_THAT(error.problem, HasSubstr("1 tetrahedra without positive volume"));
  ASSERT_EQ(error.locations.size(), 1u);
  EXPECT_THAT(error.locations[0].what, HasSubstr("tetrahedron 17"));
}

TEST_F(VerifyTetrahedra, BadIndices) {
  result.tetrahedra[3][2] = 1u << 30;
  EXPECT_THAT(verify().problem, HasSubstr("out of range"));
  result = good;
  result.tetrahedra[3][2] = result.tetrahedra[3][1];
  EXPECT_THAT(verify().problem, HasSubstr("repeated"));
}

TEST_F(VerifyTetrahedra, PointsThatNobodyUsesOrNan) {
  result.new_points.push_back({5, 5, 5});
  EXPECT_THAT(verify().problem, HasSubstr("not used"));
  result.new_points.back().x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(verify().problem, HasSubstr("not finite"));
}

TEST_F(VerifyTetrahedra, ABoundaryThatIsNotThere) {
  // The diagonal of one quad of the cube is flipped: same points, other faces.
  const TriMesh other = [] {
    TriMesh cube = test::cube(3);
    auto& a = cube.triangles[TriangleId(0)];
    auto& b = cube.triangles[TriangleId(1)];  // (a, b, c) and (a, c, d), or their mirror images
    const TriangleVertices first = a, second = b;
    if (first[2] == second[1]) {
      a = {first[0], first[1], second[2]};
      b = {first[1], first[2], second[2]};
    } else {
      a = {first[0], second[1], first[2]};
      b = {first[1], second[1], first[2]};
      a = {first[0], second[1], first[2]};
      b = {second[1], first[1], first[2]};
    }
    return cube;
  }();
  Domain changed;
  changed.add(other);
  changed.triangles.insert(changed.triangles.end(), domain.triangles.begin() + static_cast<std::ptrdiff_t>(other.n_triangles()), domain.triangles.end());
  changed.points = domain.points;
  const ErrorInfo error = error_info_of([&] { verify_tetrahedra(changed.boundary(), good, RunContext{}); });
  EXPECT_EQ(error.code, ErrorCode::tetra_result_invalid);
  EXPECT_THAT(error.problem, HasSubstr("2 boundary triangles that are not a face"));
  EXPECT_THAT(error.problem, HasSubstr("2 outer faces that are not a boundary triangle"));
}

TEST_F(VerifyTetrahedra, ABoundaryInsideOut) {
  for (auto& t : domain.triangles) std::swap(t[0], t[1]);
  EXPECT_THAT(verify().problem, HasSubstr("same side"));
}

}  // namespace
}  // namespace sterna::volmesh
