#include "scripting/lua/script_value.h"

#include "scripting/lua/component_value.h"
#include "scripting/lua/quantity.h"

namespace sterna::scripting {

std::string_view type_text(const ScriptValue& value) {
  struct Name {
    std::string_view operator()(std::monostate) const { return "nil"; }
    std::string_view operator()(bool) const { return "true or false"; }
    std::string_view operator()(std::int64_t) const { return "a number"; }
    std::string_view operator()(double) const { return "a number"; }
    std::string_view operator()(const std::string&) const { return "a string"; }
    std::string_view operator()(const std::shared_ptr<const ScriptTable>&) const { return "a table"; }
    std::string_view operator()(const SurfaceHandle&) const { return "a surface"; }
    std::string_view operator()(const EnvelopeHandle&) const { return "an envelope"; }
    std::string_view operator()(const TetrahedraHandle&) const { return "tetrahedra"; }
    std::string_view operator()(const MeshHandle&) const { return "a volume mesh"; }
    std::string_view operator()(const ModelHandle&) const { return "a model"; }
    std::string_view operator()(const ComponentHandle& v) const { return v->type_text(); }
    std::string_view operator()(const AirfoilHandle&) const { return "an airfoil"; }
    std::string_view operator()(const FunctionHandle&) const { return "a function"; }
    std::string_view operator()(const QuantityHandle& v) const { return v->type_text(); }
    std::string_view operator()(const ErrorHandle&) const { return "an error"; }
    std::string_view operator()(const ScriptVerb*) const { return "a verb"; }
    std::string_view operator()(const OpaqueValue& v) const { return v.type_name; }
  };
  return std::visit(Name{}, value);
}

std::string_view object_name(const ScriptValue& value) {
  return std::holds_alternative<SurfaceHandle>(value)      ? "surface"
         : std::holds_alternative<EnvelopeHandle>(value)   ? "envelope"
         : std::holds_alternative<TetrahedraHandle>(value) ? "tetrahedra"
         : std::holds_alternative<MeshHandle>(value)       ? "mesh"
         : std::holds_alternative<ModelHandle>(value)      ? "model"
         : std::holds_alternative<ComponentHandle>(value)  ? "component"
         : std::holds_alternative<AirfoilHandle>(value)    ? "airfoil"
         : std::holds_alternative<QuantityHandle>(value)   ? "quantity"
         : std::holds_alternative<ErrorHandle>(value)      ? "error"
                                                           : "";
}

bool is_same_object(const ScriptValue& a, const ScriptValue& b) {
  return std::visit(
      [&](const auto& of_a) {
        using V = std::decay_t<decltype(of_a)>;
        if constexpr (requires { of_a.use_count(); }) {
          const auto* of_b = std::get_if<V>(&b);
          return of_b && *of_b == of_a;
        } else {
          return false;
        }
      },
      a);
}

bool is_unknown(const ScriptValue& value) {
  const auto* opaque = std::get_if<OpaqueValue>(&value);
  return opaque && opaque->type_name == k_unknown_value;
}

}  // namespace sterna::scripting
