// What goes into keys and entries of the cache: the headers of the plain structs, whose members the compiler counts (members.h), and the structs that need a
// description of their own.
#pragma once

#include "geom/mesh/check.h"
#include "geom/model/aircraft.h"
#include "scripting/cache/archive.h"
#include "scripting/values/stored_stages.h"
#include "scripting/values/verbs.h"
#include "surfmesh/model/model_wall.h"
#include "surfmesh/remesh/remesh_surface.h"

namespace sterna::scripting {

namespace detail {

/// A struct with a base class: its members are spread over two classes.
template <>
struct Archive<volmesh::Envelope> {
  static void write(ByteSink& sink, const volmesh::Envelope& value) {
    for_each_column([&](const auto& column) { write_value(sink, column); }, value);
  }
  static void read(ByteSource& source, volmesh::Envelope& value) {
    for_each_column([&](auto& column) { read_value(source, column); }, value);
  }
};

template <>
struct Archive<volmesh::VolumeMeshResult> {
  static_assert(member_count<volmesh::VolumeMeshResult>() == 3, "the base class, mesh and check");
  static void write(ByteSink& sink, const volmesh::VolumeMeshResult& value) {
    write_value<volmesh::VolumeMeshReport>(sink, value);
    write_value(sink, value.mesh);
    write_value(sink, value.check);
  }
  static void read(ByteSource& source, volmesh::VolumeMeshResult& value) {
    read_value<volmesh::VolumeMeshReport>(source, value);
    read_value(source, value.mesh);
    read_value(source, value.check);
  }
};

/// First heights have a key by their values, and are not stored.
template <>
struct Archive<std::shared_ptr<const volmesh::FirstHeights>> {
  static void write(ByteSink& sink, const std::shared_ptr<const volmesh::FirstHeights>& heights) {
    write_value(sink, heights != nullptr);
    if (heights) write_value(sink, std::vector<double>(heights->values().begin(), heights->values().end()));
  }
};

/// The reader knows the key.
template <>
struct Archive<Provenance> {
  static void write(ByteSink&, const Provenance&) {}
  static void read(ByteSource&, Provenance&) {}
};

/// The key stands for the model.
template <>
struct Archive<TrueSurface> {
  static void write(ByteSink& sink, const TrueSurface& value) { write_value(sink, value.key); }
  static void read(ByteSource& source, TrueSurface& value) { read_value(source, value.key); }
};

}  // namespace detail
}  // namespace sterna::scripting
