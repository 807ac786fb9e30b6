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

}  // namespace detail
}  // namespace sterna::scripting
