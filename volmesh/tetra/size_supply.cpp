#include "volmesh/tetra/size_supply.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace sterna::volmesh {

SizeSupply::SizeSupply(Borrowed<const TetraBoundary> boundary, Borrowed<const std::vector<SizeSource>> sources, const SizeFieldOptions& options,
                       const RunContext& context, std::function<void(const SizeField&, const RunContext&)> judge)
    : sources_(sources.get()), options_(options) {
  making_.emplace(context, [boundary, sources, options, judge = std::move(judge)](const RunContext& side) {
    const StageTimer timer(side, "tetrahedra/size");
    SizeField field = build_size_field(boundary, sources.get(), options, side);
    if (judge) judge(field, side);
    return field;
  });
}

void SizeSupply::wait() const {
  if (making_) making_->wait();
}

const SizeField& SizeSupply::get() {
  if (!field_) field_ = &made_.emplace(std::move(*making_).take());
  return *field_;
}

SizeField SizeSupply::with(const SizeSource& samples, const TetraBoundary& boundary, const RunContext& context) {
  const SizeField& field = get();
  std::vector<SizeSource> sources(sources_.begin(), sources_.end());
  sources.push_back(samples);
  SizeFieldOptions options = options_;
  if (!making_) {
    // The original sources are not known here, so the given field is evaluated at the samples.
    options.size_growth = field.view().header().growth;
    SizeSource& own = sources.back();
    for (std::size_t i = 0; i < own.points.size(); ++i) own.sizes[i] = std::min(own.sizes[i], field(own.points[i]));
  }
  return build_size_field(boundary, sources, options, context);
}

}  // namespace sterna::volmesh
