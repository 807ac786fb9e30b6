// Methods and fields of models: model:write, model:move, model:rotate, model:deform and so on. Each gives a new model; none changes the old one.
#pragma once

#include <span>

#include "scripting/script_call.h"

namespace sterna::scripting {

std::span<const ScriptVerb> model_methods();
/// model.faces; model["wing*"] are the components of that name, as a model.
extern const ScriptVerb k_model_field;

}  // namespace sterna::scripting
