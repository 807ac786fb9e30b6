// Steps into which users can split volume_mesh (volmesh/stages.h).
#pragma once

#include <cstdint>

namespace sterna::volmesh {

/// Sets of steps, which can be combined. Each options struct of a volume mesh names in its Schema the steps at which it may be given: its own step, and if both
/// of the first two steps use it (the outer boundary), also the following step.
using MeshSteps = std::uint8_t;
inline constexpr MeshSteps k_envelope_step = 1;
inline constexpr MeshSteps k_tetrahedra_step = 2;
inline constexpr MeshSteps k_finish_step = 4;

}  // namespace sterna::volmesh
