// The steps in which volume_mesh can be done by hand (volmesh/stages.h).
#pragma once

#include <cstdint>

namespace sterna::volmesh {

/// Sets of steps, combinable. Each options struct of a volume mesh names in its Schema those where it may be given: its step, and for what both of the first
/// two build on (the outer boundary) the one after.
using MeshSteps = std::uint8_t;
inline constexpr MeshSteps k_envelope_step = 1;
inline constexpr MeshSteps k_tetrahedra_step = 2;
inline constexpr MeshSteps k_finish_step = 4;

}  // namespace sterna::volmesh
