// Steps into which volume_mesh can be split by hand (volmesh/stages.h).
#pragma once

#include <cstdint>

namespace sterna::volmesh {

/// Sets of steps, combinable. Each options struct of a volume mesh names in its Schema the steps where it may be given: its own step, and for options that both
/// of the first two steps use (the outer boundary) also the following step.
using MeshSteps = std::uint8_t;
inline constexpr MeshSteps k_envelope_step = 1;
inline constexpr MeshSteps k_tetrahedra_step = 2;
inline constexpr MeshSteps k_finish_step = 4;

}  // namespace sterna::volmesh
