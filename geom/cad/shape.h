// Interface between a Model and OpenCASCADE: the same faces, edges and corners in both, by number.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "geom/base/error.h"
#include "geom/base/run_context.h"
#include "geom/model/model.h"

namespace sterna {

/// The OpenCASCADE representation of a Model: a compound of solids, shells and loose faces whose i-th face is face i of the Model. The object is immutable and
/// shared. Its content is hidden, because OpenCASCADE's headers stay inside geom/cad.
class CadShape {
 public:
  struct Content;  ///< occt_shape.h
  explicit CadShape(std::unique_ptr<const Content> content);
  /// Creates a shape lazily: `make` (whose result is never null) is called at the first use by cad::shape_of. For models whose geometry is available before the
  /// shape.
  explicit CadShape(std::function<std::shared_ptr<const CadShape>()> make);
  ~CadShape();
  CadShape(const CadShape&) = delete;
  CadShape& operator=(const CadShape&) = delete;
  /// \throws Error of `make`, at the first call
  const Content& content() const;

 private:
  std::unique_ptr<const Content> content_;
  std::function<std::shared_ptr<const CadShape>()> make_;
  mutable std::once_flag is_made_;
  mutable std::shared_ptr<const CadShape> made_;  ///< result of make_
};

namespace cad {

/// Returns the shape of a model: model.shape if set, else built from its surfaces, edges and borders without any approximation: B-splines by exact_nurbs,
/// planes and quadrics as such if they have that form. Edges stay shared, seams and poles keep their meaning; closed solids become solids.
/// \throws Error(geometry_failed) naming the face or edge that has no exact form, or that OpenCASCADE's check rejects, with its location.
std::shared_ptr<const CadShape> shape_of(const Model& model, const RunContext& context);

/// Returns the faults of a shape found by OpenCASCADE's check (BRepCheck), one text with location for each faulty face, edge or corner; empty: valid.
std::vector<ErrorLocation> faults_of(const CadShape& shape);

}  // namespace cad
}  // namespace sterna
