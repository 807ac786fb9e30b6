// A size field that may still be in the making while an engine works on the boundary.
#pragma once

#include <functional>
#include <optional>
#include <span>

#include "geom/base/alongside.h"
#include "volmesh/tetra/size_field.h"

namespace sterna::volmesh {

class SizeSupply {
 public:
  /// One that is ready. `field` must outlive it.
  explicit SizeSupply(const SizeField& field) : field_(&field) {}
  /// Begins to build one (build_size_field) beside the caller; boundary and sources must outlive it.
  /// \p judge: looks at what is made, and may throw: get() throws that
  SizeSupply(const TetraBoundary& boundary, std::span<const SizeSource> sources, const SizeFieldOptions& options, const RunContext& context,
             std::function<void(const SizeField&, const RunContext&)> judge = {});

  bool is_ready() const { return field_ || making_->is_done(); }
  /// From any thread.
  void wait() const;
  /// Waits.
  /// \throws what build_size_field() has thrown.
  const SizeField& get();
  /// A field that asks for these sizes, too, where they are smaller; sizes grow as in this one. Waits, throws as get() does.
  SizeField with(const SizeSource& samples, const TetraBoundary& boundary, const RunContext& context);

 private:
  const SizeField* field_ = nullptr;
  std::span<const SizeSource> sources_;  ///< of the one that is built here
  SizeFieldOptions options_;
  std::optional<SizeField> made_;
  std::optional<Alongside<SizeField>> making_;  ///< last: ends first
};

}  // namespace sterna::volmesh
