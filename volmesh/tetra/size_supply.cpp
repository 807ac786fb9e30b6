#include "volmesh/tetra/size_supply.h"

namespace sterna::volmesh {

SizeSupply::SizeSupply(const TetraBoundary& boundary, std::span<const SizeSource> sources, const SizeFieldOptions& options, const RunContext& context) {
  making_.emplace(context, [&boundary, sources, options](const RunContext& side) {
    const StageTimer timer(side, "tetrahedra/size");
    return build_size_field(boundary, sources, options, side);
  });
}

void SizeSupply::wait() const {
  if (making_) making_->wait();
}

const SizeField& SizeSupply::get() {
  if (!field_) field_ = &made_.emplace(making_->take());
  return *field_;
}

}  // namespace sterna::volmesh
