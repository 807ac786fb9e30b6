// Functions for four layers, or four tets, at a time against functions for one cell and one face at a time.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "geom/mesh/cell_lanes.h"
#include "geom/mesh/check_parts.h"
#include "geom/mesh/column_shapes.h"
#include "tests/support/hybrid_shapes.h"

namespace sterna::check_parts {
namespace {

constexpr double k_angle_rounding = 1e-15;  // two roundings of angles up to pi

/// Returns the layers of a sphere with randomly displaced growth lines, so that no side is plane.
HybridMesh shaken_shell(int n_layers) {
  HybridMesh mesh = test::sphere_shell(3, {.n_layers = n_layers, .layer_height = 0.1});
  std::uint32_t state = 1;
  const auto noise = [&] { return 0.004 * (static_cast<double>((state = state * 1664525u + 1013904223u) >> 8) * 0x1p-24 - 0.5) / n_layers; };
  for (Point& p : mesh.points) p += Vec3{noise(), noise(), noise()};
  return mesh;
}

std::vector<CellCentre> locations_of(const HybridMesh& mesh, std::size_t column) {
  std::vector<CellCentre> locations(static_cast<std::size_t>(mesh.layers.n_layers) + lanes::k_width);
  ColumnShapes shapes(mesh);
  shapes.read(column);
  shapes.locations(locations.data());
  return locations;
}

void expect_same(const InnerFace& a, const InnerFace& b) {
  EXPECT_NEAR(a.non_orthogonality, b.non_orthogonality, k_angle_rounding);
  EXPECT_EQ(a.skewness, b.skewness);
  EXPECT_EQ(a.weight, b.weight);
  EXPECT_EQ(a.volume_ratio, b.volume_ratio);
  EXPECT_EQ(a.flatness, b.flatness);
  EXPECT_EQ(a.tets, b.tets);
}

TEST(ColumnShapes, AreThoseOfEachCell) {
  for (const int n_layers : {1, 3, 4, 5, 9}) {
    const HybridMesh mesh = shaken_shell(n_layers);
    ColumnShapes shapes(mesh);
    for (std::size_t column = 0; column < mesh.layers.n_columns(); ++column) {
      shapes.read(column);
      const std::span<const CellShape> cells = shapes.cells();
      const std::vector<CellCentre> locations = locations_of(mesh, column);
      ASSERT_EQ(cells.size(), static_cast<std::size_t>(n_layers));
      for (int j = 0; j < n_layers; ++j) {
        const CellShape expected = cell_shape(mesh, mesh.layers.cell(column, j)), &cell = cells[static_cast<std::size_t>(j)];
        EXPECT_EQ(cell.centre, expected.centre);
        EXPECT_EQ(cell.volume, expected.volume);
        EXPECT_EQ(cell.aspect_ratio, expected.aspect_ratio);
        EXPECT_EQ(cell.openness, expected.openness);
        EXPECT_EQ(cell.determinant, expected.determinant);
        EXPECT_EQ(locations[static_cast<std::size_t>(j)].centre, expected.centre);
        EXPECT_EQ(locations[static_cast<std::size_t>(j)].volume, expected.volume);
      }
    }
  }
}

TEST(ColumnShapes, FacesAreThoseOfEachFace) {
  const int n_layers = 6;
  const HybridMesh mesh = shaken_shell(n_layers);
  const LayerBlock& layers = mesh.layers;
  const RunContext context({.threads = 1});
  std::vector<std::uint32_t> neighbours;
  find_open_sides(layers, context, &neighbours);
  ColumnShapes shapes(mesh);
  for (std::size_t column = 0; column < layers.n_columns(); ++column) {
    const std::vector<CellCentre> own = locations_of(mesh, column);
    const auto& base = layers.base[column];
    const auto point = [&](std::size_t k, std::size_t j) { return mesh.points[layers.node(base[k % 3], static_cast<int>(j))]; };
    shapes.read(column);
    const std::span<const InnerFace> tops = shapes.tops(own.data());
    ASSERT_EQ(tops.size(), 5u);
    for (std::size_t j = 0; j < tops.size(); ++j)
      expect_same(tops[j], inner_face(std::array<Point, 3>{point(0, j + 1), point(1, j + 1), point(2, j + 1)}, own[j], own[j + 1]));
    for (std::size_t k = 0; k < 3; ++k) {
      const std::vector<CellCentre> other = locations_of(mesh, neighbours[3 * column + k]);
      const std::span<const InnerFace> sides = shapes.side(k, own.data(), other.data());
      ASSERT_EQ(sides.size(), 6u);
      for (std::size_t j = 0; j < sides.size(); ++j)
        expect_same(sides[j], inner_face(std::array<Point, 4>{point(k, j), point(k + 1, j), point(k + 1, j + 1), point(k, j + 1)}, own[j], other[j]));
    }
  }
}

TEST(ColumnShapes, FoldedPrismsAreMeasuredAlike) {
  HybridMesh mesh = shaken_shell(5);
  mesh.points[mesh.layers.node(7, 3)] = mesh.points[mesh.layers.node(7, 0)] * 0.9;  // inverted tets
  const RunContext context({.threads = 1});
  std::vector<std::uint32_t> neighbours;
  find_open_sides(mesh.layers, context, &neighbours);
  ColumnShapes shapes(mesh);
  double worst = 1.0;
  for (std::size_t column = 0; column < mesh.layers.n_columns(); ++column) {
    const std::vector<CellCentre> own = locations_of(mesh, column);
    shapes.read(column);
    const auto& base = mesh.layers.base[column];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::vector<CellCentre> other = locations_of(mesh, neighbours[3 * column + k]);
      const std::span<const InnerFace> sides = shapes.side(k, own.data(), other.data());
      for (int j = 0; j < 5; ++j) {
        const auto point = [&](std::size_t c, int level) { return mesh.points[mesh.layers.node(base[c % 3], level)]; };
        const auto i = static_cast<std::size_t>(j);
        expect_same(sides[i], inner_face(std::array<Point, 4>{point(k, j), point(k + 1, j), point(k + 1, j + 1), point(k, j + 1)}, own[i], other[i]));
        worst = std::min(worst, sides[i].tets);
      }
    }
  }
  EXPECT_LT(worst, 0.0);
}

TEST(Lanes, ArcCosineIsExactToTwoRoundings) {
  std::vector<double> values = {-1.0, 1.0, 0.0, -0.0, 0.5, -0.5, std::nextafter(0.5, 0.0), std::nextafter(-0.5, 0.0), 1.0 - 0x1p-53, -1.0 + 0x1p-53, 1e-300};
  for (int i = -1000; i <= 1000; ++i) values.push_back(std::sin(i * 0.00157));
  while (values.size() % lanes::k_width != 0) values.push_back(0.0);
  for (std::size_t i = 0; i < values.size(); i += lanes::k_width) {
    const lanes::Packed angles = lanes::arc_cosine(lanes::load(values, i));
    for (std::size_t k = 0; k < lanes::k_width; ++k) {
      const double exact = std::acos(values[i + k]);
      EXPECT_NEAR(angles[k], exact, 3e-16 * std::max(exact, 1e-8)) << values[i + k];
    }
  }
}

}  // namespace
}  // namespace sterna::check_parts
