// Exact geometry as bytes: a model's columns, and the curves and surfaces to which they refer. Shared objects are shared again after reading, and geometry that
// is read back evaluates to the same bits.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "geom/model/model.h"
#include "scripting/cache/archive.h"

namespace sterna::scripting {

/// Thrown for a curve or surface that cannot be serialised: a deformed one, or a wrapper around a curve or surface of OpenCASCADE.
struct NotKept {
  std::string kind;
};

/// Writes models that may share curves, surfaces and each other.
class ModelWriter {
 public:
  explicit ModelWriter(ByteSink& sink) : sink_(sink) {}
  /// Writes the model. The CAD shape of the model is not written, only a flag that it exists.
  /// \throws NotKept
  void model(const Model& model);
  void shared(const std::shared_ptr<const Model>& model);

 private:
  /// Returns true if the object was written before; then only its number is written.
  template <class T>
  bool is_known(const std::shared_ptr<const T>& object);
  void curve(const CurvePtr& curve);
  void parameter_curve(const ParameterCurvePtr& curve);
  void surface(const SurfacePtr& surface);
  void content(const Curve& curve);
  void content(const ParameterCurve& curve);
  void content(const Surface& surface);

  ByteSink& sink_;
  std::map<const void*, std::uint64_t> known_;  ///< number among the objects of its class
  std::uint64_t n_curves_ = 0, n_parameter_curves_ = 0, n_surfaces_ = 0, n_models_ = 0;
};

/// Reads the data of a ModelWriter, in the same order.
class ModelReader {
 public:
  /// \p shape_of_next returns the shape of the n-th model (from 0, in the order of writing) that had one
  ModelReader(ByteSource& source, std::function<std::shared_ptr<const CadShape>(std::size_t)> shape_of_next)
      : source_(source), shape_of_next_(std::move(shape_of_next)) {}
  /// \throws Error(file_malformed)
  Model model();
  std::shared_ptr<const Model> shared();

 private:
  template <class T, class Read>
  std::shared_ptr<const T> object(std::vector<std::shared_ptr<const T>>& known, const Read& read);
  CurvePtr curve();
  ParameterCurvePtr parameter_curve();
  SurfacePtr surface();
  CurvePtr new_curve();
  ParameterCurvePtr new_parameter_curve();
  SurfacePtr new_surface();

  ByteSource& source_;
  std::function<std::shared_ptr<const CadShape>(std::size_t)> shape_of_next_;
  std::size_t n_models_ = 0;
  std::vector<std::shared_ptr<const Model>> models_;
  std::vector<CurvePtr> curves_;
  std::vector<ParameterCurvePtr> parameter_curves_;
  std::vector<SurfacePtr> surfaces_;
};

}  // namespace sterna::scripting
