// Typed 32-bit ids and columns indexed by them. A vertex id cannot be used in place of a triangle id.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <utility>
#include <vector>

namespace sterna {

/// Value of invalid ids, and of raw 32-bit indices that refer to no entity.
inline constexpr std::uint32_t k_none = std::numeric_limits<std::uint32_t>::max();

/// Throws Error(ErrorCode::overflow) naming the quantity that overflowed; defined in ids.cpp.
[[noreturn]] void throw_id_overflow(std::uint64_t value);

/// 32-bit id of one kind of entity. It is invalid by default and has no implicit conversions.
template <class Tag>
class Id {
 public:
  static constexpr std::uint32_t k_invalid = k_none;

  constexpr Id() = default;
  /// \throws Error(overflow) if `index` is k_invalid or larger
  constexpr explicit Id(std::uint64_t index) : value_(static_cast<std::uint32_t>(index)) {
    if (index >= k_invalid) throw_id_overflow(index);
  }
  /// \throws Error(overflow) if `index` is k_invalid
  constexpr explicit Id(std::uint32_t index) : Id(std::uint64_t{index}) {}
  constexpr explicit Id(int index) : Id(static_cast<std::uint64_t>(static_cast<std::int64_t>(index))) {}

  /// Returns the id of an index without a test: for arithmetic with ids in inner loops.
  /// \pre `index` is below k_invalid
  static constexpr Id untested(std::uint32_t index) {
    Id id;
    id.value_ = index;
    return id;
  }

  constexpr bool is_valid() const { return value_ != k_invalid; }
  constexpr std::uint32_t value() const { return value_; }
  constexpr std::size_t index() const { return value_; }
  friend constexpr auto operator<=>(const Id&, const Id&) = default;

 private:
  std::uint32_t value_ = k_invalid;
};

using VertexId = Id<struct VertexTag>;      ///< vertex of a TriMesh
using TriangleId = Id<struct TriangleTag>;  ///< triangle of a TriMesh
using HalfedgeId = Id<struct HalfedgeTag>;  ///< 3 * triangle + corner
using PatchId = Id<struct PatchTag>;        ///< named boundary patch
using NodeId = Id<struct NodeTag>;          ///< node of a HybridMesh

/// Range of ids [0, n) for range-based for loops.
template <class I>
class IdRange {
 public:
  explicit constexpr IdRange(std::size_t n) : n_(n) {}
  class iterator {
   public:
    explicit constexpr iterator(std::size_t i) : i_(i) {}
    constexpr I operator*() const { return I(static_cast<std::uint64_t>(i_)); }
    constexpr iterator& operator++() {
      ++i_;
      return *this;
    }
    friend constexpr bool operator==(const iterator&, const iterator&) = default;

   private:
    std::size_t i_;
  };
  constexpr iterator begin() const { return iterator(0); }
  constexpr iterator end() const { return iterator(n_); }

 private:
  std::size_t n_;
};

/// A vector that is indexed by an id type.
template <class I, class T>
class Column {
 public:
  Column() = default;
  explicit Column(std::size_t n, const T& value = T{}) : data_(n, value) {}
  explicit Column(std::vector<T> data) : data_(std::move(data)) {}
  Column(std::initializer_list<T> values) : data_(values) {}

  decltype(auto) operator[](I id) { return data_[id.index()]; }
  decltype(auto) operator[](I id) const { return data_[id.index()]; }
  std::size_t size() const { return data_.size(); }
  bool empty() const { return data_.empty(); }
  void resize(std::size_t n) { data_.resize(n); }
  void resize(std::size_t n, const T& value) { data_.resize(n, value); }
  void reserve(std::size_t n) { data_.reserve(n); }
  void assign(std::size_t n, const T& value) { data_.assign(n, value); }
  void clear() { data_.clear(); }
  I push_back(T value) {
    data_.push_back(std::move(value));
    return I(static_cast<std::uint64_t>(data_.size() - 1));
  }
  IdRange<I> ids() const { return IdRange<I>(data_.size()); }
  std::vector<T>& raw() { return data_; }
  const std::vector<T>& raw() const { return data_; }
  auto begin() { return data_.begin(); }
  auto end() { return data_.end(); }
  auto begin() const { return data_.begin(); }
  auto end() const { return data_.end(); }
  friend bool operator==(const Column&, const Column&) = default;

 private:
  std::vector<T> data_;
};

using TriangleVertices = std::array<VertexId, 3>;

}  // namespace sterna
