// A size field that may still be under construction while an engine processes the boundary.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "geom/base/alongside.h"
#include "geom/base/borrowed.h"
#include "volmesh/tetra/size_field.h"

namespace sterna::volmesh {

class SizeSupply {
 public:
  /// Uses a finished field.
  explicit SizeSupply(Borrowed<const SizeField> field) : field_(&field.get()) {}
  /// Starts to build a field (build_size_field) in parallel to the caller. \p judge checks the finished field; if it throws, get() rethrows the error
  SizeSupply(Borrowed<const TetraBoundary> boundary, Borrowed<const std::vector<SizeSource>> sources, const SizeFieldOptions& options,
             const RunContext& context, std::function<void(const SizeField&, const RunContext&)> judge = {});

  bool is_ready() const { return field_ || making_->is_done(); }
  /// Thread-safe.
  void wait() const;
  /// Waits for the field and returns it.
  /// \throws the errors of build_size_field()
  const SizeField& get();
  /// Returns a field that also contains these sizes where they are smaller. Sizes grow as in this field. Waits and throws like get().
  SizeField with(const SizeSource& samples, const TetraBoundary& boundary, const RunContext& context);

 private:
  const SizeField* field_ = nullptr;
  std::span<const SizeSource> sources_;  ///< sources of the field that is built here
  SizeFieldOptions options_;
  std::optional<SizeField> made_;
  std::optional<Alongside<SizeField>> making_;  ///< must be the last member, because it must end first
};

}  // namespace sterna::volmesh
