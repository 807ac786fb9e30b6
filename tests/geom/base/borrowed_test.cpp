#include "geom/base/borrowed.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/boolean/strip_mesh.h"

namespace sterna {
namespace {

using Words = std::vector<std::string>;

static_assert(std::is_convertible_v<Words&, Borrowed<const Words>>);
static_assert(std::is_convertible_v<const Words&, Borrowed<const Words>>);
static_assert(std::is_convertible_v<Words&, Borrowed<Words>>);
// A temporary would end before the object that refers to it, and a constant object cannot be changed.
static_assert(!std::is_convertible_v<Words, Borrowed<const Words>>);
static_assert(!std::is_convertible_v<const Words, Borrowed<const Words>>);
static_assert(!std::is_convertible_v<Words, Borrowed<Words>>);
static_assert(!std::is_convertible_v<const Words&, Borrowed<Words>>);

template <class Tree>
constexpr bool k_is_reference = std::is_constructible_v<StripMesh, Column<VertexId, Vec3>, Column<TriangleId, StripTriangle>, StripLimits, Tree>;
static_assert(k_is_reference<TriangleTree&>);
static_assert(!k_is_reference<TriangleTree>);

TEST(Borrowed, RefersToTheObjectOfTheCaller) {
  Words words = {"wing"};
  const Borrowed<Words> borrowed = words;
  borrowed->push_back("fin");
  const Words& same = borrowed;
  EXPECT_EQ(&same, &words);
  EXPECT_EQ(&borrowed.get(), &words);
  EXPECT_EQ(words.size(), 2u);
}

}  // namespace
}  // namespace sterna
