// The bridge between a Model and OpenCASCADE: the same faces, edges and corners in both, by number.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "geom/base/error.h"
#include "geom/base/run_context.h"
#include "geom/model/model.h"

namespace sterna {

/// What OpenCASCADE holds of a Model: a compound of solids, shells and loose faces whose i-th face is face i of the Model. Immutable and shared; opaque,
/// since OpenCASCADE's headers stay inside geom/cad.
class CadShape {
 public:
  struct Content;  ///< occt_shape.h
  explicit CadShape(std::unique_ptr<const Content> content);
  /// What `make` gives (never null) when it is first asked for: of a model whose geometry is known before its shape is. cad::shape_of asks.
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
  mutable std::shared_ptr<const CadShape> made_;  ///< by make_
};

namespace cad {

/// The shape of a model: model.shape where there is one, else built from its surfaces, edges and borders without any approximation: B-splines by exact_nurbs,
/// planes and quadrics likewise where they have that form. Edges stay shared, seams and poles keep their meaning; solids that are closed become solids.
/// \throws Error(geometry_failed) naming the face or edge that has no exact form, or that OpenCASCADE's check rejects, with its place.
std::shared_ptr<const CadShape> shape_of(const Model& model, const RunContext& context);

/// Faults of a shape by OpenCASCADE's own check (BRepCheck), one text for each faulty face, edge or corner with its place; empty: valid.
std::vector<ErrorPlace> faults_of(const CadShape& shape);

}  // namespace cad
}  // namespace sterna
