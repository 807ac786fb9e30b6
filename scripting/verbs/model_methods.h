// Methods and fields of models: model:write, model:move, model:rotate, model:deform and so on. Each returns a new model; none changes the old one.
#pragma once

#include <span>

#include "geom/model/frame.h"
#include "scripting/lua/script_call.h"

namespace sterna::scripting {

std::span<const ScriptVerb> model_methods();
/// Reads the fields of a model: model.faces; model["wing*"] is a model of the components of that name.
extern const ScriptVerb k_model_field;

/// Reads the motion of object:move{ dx, dy, dz } and object:rotate{ ... }, for models and surfaces.
/// \throws Error(bad_argument)
Transform read_shift(const ScriptCall& call, std::string_view usage);
Transform read_turn(const ScriptCall& call, std::string_view usage);
std::string rotate_help();

}  // namespace sterna::scripting
