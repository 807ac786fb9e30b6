// Members of the data that a reference case stores, for archive.h, in the same form as in stored_types.h.
#pragma once

#include "scripting/values/kept_reference.h"
#include "scripting/values/stored_types.h"

namespace sterna::scripting {

template <>
inline constexpr std::size_t k_members<ContentKey> = 1;
template <>
inline constexpr std::size_t k_members<Component> = 2;
template <>
inline constexpr std::size_t k_members<Interval> = 2;
template <>
inline constexpr std::size_t k_members<ParameterBox> = 2;
template <>
inline constexpr std::size_t k_members<surfmesh::EdgeStructure> = 5;
template <>
inline constexpr std::size_t k_members<surfmesh::UseStructure> = 3;
template <>
inline constexpr std::size_t k_members<surfmesh::FaceStructure> = 7;
template <>
inline constexpr std::size_t k_members<surfmesh::SolidStructure> = 3;
template <>
inline constexpr std::size_t k_members<surfmesh::ModelStructure> = 5;
template <>
inline constexpr std::size_t k_members<surfmesh::StructuredMesh> = 2;
template <>
inline constexpr std::size_t k_members<surfmesh::CarriedMesh> = 3;
template <>
inline constexpr std::size_t k_members<volmesh::EnvelopeOptions> = 23;
template <>
inline constexpr std::size_t k_members<volmesh::StartingEnvelope> = 2;
template <>
inline constexpr std::size_t k_members<KeptPart> = 7;
template <>
inline constexpr std::size_t k_members<KeptEnvelope> = 3;
template <>
inline constexpr std::size_t k_members<CarriedPart> = 3;
template <>
inline constexpr std::size_t k_members<ReferenceUse::Beside> = 4;

}  // namespace sterna::scripting
