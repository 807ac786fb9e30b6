// Random damage: the result is either a surface that fulfils the contract or an Error with a location.
#include <gtest/gtest.h>

#include <map>
#include <random>

#include "tests/surfmesh/soups.h"

namespace sterna::test {
namespace {

/// Stitches and returns the verdict; checks the contract in either case.
std::string verdict_of(const std::vector<SurfaceSoup>& soups, const surfmesh::StitchOptions& options = {}) {
  try {
    const auto result = stitch(soups, options, 1);
    expect_stitched(result.mesh);
    return "valid";
  } catch (const Error& error) {
    EXPECT_NE(error.code(), ErrorCode::internal) << error.what();
    if (error.code() != ErrorCode::empty_surface) {
      EXPECT_FALSE(error.info().locations.empty()) << error.what();
      EXPECT_FALSE(error.info().geometry.empty()) << error.what();
      EXPECT_GE(error.n_locations(), static_cast<std::int64_t>(error.info().locations.size()));
    }
    return std::string(to_string(error.code()));
  }
}

TEST(StitchRandom, FacetsOnALatticeOfFewPoints) {
  // Nearly every configuration is degenerate: repeated vertices, copies, collinear and coplanar facets, edges with many facets.
  std::map<std::string, int> verdicts;
  for (unsigned seed = 0; seed < 3000; ++seed) {
    std::mt19937 random(seed);
    SurfaceSoup soup;
    soup.patch_names = {""};
    soup.source = "lattice.stl";
    const auto coordinate = [&] { return static_cast<double>(random() % 3); };
    const int n = 1 + static_cast<int>(random() % 12);
    for (int i = 0; i < n; ++i) {
      std::array<Vec3, 3> c;
      for (Vec3& p : c) p = {coordinate(), coordinate(), coordinate()};
      add_facet(soup, c[0], c[1], c[2]);
    }
    ++verdicts[verdict_of({soup})];
    ++verdicts[verdict_of({soup, soup}, {.allow_open = false})];
  }
  EXPECT_GT(verdicts["open_surface"], 0);
  EXPECT_GT(verdicts["non_manifold_surface"], 0);
  EXPECT_GT(verdicts["empty_surface"], 0);
}

/// Splits edges of the soup at their middles by flat facets, in one of the two facets at the edge or in both.
SurfaceSoup with_flat_facets(const TriMesh& mesh, std::mt19937& random, int n) {
  std::vector<std::array<Vec3, 3>> facets;
  for (const TriangleId t : mesh.triangles.ids()) facets.push_back(corners(mesh, t));
  for (int i = 0; i < n; ++i) {
    const std::size_t t = random() % facets.size();
    const std::size_t k = random() % 3;
    const Vec3 p = facets[t][k], q = facets[t][(k + 1) % 3], apex = facets[t][(k + 2) % 3];
    const Vec3 r = 0.5 * (p + q);  // exact: coordinates are few bits
    facets[t] = {p, r, apex};
    facets.push_back({r, q, apex});
    facets.push_back({q, r, p});  // fills the gap between p-r-q and the neighbour's edge q-p
  }
  SurfaceSoup soup;
  soup.patch_names = {""};
  soup.source = "slits.stl";
  for (const auto& c : facets) add_facet(soup, c[0], c[1], c[2]);
  return soup;
}

TEST(StitchRandom, FlatFacetsCloseSlitsWithoutMovingSurface) {
  int n_valid = 0;
  for (unsigned seed = 0; seed < 400; ++seed) {
    std::mt19937 random(seed);
    const TriMesh mesh = cube(2);
    const SurfaceSoup soup = with_flat_facets(mesh, random, 1 + static_cast<int>(random() % 12));
    SCOPED_TRACE(seed);
    try {
      const TriMesh result = stitch({soup}, {}, 1).mesh;
      expect_stitched(result);
      EXPECT_NEAR(volume(result), 1.0, 1e-14);
      EXPECT_NEAR(area(result), 6.0, 1e-13);
      EXPECT_LE(result.n_triangles(), soup.triangles.size());  // flat facets on both sides of an edge are copies of each other and are removed
      ++n_valid;
    } catch (const Error& error) {
      // A flat facet in a flat facet can fold: two of its facets are then copies, or a vertex is visited twice, which has a verdict of its own.
      EXPECT_TRUE(error.code() == ErrorCode::non_manifold_surface || error.code() == ErrorCode::self_intersection) << error.what();
    }
  }
  RecordProperty("valid", n_valid);
  EXPECT_GT(n_valid, 200);
}

TEST(StitchRandom, DamagedSpheres) {
  const SurfaceSoup whole = soup_of(sphere(3));
  std::map<std::string, int> verdicts;
  for (unsigned seed = 0; seed < 400; ++seed) {
    std::mt19937 random(seed);
    SurfaceSoup soup = whole;
    const int n = 1 + static_cast<int>(random() % 3);
    for (int i = 0; i < n; ++i) {
      const std::size_t t = random() % soup.triangles.size();
      switch (random() % 5) {
        case 0: std::swap(soup.triangles[t][0], soup.triangles[t][1]); break;
        case 1: soup.triangles.push_back(soup.triangles[t]), soup.patch.push_back(0); break;
        case 2: soup.triangles.erase(soup.triangles.begin() + static_cast<std::ptrdiff_t>(t)), soup.patch.pop_back(); break;
        case 3: soup.points[soup.triangles[t][0]] = soup.points[random() % soup.points.size()]; break;
        default: {
          const Vec3 p = soup.points[soup.triangles[t][0]];
          for (Vec3& q : soup.points)
            if (q == p) q = {-0.5 * p.x, -0.5 * p.y, 0.1 * p.z};
        }
      }
    }
    ++verdicts[verdict_of({soup})];
  }
  EXPECT_GT(verdicts["valid"], 0);
  EXPECT_GT(verdicts["open_surface"], 0);
  EXPECT_GT(verdicts["self_intersection"], 0);
}

}  // namespace
}  // namespace sterna::test
