// Stored values: each member, also of nested structs, has an effect on the key and on the stored bytes, and the bytes read back equal.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <type_traits>

#include "geom/base/error.h"
#include "scripting/cache/content_key.h"
#include "scripting/lua/component_value.h"
#include "scripting/values/kept_reference.h"
#include "scripting/values/mesh_parts.h"
#include "scripting/values/stored_types.h"
#include "surfmesh/remesh/remesh_surface.h"

namespace sterna::scripting {
namespace {

class BytesOut final : public ByteSink {
 public:
  void put(const void* data, std::size_t n) override { bytes.append(static_cast<const char*>(data), n); }
  std::string bytes;
};

class BytesIn final : public ByteSource {
 public:
  explicit BytesIn(const std::string& bytes) : bytes_(bytes) {}
  void take(void* data, std::size_t n) override {
    if (n > n_left()) refuse();
    if (n > 0) std::memcpy(data, bytes_.data() + at_, n);
    at_ += n;
  }
  std::uint64_t n_left() const override { return bytes_.size() - at_; }
  [[noreturn]] void refuse() const override { throw Error({.code = ErrorCode::internal, .attempted = "reading a value", .problem = "it is malformed"}); }

 private:
  const std::string& bytes_;
  std::size_t at_ = 0;
};

template <class T>
std::string stored_bytes(const T& value) {
  BytesOut sink;
  write_value(sink, value);
  return sink.bytes;
}

/// Visits a value and all values in it. First it gives every container one element and every optional a value; later visits change one of the leaves: a number,
/// a string, the length of a container, the presence of an optional.
class LeafChanger {
 public:
  static constexpr std::size_t k_fill = static_cast<std::size_t>(-1);

  explicit LeafChanger(std::size_t leaf) : leaf_(leaf) {}
  std::size_t n_leaves() const { return n_; }

  template <class T>
  void visit(T& value) {
    if constexpr (std::is_same_v<T, bool>) {
      if (is_next()) value = !value;
    } else if constexpr (std::is_enum_v<T>) {
      if (is_next()) value = static_cast<T>(static_cast<std::underlying_type_t<T>>(value) + 1);
    } else if constexpr (std::is_floating_point_v<T>) {
      if (is_next()) value = std::isfinite(value) ? std::nextafter(value, std::numeric_limits<T>::infinity()) : T(0.5);
    } else if constexpr (std::is_integral_v<T>) {
      if (is_next()) value = static_cast<T>(value + 1);
    } else if constexpr (IsId<T>::value) {
      if (is_next()) value = T(std::uint64_t{7});
    } else {
      visit_object(value);
    }
  }

 private:
  bool is_filling() const { return leaf_ == k_fill; }
  bool is_next() { return n_++ == leaf_; }

  void visit_object(std::string& value) {
    if (is_next()) value += "x";
  }
  void visit_object(Measured&) {}  // no part of the value
  void visit_object(std::monostate&) {}
  template <class T>
  void visit_object(std::vector<T>& value) {
    if (is_filling()) value.resize(1);
    if (is_next()) value.resize(value.size() + 1);
    for (T& item : value) visit(item);
  }
  template <class I, class T>
  void visit_object(Column<I, T>& value) {
    visit(value.raw());
  }
  template <class Key, class T, class Less>
  void visit_object(std::map<Key, T, Less>& value) {
    if (is_filling()) value[Key{}];
    if (is_next()) return value.clear();
    for (auto& [key, item] : value) visit(item);
  }
  template <class T, std::size_t N>
  void visit_object(std::array<T, N>& value) {
    for (T& item : value) visit(item);
  }
  template <class A, class B>
  void visit_object(std::pair<A, B>& value) {
    visit(value.first);
    visit(value.second);
  }
  template <class T>
  void visit_object(std::optional<T>& value) {
    if (is_filling()) value.emplace();
    if (is_next()) return value.reset();
    if (value) visit(*value);
  }
  template <class T>
  void visit_object(std::shared_ptr<const T>& value) {
    auto copy = value ? std::make_shared<T>(*value) : std::make_shared<T>();
    if (is_next()) return value.reset();
    visit(*copy);
    value = std::move(copy);
  }
  template <class... T>
  void visit_object(std::variant<T...>& value) {
    if (is_filling()) value.template emplace<sizeof...(T) - 1>();
    if (is_next()) value.template emplace<0>();
    std::visit([&](auto& held) { visit(held); }, value);
  }
  void visit_object(TrueSurface& value) { visit(value.key); }  // its wall is a view of a model
  void visit_object(volmesh::Envelope& value) {
    for_each_column([&](auto& column) { visit(column); }, value);
  }
  void visit_object(volmesh::VolumeMeshResult& value) {
    visit(static_cast<volmesh::VolumeMeshReport&>(value));
    visit(value.mesh);
    visit(value.check);
  }
  template <class T>
  void visit_object(T& value) {
    with_members<k_members<T>>(value, [&](auto&... members) { (visit(members), ...); });
  }

  std::size_t leaf_, n_ = 0;
};

template <class T>
class StoredValue : public testing::Test {};
using StoredTypes = testing::Types<SurfaceValue, SurfaceRecipe, surfmesh::SurfaceMesh, surfmesh::RemeshResult, volmesh::EnvelopeStage, volmesh::FilledStage,
                                   volmesh::VolumeMeshResult, volmesh::PartEnvelope, KeptPart, KeptEnvelope, ComponentValue>;
TYPED_TEST_SUITE(StoredValue, StoredTypes);

TYPED_TEST(StoredValue, EachLeafIsInKeyAndBytesAndReadsBack) {
  TypeParam full;
  LeafChanger filler(LeafChanger::k_fill);
  filler.visit(full);
  ASSERT_GT(filler.n_leaves(), 0u);
  std::set<ContentKey> keys = {KeyMaker("value").add(full).key()};
  for (std::size_t leaf = 0; leaf < filler.n_leaves(); ++leaf) {
    TypeParam changed = full;
    LeafChanger(leaf).visit(changed);
    EXPECT_TRUE(keys.insert(KeyMaker("value").add(changed).key()).second) << "leaf " << leaf << " has no effect on the key";
    const std::string bytes = stored_bytes(changed);
    BytesIn source(bytes);
    TypeParam read;
    read_value(source, read);
    EXPECT_EQ(source.n_left(), 0u) << "leaf " << leaf;
    EXPECT_EQ(stored_bytes(read), bytes) << "leaf " << leaf << " is not read back";
  }
}

TEST(StoredValues, MeasurementsAreNotStored) {
  volmesh::VolumeMeshResult result;
  const std::string bytes = stored_bytes(result);
  result.tetra_engine_seconds = 3.0;
  EXPECT_EQ(stored_bytes(result), bytes);
}

TEST(StoredValues, VariantOfUnknownKindIsRefused) {
  SurfaceStep step;
  std::string bytes = stored_bytes(step);
  bytes.front() = 17;  // the index of the variant comes first
  BytesIn source(bytes);
  EXPECT_THROW(read_value(source, step), Error);
}

}  // namespace
}  // namespace sterna::scripting
