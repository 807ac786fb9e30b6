// The objects held by scripts, as pointers: their types are defined in the folders above this one.
#pragma once

#include <memory>

namespace sterna {
struct Airfoil;  // geom/model/airfoil.h
}

namespace sterna::scripting {

struct SurfaceValue;     // values/verbs.h
struct MeshValue;        // values/verbs.h
struct EnvelopeValue;    // values/stored_stages.h
struct TetrahedraValue;  // values/stored_stages.h
struct ModelValue;       // values/models.h
struct ComponentValue;   // component_value.h
struct QuantityValue;    // quantity.h
class ScriptFunction;    // script_function.h
struct ScriptTable;      // script_value.h
using SurfaceHandle = std::shared_ptr<const SurfaceValue>;
using MeshHandle = std::shared_ptr<const MeshValue>;
using EnvelopeHandle = std::shared_ptr<const EnvelopeValue>;
using TetrahedraHandle = std::shared_ptr<const TetrahedraValue>;
using ModelHandle = std::shared_ptr<const ModelValue>;
using ComponentHandle = std::shared_ptr<ComponentValue>;
using AirfoilHandle = std::shared_ptr<const Airfoil>;
using FunctionHandle = std::shared_ptr<const ScriptFunction>;
using QuantityHandle = std::shared_ptr<const QuantityValue>;
using TableHandle = std::shared_ptr<const ScriptTable>;

}  // namespace sterna::scripting
