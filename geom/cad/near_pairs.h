// Inside geom/cad only: the intersection step of OpenCASCADE's general fuse, restricted to edges and faces that are actually close to each other.
#pragma once

#include <BOPAlgo_PaveFiller.hxx>

#include "geom/base/run_context.h"

namespace sterna::cad {

/// A pave filler that first removes pairs of edges and faces by comparing the hulls of their B-spline pieces. OpenCASCADE compares whole bounding boxes: those
/// of a swept leading edge and of a fuselage overlap although the two are metres apart, and each such pair costs 0.1 s and more. Hulls contain their pieces, so
/// no pair that is within the tolerances is lost.
class NearPairsFiller : public BOPAlgo_PaveFiller {
 public:
  explicit NearPairsFiller(const RunContext& context) : context_(context) {}

 protected:
  void Init(const Message_ProgressRange& range) override;

 private:
  RunContext context_;
};

}  // namespace sterna::cad
