// Exact geometry as bytes: a model's columns, and the curves and surfaces to which they refer. Shared objects are shared again after reading, and geometry that
// is read back evaluates to the same bits.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "geom/model/model.h"
#include "scripting/cache/archive.h"

namespace sterna::scripting {

/// Thrown for a curve or surface that cannot be serialised: a deformed one, or a wrapper around a curve or surface of OpenCASCADE.
struct NotKept {
  std::string kind;
};

/// Passes bytes on, and numbers the objects that models share. Values with models are written to such a sink only. CAD shapes of models are not written, only a
/// flag that they exist.
class ModelSink final : public ByteSink {
 public:
  explicit ModelSink(ByteSink& to) : to_(to) {}
  void put(const void* bytes, std::size_t n) override { to_.put(bytes, n); }
  /// Returns the numbers of the objects of a class that are completely written.
  template <class T>
  std::map<const T*, std::uint64_t>& numbers() {
    return std::get<std::map<const T*, std::uint64_t>>(numbers_);
  }

 private:
  template <class... T>
  using Numbers = std::tuple<std::map<const T*, std::uint64_t>...>;

  ByteSink& to_;
  Numbers<Curve, ParameterCurve, Surface, Model> numbers_;
};

/// Source of the data of a ModelSink.
class ModelSource final : public ByteSource {
 public:
  using ShapeOf = std::function<std::shared_ptr<const CadShape>(std::size_t)>;

  /// \p shape_of_next returns the shape of the n-th model (from 0, in the order of writing) that had one
  ModelSource(ByteSource& from, ShapeOf shape_of_next) : from_(from), shape_of_next_(std::move(shape_of_next)) {}
  void take(void* bytes, std::size_t n) override { from_.take(bytes, n); }
  std::uint64_t n_left() const override { return from_.n_left(); }
  [[noreturn]] void refuse() const override { from_.refuse(); }
  /// Returns the objects of a class that are completely read.
  template <class T>
  std::vector<std::shared_ptr<const T>>& objects() {
    return std::get<std::vector<std::shared_ptr<const T>>>(objects_);
  }
  /// Returns the shape of the next model.
  std::shared_ptr<const CadShape> next_shape(bool has_shape);

 private:
  template <class... T>
  using Objects = std::tuple<std::vector<std::shared_ptr<const T>>...>;

  ByteSource& from_;
  ShapeOf shape_of_next_;
  Objects<Curve, ParameterCurve, Surface, Model> objects_;
  std::size_t n_models_ = 0;
};

namespace detail {

/// An object that several owners may share. \throws NotKept when writing
template <class T>
struct SharedArchive {
  static void write(ByteSink& sink, const std::shared_ptr<const T>& object);
  static void read(ByteSource& source, std::shared_ptr<const T>& object);
};
template <>
struct Archive<CurvePtr> : SharedArchive<Curve> {};
template <>
struct Archive<ParameterCurvePtr> : SharedArchive<ParameterCurve> {};
template <>
struct Archive<SurfacePtr> : SharedArchive<Surface> {};
template <>
struct Archive<std::shared_ptr<const Model>> : SharedArchive<Model> {};

template <>
struct Archive<std::shared_ptr<const CadShape>> {
  static void write(ByteSink& sink, const std::shared_ptr<const CadShape>& shape);
  static void read(ByteSource& source, std::shared_ptr<const CadShape>& shape);
};

}  // namespace detail
}  // namespace sterna::scripting
